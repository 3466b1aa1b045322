// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isosurfaces of unstructured grids in browsers and Node: isotet as WebAssembly, one thread. isotet.d.ts has the contracts.
import {blobAsFile, bytesAsFile, Files} from './engine_files.js';

const arrays = {
  int8: Int8Array, uint8: Uint8Array, int16: Int16Array, uint16: Uint16Array, int32: Int32Array, uint32: Uint32Array,
  int64: BigInt64Array, uint64: BigUint64Array, float32: Float32Array, float64: Float64Array,
};
const typeOf = (values) => Object.keys(arrays).find((name) => values instanceof arrays[name]);

async function bytesOfModule(address) {
  if (address.protocol === 'file:' && typeof process !== 'undefined') return (await import('node:fs/promises')).readFile(address);
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${address} cannot be loaded: ${answer.status}`);
  return answer.arrayBuffer();
}

const modules = { // that lie beside this file
  packed: new URL('isotet_engine.wasm', import.meta.url), // arrays and packed files
  files: new URL('isotet_engine_readers.wasm', import.meta.url),
};
const compiled = {}; // promises of modules, for all grids
let given = null;    // one in their place

/** @see isotet.d.ts */
export function useModule(module) {
  given = module instanceof WebAssembly.Module ? Promise.resolve(module) : WebAssembly.compile(module);
  return given;
}

async function compile(kind) {
  return given ?? (compiled[kind] ??= bytesOfModule(modules[kind]).then((bytes) => WebAssembly.compile(bytes)));
}

/** A grid, and the instance of the module that has it in its memory. */
export class Grid {
  static async create(kind, files, onProgress) {
    const grid = new Grid(), given = new Files(files);
    const page = {text: (at, count) => {
      const said = JSON.parse(new TextDecoder().decode(new Uint8Array(grid.exports.memory.buffer, at, count)));
      if (said.progress) onProgress?.(...said.progress);
      else grid.answer = said;
    }};
    const {exports} = await WebAssembly.instantiate(await compile(kind), {page, wasi_snapshot_preview1: given.imports()});
    grid.exports = exports;
    given.memory = exports.memory;
    exports._initialize();
    return grid;
  }

  call(message) {
    if (!this.exports) throw new Error('the grid was closed');
    const text = new TextEncoder().encode(JSON.stringify(message)), at = this.exports.room(text.length);
    new Uint8Array(this.exports.memory.buffer).set(text, at);
    try {
      this.exports.call();
    } catch (error) {
      this.exports = null; // its memory is in no known state
      throw new Error(`isotet stopped, for lack of memory perhaps (${error.message})`);
    }
    if (this.answer.error) throw new Error(this.answer.error);
    return this.answer;
  }

  describe({points, cells, fields, times, notes}) {
    Object.assign(this, {points, cells, fields, times, notes});
    return this;
  }

  /** Copies arrays into the module's memory. */
  give(values) {
    const array = this.given = (this.given ?? -1) + 1, at = this.exports.array(values.byteLength);
    if (at === 0 && values.byteLength > 0) throw new Error(`there is no memory for ${values.byteLength} bytes`);
    new Uint8Array(this.exports.memory.buffer).set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), at);
    return {array, type: typeOf(values)};
  }

  view({type, at, count}) { return new arrays[type](this.exports.memory.buffer, at, count); }

  wish({field, fields = [], normals = 'none', step = 0, once = false}) {
    const wish = {field: field ?? this.fields[0]?.name ?? '', carry: fields, normals, step};
    return once ? {...wish, once} : wish;
  }

  contour(isovalue, options = {}) {
    const told = this.call({do: 'contour', isovalue, ...this.wish(options)});
    const fields = Object.fromEntries(Object.entries(told.fields).map(([name, place]) => [name, this.view(place)]));
    return {positions: this.view(told.positions), triangles: this.view(told.triangles), normals: told.normals ? this.view(told.normals) : null,
      fields, method: told.method, notes: told.notes};
  }

  range(options = {}) {
    const {lower, upper} = this.call({do: 'range', ...this.wish(options)});
    return [lower, upper];
  }

  close() { this.exports = null; }
}

const isBlob = (data) => typeof Blob !== 'undefined' && data instanceof Blob;

function fileOf(data) {
  if (isBlob(data)) return blobAsFile(data);
  return bytesAsFile(data instanceof ArrayBuffer ? new Uint8Array(data) : new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
}

const packedMark = 'isotetP\n';

/** Which module reads this file. */
async function kindOf(data) {
  const begin = isBlob(data) ? await data.slice(0, packedMark.length).arrayBuffer() : fileOf(data).read(0, packedMark.length);
  return String.fromCharCode(...new Uint8Array(begin)) === packedMark ? 'packed' : 'files';
}

/** @see isotet.d.ts */
export async function open(data, {name = 'grid', files = {}, onProgress} = {}) {
  const all = Object.fromEntries(Object.entries(files).map(([path, content]) => [path, fileOf(content)]));
  const grid = await Grid.create(await kindOf(data), {...all, [name]: fileOf(data)}, onProgress);
  return grid.describe(grid.call({do: 'open', path: name}));
}

/** @see isotet.d.ts */
export async function fromArrays({points, cells, values}) {
  const grid = await Grid.create('packed', {}), message = {do: 'take', fields: {}};
  const {connectivity, offsets, types} = ArrayBuffer.isView(cells) ? {connectivity: cells} : cells;
  for (const [key, array] of Object.entries({points, connectivity, offsets, types})) {
    if (array === undefined) continue;
    if (!typeOf(array)) throw new TypeError(`${key} is no typed array`);
    message[key] = grid.give(array);
  }
  for (const [name, array] of Object.entries(ArrayBuffer.isView(values) ? {values} : values)) {
    if (!typeOf(array)) throw new TypeError(`the values of ${name} are no typed array`);
    message.fields[name] = grid.give(array);
  }
  return grid.describe(grid.call(message));
}

/** The same grid in a thread: methods return promises, and arrays are the caller's own. */
export class RemoteGrid {
  constructor(worker) {
    this.worker = worker;
    this.waiting = new Map();
    this.number = 0;
    worker.onmessage = ({data}) => {
      if (data.progress) return this.onProgress?.(...data.progress);
      const {take, fail} = this.waiting.get(data.number);
      this.waiting.delete(data.number);
      if (data.error) fail(new Error(data.error));
      else take(data.result);
    };
    worker.onerror = (event) => {
      for (const {fail} of this.waiting.values()) fail(new Error(event.message));
      this.waiting.clear();
    };
  }

  ask(method, ...words) {
    return new Promise((take, fail) => {
      this.waiting.set(++this.number, {take, fail});
      this.worker.postMessage({number: this.number, method, words});
    });
  }

  contour(isovalue, options) { return this.ask('contour', isovalue, options); }

  range(options) { return this.ask('range', options); }

  close() { this.worker.terminate(); }
}

async function remote(kind, worker, onProgress, method, ...words) {
  const grid = new RemoteGrid(worker ?? new Worker(new URL('isotet_worker.js', import.meta.url), {type: 'module'}));
  grid.onProgress = onProgress;
  return Object.assign(grid, await grid.ask(method, ...words, await compile(kind)));
}

export async function openInWorker(data, {worker, onProgress, ...options} = {}) {
  return remote(await kindOf(data), worker, onProgress, 'open', data, options);
}

export const fromArraysInWorker = (grid, {worker} = {}) => remote('packed', worker, null, 'fromArrays', grid, {});
