// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ties the parts together: state -> wishes -> frames -> picture.
import {Camera} from './camera.js';
import {ChartSlider} from './chart.js';
import {Cuts} from './cuts.js';
import * as format from './format.js';
import {Link, readFrame} from './link.js';
import {Pointer} from './pointer.js';
import {Save} from './save.js';
import {Scene} from './scene.js';
import {fromAddress, fromMessage, planesOf, toAddress, toMessage} from './state.js';
import {TimeSteps} from './time.js';

const id = (name) => document.getElementById(name);
const [token, ...rest] = location.hash.slice(1).split('&');
let state = fromAddress(rest.join('&'));
const camera = new Camera();
let grid = null, maps = null, frame = null, scene = null;
let number = 0, saidAfter = 0, sent = null, sentAt = new Map(), waiting = 0, restTimer = 0, wishPlanned = false, drawPlanned = false;

// --- what is shown -------------------------------------------------------------------------------------------------

function css(name) { return getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim(); }

function showMessage(sentence) {
  id('message').textContent = sentence;
  id('message').hidden = !sentence;
}

/** Says it until a frame comes that was asked for after number `after`: one still on its way must not wipe it out. */
function say(sentence, after = number) {
  saidAfter = sentence ? after : 0;
  showMessage(sentence);
}

function showNotes(next) {
  if (next.number > saidAfter) say(next.notes.join(' '), 0);
}

/** Colour and opacity of what the frame has: the slider's surface, pinned ones, slices, the boundary. */
function dressed() {
  if (!frame) return [];
  // A surface that was pinned just now lies where the slider's still is: it is drawn once.
  const twice = isosurfaces().slice(1).some((one) => one.isovalue === frame.surfaces[0].isovalue);
  return frame.surfaces.map((surface, i) => {
    const {key, kind} = surface;
    if (kind === 'slice') return {key, kind, color: surface.color, opacity: 1};
    if (kind === 'boundary') return {key, kind, color: surface.color, opacity: state.boundary};
    const own = i === 0 ? state : state.pins[i - 1] || {};
    return {key, kind, isovalue: surface.isovalue, color: own.color || surface.color, opacity: own.opacity ?? surface.opacity, hidden: twice && i === 0};
  });
}
const isosurfaces = () => (frame?.surfaces || []).filter(({kind}) => kind === 'surface');

/** While something moves, a picture that takes long has half the pixels each way; in full when all rests. */
let slow = false, sharpTimer = 0;
function chooseScale() {
  clearTimeout(sharpTimer);
  if (slow && !resting) {
    scene.scale = 0.5;
    sharpTimer = setTimeout(() => { resting = true; drawSoon(); }, 250);
  } else scene.scale = 1;
  resting = false;
}
let resting = false;

/** Why the server draws, or nothing where the browser does. */
const serverDraws = () => (!scene ? 'no WebGL2 here' : state.drawn === 'server' ? 'chosen' :
  large && state.drawn !== 'browser' ? `${format.rough(large)} triangles are too many for the browser` : '');

/** Triangles of surfaces that are too large for the browser, else 0: then the server draws until they are a quarter smaller. */
let large = 0;
function noteSize(next) {
  const most = Number(document.body.dataset.most) || 8e6;
  const all = [...new Map(next.surfaces.filter(({kind}) => kind === 'surface').map((one) => [one.isovalue, one.triangles])).values()].reduce((a, b) => a + b, 0);
  const before = serverDraws();
  if (all > most) large = all;
  else if (all < 0.75 * most) large = 0;
  if (!before === !serverDraws()) return;
  id('picture').hidden = !serverDraws();
  sent = null;
  wishSoon();
}
const aspect = () => id('scene').clientWidth / Math.max(1, id('scene').clientHeight);
const pictureSize = () => ['clientWidth', 'clientHeight'].map((side) => Math.max(1, Math.min(4096, Math.round(id('scene')[side] * (window.devicePixelRatio || 1)))));

function draw() {
  drawPlanned = false;
  if (!grid?.lower) return;
  if (serverDraws()) {
    drawAxes();
    placeMark();
    document.body.dataset.camera = camera.text();
    if (frame && !frame.picture) {
      acknowledge(frame);
      wishSoon();
    }
    return;
  }
  if (frame?.picture) return wishSoon();
  chooseScale();
  const pad = grid.upper.map((u, i) => (u - grid.lower[i]) * 0.001);
  const start = performance.now();
  scene.draw(camera, dressed().filter((one) => !one.hidden), {background: css('scene'), lower: grid.lower.map((v, i) => v - pad[i]),
    upper: grid.upper.map((v, i) => v + pad[i]), boxLower: grid.lower, boxUpper: grid.upper, outline: state.outline,
    edges: state.edges, mapped: !!state.colorBy, noData: frame?.scale?.no_data, line: css('soft'),
    cuts: planesOf(state, 'clip')});
  placeMark();
  drawAxes();
  scene.finish();
  const took = performance.now() - start;
  if (scene.scale === 1) slow = took > 50;
  measureSpeed(took);
  if (frame && !frame.acknowledged) {
    frame.draw_ms = took;
    frame.age_ms = performance.now() - (sentAt.get(frame.number) ?? start);
    for (const old of sentAt.keys()) if (old <= frame.number) sentAt.delete(old);
    acknowledge(frame);
    tellFacts();
    time.shown(frame.step);
    measureServer(frame);
    askSpectrum();
    refineSoon();
  }
  document.body.dataset.camera = camera.text();
}

