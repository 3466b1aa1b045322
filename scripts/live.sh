#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Makes a folder for a web site: pages with three grids of data/ in them, that for files of one's own, and an index of them.
# It takes a program with isotet as WebAssembly in it (docs/export.md tells how to build it).
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

if (($# > 1)) || [[ ${1:-} == -* ]]; then
    echo "usage: $0 [FOLDER]    (docs/live); ISOTET_PROGRAM names another program than that of scripts/test.sh" >&2
    [[ ${1:-} == -h || ${1:-} == --help ]] && exit 0
    exit 2
fi
folder=$(realpath -m "${1:-$root/docs/live}")
readonly folder program=${ISOTET_PROGRAM:-$root/build/test/release/apps/cli/isotet}

# NAME | TITLE | GRID, and options of isotet export
readonly pages=(
    "artery|Blood flow in an artery: speed, coloured by pressure|vtu/artery_flow_tet_wedge.vtu -f Umag --color-by p"
    "model|Regions of a geological model|gocad/geomodel3d_tsolid.so -f tvolume"
    "tension|A rod under tension, in three time steps|exodus/tension_tets_stress_3steps.e --all-steps"
)

mkdir -p "$folder"
{
    echo '<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    echo '<title>isotet in the browser</title><h1>isotet in the browser</h1><ul>'
    for page in "${pages[@]}"; do
        IFS='|' read -r name title words <<<"$page"
        echo "<li><a href=\"$name.html\">$title</a></li>"
        say "isotet export data/${words%% *} $folder/$name.html" >&2
        # shellcheck disable=SC2086 # options, as they stand there
        "$program" export "$root/data/${words%% *}" "$folder/$name.html" --as grid ${words#* } --quiet </dev/null >&2
    done
    "$program" page "$folder/isotet.html" --quiet </dev/null >&2
    echo '<li><a href="isotet.html">A grid of yours: files are dropped into this page, and do not leave your machine</a></li></ul></html>'
} >"$folder/index.html"
say "$folder/index.html: $(du -sh "$folder" | cut -f1)"
