#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Measures repeated extraction on a Vulkan device, step by step, beside the CPU engine: builds what it needs without VTK and
# without network, makes its grids in memory, prints one table, ends within 8 minutes. Only a device's driver must be there.
# A machine without compiler or Vulkan loader runs what --carry made on another one.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

readonly build=$root/build/bench_gpu
readonly program=$build/bench/isotet_gpu_bench

usage() {
    cat <<'USAGE'
usage: bench_gpu.sh [--device DEVICE] [--seconds N] [--max-tets N]
       bench_gpu.sh --carry FOLDER

  --device DEVICE  a number or a part of a name in isotet devices, or software (the best graphics card)
  --seconds N      how long to measure (420 less what building took)
  --max-tets N     leave larger grids out (1000000000)
  --carry FOLDER   measure nothing; put the program, its libraries and the Vulkan loader into FOLDER, and a script
                   run.sh that takes the options above, for another machine with glibc 2.36 or later
USAGE
}

# The libraries that the program needs and that are not glibc's, and the loader that it opens by name.
libraries_to_carry() {
    ldd "$program" | awk '$2 == "=>" && $1 !~ /^lib(c|m|dl|rt|pthread)\.so/ { print $3 }'
    local loader
    loader=$(ldconfig -p | awk '$1 == "libvulkan.so.1" { print $NF; exit }')
    if [[ -z $loader ]]; then
        fail "there is no libvulkan.so.1 here to carry (Debian: libvulkan1)"
        return 1
    fi
    echo "$loader"
}

# Takes options with their values into device, seconds and tets; the first that is none of them, and all behind it, are
# left_over. run.sh has it, too.
read_options() {
    device='' seconds='' tets=1000000000
    while (($# > 1)); do
        case $1 in
        --device) device=$2 ;;
        --seconds) seconds=$2 ;;
        --max-tets) tets=$2 ;;
        *) break ;;
        esac
        shift 2
    done
    left_over=("$@")
}

carry() {
    local folder=$1 libraries
    libraries=$(libraries_to_carry) || return
    mkdir -p "$folder/lib" || return
    # shellcheck disable=SC2086 # one word a library
    cp -L $libraries "$folder/lib" || return
    install "$program" "$folder" || return
    {
        cat <<'RUN'
#!/usr/bin/env bash
# run.sh [--device DEVICE] [--seconds N] [--max-tets N]: as bench_gpu.sh, with what lies beside it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
RUN
        declare -f read_options
        cat <<'RUN'
read_options "$@"
if ((${#left_over[@]} > 0)); then
    echo "run.sh: '${left_over[0]}' is no option, or lacks its value" >&2
    exit 2
fi
# The machine's own loader, where there is one, comes last: it would do as well.
export LD_LIBRARY_PATH=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
exec timeout 480 "$here/isotet_gpu_bench" "$device" "${seconds:-400}" "$tets"
RUN
    } >"$folder/run.sh" || return
    chmod +x "$folder/run.sh"
    say "gpu_bench: lies in $folder, $(du -sh "$folder" | cut -f 1)"
}

folder=''
read_options "$@"
if ((${#left_over[@]} > 0)); then
    case ${#left_over[@]}${left_over[0]} in
    1-h | 1--help) usage && exit 0 ;;
    2--carry) folder=${left_over[1]} ;;
    *) usage >&2 && exit 2 ;;
    esac
fi

say "gpu_bench: configures"
in_log "gpu_bench: configure" "$build.configure.log" cmake -G Ninja -S "$root" -B "$build" \
    -DCMAKE_BUILD_TYPE=Release -DISOTET_IO=OFF -DISOTET_PROGRAM=OFF -DISOTET_TESTS=OFF -DISOTET_BENCH=ON || exit
say "gpu_bench: builds"
in_log "gpu_bench: build" "$build.build.log" cmake --build "$build" -j "$(jobs_that_fit)" --target isotet_gpu_bench || exit
if [[ -n $folder ]]; then
    carry "$folder"
    exit
fi
say "gpu_bench: measures"
readonly left=$((420 - SECONDS))
exec timeout 480 "$program" "$device" "${seconds:-$((left > 60 ? left : 60))}" "$tets"