function measureSpeed(took) {
  const drawn = (frame?.surfaces || []).reduce((sum, {key}) => sum + (scene.meshes.get(key)?.count || 0) / 3, 0);
  if (drawn < 20000) return;
  speed = speed === null ? drawn / took : 0.7 * speed + 0.3 * drawn / took;
  // A preview from before the speed was known is replaced.
  const settled = frame.preview && frame.number === number && sent?.endsWith('|rest');
  if (settled && mostTriangles(false) > lastMost) { sent = null; restSoon(); }
}

function drawSoon() {
  if (drawPlanned) return;
  drawPlanned = true;
  requestAnimationFrame(draw);
}

function drawAxes() {
  const right = camera.right(), ends = [0, 1, 2].map((i) => [right[i], -camera.up[i], camera.direction[i]]);
  const colors = ['#d1495b', '#3a9d5d', '#3f7cc4'];
  id('axes').innerHTML = ends.map(([x, y, z], i) => ({x, y, z, i})).sort((a, b) => a.z - b.z).map(({x, y, i}) =>
    `<line x2="${22 * x}" y2="${22 * y}" stroke="${colors[i]}" stroke-width="2.5" stroke-linecap="round"/>` +
    `<text x="${30 * x}" y="${30 * y}">${'xyz'[i]}</text>`).join('');
}

function tellFacts() {
  const [first] = isosurfaces();
  const triangles = [...new Map(isosurfaces().map((one) => [one.isovalue, one.triangles])).values()].reduce((a, b) => a + b, 0);
  const drawn = isosurfaces().reduce((sum, one) => sum + (scene?.meshes.get(one.key)?.count || 0) / 3, 0);
  id('shown').textContent = first ? `${format.short(first.isovalue)} shown` : 'No surface';
  const parts = [`${format.grouped(triangles)} triangles` + (frame.preview && !frame.picture ? `, preview of ${format.rough(drawn)}` : '')];
  if (triangles === 0 && first) parts[0] = 'no triangles at this value';
  const {picture} = frame;
  if (picture) parts.push(`drawn by the server (${serverDraws() || 'until now'}): ${picture.type === 'image/png' ? 'exact' : 'while it moves'}, ${picture.width} × ${picture.height}`);
  parts.push(`extract ${format.duration(frame.extract_ms)}`, `${picture ? 'draw and encode' : 'encode'} ${format.duration(frame.mesh_ms)}`, format.bytes(frame.bytes),
    `${picture ? 'show' : 'draw'} ${format.duration(frame.draw_ms)}`, `${format.duration(frame.age_ms)} in all`);
  if (frame.field_bound != null) parts.push(`curved cells refined: within ${format.short(frame.field_bound)} of the field`);
  else if (grid.refines && !picture) parts.push('curved cells split at their nodes');
  if (frame.method === 'direct' && !picture && frame.field_bound == null) parts.push('direct, while the grid is packed');
  id('facts').textContent = parts.join(' · ');
  id('facts').title = parts.join('\n');
  Object.assign(document.body.dataset, {shown: first?.isovalue ?? '', triangles, drawn, preview: frame.preview, method: frame.method,
    bound: frame.field_bound ?? '', frame: frame.number, field: frame.field, step_shown: frame.step,
    picture: frame.picture?.type ?? '', kinds: frame.surfaces.map(({kind}) => kind).join(' ')});
  id('scene').setAttribute('aria-label', `Isosurface of ${state.field} at ${first ? format.short(first.isovalue) : 'no value'}, ` +
    `${format.grouped(triangles)} triangles. Arrow keys turn, with Shift they move, plus and minus zoom.`);
}

