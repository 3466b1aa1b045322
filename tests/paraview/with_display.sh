#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# with_display.sh COMMAND...: runs it with an X server of its own, which takes a free display and tells when it is ready.
set -euo pipefail
folder=$(mktemp -d)
mkfifo "$folder/display"
# -noreset: a server that starts anew when its first client leaves refuses the next one for a moment.
Xvfb -displayfd 3 -screen 0 800x600x24 -nolisten tcp -noreset 3>"$folder/display" 2>"$folder/log" &
server=$!
trap 'kill "$server" 2>/dev/null || true; rm -rf "$folder"' EXIT
if ! read -r -t 30 display <"$folder/display"; then
    cat "$folder/log" >&2
    exit 1
fi
DISPLAY=:$display "$@"
