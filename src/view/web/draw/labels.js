// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is written in the scene: colour scale or legend, field, isovalue and time, as isotet render has it.
import {app, css, id} from '../app.js';
import {coloredBy} from '../state.js';
import {numberLabel, ticksOf} from './ticks.js';

const size = 13; // of letters, in pixels of the page
const line = Math.round(1.45 * size), swatch = size;

/** "artery.vtu · Umag = 0.2 · time 0.5" */
function caption() {
  const {frame, grid, state} = app, values = shown().map(({isovalue}) => isovalue);
  const parts = [id('file').textContent];
  if (values.length > 4) parts.push(`${values.length} isovalues of ${frame.field}`);
  else if (values.length > 0) parts.push(`${frame.field} = ${values.map(numberLabel).join(', ')}`);
  if (grid.times.length > 1) parts.push(`time ${numberLabel(grid.times[frame.step] ?? 0)} (step ${frame.step})`);
  if (state.planes.some(({kind}) => kind === 'clip')) parts.push('clipped');
  if (state.stretch?.some((factor) => factor !== 1)) parts.push(`axes × ${state.stretch.map(numberLabel).join(', ')}`);
  return parts.join('  ·  ');
}

/** Each isosurface once, by rising values. */
const shown = () => [...new Map((app.frame?.surfaces || []).filter(({kind}) => kind === 'surface').map((one) => [one.isovalue, one])).values()]
  .sort((a, b) => a.isovalue - b.isovalue);

const colorOf = (surface) => [app.state, ...app.state.pins].find(({value}) => value === surface.isovalue)?.color || surface.color;

/** Text that can be read on any surface. */
function write(context, text, x, y) {
  context.strokeStyle = css('scene');
  context.lineWidth = 3;
  context.lineJoin = 'round';
  context.strokeText(text, x, y);
  context.fillStyle = css('text');
  context.fillText(text, x, y);
}

/** As much of it as is `wide`, with an ellipsis. */
function shortened(context, text, wide) {
  if (context.measureText(text).width <= wide) return text;
  let length = text.length;
  while (length > 0 && context.measureText(`${text.slice(0, length)}…`).width > wide) --length;
  return `${text.slice(0, length)}…`;
}

function place({lower, upper, logarithmic}, value) {
  return logarithmic ? Math.log(value / lower) / Math.log(upper / lower) : (value - lower) / (upper - lower);
}

/** With its lower end at y + tall. */
function paintScale(context, scale, ticks, x, y, tall) {
  const colors = app.maps[app.state.map];
  for (let row = 0; row < tall; ++row) {
    const at = 6 * Math.round((1 - (row + 0.5) / tall) * 63);
    context.fillStyle = '#' + colors.slice(at, at + 6);
    context.fillRect(x, y + row, swatch, 1);
  }
  for (const [value, label] of ticks) {
    const at = Math.round(y + (1 - Math.max(0, Math.min(1, place(scale, value)))) * (tall - 1));
    context.fillStyle = css('text');
    context.fillRect(x + swatch, at, 5, 1);
    write(context, label, x + swatch + 9, at);
  }
}

function paintEntry(context, [color, text], x, y) {
  context.fillStyle = color;
  context.fillRect(x, y - swatch / 2, swatch, swatch);
  write(context, text, x + swatch + 7, y);
}

/** At the right: the scale of the colours, else the colours of several surfaces. */
function paintColumn(context, width, height) {
  const {frame, state} = app, scale = coloredBy(state) ? frame.scale : null, surfaces = shown();
  const classes = scale?.classes?.filter(({name}) => !state.hidden.includes(name)).map(({name, color}) => [color, name]), graded = scale && !classes;
  const entries = classes || (scale || surfaces.length < 2 ? [] : surfaces.map((one) => [colorOf(one), numberLabel(one.isovalue)]).reverse());
  if (!scale && entries.length === 0) return;
  const tall = graded ? Math.round(Math.min(0.55 * height, 320)) : line * entries.length, title = scale ? coloredBy(state) : frame.field;
  const ticks = graded ? ticksOf(scale, Math.floor(tall / (3 * size))) : [];
  const wide = Math.max(context.measureText(title).width, ...[...ticks, ...entries].map(([, text]) => swatch + 9 + context.measureText(text).width));
  const x = Math.round(width - wide - size), y = Math.round((height - tall) / 2);
  write(context, title, x, y - line);
  if (graded) paintScale(context, scale, ticks, x, y, tall);
  entries.forEach((entry, i) => paintEntry(context, entry, x, y + line * (i + 0.5)));
}

/** On a context whose pixels are those of the page, `width` to `height`. */
export function paintLabels(context, width, height) {
  if (!app.state.labels || !app.frame || !app.maps || width < 240 || height < 200) return;
  context.font = `${size}px system-ui, "DejaVu Sans", sans-serif`;
  context.textBaseline = 'middle';
  paintColumn(context, width, height);
  context.textBaseline = 'alphabetic';
  write(context, shortened(context, caption(), width - 92 - size), 92, height - size);
}

let painted = ''; // what the canvas shows

export function showLabels() {
  const canvas = id('labels'), ratio = window.devicePixelRatio || 1, {frame, state} = app;
  const now = JSON.stringify([canvas.clientWidth, canvas.clientHeight, ratio, css('scene'), css('text'), state.labels, !!app.maps, frame && [caption(), frame.field, frame.scale, state.map, state.colorBy,
    state.hidden, shown().map((one) => [one.isovalue, colorOf(one)])]]);
  if (now === painted) return;
  painted = now;
  const context = canvas.getContext('2d', {willReadFrequently: true}); // it changes while software draws the scene
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * ratio));
  context.scale(ratio, ratio);
  paintLabels(context, canvas.clientWidth, canvas.clientHeight);
  document.body.dataset.caption = state.labels && frame ? caption() : '';
}
