// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly (src/web) in a thread of its own. It is told {engine, grid, told} once, or {engine, blobs, told}, and then
// messages of the page; what it says goes back as {started}, {text} or {frame}. Engine and grid are deflated, in base64. `card`
// names the kind of graphics card that is used (webgpu.js); nothing: none.
import {allBytes, damaged, fromBase64, inflated} from './base64.js';
import {blobAsFile, bytesAsFile, Files} from './engine_files.js';
import {CardOfModule} from './webgpu.js';

/** Compiled while it is inflated. */
async function compiled(text) {
  const response = new Response(inflated(fromBase64(text)), {headers: {'Content-Type': 'application/wasm'}});
  try {
    return await WebAssembly.compileStreaming(response);
  } catch (error) {
    throw error instanceof WebAssembly.CompileError ? new Error(`this browser cannot run isotet: ${error.message}`) : damaged();
  }
}

/**
 * isotet as WebAssembly, with a grid: packed, as bytes, or files that its readers read.
 * @param engine a module, or its bytes
 * @param files  {path: {size, read}}, of which told.files names those to read; in place of `grid`
 * @param say    takes {text}, {frame, spent: ms of the card} and, of extract(), {positions, triangles}
 * @returns      what answers; its answer() is done at once where `card.card` is null, else when its promise is
 */
export async function startEngine({engine, grid, files, told}, say) {
  let card = null;
  const given = new Files(files || {'grid.isotet': bytesAsFile(grid)});
  const bytes = (at, count) => new Uint8Array(given.memory.buffer).slice(at, at + count);
  const page = {
    text: (at, count) => {
      const text = JSON.parse(new TextDecoder().decode(bytes(at, count)));
      if (!card?.take(text)) say({text});
    },
    frame: (at, count) => say({frame: bytes(at, count).buffer, spent: card.spent}),
    surface: (places, placeBytes, corners, cornerBytes) => say({positions: bytes(places, placeBytes).buffer, triangles: bytes(corners, cornerBytes).buffer}),
  };
  const made = await WebAssembly.instantiate(engine, {page, wasi_snapshot_preview1: given.imports()}), {exports} = made.instance ?? made;
  given.memory = exports.memory;
  exports._initialize();
  card = new CardOfModule(exports, exports.memory);
  const tell = (text) => {
    const letters = new TextEncoder().encode(text), at = exports.room(letters.length);
    new Uint8Array(exports.memory.buffer).set(letters, at);
  };
  tell(JSON.stringify(told));
  if (files) exports.read();
  else exports.open();
  return {
    card,
    answer(message) {
      const call = () => { tell(JSON.stringify(message)); exports.answer(); };
      card.spent = 0;
      return card.card ? card.settle(call) : call();
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
  const sayCard = () => {
    const {card, why} = isotet.card;
    say({text: {say: 'card', info: card?.info ?? null, why}});
  };
  /** The card is opened while the first surface is made, and tested when nothing else is done. */
  const beginCard = async (kind) => {
    await isotet.card.open(kind);
    later(async () => { await isotet.card.use(); sayCard(); });
  };
  const answer = async (data) => {
    const had = isotet.card.card;
    if (data.do === 'measure') return say({text: {say: 'measured', surfaces: await isotet.card.measure()}});
    await isotet.answer(data);
    if (had && !isotet.card.card) sayCard();
    if (waits && data.do === 'show') setTimeout(() => later(prepare)); // the first surface is shown meanwhile
    waits = waits && data.do !== 'show';
  };
  /** One after another. */
  let last = Promise.resolve();
  const later = (work) => { last = last.then(work).catch(failed); };
  onmessage = async ({data}) => {
    if (isotet) return later(() => answer(data));
    try {
      const files = data.blobs && Object.fromEntries(data.blobs.map(({path, blob}) => [path, blobAsFile(blob)]));
      const [engine, grid] = await Promise.all([compiled(data.engine), data.grid !== undefined && allBytes(inflated(fromBase64(data.grid)))]);
      isotet = await startEngine({engine, grid, files, told: data.told}, say);
      if (data.card) beginCard(data.card);
    } catch (error) {
      failed(error);
    }
  };
}
