#!/usr/bin/env bash
# Runs what a change must pass: formatting, a build without warnings, the sanitizers over format and decoder, a short
# fuzzing run, all tests. Installs missing packages. Takes about ten minutes on two cores, less with ccache.
# Usage: bash tools/test.sh           all of this
#        bash tools/test.sh gpu       only what draws, by OpenGL on Mesa's llvmpipe and by WebGPU in Chromium; two minutes
#        bash tools/test.sh web       only the npm package and the viewer, in Node and in Chromium; three minutes
#        bash tools/test.sh gltf      only glTF files, with the Khronos validator if npm can fetch it
#        bash tools/test.sh packages  only the Debian packages of what is built in build/ci: lintian, and their use in an
#                                     empty Debian; three minutes, and the build if there is none
#        bash tools/test.sh cluster   only gim batch as a Slurm array, on a Slurm of one node; one minute, and the build
#        bash tools/test.sh cross     only the conformance vectors, on other compilers and platforms; three minutes
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

readonly FUZZ_SECONDS=${GIM_FUZZ_SECONDS:-20} # per target

# Frames of WebGPU. Skips, and says so, where there is no browser to be had.
test_in_browser() {
    local name folder="$GIM_ROOT/tests/gpu/browser" cases="$GIM_ROOT/build/gpu/cases"
    for name in node:nodejs npm:npm chromium:chromium; do
        command -v "${name%%:*}" >/dev/null || (install_packages "${name##*:}") ||
            { say "Skipped: no ${name%%:*}, so WebGPU stays untested" && return 0; }
    done
    say "Frames by WebGPU"
    rm -rf "$cases"
    "$GIM_ROOT/build/gpu/tests/gpu/write_buffers" "$cases" || die "write_buffers failed"
    cd "$folder"
    [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --no-audit --no-fund ||
        { say "Skipped: npm cannot fetch the browser's client, so WebGPU stays untested" && return 0; }
    GIM_GPU_CASES="$cases" GIM_CHROMIUM="$(command -v chromium)" node --test --test-reporter=spec ||
        die "the tests in the browser failed"
}

test_gpu() {
    local name
    install_packages "${GIM_GPU_PACKAGES[@]}"
    configure_and_build gpu
    say "Frames by OpenGL"
    for name in gpu_data_test gpu_test; do
        "$GIM_ROOT/build/gpu/tests/gpu/$name" --gtest_brief=1 || die "$name failed"
    done
    (test_in_browser)
}

# The Khronos validator of glTF is a package of npm. Its test skips, and says so, where it is not there.
fetch_validator() {
    local name
    for name in node:nodejs npm:npm; do
        command -v "${name%%:*}" >/dev/null || (install_packages "${name##*:}") ||
            { say "Skipped: no ${name%%:*}, so glTF files are not validated" && return 0; }
    done
    cd "$GIM_ROOT/tests/gltf"
    [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --no-audit --no-fund ||
        say "Skipped: npm cannot fetch the validator, so glTF files are not validated"
}

test_gltf() {
    install_packages "${GIM_BUILD_PACKAGES[@]}"
    (fetch_validator)
    configure ci
    build ci encode_glb_test
    "$GIM_ROOT/build/ci/tests/encode_glb_test" || die "encode_glb_test failed"
}

test_packages() {
    install_packages "${GIM_BUILD_PACKAGES[@]}" "${GIM_PYTHON_PACKAGES[@]}"
    say "Building what the packages hold"
    configure ci
    build ci gim gim_encoder gim_decoder gim_decoder_shared
    bash "$GIM_ROOT/tools/package.sh" --from "$GIM_ROOT/build/ci" || exit 1
    bash "$GIM_ROOT/tests/packages/run.sh" "$GIM_ROOT/build/ci/package" || exit 1
}

test_cluster() {
    install_packages "${GIM_BUILD_PACKAGES[@]}"
    (install_packages "${GIM_CLUSTER_PACKAGES[@]}") || { say "Skipped: no Slurm, so tools/slurm stays untested" && return 0; }
    configure ci
    build ci gim gim_corpus
    bash "$GIM_ROOT/tests/slurm/run.sh" "$GIM_ROOT/build/ci/tools/gim" "$GIM_ROOT/build/ci/corpus/gim_corpus"
}

test_cross() {
    install_packages "${GIM_CROSS_PACKAGES[@]}"
    say "Vectors on other platforms"
    bash "$GIM_ROOT/tests/decoder/cross.sh" || die "the decoder fails on another platform"
}

# The npm package and the viewer. What wants a browser, nginx or the gim program of another build skips, and says so, where
# there is none.
test_web() {
    local name damaged="$GIM_ROOT/build/web/damaged" tests="$GIM_ROOT/build/web/tests/web"
    install_packages "${GIM_WEB_PACKAGES[@]}"
    for name in node:nodejs npm:npm chromium:chromium; do
        command -v "${name%%:*}" >/dev/null || (install_packages "${name##*:}") || say "Skipped: no ${name%%:*}"
    done
    command -v node >/dev/null && command -v npm >/dev/null ||
        { say "Skipped: the npm package stays untested" && return 0; }
    configure_and_build web
    "$tests/write_damaged" "$GIM_ROOT/spec/vectors" "$damaged" || die "write_damaged failed"
    "$tests/write_refined" "$GIM_ROOT/spec/vectors" "$damaged" "$GIM_ROOT/build/web/refined" || die "write_refined failed"
    bash "$GIM_ROOT/tools/npm.sh" || die "building the npm package failed"
    cd "$GIM_ROOT/tests/web"
    [ node_modules/.package-lock.json -nt package-lock.json ] || npm ci --no-audit --no-fund ||
        { say "Skipped: npm cannot fetch the bundlers, so the npm package stays untested" && return 0; }
    bash "$GIM_ROOT/tools/viewer/build.sh" || die "building the viewer's page failed"
    say "Tests of the npm package"
    GIM_CHROMIUM="$(command -v chromium || true)" node --test --test-reporter=spec || die "the tests of the npm package failed"
}

case "${1:-}" in
    "") ;;
    gltf) test_gltf && exit 0 ;;
    gpu) test_gpu && exit 0 ;;
    packages) test_packages && exit 0 ;;
    cross) test_cross && exit 0 ;;
    cluster) (test_cluster) || exit 1; exit 0 ;;
    web) (test_web) || exit 1; exit 0 ;;
    *) die "usage: bash tools/test.sh [gltf | gpu | web | packages | cross | cluster]" ;;
