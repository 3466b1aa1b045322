// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The isovalue: slider, chart and number.
import {app, id} from './app.js';
import {ChartSlider} from './chart.js';
import * as format from './format.js';
import {say} from './notes.js';
import {pinColor, showSurfaces} from './surfaces.js';
import {address, commit, commitSoon} from './undo.js';
import {forgetPoints, showCurve} from './volume.js';
import {wishSoon} from './wishes.js';

app.slider = new ChartSlider(id('slider'), id('chart'), {input: setValue, commit});

const level = {
  seen: new Map(),       // ranges: field -> step -> [lower, upper]
  left: new Map(),       // what was shown of a field when another one was chosen
  automatic: false,      // the value is that of a field that is constant, until a step has another
  chart: '', spectrum: '', // that were asked for: step and field
  empty: '',             // where no value is finite
  msPerTriangle: null,   // of the server, by the last frames that it made
};

export function setValue(value) {
  app.state.value = app.slider.allowed(value);
  level.automatic = false;
  showValue();
  wishSoon();
}

export function showValue() {
  showSpan();
  if (document.activeElement !== id('value')) {
    id('value').value = app.state.value === null ? '' : String(app.state.value);
    id('value').removeAttribute('aria-invalid');
  }
  const rows = id('surfaces').children;
  if (rows.length > 0 && app.state.value !== null) rows[0].querySelector('.value').textContent = format.short(app.state.value);
  app.slider.set(app.state.value ?? 0, app.state.pins.map((pin, i) => ({value: pin.value, color: pinColor(i)})));
  const expected = app.state.value === null ? null : app.slider.expected(app.state.value);
  const ms = expected === null || !level.msPerTriangle ? '' : `, ${format.duration(expected * level.msPerTriangle)}`;
  id('prediction').textContent = expected === null ? '' : expected === 0 ? 'No triangles expected' : `About ${format.rough(expected)} triangles${ms} expected`;
  showMeasures();
  showCurve();
}

export function measureServer(made) {
  const triangles = made.surfaces.filter(({kind, mesh}) => kind === 'surface' && mesh).reduce((sum, one) => sum + one.triangles, 0);
  if (triangles < 1000 || made.picture) return;
  const now = (made.extract_ms + made.mesh_ms) / triangles;
  level.msPerTriangle = level.msPerTriangle === null ? now : 0.7 * level.msPerTriangle + 0.3 * now;
}

/** Of fields that were shown before. */
export const forgetValues = () => level.left.clear();

/** Once the grid is packed, frames take another time. */
export const forgetSpeed = () => { level.msPerTriangle = null; };

/** Area and volume at the slider's value. */
function showMeasures() {
  const {spectrum} = app.slider;
  for (const option of id('curve').options) option.disabled = option.value !== 'triangles' && !spectrum;
  id('curve').value = spectrum ? app.slider.curve : 'triangles';
  document.body.dataset.spectrum = spectrum ? spectrum.field : '';
  if (!spectrum || app.state.value === null) { id('measures').textContent = app.grid?.saved === 'surfaces' ? '' : 'Area and volume come when nothing moves'; return; }
  const [area, below] = ['area', 'volume_below'].map((name) => app.slider.measured(name, app.state.value));
  id('measures').textContent = area === null ? '' :
    `Area ${format.rounded(area, 4)}, volume below ${format.rounded(below, 4)}: ${format.share(below, spectrum.volume)} of ${format.rounded(spectrum.volume, 4)}`;
}

id('curve').addEventListener('change', () => { app.slider.curve = id('curve').value; app.slider.draw(); });

/** The range of a field in a step; nothing where it was not seen. */
export const rangeOf = (field, step) => level.seen.get(field)?.get(step);

function see(field, step, lower, upper) {
  if (!level.seen.has(field)) level.seen.set(field, new Map());
  if (lower <= upper) level.seen.get(field).set(step, [lower, upper]);
}

