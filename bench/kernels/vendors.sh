#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# What the shader compilers of five vendors make of the kernels, without a card: drivers of Mesa start on its fake kernel devices
# (drm-shim). The drivers of AMD, Intel and NVIDIA come from Debian 13 in a folder of its own, with the shims for AMD and
# NVIDIA; Intel's shim, and all for Qualcomm and Arm, is built from Debian's source. Needs root once, for that folder.
source "$(dirname "${BASH_SOURCE[0]}")/../../scripts/lib/common.sh"
source "$root/scripts/lib/packages.sh"
source "$root/scripts/lib/software_vulkan.sh"

readonly vendors=$root/build/vendors
readonly debian=$vendors/root built=$vendors/root/root/built ready=$vendors/ready results=$vendors/results
readonly libraries=$debian/usr/lib/x86_64-linux-gnu
readonly devices=(skl dg2 bmg a660 a740 ampere g610 navi31 vega10)
readonly release=trixie not_there=77

# Of Debian 13, for the folder: what Mesa is built with, and the drivers that need no building.
readonly packages=(g++ pkgconf meson ninja-build python3-mako python3-yaml python3-ply python3-packaging bison flex glslang-tools
    spirv-tools libdrm-dev libelf-dev zlib1g-dev libzstd-dev libexpat1-dev libvulkan-dev llvm-19-dev libclang-cpp19-dev
    libclang-19-dev libclc-19-dev libllvmspirvlib-19-dev libarchive-dev liblua5.4-dev dpkg-dev mesa-vulkan-drivers mesa-drm-shim)
readonly mesa_options=(--buildtype=plain -Doptimization=1 -Db_ndebug=true -Dplatforms= -Dgallium-drivers=
    -Dvulkan-drivers=freedreno,panfrost -Dtools=drm-shim,intel -Dglx=disabled -Degl=disabled -Dgbm=disabled -Dopengl=false
    -Dgles1=disabled -Dgles2=disabled -Dllvm=enabled -Dvideo-codecs= -Dfreedreno-kmds=msm -Dxmlconfig=disabled
    -Dintel-rt=disabled)
readonly mesa_targets=(src/intel/tools/libintel_noop_drm_shim.so
    src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so src/freedreno/vulkan/libvulkan_freedreno.so
    src/panfrost/drm-shim/libpanfrost_noop_drm_shim.so src/panfrost/vulkan/libvulkan_panfrost.so)

usage() {
    cat <<END
usage: $0 [all] [--against FOLDER]
           installs and builds what is missing, compiles every pipeline for each device, prints the tables
           all: a row for every set of constants; --against: results of another run, kept from $results
       $0 run DEVICE PROGRAM
           starts PROGRAM DRIVER on one of ${devices[*]}; ends with $not_there where they were never built
END
}

# The folder with Debian 13, from where this machine gets its Debian.
unpack_debian() {
    local mirror
    mirror=$(debian_mirror)
    if [[ -z $mirror ]]; then apt-get update && mirror=$(debian_mirror); fi
    if [[ -z $mirror ]]; then
        echo "apt's configuration names no mirror of bookworm" >&2
        return 1
    fi
    rm -rf --one-file-system "$debian"
    debootstrap --variant=minbase --include=ca-certificates "$release" "$debian" "$mirror" || return
    printf 'deb %s %s main\ndeb-src %s %s main\n' "$mirror" "$release" "$mirror" "$release" >"$debian/etc/apt/sources.list"
    chroot "$debian" apt-get update || return
    DEBIAN_FRONTEND=noninteractive chroot "$debian" apt-get install -y --no-install-recommends "${packages[@]}" || return
    touch "$vendors/unpacked"
}

build_mesa() {
    chroot "$debian" bash -c 'cd /root && rm -rf mesa-* built && apt-get source mesa && cd mesa-*/ &&
        meson setup /root/built "${@:2:$1}" && ninja -C /root/built "${@:$1+2}"' \
        bash ${#mesa_options[@]} "${mesa_options[@]}" "${mesa_targets[@]}"
}

