#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Builds isotet as WebAssembly, FOLDER/isotet.wasm, which `isotet export --as grid` puts into pages: with clang-19 and Debian's
# C and C++ libraries for wasm32-wasi, one thread, SIMD of 128 bits. Then compares its surfaces with those of a program, where
# ISOTET_PROGRAM names one (nodejs is installed for that). Give the module to a build by -DISOTET_WEB_MODULE=FOLDER/isotet.wasm.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

if (($# > 1)) || [[ ${1:-} == -* ]]; then
    echo "usage: $0 [FOLDER]    (build/web)" >&2
    [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0
    exit 2
fi
folder=$(realpath -m "${1:-$root/build/web}")
readonly folder

install_packages cmake ninja-build libfmt-dev nlohmann-json3-dev "${packages_for_web[@]}" || exit
mkdir -p "$folder"
cmake -G Ninja -S "$root/src/web" -B "$folder" -DCMAKE_TOOLCHAIN_FILE="$root/cmake/wasm.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DISOTET_WASM_ROOT="${ISOTET_WASM_ROOT:-}" >"$folder/configure.log"
cmake --build "$folder" -j "$(jobs_that_fit)"
say "$folder/isotet.wasm: $(stat -c %s "$folder/isotet.wasm") bytes, $(gzip -9 <"$folder/isotet.wasm" | wc -c) compressed"
if [[ -n ${ISOTET_PROGRAM:-} ]]; then node "$root/tests/web/module_test.mjs" "$folder/isotet.wasm" "$ISOTET_PROGRAM"; fi
