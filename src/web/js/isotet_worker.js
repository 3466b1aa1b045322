// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid in a thread of its own: what RemoteGrid (isotet.js) asks for.
import {fromArrays, haveThreadsFailed, open, takeModules} from './isotet.js';

let grid = null;

/** Arrays that do not change when the module's memory does; they go without another copy. */
function keep(surface) {
  const own = (values) => values && values.slice();
  const fields = Object.fromEntries(Object.entries(surface.fields).map(([name, values]) => [name, own(values)]));
  return {...surface, positions: own(surface.positions), triangles: own(surface.triangles), normals: own(surface.normals), fields};
}

const methods = {
  async open(data, options, {threads}, modules) {
    takeModules(modules);
    grid = await open(data, {...options, threads, onProgress: (...progress) => postMessage({progress})});
    return describe();
  },
  async fromArrays(arrays, _options, {threads}, modules) {
    takeModules(modules);
    grid = await fromArrays(arrays, {threads});
    return describe();
  },
  contour: (...words) => keep(grid.contour(...words)),
  range: (...words) => grid.range(...words),
};

function describe() {
  const {points, cells, fields, times, notes, threads} = grid;
  return {points, cells, fields, times, notes, threads};
}

const buffersOf = (result) => [result?.positions, result?.triangles, result?.normals, ...Object.values(result?.fields ?? {})].filter(ArrayBuffer.isView).map(({buffer}) => buffer);

onmessage = async ({data: {number, method, words}}) => {
  try {
    const result = await methods[method](...words);
    postMessage({number, result}, buffersOf(result));
  } catch (error) {
    postMessage({number, error: error.message, threadsFailed: haveThreadsFailed()});
  }
};
