// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Meshes out of a file: base64, inflated by the browser, then columns of differences (src/view/saved_mesh.hpp).
import {allBytes, damaged, fromBase64, inflated} from './base64.js';

/** What stands in the file under this name: base64. */
export function partText(name) {
  const part = document.getElementById(name);
  if (!part) throw damaged();
  return part.textContent;
}

/** Its bytes, inflated. */
export const unpack = async (name) => allBytes(inflated(fromBase64(partText(name))));

/** What the page was told when it was made. */
export function savedMessage() {
  const text = partText('saved');
  try {
    return JSON.parse(text);
  } catch {
    throw damaged();
  }
}

/** Columns of numbers of so many bytes each, the lowest bytes of all first. */
class Columns {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }

  read(count, width, put) {
    const {bytes, at} = this;
    if (at + count * width > bytes.length) throw new Error('a mesh of the file is cut short');
    for (let i = 0; i < count; ++i) {
      let code = 0;
      for (let plane = width - 1; plane >= 0; --plane) code = code * 256 + bytes[at + plane * count + i];
      put(i, code);
    }
    this.at += count * width;
  }

  /** Of differences to the number before. */
  readDifferences(count, width, put) {
    const most = 256 ** width;
    let last = 0;
    this.read(count, width, (i, code) => {
      last = (last + (code % 2 ? most - (code + 1) / 2 : code / 2)) % most;
      put(i, last);
    });
  }
}

/** Fills a mesh that the file tells of: as frame.js has it. */
export function decodeMesh(bytes, told) {
  const {vertices, triangles, wide, flat, colored} = told, columns = new Columns(bytes), mesh = {...told};
  mesh.vertexBytes = new Uint8Array(8 * vertices);
  const places = new Uint16Array(mesh.vertexBytes.buffer);
  for (let axis = 0; axis < 3; ++axis) columns.readDifferences(vertices, 2, (i, place) => { places[4 * i + axis] = place; });
  for (let side = 0; side < 2; ++side) columns.readDifferences(vertices, 1, (i, code) => { mesh.vertexBytes[8 * i + 6 + side] = code; });
  if (colored) {
    mesh.colors = new Uint16Array(vertices);
    columns.readDifferences(vertices, 2, (i, place) => { mesh.colors[i] = place; });
  }
  if (!flat) {
    mesh.corners = wide ? new Uint32Array(3 * triangles) : new Uint16Array(3 * triangles);
    let next = 0; // vertex that no triangle has used
    columns.read(3 * triangles, wide ? 4 : 2, (i, back) => {
      if (back > next || next - back >= vertices) throw new Error('a mesh of the file has a corner that is no vertex');
      mesh.corners[i] = next - back;
      if (back === 0) ++next;
    });
  }
  return mesh;
}
