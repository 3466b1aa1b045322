// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause

/** Numbers of a grid. Grids in float64 have surfaces in float64. */
export type Numbers = Float32Array | Float64Array;
export type Integers = Int32Array | Uint32Array | BigInt64Array | BigUint64Array;

export interface FieldInfo {
  name: string;
  /** Of a vector, contour takes "U:mag", "U:x" and so on. */
  components: number;
  /** Values are of cells: contour averages them to the points. */
  cell: boolean;
}

export interface ContourOptions {
  /** The field to contour, or an expression of fields such as "mag(U)"; default: the first one. */
  field?: string;
  /** Fields that the surface carries, as values at its vertices. */
  fields?: string[];
  /** "vertex": one for each vertex, of unit length, towards higher values. Default: "none". */
  normals?: 'none' | 'vertex';
  /** Time step, of a file that has several. */
  step?: number;
  /** No other isovalue will be asked for: the grid is not packed. */
  once?: boolean;
}

export interface Surface {
  /** x, y, z of each vertex. */
  positions: Numbers;
  /** Three vertices for each triangle, counter-clockwise seen from the side of higher values. Every edge that is cut gives one vertex. */
  triangles: Uint32Array;
  /** x, y, z for each vertex, or null. */
  normals: Float32Array | null;
  /** A value for each vertex, of each of ContourOptions.fields. */
  fields: Record<string, Numbers>;
  method: 'direct' | 'clusters';
  notes: string[];
}

interface Described {
  readonly points: number;
  readonly cells: number;
  readonly fields: FieldInfo[];
  /** Of its time steps; empty where it has one. */
  readonly times: number[];
  /** What was found while reading. */
  readonly notes: string[];
  /** How many threads pack and extract. */
  readonly threads: number;
}

/** A grid in the memory of an instance of isotet: at most 4 GB. Methods throw an Error whose message says what is wrong. */
export interface Grid extends Described {
  /**
   * The surface on which the field has this value: the same bytes as the program's. The first call packs the grid, unless `once`;
   * later ones take time in proportion to the surface.
   *
   * Its arrays are views of the instance's memory, without a copy: they are valid until the next call of any method. `slice()` keeps
   * one. Where there are several threads, the memory is a SharedArrayBuffer: what takes none of it (Blob, TextDecoder) takes a slice().
   */
  contour(isovalue: number, options?: ContourOptions): Surface;
  /** The smallest and the largest finite value of the field. */
  range(options?: ContourOptions): [number, number];
  /** Gives its memory back, once no surface of it is used any more, and ends its threads. */
  close(): void;
}

/** The graphics card that makes surfaces, as the browser names it. */
export interface DeviceInfo {
  vendor: string;
  architecture: string;
  device: string;
  description: string;
  /** Of a buffer at most. */
  bindingBytes: number;
}

/**
 * A grid of `device: 'webgpu'`. The card makes surfaces in single precision without `fields`, from the second isovalue in a row of a
 * field on: the same triangles in the same order, coordinates within one unit in the last place, as a small grid has tested. The
 * processor makes all others, and all after the card has failed. Calls are made one after another; arrays are copies, which stay valid.
 */
export interface DeviceGrid extends Described {
  /** Null: there is none, because of whyNoDevice. */
  readonly device: DeviceInfo | null;
  readonly whyNoDevice: string;
  contour(isovalue: number, options?: ContourOptions): Promise<Surface>;
  range(options?: ContourOptions): Promise<[number, number]>;
  close(): void;
}

export interface DeviceOptions {
  /** 'webgpu': a graphics card, where there is one; 'webgpu-software': the browser's software adapter too, which is slower than the processor. */
  device?: 'webgpu' | 'webgpu-software';
}

/** The same in a thread (Worker). Arrays of surfaces are copies, which stay valid. */
export interface RemoteGrid extends Described {
  /** With `device`, as when it was opened. */
  readonly device?: DeviceInfo | null;
  readonly whyNoDevice?: string;
  contour(isovalue: number, options?: ContourOptions): Promise<Surface>;
  range(options?: ContourOptions): Promise<[number, number]>;
  close(): void;
}

export type Content = ArrayBuffer | ArrayBufferView | Blob;

export interface ThreadOptions {
  /**
   * How many threads pack and extract arrays and packed files, up to 16; surfaces are the same bytes. Default: as many as the machine
   * has in a page that is isolated (crossOriginIsolated), one in Node. Elsewhere, where memory for them is missing, after
   * useModule(), and after a thread has failed, there is one.
   */
  threads?: number;
}

export interface OpenOptions extends ThreadOptions {
  /** Of the file. TetGen's files are known by it alone, others by what they hold. */
  name?: string;
  /** Other files by their paths: pieces of a PVTU, the .ele beside a .node. */
  files?: Record<string, Content>;
  onProgress?: (step: string, fraction: number) => void;
}

/**
 * Reads a grid: a packed one (.isotet), VTU, PVTU, legacy VTK, Gmsh, Medit, TetGen, AVS UCD, CalculiX, Gocad or GRDECL.
 * A Blob is read in parts, and only in a thread.
 */
export function open(data: Content, options: OpenOptions & Required<DeviceOptions>): Promise<DeviceGrid>;
export function open(data: Content, options?: OpenOptions): Promise<Grid>;

/** @param options.worker  a thread that runs isotet_worker.js, where the page makes it otherwise */
export function openInWorker(data: Content, options?: OpenOptions & DeviceOptions & {worker?: Worker}): Promise<RemoteGrid>;

export interface GridArrays {
  /** x, y, z of each point. */
  points: Numbers;
  /** Four corners for each tetrahedron; or cells of any type: corners, where those of each cell begin (one more than there are cells), VTK's types. */
  cells: Integers | {connectivity: Integers; offsets: Integers; types: Uint8Array};
  /** A value for each point: of one field, called "values", or of fields by their names. */
  values: Numbers | Integers | Record<string, Numbers | Integers>;
}

/** A grid out of arrays, which are copied. */
export function fromArrays(grid: GridArrays, options: ThreadOptions & Required<DeviceOptions>): Promise<DeviceGrid>;
export function fromArrays(grid: GridArrays, options?: ThreadOptions): Promise<Grid>;
export function fromArraysInWorker(grid: GridArrays, options?: ThreadOptions & DeviceOptions & {worker?: Worker}): Promise<RemoteGrid>;

/**
 * A module in place of those beside isotet.js, for all grids: its bytes, or compiled. isotet_engine.wasm takes arrays and packed files,
 * isotet_engine_readers.wasm all. Call it first.
 */
export function useModule(module: ArrayBuffer | Uint8Array | WebAssembly.Module): Promise<WebAssembly.Module>;
