#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Draws the pictures of docs/gallery again, by the commands that stand under them (scripts/test.sh builds the program).
# tests/render compares them.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

readonly program=${ISOTET_PROGRAM:-$root/build/test/release/apps/cli/isotet}

if (($# > 0)); then
    echo "usage: $0    (no options; ISOTET_PROGRAM names another program than that of scripts/test.sh)" >&2
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
fi

cd "$root"
grep '^isotet render ' docs/pictures.md | while read -r _ command options; do
    say "isotet $command $options"
    # shellcheck disable=SC2086 # the options of a line, as it stands there
    "$program" $command $options --quiet </dev/null
done
