// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One of the two frames of beside.html: tells what it shows, and follows the other one.
import {app, id, isSecond} from './app.js';
import {setValue, valuePlayer} from './level.js';
import {showCamera} from './looking.js';
import {toAddress} from './state.js';
import {commit, follow} from './undo.js';

/** The page that has the frames; null where this page is alone. */
const pair = parent !== window && new URLSearchParams(location.search).has('beside') ? parent : null;
/** What it told of this page last: all of its state, and the number of the other one's change that it took last. */
const toldPair = {state: '', taken: 0};

function tellPair(always = false) {
  const camera = app.camera.text(), state = toAddress({...app.state, camera}), {field, value, step} = app.state;
  if (state === toldPair.state && !always) return;
  toldPair.state = state;
  const {title: path, textContent: file} = id('file'), {lower, upper} = app.grid;
  pair.postMessage({taken: toldPair.taken, camera, field, value, step, steps: app.time.times.length, file, path, lower, upper}, location.origin);
}

function takeChange({number, camera, value, step}) {
  if (camera !== undefined && app.camera.set(camera)) showCamera();
  if (value !== undefined) {
    valuePlayer.stop();
    setValue(value);
  }
  if (step !== undefined) {
    app.time.stop();
    app.time.on.go(step);
  }
  toldPair.taken = number;
  tellPair(true);
}

if (pair) {
  app.changed = () => tellPair();
  id('beside').textContent = 'Alone';
  id('beside').title = 'This picture alone (2)';
  addEventListener('message', ({source, origin, data}) => {
    if (source !== pair || origin !== location.origin || !app.grid) return;
    if (data.panel !== undefined) document.body.classList.toggle('wide', !data.panel);
    else follow(() => takeChange(data));
  });
}

/** Two pictures that begin as this one, this one and that of the other file, or this one alone. */
export function toggleBeside() {
  if (!app.grid || app.grid.saved) return;
  commit();
  const state = toAddress(app.state), other = app.other ? new URLSearchParams({camera: app.state.camera}).toString() : state;
  if (pair) pair.location.assign(`${location.pathname}${isSecond ? '?second' : ''}#${app.token}&${state}`);
  else location.assign(`beside.html${app.other ? '?second' : ''}#${app.token}&${new URLSearchParams(isSecond ? {left: other, right: state} : {left: state, right: other})}`);
}

id('beside').addEventListener('click', toggleBeside);
