#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Makes a release of what is committed, in build/release: source archive, Debian package, wheel, isotet.js as a package for npm,
# checksums; then the tag. Without a compiler for WebAssembly it says so, and leaves isotet.js and the modules of pages out.
# Everything is built from the archive, and the package is installed on a fresh Debian 12, which needs root. A name of the
# release that is taken, files that are not committed, a list of changes without the release, and a failed test end it.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

tests=yes tag=yes
for option; do
    case $option in
    --no-tests) tests=no ;;
    --no-tag) tag=no ;;
    *)
        echo "usage: $0 [--no-tests] [--no-tag]" >&2
        [[ $option == -h || $option == --help ]] && exit 0
        exit 2
        ;;
    esac
done

cd "$root"
version=$(sed -n 's/^project(isotet VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
readonly version out=$root/build/release
readonly source=$out/isotet-$version debian=$out/debian

check_tree() {
    if [[ -n $(git status --porcelain) ]]; then
        fail "files are changed or new, but a release is of what is committed"
        return 1
    fi
    if [[ $tag == no ]]; then return; fi
    if git rev-parse -q --verify "refs/tags/v$version" >/dev/null; then
        fail "v$version is tagged already: CMakeLists.txt names the version"
        return 1
    fi
    if ! grep -qE "^## $version, [0-9]{4}-[0-9]{2}-[0-9]{2}\$" CHANGELOG.md; then
        fail "CHANGELOG.md has no '## $version, YEAR-MONTH-DAY'"
        return 1
    fi
}

make_archive() {
    rm -rf "$out"
    mkdir -p "$out"
    git archive --prefix="isotet-$version/" HEAD | xz -T0 >"$out/isotet-$version.tar.xz" || return
    tar -xf "$out/isotet-$version.tar.xz" -C "$out"
}

# isotet.js as `npm install FILE` takes it, and the modules that the program puts into pages.
make_web() {
    if ! install_packages "${packages_for_web[@]}"; then
        say "no isotet.js, and no pages with a grid: the packages named above are missing. Unpacked elsewhere: ISOTET_PACKAGES=present ISOTET_WASM_ROOT=FOLDER $0"
        return
    fi
    in_log "isotet.js" "$out/web.log" env -u ISOTET_PROGRAM "$source/scripts/web.sh" "$out/web" || return
    tar -czf "$out/isotet-js-$version.tgz" -C "$out/web" --owner=0 --group=0 --transform 's,^npm,package,' npm || return
    web_module=(-DISOTET_WEB_MODULE="$out/web/isotet.wasm")
}

# With the program that was built around it.
try_web() {
    if ((${#web_module[@]} == 0)); then return; fi
    ISOTET_PROGRAM=$out/tree/apps/cli/isotet in_log "isotet.js: tests" "$out/web_tests.log" "$source/scripts/web.sh" "$out/web"
}

make_package() {
    build_source=$source build release "$out/tree" -DCMAKE_BUILD_TYPE=Release -DISOTET_TESTS=OFF "${web_module[@]}" || return
    in_log "Debian package" "$out/package.log" cpack --config "$out/tree/CPackConfig.cmake" -B "$out" || return
    rm -rf "$out/_CPack_Packages"
}

# The mirror that this machine uses.
mirror() {
    apt-get indextargets --format "\$(ORIGIN)|\$(CODENAME)|\$(REPO_URI)" 'Created-By: Packages' |
        sed -n 's/^Debian|bookworm|//p' | head -n 1
}

# Reads a file by the program itself, and one by isotet-reader.
try_package() {
    say "installs the package on a fresh Debian 12"
    rm -rf "$debian"
    in_log "fresh Debian" "$out/debian.log" debootstrap --variant=minbase bookworm "$debian" "$(mirror)" || return
    cp "$out"/isotet_*.deb "$source/data/vtu/artery_flow_tet_wedge.vtu" "$source/data/exodus/mixed_blocks_hdf5.exo" "$debian/tmp" || return
    cp /etc/resolv.conf "$debian/etc"
    in_log "trying the package" "$out/try.log" chroot "$debian" sh -ec '
        cd /tmp
        apt-get update
        DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends ./isotet_*.deb
        isotet --version
        isotet extract artery_flow_tet_wedge.vtu artery.stl -f Umag -i 0.2 --solid above
        isotet check artery.stl --closed
        isotet info mixed_blocks_hdf5.exo
        isotet render artery_flow_tet_wedge.vtu -o artery.png
        test -s /usr/share/man/man1/isotet.1 || test -s /usr/share/man/man1/isotet.1.gz
        ! ldd /usr/bin/isotet /usr/bin/isotet-reader | grep -E "libvtk|not found"' || return
    rm -rf "$debian"
}

make_wheel() {
    cmake --install "$out/tree" --prefix "$out/prefix" >"$out/install.log" || return
    ISOTET_INSTALLED=$out/prefix in_log "wheel" "$out/wheel.log" "$source/scripts/wheel.sh" "$out/wheel" || return
    cp "$out"/wheel/dist/* "$out"
}

check_tree || exit
say "isotet $version"
install_packages "${packages_to_build[@]}" "${packages_for_python[@]}" debootstrap dpkg-dev xz-utils || exit
use_ccache
if [[ $tests == yes ]]; then in_log "tests" "$root/build/release.tests.log" "$root/scripts/test.sh" || exit; fi
make_archive || exit
web_module=()
make_web || exit
make_package || exit
if [[ $tests == yes ]]; then try_web || exit; fi
try_package || exit
make_wheel || exit
(cd "$out" && sha256sum -- *.t*z *.deb *.whl >SHA256SUMS && cat SHA256SUMS)
if [[ $tag == yes ]]; then git tag -a "v$version" -m "isotet $version" && say "tagged v$version"; fi