/** The ends of the slider: of the step that is shown, or of all that were seen. */
function showSpan() {
  const {slider, state, frame} = app, steps = level.seen.get(state.field) || new Map();
  const many = app.time.times.length > 1, step = frame?.field === state.field ? frame.step : state.step;
  const ranges = many && state.span === 'step' ? [steps.get(step)].filter(Boolean) : [...steps.values()];
  slider.span = ranges.length === 0 ? null : {lower: Math.min(...ranges.map(([lower]) => lower)), upper: Math.max(...ranges.map(([, upper]) => upper))};
  id('lower').textContent = slider.span ? format.short(slider.span.lower) : '';
  id('upper').textContent = slider.span ? format.short(slider.span.upper) : level.empty === question() ? 'The field has no finite value' : '';
  id('ends-of').textContent = !many || !slider.span ? '' : state.span === 'step' ? `step ${step}` :
    steps.size === app.time.times.length ? 'all steps' : `${steps.size} of ${app.time.times.length} steps`;
  Object.assign(document.body.dataset, {chart_step: slider.chart?.step ?? '', span: slider.span ? `${slider.span.lower} ${slider.span.upper}` : ''});
}

id('span').addEventListener('change', () => {
  app.state.span = id('span').value;
  showValue();
  commit();
});

/** The chart belongs to one step: another one's is taken away, and asked for unless they play. */
export function followStep() {
  const {slider, state, frame, time} = app;
  if (frame?.range) see(frame.field, frame.step, ...frame.range);
  const step = frame?.field === state.field ? frame.step : state.step;
  for (const kind of ['chart', 'spectrum'])
    if (slider[kind] && (slider[kind].field !== state.field || (state.step !== null && slider[kind].step !== step))) slider[kind] = null;
  if ((!slider.chart || state.value === null) && !time.playing && level.empty !== question()) askChart();
  showValue();
  askSpectrum();
}

const question = () => `${app.state.step}|${app.state.field}`;

export function askChart() {
  const wanted = question(), message = {do: 'chart', field: app.state.field};
  if (app.state.step !== null) message.step = app.state.step;
  if (level.chart !== wanted && app.link.send(message)) level.chart = wanted;
}

export function takeChart(chart) {
  const {slider, state} = app;
  level.chart = '';
  if (chart.lower <= chart.upper) see(chart.field, chart.step, chart.lower, chart.upper);
  if (chart.field !== state.field || (state.step !== null && chart.step !== state.step)) return;
  slider.chart = chart.lower <= chart.upper ? chart : null;
  level.empty = slider.chart ? '' : question();
  const varies = chart.lower < chart.upper;
  if (state.value === null && slider.chart) {
    state.value = chart.first;
    level.automatic = !varies;
    history.replaceState(null, '', address());
  } else if (level.automatic && varies) {
    setValue(chart.first);
    commitSoon();
  }
  showValue();
  askSpectrum();
  wishSoon();
}

/** Of the step that is shown, unless they play. */
export function askSpectrum() {
  const {slider, state} = app, wanted = question();
  if (!slider.chart || app.time.playing || level.spectrum === wanted || slider.spectrum?.field === state.field) return;
  const message = {do: 'spectrum', field: state.field};
  if (state.step !== null) message.step = state.step;
  if (app.link.send(message)) level.spectrum = wanted;
}

/** Another connection knows of no question. */
export const forgetQuestions = () => { level.chart = level.spectrum = ''; };

export function takeSpectrum(spectrum) {
  level.spectrum = '';
  if (spectrum.field !== app.state.field || (app.state.step !== null && spectrum.step !== app.state.step)) return;
  app.slider.spectrum = spectrum.isovalues.length > 0 ? spectrum : null;
  showValue();
}

function typed() {
  const value = format.parseNumber(id('value').value, app.slider.span);
  id('value').setAttribute('aria-invalid', value === null);
  if (value === null) return say('An isovalue is a number, such as 0.25 or 1e-3, or a part of the range, such as 50 %.');
  say('');
  setValue(value);
  commit();
}

id('value').addEventListener('keydown', (event) => {
  if (event.key === 'Enter') typed();
  if (event.key === 'Escape') { event.target.value = String(app.state.value ?? ''); event.target.removeAttribute('aria-invalid'); }
});
id('value').addEventListener('blur', () => showValue());

/** Another field has its own value and pins: those that it had, when it was shown before. */
export function chooseField(name) {
  const {state} = app;
  commit(); // what was shown last is a state of its own
  level.left.set(state.field, {value: state.value, pins: state.pins});
  Object.assign(state, {field: name, value: null, pins: []}, level.left.get(name));
  app.slider.chart = app.slider.spectrum = null;
  level.automatic = false;
  forgetPoints();
  commit();
  askChart();
  showValue();
  showSurfaces();
  wishSoon();
}

id('field').addEventListener('change', () => chooseField(id('field').value));
