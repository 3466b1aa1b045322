#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# From a fresh clone to isosurfaces of a real grid: installs missing packages, builds the program, extracts surfaces of
# equal speed from the blood flow in an artery, checks them, draws one of them, and prints a table. A second run skips what
# is done. Writes into build/ of the tree and nowhere else.
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$root/scripts/lib/packages.sh"
source "$root/scripts/lib/software_vulkan.sh"

# Paths are relative to the tree, so that what is shown can be typed.
readonly called_from=$PWD
cd "$root"
readonly grid=data/vtu/artery_flow_tet_wedge.vtu
readonly field=Umag
readonly isovalues=(0.1 0.2 0.3)
readonly build=build/demo
readonly out=$build/out
readonly program=$build/apps/cli/isotet
readonly table=$out/table.txt
readonly picture=$out/artery.png

if (($# > 0)); then
    echo "usage: $0    (no options; writes surfaces into build/demo/out)" >&2
    [[ $1 == -h || $1 == --help ]] && exit 0
    exit 2
fi

surface_of() { printf '%s/artery_speed_%s.vtp' "$out" "$1"; }

up_to_date() {
    [[ $table -nt $program && $table -nt $grid ]] || return 1
    local isovalue
    for isovalue in "${isovalues[@]}"; do [[ -s $(surface_of "$isovalue") ]] || return 1; done
}

# The table is what `isotet extract` prints; it appears under its name only when all surfaces passed the check.
extract_and_check() {
    mkdir -p "$out"
    rm -f "$table"
    local options=() isovalue
    for isovalue in "${isovalues[@]}"; do options+=(-i "$isovalue"); done
    say "extracts where $field, the speed of the blood, is ${isovalues[*]} m/s in $grid"
    "$program" extract "$grid" "$out/artery_speed_{value}.vtp" -f "$field" "${options[@]}" \
        --normals gradient --edge-ends --json "$out/extract.json" >"$table.unchecked" || return
    for isovalue in "${isovalues[@]}"; do
        say "checks $(surface_of "$isovalue") against the grid"
        if ! "$program" check "$(surface_of "$isovalue")" --grid "$grid" -f "$field" >"$out/check_$isovalue.txt"; then
            fail "the check says no:"
            cat "$out/check_$isovalue.txt" >&2
            return 1
        fi
    done
    mv "$table.unchecked" "$table"
}

draw() {
    say "draws where $field is 0.2 m/s, coloured by pressure: $picture"
    "$program" render "$grid" -o "$picture" -f "$field" -i 0.2 --color-by p >"$out/render.txt" 2>"$out/render.log"
}

# A graphics card draws, or a software device of this machine; else Mesa's is unpacked, as for the tests. Everything but the
# picture works without any.
draw_somehow() {
    if draw; then return; fi
    say "no device of this machine can draw: Mesa's software device shall"
    if install_packages "${packages_for_software_vulkan[@]}" && software_vulkan "$root/$build/mesa" && draw; then return; fi
    say "there is no picture: $(tail -n 1 "$out/render.log")"
}

print_what_next() {
    local look=
    if [[ -e $picture ]]; then look="look at $picture, "; fi
    cat <<NEXT

Checked: every edge of the surfaces that does not lie on the boundary of the grid is shared by its triangles in both
directions. Open the files in ParaView, ${look}or try:
NEXT
    if [[ $called_from != "$root" ]]; then echo "  cd $root"; fi
    if [[ -e $build/mesa/env.sh ]]; then echo "  source $build/mesa/env.sh    # the software device, for render"; fi
    cat <<NEXT
  $program $grid
  $program render $grid -f p -o pressure.png
  $program extract $grid pressure.stl -f p -i 180
  $program extract make:kuhn:128:gyroid gyroid.ply -f gyroid -i 0
  $program extract YOUR_GRID surface.vtp -f FIELD -i VALUE
  $program bench $grid -f p
  $program formats
  ./scripts/test.sh quick
  $program view $grid -f p    # in the browser: the surface follows a slider
NEXT
}

say "isotet demo: packages, build, extract, check, draw"
install_packages "${packages_to_build[@]}" || exit
build demo "$build" -DCMAKE_BUILD_TYPE=Release -DISOTET_TESTS=OFF
if up_to_date; then
    say "extracted and checked before, by the same program from the same grid"
else
    extract_and_check
fi
if [[ ! $picture -nt $program ]]; then draw_somehow; fi
echo
cat "$table"
print_what_next
