// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid in a thread of its own: what RemoteGrid (isotet.js) asks for.
import {DeviceGrid, fromArrays, haveThreadsFailed, open, ownSurface, takeModules} from './isotet.js';

let grid = null;

const methods = {
  async open(data, options, {threads}, modules) {
    takeModules(modules);
    grid = await open(data, {...options, threads, onProgress: (...progress) => postMessage({progress})});
    return describe();
  },
  async fromArrays(arrays, {device}, {threads}, modules) {
    takeModules(modules);
    grid = await fromArrays(arrays, {threads, device});
    return describe();
  },
  contour: async (...words) => (grid instanceof DeviceGrid ? grid.contour(...words) : ownSurface(grid.contour(...words))), // they go without another copy
  range: (...words) => grid.range(...words),
};

function describe() {
  const {points, cells, fields, times, notes, threads, device, whyNoDevice} = grid;
  return {points, cells, fields, times, notes, threads, device, whyNoDevice};
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
