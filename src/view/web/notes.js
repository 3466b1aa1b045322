// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sentences over the picture, and notes of grid and surfaces in a list.
import {app, id} from './app.js';

/** What is shown, but for the camera. */
const shownState = () => JSON.stringify({...app.state, camera: null});
let saidFor = '';

/** Says it until something else is shown. */
export function say(sentence) {
  saidFor = sentence ? shownState() : '';
  id('message').textContent = sentence;
  id('message').hidden = !sentence;
}

id('message').addEventListener('click', () => say(''));

/** What the frame says stands beside what the grid said, which stays. */
export function showNotes(frame = app.frame) {
  if (frame && saidFor && saidFor !== shownState()) say('');
  const notes = [...new Set([...(app.grid?.notes || []), ...(frame?.notes || [])])], list = id('notes-list');
  if (notes.join('\n') === [...list.children].map((one) => one.textContent).join('\n')) return;
  id('notes').hidden = notes.length === 0;
  id('notes-title').textContent = notes.length === 1 ? '1 note' : `${notes.length} notes`;
  list.replaceChildren(...notes.map((note) => {
    const item = document.createElement('li');
    item.textContent = note;
    return item;
  }));
}
