// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Standard views, and what is drawn beside the surfaces.
import {app, aspect, id} from './app.js';
import {showValue} from './level.js';
import {say} from './notes.js';
import {closePicked} from './picked.js';
import {forgetPartNumbers} from './parts.js';
import {drawSoon} from './picture.js';
import {commit, commitSoon} from './undo.js';
import {serverDraws, wishSoon} from './wishes.js';

export function lookFrom(name) {
  if (!app.grid?.lower) return;
  if (name !== 'fit') app.camera.look(name);
  app.camera.fit(app.grid.lower, app.grid.upper, aspect());
  moved();
}

export function moved() {
  if (serverDraws()) wishSoon();
  id('parallel').checked = app.camera.projection === 'parallel';
  drawSoon();
  commitSoon();
}

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
  id('boundary').setAttribute('aria-valuetext', id('boundary-text').textContent);
}
id('boundary').addEventListener('input', () => {
  app.state.boundary = Number(id('boundary').value);
  showBoundary();
  wishSoon();
  drawSoon();
  commitSoon();
});
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { showValue(); drawSoon(); });
new ResizeObserver(() => { if (app.grid && serverDraws()) wishSoon(); drawSoon(); }).observe(id('stage'));
