// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// In place of the socket (link.js) where the page is a file of `isotet export`: what the server would say stands in the file.
import {looksOf} from '../draw/looks.js';
import {nothingShown, surfaceFile} from './mesh_files.js';
import {decodeMesh, savedMessage, unpack} from './unpack.js';

const maxKept = 256e6; // bytes of meshes that were unpacked

export class Link {
  /** @param on  as that of link.js */
  constructor(_token, on) {
    this.on = on;
    this.saved = null;
    this.meshes = new Map(); // by their names, the one that was used last at the end
    this.known = new Set();  // keys that the page has
    this.wish = null;
    setTimeout(() => this.begin());
  }

  begin() {
    try {
      this.saved = savedMessage();
      this.on.open();
      this.on.text(this.saved.welcome);
      this.on.text(this.saved.grid);
      this.on.text({say: 'progress', step: 'ready', fraction: 1});
    } catch (error) {
      this.on.text({say: 'error', about: 'page', sentence: `Nothing can be shown: ${error.message}.`});
    }
  }

  restart() {
    this.known.clear();
    this.begin();
  }

  send(message) {
    const {saved} = this, step = message.step ?? 0;
    if (!saved) return false;
    if (message.do === 'show') this.show(message);
    if (message.do === 'chart') this.answer(message, saved.charts, step);
    if (message.do === 'spectrum') this.answer(message, saved.spectra, step);
    if (message.do === 'pick') this.say({say: 'picked', point: message.point, values: []});
    if (message.do === 'save') this.save(message);
    if (message.do === 'part') this.on.part(this.file);
    return true;
  }

  /** As a server: later, and nothing where there is no answer. */
  say(message) {
    if (message) setTimeout(() => this.on.text(message));
  }

  answer({field, cells = []}, answers, step) {
    const found = answers.find((one) => one.field === field && one.step === step);
    if (found) this.say({...found, cells});
  }

  /** The newest wish only. */
  async show(message) {
    const working = this.wish !== null;
    this.wish = message;
    if (working) return;
    while (this.wish) {
      const next = this.wish;
      try {
        this.on.frame(await this.frame(next));
      } catch (error) {
        this.on.text({say: 'refused', number: next.number, sentence: `A surface of this file cannot be shown: ${error.message}`});
      }
      if (this.wish === next) this.wish = null;
    }
  }

  /** It goes on until there is another one. */
  boundaryAt(step) { return this.saved.boundaries.filter((one) => one.step <= step).pop(); }

  /** The surface of the nearest value at a step. */
  nearest(step, value) {
    return this.saved.surfaces.filter((one) => one.step === step).reduce((best, one) => (Math.abs(one.isovalue - value) < Math.abs(best.isovalue - value) ? one : best));
  }

  async mesh(name, told) {
    let mesh = this.meshes.get(name);
    this.meshes.delete(name);
    if (!mesh) mesh = decodeMesh(await unpack(name), told);
    this.meshes.set(name, mesh);
    let kept = [...this.meshes.values()].reduce((sum, {vertexBytes, corners}) => sum + vertexBytes.length + (corners?.byteLength ?? 0), 0);
    for (const [old, {vertexBytes, corners}] of this.meshes) {
      if (kept <= maxKept || old === name) break;
      kept -= vertexBytes.length + (corners?.byteLength ?? 0);
      this.meshes.delete(old);
    }
    return mesh;
  }

  async frame({number, state, picture}) {
    if (picture) throw new Error('this browser has no WebGL2, which draws it');
    const step = state.step ?? 0, start = performance.now(), shown = state.isosurfaces ? state.isovalues.map((value) => this.nearest(step, value)) : [];
    const once = [...new Set(shown)], looks = looksOf(once, this.saved.welcome.maps[state.map], state.opacity ?? null);
    const surfaces = shown.map((one) => ({key: one.part, kind: 'surface', isovalue: one.isovalue, triangles: one.triangles, ...looks[once.indexOf(one)], told: one.mesh}));
    const boundary = this.boundaryAt(step);
    if (boundary && state.boundary > 0) surfaces.push({key: boundary.part, kind: 'boundary', color: boundary.color, opacity: state.boundary, triangles: boundary.triangles, told: boundary.mesh});
    const keys = new Set();
    let bytes = 0;
    for (const one of surfaces) {
      if (!this.known.has(one.key) && !keys.has(one.key)) {
        one.mesh = await this.mesh(one.key, one.told);
        bytes += one.told.bytes;
      }
      keys.add(one.key);
      delete one.told;
    }
    this.known = keys;
    const {notes, range, field_bound, scale} = shown[0] ?? boundary ?? {notes: []};
    return {number, preview: false, method: 'saved', extract_ms: 0, mesh_ms: performance.now() - start, wait_ms: 0, step, field: state.field, notes, range, field_bound, scale, surfaces, bytes};
  }

  /** Isosurfaces of a state as a file, or its boundary where that is shown alone, by the ending of its name. */
  async save({kind, name, state}) {
    const refuse = (sentence) => this.say({say: 'error', about: 'save', sentence});
    try {
      const step = state.step ?? 0, surfaces = state.isosurfaces ? state.isovalues.map((value) => this.nearest(step, value)) : [];
      const boundary = state.isosurfaces || state.boundary === 0 ? null : this.boundaryAt(step);
      const once = boundary ? [{...boundary, opacity: 1}] : [...new Set(surfaces)], meshes = [];
      if (once.length === 0) return refuse(nothingShown);
      for (const one of once) meshes.push(await this.mesh(one.part, one.mesh));
      this.file = kind === 'surface' ? surfaceFile(name, meshes, boundary ? once : looksOf(once, this.saved.welcome.maps[state.map], state.opacity ?? null)) : null;
      if (this.file) this.on.text({say: 'download', name, bytes: this.file.length});
      else refuse('This page writes pictures (.png) and surfaces (.stl, .glb).');
    } catch (error) {
      refuse(`The surface could not be written: ${error.message}`);
    }
  }
}
