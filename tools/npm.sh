#!/usr/bin/env bash
# Builds the npm package: the decoder as WebAssembly, and the JavaScript around it, in build/npm/gim-VERSION.tgz.
# Installs missing packages; needs no network but for that.
# Usage: bash tools/npm.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$GIM_ROOT"
readonly BINDINGS=decoder/bindings PACKAGE=build/npm/package WORK=build/npm/work

tracked() { git ls-files --cached --others --exclude-standard -- "$@" | grep '\.cpp$'; }

# sources_of decoder|refine: what the entry is made of. Some files have a stand-in: one needs zstd, one has large tables,
# and gim/refine decodes no levels.
sources_of() {
    local stand_ins='unpack_text|domains'
    [ "$1" = decoder ] || stand_ins='unpack_text|layouts'
    tracked format decoder | grep -vE "^(decoder/($stand_ins)\.cpp|format/checksum\.cpp|decoder/bindings/)" |
        if [ "$1" = decoder ]; then grep -vE '^decoder/(refine|clusters)'; else cat; fi
    tracked "$BINDINGS/wasm" | if [ "$1" = decoder ]; then grep -v "^$BINDINGS/wasm/refine/"; else cat; fi
}

# compile SOURCE OBJECT. Where the time goes, for speed; the rest for size.
compile() {
    local how=(-flto -Oz -DGIM_SMALL_CODE)
    case $1 in
        decoder/pyramid/rows.cpp | decoder/pyramid/band_decoder.cpp | decoder/pyramid/synthesis.cpp | \
            decoder/pyramid/cells.cpp | decoder/tiles/tile_surface.cpp | format/expectation.cpp | \
            format/lift_tiles.cpp | decoder/refine/*)
            how=(-flto -O2 -fno-unroll-loops)
            ;;
        */memory.cpp) how=(-fno-builtin -mbulk-memory -Oz) ;;
    esac
    clang++-14 --target=wasm32-wasi -msimd128 -std=c++20 "${how[@]}" -ffp-contract=off -fno-exceptions -fno-rtti \
        -fno-math-errno -fvisibility=hidden -DNDEBUG -Wall -Wextra -I. -Idecoder/include -c "$1" -o "$2"
}
export -f compile

# build_wasm decoder|refine: writes $WORK/NAME.wasm, and the same as a script, $WORK/NAME_wasm.js.
build_wasm() {
    local name=$1 source object objects=() pairs=() exports=()
    mkdir -p "$WORK/$name"
    while read -r source; do
        object="$WORK/$name/${source//\//_}.o"
        objects+=("$object")
        pairs+=("$source" "$object")
    done < <(sources_of "$name")
    printf '%s\0' "${pairs[@]}" | xargs -0 -P "$(nproc)" -n 2 bash -c 'compile "$0" "$1"' || die "compiling failed"
    mapfile -t exports < <(sed 's/^/--export=/' "$BINDINGS/wasm/$name.exports")
    # Loop strength reduction saves no time here and makes the code larger.
    wasm-ld-14 --no-entry --stack-first -z stack-size=65536 --lto-O2 -O3 --gc-sections --strip-all -mllvm -disable-lsr \
        "${exports[@]}" "${objects[@]}" -o "$WORK/$name.raw.wasm"
    wasm-opt --enable-simd --enable-bulk-memory --flatten --rereloop -Oz -Oz --coalesce-locals-learning --reorder-locals \
        --merge-similar-functions --strip-producers "$WORK/$name.raw.wasm" -o "$WORK/$name.wasm"
    node "$BINDINGS/wasm/embed.mjs" "$WORK/$name.wasm" "$WORK/${name}_wasm.js"
}

# put_module_on_a_line SCRIPT: traces of errors quote whole lines.
put_module_on_a_line() {
    node -e 'const fs = require("fs"), file = process.argv[1], script = fs.readFileSync(file, "utf8");
        const module = script.match(/"[^"]*"/g).reduce((a, b) => (b.length > a.length ? b : a));
        fs.writeFileSync(file, script.split(module).join("\n" + module + "\n"));' "$1"
}

# bundle NAME: both scripts of an entry, with its WebAssembly inside if it has one of its own. Entries call each other: all
# of a page share one decoder.
bundle() {
    local format extension
    for format in esm:mjs cjs:cjs; do
        extension=${format#*:}
        esbuild "$BINDINGS/npm/$1.js" --bundle --minify --target=es2020 --log-level=warning --charset=ascii \
            --external:gim/* --external:three --alias:gim-wasm="./$WORK/$1_wasm.js" --format="${format%:*}" \
            --outfile="$PACKAGE/$1.$extension"
        sed -i -E "s#([\"'])gim/(decoder|source)\1#\"./\2.$extension\"#g" "$PACKAGE/$1.$extension"
        [ ! -f "$WORK/$1_wasm.js" ] || put_module_on_a_line "$PACKAGE/$1.$extension"
    done
    printf '%s.mjs: %s bytes, %s with brotli\n' "$1" "$(wc -c <"$PACKAGE/$1.mjs")" \
        "$(brotli -q 11 -w 24 -c "$PACKAGE/$1.mjs" | wc -c)"
}

install_packages "${GIM_NPM_PACKAGES[@]}"
rm -rf "$PACKAGE" build/npm/*.tgz
mkdir -p "$PACKAGE" "$WORK"
cp LICENSE "$BINDINGS"/npm/{package.json,README.md} "$BINDINGS"/npm/*.d.ts "$PACKAGE"
for entry in decoder refine; do
    say "WebAssembly of gim/$entry"
    build_wasm "$entry"
done
for entry in decoder source three refine; do
    bundle "$entry"
done
(cd "$PACKAGE" && npm pack --silent --pack-destination ..) >/dev/null || die "npm pack failed"
ls build/npm/*.tgz