prepare() {
    if [[ -e $ready ]]; then return; fi
    install_packages debootstrap "${packages_to_build[@]}" || return
    mkdir -p "$vendors"
    if [[ ! -e $vendors/unpacked ]]; then
        say "vendors: unpacks Debian 13 with what Mesa is built with"
        in_log "vendors: Debian 13" "$vendors/debian.log" unpack_debian || return
    fi
    say "vendors: builds Mesa's fake devices, and the drivers that Debian does not build for this machine"
    in_log "vendors: Mesa" "$vendors/mesa.log" build_mesa || return
    touch "$ready"
}

# run DEVICE PROGRAM: with the C library and the driver of Debian 13, and the machine's own libraries where that has none.
run() {
    local driver shim settings=(MESA_SHADER_CACHE_DISABLE=true)
    if [[ ! -e $ready ]]; then
        fail "no fake devices in $vendors: $0 builds them"
        return "$not_there"
    fi
    case $1 in
        skl | dg2 | bmg)
            driver=$libraries/libvulkan_intel.so shim=$built/src/intel/tools/libintel_noop_drm_shim.so
            settings+=(INTEL_STUB_GPU_PLATFORM="$1") ;;
        a660 | a740)
            driver=$built/src/freedreno/vulkan/libvulkan_freedreno.so
            shim=$built/src/freedreno/drm-shim/libfreedreno_noop_drm_shim.so
            settings+=(FD_GPU_ID="${1#a}") ;;
        ampere)
            driver=$libraries/libvulkan_nouveau.so shim=$libraries/libnouveau_noop_drm_shim.so
            settings+=(NOUVEAU_CHIPSET=172) ;;
        g610)
            driver=$built/src/panfrost/vulkan/libvulkan_panfrost.so
            shim=$built/src/panfrost/drm-shim/libpanfrost_noop_drm_shim.so
            settings+=(PAN_GPU_ID=a867 BIFROST_MESA_DEBUG=shaderdb) ;;
        navi31 | vega10)
            driver=$libraries/libvulkan_radeon.so shim=$libraries/libamdgpu_noop_drm_shim.so
            settings+=(AMDGPU_GPU_ID="$1") ;;
        *)
            fail "no device $1: there are ${devices[*]}"
            return 2 ;;
    esac
    env "${settings[@]}" "$debian/lib64/ld-linux-x86-64.so.2" --library-path "$libraries:/usr/lib/x86_64-linux-gnu" \
        --preload "$shim" "$2" "$driver"
}

# Every pipeline for one device; nothing that the driver writes is lost, since one of them tells spills only there.
compile_for() {
    run "$1" "$vendors/tree/bench/isotet_device_kernels" >"$results/$1.txt" 2>&1 && return
    fail "$1 does not take all pipelines:"
    grep -A1 -E '^(pipeline|unusable)' "$results/$1.txt" | grep -B1 -E '^(unusable|refused)' >&2 || tail "$results/$1.txt" >&2
    return 1
}

tables() {
    local device status=0
    prepare || return
    use_ccache
    build_target=isotet_device_kernels build vendors "$vendors/tree" -DCMAKE_BUILD_TYPE=Release -DISOTET_BENCH=ON \
        -DISOTET_TESTS=OFF -DISOTET_IO=OFF -DISOTET_VTK=OFF || return
    mkdir -p "$results"
    for device in "${devices[@]}"; do
        say "vendors: compiles for $device"
        compile_for "$device" || status=1
    done
    python3 "$root/bench/kernels/vendors.py" "$results" "$@" || status=1
    return "$status"
}

case ${1:-} in
    -h | --help) usage ;;
    run)
        if (($# != 3)); then usage >&2 && exit 2; fi
        run "$2" "$3" ;;
    *) tables "$@" ;;
esac
