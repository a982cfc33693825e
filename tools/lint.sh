#!/usr/bin/env bash
# Checks formatting (clang-format 14) and the generated tables, and runs clang-tidy 14 over the tree.
# Usage: bash tools/lint.sh [--format-only | --fix] [FILE...]
# --format-only skips clang-tidy. --fix only reformats. FILEs limit clang-tidy to these sources.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "$GIM_ROOT"

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
