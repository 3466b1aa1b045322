// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isosurfaces of unstructured grids in browsers and Node: isotet as WebAssembly. isotet.d.ts has the contracts.
import {blobAsFile, bytesAsFile, Files} from './engine_files.js';
import {CardOfModule} from './webgpu.js';
import {beginThreads, grown, mostThreads, sharedMemory, threadsHere} from './isotet_threads.js';

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
  threads: new URL('isotet_engine_threads.wasm', import.meta.url), // the same by several threads
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

/** Modules that the page has compiled, in a worker of it (isotet_worker.js). */
export function takeModules({given, ...others}) {
  if (given) useModule(given);
  for (const [kind, module] of Object.entries(others)) compiled[kind] = Promise.resolve(module);
}

/** What takeModules() takes. */
async function modulesFor(kind, threads) {
  if (given) return {given: await given};
  const module = threads > 1 && await compile('threads').catch(() => null);
  return module ? {threads: module} : {[kind]: await compile(kind)};
}

let threadsFailed = false; // one has: grids that are opened from then on have one thread
export const haveThreadsFailed = () => threadsFailed;

/** How many threads a grid of this kind may have. */
function threadsFor(kind, wanted = threadsHere()) {
  if (kind !== 'packed' || given || threadsFailed) return 1;
  return Math.max(1, Math.min(mostThreads, Math.floor(wanted) || 1));
}

/** Of grids that were never closed. */
const forgotten = new FinalizationRegistry((ends) => { for (const end of ends) end(); });

/** A grid, and the instance of the module that has it in its memory. */
export class Grid {
  /** @param threads  how many, where there can be so many */
  static async create(kind, files, onProgress, threads = 1) {
    const grid = new Grid(), memory = threads > 1 ? sharedMemory() : null;
    const module = memory && await compile('threads').catch(() => null); // it may be missing where the other is
    await grid.begin(module ?? await compile(kind), files, onProgress, module && memory);
    if (module) grid.ends = await beginThreads(threads - 1, module, memory, grid.exports);
    forgotten.register(grid, grid.ends, grid);
    return grid;
  }

  ends = []; // of the other threads

  /** That pack and extract. */
  get threads() { return 1 + this.ends.length; }

  /** @param shared  memory for the module; null: its own */
  async begin(module, files, onProgress, shared) {
    const given = new Files(files), imports = {page: {text: (at, count) => this.take(at, count, onProgress)}, wasi_snapshot_preview1: given.imports()};
    const {exports} = await WebAssembly.instantiate(module, shared ? {...imports, env: {memory: shared}} : imports);
    this.exports = exports;
    this.memory = given.memory = shared ? grown(shared) : exports.memory;
    exports._initialize();
  }

  /** A message of the module. */
  take(at, count, onProgress) {
    const said = JSON.parse(new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, count).slice())); // of shared memory it decodes none
    if (said.progress) onProgress?.(...said.progress);
    else if (!this.card?.take(said)) this.answer = said;
  }

  card = null; // CardOfModule

  /** Has the module do it. */
  make(message) {
    if (!this.exports) throw new Error('the grid was closed');
    const text = new TextEncoder().encode(JSON.stringify(message)), at = this.exports.room(text.length);
    new Uint8Array(this.memory.buffer).set(text, at);
    try {
      this.exports.call();
    } catch (error) {
      throw this.stopped(error);
    }
  }

  /** What is thrown where the module stopped: its memory is in no known state. */
  stopped(error) {
    const inThread = Boolean(this.exports.has_failed?.());
    threadsFailed ||= inThread;
    this.close();
    return new Error(`${inThread ? 'a thread of isotet' : 'isotet'} stopped, for lack of memory perhaps (${error.message})`);
  }

  answered() {
    if (this.answer.error) throw new Error(this.answer.error);
    return this.answer;
  }

  call(message) {
    this.make(message);
    return this.answered();
  }

  /** The same, waiting for the graphics card. */
  async callWithCard(message) {
    try {
      await this.card.settle(() => this.make(message));
    } catch (error) {
      throw this.exports ? this.stopped(error) : error;
    }
    return this.answered();
  }

  /** Opens it; threads of one that cannot be opened end. */
  open(message) {
    try {
      return Object.assign(this, this.call(message));
    } catch (error) {
      this.close();
      throw error;
    }
  }

  /** Copies arrays into the module's memory. */
  give(values) {
    const array = this.given = (this.given ?? -1) + 1, at = this.exports.array(values.byteLength);
    if (at === 0 && values.byteLength > 0) throw new Error(`there is no memory for ${values.byteLength} bytes`);
    new Uint8Array(this.memory.buffer).set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), at);
    return {array, type: typeOf(values)};
  }

  /** What gives it arrays, which are copied. */
  messageOf(points, cells, values) {
    const message = {do: 'take', fields: {}}, {connectivity, offsets, types} = ArrayBuffer.isView(cells) ? {connectivity: cells} : cells;
    for (const [key, array] of Object.entries({points, connectivity, offsets, types})) {
      if (array === undefined) continue;
      if (!typeOf(array)) throw new TypeError(`${key} is no typed array`);
      message[key] = this.give(array);
    }
    for (const [name, array] of Object.entries(ArrayBuffer.isView(values) ? {values} : values)) {
      if (!typeOf(array)) throw new TypeError(`the values of ${name} are no typed array`);
      message.fields[name] = this.give(array);
    }
    return message;
  }

  view({type, at, count}) { return new arrays[type](this.memory.buffer, at, count); }

  wish({field, fields = [], normals = 'none', step = 0, once = false}) {
    const wish = {field: field ?? this.fields[0]?.name ?? '', carry: fields, normals, step};
    return once ? {...wish, once} : wish;
  }

  contourMessage(isovalue, options = {}) { return {do: 'contour', isovalue, ...this.wish(options)}; }

  contour(isovalue, options) { return this.surface(this.call(this.contourMessage(isovalue, options))); }

  surface(told) {
    const fields = Object.fromEntries(Object.entries(told.fields).map(([name, place]) => [name, this.view(place)]));
    return {positions: this.view(told.positions), triangles: this.view(told.triangles), normals: told.normals ? this.view(told.normals) : null,
      fields, method: told.method, notes: told.notes};
  }

  range(options = {}) {
    const {lower, upper} = this.call({do: 'range', ...this.wish(options)});
    return [lower, upper];
  }

  close() {
    this.card?.close();
    this.exports = this.memory = null;
    forgotten.unregister(this);
    for (const end of this.ends.splice(0)) end();
  }
}

