#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Runs simulation programs and mesh tools, and compares what isotet reads of their files with the newest VTK: counts,
# fields, ranges, times, an isosurface, `isotet check`. Each program is installed by itself, from Debian or the Python
# package index, into build/solvers; one that cannot be had is said. Exit status 1 where something differs that
# scripts/solvers/known.txt does not give a reason for.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

readonly build=$root/build/solvers
readonly wheel=$build/vtk # what reads the files again

usage() {
    cat <<'USAGE'
usage: solvers.sh [--list] [PROGRAM...]

  PROGRAM   some of them, by name (all)
  --list    names them, and what is installed for each

ISOTET_PROGRAM is the isotet to try; without it one is built into build/solvers/isotet.
USAGE
}
if [[ ${1:-} == -h || ${1:-} == --help ]]; then usage && exit 0; fi

install_packages python3-venv || exit
if ! [[ -x $wheel/bin/python ]]; then
    in_log "vtk: install" "$build/vtk.log" \
        sh -c 'python3 -m venv "$0" && "$0/bin/pip" --disable-pip-version-check install "$@"' \
        "$wheel" vtk==9.7.2 numpy==2.4.6 || { rm -rf "$wheel" && exit 4; }
fi
program=${ISOTET_PROGRAM:-$build/isotet/apps/cli/isotet}
if [[ -z ${ISOTET_PROGRAM:-} && ${1:-} != --list ]]; then
    install_packages "${packages_to_build[@]}" || exit
    build isotet "$build/isotet" -DCMAKE_BUILD_TYPE=Release -DISOTET_TESTS=OFF -DISOTET_VULKAN=OFF || exit
fi
exec "$wheel/bin/python" -B "$root/scripts/solvers/run.py" --isotet "$(realpath -m "$program")" --build "$build" "$@"
