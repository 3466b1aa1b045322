# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# The Debian packages that the project needs, and how missing ones get onto a Debian 12. Sourced, never run.

readonly packages_to_build=(g++ cmake ninja-build libtbb-dev libfmt-dev libmeshoptimizer-dev libfreetype-dev libpng-dev libwebp-dev libcli11-dev nlohmann-json3-dev libboost-dev libjpeg62-turbo-dev
    libpugixml-dev libdeflate-dev liblz4-dev liblzma-dev libxxhash-dev
    libhdf5-dev libcgns-dev libseccomp-dev glslc libvulkan-dev)
# What the software Vulkan device of software_vulkan.sh is linked with.
readonly packages_for_software_vulkan=(
    libdrm2 libexpat1 libllvm15 libwayland-client0 libx11-xcb1 libxcb-dri3-0 libxcb-present0 libxcb-randr0 libxcb-shm0
    libxcb-sync1 libxcb-xfixes0 libxcb1 libxshmfence1 libzstd1 zlib1g)
# What the tests of VTK's filter run in.
readonly packages_to_test_vtk=(python3-vtk9 python3-mpi4py python3-numpy openmpi-bin libopenmpi-dev)
# chromium: the browser of the tests of `isotet view`, and SwiftShader, a second software Vulkan device.
# zsh, fish: the shells that completions are tested in.
readonly packages_to_test=(ccache libvtk9-dev libgtest-dev pkg-config vulkan-validationlayers spirv-tools chromium zsh fish
    "${packages_for_software_vulkan[@]}" "${packages_to_test_vtk[@]}")
# Of scripts/web.sh: compiler and libraries for WebAssembly, and what runs its test. binaryen: clang runs its wasm-opt,
# where it is installed, which makes modules 5 % smaller.
readonly packages_for_web=(clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32
    wasi-libc binaryen nodejs)
readonly packages_for_python=(python3-dev python3-venv)
readonly packages_to_test_fully=("${packages_for_python[@]}" clang-19 clang-tidy-19 libclang-rt-19-dev xz-utils xvfb
    libgl1-mesa-dri)

missing_packages() {
    local package
    for package; do
        if [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
            printf '%s\n' "$package"
        fi
    done
}

on_debian_12() {
    [[ -r /etc/os-release ]] && (. /etc/os-release && [[ ${ID:-} == debian && ${VERSION_ID:-} == 12 ]])
}

# install_packages PACKAGE...: installs the ones that are missing, saying which, asking nothing. Returns 4 when it cannot.
install_packages() {
    if [[ ${ISOTET_PACKAGES:-} == present ]]; then return; fi
    if ! on_debian_12; then
        fail "this is not Debian 12, so nothing is installed. Needed, by their names in Debian 12: $*"
        fail "When they, or the same from elsewhere, are there: ISOTET_PACKAGES=present $0"
        return 4
    fi
    local missing
    mapfile -t missing < <(missing_packages "$@")
    if ((${#missing[@]} == 0)); then
        say "packages: all there"
        return
    fi
    local as_root=()
    if ((EUID != 0)); then
        if ! sudo -n true 2>/dev/null; then
            fail "missing packages, and neither root nor sudo without a password to install them. Please run:"
            fail "    apt-get install --no-install-recommends ${missing[*]}"
            return 4
        fi
        as_root=(sudo -n)
    fi
    say "packages: installs with apt-get, and what they depend on: ${missing[*]}"
    local log=$root/build/packages.log
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive NEEDRESTART_MODE=l
        apt-get -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
    if ! in_log "packages: apt-get update" "$log" "${apt[@]}" update ||
        ! in_log "packages: apt-get install" "$log" "${apt[@]}" install -y --no-install-recommends "${missing[@]}"; then
        fail "could not install ${missing[*]}"
        return 4
    fi
    say "packages: installed"
}
