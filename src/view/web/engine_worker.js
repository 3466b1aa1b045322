// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly (src/web) in a thread of its own. It is told {engine, grid, told} once, or {engine, blobs, told}, and then
// messages of the page; what it says goes back as {started}, {text} or {frame}. Engine and grid are deflated, in base64.
import {allBytes, fromBase64, inflated} from './base64.js';
import {blobAsFile, bytesAsFile, Files} from './engine_files.js';

/** Compiled while it is inflated. */
const compiled = (text) => WebAssembly.compileStreaming(new Response(inflated(fromBase64(text)), {headers: {'Content-Type': 'application/wasm'}}));

/**
 * isotet as WebAssembly, with a grid: packed, as bytes, or files that its readers read.
 * @param engine a module, or its bytes
 * @param files  {path: {size, read}}, of which told.files names those to read; in place of `grid`
 * @param say    takes {text}, {frame} and, of extract(), {positions, triangles}
 */
export async function startEngine({engine, grid, files, told}, say) {
  const given = new Files(files || {'grid.isotet': bytesAsFile(grid)});
  const bytes = (at, count) => new Uint8Array(given.memory.buffer).slice(at, at + count);
  const page = {
    text: (at, count) => say({text: JSON.parse(new TextDecoder().decode(bytes(at, count)))}),
    frame: (at, count) => say({frame: bytes(at, count).buffer}),
    surface: (places, placeBytes, corners, cornerBytes) => say({positions: bytes(places, placeBytes).buffer, triangles: bytes(corners, cornerBytes).buffer}),
  };
  const made = await WebAssembly.instantiate(engine, {page, wasi_snapshot_preview1: given.imports()}), {exports} = made.instance ?? made;
  given.memory = exports.memory;
  exports._initialize();
  const tell = (text) => {
    const letters = new TextEncoder().encode(text), at = exports.room(letters.length);
    new Uint8Array(exports.memory.buffer).set(letters, at);
  };
  tell(JSON.stringify(told));
  if (files) exports.read();
  else exports.open();
  return {
    answer(message) {
      tell(JSON.stringify(message));
      exports.answer();
    },
    extract(field, isovalue) {
      tell(field);
      exports.extract(isovalue);
    },
    /** Packs what was read. */
    prepare: () => exports.prepare?.(),
  };
}

if (typeof onmessage !== 'undefined' && typeof document === 'undefined') {
  const say = (message) => postMessage(message, message.frame ? [message.frame] : []);
  const why = (error) => (error instanceof WebAssembly.RuntimeError || error instanceof RangeError ?
    'isotet stopped, for lack of memory perhaps: a page may have 4 GB at most, the program all of the machine' : error.message);
  const failed = (error) => say({text: {say: 'error', about: 'engine', sentence: `The grid cannot be looked at: ${why(error)}.`}});
  say({started: true});
  let isotet = null, waits = true;
  const prepare = () => {
    try {
      isotet.prepare();
    } catch (error) {
      failed(error);
    }
  };
  onmessage = async ({data}) => {
    try {
      if (isotet) {
        isotet.answer(data);
        if (waits && data.do === 'show') setTimeout(prepare); // the first surface is shown meanwhile
        waits = waits && data.do !== 'show';
        return;
      }
      const files = data.blobs && Object.fromEntries(data.blobs.map(({path, blob}) => [path, blobAsFile(blob)]));
      const engine = compiled(data.engine), grid = data.grid && await allBytes(inflated(fromBase64(data.grid)));
      isotet = await startEngine({engine: await engine, grid, files, told: data.told}, say);
    } catch (error) {
      failed(error);
    }
  };
}
