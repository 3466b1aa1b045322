// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly (src/web/module.cpp) in a thread of its own. It is told {engine, grid, told} once, and then messages of
// the page; what it says goes back as {text} or {frame}.
'use strict';

const noEntry = 44, badDescriptor = 8, notSupported = 58; // of WASI
const folder = 3, opened = 4, plainFile = 4, aFolder = 3;

/** What WASI must have: one file, /grid.isotet, that is read. */
class OneFile {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }

  view() { return new DataView(this.memory.buffer); }

  text(at, length) { return new TextDecoder().decode(new Uint8Array(this.memory.buffer, at, length)); }

  /** Fills parts of memory with the file from a place on; returns how many bytes. */
  read(from, parts, count) {
    const view = this.view();
    let at = from;
    for (let i = 0; i < count; ++i) {
      const to = view.getUint32(parts + 8 * i, true), room = view.getUint32(parts + 8 * i + 4, true);
      const part = this.bytes.subarray(at, at + room);
      new Uint8Array(this.memory.buffer).set(part, to);
      at += part.length;
    }
    return at - from;
  }

  status(to, kind) {
    const view = this.view();
    for (let i = 0; i < 64; i += 8) view.setBigUint64(to + i, 0n, true);
    view.setUint8(to + 16, kind);
    if (kind === plainFile) view.setBigUint64(to + 32, BigInt(this.bytes.length), true);
    return 0;
  }

  imports() {
    const refuse = () => notSupported, isGrid = (at, length) => this.text(at, length).replace(/^[./]+/, '') === 'grid.isotet';
    const own = {
      fd_prestat_get: (file, to) => {
        if (file !== folder) return badDescriptor;
        this.view().setUint32(to, 0, true);
        this.view().setUint32(to + 4, 1, true);
        return 0;
      },
      fd_prestat_dir_name: (_file, to) => { this.view().setUint8(to, 47); return 0; }, // "/"
      fd_fdstat_get: (file, to) => {
        const view = this.view();
        for (let i = 0; i < 24; i += 8) view.setBigUint64(to + i, 0n, true);
        view.setUint8(to, file === folder ? aFolder : plainFile);
        view.setBigUint64(to + 8, 0xffffffffn, true);
        view.setBigUint64(to + 16, 0xffffffffn, true);
        return 0;
      },
      fd_filestat_get: (file, to) => this.status(to, file === folder ? aFolder : plainFile),
      path_filestat_get: (_file, _flags, name, length, to) => (isGrid(name, length) ? this.status(to, plainFile) : noEntry),
      path_open: (_file, _lookup, name, length, _flags, _rights, _inherited, _more, to) => {
        if (!isGrid(name, length)) return noEntry;
        this.at = 0;
        this.view().setUint32(to, opened, true);
        return 0;
      },
      fd_pread: (_file, parts, count, from, to) => { this.view().setUint32(to, this.read(Number(from), parts, count), true); return 0; },
      fd_read: (_file, parts, count, to) => {
        const got = this.read(this.at, parts, count);
        this.at += got;
        this.view().setUint32(to, got, true);
        return 0;
      },
      fd_close: () => 0,
      fd_write: (_file, parts, count, to) => {
        let written = 0;
        for (let i = 0; i < count; ++i) written += this.view().getUint32(parts + 8 * i + 4, true);
        this.view().setUint32(to, written, true);
        return 0;
      },
      clock_time_get: (_clock, _precision, to) => { this.view().setBigUint64(to, BigInt(Math.round(1e6 * performance.now())), true); return 0; },
      environ_sizes_get: (count, size) => { this.view().setUint32(count, 0, true); this.view().setUint32(size, 0, true); return 0; },
      environ_get: () => 0,
      proc_exit: (status) => { throw new Error(`isotet ended (${status})`); },
    };
    return new Proxy(own, {get: (all, name) => all[name] || refuse, has: () => true});
  }
}

/** isotet, with a grid; `say` takes {text}, {frame} and, of extract(), {positions, triangles}. */
async function startEngine({engine, grid, told}, say) {
  const file = new OneFile(grid);
  const bytes = (at, count) => new Uint8Array(file.memory.buffer).slice(at, at + count);
  const page = {
    text: (at, count) => say({text: JSON.parse(new TextDecoder().decode(bytes(at, count)))}),
    frame: (at, count) => say({frame: bytes(at, count).buffer}),
    surface: (places, placeBytes, corners, cornerBytes) => say({positions: bytes(places, placeBytes).buffer, triangles: bytes(corners, cornerBytes).buffer}),
  };
  const {instance} = await WebAssembly.instantiate(engine, {page, wasi_snapshot_preview1: file.imports()});
  const {exports} = instance;
  file.memory = exports.memory;
  exports._initialize();
  const tell = (message) => {
    const text = new TextEncoder().encode(JSON.stringify(message));
    const at = exports.room(text.length);
    new Uint8Array(exports.memory.buffer).set(text, at);
  };
  tell(told);
  exports.open();
  return {
    answer(message) {
      tell(message);
      exports.answer();
    },
    extract(field, isovalue) {
      const name = new TextEncoder().encode(field), at = exports.room(name.length);
      new Uint8Array(exports.memory.buffer).set(name, at);
      exports.extract(isovalue);
    },
  };
}

if (typeof onmessage !== 'undefined' && typeof document === 'undefined') {
  const say = (message) => postMessage(message, message.frame ? [message.frame] : []);
  const why = (error) => (error instanceof WebAssembly.RuntimeError ? 'isotet stopped, for lack of memory perhaps' : error.message);
  const failed = (error) => say({text: {say: 'error', about: 'engine', sentence: `The grid cannot be looked at: ${why(error)}.`}});
  let isotet = null;
  onmessage = async ({data}) => {
    try {
      if (isotet) isotet.answer(data);
      else isotet = await startEngine(data, say);
    } catch (error) {
      failed(error);
    }
  };
}