/** A picture of the server: newer ones only. */
async function takePicture(next) {
  const start = performance.now(), canvas = id('picture');
  const bitmap = await createImageBitmap(new Blob([next.picture.coded], {type: next.picture.type}));
  if (frame?.picture && frame.number > next.number) return acknowledge(next);
  [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
  canvas.getContext('2d').drawImage(bitmap, 0, 0);
  // A pixel of the picture is one of the screen, also where the stage has a part of a pixel more.
  ['width', 'height'].forEach((side, i) => { canvas.style[side] = `${pictureSize()[i] / (window.devicePixelRatio || 1)}px`; });
  canvas.hidden = !serverDraws();
  next.field = state.field;
  next.draw_ms = performance.now() - start;
  next.age_ms = performance.now() - (sentAt.get(next.number) ?? start);
  for (const old of sentAt.keys()) if (old <= next.number) sentAt.delete(old);
  acknowledge(frame);
  frame = next;
  acknowledge(frame);
  if (next.number >= number) stopWaiting();
  showNotes(next);
  showSurfaces();
  showRange();
  tellFacts();
  drawSoon();
  if (next.preview && next.number >= number) restSoon();
  time.shown(next.step);
  askSpectrum();
}

/** The server sends no more than two frames ahead: each is acknowledged once, also one that is replaced before it is drawn. */
function acknowledge(one) {
  if (!one || one.acknowledged) return;
  one.acknowledged = true;
  link.send({do: 'shown', number: one.number});
}

function takeFrame(buffer) {
  const next = readFrame(buffer);
  measureLine(next);
  noteSize(next);
  if (next.picture) return takePicture(next);
  acknowledge(frame);
  if (!scene) return acknowledge(next);
  id('picture').hidden = true;
  const keep = new Set(next.surfaces.map(({key}) => key));
  for (const key of [...scene.meshes.keys()]) if (!keep.has(key)) scene.remove(key);
  for (const {key, mesh} of next.surfaces) if (mesh) scene.add(key, mesh);
  next.field = state.field;
  frame = next;
  if (next.number >= number) stopWaiting();
  showNotes(next);
  showSurfaces();
  showRange();
  drawSoon();
  if (next.preview && next.number >= number) restSoon();
}

function stopWaiting() {
  clearTimeout(waiting);
  waiting = 0;
  id('stage').classList.remove('waiting');
  id('bar').hidden = true;
}

// --- wishes --------------------------------------------------------------------------------------------------------

/** What a frame depends on. */
const wanted = () => JSON.stringify([state.field, state.value, state.pins.map((pin) => pin.value), state.colorBy, state.map, state.range, state.logarithmic,
  planesOf(state, 'slice'), state.boundary > 0, state.step, document.body.dataset.step === 'ready', serverDraws() && [camera.text(), pictureSize(), toMessage(state)]]);

/** Bytes a ms of the line, by frames that are large enough to tell. */
let line = null;
function measureLine(next) {
  const took = performance.now() - (sentAt.get(next.number) ?? NaN) - next.wait_ms - next.extract_ms - next.mesh_ms;
  if (next.bytes < 200000 || !(took > 0)) return;
  line = line === null ? next.bytes / took : 0.7 * line + 0.3 * next.bytes / took;
}

/** Triangles of a surface that are drawn in time: 40 ms for a hand that moves, 1.5 s for one that rests. In few steps. */
let speed = null, lastMost = 0; // triangles a ms
function mostTriangles(moving) {
  const [ms, least, limit] = moving ? [40, 30000, 600000] : [1500, 150000, 8e6];
  const parts = Math.max(1, frame?.surfaces.length || 1); // share the time
  const sent_in_time = line === null ? Infinity : line * (moving ? 100 : 2000) / (14 * parts); // 14 bytes a triangle
  const most = Math.max(least, Math.min(limit, speed === null ? 100000 : speed * ms / parts, sent_in_time));
  return Math.round(10000 * 2 ** Math.floor(Math.log2(most / 10000)));
}

function wish(moving) {
  wishPlanned = false;
  if (!grid || !state.field || state.value === null) return;
  const what = wanted() + (moving ? '' : '|rest');
  if (what === sent || (moving && sent === wanted() + '|rest')) return;
  const message = {do: 'show', number: number + 1, state: toMessage(state), moving, most: mostTriangles(moving)};
  if (serverDraws()) Object.assign(message, {picture: pictureSize()}).state.camera = camera.text();
  else delete message.state.camera;
  if (time.playing) message.next = time.next(state.step);
  if (!link.send(message)) return;
  sent = what;
  lastMost = message.most;
  sentAt.set(++number, performance.now());
  if (!waiting) waiting = setTimeout(() => { id('stage').classList.add('waiting'); id('bar').hidden = false; }, 100);
}

/** A wish a picture of the screen, however fast the hand is; when it rests, in full. */
function wishSoon() {
  if (!wishPlanned) {
    wishPlanned = true;
    requestAnimationFrame(() => wish(true));
  }
  restSoon();
}

function restSoon() {
  clearTimeout(restTimer);
  restTimer = setTimeout(() => wish(false), 150);
}

/** Curved cells are refined where nothing moves: the surface that is shown is made anew, and takes its time. */
function refineSoon() {
  if (!grid.refines || frame.picture || frame.preview || frame.field_bound != null) return;
  if (frame.number !== number || sent !== wanted() + '|rest') return;
  const message = {do: 'refine', number: number + 1, state: toMessage(state), most: lastMost};
  delete message.state.camera;
  if (link.send(message)) sentAt.set(++number, performance.now());
}

// --- undo: the address holds the state ------------------------------------------------------------------------------

let commitTimer = 0;
const address = () => `#${token}&${toAddress(state)}`;

function commit() {
  clearTimeout(commitTimer);
  commitTimer = 0;
  state.camera = grid ? camera.text() : state.camera;
  if (location.hash !== address()) history.pushState(null, '', address());
}

function commitSoon() {
  clearTimeout(commitTimer);
  commitTimer = setTimeout(commit, 500);
}

addEventListener('popstate', () => {
  clearTimeout(commitTimer);
  const [sameToken, ...parts] = location.hash.slice(1).split('&');
  if (sameToken !== token) return location.reload();
  state = fromAddress(parts.join('&'));
  if (!grid?.fields.some(({name}) => name === state.field)) state.field = grid?.state.field || state.field;
  showState();
});

/** The controls and the picture follow a new state. */
function showState() {
  if (!state.camera || !camera.set(state.camera)) camera.fit(grid.lower, grid.upper, aspect());
  id('field').value = state.field;
  id('color-by').value = state.colorBy;
  id('map').value = state.map;
  id('logarithmic').checked = state.logarithmic;
  id('outline').checked = state.outline;
  id('edges').checked = state.edges;
  id('parallel').checked = camera.projection === 'parallel';
  id('color-details').hidden = !state.colorBy;
  id('drawn-by').value = scene ? state.drawn : 'server';
  id('drawn-by').disabled = !scene;
  id('picture').hidden = !serverDraws();
  showBoundary();
  cuts.show();
  time.show(state.step ?? 0);
  showMap();
  showRange();
  if (slider.chart?.field !== state.field) askChart();
  showValue();
  showSurfaces();
  wishSoon();
  drawSoon();
}

// --- level -----------------------------------------------------------------------------------------------------------

const slider = new ChartSlider(id('slider'), id('chart'), {input: setValue, commit});

function setValue(value) {
  state.value = value;
  showValue();
  wishSoon();
}

function showValue() {
  if (document.activeElement !== id('value')) id('value').value = state.value === null ? '' : String(state.value);
  id('value').removeAttribute('aria-invalid');
  const rows = id('surfaces').children;
  if (rows.length > 0 && state.value !== null) rows[0].querySelector('.value').textContent = format.short(state.value);
  slider.set(state.value ?? 0, state.pins.map((pin, i) => ({value: pin.value, color: pinColor(i)})));
  const expected = state.value === null ? null : slider.expected(state.value);
  const ms = expected === null || !msPerTriangle ? '' : `, ${format.duration(expected * msPerTriangle)}`;
  id('prediction').textContent = expected === null ? '' : `About ${format.rough(expected)} triangles${ms} expected`;
  showMeasures();
}

/** What the server took for a triangle, by the last frames that it made. */
let msPerTriangle = null;
function measureServer(made) {
  const triangles = made.surfaces.filter(({kind, mesh}) => kind === 'surface' && mesh).reduce((sum, one) => sum + one.triangles, 0);
  if (triangles < 1000 || made.picture) return;
  const now = (made.extract_ms + made.mesh_ms) / triangles;
  msPerTriangle = msPerTriangle === null ? now : 0.7 * msPerTriangle + 0.3 * now;
}

/** Area and volume at the slider's value. */
function showMeasures() {
  const {spectrum} = slider;
  for (const option of id('curve').options) option.disabled = option.value !== 'triangles' && !spectrum;
  id('curve').value = spectrum ? slider.curve : 'triangles';
  document.body.dataset.spectrum = spectrum ? spectrum.field : '';
  if (!spectrum || state.value === null) { id('measures').textContent = 'Area and volume come when nothing moves'; return; }
  const [area, below] = ['area', 'volume_below'].map((name) => slider.measured(name, state.value));
  id('measures').textContent = area === null ? '' :
    `Area ${area.toPrecision(4)}, volume below ${below.toPrecision(4)} of ${spectrum.volume.toPrecision(4)}`;
}

id('curve').addEventListener('change', () => { slider.curve = id('curve').value; slider.draw(); });

const pinColor = (i) => state.pins[i].color || frame?.surfaces[i + 1]?.color || '#888888';

function askChart() {
  if (slider.chart?.field !== state.field) slider.chart = slider.spectrum = null; // the same field's serves until the new one is there
  link.send({do: 'chart', field: state.field});
}

function takeChart(chart) {
  if (chart.field !== state.field) return;
  slider.chart = chart.lower <= chart.upper ? chart : null;
  id('lower').textContent = slider.chart ? format.short(chart.lower) : '';
  id('upper').textContent = slider.chart ? format.short(chart.upper) : 'The field has no finite value';
  if (state.value === null && slider.chart) {
    state.value = chart.first;
    history.replaceState(null, '', address());
  }
  showValue();
  askSpectrum();
  wishSoon();
}

/** Of the step that is shown, unless they play. */
let spectrumAsked = '';
function askSpectrum() {
  const step = frame?.step ?? 0, wanted = `${step}|${state.field}`;
  if (!slider.chart || time.playing || spectrumAsked === wanted || (slider.spectrum?.field === state.field && slider.spectrum.step === step)) return;
  if (link.send({do: 'spectrum', field: state.field})) spectrumAsked = wanted;
}

function takeSpectrum(spectrum) {
  spectrumAsked = '';
  if (spectrum.field !== state.field || (frame && spectrum.step !== frame.step)) return;
  slider.spectrum = spectrum.isovalues.length > 0 ? spectrum : null;
  showValue();
}

function typed() {
  const value = format.parseNumber(id('value').value);
  id('value').setAttribute('aria-invalid', value === null);
  if (value === null) return say('An isovalue is a number, such as 0.25 or 1e-3.');
  say('');
  setValue(value);
  commit();
}

id('value').addEventListener('keydown', (event) => {
  if (event.key === 'Enter') typed();
  if (event.key === 'Escape') { event.target.value = String(state.value ?? ''); event.target.removeAttribute('aria-invalid'); }
});
id('value').addEventListener('blur', () => showValue());

function pin() {
  if (state.value === null || state.pins.length >= 31 || state.pins.some((one) => one.value === state.value)) return;
  state.pins.push({value: state.value, color: null, opacity: null});
  pinsChanged();
}

function pinsChanged() {
  showSurfaces();
  showValue();
  commit();
  wishSoon();
  drawSoon();
}

id('pin').addEventListener('click', pin);

/** The list of surfaces, with colour and opacity. Rows stay where their number is the same: a control keeps its focus. */
function showSurfaces() {
  const list = id('surfaces'), all = state.value === null ? [] : [state, ...state.pins];
  while (list.children.length > all.length) list.lastChild.remove();
  const looks = dressed();
  all.forEach((one, i) => {
    const row = list.children[i] || list.appendChild(surfaceRow(i));
    const [color, value, opacity] = row.children;
    value.textContent = format.short(one.value);
    if (document.activeElement !== color) color.value = one.color || looks[i]?.color || '#888888';
    color.hidden = !!state.colorBy;
    if (document.activeElement !== opacity) opacity.value = one.opacity ?? looks[i]?.opacity ?? 1;
    const name = i === 0 ? 'the surface of the slider' : `pin ${format.short(one.value)}`;
    color.setAttribute('aria-label', `Colour of ${name}`);
    opacity.setAttribute('aria-label', `Opacity of ${name}`);
    row.querySelector('button')?.setAttribute('aria-label', `Remove ${name}`);
  });
}

function surfaceRow(i) {
  const row = document.createElement('li');
  row.innerHTML = '<input type="color"><span class="value"></span><input type="range" min="0" max="1" step="0.05">' +
    (i === 0 ? '<span class="spacer"></span>' : '<button type="button">×</button>');
  const own = () => (i === 0 ? state : state.pins[i - 1]);
  const [color, , opacity] = row.children;
  color.addEventListener('input', () => { own().color = color.value; showValue(); if (serverDraws()) wishSoon(); drawSoon(); commitSoon(); });
  opacity.addEventListener('input', () => { own().opacity = Number(opacity.value); if (serverDraws()) wishSoon(); drawSoon(); commitSoon(); });
  row.querySelector('button')?.addEventListener('click', () => {
    state.pins.splice(i - 1, 1);
    pinsChanged();
    (id('surfaces').children[i] || id('surfaces').children[i - 1])?.querySelector('button, input')?.focus();
  });
  return row;
}

id('field').addEventListener('change', () => {
  state.field = id('field').value;
  state.value = null;
  state.pins = [];
  askChart();
  showSurfaces();
  commitSoon();
});

// --- colour ----------------------------------------------------------------------------------------------------------

function showMap() {
  if (!maps) return;
  const colors = maps[state.map], context = id('legend').getContext('2d');
  scene?.setMap(state.map, colors);
  for (let x = 0; x < 256; ++x) {
    const at = 6 * Math.round(x * 63 / 255);
    context.fillStyle = '#' + colors.slice(at, at + 6);
    context.fillRect(x, 0, 1, 1);
  }
}

function showRange() {
  const scale = state.range ? {lower: state.range[0], upper: state.range[1]} : frame?.scale;
  for (const end of ['lower', 'upper']) {
    const input = id('range-' + end);
    if (document.activeElement !== input) input.value = scale ? format.short(scale[end]) : '';
  }
}

function colorsChanged() {
  id('color-details').hidden = !state.colorBy;
  showMap();
  showRange();
  showSurfaces();
  commitSoon();
  wishSoon();
  drawSoon();
}

id('color-by').addEventListener('change', () => { state.colorBy = id('color-by').value; state.range = null; colorsChanged(); });
id('map').addEventListener('change', () => { state.map = id('map').value; colorsChanged(); });
id('logarithmic').addEventListener('change', () => { state.logarithmic = id('logarithmic').checked; colorsChanged(); });
id('range-reset').addEventListener('click', () => { state.range = null; colorsChanged(); });
for (const end of ['lower', 'upper']) {
  id('range-' + end).addEventListener('keydown', (event) => { if (event.key === 'Enter') takeRange(); });
  id('range-' + end).addEventListener('change', takeRange);
}

function takeRange() {
  const ends = ['lower', 'upper'].map((end) => format.parseNumber(id('range-' + end).value));
  const fits = ends.every((one) => one !== null) && ends[0] < ends[1];
  for (const end of ['lower', 'upper']) id('range-' + end).setAttribute('aria-invalid', !fits);
  if (!fits) return say('The range of colours takes two numbers, the smaller one first.');
  say('');
  if (state.range?.[0] === ends[0] && state.range?.[1] === ends[1]) return;
  if (!state.range && frame?.scale && format.short(frame.scale.lower) === format.short(ends[0]) && format.short(frame.scale.upper) === format.short(ends[1])) return;
  state.range = ends;
  colorsChanged();
}

// --- view ------------------------------------------------------------------------------------------------------------

function lookFrom(name) {
  if (!grid?.lower) return;
  if (name !== 'fit') camera.look(name);
  camera.fit(grid.lower, grid.upper, aspect());
  moved();
}

function moved() {
  if (serverDraws()) wishSoon();
  id('parallel').checked = camera.projection === 'parallel';
  drawSoon();
  commitSoon();
}

for (const button of document.querySelectorAll('[data-view]')) button.addEventListener('click', () => lookFrom(button.dataset.view));
id('parallel').addEventListener('change', () => { camera.setProjection(id('parallel').checked ? 'parallel' : 'perspective'); moved(); });
for (const flag of ['edges', 'outline'])
  id(flag).addEventListener('change', () => { state[flag] = id(flag).checked; if (serverDraws()) wishSoon(); drawSoon(); commitSoon(); });
id('drawn-by').addEventListener('change', () => {
  state.drawn = id('drawn-by').value;
  sent = null;
  closePicked();
  wishSoon();
  drawSoon();
  commit();
});

function showBoundary() {
  id('boundary').value = state.boundary;
  id('boundary-text').textContent = state.boundary > 0 ? state.boundary.toFixed(2) : 'off';
  id('boundary').setAttribute('aria-valuetext', id('boundary-text').textContent);
}
id('boundary').addEventListener('input', () => {
  state.boundary = Number(id('boundary').value);
  showBoundary();
  wishSoon();
  drawSoon();
  commitSoon();
});
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { showValue(); drawSoon(); });
new ResizeObserver(() => { if (grid && serverDraws()) wishSoon(); drawSoon(); }).observe(id('stage'));

