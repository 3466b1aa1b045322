#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Builds isotet as WebAssembly with clang-19 and Debian's C and C++ libraries for wasm32-wasi, SIMD of 128 bits:
# FOLDER/isotet.wasm, which `isotet export --as grid` puts into pages, FOLDER/isotet_readers.wasm, for `isotet page`, and the package
# FOLDER/npm, isotet.js for other pages. Give the first, with the second beside it, to a build by -DISOTET_WEB_MODULE=FOLDER/isotet.wasm.
# Then compares with a program, where ISOTET_PROGRAM names one: surfaces by Node; and where npm is installed, in Chromium, threads, WebGPU, the
# examples with three.js and vtk.js, and the program's pages against the rules of axe-core.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"
source "$root/scripts/lib/software_vulkan.sh"
source "$root/scripts/lib/web_libraries.sh"

if (($# > 1)) || [[ ${1:-} == -* ]]; then
    echo "usage: $0 [FOLDER]    (build/web)" >&2
    [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0
    exit 2
fi
folder=$(realpath -m "${1:-$root/build/web}")
readonly folder

install_packages cmake ninja-build libfmt-dev nlohmann-json3-dev "${packages_for_web[@]}" || exit
mkdir -p "$folder"
web_libraries_in "$folder/libraries"
use_ccache
cmake -G Ninja -S "$root/src/web" -B "$folder" -DCMAKE_TOOLCHAIN_FILE="$root/cmake/wasm.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DISOTET_WASM_ROOT="${ISOTET_WASM_ROOT:-}" -DISOTET_WEB_LIBRARIES="$folder/libraries" >"$folder/configure.log"
cmake --build "$folder" -j "$(jobs_that_fit)"
cmake -G Ninja -S "$root/src/web" -B "$folder/threads" -DCMAKE_TOOLCHAIN_FILE="$root/cmake/wasm.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DISOTET_WASM_ROOT="${ISOTET_WASM_ROOT:-}" -DISOTET_WEB_WORKERS=ON >"$folder/configure_threads.log"
cmake --build "$folder/threads" -j "$(jobs_that_fit)"
cp "$folder/threads/isotet_engine_threads.wasm" "$folder/npm"
for module in isotet isotet_readers npm/isotet_engine npm/isotet_engine_threads npm/isotet_engine_readers; do
    say "$module.wasm: $(stat -c %s "$folder/$module.wasm") bytes, $(gzip -9 <"$folder/$module.wasm" | wc -c) compressed"
done
if [[ -z ${ISOTET_PROGRAM:-} ]]; then exit; fi
node "$root/tests/web/module_test.mjs" "$folder/isotet.wasm" "$ISOTET_PROGRAM"
node "$root/tests/web/readers_test.mjs" "$folder/isotet_readers.wasm" "$ISOTET_PROGRAM"
node "$root/tests/web/npm_test.mjs" "$folder/npm" "$ISOTET_PROGRAM"
node "$root/tests/web/threads_test.mjs" "$folder/npm" "$ISOTET_PROGRAM"
if ! command -v npm >/dev/null; then exit; fi
mkdir -p "$folder/libraries"
npm install --prefix "$folder/libraries" --no-save --no-audit --no-fund --ignore-scripts --silent three vtk.js axe-core
python3 -B "$root/tests/web/threads_test.py" "$folder/npm"
python3 -B "$root/tests/web/webgpu_test.py" "$folder/npm" "$ISOTET_PROGRAM"
python3 -B "$root/tests/web/examples_test.py" "$folder/npm" "$folder/libraries/node_modules"
python3 -B "$root/tests/web/accessible_test.py" "$folder/libraries/node_modules/axe-core/axe.min.js" "$ISOTET_PROGRAM"
