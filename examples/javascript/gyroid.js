// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A made grid as typed arrays: a cube from -3 to 3 of `side` cubes each way, six tetrahedra each, and a gyroid on its points.

const corners = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]; // bits: x, y, z

export function gyroidGrid(side) {
  const row = side + 1, points = new Float32Array(3 * row ** 3), gyroid = new Float32Array(row ** 3);
  const at = (x, y, z) => (z * row + y) * row + x;
  for (let z = 0; z < row; ++z)
    for (let y = 0; y < row; ++y)
      for (let x = 0; x < row; ++x) {
        const place = [x, y, z].map((i) => 6 * i / side - 3), [sin, cos] = [Math.sin, Math.cos].map((f) => place.map((p) => f(2 * p)));
        points.set(place, 3 * at(x, y, z));
        gyroid[at(x, y, z)] = sin[0] * cos[1] + sin[1] * cos[2] + sin[2] * cos[0];
      }
  const cells = new Uint32Array(24 * side ** 3);
  let next = 0;
  for (let z = 0; z < side; ++z)
    for (let y = 0; y < side; ++y)
      for (let x = 0; x < side; ++x)
        for (const tet of corners) for (const corner of tet) cells[next++] = at(x + (corner & 1), y + ((corner >> 1) & 1), z + (corner >> 2));
  return {points, cells, values: {gyroid}};
}
