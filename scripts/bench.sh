#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Races isotet against VTK on this machine: installs missing packages, builds, measures, prints tables, and leaves CSV,
# JSON and SVG charts in build/bench/results. Nothing else should run meanwhile.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

readonly build=$root/build/bench
readonly venv=$build/wheel
readonly wheel_packages=(vtk==9.7.2 numpy==2.4.6) # what a wheel of VTK needs of others is for drawing

usage() {
    cat <<'USAGE'
usage: bench.sh [--quick] [--threads N] [--max-cells N] [--wheel] [OPTION...]

  --quick          regular grids to 30 million tetrahedra, the others at 5 million: some minutes, 8 GB
  --threads N      threads of every contestant (all processors)
  --max-cells N     leave larger made grids out; 100 million need 24 GB
  --wheel          get the VTK wheel from the Python package index into build/bench, as another rival
  --rounds N       how often everything is measured (5)
  --pack-rounds N  how often packing and what goes with it is measured (as --rounds; 3 with --quick)
  --isovalues N    surfaces a round, 1 to 5 (5; 3 with --quick)
  --only TEXT[,TEXT]  only made and shipped grids whose name holds one of the texts
  --file PATH FIELD   race on this grid, too
  --out FOLDER     where results go (build/bench/results)
  --note TEXT      a sentence about the circumstances, kept with the results
  --publish        take the results over into docs/performance
USAGE
}

get_wheel=0
options=()
for argument; do
    case $argument in
    -h | --help) usage && exit 0 ;;
    --wheel) get_wheel=1 ;;
    *) options+=("$argument") ;;
    esac
done

install_packages "${packages_to_build[@]}" libvtk9-dev python3 || exit
build bench "$build" -DCMAKE_BUILD_TYPE=Release -DISOTET_BENCH=ON -DISOTET_TESTS=OFF -DISOTET_PROGRAM=OFF || exit
if ((get_wheel)) && ! [[ -x $venv/bin/python ]]; then
    install_packages python3-venv || exit
    say "wheel: gets ${wheel_packages[*]}"
    if ! in_log "wheel: install" "$build/wheel.log" \
        sh -c 'python3 -m venv "$0" && "$0/bin/pip" install --no-deps "$@"' "$venv" "${wheel_packages[@]}"; then
        rm -rf "$venv"
        say "wheel: not to be had; goes on without"
    fi
fi
if [[ -x $venv/bin/python ]]; then options+=(--wheel-python "$venv/bin/python"); fi
say "bench: measures"
exec python3 -B "$root/bench/race" --build "$build" "${options[@]}"
