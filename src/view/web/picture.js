// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Frames of the server on the screen.
import {app, aspect, css, id} from './app.js';
import {mapColors, showRange} from './draw/colors.js';
import * as format from './format.js';
import {frameBoundary, hasSurfaces} from './draw/framing.js';
import {seenBox} from './draw/heights.js';
import {followStep, measureServer, rangeOf, valueShown} from './level.js';
import {paintLabels, showLabels} from './draw/labels.js';
import {showNotes} from './notes.js';
import {askParts} from './parts.js';
import {checkPicked, placeMark} from './picked.js';
import {hiddenClasses, showRegions} from './regions.js';
import {factorsOf, planesOf} from './state.js';
import {showSurfaces} from './surfaces.js';
import {showVolume} from './draw/volume.js';
import {frameCame, measureLine, measureSpeed, noteSize, pictureSize, refineSoon, restSoon, serverDraws, wishSoon} from './wishes.js';

/** Colour and opacity of what the frame has: the slider's surface, pinned ones, slices, the boundary. */
export function dressed() {
  if (!app.frame) return [];
  // A surface that was pinned just now lies where the slider's still is: it is drawn once.
  const twice = isosurfaces().slice(1).some((one) => one.isovalue === app.frame.surfaces[0].isovalue);
  return app.frame.surfaces.map((surface, i) => {
    const {key, kind} = surface;
    if (kind === 'slice') return {key, kind, color: surface.color, opacity: 1};
    if (kind === 'boundary') return {key, kind, color: surface.color, opacity: app.state.boundary};
    const own = i === 0 ? app.state : app.state.pins[i - 1] || {};
    return {key, kind, isovalue: surface.isovalue, color: own.color || surface.color, opacity: own.opacity ?? surface.opacity, hidden: twice && i === 0};
  });
}

const isosurfaces = () => (app.frame?.surfaces || []).filter(({kind}) => kind === 'surface');

/**
 * While something moves, a picture that takes long is rough: half the pixels each way or a third, one sample each, no darker folds; in
 * full when all rests. So is the first one, for its time is not known.
 */
let slow = true, part = 0.5, rests = false, sharpTimer = 0, drawPlanned = false;
function chooseRoughness() {
  clearTimeout(sharpTimer);
  const rough = slow && !rests;
  app.scene.scale = rough ? part : 1;
  app.scene.smooth = !rough;
  rests = false;
}

/** Whether the next pictures are rough, by how long this one took. */
function measurePicture(took) {
  if (app.scene.smooth) {
    if (app.frame) slow = took > 50;
    return;
  }
  part = took > 30 ? 0.35 : took < 10 ? 0.5 : part;
  sharpTimer = setTimeout(() => { rests = true; drawSoon(); }, app.frame && took < 20 ? 0 : 250);
}

function draw() {
  drawPlanned = false;
  if (!app.grid?.lower) return;
  app.changed();
  if (serverDraws()) {
    drawAxes();
    placeMark();
    showLabels();
    document.body.dataset.camera = app.camera.text();
    if (app.frame && !app.frame.picture) {
      acknowledge(app.frame);
      wishSoon();
    }
    return;
  }
  if (app.frame?.picture) return wishSoon();
  chooseRoughness();
  const [lower, upper] = seenBox(), pad = upper.map((u, i) => (u - lower[i]) * 0.001);
  const start = performance.now();
  if (app.maps) app.scene.setMap(mapColors());
  app.scene.draw(app.camera, dressed().filter((one) => !one.hidden), {background: css('scene'), lower: lower.map((v, i) => v - pad[i]),
    upper: upper.map((v, i) => v + pad[i]), stretch: factorsOf(app.state), hidden: hiddenClasses(), boxLower: app.grid.lower, boxUpper: app.grid.upper, outline: app.state.outline,
    edges: app.state.edges, mapped: !!app.state.colorBy, noData: app.frame?.scale?.no_data, line: css('soft'),
    cuts: planesOf(app.state, 'clip'), occlusion: app.scene.smooth ? 0.8 : 0});
  placeMark();
  drawAxes();
  app.scene.finish();
  id('stage').classList.add('drawn');
  const took = performance.now() - start;
  measurePicture(took);
  measureSpeed(took);
  showLabels();
  if (app.frame && !app.frame.acknowledged) {
    app.frame.draw_ms = took;
    app.frame.age_ms = performance.now() - (app.sentAt.get(app.frame.number) ?? start);
    for (const old of app.sentAt.keys()) if (old <= app.frame.number) app.sentAt.delete(old);
    acknowledge(app.frame);
    tellFacts();
    app.time.shown(app.frame.step);
    valueShown();
    measureServer(app.frame);
    followStep();
    refineSoon();
    askParts();
  }
  document.body.dataset.camera = app.camera.text();
}

