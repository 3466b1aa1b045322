#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Builds the engine for aarch64 with Debian's cross compiler, without TBB, and runs it in qemu: surfaces of grids of all kinds of cells
# are the program's, byte for byte.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

if (($# > 1)) || [[ ${1:-} == -* ]]; then
    echo "usage: $0 [FOLDER]    (build/portable); ISOTET_PROGRAM names another program than that of scripts/test.sh" >&2
    [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0
    exit 2
fi
folder=$(realpath -m "${1:-$root/build/portable}")
readonly folder program=${ISOTET_PROGRAM:-$root/build/test/release/apps/cli/isotet}

install_packages cmake ninja-build libfmt-dev g++-aarch64-linux-gnu qemu-user || exit
mkdir -p "$folder"
use_ccache
cmake -G Ninja -S "$root/tests/portable" -B "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_SYSTEM_NAME=Linux \
    -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ >"$folder/configure.log"
cmake --build "$folder" -j "$(jobs_that_fit)"
python3 -B "$root/tests/portable/compare.py" "$program" qemu-aarch64 "$folder/extract_made"
