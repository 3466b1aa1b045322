// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours and opacities of isosurfaces that are shown together, as looks_of() of src/scene/scene_looks.cpp gives them.

/** A colour of a map of 64 colours, "#rrggbb". */
function colorAt(map, place) {
  const entry = Math.max(0, Math.min(1, place)) * 63, below = Math.min(62, Math.floor(entry)), part = entry - below;
  const value = (at, k) => parseInt(map.slice(6 * at + 2 * k, 6 * at + 2 * k + 2), 16);
  return '#' + [0, 1, 2].map((k) => Math.round(value(below, k) * (1 - part) + value(below + 1, k) * part).toString(16).padStart(2, '0')).join('');
}

/** @param shown  [{isovalue, color: where it is alone, hides: isovalues of surfaces}], each isovalue once */
export function looksOf(shown, map, opacity) {
  const values = shown.map(({isovalue}) => isovalue);
  return shown.map(({isovalue, color, hides}) => ({
    color: shown.length < 2 ? color : colorAt(map, 0.12 + 0.76 * values.filter((one) => one < isovalue).length / (shown.length - 1)),
    opacity: opacity ?? (hides.some((one) => values.includes(one)) ? 0.35 : 1),
  }));
}