/** What the stage shows, with the pixels of the screen. */
export function pictureAsSeen() {
  const canvas = document.createElement('canvas'), context = canvas.getContext('2d');
  [canvas.width, canvas.height] = pictureSize();
  context.fillStyle = css('scene');
  context.fillRect(0, 0, canvas.width, canvas.height);
  if (serverDraws()) context.drawImage(id('picture'), 0, 0);
  else {
    rests = true;
    draw(); // what was drawn is there until the browser shows it
    context.drawImage(id('scene'), 0, 0, canvas.width, canvas.height);
  }
  const ratio = window.devicePixelRatio || 1;
  context.scale(ratio, ratio);
  paintLabels(context, canvas.width / ratio, canvas.height / ratio);
  paintAxes(context, 46, canvas.height / ratio - 46);
  return canvas;
}

export function drawSoon() {
  if (drawPlanned) return;
  drawPlanned = true;
  requestAnimationFrame(draw);
}

/** Ends of the axes, the nearest one last. */
function axes() {
  const right = app.camera.right(), colors = ['#d1495b', '#3a9d5d', '#3f7cc4'];
  return [0, 1, 2].map((i) => ({x: right[i], y: -app.camera.up[i], z: app.camera.direction[i], name: 'xyz'[i], color: colors[i]})).sort((a, b) => a.z - b.z);
}

let axesShown = '';

function drawAxes() {
  const camera = app.camera.text();
  if (camera === axesShown) return;
  axesShown = camera;
  id('axes').innerHTML = axes().map(({x, y, name, color}) =>
    `<line x2="${22 * x}" y2="${22 * y}" stroke="${color}" stroke-width="2.5" stroke-linecap="round"/>` +
    `<text x="${30 * x}" y="${30 * y}">${name}</text>`).join('');
}

/** The same in a picture. */
function paintAxes(context, left, top) {
  Object.assign(context, {lineWidth: 2.5, lineCap: 'round', textAlign: 'center', textBaseline: 'middle', font: '600 11px system-ui, "DejaVu Sans", sans-serif'});
  for (const {x, y, name, color} of axes()) {
    context.strokeStyle = color;
    context.beginPath();
    context.moveTo(left, top);
    context.lineTo(left + 22 * x, top + 22 * y);
    context.stroke();
    context.fillStyle = css('soft');
    context.fillText(name, left + 30 * x, top + 30 * y);
  }
}

/** The range of the field, where a value is not in it. */
function outside(value) {
  const {field, step} = app.frame, [lower, upper] = rangeOf(field, step) || [];
  return lower === undefined || (value >= lower && value <= upper) ? '' : `${field} is ${format.short(lower)} to ${format.short(upper)}`;
}