// --- cuts, time, values -----------------------------------------------------------------------------------------------

const cuts = new Cuts(id('cuts'), {slice: id('add-slice'), clip: id('add-clip')}, {
  state: () => state, box: () => [grid?.lower || [0, 0, 0], grid?.upper || [1, 1, 1]], direction: () => camera.direction, say,
  changed(moving, added) {
    // A slice of one colour says little.
    if (added === 'slice' && !state.colorBy) {
      state.colorBy = id('color-by').value = state.field;
      colorsChanged();
    }
    cuts.show();
    wishSoon();
    drawSoon();
    if (moving) commitSoon(); else commit();
  },
});

const time = new TimeSteps({section: id('time'), slider: id('step'), label: id('step-text'), play: id('play')}, {
  step: () => state.step ?? 0, commit,
  go(step) {
    if (step < 0 || step >= time.times.length) return;
    state.step = step;
    time.show(step);
    wishSoon();
    commitSoon();
  },
});

let picked = null;
function pickAt(x, y) {
  if (serverDraws()) {
    if (!grid?.lower) return;
    const [point, ray] = camera.ray(x, y, aspect(), grid.lower, grid.upper);
    picked = {point: null, isovalue: null};
    link.send({do: 'pick', state: {...toMessage(state), camera: undefined}, point, ray});
    return;
  }
  const found = scene?.pickSurface(x, y);
  if (!found) return closePicked();
  const {surface, point} = found, message = {do: 'pick', state: toMessage(state), point};
  delete message.state.camera;
  if (surface.kind === 'slice') message.slice = frame.surfaces.filter(({kind}) => kind === 'slice').findIndex(({key}) => key === surface.key);
  else message.state.isovalues = [surface.isovalue];
  if (message.slice >= message.state.slices.length) return;
  picked = {point, isovalue: surface.kind === 'slice' ? null : surface.isovalue};
  link.send(message);
}

