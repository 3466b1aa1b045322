#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# The package has program, reader and man pages, needs no VTK, and what is in it reads a file of isotet-reader's.
#     debian_package.sh BUILD_TREE FOLDER FILE
set -euo pipefail
build=$1 folder=$2 file=$3
rm -rf "$folder"
mkdir -p "$folder"
cpack --config "$build/CPackConfig.cmake" -B "$folder" >"$folder/log" || { cat "$folder/log"; exit 1; }
package=$(echo "$folder"/isotet_*.deb)
needs=$(dpkg-deb -f "$package" Depends)
[[ $needs == *libtbb12* && $needs != *libvtk* ]] || { echo "it needs $needs"; exit 1; }
dpkg-deb -x "$package" "$folder/root"
test -s "$folder/root/usr/share/man/man1/isotet-extract.1"
test ! -e "$folder/root/usr/include"
"$folder/root/usr/bin/isotet" info "$file" | grep exodus
