// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Regions, blocks and other classes that colour, by name: each can be hidden. The browser leaves out what has their colour.
import {app, id} from './app.js';
import {say} from './notes.js';
import {drawSoon} from './picture.js';
import {commit} from './undo.js';
import {serverDraws} from './wishes.js';

const classes = () => app.frame?.scale?.classes ?? [];

/** {count, mask}: of the classes of the colours, and which of them are hidden, as bits. */
export const hiddenClasses = () => ({count: classes().length, mask: classes().reduce((mask, {name}, i) => mask | (app.state.hidden.includes(name) ? 1 << i : 0), 0)});

/** Rows stay where their number is the same: a control keeps its focus. */
export function showRegions() {
  const list = id('regions-list'), all = serverDraws() ? [] : classes();
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
}

function regionRow(i) {
  const row = document.createElement('li');
  row.innerHTML = '<label class="check"><input type="checkbox"><span class="swatch" aria-hidden="true"></span><span></span></label><button type="button" title="Show this one alone">Only</button>';
  const name = () => classes()[i].name;
  row.querySelector('input').addEventListener('change', (event) => hide(event.target.checked ? app.state.hidden.filter((one) => one !== name()) : [...app.state.hidden, name()]));
  row.querySelector('button').addEventListener('click', () => hide(classes().map((one) => one.name).filter((one) => one !== name())));
  return row;
}

function hide(names) {
  app.state.hidden = names;
  say('');
  showRegions();
  drawSoon();
  commit();
}

id('regions-all').addEventListener('click', () => hide([]));
