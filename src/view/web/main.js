// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ties the parts together: state -> wishes -> frames -> picture.
import {app, id, mayBeField} from './app.js';
import {colorsChanged, showMap, showRange} from './draw/colors.js';
import {commands, takeCommand, takeState, wholeState} from './commands.js';
import {Cuts} from './cuts.js';
import {rememberVersion, takeCard, takeMeasured} from './link/device.js';
import './fold.js';
import {short} from './format.js';
import {offerField, refuseFormula} from './formula.js';
import {forgetBoundary, frameAll, lookAtFirst} from './draw/framing.js';
import {showHeights, stretched} from './draw/heights.js';
import './keys.js';
import {askChart, followStep, forgetField, forgetQuestions, forgetSpeed, forgetValues, takeChart, takeShare, takeSpectrum, valuePlayer} from './level.js';
import {Link} from './link/link.js';
import {moved, showBoundary} from './looking.js';
import {say, showNotes} from './notes.js';
import {forgetPartNumbers, showParts, takeParts} from './parts.js';
import {pickAt, takePicked} from './picked.js';
import {drawSoon, pictureAsSeen, takeFrame} from './picture.js';
import {Pointer} from './pointer.js';
import {showRegions} from './regions.js';
import {Save} from './save.js';
import {Scene} from './draw/scene.js';
import {coloredBy, fromAddress, fromMessage} from './state.js';
import {showSurfaces} from './surfaces.js';
import {TimeSteps} from './time.js';
import {commit, commitSoon, nameState, onReturn} from './undo.js';
import {showVolume} from './draw/volume.js';
import {serverDraws, stopWaiting, wishSoon} from './wishes.js';

id('unfinished').remove(); // all of the page came

/** The controls and the picture follow a new state. */
function showState() {
  showHeights();
  if (!app.state.camera || !app.camera.set(app.state.camera)) frameAll();
  offerField(app.state.field);
  if (!app.grid.colors) offerField(app.state.colorBy);
  id('field').value = app.state.field;
  id('color-by').value = app.state.colorBy;
  id('map').value = app.state.map;
  id('logarithmic').checked = app.state.logarithmic;
  id('outline').checked = app.state.outline;
  id('edges').checked = app.state.edges;
  id('labels-on').checked = app.state.labels;
  id('solid').value = app.state.solid;
  id('parallel').checked = app.camera.projection === 'parallel';
  id('color-details').hidden = !coloredBy(app.state);
  id('drawn-by').value = app.scene ? app.state.drawn : 'server';
  id('drawn-by').disabled = !app.scene;
  showVolume();
  id('picture').hidden = !serverDraws();
  showBoundary();
  app.cuts.show();
  app.time.show(app.state.step ?? 0);
  showMap();
  showRange();
  showRegions();
  id('span').value = app.state.span;
  followStep();
  showSurfaces();
  showParts();
  wishSoon();
  drawSoon();
}

app.cuts = new Cuts(id('cuts'), {slice: id('add-slice'), clip: id('add-clip')}, {
  state: () => app.state, box: () => [app.grid?.lower || [0, 0, 0], app.grid?.upper || [1, 1, 1]], direction: () => stretched(app.camera.direction), say,
  changed(moving, added) {
    // A slice of one colour says little.
    if (added === 'slice' && !app.state.colorBy) {
      app.state.colorBy = id('color-by').value = app.state.field;
      colorsChanged();
    }
    app.cuts.show();
    wishSoon();
    drawSoon();
    if (moving) commitSoon(); else commit();
  },
});

app.time = new TimeSteps({section: id('time'), slider: id('step'), label: id('step-text'), typed: id('time-typed'), play: id('play'), speed: id('speed'), order: id('order')}, {
  step: () => app.state.step ?? 0, commit, rest: followStep, say,
  go(step) {
    if (step < 0 || step >= app.time.times.length) return;
    if (step !== app.state.step) forgetPartNumbers();
    app.state.step = step;
    app.time.show(step);
    wishSoon();
    commitSoon();
  },
});