function takePicked(message) {
  if (!picked) return;
  if (picked.point === null) picked.isovalue = message.isovalue ?? null; // of a ray
  picked.point = message.point;
  const numbers = (values) => values.map(format.short).join(', ');
  const rows = [['x, y, z', numbers(message.point)], ...message.values.map(({name, cell, values}) => [name + (cell ? ' (cell)' : ''), numbers(values.map((v) => v ?? NaN))])];
  if (message.cell !== undefined) rows.push(['Cell', String(message.cell)]);
  id('picked-title').textContent = picked.isovalue === null ? 'On the slice' : `${state.field} = ${format.short(picked.isovalue)}`;
  id('picked-rows').replaceChildren(...rows.map(([name, value]) => {
    const row = document.createElement('tr'), head = document.createElement('th'), cell = document.createElement('td');
    head.scope = 'row';
    head.textContent = name;
    cell.textContent = value;
    row.append(head, cell);
    return row;
  }));
  id('picked').hidden = false;
  document.body.dataset.picked = JSON.stringify(message);
  placeMark();
}

function closePicked() {
  picked = null;
  id('picked').hidden = true;
  delete document.body.dataset.picked;
  placeMark();
}
id('picked-close').addEventListener('click', () => { closePicked(); id('scene').focus(); });