function tellFacts() {
  document.querySelector('[data-view=surface]').disabled = !hasSurfaces();
  const [first] = isosurfaces();
  const triangles = [...new Map(isosurfaces().map((one) => [one.isovalue, one.triangles])).values()].reduce((a, b) => a + b, 0);
  const drawn = isosurfaces().reduce((sum, one) => sum + (app.scene?.meshes.get(one.key)?.count || 0) / 3, 0);
  const volume = app.frame.opacity_length > 0, boundary = app.frame.surfaces.find(({kind}) => kind === 'boundary');
  const alone = !first && !volume && boundary;
  id('shown').textContent = first ? `${format.short(first.isovalue)} shown` : volume ? 'Volume shown' : alone ? 'Boundary shown' : 'No surface';
  const parts = [`${format.grouped(alone ? boundary.triangles : triangles)} triangles` + (app.frame.preview && !app.frame.picture && !alone ? `, preview of ${format.rough(drawn)}` : '')];
  if (triangles === 0 && first) parts[0] = ['no triangles at this value', outside(first.isovalue)].filter(Boolean).join(': ');
  if (volume && !first) parts[0] = `opacity of a length of ${format.short(app.frame.opacity_length)}`;
  const {picture} = app.frame, made = picture ? app.frame : app.made || app.frame;
  if (picture) parts.push(`drawn by the server (${serverDraws() || 'until now'}): ${picture.type === 'image/png' ? 'exact' : 'while it moves'}, ${picture.width} × ${picture.height}`);
  if (app.grid.saved === 'surfaces') parts.push(`unpacked in ${format.duration(made.mesh_ms)}`);
  else parts.push(`extract ${format.duration(made.extract_ms)}`, `${picture ? 'draw and encode' : 'encode'} ${format.duration(made.mesh_ms)}`);
  parts.push(format.bytes(made.bytes),
    `${picture ? 'show' : 'draw'} ${format.duration(app.frame.draw_ms)}`, `${format.duration(app.frame.age_ms)} in all`);
  if (app.frame.field_bound != null) parts.push(`curved cells refined: within ${format.short(app.frame.field_bound)} of the field`);
  else if (app.grid.refines && !picture) parts.push('curved cells split at their nodes');
  if (app.frame.method === 'direct' && !picture && app.frame.field_bound == null) parts.push('direct, while the grid is packed');
  id('facts').textContent = parts.join(' · ');
  id('facts').title = parts.join('\n');
  Object.assign(document.body.dataset, {shown: first?.isovalue ?? '', triangles, drawn, preview: app.frame.preview, method: app.frame.method,
    bound: app.frame.field_bound ?? '', frame: app.frame.number, field: app.frame.field, step_shown: app.frame.step,
    volume: volume ? app.state.volume?.opacity ?? '' : '', picture: app.frame.picture?.type ?? '', kinds: app.frame.surfaces.map(({kind}) => kind).join(' ')});
  const what = alone ? `Boundary of the grid${app.state.coloredBoundary && app.state.colorBy ? ` coloured by ${app.state.colorBy}` : ''}` :
    `Isosurface of ${app.state.field} at ${first ? format.short(first.isovalue) : 'no value'}, ${format.grouped(triangles)} triangles`;
  id('scene').setAttribute('aria-label', `${what}. Arrow keys turn, with Shift they move, plus and minus zoom.`);
}

/** A picture of the server: newer ones only. */
async function takePicture(next) {
  const start = performance.now(), canvas = id('picture');
  const bitmap = await createImageBitmap(new Blob([next.picture.coded], {type: next.picture.type}));
  if (app.frame?.picture && app.frame.number > next.number) return acknowledge(next);
  [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
  canvas.getContext('2d').drawImage(bitmap, 0, 0);
  // A pixel of the picture is one of the screen, also where the stage has a part of a pixel more.
  ['width', 'height'].forEach((side, i) => { canvas.style[side] = `${pictureSize()[i] / (window.devicePixelRatio || 1)}px`; });
  canvas.hidden = !serverDraws();
  next.draw_ms = performance.now() - start;
  next.age_ms = performance.now() - (app.sentAt.get(next.number) ?? start);
  for (const old of app.sentAt.keys()) if (old <= next.number) app.sentAt.delete(old);
  acknowledge(app.frame);
  app.frame = next;
  acknowledge(app.frame);
  frameCame(next.number);
  showNotes(next);
  checkPicked();
  showSurfaces();
  showRange();
  showRegions();
  showVolume();
  tellFacts();
  drawSoon();
  if (next.preview && next.number >= app.number) restSoon();
  app.time.shown(next.step);
  valueShown();
  followStep();
  askParts();
}

/** The server sends no more than two frames ahead: each is acknowledged once, also one that is replaced before it is drawn. */
function acknowledge(one) {
  if (!one || one.acknowledged) return;
  one.acknowledged = true;
  app.link.send({do: 'shown', number: one.number});
}

export function takeFrame(next) {
  measureLine(next);
  noteSize(next);
  if (next.picture) return takePicture(next);
  acknowledge(app.frame);
  if (!app.scene) return acknowledge(next);
  id('picture').hidden = true;
  const keep = new Set(next.surfaces.map(({key}) => key));
  for (const key of [...app.scene.meshes.keys()]) if (!keep.has(key)) app.scene.remove(key);
  for (const {key, mesh} of next.surfaces) if (mesh) app.scene.add(key, mesh);
  app.frame = next;
  frameBoundary(next.surfaces);
  if (next.surfaces.some(({kind, mesh}) => kind === 'surface' && mesh)) app.made = {extract_ms: next.extract_ms, mesh_ms: next.mesh_ms, bytes: next.bytes};
  frameCame(next.number);
  showNotes(next);
  checkPicked();
  showSurfaces();
  showRange();
  showRegions();
  drawSoon();
  if (next.preview && next.number >= app.number) restSoon();
}
