// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The isovalue: slider, chart and number.
import {app, id} from './app.js';
import {ChartSlider} from './chart.js';
import {colorsChanged} from './draw/colors.js';
import * as format from './format.js';
import {showIsosurfaces} from './looking.js';
import {say} from './notes.js';
import {Player} from './play.js';
import {forgetParts, forgetPartNumbers} from './parts.js';
import {cellsOf} from './state.js';
import {pinColor, showSurfaces, sliderColor} from './surfaces.js';
import {commit, commitSoon, nameState} from './undo.js';
import {forgetPoints, showCurve} from './draw/volume.js';
import {wishSoon} from './wishes.js';

app.slider = new ChartSlider(id('slider'), id('chart'), {input(value) { showIsosurfaces(true); setValue(value); }, commit});

/** Over the slider from end to end, by its scale. */
const places = () => app.slider.stops?.length ?? 101;
const valueOfPlace = (place) => (app.slider.stops ? app.slider.stops[place] : app.slider.roundedAt(place / (places() - 1)));

export const valuePlayer = new Player({button: id('play-value'), speed: id('speed-value'), order: id('order-value')}, {
  count: () => (app.slider.range() > 0 ? places() : 0), ended: () => commit(),
  at() {
    if (level.place !== null && valueOfPlace(level.place) === app.state.value) return level.place;
    const {slider, state} = app, {stops} = slider;
    return stops ? stops.indexOf(slider.allowed(state.value)) : Math.round(Math.max(0, Math.min(1, slider.part(state.value))) * (places() - 1));
  },
  go(place) {
    const before = app.state.value;
    level.place = place;
    level.asked = app.number + 1;
    showIsosurfaces(true);
    setValue(valueOfPlace(place));
    if (app.state.value === before) valuePlayer.shown(); // no other frame comes
  },
});

/** A frame is on the screen: of the slider's value, though it may have no isosurface. */
export function valueShown() { if (app.frame.number >= level.asked) valuePlayer.shown(); }

for (const event of ['pointerdown', 'keydown']) id('slider').addEventListener(event, () => valuePlayer.stop());

const level = {
  place: null,           // that was played last
  asked: 0,              // the number of its frame
  seen: new Map(),       // ranges: field -> step -> [lower, upper]
  left: new Map(),       // what was shown of a field when another one was chosen
  automatic: false,      // the value is that of a field that is constant, until a step has another
  chart: '', spectrum: '', // that were asked for: step and field
  share: '',             // that was typed last, until its isovalue comes
  empty: '',             // where no value is finite
  typing: false,         // in the box, until Enter
  scaled: '',            // the field whose slider became logarithmic by itself
  msPerTriangle: null,   // of the server, by the last frames that it made
};

export function setValue(value) {
  if (app.state.value !== app.slider.allowed(value)) forgetPartNumbers();
  app.state.value = app.slider.allowed(value);
  level.automatic = false;
  showValue();
  wishSoon();
}

export function showValue() {
  showSpan();
  if (!level.typing) fillBox();
  const rows = id('surfaces').children;
  if (rows.length > 0 && app.state.value !== null) rows[0].querySelector('.value').textContent = format.short(app.state.value);
  showScale();
  app.slider.set(app.state.value ?? 0, app.state.pins.map((pin, i) => ({value: pin.value, color: pinColor(i)})), sliderColor());
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

/** Of another grid: its fields may have the same names. */
export function forgetField() {
  level.seen.clear();
  forgetValues();
  level.automatic = false;
  level.empty = '';
  app.slider.chart = app.slider.spectrum = null;
}

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
  id('upper').textContent = slider.span ? format.short(slider.span.upper) : level.empty === question() ? (cellsOf(app.state).length > 0 ? 'No finite value in the cells that are shown' : 'The field has no finite value') : '';
  id('ends-of').textContent = !many || !slider.span ? '' : state.span === 'step' ? `step ${step}` :
    steps.size === app.time.times.length ? 'all steps' : `${steps.size} of ${app.time.times.length} steps`;
  Object.assign(document.body.dataset, {chart_step: slider.chart?.step ?? '', span: slider.span ? `${slider.span.lower} ${slider.span.upper}` : ''});
}

/** What cannot be is by value: a logarithm of nothing above 0, a share of a volume that is not measured yet. */
function showScale() {
  const {slider, state} = app, can = {'': true, log: slider.span?.upper > 0, share: slider.spectrum?.isovalues.length > 1 && slider.spectrum.volume > 0};
  for (const option of id('scale').options) option.disabled = !can[option.value];
  id('scale').value = state.scale;
  slider.scale = can[state.scale] ? state.scale : '';
}

id('scale').addEventListener('change', () => {
  app.state.scale = id('scale').value;
  showValue();
  commit();
});

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
    if (slider[kind] && (slider[kind].field !== state.field || (state.step !== null && slider[kind].step !== step) || !isOfCells(slider[kind]))) slider[kind] = null;
  if ((!slider.chart || state.value === null) && !time.playing && level.empty !== question()) askChart();
  showValue();
  askSpectrum();
}

