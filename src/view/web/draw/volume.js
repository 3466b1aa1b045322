// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The field as a volume: switch, opacity over the values, and its curve on the histogram.
import {app, css, id} from '../app.js';
import {paintBars} from '../chart.js';
import {colorsChanged} from './colors.js';
import {roundTo} from '../format.js';
import {closePicked} from '../picked.js';
import {commit, commitSoon} from '../undo.js';
import {wishSoon} from '../wishes.js';

const opacityPresets = ['ramp', 'peaks', 'shell'];
const pointReach = 12; // pixels from a point to the pointer that takes it
let heldPoint = -1;    // the point that the hand moves

/** [[value, opacity], ...] of a text as isotet render takes it; null where it is a preset or no curve. */
export function pointsOf(text) {
  const points = text.split(',').map((point) => point.split(':').map((part) => (part.trim() === '' ? NaN : Number(part))));
  const fits = points.every((point, i) => point.length === 2 && point.every(Number.isFinite) && point[1] >= 0 && point[1] <= 1 && (i === 0 || point[0] >= points[i - 1][0]));
  return fits ? points : null;
}

const presetOf = (text) => (opacityPresets.includes(text.split(':')[0]) ? text.split(':')[0] : '');

/** Points are values of one field: another one begins with a preset. */
export function forgetPoints() {
  if (app.state.volume && !presetOf(app.state.volume.opacity)) app.state.volume.opacity = 'ramp';
}

const textOfPoints = (points) => points.map(([value, opacity]) => `${value}:${opacity}`).join(',');

/** The curve that is wished for; of a preset that which the last picture had. */
const opacityPoints = () => (app.state.volume && pointsOf(app.state.volume.opacity)) || app.frame?.opacity || [];

export function showVolume() {
  const {volume} = app.state;
  id('volume').checked = !!volume;
  id('volume-details').hidden = !volume;
  id('color-by').disabled = !!volume; // a picture has one colour scale
  if (!volume) return;
  id('volume-surfaces').checked = volume.surfaces;
  id('volume-shaded').checked = volume.shaded;
  id('opacity-preset').value = presetOf(volume.opacity);
  if (document.activeElement !== id('opacity-text')) id('opacity-text').value = volume.opacity;
  const length = volume.length ?? app.frame?.opacity_length;
  if (document.activeElement !== id('opacity-length')) id('opacity-length').value = length ? String(Number(length.toPrecision(4))) : '';
  showCurve();
}

/** The place of a point on the canvas. Low opacities matter most: the height is their square root. */
function placeOf([value, opacity], width, height) {
  return [Math.max(0, Math.min(1, app.slider.evenPart(value))) * width, 4 + (height - 8) * (1 - Math.sqrt(opacity))];
}

export function showCurve() {
  const canvas = id('opacity-curve'), [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (!app.state.volume || width === 0 || !app.slider.span) return;
  const ratio = window.devicePixelRatio || 1, context = canvas.getContext('2d'), {chart} = app.slider;
  [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  context.scale(ratio, ratio);
  context.fillStyle = css('bars');
  if (chart) paintBars(context, chart, (value) => app.slider.evenPart(value) * width, height - 4, height - 8);
  const points = opacityPoints().map((point) => placeOf(point, width, height));
  if (points.length === 0) return;
  context.strokeStyle = context.fillStyle = css('accent');
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(0, points[0][1]);
  for (const [x, y] of points) context.lineTo(x, y);
  context.lineTo(width, points.at(-1)[1]);
  context.stroke();
  for (const [x, y] of points) {
    context.beginPath();
    context.arc(x, y, 4, 0, 2 * Math.PI);
    context.fill();
  }
  document.body.dataset.curve = textOfPoints(opacityPoints());
}

function changeOpacity(opacity) {
  app.state.volume.opacity = opacity;
  showVolume();
  wishSoon();
  commitSoon();
}

/** The point at the pointer, between its neighbours. */
function movePoint(event) {
  const box = id('opacity-curve').getBoundingClientRect(), {span} = app.slider, points = opacityPoints().map((point) => [...point]);
  const across = Math.max(0, Math.min(1, (event.clientX - box.left) / box.width));
  const up = Math.max(0, Math.min(1, 1 - (event.clientY - box.top - 4) / (box.height - 8)));
  const value = roundTo(span.lower + across * app.slider.range(), app.slider.range());
  points[heldPoint] = [Math.max(points[heldPoint - 1]?.[0] ?? -Infinity, Math.min(points[heldPoint + 1]?.[0] ?? Infinity, value)), Number((up * up).toPrecision(3))];
  changeOpacity(textOfPoints(points));
}

/** The nearest point where one is in pointReach, else -1. */
function pointAt(event) {
  const box = id('opacity-curve').getBoundingClientRect();
  const far = opacityPoints().map((point) => { const [x, y] = placeOf(point, box.width, box.height); return Math.hypot(x - event.clientX + box.left, y - event.clientY + box.top); });
  const nearest = far.indexOf(Math.min(...far));
  return far[nearest] <= pointReach ? nearest : -1;
}

id('opacity-curve').addEventListener('pointerdown', (event) => {
  if (event.button !== 0 || !app.slider.span) return;
  event.preventDefault();
  try { event.target.setPointerCapture(event.pointerId); } catch { /* a pointer that is up already */ }
  heldPoint = pointAt(event);
  if (heldPoint < 0) { // a new one
    const value = app.slider.span.lower + (event.offsetX / event.target.clientWidth) * app.slider.range(), points = [...opacityPoints()];
    heldPoint = points.filter((point) => point[0] <= value).length;
    points.splice(heldPoint, 0, [value, 0]);
    app.state.volume.opacity = textOfPoints(points);
  }
  movePoint(event);
});
id('opacity-curve').addEventListener('pointermove', (event) => { if (heldPoint >= 0) movePoint(event); });
for (const end of ['pointerup', 'pointercancel'])
  id('opacity-curve').addEventListener(end, () => { if (heldPoint >= 0) { heldPoint = -1; commit(); } });
id('opacity-curve').addEventListener('dblclick', (event) => {
  const at = pointAt(event), points = [...opacityPoints()];
  if (at < 0 || points.length < 2) return;
  points.splice(at, 1);
  changeOpacity(textOfPoints(points));
});

id('volume').addEventListener('change', () => {
  const {state} = app;
  state.volume = id('volume').checked ? {opacity: 'ramp', length: null, surfaces: false, shaded: false} : null;
  app.sent = null;
  closePicked();
  showVolume();
  colorsChanged();
  commit();
});
for (const part of ['surfaces', 'shaded'])
  id(`volume-${part}`).addEventListener('change', (event) => {
    app.state.volume[part] = event.target.checked;
    wishSoon();
    commit();
  });
id('opacity-preset').addEventListener('change', () => changeOpacity(id('opacity-preset').value || textOfPoints(opacityPoints())));
id('opacity-text').addEventListener('change', () => changeOpacity(id('opacity-text').value.trim() || 'ramp'));
id('opacity-length').addEventListener('change', () => {
  const length = Number(id('opacity-length').value.replace(',', '.'));
  id('opacity-length').setAttribute('aria-invalid', !(length >= 0 && Number.isFinite(length)));
  if (!(length >= 0 && Number.isFinite(length))) return;
  app.state.volume.length = length || null; // nothing: by the size of the grid
  wishSoon();
  commit();
});
new ResizeObserver(showCurve).observe(id('opacity-curve'));
