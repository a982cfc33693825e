#!/usr/bin/env bash
# Makes the Debian packages gim, libgim-decoder0, libgim-dev, python3-gim and gim-doc, and checks them with lintian. They
# are in build/package, or in FOLDER/package. Needs Debian 12 or newer.
# Usage: bash tools/package.sh              builds everything as dpkg-buildpackage does; ten minutes on two cores
#        bash tools/package.sh --twice      builds a second time in another folder; the packages must have the same bytes
#        bash tools/package.sh --from FOLDER    packages what is built in FOLDER, as build/ci; a minute
# FOLDER has to be configured with CMAKE_INSTALL_PREFIX=/usr, as the preset `ci` is.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

out="$GIM_ROOT/build/package"
built=
twice=no
case "${1:-}" in
    "") ;;
    --twice) twice=yes ;;
    --from)
        built=$(cd "${2:?--from needs a folder}" && pwd) || die "no such folder: $2"
        grep -q '^CMAKE_INSTALL_PREFIX:PATH=/usr$' "$built/CMakeCache.txt" ||
            die "$built is not configured with CMAKE_INSTALL_PREFIX=/usr"
        out="$built/package"
        ;;
    *) die "usage: bash tools/package.sh [--twice | --from FOLDER]" ;;
esac

# copy_tree FOLDER: the tracked files as they are, with tools/debian as debian/, and the page of gim view if it is built.
copy_tree() {
    rm -rf "$1"
    mkdir -p "$1"
    (cd "$GIM_ROOT" && git ls-files -z | tar -c --null --files-from=- --ignore-failed-read) | tar -x -C "$1"
    cp -a "$1/tools/debian" "$1/debian"
    if [ -d "$GIM_ROOT/build/viewer" ]; then
        mkdir "$1/build"
        cp -a "$GIM_ROOT/build/viewer" "$1/build"
    else
        say "The page of gim view is not in the packages: tools/viewer/build.sh has not built it"
    fi
}

# prepare FOLDER NAME: an empty folder with the tree NAME.
prepare() {
    mkdir -p "$1"
    rm -f "$1"/*.deb "$1"/*.changes "$1"/*.buildinfo
    copy_tree "$1/$2"
}

# build_in FOLDER NAME: the packages, in FOLDER.
build_in() {
    say "Building the packages in $1/$2"
    (
        cd "$1/$2"
        [ -z "$built" ] || export GIM_BUILD_DIR="$built" DEB_BUILD_OPTIONS="noautodbgsym nocheck"
        dpkg-buildpackage --build=binary --no-sign ${built:+--no-check-builddeps} >"$1/build.log" 2>&1
    ) || { tail -40 "$1/build.log" && die "dpkg-buildpackage failed; see $1/build.log"; }
}

check_version() {
    local of_project of_packages
    of_project=$(sed -n 's/^project(gim VERSION \([0-9.]*\).*/\1/p' "$GIM_ROOT/CMakeLists.txt")
    of_packages=$(dpkg-parsechangelog -l "$GIM_ROOT/tools/debian/changelog" -S Version)
    [ "$of_project" = "$of_packages" ] ||
        die "tools/debian/changelog has the version $of_packages, CMakeLists.txt $of_project"
}

# Under root, lintian wants to be asked.
check_with_lintian() {
    say "lintian"
    if ! command -v lintian >/dev/null && ! (install_packages lintian); then
        say "Skipped: no lintian"
        return 0
    fi
    lintian --allow-root --fail-on error,warning --tag-display-limit 0 "$out"/*.changes || die "lintian has complaints"
}

compare_builds() {
    local package
    for package in "$out"/*.deb; do
        cmp "$package" "$out/again/$(basename "$package")" || die "a second build gives other bytes; diffoscope tells more"
    done
    say "Both builds have the same bytes"
}

if [ -n "$built" ]; then
    install_packages "${GIM_PACKAGE_PACKAGES[@]}"
else
    install_packages "${GIM_PACKAGE_PACKAGES[@]}" "${GIM_BUILD_PACKAGES[@]}" "${GIM_PYTHON_PACKAGES[@]}"
fi
check_version
prepare "$out" gim
[ "$twice" = no ] || prepare "$out/again" gim-again # the same files, whatever happens to the tree meanwhile
build_in "$out" gim
check_with_lintian
if [ "$twice" = yes ]; then
    build_in "$out/again" gim-again
    compare_builds
fi
say "Packages"
ls -l "$out"/*.deb
