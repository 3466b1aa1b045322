#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Measures repeated extraction on a Vulkan device, step by step, beside the CPU engine: builds what it needs without VTK and
# without network, makes its grids in memory, prints one table, ends within 8 minutes. A device's driver must be there, and
# the Vulkan loader, libvulkan.so.1 (LD_LIBRARY_PATH may point to one).
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

readonly build=$root/build/bench_gpu

usage() {
    cat <<'USAGE'
usage: bench_gpu.sh [--device DEVICE] [--seconds N] [--max-tets N]

  --device DEVICE  a number or a part of a name in isotet devices, or software (the best graphics card)
  --seconds N      how long to measure (420 less what building took)
  --max-tets N     leave larger grids out (1000000000)
USAGE
}

device='' seconds='' tets=1000000000
while (($# > 0)); do
    case $1 in
    -h | --help) usage && exit 0 ;;
    --device | --seconds | --max-tets)
        if (($# < 2)); then
            usage >&2
            exit 2
        fi
        case $1 in
        --device) device=$2 ;;
        --seconds) seconds=$2 ;;
        *) tets=$2 ;;
        esac
        shift 2
        ;;
    *) usage >&2 && exit 2 ;;
    esac
done

say "gpu_bench: configures"
in_log "gpu_bench: configure" "$build.configure.log" cmake -G Ninja -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release \
    -DISOTET_IO=OFF -DISOTET_PROGRAM=OFF -DISOTET_TESTS=OFF -DISOTET_BENCH=ON || exit
say "gpu_bench: builds"
in_log "gpu_bench: build" "$build.build.log" cmake --build "$build" -j "$(jobs_that_fit)" --target isotet_gpu_bench || exit
say "gpu_bench: measures"
readonly left=$((420 - SECONDS))
exec timeout 480 "$build/bench/isotet_gpu_bench" "$device" "${seconds:-$((left > 60 ? left : 60))}" "$tets"