function placeMark() {
  const at = picked && !id('picked').hidden && !serverDraws() && scene?.project(picked.point);
  id('mark').toggleAttribute('hidden', !at);
  if (!at) return;
  id('mark').style.left = `${50 + 50 * at[0]}%`;
  id('mark').style.top = `${50 - 50 * at[1]}%`;
}

// --- commands --------------------------------------------------------------------------------------------------------

let copying = null;
for (const kind of ['render', 'extract'])
  id('copy-' + kind).addEventListener('click', () => {
    copying = kind;
    link.send({do: 'command', state: wholeState()});
  });

async function takeCommand(message) {
  const text = message[copying] || '';
  let copied = true;
  try { await navigator.clipboard.writeText(text); } catch { copied = false; }
  const own = copying === 'render' && [state, ...state.pins].some((one) => one.color || (one.opacity !== null && one.opacity !== state.opacity));
  id('copied').textContent = text;
  id('copied').title = copied ? 'Copied' : 'The browser did not copy: select it';
  id('copy-' + copying).textContent = copied ? 'Copied' : 'See below';
  if (own) say('Colours and opacities of single surfaces are not part of isotet render.');
  setTimeout(() => { id('copy-render').textContent = 'Copy render'; id('copy-extract').textContent = 'Copy extract'; }, 1500);
}

