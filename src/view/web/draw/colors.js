// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours by a field: map, range, logarithm.
import {app, id} from '../app.js';
import * as format from '../format.js';
import {say} from '../notes.js';
import {drawSoon} from '../picture.js';
import {coloredBy} from '../state.js';
import {showSurfaces} from '../surfaces.js';
import {commitSoon} from '../undo.js';
import {wishSoon} from '../wishes.js';

/** 64 colours, one after another; of classes as many of each. */
export function mapColors() {
  const classes = app.frame?.scale?.classes;
  return classes ? Array.from({length: 64}, (_, i) => classes[Math.floor(i * classes.length / 64)].color.slice(1)).join('') : app.maps[app.state.map];
}

export function showMap() {
  if (!app.maps) return;
  const colors = mapColors(), context = id('legend').getContext('2d');
  for (let x = 0; x < 256; ++x) {
    const at = 6 * Math.round(x * 63 / 255);
    context.fillStyle = '#' + colors.slice(at, at + 6);
    context.fillRect(x, 0, 1, 1);
  }
}

export function showRange() {
  showMap();
  id('color-range').hidden = !!app.frame?.scale?.classes;
  document.body.dataset.classes = (app.frame?.scale?.classes || []).map(({name}) => name).join(' ');
  const scale = app.state.range ? {lower: app.state.range[0], upper: app.state.range[1]} : app.frame?.scale;
  for (const end of ['lower', 'upper']) {
    const input = id('range-' + end);
    if (document.activeElement === input) continue;
    input.value = scale ? format.short(scale[end]) : '';
    input.removeAttribute('aria-invalid');
  }
}

export function colorsChanged() {
  id('color-details').hidden = !coloredBy(app.state);
  showMap();
  showRange();
  showSurfaces();
  commitSoon();
  wishSoon();
  drawSoon();
}

id('color-by').addEventListener('change', () => { app.state.colorBy = id('color-by').value; app.state.range = null; app.state.hidden = []; colorsChanged(); });
id('map').addEventListener('change', () => { app.state.map = id('map').value; colorsChanged(); });
id('logarithmic').addEventListener('change', () => { app.state.logarithmic = id('logarithmic').checked; colorsChanged(); });
id('range-reset').addEventListener('click', () => { say(''); app.state.range = null; colorsChanged(); });
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
  if (app.state.range?.[0] === ends[0] && app.state.range?.[1] === ends[1]) return;
  if (!app.state.range && app.frame?.scale && format.short(app.frame.scale.lower) === format.short(ends[0]) && format.short(app.frame.scale.upper) === format.short(ends[1])) return;
  app.state.range = ends;
  colorsChanged();
}