esac

install_packages "${GIM_BUILD_PACKAGES[@]}" "${GIM_PYTHON_PACKAGES[@]}" libbenchmark-dev clang clang-format-14
bash "$GIM_ROOT/tools/lint.sh" --format-only
configure_and_build ci -DGIM_BUILD_BENCHMARKS=ON

configure_and_build sanitize
say "Tests of format and decoder under the sanitizers"
(cd "$GIM_ROOT" && ctest --preset sanitize -j"$(nproc)" --quiet) ||
    die "the tests under the sanitizers failed; run: ctest --preset sanitize"

configure_and_build fuzz
shopt -s nullglob
# Seeds of a fuzz target: of a mesh reader those of its format, and the cases beside the repository if they are there.
seeds_of() {
    local format=${1%_fuzz}
    if [ -d "$GIM_ROOT/tests/fuzz/seeds/$format" ]; then
        printf '%s\n' "$GIM_ROOT/tests/fuzz/seeds/$format"
        [ ! -d "$GIM_ROOT/../shared/cases" ] || printf '%s\n' "$GIM_ROOT/../shared/cases"
    else
        printf '%s\n' "$GIM_ROOT"/spec/vectors/{valid,invalid}
    fi
}

while read -r target; do
    mapfile -t seeds < <(seeds_of "$(basename "$target")")
    say "Fuzzing $(basename "$target") for $FUZZ_SECONDS s"
    corpus="$GIM_ROOT/build/fuzz/corpus/$(basename "$target")"
    mkdir -p "$corpus"
    "$target" -max_total_time="$FUZZ_SECONDS" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
        -artifact_prefix="$GIM_ROOT/build/fuzz/" "$corpus" "${seeds[@]}" 2>"$corpus.log" ||
        { tail -40 "$corpus.log" && die "$(basename "$target") found a failure; see build/fuzz/crash-*"; }
    grep -E "stat::(number_of_executed_units|average_exec_per_sec)" "$corpus.log" || true
done < <(find "$GIM_ROOT/build/fuzz" -type f -name '*_fuzz' -perm -u+x | sort)

(fetch_validator)
say "All tests"
cd "$GIM_ROOT"
exec ctest --preset ci -j"$(nproc)"
