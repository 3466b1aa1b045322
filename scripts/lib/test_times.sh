# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# What is told at the end of a test run: where the time went, and what failed. Sourced, never run; needs common.sh.

# One line for each kind of test in a log of ctest: kind, processes, tests in them, seconds. The longest come first.
times_of_kinds() {
    awk '
        /^[0-9]+\/[0-9]+ Testing: / {
            parts = split($3, name, ".")
            kind = name[1]
            if (parts > 2 && (kind == "address" || kind == "thread")) kind = kind "." name[2]
            processes[kind]++
            cases = 1
        }
        /^\[==========\] [0-9]+ tests? from .* ran\./ { cases = $2 }
        /^Test time = / { seconds[kind] += $4; tests[kind] += cases }
        END { for (kind in processes) printf "%s|%d|%d|%.0f\n", kind, processes[kind], tests[kind], seconds[kind] }
    ' "$1" | sort -t '|' -k 4,4nr -k 1,1
}

# print_times LOG: what `measured` has noted, and the kinds of test in ctest's LOG.
print_times() {
    local name seconds processors processes tests
    printf '\n%-24s %9s %14s\n' '' seconds 'of processors'
    for line in "${spent[@]}"; do
        IFS='|' read -r name seconds processors <<<"$line"
        printf '%-24s %9d %14d\n' "$name" "$seconds" "$processors"
    done
    printf '\n%-24s %9s %14s %9s\n' 'kind of test' seconds processes tests
    times_of_kinds "$1" | while IFS='|' read -r name processes tests seconds; do
        printf '%-24s %9d %14d %9d\n' "$name" "$seconds" "$processes" "$tests"
    done
}

# print_failures LOG: the last lines of each test that failed in ctest's LOG, once more, where the end of a run is read;
# of a process of several tests, without what says that one begins or passed.
print_failures() {
    awk -v lines=25 '
        /^[0-9]+\/[0-9]+ Testing: / { name = $3 }
        /^Output:$/ { count = 0; next }
        /^<end of output>$/ || /^\[( RUN      |       OK |-{10}|={10})\]/ { next }
        { said[count++ % lines] = $0 }
        /^Test Failed\.$/ {
            printf "\n%s failed:\n", name
            for (i = count > lines ? count - lines : 0; i < count; ++i) print "    " said[i % lines]
        }
    ' "$1"
}
