// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Command lines: copied, and pasted.
import {app, id} from './app.js';
import {frameAll} from './draw/framing.js';
import {say} from './notes.js';
import {takeHidden} from './regions.js';
import {fromMessage, toMessage} from './state.js';
import {commit} from './undo.js';

/** `show` puts a new state on the screen. */
export const commands = {show() {}};

let copying = null;
for (const kind of ['render', 'extract'])
  id('copy-' + kind).addEventListener('click', () => {
    copying = kind;
    app.link.send({do: 'command', state: wholeState()});
  });

export async function takeCommand(message) {
  if (copying === null) return app.save.takeCommand(message);
  const kind = copying, text = message[kind === 'extract' && id('copy-steps').checked ? 'extract_all' : kind] || '';
  copying = null;
  let copied = true;
  try { await navigator.clipboard.writeText(text); } catch { copied = false; }
  const own = kind === 'render' && [app.state, ...app.state.pins].some((one) => one.color || (one.opacity !== null && one.opacity !== app.state.opacity));
  id('copied').textContent = text;
  id('copied').title = copied ? 'Copied' : 'The browser did not copy: select it';
  id('copy-' + kind).textContent = copied ? 'Copied' : 'See below';
  if (own) say('Not part of isotet render: colours and opacities of single surfaces.');
  setTimeout(() => { id('copy-render').textContent = 'Copy render'; id('copy-extract').textContent = 'Copy extract'; }, 1500);
}

id('command').addEventListener('keydown', (event) => {
  if (event.key !== 'Enter' || id('command').value.trim() === '') return;
  app.link.send({do: 'paste', text: id('command').value});
});

/** What of a pasted command line was not taken. */
function leftOut({left_out, other_file}) {
  const parts = [];
  if (other_file) parts.push(`The command is for ${other_file}; it is shown for this file.`);
  if (left_out.length > 0) parts.push(`Not taken, as the page does not have it: ${left_out.join(', ')}`);
  return parts.join(' ');
}

/** All is seen from there, and enlarged. */
function lookAsTold({direction, up, parallel, zoom}) {
  app.camera.setProjection(parallel ? 'parallel' : 'perspective');
  Object.assign(app.camera, {direction, up});
  frameAll();
  app.camera.zoom(app.camera.target, zoom);
  app.state.camera = app.camera.text();
}

export function takeState(message) {
  const next = fromMessage(message.state);
  if (!next.field) next.field = app.state.field;
  if (next.value === null && next.field === app.state.field) next.value = app.state.value;
  if (next.step === null) next.step = app.state.step;
  next.stretch ??= app.grid.state.stretch ?? null; // as isotet render without --scale
  if (next.planes.some(({kind}) => kind === 'slice') && !next.isosurfaces) next.colorBy ||= next.field;
  takeHidden(next);
  app.state = {...next, drawn: app.state.drawn, up: message.look?.axis ?? app.state.up};
  if (message.look) lookAsTold(message.look);
  else if (!app.state.camera) app.state.camera = app.camera.text();
  id('command').value = '';
  commit();
  commands.show();
  say(leftOut(message));
}

/** As a command line has it: each isovalue once, and axes as they are where isotet render would stretch them. */
export function wholeState() {
  app.state.camera = app.camera.text();
  const message = toMessage(app.state);
  message.isovalues = [...new Set(message.isovalues)];
  if (app.grid.state.stretch) message.stretch ??= [1, 1, 1];
  return message;
}
