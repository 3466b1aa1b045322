// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sentences over the picture.
import {app, id} from './app.js';

let saidAfter = 0;

function showMessage(sentence) {
  id('message').textContent = sentence;
  id('message').hidden = !sentence;
}

/** Says it until a frame comes that was asked for after number `after`: one still on its way must not wipe it out. */
export function say(sentence, after = app.number) {
  saidAfter = sentence ? after : 0;
  showMessage(sentence);
}

export function showNotes(next) {
  if (next.number > saidAfter) say(next.notes.join(' '), 0);
}