const question = () => JSON.stringify([app.state.step, app.state.field, cellsOf(app.state)]);

const isOfCells = ({cells = []}) => JSON.stringify(cells) === JSON.stringify(cellsOf(app.state));

/** What comes may be of another field, step or cells than are shown by now. */
const isOfState = (answer) => answer.field === app.state.field && (app.state.step === null || answer.step === app.state.step) && isOfCells(answer);

/** What it is about. */
function questionOf(kind) {
  const {field, step} = app.state, cells = cellsOf(app.state), message = {do: kind, field};
  if (step !== null) message.step = step;
  return cells.length > 0 ? {...message, cells} : message;
}

export function askChart() {
  const wanted = question();
  if (level.chart !== wanted && app.link.send(questionOf('chart'))) level.chart = wanted;
}

export function takeChart(chart) {
  const {slider, state} = app;
  level.chart = '';
  if (chart.lower <= chart.upper) see(chart.field, chart.step, chart.lower, chart.upper);
  if (!isOfState(chart)) return;
  slider.chart = chart.lower <= chart.upper ? chart : null;
  level.empty = slider.chart ? '' : question();
  const varies = chart.lower < chart.upper;
  if (state.value === null && slider.chart) {
    if (!state.scale && slider.isOverDecades()) {
      state.scale = 'log';
      level.scaled = state.field;
    }
    state.value = state.scale === 'log' ? slider.firstByLogarithm() : chart.first;
    level.automatic = !varies;
    nameState();
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
  if (app.link.send(questionOf('spectrum'))) level.spectrum = wanted;
}

/** Another connection knows of no question. */
export function forgetQuestions() {
  level.chart = level.spectrum = level.share = '';
  forgetParts();
}

export function takeSpectrum(spectrum) {
  level.spectrum = '';
  if (!isOfState(spectrum)) return;
  app.slider.spectrum = spectrum.isovalues.length > 0 ? spectrum : null;
  showValue();
}

/** An isovalue by share is found by the server. */
function askShare({of, percent}) {
  if (app.link.send({...questionOf('share'), of, percent})) level.share = `${question()}|${of}|${percent}`;
}

export function takeShare({field, step, of, percent, isovalue}) {
  const {state} = app;
  if (level.share !== `${question()}|${of}|${percent}` || field !== state.field || (state.step !== null && step !== state.step)) return;
  level.share = '';
  level.typing = false;
  setValue(isovalue);
  commit();
}

function typed() {
  valuePlayer.stop();
  const {value: text} = id('value'), hasShares = app.grid?.saved !== 'surfaces', share = hasShares ? format.parseShare(text) : null;
  const value = share ? 0 : text === format.ofBox(app.state.value) ? app.state.value : format.parseNumber(text, app.slider.span);
  id('value').setAttribute('aria-invalid', value === null);
  level.typing = value === null;
  if (value === null) return say(`An isovalue is a number, such as 0.25 or 1e-3, or a part of the range, such as 50 %${hasShares ? '; or 90%v for 90 % of the volume below it, or p95 for a percentile of the points' : ''}.`);
  level.share = '';
  showIsosurfaces(true);
  if (share) { say(''); level.typing = true; return askShare(share); }
  say('');
  setValue(value);
  commit();
}

/** The number as it is now; a box that has the focus keeps it. */
function fillBox() {
  const box = id('value'), text = format.ofBox(app.state.value);
  box.removeAttribute('aria-invalid');
  if (box.value === text) return;
  box.value = text;
  if (document.activeElement === box) box.select();
}

/** What was typed and not taken goes, and with it what was said of it. */
function leaveBox() {
  if (id('value').getAttribute('aria-invalid') === 'true') say('');
  level.typing = false;
  fillBox();
}

id('value').addEventListener('input', () => { level.typing = true; });

id('value').addEventListener('keydown', (event) => {
  if (event.key === 'Enter') typed();
  if (['ArrowUp', 'ArrowDown', 'PageUp', 'PageDown'].includes(event.key) && app.slider.span) {
    event.preventDefault();
    valuePlayer.stop();
    showIsosurfaces(true);
    level.typing = false;
    app.slider.step((event.key.endsWith('Up') ? 1 : -1) * (event.key.startsWith('Page') ? 10 : event.shiftKey ? 0.1 : 1));
  }
  if (event.key === 'Escape') leaveBox();
});
id('value').addEventListener('blur', leaveBox);

/** Another field has its own value and pins: those that it had, when it was shown before. */
export function chooseField(name) {
  const {state} = app;
  valuePlayer.stop();
  commit(); // what was shown last is a state of its own
  forgetPartNumbers();
  level.left.set(state.field, {value: state.value, pins: state.pins});
  if (level.scaled === state.field && state.scale === 'log') state.scale = '';
  Object.assign(state, {field: name, value: null, pins: []}, level.left.get(name));
  if (!state.isosurfaces && state.coloredBoundary && app.grid.fields.some((one) => one.name === name)) { // it is what is seen
    state.range = null;
    state.hidden = [];
    state.colorBy = id('color-by').value = name;
    colorsChanged();
  }
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
