// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the page asks the server for, and how much of it it can take.
import {app, id} from './app.js';
import * as format from './format.js';
import {cellsOf, planesOf, toMessage} from './state.js';

/** Why the server draws, or nothing where the browser does. */
export const serverDraws = () => (!app.scene ? 'no WebGL2 here' : app.grid?.saved ? '' : app.state.volume ? 'a volume' : app.state.drawn === 'server' ? 'chosen' :
  app.large && app.state.drawn !== 'browser' ? `${format.rough(app.large)} triangles are too many for the browser` : '');

/** Where surfaces are too large for the browser the server draws, until they are a quarter smaller. */
export function noteSize(next) {
  const most = Number(document.body.dataset.most) || 8e6;
  const all = [...new Map(next.surfaces.filter(({kind}) => kind === 'surface').map((one) => [one.isovalue, one.triangles])).values()].reduce((a, b) => a + b, 0);
  const before = serverDraws();
  if (all > most) app.large = all;
  else if (all < 0.75 * most) app.large = 0;
  if (!before === !serverDraws()) return;
  id('picture').hidden = !serverDraws();
  app.sent = null;
  wishSoon();
}

export const pictureSize = () => ['clientWidth', 'clientHeight'].map((side) => Math.max(1, Math.min(4096, Math.round(id('scene')[side] * (window.devicePixelRatio || 1)))));

export function measureSpeed(took) {
  const drawn = (app.frame?.surfaces || []).reduce((sum, {key}) => sum + (app.scene.meshes.get(key)?.count || 0) / 3, 0);
  if (drawn < 20000) return;
  measured.speed = measured.speed === null ? drawn / took : 0.7 * measured.speed + 0.3 * drawn / took;
  // A preview from before the speed was known is replaced.
  const settled = app.frame.preview && app.frame.number === app.number && app.sent?.endsWith('|rest');
  if (settled && mostTriangles(false) > measured.lastMost) { app.sent = null; restSoon(); }
}

/** Bytes a ms of the line and triangles a ms of drawing, by the last frames; triangles that were asked for last. */
const measured = {line: null, speed: null, lastMost: 0};
let waiting = 0, restTimer = 0, wishPlanned = false;

export function stopWaiting() {
  clearTimeout(waiting);
  waiting = 0;
  id('stage').classList.remove('waiting');
  id('bar').hidden = true;
}

/** The picture becomes pale where no frame comes for a while. */
function startWaiting() {
  waiting ||= setTimeout(() => { id('stage').classList.add('waiting'); id('bar').hidden = false; }, 200);
}

/** A pale picture stays so until the newest frame is there. */
export function frameCame(number) {
  if (number >= app.number) return stopWaiting();
  if (!id('bar').hidden) return;
  stopWaiting();
  startWaiting();
}

/** What a frame depends on. */
const wanted = () => JSON.stringify([app.state.field, app.state.value, app.state.pins.map((pin) => pin.value), app.state.colorBy, app.state.map, app.state.range, app.state.logarithmic,
  planesOf(app.state, 'slice'), app.state.boundary > 0, app.state.isosurfaces, app.state.coloredBoundary, app.state.solid, app.state.keep, cellsOf(app.state), app.state.step, document.body.dataset.step, serverDraws() && [app.camera.text(), pictureSize(), toMessage(app.state)]]);

/** Bytes a ms of the line, by frames that are large enough to tell. */
export function measureLine(next) {
  const took = performance.now() - (app.sentAt.get(next.number) ?? NaN) - next.wait_ms - next.extract_ms - next.mesh_ms;
  if (next.bytes < 200000 || !(took > 0)) return;
  measured.line = measured.line === null ? next.bytes / took : 0.7 * measured.line + 0.3 * next.bytes / took;
}

/** Triangles of a surface that are drawn in time: 40 ms for a hand that moves, 1.5 s for one that rests. In few steps. */
function mostTriangles(moving) {
  const [ms, least, limit] = moving ? [40, 30000, 600000] : [1500, 150000, 8e6];
  const parts = Math.max(1, app.frame?.surfaces.length || 1); // share the time
  const sent_in_time = measured.line === null ? Infinity : measured.line * (moving ? 100 : 2000) / (14 * parts); // 14 bytes a triangle
  const most = Math.max(least, Math.min(limit, measured.speed === null ? 100000 : measured.speed * ms / parts, sent_in_time));
  return Math.round(10000 * 2 ** Math.floor(Math.log2(most / 10000)));
}

function wish(moving) {
  wishPlanned = false;
  if (!app.grid || !app.state.field || app.state.value === null) return;
  app.changed();
  const what = wanted() + (moving ? '' : '|rest');
  if (what === app.sent || (moving && app.sent === wanted() + '|rest')) return;
  const message = {do: 'show', number: app.number + 1, state: toMessage(app.state), moving, most: mostTriangles(moving)};
  if (serverDraws()) Object.assign(message, {picture: pictureSize()}).state.camera = app.camera.text();
  else delete message.state.camera;
  if (app.time.playing) message.next = app.time.next(app.state.step);
  if (!app.link.send(message)) return;
  app.sent = what;
  measured.lastMost = message.most;
  app.sentAt.set(++app.number, performance.now());
  startWaiting();
}

/** A wish a picture of the screen, however fast the hand is; when it rests, in full. The first one does not wait for a picture. */
export function wishSoon() {
  if (!wishPlanned) {
    wishPlanned = true;
    if (app.number === 0) queueMicrotask(() => wish(true));
    else requestAnimationFrame(() => wish(true));
  }
  restSoon();
}

export function restSoon() {
  clearTimeout(restTimer);
  restTimer = setTimeout(() => wish(false), 150);
}

/** What the page asks for is on the screen, in full. */
export const isAtRest = () => app.frame?.number === app.number && app.sent === wanted() + '|rest';

/** Curved cells are refined where nothing moves: the surface that is shown is made anew, and takes its time. */
export function refineSoon() {
  if (!app.grid.refines || app.state.solid || app.frame.picture || app.frame.preview || app.frame.field_bound != null) return;
  if (!isAtRest()) return;
  const message = {do: 'refine', number: app.number + 1, state: toMessage(app.state), most: measured.lastMost};
  delete message.state.camera;
  if (!app.link.send(message)) return;
  app.sentAt.set(++app.number, performance.now());
}
