# Sourced by the other scripts of this folder. Installs missing Debian packages, reports progress, finds the tree.
# Needs only bash, git and apt. Calls apt only if a package is missing.

GIM_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly GIM_ROOT

readonly GIM_BUILD_PACKAGES=(
    g++ cmake ninja-build pkg-config
    libeigen3-dev libopenmesh-dev liblemon-dev libtbb-dev libzstd-dev
    libcli11-dev nlohmann-json3-dev libopenexr-dev libdraco-dev libmeshoptimizer-dev libstb-dev libcpp-httplib-dev libzip-dev
    libsqlite3-dev libxxhash-dev
    libepoxy-dev libegl-dev libegl-mesa0 libgl1-mesa-dri
    libgtest-dev
)

# Of `tools/test.sh gpu`. The browser and node come from anywhere.
readonly GIM_GPU_PACKAGES=(
    g++ cmake ninja-build pkg-config libzstd-dev libgtest-dev
    libepoxy-dev libegl-dev libegl1 libegl-mesa0 libgl1-mesa-dri
)

# Of gim.py and its tests.
readonly GIM_PYTHON_PACKAGES=(python3 python3-numpy)

# Of tools/package.sh, besides what the build needs.
readonly GIM_PACKAGE_PACKAGES=(dpkg-dev debhelper dh-python python3)

# Of tools/npm.sh. The compiler and its libraries make WebAssembly; node and npm come from anywhere.
readonly GIM_NPM_PACKAGES=(
    clang-14 lld-14 wasi-libc libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32 binaryen brotli esbuild
)

# Of `tools/test.sh cross`.
readonly GIM_CROSS_PACKAGES=(
    gcc g++ clang g++-aarch64-linux-gnu g++-arm-linux-gnueabihf g++-s390x-linux-gnu qemu-user
)

# Of `tools/test.sh cluster`.
readonly GIM_CLUSTER_PACKAGES=(slurmctld slurmd slurm-client munge python3)

# Of `tools/test.sh web`, besides those of tools/npm.sh.
readonly GIM_WEB_PACKAGES=(g++ cmake ninja-build pkg-config libzstd-dev libgtest-dev)

say() { printf '\n== %s\n' "$*"; }
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        die "packages are missing; run as root: apt-get install --no-install-recommends $GIM_MISSING"
    fi
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# install_packages NAME...: does nothing if all of them are installed.
install_packages() {
    local missing=() name
    command -v dpkg-query >/dev/null || die "this script knows only Debian's packages; install these by hand: $*"
    for name in "$@"; do
        is_installed "$name" || missing+=("$name")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    GIM_MISSING="${missing[*]}"
    say "Installing ${#missing[@]} Debian packages: $GIM_MISSING"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq update ||
        die "'apt-get update' failed (is the network up?); run this script again when it works"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${missing[@]}" ||
        die "apt-get cannot install: $GIM_MISSING (needs Debian 12 or newer); install them and run this script again"
}

# configure PRESET [cmake options]: in build/PRESET, with ccache if it is installed.
configure() {
    local preset=$1
    shift
    local launcher=()
    command -v ccache >/dev/null && launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    (cd "$GIM_ROOT" && cmake --preset "$preset" --log-level=WARNING "${launcher[@]}" "$@") ||
        die "configuring the preset '$preset' failed"
}

# build PRESET [TARGET...]: what is configured.
build() {
    local preset=$1
    shift
    export CCACHE_SLOPPINESS=pch_defines,time_macros # else ccache keeps nothing that uses a precompiled header
    (cd "$GIM_ROOT" && cmake --build --preset "$preset" ${1:+--target "$@"}) || die "building the preset '$preset' failed"
}

# configure_and_build PRESET [cmake options]
configure_and_build() {
    say "Building the preset '$1'"
    configure "$@"
    build "$1"
}
