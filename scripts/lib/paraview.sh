# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Debian's ParaView beside the tests: python3-paraview and libvtk9-dev cannot be installed together. Its packages are
# unpacked into a folder; the libraries that they need come with those of libvtk9-dev. Nothing is installed, and no list or
# configuration of apt is changed. Sourced, never run; needs common.sh.

readonly paraview_packages=(paraview paraview-dev python3-paraview)

# With the machine's lists where it has some, else with lists of our own.
download_paraview() {
    local folder=$1 options=(-o APT::Sandbox::User= -o Acquire::Retries=3)
    cd "$folder" || return
    if apt-get "${options[@]}" download "${paraview_packages[@]}"; then return; fi
    mkdir -p "$folder/lists/partial"
    options+=(-o Dir::State::lists="$folder/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=)
    apt-get "${options[@]}" update && apt-get "${options[@]}" download "${paraview_packages[@]}"
}

unpack_paraview() {
    local folder=$1 package
    rm -rf "$folder"
    mkdir -p "$folder"
    (download_paraview "$folder") || return
    for package in "$folder"/*.deb; do dpkg -x "$package" "$folder/root" || return; done
    rm -rf "$folder/lists" "$folder"/*.deb
    local libraries
    libraries=$(echo "$folder"/root/usr/lib/*-linux-gnu)
    if LD_LIBRARY_PATH=$libraries ldd "$folder/root/usr/bin/pvbatch" "$folder"/root/usr/lib/python3/dist-packages/paraview/modules/*.so |
        grep 'not found'; then
        echo "these libraries are missing, and ParaView needs them" >&2
        return 1
    fi
    touch "$folder/done" # last: all is there
}

# paraview FOLDER: unpacks once.
paraview() {
    if [[ -e $1/done ]]; then return; fi
    say "paraview: unpacks ${paraview_packages[*]}"
    in_log "paraview: unpacking" "$1.log" unpack_paraview "$1"
}
