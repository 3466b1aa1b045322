#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Builds and runs all tests: the release build; clang's build with the address and undefined-behaviour sanitizers, which also
# runs every fuzz target for a short time; the thread sanitizer; clang-tidy. `quick`: the release build only.
# The trees stand in build/test. What ctest says about all of them together comes last, below a table of where the time went.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"
source "$root/scripts/lib/paraview.sh"
source "$root/scripts/lib/software_vulkan.sh"
source "$root/scripts/lib/test_times.sh"
source "$root/scripts/lib/thread_sanitizer.sh"

readonly trees=$root/build/test

mode=${1:-full}
if (($# > 1)) || [[ $mode != full && $mode != quick ]]; then
    echo "usage: $0 [quick]    quick: release build only, no sanitizers, no fuzzing, no clang-tidy" >&2
    [[ $mode == -h || $mode == --help ]] && exit 0
    exit 2
fi

# What a sanitizer can say nothing about: these look at the tree, at installing, at the program, or count memory. And tests
# on a Vulkan device: drivers and layers leave memory behind and are unloaded, so that their leaks cannot be told from ours
# by name.
readonly not_for_address=(cli docs fuzz gpu_engine headers includes install memory paraview python render vtk vulkan)
# Of these, the tests that use several threads.
readonly for_thread='api;check;determinism;direct;draw;ops' threaded='*Thread*:*AtOnce*:InstructionLevels.*'

kinds_for_address() {
    local folder kinds=
    for folder in "$root"/tests/*/CMakeLists.txt; do
        folder=$(basename "$(dirname "$folder")")
        if [[ " ${not_for_address[*]} " != *" $folder "* ]]; then kinds+="$folder;"; fi
    done
    echo "${kinds%;}"
}

build_release() {
    local python=
    if [[ $mode == full ]]; then python=$trees/python/venv/bin/python; fi
    build release "$trees/release" -DCMAKE_BUILD_TYPE=Release -DISOTET_WERROR=ON -DISOTET_VTK=ON -DISOTET_TEST_PYTHON="$python"
}

# What other projects build against.
readonly prefix=$trees/prefix
install_release() {
    in_log "installs release" "$trees/install.log" cmake --install "$trees/release" --prefix "$prefix"
}

# The wheel, and the environment that its tests run in, which are tests of release. The library inside is that of release
# where its component io needs no VTK, else it is compiled once more.
build_python() {
    local installed=
    install_release || return
    if ! grep -q VTK "$prefix/lib/cmake/isotet/isotet-io.cmake"; then installed=$prefix; fi
    ISOTET_INSTALLED=$installed measured python "$root/scripts/wheel.sh" "$trees/python"
}

# The ParaView plugin, against the installed release and Debian's ParaView.
build_paraview() {
    local unpacked=$trees/paraview/unpacked wheel=$trees/paraview/wheel packages
    packages=$(echo "$trees"/python/venv/lib/python3*/site-packages)
    measured "paraview: unpack" paraview "$unpacked" || return
    install_release || return
    rm -rf "$wheel" # without the VTK of that environment
    mkdir -p "$wheel"
    ln -s "$packages"/isotet "$packages"/isotet.libs "$packages"/nanobind_backend* "$wheel" || return
    build_source=$root/paraview build paraview "$trees/paraview/build" -DCMAKE_BUILD_TYPE=Release -DISOTET_WERROR=ON \
        -DPython3_EXECUTABLE=/usr/bin/python3 -DCMAKE_PREFIX_PATH="$prefix" \
        -DParaView_DIR="$(echo "$unpacked"/root/usr/lib/*/cmake/paraview-*)" \
        -DISOTET_PARAVIEW_TESTS="$unpacked/root/usr" -DISOTET_PARAVIEW_WHEEL="$wheel"
}

# Without VTK: its readers run as uninstrumented children under a limit on address space that a sanitizer cannot live in.
# The library and its tests are a subfolder of the ten-line consumer here, so that add_subdirectory() needs no build of its own.
build_address() {
    CC=clang-19 CXX=clang++-19 build_source=$root/tests/install/consumer \
        build address "$trees/address" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS='-O1 -D_GLIBCXX_ASSERTIONS' \
        -DISOTET_TREE="$root" -DISOTET_WERROR=ON -DISOTET_FUZZ=ON -DISOTET_FUZZ_SECONDS=10 -DISOTET_IO=OFF \
        -DISOTET_TESTS=ON -DISOTET_TEST_PREFIX=address. -DISOTET_TEST_KINDS="$(kinds_for_address)"
}

build_thread() {
    thread_sanitizer_tbb "$trees/tbb" || return
    build_target=isotet_tests \
        build thread "$trees/thread" -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O1 -DISOTET_SANITIZE=thread \
        -DCMAKE_PREFIX_PATH="$trees/tbb/installed" -DISOTET_IO=OFF -DISOTET_VULKAN=OFF -DISOTET_PROGRAM=OFF \
        -DISOTET_TEST_PREFIX=thread. -DISOTET_TEST_KINDS="$for_thread" -DISOTET_TEST_FILTER="$threaded"
}

build_tidy() {
    say "tidy: reads the sources that release compiles"
    measured tidy in_log tidy "$trees/tidy.log" "$root/scripts/tidy.sh" "$trees/release"
}

# The device that the tests of the Vulkan engine run on.
build_mesa() {
    software_vulkan "$trees/mesa"
}

# try_stage NAME [TEST_FOLDER]: builds one tree, and adds its tests to the list of ctest, and one that says whether that
# went well: it prints what was wrong, for readers who see the failed tests alone.
try_stage() {
    local name=$1 folder=${2:-} why=$trees/$1.failed tests
    failed_log=/dev/null
    if "build_$name"; then
        tests="add_test([=[build.$name]=] true)"
        if [[ -n $folder ]]; then tests+=$'\n'"subdirs([=[$folder]=])"; fi
    else
        grep -E 'error: |Error |Killed|^FAILED' "$failed_log" | head -n 8 >"$why"
        tail -n 15 "$failed_log" >>"$why"
        tests="add_test([=[build.$name]=] sh -c [=[cat '$why'; exit 1]=])"
    fi
    echo "$tests" >>"$trees/CTestTestfile.cmake"
}

say "isotet tests, $mode"
packages=("${packages_to_build[@]}" "${packages_to_test[@]}")
if [[ $mode == full ]]; then packages+=("${packages_to_test_fully[@]}"); fi
install_packages "${packages[@]}" || exit

use_ccache
mkdir -p "$trees"
: >"$trees/CTestTestfile.cmake"
try_stage release release
if [[ $mode == full ]]; then
    try_stage python
    try_stage paraview paraview/build
    try_stage tidy
    try_stage address address
    try_stage thread thread
fi
try_stage mesa # last: it sets the folder of caches, which is not for compilers

say "runs the tests"
export ASAN_OPTIONS=allocator_may_return_null=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1
run_tests() {
    "${without_random_addresses[@]}" ctest --test-dir "$trees" --output-on-failure --no-tests=error --no-label-summary \
        -j "$(nproc)" | tee "$trees/tests.log"
}
status=0
measured tests run_tests || status=$?
print_times "$trees/Testing/Temporary/LastTest.log"
print_failures "$trees/Testing/Temporary/LastTest.log"
echo
grep '% tests passed, ' "$trees/tests.log" || true
exit "$status"
