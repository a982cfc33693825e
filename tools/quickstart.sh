#!/usr/bin/env bash
# Goes from a fresh Debian 12 (with git and apt) to a picture: installs missing packages, builds, and runs encode,
# decode, compare and render on the Stanford bunny. A second run does not install or build again. Usage: bash
# tools/quickstart.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

readonly OUT="$GIM_ROOT/out/quickstart"
readonly PACKAGED_BUNNY=usr/share/glmark2/models/bunny.obj

# Prints the path of the bunny, or fails. Unpacks the package without installing it, because its data is enough.
find_bunny() {
    local path
    for path in "/$PACKAGED_BUNNY" "$OUT/package/$PACKAGED_BUNNY"; do
        [ -s "$path" ] && echo "$path" && return 0
    done
    mkdir -p "$OUT/package"
    (
        cd "$OUT/package"
        apt-get -qq download glmark2-data ||
            { as_root apt-get -qq update && apt-get -qq download glmark2-data; }
        dpkg-deb -x glmark2-data_*.deb . && rm -f glmark2-data_*.deb
    ) >&2 || return 1
    [ -s "$OUT/package/$PACKAGED_BUNNY" ] && echo "$OUT/package/$PACKAGED_BUNNY"
}

install_packages "${GIM_BUILD_PACKAGES[@]}"
configure_and_build release -DGIM_BUILD_TESTS=OFF
mkdir -p "$OUT"
PATH="$GIM_ROOT/build/release/tools:$GIM_ROOT/build/release/corpus:$PATH"

say "Looking for the Stanford bunny"
if mesh=$(find_bunny); then
    echo "$mesh"
else
    echo "The bunny (Debian package glmark2-data) is not available. A generated mesh takes its place."
    mesh="$OUT/limbs-rough.ply"
    gim_corpus limbs-rough "$mesh"
fi

say "Encoding (257 x 257 samples, default quality)"
gim encode "$mesh" "$OUT/mesh.gim" --json "$OUT/report.json"
say "Decoding"
gim decode "$OUT/mesh.gim" "$OUT/mesh.ply"
gim info "$OUT/mesh.gim"
say "Comparing"
gim compare "$mesh" "$OUT/mesh.ply"
gim render "$mesh" "$OUT/picture.png" --gim "$OUT/mesh.gim" --size 480

say "Done"
echo "program  $GIM_ROOT/build/release/tools/gim"
echo "file     $OUT/mesh.gim"
echo "picture  $OUT/picture.png  (original, geometry image, reconstruction)"
