// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Standard views, and what is drawn beside the surfaces.
import {app, id} from './app.js';
import {colorsChanged} from './draw/colors.js';
import {frameAll, frameSurfaces} from './draw/framing.js';
import {setUpHeights} from './draw/heights.js';
import {showValue} from './level.js';
import {say} from './notes.js';
import {closePicked} from './picked.js';
import {forgetPartNumbers} from './parts.js';
import {drawSoon} from './picture.js';
import {commit, commitSoon} from './undo.js';
import {serverDraws, wishSoon} from './wishes.js';

export function lookFrom(name) {
  if (!app.grid?.lower) return;
  if (name === 'surface') frameSurfaces();
  else {
    if (name !== 'fit') app.camera.look(name);
    frameAll();
  }
  moved();
}

export function showCamera() {
  if (serverDraws()) wishSoon();
  id('parallel').checked = app.camera.projection === 'parallel';
  drawSoon();
}

export function moved() {
  showCamera();
  commitSoon();
}

setUpHeights(moved, () => lookFrom('oblique'));
for (const button of document.querySelectorAll('[data-view]')) button.addEventListener('click', () => lookFrom(button.dataset.view));
id('parallel').addEventListener('change', () => { app.camera.setProjection(id('parallel').checked ? 'parallel' : 'perspective'); moved(); });
for (const flag of ['edges', 'outline'])
  id(flag).addEventListener('change', () => { app.state[flag] = id(flag).checked; if (serverDraws()) wishSoon(); drawSoon(); commitSoon(); });
id('labels-on').addEventListener('change', () => { app.state.labels = id('labels-on').checked; drawSoon(); commit(); });

export function toggleFullScreen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen().catch(() => say('The browser does not allow full screen here.'));
}

export const togglePanel = () => document.body.classList.toggle('wide');

id('full-screen').addEventListener('click', toggleFullScreen);
document.addEventListener('fullscreenchange', () => { id('full-screen').textContent = document.fullscreenElement ? 'Leave full screen' : 'Full screen'; });

id('drawn-by').addEventListener('change', () => {
  app.state.drawn = id('drawn-by').value;
  app.sent = null;
  closePicked();
  wishSoon();
  drawSoon();
  commit();
});

id('solid').addEventListener('change', () => {
  app.state.solid = id('solid').value;
  forgetPartNumbers();
  closePicked();
  wishSoon();
  commit();
});

export function showBoundary() {
  id('boundary').value = app.state.boundary;
  id('boundary-text').textContent = app.state.boundary > 0 ? app.state.boundary.toFixed(2) : 'off';
  id('isosurfaces').checked = app.state.isosurfaces;
  id('colored-boundary').checked = app.state.coloredBoundary;
  id('boundary').setAttribute('aria-valuetext', id('boundary-text').textContent);
}
id('boundary').addEventListener('input', () => {
  app.state.boundary = Number(id('boundary').value);
  showBoundary();
  wishSoon();
  drawSoon();
  commitSoon();
});
/** Without isosurfaces the boundary says all. */
export function showIsosurfaces(shown) {
  const {state} = app;
  if (state.isosurfaces === shown) return;
  state.isosurfaces = shown;
  if (!shown) {
    state.boundary = 1;
    state.coloredBoundary = true;
    state.colorBy ||= state.field;
    closePicked();
  } else if (state.boundary === 1) { // it would hide them
    Object.assign(state, {boundary: 0.1, coloredBoundary: false});
    if (state.colorBy === state.field) state.colorBy = ''; // says nothing on them
  }
  showBoundary();
  id('color-by').value = state.colorBy;
  colorsChanged();
}
id('isosurfaces').addEventListener('change', () => showIsosurfaces(id('isosurfaces').checked));
id('colored-boundary').addEventListener('change', () => {
  app.state.coloredBoundary = id('colored-boundary').checked;
  if (app.state.coloredBoundary) app.state.colorBy ||= app.state.field;
  id('color-by').value = app.state.colorBy;
  showBoundary();
  colorsChanged();
});
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { showValue(); drawSoon(); });
new ResizeObserver(() => { if (app.grid && serverDraws()) wishSoon(); drawSoon(); }).observe(id('stage'));