id('command').addEventListener('keydown', (event) => {
  if (event.key !== 'Enter' || id('command').value.trim() === '') return;
  link.send({do: 'paste', text: id('command').value});
});

function takeState(message) {
  const next = fromMessage(message);
  if (!next.field) next.field = state.field;
  if (next.value === null && next.field === state.field) next.value = state.value;
  if (next.step === null) next.step = state.step;
  state = {...next, drawn: state.drawn};
  if (!state.camera) state.camera = camera.text();
  id('command').value = '';
  say('');
  commit();
  showState();
}

/** As a command line has it: each isovalue once. */
function wholeState() {
  state.camera = camera.text();
  const message = toMessage(state);
  message.isovalues = [...new Set(message.isovalues)];
  return message;
}

const save = new Save({state: wholeState, send: (message) => link.send(message),
  size: () => [id('scene').clientWidth, id('scene').clientHeight].map((side) => Math.round(side * Math.max(1, window.devicePixelRatio))),
  range: () => (slider.chart ? [slider.chart.lower, slider.chart.upper] : [0, 1])});

// --- keys ------------------------------------------------------------------------------------------------------------

id('help-open').addEventListener('click', () => id('help').showModal());
id('help-close').addEventListener('click', () => id('help').close());

const keys = {
  f: () => lookFrom('fit'), Home: () => lookFrom('fit'), 1: () => lookFrom('front'), 3: () => lookFrom('right'), 7: () => lookFrom('top'),
  s: () => save.open(), v: () => pickAt(0, 0), ' ': () => time.toggle(), ',': () => { time.stop(); time.on.go((state.step ?? 0) - 1); }, '.': () => { time.stop(); time.on.go((state.step ?? 0) + 1); },
  Escape: closePicked, 9: () => lookFrom('oblique'), 5: () => id('parallel').click(), e: () => id('edges').click(), b: () => id('outline').click(), p: pin,
  '[': () => slider.step(-1), ']': () => slider.step(1), '{': () => slider.step(-0.1), '}': () => slider.step(0.1), '?': () => id('help').showModal(),
};
addEventListener('keydown', (event) => {
  const typing = event.target.matches('input[type=text], select') || id('help').open || id('save').open || (event.key === ' ' && event.target.matches('button, input'));
  const action = keys[event.key] || keys[event.key.toLowerCase()];
  if (typing || event.ctrlKey || event.altKey || event.metaKey || !action) return;
  event.preventDefault();
  action();
});

