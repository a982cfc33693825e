#!/usr/bin/env bash
# Builds the viewer's page in build/viewer: static files for any web server, and for gim view. Needs node and npm; makes the
# decoder first if it is not there.
# Usage: bash tools/viewer/build.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"
cd "$GIM_ROOT"
readonly PAGE=build/viewer SOURCES=tools/viewer
for name in node npm; do
    command -v "$name" >/dev/null || die "no $name; install it and run this script again"
done
install_packages esbuild
[ -f build/npm/package/decoder.mjs ] || bash tools/npm.sh
(cd "$SOURCES" && { [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --no-audit --no-fund; }) ||
    die "npm cannot fetch three.js"
rm -rf "$PAGE"
mkdir -p "$PAGE"
cp "$SOURCES"/{index.html,viewer.css} LICENSE "$PAGE"
for entry in viewer measure_worker; do
    NODE_PATH="$SOURCES/node_modules" esbuild "$SOURCES/$entry.js" --bundle --minify --format=esm --target=es2022 \
        --log-level=warning --alias:gim/decoder=./build/npm/package/decoder.mjs \
        --alias:gim/source=./decoder/bindings/npm/source.js --outfile="$PAGE/$entry.js"
done
du -sh "$PAGE"
