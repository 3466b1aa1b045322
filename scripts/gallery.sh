#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Draws the pictures of docs/gallery again, by the commands that stand under them, on the software device that the tests use
# (scripts/test.sh builds the program and unpacks the device). tests/render compares them.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"
source "$root/scripts/lib/software_vulkan.sh"

readonly program=${ISOTET_PROGRAM:-$root/build/test/release/apps/cli/isotet}

if (($# > 0)); then
    echo "usage: $0    (no options; ISOTET_PROGRAM names another program than that of scripts/test.sh)" >&2
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
fi

cd "$root"
# A device that was chosen from outside is left alone.
if [[ -z ${VK_DRIVER_FILES:-} ]]; then software_vulkan "$root/build/test/mesa" || exit; fi
grep '^isotet render ' docs/gallery/README.md | while read -r _ command options; do
    say "isotet $command $options"
    # shellcheck disable=SC2086 # the options of a line, as it stands there
    "$program" $command $options --device software --quiet </dev/null
done
