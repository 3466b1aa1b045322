// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours and opacities of isosurfaces that are shown together, as looks_of() of src/scene/scene_looks.cpp gives them.

/** A colour of a map of 64 colours, "#rrggbb". */
function colorAt(map, place) {
  const entry = Math.max(0, Math.min(1, place)) * 63, below = Math.min(62, Math.floor(entry)), part = entry - below;
  const value = (at, k) => parseInt(map.slice(6 * at + 2 * k, 6 * at + 2 * k + 2), 16);
  return '#' + [0, 1, 2].map((k) => Math.round(value(below, k) * (1 - part) + value(below + 1, k) * part).toString(16).padStart(2, '0')).join('');
}

const holds = (box, other) => other.lower.every((v, i) => box.lower[i] <= v && other.upper[i] <= box.upper[i]);

/** Whether a surface may hide another one: one that has its box inside this one's, or beside it. */
const hides = (boxes, which) => boxes.some((box, i) => i !== which && box.lower && boxes[which].lower && !holds(box, boxes[which]));

/** @param shown  [{isovalue, color: where it is alone, mesh: with its box}], each isovalue once */
export function looksOf(shown, map, opacity) {
  const boxes = shown.map(({mesh}) => mesh), values = shown.map(({isovalue}) => isovalue);
  return shown.map(({isovalue, color}, i) => ({
    color: shown.length < 2 ? color : colorAt(map, 0.12 + 0.76 * values.filter((one) => one < isovalue).length / (shown.length - 1)),
    opacity: opacity ?? (hides(boxes, i) ? 0.35 : 1),
  }));
}
