#!/usr/bin/env bash
# Builds the decoder for other platforms and decodes all conformance vectors there: clang on this machine, 64-bit and
# 32-bit ARM, and big-endian s390x under qemu. Checks the headers as strict C99 and C++20, and as a compiler for
# Windows sees them. `bash tools/test.sh cross` installs what it needs and runs it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
readonly OUT=build/cross
readonly CXX_FLAGS=(-std=c++20 -O2 -ffp-contract=off -fno-math-errno -Wall -Wextra -Werror -Wno-psabi -I. -Idecoder/include)

# All sources of format and decoder, but for compressed text: zstd is not there for other platforms.
sources() {
    ls format/*.cpp
    find decoder -path decoder/bindings -prune -o -name '*.cpp' ! -name unpack_text.cpp -print
    echo decoder/bindings/wasm/unpack_text.cpp
    echo tests/decoder/check_vectors.cpp
}

# check_platform NAME COMPILER [RUNNER...]: the runner starts programs of that platform.
check_platform() {
    local name=$1 compiler=$2 objects=()
    shift 2
    mkdir -p "$OUT/$name"
    while read -r source; do objects+=("$OUT/$name/${source//\//_}.o"); done < <(sources)
    sources | xargs -P "$(nproc)" -I{} bash -c \
        'object="$1/$(echo "$2" | tr / _).o"; shift 2; exec "$@" -o "$object"' _ "$OUT/$name" {} \
        "$compiler" "${CXX_FLAGS[@]}" -c {}
    "$compiler" -static "${objects[@]}" -o "$OUT/$name/check_vectors"
    printf '%-28s ' "$name"
    "$@" "$OUT/$name/check_vectors" spec/vectors
}

check_headers() {
    local header
    for header in decoder/include/gim/*.h; do
        gcc -std=c99 -pedantic-errors -Wall -Wextra -Werror -Idecoder/include -fsyntax-only -x c "$header"
        g++ -std=c++20 -pedantic-errors -Wall -Wextra -Werror -Idecoder/include -fsyntax-only -x c++ "$header"
        clang --target=x86_64-pc-windows-msvc -ffreestanding -std=c99 -pedantic-errors -Wall -Wextra -Werror \
            -Idecoder/include -fsyntax-only -x c "$header"
    done
    g++ -std=c++20 -pedantic-errors -Wall -Wextra -Werror -Idecoder/include -fsyntax-only -x c++ \
        decoder/include/gim/decoder.hpp
    printf '%-28s C99, C++20, and C for Windows\n' "headers"
}

check_headers
check_platform "x86-64, clang" clang++
check_platform "ARM, 64 bits" aarch64-linux-gnu-g++ qemu-aarch64
check_platform "ARM, 32 bits" arm-linux-gnueabihf-g++ qemu-arm
check_platform "s390x, big-endian" s390x-linux-gnu-g++ qemu-s390x
