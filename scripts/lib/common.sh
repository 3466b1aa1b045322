# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# What demo.sh and test.sh share: where the tree is, what they say, and how they build. Sourced, never run.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
readonly root

# The minutes since the start stand before every line, so that a log tells where the time went.
say() {
    printf '[%2d min] %s\n' $((SECONDS / 60)) "$*"
}

fail() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
}

# One compiler takes up to 1.5 GB: as many as the processors and the free memory carry. ISOTET_JOBS overrules.
jobs_that_fit() {
    if [[ -n ${ISOTET_JOBS:-} ]]; then
        echo "$ISOTET_JOBS"
        return
    fi
    local processors free_gigabytes
    processors=$(nproc)
    free_gigabytes=$(awk '/^MemAvailable:/ { print int($2 / 1048576 / 1.5) }' /proc/meminfo)
    local jobs=$((free_gigabytes < processors ? free_gigabytes : processors))
    echo $((jobs < 1 ? 1 : jobs))
}

# Seconds that the processors have spent on all children that this shell has waited for.
processor_seconds() {
    awk -v ticks_a_second="$(getconf CLK_TCK)" '{ print int(($16 + $17) / ticks_a_second) }' "/proc/$$/stat"
}

# measured NAME COMMAND...: runs the command, and notes in `spent` what it took: name, seconds, seconds of processors.
spent=()
measured() {
    local name=$1 start=$SECONDS start_processors status=0
    shift
    start_processors=$(processor_seconds)
    "$@" || status=$?
    spent+=("$name|$((SECONDS - start))|$(($(processor_seconds) - start_processors))")
    return "$status"
}

# in_log NAME LOG COMMAND...: runs the command with its output in LOG, says every half minute how far ninja is, and shows
# the end of LOG when the command fails; failed_log is LOG then.
failed_log=
in_log() {
    local name=$1 log=$2
    shift 2
    mkdir -p "$(dirname "$log")"
    NINJA_STATUS='[%f/%t] ' "$@" >"$log" 2>&1 </dev/null &
    local child=$! ticks=0
    while kill -0 "$child" 2>/dev/null; do
        sleep 0.5
        ticks=$((ticks + 1))
        if ((ticks % 60 == 0)); then
            local files_done
            files_done=$(tail -c 4000 "$log" | grep -o '^\[[0-9]*/[0-9]*\]' | tail -n 1 || true)
            say "$name ${files_done:-goes on}"
        fi
    done
    local status=0
    wait "$child" || status=$?
    if ((status != 0)); then
        failed_log=$log
        fail "$name failed with status $status; the end of $log:"
        tail -n 60 "$log" >&2
    fi
    return "$status"
}

# use_ccache: compiles by way of ccache, where it is installed: what was compiled before, in any checkout, is taken from the
# user's cache. Results that other settings of ccache put there are not: where a header may be younger than the compiler's
# start, a header changed while it was read is kept with the result of the old one, in precompiled headers too.
use_ccache() {
    if ! command -v ccache >/dev/null; then return; fi
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_COMPILERCHECK=content
    export CCACHE_NAMESPACE=isotet CCACHE_SLOPPINESS=pch_defines,time_macros
}

# build NAME FOLDER CMAKE_OPTIONS...: configures and builds the tree in FOLDER; does next to nothing when it is up to date.
# `build_target=isotet_program build ...` builds just that; `build_source` is another project than this one.
build() {
    local name=$1 folder=$2
    shift 2
    say "$name: configures"
    measured "$name: configure" in_log "$name: configure" "$folder.configure.log" \
        cmake -G Ninja -S "${build_source:-$root}" -B "$folder" "$@" || return
    local compile=(cmake --build "$folder" --target "${build_target:-all}" -j)
    say "$name: builds, $(jobs_that_fit) files at a time"
    if ! measured "$name: build" in_log "$name: build" "$folder.build.log" "${compile[@]}" "$(jobs_that_fit)"; then
        # The system ends a compiler where other programs take the memory that was free.
        grep -q 'Killed signal' "$folder.build.log" || return
        say "$name: a compiler was ended; builds one file at a time"
        measured "$name: build" in_log "$name: build" "$folder.build.log" "${compile[@]}" 1 || return
    fi
    say "$name: built"
}
