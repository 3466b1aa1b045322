// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces as files, of what the page has: places are rounded to 65535ths of each surface's box.

export const nothingShown = 'Nothing is shown that could be written.';

/** Positions of the vertices, three numbers each. */
function positionsOf({vertexBytes, vertices, lower, upper}) {
  const places = new Uint16Array(vertexBytes.buffer, vertexBytes.byteOffset, 4 * vertices), positions = new Float32Array(3 * vertices);
  for (let i = 0; i < vertices; ++i)
    for (let axis = 0; axis < 3; ++axis) positions[3 * i + axis] = lower[axis] + places[4 * i + axis] / 65535 * (upper[axis] - lower[axis]);
  return positions;
}

const cornersOf = ({corners, triangles}) => (corners ? Uint32Array.from(corners) : Uint32Array.from({length: 3 * triangles}, (_, i) => i));

/** Binary STL. */
function stlOf(meshes) {
  const all = meshes.filter(({triangles}) => triangles > 0), count = all.reduce((sum, {triangles}) => sum + triangles, 0);
  const view = new DataView(new ArrayBuffer(84 + 50 * count));
  new TextEncoder().encodeInto('isotet', new Uint8Array(view.buffer, 0, 80));
  view.setUint32(80, count, true);
  let at = 84;
  for (const mesh of all) {
    const positions = positionsOf(mesh), corners = cornersOf(mesh);
    for (let t = 0; t < corners.length; t += 3, at += 50) {
      const [a, b, c] = [0, 1, 2].map((k) => positions.subarray(3 * corners[t + k], 3 * corners[t + k] + 3));
      const u = [0, 1, 2].map((i) => b[i] - a[i]), v = [0, 1, 2].map((i) => c[i] - a[i]);
      const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], size = Math.hypot(...normal) || 1;
      [...normal.map((n) => n / size), ...a, ...b, ...c].forEach((number, i) => view.setFloat32(at + 4 * i, number, true));
    }
  }
  return new Uint8Array(view.buffer);
}

const linear = (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);

/** Binary glTF 2.0: a mesh a surface. `looks`: [{color: "#rrggbb", opacity}] */
function glbOf(meshes, looks) {
  const blocks = [], views = [], accessors = [], json = {asset: {version: '2.0', generator: 'isotet'}, scene: 0, scenes: [{nodes: []}], nodes: [], meshes: [], materials: []};
  let length = 0;
  const add = (data, target, accessor) => {
    views.push({buffer: 0, byteOffset: length, byteLength: data.byteLength, target});
    blocks.push(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    length += data.byteLength; // numbers of 4 bytes each
    return accessors.push({bufferView: views.length - 1, ...accessor}) - 1;
  };
  meshes.forEach((mesh, i) => {
    if (mesh.triangles === 0) return;
    const positions = positionsOf(mesh), corners = cornersOf(mesh), ends = (pick) => [0, 1, 2].map((axis) => {
      let end = positions[axis];
      for (let at = axis; at < positions.length; at += 3) end = pick(end, positions[at]);
      return end;
    });
    const color = [1, 3, 5].map((at) => linear(parseInt(looks[i].color.slice(at, at + 2), 16) / 255));
    json.materials.push({doubleSided: true, alphaMode: looks[i].opacity < 1 ? 'BLEND' : 'OPAQUE',
      pbrMetallicRoughness: {baseColorFactor: [...color, looks[i].opacity], metallicFactor: 0, roughnessFactor: 0.7}});
    json.meshes.push({primitives: [{material: json.materials.length - 1,
      attributes: {POSITION: add(positions, 34962, {componentType: 5126, count: mesh.vertices, type: 'VEC3', min: ends(Math.min), max: ends(Math.max)})},
      indices: add(corners, 34963, {componentType: 5125, count: corners.length, type: 'SCALAR'})}]});
    json.scenes[0].nodes.push(json.nodes.push({mesh: json.meshes.length - 1}) - 1);
  });
  return glbBytes({...json, buffers: [{byteLength: length}], bufferViews: views, accessors}, blocks, length);
}

/** A file by the ending of its name; null where it is another one. */
export function surfaceFile(name, meshes, looks) {
  const ending = name.toLowerCase().split('.').pop();
  return ending === 'stl' ? stlOf(meshes) : ending === 'glb' ? glbOf(meshes, looks) : null;
}

function glbBytes(json, blocks, length) {
  const text = new TextEncoder().encode(JSON.stringify(json)), room = Math.ceil(text.length / 4) * 4;
  const out = new Uint8Array(28 + room + length), view = new DataView(out.buffer);
  [0x46546C67, 2, out.length, room, 0x4E4F534A].forEach((number, i) => view.setUint32(4 * i, number, true));
  out.fill(0x20, 20, 20 + room);
  out.set(text, 20);
  view.setUint32(20 + room, length, true);
  view.setUint32(24 + room, 0x004E4942, true);
  let at = 28 + room;
  for (const block of blocks) {
    out.set(block, at);
    at += block.length;
  }
  return out;
}