/** Arrays that do not change when the module's memory does. */
export function ownSurface(surface) {
  const own = (values) => values && values.slice();
  const fields = Object.fromEntries(Object.entries(surface.fields).map(([name, values]) => [name, own(values)]));
  return {...surface, positions: own(surface.positions), triangles: own(surface.triangles), normals: own(surface.normals), fields};
}

/** A grid whose isosurfaces the graphics card makes, where it can. Methods return promises; arrays are the caller's own. */
export class DeviceGrid {
  /** @param kind  as CardOfModule.open() */
  static async create(grid, kind) {
    const {points, cells, fields, times, notes, threads} = grid;
    grid.card = new CardOfModule(grid.exports, grid.memory);
    await grid.card.open(kind);
    await grid.card.use().catch((error) => { throw grid.stopped(error); });
    return Object.assign(new DeviceGrid(), {grid, points, cells, fields, times, notes, threads});
  }

  last = Promise.resolve(); // of the calls, one after another

  after(work) {
    const done = this.last.then(work);
    this.last = done.catch(() => {});
    return done;
  }

  /** Of the graphics card; null: the processor makes all surfaces, because of whyNoDevice. */
  get device() { return this.grid.card.card?.info ?? null; }

  get whyNoDevice() { return this.grid.card.why; }

  contour(isovalue, options) {
    return this.after(async () => ownSurface(this.grid.surface(await this.grid.callWithCard(this.grid.contourMessage(isovalue, options)))));
  }

  range(options) { return this.after(() => this.grid.range(options)); }

  close() { this.grid.close(); }
}

const withDevice = (grid, kind) => (kind ? DeviceGrid.create(grid, kind) : grid);

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
export async function open(data, {name = 'grid', files = {}, onProgress, threads, device} = {}) {
  const all = Object.fromEntries(Object.entries(files).map(([path, content]) => [path, fileOf(content)]));
  const kind = await kindOf(data), grid = await Grid.create(kind, {...all, [name]: fileOf(data)}, onProgress, threadsFor(kind, threads));
  return withDevice(grid.open({do: 'open', path: name}), device);
}

/** @see isotet.d.ts */
export async function fromArrays({points, cells, values}, {threads, device} = {}) {
  const grid = await Grid.create('packed', {}, null, threadsFor('packed', threads));
  try {
    return await withDevice(grid.open(grid.messageOf(points, cells, values)), device);
  } catch (error) {
    grid.close();
    throw error;
  }
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
      threadsFailed ||= Boolean(data.threadsFailed);
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

async function remote(kind, threads, worker, onProgress, method, ...words) {
  const grid = new RemoteGrid(worker ?? new Worker(new URL('isotet_worker.js', import.meta.url), {type: 'module'}));
  grid.onProgress = onProgress;
  return Object.assign(grid, await grid.ask(method, ...words, {threads}, await modulesFor(kind, threads)));
}

export async function openInWorker(data, {worker, onProgress, threads, ...options} = {}) {
  const kind = await kindOf(data);
  return remote(kind, threadsFor(kind, threads), worker, onProgress, 'open', data, options);
}

export const fromArraysInWorker = (grid, {worker, threads, device} = {}) => remote('packed', threadsFor('packed', threads), worker, null, 'fromArrays', grid, {device});
