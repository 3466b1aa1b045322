// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The files that isotet as WebAssembly reads, by the calls of WASI.

const noEntry = 44, badDescriptor = 8, notSupported = 58; // of WASI
const folder = 3, plainFile = 4, aFolder = 3;
const entryBytes = 24; // of a name in a folder, before its letters

/** "/a/./b/../c" as "a/c". */
function plainPath(path) {
  const parts = [];
  for (const part of path.split('/')) {
    if (part === '..') parts.pop();
    else if (part !== '' && part !== '.') parts.push(part);
  }
  return parts.join('/');
}

/** What each folder of paths holds: name -> whether it is a folder. */
function foldersOf(paths) {
  const folders = new Map([['', new Map()]]);
  for (const path of paths) {
    const parts = path.split('/');
    for (let i = 0; i < parts.length; ++i) {
      const at = parts.slice(0, i).join('/');
      if (!folders.has(at)) folders.set(at, new Map());
      folders.get(at).set(parts[i], i + 1 < parts.length);
    }
  }
  return folders;
}

/** Bytes in memory, read as a file. */
export const bytesAsFile = (bytes) => ({size: bytes.length, read: (at, count) => bytes.subarray(at, at + count)});

/** A file of the user, read where it is needed: it may be larger than memory. Of a thread (FileReaderSync). */
export function blobAsFile(blob) {
  const reader = new FileReaderSync(), window = 1 << 20;
  const take = (at, count) => new Uint8Array(reader.readAsArrayBuffer(blob.slice(at, at + count)));
  let kept = new Uint8Array(0), from = 0;
  return {
    size: blob.size,
    read(at, count) {
      if (count >= window) return take(at, count);
      if (at < from || at + count > from + kept.length) [from, kept] = [at, take(at, window)];
      return kept.subarray(at - from, at - from + count);
    },
  };
}

/** Files by their names, where one alone has the name. In a case of OpenFOAM a name is that of a field, in each step. */
function onlyOnesOf(files) {
  const found = new Map();
  for (const [path, file] of files) {
    if (path.includes('polyMesh/')) return new Map();
    const name = path.split('/').pop();
    found.set(name, found.has(name) ? undefined : file);
  }
  return found;
}

/** What WASI must have: files that are read, by their paths. */
export class Files {
  /** @param files  {path: {size, read(at, count)}} */
  constructor(files) {
    this.files = new Map(Object.entries(files).map(([path, file]) => [plainPath(path), file]));
    this.folders = foldersOf(this.files.keys());
    this.byName = onlyOnesOf(this.files);
    this.opened = new Map(); // by descriptor
    this.next = folder + 1;
  }

  view() { return new DataView(this.memory.buffer); }

  path(at, length) { return plainPath(new TextDecoder('utf-8', {ignoreBOM: true}).decode(new Uint8Array(this.memory.buffer, at, length))); }

  /** A file that was given without its folder, or in another one, is found by its name. */
  find(path) {
    const name = path.split('/').pop();
    return this.files.get(path) ?? this.files.get(name) ?? this.byName.get(name);
  }

  /** The names of a folder from a place on, as WASI has them; returns how many bytes. */
  list(names, from, to, room) {
    const view = this.view();
    let at = 0;
    for (let i = from; i < names.length && at < room; ++i) {
      const [name, isFolder] = names[i], letters = new TextEncoder().encode(name), entry = new DataView(new ArrayBuffer(entryBytes));
      entry.setBigUint64(0, BigInt(i + 1), true);
      entry.setBigUint64(8, BigInt(i + 1), true);
      entry.setUint32(16, letters.length, true);
      entry.setUint8(20, isFolder ? aFolder : plainFile);
      for (const part of [new Uint8Array(entry.buffer), letters]) { // the last may be cut: it is asked for again
        const count = Math.min(part.length, room - at);
        new Uint8Array(view.buffer).set(part.subarray(0, count), to + at);
        at += count;
      }
    }
    return at;
  }

  /** Fills parts of memory with a file from a place on; returns how many bytes. */
  read(file, from, parts, count) {
    const view = this.view();
    let at = from;
    for (let i = 0; i < count; ++i) {
      const to = view.getUint32(parts + 8 * i, true), room = Math.min(view.getUint32(parts + 8 * i + 4, true), Math.max(0, file.size - at));
      const part = room > 0 ? file.read(at, room) : new Uint8Array(0);
      new Uint8Array(this.memory.buffer).set(part, to);
      at += part.length;
    }
    return at - from;
  }

  status(to, kind, size, number = 0) {
    const view = this.view();
    for (let i = 0; i < 64; i += 8) view.setBigUint64(to + i, 0n, true);
    view.setBigUint64(to + 8, BigInt(number), true);
    view.setUint8(to + 16, kind);
    view.setBigUint64(to + 32, BigInt(size), true);
    return 0;
  }

  imports() {
    const refuse = () => notSupported;
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
        view.setUint8(to, file === folder || this.opened.get(file)?.names ? aFolder : plainFile);
        view.setBigUint64(to + 8, 0xffffffffn, true);
        view.setBigUint64(to + 16, 0xffffffffn, true);
        return 0;
      },
      fd_filestat_get: (number, to) => {
        const opened = this.opened.get(number);
        return opened?.file ? this.status(to, plainFile, opened.file.size, number) : this.status(to, aFolder, 0);
      },
      path_filestat_get: (_folder, _flags, name, length, to) => {
        const path = this.path(name, length), file = this.find(path);
        if (this.folders.has(path)) return this.status(to, aFolder, 0);
        return file ? this.status(to, plainFile, file.size) : noEntry;
      },
      path_open: (_folder, _lookup, name, length, _flags, _rights, _inherited, _more, to) => {
        const path = this.path(name, length), names = this.folders.get(path), file = names ? null : this.find(path);
        if (file === undefined) return noEntry;
        this.opened.set(this.next, {file, names: names && [...names], at: 0});
        this.view().setUint32(to, this.next++, true);
        return 0;
      },
      fd_readdir: (number, to, room, from, count) => {
        const names = this.opened.get(number)?.names;
        if (!names) return badDescriptor;
        this.view().setUint32(count, this.list(names, Number(from), to, room), true);
        return 0;
      },
      fd_pread: (number, parts, count, from, to) => {
        const opened = this.opened.get(number);
        if (!opened?.file) return badDescriptor;
        this.view().setUint32(to, this.read(opened.file, Number(from), parts, count), true);
        return 0;
      },
      fd_read: (number, parts, count, to) => {
        const opened = this.opened.get(number);
        if (!opened?.file) return badDescriptor;
        const got = this.read(opened.file, opened.at, parts, count);
        opened.at += got;
        this.view().setUint32(to, got, true);
        return 0;
      },
      fd_close: (number) => { this.opened.delete(number); return 0; },
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