// --- start -----------------------------------------------------------------------------------------------------------

function fill(select, names, chosen) {
  select.replaceChildren(...names.map(([value, text]) => new Option(text, value)));
  select.value = chosen;
}

function takeGrid(message) {
  if (grid) { askChart(); sent = null; return wishSoon(); }
  grid = message;
  if (!grid.lower) [grid.lower, grid.upper] = [[0, 0, 0], [1, 1, 1]];
  time.set(grid.times);
  const names = grid.fields.map(({name}) => name), start = fromMessage(grid.state);
  const fresh = !state.field || !names.includes(state.field);
  if (fresh) state = {...start, camera: state.camera};
  if (grid.times.length < 2) state.step = null;
  else if (state.step === null || state.step >= grid.times.length) state.step = start.step;
  if (!names.includes(state.field)) names.unshift(state.field);
  const label = (name) => [name, name + (grid.fields.find((one) => one.name === name)?.cell ? ' (cells)' : '')];
  fill(id('field'), names.map(label), state.field);
  fill(id('color-by'), [['', 'Surface'], ...names.map(label)], state.colorBy);
  say(grid.notes.join(' '), 0);
  document.body.dataset.grid = `${grid.points} points, ${grid.cells} cells`;
  showState();
  if (fresh) history.replaceState(null, '', address());
}

function takeProgress({step, fraction}) {
  const running = fraction < 1 && step !== 'ready', failed = /^n(ot packed|o boundary)/.test(step);
  const words = {read: 'Reading', pack: 'Packing', make: 'Making', split: 'Packing', boundary: 'Finding the boundary'};
  id('progress').hidden = !running && !failed;
  id('progress-text').textContent = failed ? step : `${words[step] || step}${grid ? ', the surface can be moved already' : ''}`;
  id('progress-bar').hidden = !running;
  if (fraction > 0) id('progress-bar').value = fraction;
  else id('progress-bar').removeAttribute('value');
  document.body.dataset.step = step;
  if (step === 'ready' && grid) wishSoon(); // the boundary is there
}

const messages = {
  welcome(message) {
    maps = message.maps;
    save.out = message.out;
    fill(id('map'), Object.keys(maps).map((name) => [name, name]), state.map in maps ? state.map : (state.map = 'viridis'));
    const name = message.file.split('/').pop();
    id('file').textContent = name;
    id('file').title = message.file;
    document.title = `${name} – isotet`;
    showMap();
    if (grid) { sent = null; askChart(); }
  },
  grid: takeGrid,
  progress: takeProgress,
  chart: takeChart,
  spectrum: takeSpectrum,
  command: takeCommand,
  picked: takePicked,
  state: (message) => takeState(message.state),
  refused(message) {
    if (message.number >= number) stopWaiting();
    sent = null;
    say(message.sentence, message.number);
  },
  saved: (message) => save.tell(`Saved: ${message.path}`),
  error: (message) => (message.about === 'save' ? save.tell(message.sentence) : say(message.sentence)),
};

try {
  scene = new Scene(id('scene'));
  scene.onRestored = () => { frame = null; sent = null; link.socket.close(); };
} catch {
  scene = null; // the server draws
}

const link = new Link(token, {
  open: () => { id('link').textContent = ''; document.body.dataset.link = 'open'; },
  lost: () => {
    // Another connection begins without surfaces: all are sent again.
    sent = null;
    spectrumAsked = '';
    stopWaiting();
    id('link').textContent = 'No connection: trying again';
    document.body.dataset.link = 'lost';
  },
  text: (message) => messages[message.say]?.(message),
  frame: takeFrame,
});

new Pointer(id('scene'), camera, () => (serverDraws() ? null : scene), {
  moved, middle: () => grid && grid.lower.map((v, i) => (v + grid.upper[i]) / 2), level: (steps) => slider.step(steps), click: pickAt,
});
