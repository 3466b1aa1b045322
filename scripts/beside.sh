#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# What a file looks like at first: `isotet render FILE` with nothing else, beside the pictures that ParaView and PyVista draw
# of the same field with their defaults. For eyes to judge. One picture a file in build/beside, and all on one sheet.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"
source "$root/scripts/lib/paraview.sh"

readonly build=$root/build/beside

usage() {
    cat <<'USAGE'
usage: beside.sh [FILE...]

  FILE   files that VTK reads too, or make:SHAPE (15 of data/ and made ones)

ISOTET_PROGRAM names another program than that of scripts/test.sh.
USAGE
}
if [[ ${1:-} == -h || ${1:-} == --help ]]; then usage && exit 0; fi

program=${ISOTET_PROGRAM:-$root/build/test/release/apps/cli/isotet}
if ! [[ -x $program ]]; then
    fail "there is no $program; scripts/test.sh builds it, or name one in ISOTET_PROGRAM"
    exit 4
fi

install_packages python3-venv libvtk9-dev xvfb libgl1-mesa-dri || exit
mkdir -p "$build"
paraview "$build/paraview" || exit
if ! [[ -x $build/python/bin/python ]]; then
    in_log "pyvista: install" "$build/pyvista.log" \
        sh -c 'python3 -m venv "$0" && "$0/bin/pip" --disable-pip-version-check install "$@"' \
        "$build/python" pyvista==0.49.1 vtk==9.7.2 || { rm -rf "$build/python" && exit 4; }
fi
ISOTET_PROGRAM=$(realpath "$program") PARAVIEW=$build/paraview/root/usr \
    exec "$build/python/bin/python" -B "$root/scripts/beside/draw.py" "$build" "$@"
