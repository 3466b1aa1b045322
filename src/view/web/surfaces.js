// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The list of surfaces: that of the slider, and pinned ones.
import {app, id} from './app.js';
import * as format from './format.js';
import {showValue} from './level.js';
import {dressed, drawSoon} from './picture.js';
import {commit, commitSoon} from './undo.js';
import {serverDraws, wishSoon} from './wishes.js';

export const pinColor = (i) => app.state.pins[i].color || app.frame?.surfaces[i + 1]?.color || '#888888';

/** Of the slider's surface; nothing where a field colours it. */
export function sliderColor() {
  if (app.state.colorBy || !app.state.isosurfaces) return null;
  const [first] = app.frame?.surfaces ?? [];
  return app.state.color || (first?.kind === 'surface' ? first.color : null);
}

export function pin() {
  if (app.state.value === null || app.state.pins.length >= 31 || app.state.pins.some((one) => one.value === app.state.value)) return;
  // It keeps the colour that it has; the surfaces that isotet render draws together have others.
  const color = app.state.colorBy || serverDraws() ? null : sliderColor();
  app.state.pins.push({value: app.state.value, color, opacity: null});
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
export function showSurfaces() {
  const list = id('surfaces'), all = app.state.value === null ? [] : [app.state, ...app.state.pins];
  while (list.children.length > all.length) list.lastChild.remove();
  const looks = dressed().filter(({kind}) => kind === 'surface');
  all.forEach((one, i) => {
    const row = list.children[i] || list.appendChild(surfaceRow(i));
    const [color, value, opacity] = row.children;
    value.textContent = format.short(one.value);
    if (document.activeElement !== color) color.value = one.color || looks[i]?.color || '#888888';
    color.hidden = !!app.state.colorBy;
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
  const own = () => (i === 0 ? app.state : app.state.pins[i - 1]);
  const [color, , opacity] = row.children;
  color.addEventListener('input', () => { own().color = color.value; showValue(); if (serverDraws()) wishSoon(); drawSoon(); commitSoon(); });
  opacity.addEventListener('input', () => { own().opacity = Number(opacity.value); if (serverDraws()) wishSoon(); drawSoon(); commitSoon(); });
  row.querySelector('button')?.addEventListener('click', () => {
    app.state.pins.splice(i - 1, 1);
    pinsChanged();
    (id('surfaces').children[i] || id('surfaces').children[i - 1])?.querySelector('button, input')?.focus();
  });
  return row;
}
