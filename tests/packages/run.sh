#!/usr/bin/env bash
# Installs the packages in an empty Debian and uses them there (try.sh). Where mmdebstrap or the network is missing, it
# unpacks them into a folder and uses them from there, and says so. Usage: run.sh FOLDER-OF-PACKAGES
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/setup.sh"
packages=$(cd "$1" && pwd)
readonly packages HERE="$GIM_ROOT/tests/packages"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"

# Makes the empty Debian, installs, runs. Leaves $work/begun if there was an empty Debian.
try_installed() {
    mkdir -m 777 "$work/marks"
    mkdir "$work/files"
    cp "$packages"/*.deb "$HERE/try.sh" "$GIM_ROOT"/tests/consumer/main.{c,cpp} "$work/files"
    rm -f "$work"/files/*dbgsym*
    mmdebstrap --quiet --variant=apt --format=null --dpkgopt=force-unsafe-io \
        --customize-hook="touch '$work/marks/begun'" \
        --customize-hook="mkdir \"\$1/files\"" \
        --customize-hook="copy-in $(printf '%s ' "$work"/files/*) /files" \
        --customize-hook='chroot "$1" sh -c "apt-get -qq install --yes --no-install-recommends g++ pkg-config /files/*.deb"' \
        --customize-hook='chroot "$1" env -i PATH=/usr/bin:/bin sh /files/try.sh /files' \
        "$(. /etc/os-release && echo "$VERSION_CODENAME")" /dev/null >"$work/log" 2>&1
}

# The programs of this machine, with paths to the folder. Needs the libraries that the packages depend on.
try_unpacked() {
    local package root="$work/root" libraries
    for package in "$packages"/*.deb; do dpkg-deb -x "$package" "$root"; done
    libraries=$(dirname "$(find "$root" -name 'libgim-decoder.so.0')")
    PATH="$root/usr/bin:$PATH" LD_LIBRARY_PATH="$libraries" PYTHONPATH="$root/usr/lib/python3/dist-packages" \
        SHARE="$root/usr/share" PKG_CONFIG_PATH="$libraries/pkgconfig" PKG_CONFIG_SYSROOT_DIR= \
        sh "$HERE/try.sh" "$GIM_ROOT/tests/consumer"
}

say "The packages in an empty Debian"
if ! command -v mmdebstrap >/dev/null && ! (install_packages mmdebstrap); then
    say "Skipped: no mmdebstrap. The packages are unpacked instead"
    try_unpacked
elif try_installed; then
    sed -n '/^-- /,$p' "$work/log"
elif [ -e "$work/marks/begun" ]; then
    tail -60 "$work/log"
    die "the packages do not work in an empty Debian"
else
    tail -5 "$work/log"
    say "Skipped: mmdebstrap cannot make an empty Debian (is the network up?). The packages are unpacked instead"
    try_unpacked
fi
