// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// In place of the socket (link.js) where the page is a file: isotet as WebAssembly answers, in a thread (engine_worker.js).
import {readFrame} from './frame.js';
import {nothingShown, surfaceFile} from './mesh_files.js';
import {unpack} from './unpack.js';

/** The graphics card, unless the address says `?card=off`; with `?card=any` one that is the processor too. */
const chosenCard = () => ({off: '', any: 'webgpu-software'}[new URLSearchParams(location.search).get('card')] ?? 'webgpu');

export class EngineLink {
  /** @param on  as that of link.js */
  constructor(on) {
    this.on = on;
    this.forget();
  }

  forget() {
    this.worker?.terminate();
    this.worker = this.beginning = null;
    this.ready = false;
    this.meshes = new Map(); // of the last frame
    this.wish = null;        // the newest that waits
    this.working = false;    // on a frame
  }

  failed(why) { this.take({text: {say: 'error', about: 'engine', sentence: `The grid cannot be looked at: ${why}.`}}); }

  /** @param message()  {engine, grid or blobs, told}: as the thread takes it */
  begin(message) { this.started = this.startThread(message).catch((error) => this.failed(error.message)); }

  async startThread(message) {
    const beginning = this.beginning = {}, told = message(), code = await unpack('worker');
    if (this.beginning !== beginning) return; // another file was chosen
    for (const address of [URL.createObjectURL(new Blob([code], {type: 'text/javascript'})), `data:text/javascript,${encodeURIComponent(new TextDecoder().decode(code))}`]) {
      if (await this.runs(address, {...told, card: chosenCard()})) return;
    }
    this.failed('the page around this one lets no thread begin');
  }

  /** False where the policy of a page around this one forbids such an address: that of VS Code's notebooks blob:, others data:. */
  runs(address, message) {
    return new Promise((resolve) => {
      const worker = this.worker = new Worker(address);
      worker.postMessage(message);
      worker.onmessage = ({data}) => (data.started ? resolve(true) : this.take(data));
      worker.onerror = ({message: why}) => { if (why) this.failed(why); resolve(Boolean(why)); };
    }).catch(() => false); // some browsers throw
  }

  take({text, frame, spent}) {
    if (frame) {
      this.working = false;
      const read = readFrame(frame);
      read.extract_ms += spent;
      this.keep(read);
      this.next();
      return;
    }
    if (text.say === 'refused' || text.about === 'engine') this.working = false;
    if (text.say === 'welcome') {
      this.ready = true;
      this.on.open();
    }
    this.on.text(text);
    this.next();
  }

  keep(frame) {
    const meshes = new Map();
    for (const {key, mesh} of frame.surfaces) meshes.set(key, mesh || this.meshes.get(key));
    this.meshes = meshes;
    this.frame = frame;
    this.on.frame(frame);
  }

  next() {
    if (this.working || !this.wish) return;
    this.working = true;
    this.worker.postMessage(this.wish);
    this.wish = null;
  }

  restart() { location.reload(); }

  send(message) {
    if (!this.ready) return false;
    if (message.do === 'show' || message.do === 'refine') {
      this.wish = message;
      this.next();
    } else if (['chart', 'spectrum', 'pick', 'parts', 'share', 'measure'].includes(message.do)) this.worker.postMessage(message);
    else if (message.do === 'save') this.save(message);
    else if (message.do === 'part') this.on.part(this.file);
    return true;
  }

  /** The isosurfaces that are shown, as a file, or the boundary where there are none. */
  save({name, kind, state}) {
    const answer = (message) => setTimeout(() => this.on.text(message));
    const shown = this.frame.surfaces.filter((one) => one.kind === (state.isosurfaces ? 'surface' : 'boundary'));
    if (shown.length === 0) return answer({say: 'error', about: 'save', sentence: nothingShown});
    this.file = kind === 'surface' ? surfaceFile(name, [...new Set(shown.map(({key}) => key))].map((key) => this.meshes.get(key)), shown) : null;
    if (this.file) answer({say: 'download', name, bytes: this.file.length});
    else answer({say: 'error', about: 'save', sentence: 'This page writes pictures (.png) and surfaces (.stl, .glb).'});
  }
}
