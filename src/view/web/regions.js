// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Regions, blocks and other classes that colour, by name: each can be hidden. The browser leaves out what has their colour at
// once; the server leaves out their cells.
import {app, id} from './app.js';
import {followStep} from './level.js';
import {say} from './notes.js';
import {forgetPartNumbers} from './parts.js';
import {closePicked} from './picked.js';
import {drawSoon} from './picture.js';
import {commit} from './undo.js';
import {wishSoon} from './wishes.js';

const classes = () => app.frame?.scale?.classes ?? [];

/** {count, mask}: of the classes of the colours, and which of them are hidden, as bits. */
export const hiddenClasses = () => ({count: classes().length, mask: classes().reduce((mask, {name}, i) => mask | (app.state.hidden.includes(name) ? 1 << i : 0), 0)});

/** Rows stay where their number is the same: a control keeps its focus. */
export function showRegions() {
  const list = id('regions-list'), all = classes();
  id('regions').hidden = all.length < 2;
  while (list.children.length > all.length) list.lastChild.remove();
  all.forEach(({name, color}, i) => {
    const row = list.children[i] || list.appendChild(regionRow(i)), [box, swatch, text] = row.firstChild.children;
    box.checked = !app.state.hidden.includes(name);
    swatch.style.background = color;
    text.textContent = name;
    row.lastChild.setAttribute('aria-label', `Show only ${name}`);
  });
  document.body.dataset.hidden = app.state.hidden.join(' ');
  id('cells').hidden = app.state.cells.length === 0;
  id('cells-text').textContent = app.state.cells.join(' and ');
}

function regionRow(i) {
  const row = document.createElement('li');
  row.innerHTML = '<label class="check"><input type="checkbox"><span class="swatch" aria-hidden="true"></span><span></span></label><button type="button" title="Show this one alone">Only</button>';
  const name = () => classes()[i].name;
  row.querySelector('input').addEventListener('change', (event) => hide(event.target.checked ? app.state.hidden.filter((one) => one !== name()) : [...app.state.hidden, name()]));
  row.querySelector('button').addEventListener('click', () => hide(classes().map((one) => one.name).filter((one) => one !== name())));
  return row;
}

function chosen() {
  say('');
  forgetPartNumbers();
  closePicked();
  showRegions();
  followStep();
  wishSoon();
  drawSoon();
  commit();
}

function hide(names) {
  app.state.hidden = names;
  chosen();
}

/** Names of a list, which may have commas where they are known. */
function namesIn(list) {
  const names = [], known = classes().map(({name}) => name).sort((a, b) => b.length - a.length);
  for (let rest = list; rest !== '';) {
    const name = known.find((one) => `${rest},`.startsWith(`${one},`)) ?? rest.split(',')[0];
    names.push(name);
    rest = rest.slice(name.length + 1);
  }
  return names;
}

/** Of choices that a command line has, classes of the colours that are left out are hidden ones. */
export function takeHidden(state) {
  const head = `!${state.colorBy}=`, own = state.colorBy ? state.cells.filter((one) => one.startsWith(head)) : [];
  if (own.length === 0) return;
  state.hidden = own.flatMap((one) => namesIn(one.slice(head.length)));
  state.cells = state.cells.filter((one) => !own.includes(one));
}

id('regions-all').addEventListener('click', () => hide([]));
id('cells-all').addEventListener('click', () => { app.state.cells = []; chosen(); });