/** "artery-Umag-0.2", of letters that every system takes. */
const fileName = () => [id('file').textContent.replace(/\.[a-z0-9]+$/i, ''), app.state.field, app.state.value === null ? '' : short(app.state.value)].filter(Boolean)
  .join('-').replace(/[^A-Za-z0-9._+=-]+/g, '_').replace(/^[.]+/, '').slice(0, 80);

app.save = new Save({state: wholeState, send: (message) => app.link.send(message), name: fileName, seen: pictureAsSeen, steps: () => app.time.times.length,
  size: () => [id('scene').clientWidth, id('scene').clientHeight].map((side) => Math.round(side * Math.max(1, window.devicePixelRatio))),
  range: () => (app.slider.span ? [app.slider.span.lower, app.slider.span.upper] : [0, 1])});

/** As at the start; the browser's Back leads to what was shown. */
id('reset').addEventListener('click', () => {
  if (!app.grid) return;
  commit();
  app.time.stop();
  valuePlayer.stop();
  app.state = fromMessage(app.grid.state);
  app.camera.setUp(app.state.up);
  lookAtFirst();
  app.camera.setProjection('perspective');
  forgetValues();
  say('');
  showState();
  commit();
});

/** What an address names and there is not: a map of colours, a time step, an isovalue, saved colours. */
function fitState() {
  if (app.maps && !Object.hasOwn(app.maps, app.state.map)) app.state.map = 'viridis';
  if (!app.grid) return;
  if (app.grid.times.length < 2) app.state.step = null;
  else if (app.state.step === null || app.state.step >= app.grid.times.length) app.state.step = fromMessage(app.grid.state).step;
  if (app.state.value !== null) app.state.value = app.slider.allowed(app.state.value);
  if (app.grid.colors && !app.grid.colors.includes(app.state.colorBy)) app.state.colorBy = '';
}

onReturn(() => { fitState(); showState(); });
commands.show = showState;

function fill(select, names, chosen) {
  select.replaceChildren(...names.map(([value, text]) => new Option(text, value)));
  select.value = chosen;
}

/** The page is a file, of some isosurfaces or of a grid: it has nothing that only isotet can do, or only who has the grid. */
function takeSaved({saved, values, state}) {
  app.slider.stops = values ?? null;
  app.save.endings = '.stl or .glb';
  const gone = saved === 'grid' ? ['isotet'] : ['isotet', 'grid'];
  for (const one of document.querySelectorAll('[data-needs]')) one.hidden = one.disabled = gone.includes(one.dataset.needs);
  if (state.isosurfaces === false) id('isosurfaces').parentElement.hidden = false; // the way back to the boundary
}

function takeGrid(message) {
  if (app.grid) { askChart(); app.sent = null; return wishSoon(); }
  app.grid = message;
  if (message.saved) takeSaved(message);
  if (!app.grid.lower) [app.grid.lower, app.grid.upper] = [[0, 0, 0], [1, 1, 1]];
  app.time.set(app.grid.times);
  id('copy-steps-row').hidden = app.grid.times.length < 2;
  const names = app.grid.fields.map(({name}) => name), start = fromMessage(app.grid.state);
  const fresh = !app.state.field || !mayBeField(app.state.field);
  if (fresh) app.state = {...start, camera: app.state.camera, labels: app.state.labels, drawn: app.state.drawn};
  fitState();
  if (!names.includes(app.state.field)) names.unshift(app.state.field);
  const label = (name) => [name, name + (app.grid.fields.find((one) => one.name === name)?.cell ? ' (cells)' : '')];
  fill(id('field'), names.map(label), app.state.field);
  fill(id('color-by'), [['', 'Surface'], ...(app.grid.colors ?? names).map(label)], app.state.colorBy);
  showNotes();
  document.body.dataset.grid = `${app.grid.points} points, ${app.grid.cells} cells`;
  if (!app.state.camera) lookAtFirst();
  showState();
  if (fresh) nameState();
}

