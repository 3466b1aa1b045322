// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The isovalue: slider, chart and number.
import {app, id} from './app.js';
import {ChartSlider} from './chart.js';
import * as format from './format.js';
import {say} from './notes.js';
import {pinColor, showSurfaces} from './surfaces.js';
import {address, commit, commitSoon} from './undo.js';
import {wishSoon} from './wishes.js';

app.slider = new ChartSlider(id('slider'), id('chart'), {input: setValue, commit});

export function setValue(value) {
  app.state.value = value;
  showValue();
  wishSoon();
}

export function showValue() {
  if (document.activeElement !== id('value')) id('value').value = app.state.value === null ? '' : String(app.state.value);
  id('value').removeAttribute('aria-invalid');
  const rows = id('surfaces').children;
  if (rows.length > 0 && app.state.value !== null) rows[0].querySelector('.value').textContent = format.short(app.state.value);
  app.slider.set(app.state.value ?? 0, app.state.pins.map((pin, i) => ({value: pin.value, color: pinColor(i)})));
  const expected = app.state.value === null ? null : app.slider.expected(app.state.value);
  const ms = expected === null || !msPerTriangle ? '' : `, ${format.duration(expected * msPerTriangle)}`;
  id('prediction').textContent = expected === null ? '' : `About ${format.rough(expected)} triangles${ms} expected`;
  showMeasures();
}

/** What the server took for a triangle, by the last frames that it made. */
let msPerTriangle = null;
export function measureServer(made) {
  const triangles = made.surfaces.filter(({kind, mesh}) => kind === 'surface' && mesh).reduce((sum, one) => sum + one.triangles, 0);
  if (triangles < 1000 || made.picture) return;
  const now = (made.extract_ms + made.mesh_ms) / triangles;
  msPerTriangle = msPerTriangle === null ? now : 0.7 * msPerTriangle + 0.3 * now;
}

/** Area and volume at the slider's value. */
function showMeasures() {
  const {spectrum} = app.slider;
  for (const option of id('curve').options) option.disabled = option.value !== 'triangles' && !spectrum;
  id('curve').value = spectrum ? app.slider.curve : 'triangles';
  document.body.dataset.spectrum = spectrum ? spectrum.field : '';
  if (!spectrum || app.state.value === null) { id('measures').textContent = 'Area and volume come when nothing moves'; return; }
  const [area, below] = ['area', 'volume_below'].map((name) => app.slider.measured(name, app.state.value));
  id('measures').textContent = area === null ? '' :
    `Area ${area.toPrecision(4)}, volume below ${below.toPrecision(4)} of ${spectrum.volume.toPrecision(4)}`;
}

id('curve').addEventListener('change', () => { app.slider.curve = id('curve').value; app.slider.draw(); });

export function askChart() {
  if (app.slider.chart?.field !== app.state.field) app.slider.chart = app.slider.spectrum = null; // the same field's serves until the new one is there
  app.link.send({do: 'chart', field: app.state.field});
}

export function takeChart(chart) {
  if (chart.field !== app.state.field) return;
  app.slider.chart = chart.lower <= chart.upper ? chart : null;
  id('lower').textContent = app.slider.chart ? format.short(chart.lower) : '';
  id('upper').textContent = app.slider.chart ? format.short(chart.upper) : 'The field has no finite value';
  if (app.state.value === null && app.slider.chart) {
    app.state.value = chart.first;
    history.replaceState(null, '', address());
  }
  showValue();
  askSpectrum();
  wishSoon();
}

/** Of the step that is shown, unless they play. */
let spectrumAsked = '';
export function askSpectrum() {
  const step = app.frame?.step ?? 0, wanted = `${step}|${app.state.field}`;
  if (!app.slider.chart || app.time.playing || spectrumAsked === wanted || (app.slider.spectrum?.field === app.state.field && app.slider.spectrum.step === step)) return;
  if (app.link.send({do: 'spectrum', field: app.state.field})) spectrumAsked = wanted;
}

/** Another connection knows of no question. */
export const forgetQuestions = () => { spectrumAsked = ''; };

export function takeSpectrum(spectrum) {
  spectrumAsked = '';
  if (spectrum.field !== app.state.field || (app.frame && spectrum.step !== app.frame.step)) return;
  app.slider.spectrum = spectrum.isovalues.length > 0 ? spectrum : null;
  showValue();
}

function typed() {
  const value = format.parseNumber(id('value').value);
  id('value').setAttribute('aria-invalid', value === null);
  if (value === null) return say('An isovalue is a number, such as 0.25 or 1e-3.');
  say('');
  setValue(value);
  commit();
}

id('value').addEventListener('keydown', (event) => {
  if (event.key === 'Enter') typed();
  if (event.key === 'Escape') { event.target.value = String(app.state.value ?? ''); event.target.removeAttribute('aria-invalid'); }
});
id('value').addEventListener('blur', () => showValue());

id('field').addEventListener('change', () => {
  app.state.field = id('field').value;
  app.state.value = null;
  app.state.pins = [];
  askChart();
  showSurfaces();
  commitSoon();
});
