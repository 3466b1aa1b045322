# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Sources of the libraries that isotet's readers need as WebAssembly: those of Debian 12, for it has them compiled for processors
# only. Sourced, never run; needs common.sh, packages.sh and software_vulkan.sh (debian_mirror).

readonly web_libraries=(
    "p/pugixml/pugixml_1.13.orig.tar.gz 5c5ad5d7caeb791420408042a7d88c2c6180781bf218feca259fd9d840a888e1"
    "libd/libdeflate/libdeflate_1.14.orig.tar.gz 89e7df898c37c3427b0f39aadcf733731321a278771d20fc553f92da8d4808ac"
    "l/lz4/lz4_1.9.4.orig.tar.gz 0b0e3aa07c8c063ddf40b082bdf7e37a1562bda40a0ff5272957f3e987e0e54b"
    "x/xz-utils/xz-utils_5.4.1.orig.tar.xz 5d9827aa1875b21c288f78864bb26d2650b436ea8d2cad364e4921eb6266a5a5")

download_web_libraries() {
    local to=$1 mirror line path check
    rm -rf "$to"
    mkdir -p "$to"
    mirror=$(debian_mirror)
    if [[ -z $mirror ]]; then
        echo "apt's configuration names no mirror of bookworm" >&2
        return 1
    fi
    for line in "${web_libraries[@]}"; do
        read -r path check <<<"$line"
        /usr/lib/apt/apt-helper -o APT::Sandbox::User= -o Acquire::Retries=3 download-file \
            "${mirror}pool/main/$path" "$to/${path##*/}" "SHA256:$check" || return
        tar -xf "$to/${path##*/}" -C "$to" || return
        rm "$to/${path##*/}"
    done
    touch "$to/done" # last: all is there
}

# web_libraries_in FOLDER: downloads once.
web_libraries_in() {
    if [[ -e $1/done ]]; then return; fi
    say "web: gets the sources of pugixml, libdeflate, LZ4 and liblzma"
    in_log "web: sources" "$1.log" download_web_libraries "$1"
}