/** Another grid comes: nothing of this one stays. */
function forgetGrid() {
  app.time.stop();
  valuePlayer.stop();
  if (app.grid) app.state = fromAddress('');
  app.grid = app.frame = app.made = app.sent = app.picked = null;
  app.sentAt.clear();
  app.large = 0;
  forgetQuestions();
  forgetField();
  forgetPartNumbers();
  forgetBoundary();
  stopWaiting();
  say('');
}

function takeProgress({step, fraction}) {
  const running = fraction < 1 && step !== 'ready', failed = /^n(ot packed|o boundary)/.test(step);
  const words = {read: 'Reading', pack: 'Packing', make: 'Making', split: 'Packing', boundary: 'Finding the boundary', check: 'Finding the boundary'};
  id('progress').hidden = !running && !failed;
  id('progress-text').textContent = failed ? step : `${words[step] || step}${app.grid ? ', the surface can be moved already' : ''}`;
  id('progress-bar').hidden = !running;
  if (fraction > 0) id('progress-bar').value = fraction;
  else id('progress-bar').removeAttribute('value');
  const changed = document.body.dataset.step !== step;
  document.body.dataset.step = step;
  if (step === 'ready') forgetSpeed();
  if (changed && app.grid) wishSoon(); // the boundary may be there
}

const messages = {
  welcome(message) {
    rememberVersion(message);
    app.maps = message.maps;
    app.save.out = message.out;
    app.other = message.other ?? '';
    fitState();
    fill(id('map'), Object.keys(app.maps).map((name) => [name, name]), app.state.map);
    const name = message.file.split('/').pop();
    id('file').textContent = name;
    id('file').title = message.file;
    document.title = `${name} – isotet`;
    showMap();
    if (app.grid) { app.sent = null; askChart(); }
  },
  grid: takeGrid,
  progress: takeProgress,
  chart: takeChart,
  spectrum: takeSpectrum,
  command: takeCommand,
  parts: takeParts,
  card: takeCard,
  measured: takeMeasured,
  picked: takePicked,
  share: takeShare,
  state: takeState,
  refused(message) {
    if (message.number >= app.number) stopWaiting();
    app.sentAt.delete(message.number);
    app.sent = null;
    app.time.stop(); // the frame that they wait for does not come
    valuePlayer.stop();
    say(message.sentence);
  },
  saved: (message) => app.save.done(`Saved: ${message.path}`),
  download: (message) => app.save.begin(message),
  error: ({about, sentence}) => {
    if (about === 'save') app.save.tell(sentence);
    else if (about !== 'chart' || !refuseFormula(sentence)) say(sentence);
  },
};

app.link = new Link(app.token, {
  open: () => { id('lost').hidden = true; document.body.dataset.link = 'open'; },
  other: forgetGrid,
  waits: () => app.sentAt.size > 0 || app.save.file !== null,
  lost: (refused) => {
    // Another connection begins without surfaces: all are sent again.
    app.sent = null;
    forgetQuestions();
    app.save.lost();
    stopWaiting();
    app.sentAt.clear();
    id('lost').textContent = refused === 'file' ? 'isotet view has ended.' :
      'No connection to isotet view: what is chosen now is shown when it is back. Trying again … If it was ended, start it again.';
    id('lost').hidden = refused === 'token' || refused === 'pages';
    document.body.dataset.link = 'lost';
  },
  text: (message) => messages[message.say]?.(message),
  frame: takeFrame,
  part: (bytes) => app.save.takePart(bytes),
});

await app.link.started; // the thread, where there is one: WebGL's beginning may take as long as that of the engine

try {
  app.scene = new Scene(id('scene'));
  app.scene.onRestored = () => { app.frame = null; app.sent = null; app.link.restart(); };
} catch {
  app.scene = null; // the server draws
}

new Pointer(id('scene'), app.camera, () => (serverDraws() ? null : app.scene), {
  moved, middle: () => app.grid && stretched(app.grid.lower.map((v, i) => (v + app.grid.upper[i]) / 2)), level: (steps) => app.slider.step(steps), click: pickAt,
});
