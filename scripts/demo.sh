#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# From a fresh clone to isosurfaces of a real grid: installs missing packages, builds the program, extracts surfaces of
# equal speed from the blood flow in an artery, checks them, and prints a table. A second run skips what is done.
# Writes into build/ of the tree and nowhere else.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"

readonly grid=$root/data/vtu/artery_flow_tet_wedge.vtu
readonly field=Umag
readonly isovalues=(0.1 0.2 0.3)
readonly build=$root/build/demo
readonly out=$build/out
readonly program=$build/apps/cli/isotet
readonly report=$out/extract.json

if (($# > 0)); then
    echo "usage: $0    (no options; writes surfaces into build/demo/out)" >&2
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
fi

surface_of() { printf '%s/artery_speed_%s.vtp' "$out" "$1"; }

up_to_date() {
    [[ $report -nt $program && $report -nt $grid ]] || return 1
    local isovalue
    for isovalue in "${isovalues[@]}"; do
        [[ -s $(surface_of "$isovalue") && -s $out/check_$isovalue.json ]] || return 1
    done
}

extract_and_check() {
    mkdir -p "$out"
    rm -f "$report"
    local options=() isovalue
    for isovalue in "${isovalues[@]}"; do options+=(-i "$isovalue"); done
    say "extract: $field = ${isovalues[*]} from ${grid#"$root"/}"
    "$program" extract "$grid" "$out/artery_speed_{value}.vtp" -f "$field" "${options[@]}" \
        --normals gradient --edge-ends --json "$report.new" >"$out/extract.log" || return
    for isovalue in "${isovalues[@]}"; do
        say "check: $(surface_of "$isovalue")"
        "$program" check "$(surface_of "$isovalue")" --grid "$grid" -f "$field" --json "$out/check_$isovalue.json" \
            >"$out/check_$isovalue.log" || return
    done
    mv "$report.new" "$report"
}

# The table, out of what `isotet extract --json` and `isotet check --json` wrote.
print_table() {
    local -A seen=()
    local path value i isovalue
    while IFS=$'\t' read -r path value; do seen[$path]=$value; done \
        < <(awk -f "$root/scripts/lib/json_paths.awk" "$report")
    printf '\n%s\n' "${grid#"$root"/}, speed of the blood in m/s"
    printf '  points %s   cells %s   tetrahedra %s\n' "${seen[points]}" "${seen[cells]}" "${seen[tets]}"
    printf '  engine %s, %s threads   packed %s KiB   transient peak %s KiB\n' "${seen[engine]}" "${seen[threads]}" \
        "$(kibibytes "${seen[bytes.packed]}")" "$(kibibytes "${seen[bytes.transient_peak]}")"
    printf '  read %.3f s   pack %.3f s\n\n' "${seen[seconds.read]}" "${seen[seconds.pack]}"
    printf '  %8s %9s %10s %12s %10s %10s   %s\n' isovalue vertices triangles 'area (m2)' extract write 'file, checked'
    for ((i = 0; i < ${#isovalues[@]}; i++)); do
        isovalue=${isovalues[i]}
        printf '  %8s %9s %10s %12.6g %8.1f ms %7.1f ms   %s\n' "$isovalue" \
            "${seen[surfaces.$i.vertices]}" "${seen[surfaces.$i.triangles]}" "${seen[surfaces.$i.area]}" \
            "$(milliseconds "${seen[surfaces.$i.seconds.extract]}")" \
            "$(milliseconds "${seen[surfaces.$i.seconds.write]}")" "$(shorter "$(surface_of "$isovalue")")"
    done
}

kibibytes() { awk -v bytes="$1" 'BEGIN { printf "%d", bytes / 1024 }'; }

milliseconds() { awk -v seconds="$1" 'BEGIN { print seconds * 1000 }'; }

shorter() { printf '%s' "${1#"$PWD"/}"; }

print_what_next() {
    local tool
    tool=$(shorter "$program")
    cat <<NEXT

Checked: every edge of the surfaces that does not lie on the boundary of the grid is shared by its triangles in both
directions. Open the files in ParaView, or try:
  $tool $(shorter "$grid")
  $tool extract $(shorter "$grid") wall.stl -f p -i 180
  $tool extract make:kuhn:128:gyroid gyroid.ply -f gyroid -i 0
  $tool extract YOUR_GRID surface.vtp -f FIELD -i VALUE
  $tool formats
  ./scripts/test.sh quick
NEXT
}

say "isotet demo: packages, build, extract, check"
install_packages "${packages_to_build[@]}" || exit
build demo "$build" -DCMAKE_BUILD_TYPE=Release -DISOTET_TESTS=OFF
if up_to_date; then
    say "extract, check: done before, from the same program and grid"
else
    extract_and_check
fi
print_table
print_what_next
