// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values at a point of a surface or slice.
import {app, aspect, id} from './app.js';
import * as format from './format.js';
import {seenBox, stretched, unstretched} from './draw/heights.js';
import {markPart} from './parts.js';
import {isSeenFirst} from './draw/scene.js';
import {toMessage} from './state.js';
import {serverDraws} from './wishes.js';

/** It stands alone, or hides what is behind it. */
function isBoundaryPicked() {
  const {isosurfaces, volume, boundary, planes} = app.state;
  return isSeenFirst(boundary) || (boundary > 0 && !isosurfaces && !volume && !planes.some(({kind}) => kind === 'slice'));
}

export function pickAt(x, y) {
  if (serverDraws()) {
    const {volume, planes} = app.state; // there may be no surface
    const boundary = isBoundaryPicked();
    if (!app.grid?.lower || (volume && !volume.surfaces && !boundary && !planes.some(({kind}) => kind === 'slice'))) return;
    const [point, ray] = app.camera.ray(x, y, aspect(), ...seenBox()).map(unstretched);
    app.picked = {point: null, isovalue: null, key: null, boundary, field: app.frame?.field, step: app.frame?.step};
    app.link.send({do: 'pick', state: {...toMessage(app.state), camera: undefined}, point, ray, boundary, parts: id('parts').open});
    return;
  }
  const found = app.scene?.pickSurface(x, y);
  if (!found) return closePicked();
  const {surface} = found, point = unstretched(found.point), message = {do: 'pick', state: toMessage(app.state), point, parts: id('parts').open};
  delete message.state.camera;
  if (surface.kind === 'boundary') message.boundary = true;
  else if (surface.kind === 'slice') message.slice = app.frame.surfaces.filter(({kind}) => kind === 'slice').findIndex(({key}) => key === surface.key);
  else message.state.isovalues = [surface.isovalue];
  if (message.slice >= message.state.slices.length) return;
  app.picked = {point, boundary: surface.kind === 'boundary', isovalue: surface.isovalue ?? null, key: surface.kind === 'surface' ? null : surface.key,
    field: app.frame.field, step: app.frame.step};
  app.link.send(message);
}

export function takePicked(message) {
  if (!app.picked) return;
  if (app.picked.point === null) Object.assign(app.picked, {isovalue: message.isovalue ?? null, boundary: !!message.boundary}); // of a ray
  app.picked.point = message.point;
  const numbers = (values) => values.map(format.short).join(', ');
  const rows = [['x, y, z', numbers(message.point)], ...message.values.map(({name, cell, values}) => [name + (cell ? ' (cell)' : ''), numbers(values.map((v) => v ?? NaN))])];
  if (message.cell !== undefined) rows.push(['Cell', String(message.cell)]);
  id('picked-title').textContent = app.picked.isovalue === null ? (app.picked.boundary ? 'On the boundary' : 'On the slice') : `${app.state.field} = ${format.short(app.picked.isovalue)}`;
  id('picked-rows').replaceChildren(...rows.map(([name, value]) => {
    const row = document.createElement('tr'), head = document.createElement('th'), cell = document.createElement('td');
    head.scope = 'row';
    head.textContent = name;
    cell.textContent = value;
    row.append(head, cell);
    return row;
  }));
  markPart(app.picked.isovalue === app.state.value ? message.values.find(({name, cell}) => cell && name === 'part')?.values[0] : undefined);
  id('picked').hidden = false;
  document.body.dataset.picked = JSON.stringify(message);
  placeMark();
}

/** The point belongs to a surface that is shown: it goes with it. */
export function checkPicked() {
  const {picked, frame} = app;
  if (!picked || picked.point === null) return;
  const {isovalue, key, field, step} = picked, has = (fits) => frame.surfaces.some(fits);
  const there = key === null || frame.picture ? isovalue === null || has((one) => one.kind === 'surface' && one.isovalue === isovalue) : has((one) => one.key === key);
  if (!there || frame.step !== step || frame.field !== field) closePicked();
}

export function closePicked() {
  app.picked = null;
  id('picked').hidden = true;
  delete document.body.dataset.picked;
  placeMark();
}
id('picked-close').addEventListener('click', () => { closePicked(); id('scene').focus(); });

export function placeMark() {
  const at = app.picked && !id('picked').hidden && !serverDraws() && app.scene?.project(stretched(app.picked.point));
  id('mark').toggleAttribute('hidden', !at);
  if (!at) return;
  id('mark').style.left = `${50 + 50 * at[0]}%`;
  id('mark').style.top = `${50 - 50 * at[1]}%`;
}
