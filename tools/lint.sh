#!/usr/bin/env bash
# Checks formatting (clang-format 14), the direction of includes, the length of files and the generated tables; runs
# clang-tidy 14 over the tree.
# Usage: bash tools/lint.sh [--format-only | --fix] [FILE...]     --fix reformats; FILEs limit clang-tidy to these sources
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$GIM_ROOT"

# What the files of a folder may include besides their own folder. A folder that is not listed may include nothing else.
declare -A may_include=(
    [decoder/pyramid]="format"
    [decoder/layout]="format decoder/pyramid"
    [decoder/squares]="format decoder/pyramid decoder/layout"
    [decoder/charts]="format decoder/pyramid decoder/layout"
    [decoder/tiles]="format decoder/pyramid decoder/layout"
    [decoder/raster]="format decoder/pyramid decoder/layout decoder/charts"
    [decoder/refine]="format decoder/pyramid decoder/layout"
    [decoder]="format decoder/pyramid decoder/layout decoder/squares decoder/charts decoder/raster decoder/tiles decoder/refine"
    [decoder/bindings/wasm]="format decoder"
    [decoder/bindings/wasm/refine]="decoder decoder/squares decoder/tiles"
    [encoder/base]=""
    [encoder/surface]="format encoder/base"
    [encoder/code]="format encoder/base encoder/surface"
    [encoder/image]="format encoder/base encoder/surface encoder/code"
    [encoder/fit]="format encoder/base encoder/surface encoder/code encoder/image"
    [encoder/planes]="format encoder/base encoder/surface encoder/code encoder/image"
    [encoder/layout]="format encoder/base encoder/surface encoder/code encoder/image encoder/fit encoder/planes"
    [encoder/squares]="format encoder/base encoder/surface encoder/code encoder/image encoder/fit encoder/planes encoder/layout"
    [encoder/charts]="format encoder/base encoder/surface encoder/code encoder/image encoder/fit encoder/planes encoder/layout"
    [encoder/tiles]="format encoder/base encoder/surface encoder/code encoder/image encoder/fit encoder/planes encoder/layout"
    [encoder/raster]="format decoder/pyramid encoder/base encoder/surface encoder/code encoder/image encoder/fit"
    [encoder/emboss]="format decoder/pyramid decoder/squares decoder/tiles encoder/base encoder/surface encoder/code encoder/image encoder/planes encoder/tiles"
    [encoder]="format encoder/base encoder/surface encoder/code encoder/image encoder/fit encoder/planes encoder/layout encoder/squares encoder/charts encoder/tiles encoder/raster"
    [corpus]=""
    [tools]="corpus tools/batch tools/scene"
    [tools/batch]="tools"
    [tools/scene]="tools tools/gpu"
    [tools/gpu]=""
    [tools/rd]="tools corpus"
    [tools/train]="format decoder/squares encoder/tiles"
)
readonly MOST_LINES=500 MOST_SHADER_LINES=150

# Prints every include against the arrow. Public headers (gim/...) are everybody's.
wrong_includes() {
    local file folder target
    while IFS=: read -r file target; do
        folder=$(dirname "$file")
        target=$(dirname "$target")
        [ "$folder" = "$target" ] && continue
        case " ${may_include[$folder]:-} " in *" $target "*) ;; *) echo "$file includes $target" ;; esac
    done < <(git ls-files 'format/*' 'decoder/*' 'encoder/*' 'tools/*' 'corpus/*' | grep -E '\.(h|hpp|cpp)$' |
        xargs grep -oE '^#include "(format|decoder|encoder|tools|corpus|tests)/[^"]+' | sed 's/#include "//')
}

long_files() {
    git ls-files 'format/*' 'decoder/*' 'encoder/*' 'tools/*' 'corpus/*' | grep -E '\.(h|hpp|cpp)$' | xargs wc -l |
        awk -v most="$MOST_LINES" '$2 != "total" && $1 > most { print $2 " has " $1 " lines" }'
    git ls-files 'decoder/shaders/*' | grep -v '\.md$' | xargs wc -l |
        awk -v most="$MOST_SHADER_LINES" '$2 != "total" && $1 > most { print $2 " has " $1 " lines" }'
}

mode=${1:-}
case "$mode" in --format-only | --fix) shift ;; *) mode= ;; esac

install_packages clang-format-14 python3
mapfile -t sources < <(git ls-files '*.h' '*.cpp' '*.c')
if [ "$mode" = --fix ]; then
    clang-format-14 -i "${sources[@]}"
    exit 0
fi
say "clang-format over ${#sources[@]} files"
clang-format-14 --dry-run -Werror "${sources[@]}" || die "run: bash tools/lint.sh --fix"
say "Includes and lengths"
complaints=$(wrong_includes; long_files)
[ -z "$complaints" ] || die "$complaints"
say "Generated tables"
python3 tools/results.py --check || die "run: python3 tools/results.py"
[ "$mode" = --format-only ] && exit 0

install_packages "${GIM_BUILD_PACKAGES[@]}" clang-tidy-14
cmake --preset release --log-level=WARNING
say "clang-tidy"
if [ $# -gt 0 ]; then
    files=("$@")
else
    mapfile -t files < <(git ls-files '*.cpp' | grep -vE '^(tests/fuzz|tools/rd)/')
fi
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy-14 -p build/release --quiet 2>/dev/null ||
    die "clang-tidy found problems; see above"
echo "clean: ${#files[@]} files"
