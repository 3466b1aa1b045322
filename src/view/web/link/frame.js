// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What comes in bytes: frames, and parts of files that are downloaded.

const mark = (text) => [...text].reduce((number, letter, i) => number + letter.charCodeAt(0) * 256 ** i, 0);

/** Whether bytes begin with four letters: "isof" is a frame, "isod" a part of a download. */
export const beginsWith = (buffer, text) => new DataView(buffer).getUint32(0, true) === mark(text);

/** A frame taken apart: its head, with arrays in place of where they stand. */
export function readFrame(buffer) {
  const view = new DataView(buffer);
  if (!beginsWith(buffer, 'isof')) throw new Error('a frame begins with "isof"');
  const length = view.getUint32(4, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  const blocks = Math.ceil((8 + length) / 8) * 8;
  for (const {mesh} of head.surfaces) {
    if (!mesh) continue;
    mesh.vertexBytes = new Uint8Array(buffer, blocks + mesh.vertices_at, 8 * mesh.vertices);
    if (mesh.colors_at !== undefined) mesh.colors = new Uint16Array(buffer, blocks + mesh.colors_at, mesh.vertices);
    if (mesh.corners_at !== undefined) {
      const Type = mesh.wide ? Uint32Array : Uint16Array;
      mesh.corners = new Type(buffer, blocks + mesh.corners_at, 3 * mesh.triangles);
    }
  }
  if (head.picture) head.picture.coded = new Uint8Array(buffer, blocks + head.picture.at, head.picture.bytes);
  head.bytes = buffer.byteLength;
  return head;
}
