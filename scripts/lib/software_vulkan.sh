# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# A software Vulkan device that can be trusted: Mesa's lavapipe 25 or later, from the backports of Debian 12, unpacked
# beside the tests. Debian 12's own, 22.3, ends long loops early without a word. Nothing is installed: the machine keeps
# its own Mesa, its lists and its configuration. Sourced, never run; needs common.sh and packages.sh.

# Where this machine gets Debian 12 from; empty where apt has read no lists yet. Options of apt-get may follow.
debian_mirror() {
    apt-get "$@" indextargets --format '$(ORIGIN)|$(RELEASE)|$(REPO_URI)' 'Created-By: Packages' |
        sed -n 's/^Debian|bookworm|//p' | head -n 1
}

unpack_software_vulkan() {
    local folder=$1 keyring=/usr/share/keyrings/debian-archive-keyring.gpg option= mirror driver
    rm -rf "$folder"
    mkdir -p "$folder/lists/partial"
    local options=(-o Dir::State::lists="$folder/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=
        -o APT::Sandbox::User= -o Acquire::Retries=3)
    mirror=$(debian_mirror)
    if [[ -z $mirror ]]; then
        apt-get "${options[@]}" update || return
        mirror=$(debian_mirror "${options[@]}")
    fi
    if [[ -z $mirror ]]; then
        echo "apt's configuration names no mirror of bookworm" >&2
        return 1
    fi
    if [[ -r $keyring ]]; then option="[signed-by=$keyring] "; fi
    echo "deb $option$mirror bookworm-backports main" >"$folder/sources.list"
    options+=(-o Dir::Etc::SourceList="$folder/sources.list" -o Dir::Etc::SourceParts=-)
    apt-get "${options[@]}" update || return
    (cd "$folder" && apt-get "${options[@]}" download mesa-vulkan-drivers/bookworm-backports) || return
    dpkg -x "$folder"/mesa-vulkan-drivers_*.deb "$folder/root" || return
    driver=$(echo "$folder"/root/usr/lib/*/libvulkan_lvp.so)
    if ldd "$driver" | grep 'not found'; then
        echo "these libraries are missing, and $driver needs them" >&2
        return 1
    fi
    printf '{"file_format_version": "1.0.0", "ICD": {"api_version": "1.3.0", "library_path": "%s"}}\n' "$driver" \
        >"$folder/lavapipe.json" || return
    rm -rf "$folder/lists" "$folder"/*.deb
    # Compiled shaders, Mesa's and ours, are kept here, not in the user's folder. This file comes last: it says that all is there.
    printf 'export VK_DRIVER_FILES=%q\nexport XDG_CACHE_HOME=%q\n' "$folder/lavapipe.json" "$folder/cache" >"$folder/env.sh"
}

# software_vulkan FOLDER: unpacks once, and lets everything that is started later use it. On other systems than Debian 12
# the machine's own Vulkan stays; the tests say so themselves if it is too old.
software_vulkan() {
    if ! on_debian_12; then return; fi
    if [[ ! -e $1/env.sh ]]; then
        say "vulkan: unpacks Mesa's software device from bookworm-backports"
        in_log "vulkan: Mesa" "$1.log" unpack_software_vulkan "$1" || return
    fi
    # shellcheck source=/dev/null
    source "$1/env.sh"
}
