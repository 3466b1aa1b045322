// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What fills the picture: the points of the grid's boundary, as `isotet render` has it; until they are there, the corners of the box.
import {app, aspect} from '../app.js';
import {seenBox} from './heights.js';
import {factorsOf} from '../state.js';
import {nameState} from '../undo.js';

const framing = {
  boundary: null,            // {key, places: of 65535ths of its box, lower, upper}
  camera: '', byBox: false, // as the page placed it last
};

/** Corners of a box, x, y and z one after another. */
const boxCorners = (lower, upper) => Float64Array.from({length: 24}, (_, i) => (Math.floor(i / 3) >> i % 3 & 1 ? upper : lower)[i % 3]);

function placedPoints({places, lower, upper}) {
  const factors = factorsOf(app.state), points = new Float64Array(places.length);
  for (let axis = 0; axis < 3; ++axis) {
    const from = lower[axis] * factors[axis], unit = (upper[axis] - lower[axis]) * factors[axis] / 65535;
    for (let i = axis; i < places.length; i += 3) points[i] = from + places[i] * unit;
  }
  return points;
}

/** Sees all of the grid, from where the camera looks. */
export function frameAll() {
  framing.byBox = !framing.boundary || app.state.outline;
  app.camera.fit(framing.byBox ? boxCorners(...seenBox()) : placedPoints(framing.boundary), aspect());
  framing.camera = app.camera.text();
}

/** Isosurfaces and solids of the frame that the browser has, as --fit surface. */
const surfacesHere = () => (app.frame?.surfaces ?? []).filter(({kind}) => kind === 'surface').map(({key}) => app.scene?.meshes.get(key)).filter((mesh) => mesh?.lower && mesh.count > 0);

export const hasSurfaces = () => !app.frame?.picture && surfacesHere().length > 0;

/** Sees all of the isosurfaces. */
export function frameSurfaces() {
  const all = surfacesHere().map(({vertexBytes, lower, upper}) => placedPoints({places: placesOf(vertexBytes), lower, upper}));
  const points = new Float64Array(all.reduce((sum, {length}) => sum + length, 0));
  let at = 0;
  for (const one of all) { points.set(one, at); at += one.length; }
  if (at === 0) return;
  app.camera.fit(points, aspect());
}

/** Of vertices as frames have them. */
function placesOf({buffer, byteOffset, byteLength}) {
  const shorts = new Uint16Array(buffer, byteOffset, byteLength >> 1), places = new Uint16Array(shorts.length / 4 * 3);
  for (let i = 0, out = 0; i < shorts.length; i += 4, out += 3) for (let axis = 0; axis < 3; ++axis) places[out + axis] = shorts[i + axis];
  return places;
}

/** The boundary of a frame: a camera that was placed by the box, and not moved since, is placed by it. */
export function frameBoundary(surfaces) {
  const found = surfaces.find(({kind, mesh}) => kind === 'boundary' && mesh?.lower);
  if (!found || framing.boundary?.key === found.key) return;
  const {vertexBytes, lower, upper} = found.mesh;
  framing.boundary = {key: found.key, places: placesOf(vertexBytes), lower, upper};
  if (!framing.byBox || app.state.outline || app.camera.text() !== framing.camera) return;
  frameAll();
  if (app.state.camera) app.state.camera = app.camera.text();
  nameState();
}

/** Another grid has another boundary. */
export const forgetBoundary = () => Object.assign(framing, {boundary: null, camera: '', byBox: false});

/** A flat grid without isosurfaces is seen along its thin axis, as by `isotet render`. */
export function lookAtFirst() {
  const [lower, upper] = seenBox(), size = upper.map((u, i) => u - lower[i]), thin = size.indexOf(Math.min(...size));
  const flat = size.every((one, i) => i === thin || size[thin] < one / 20);
  app.camera.look(app.state.isosurfaces || !flat || app.state.up !== 'z' ? 'oblique' : ['right', 'front', 'top'][thin]);
}
