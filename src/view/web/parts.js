// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The connected parts of the slider's surface or solid, largest first: each can be left out.
import {app, id} from './app.js';
import * as format from './format.js';
import {say} from './notes.js';
import {closePicked} from './picked.js';
import {isKeptParts, toMessage} from './state.js';
import {commit} from './undo.js';
import {isAtRest, wishSoon} from './wishes.js';

const parted = {asked: '', table: null}; // what was asked last, and its answer

/** What the parts depend on. */
const partsQuestion = () => JSON.stringify([app.state.field, app.state.value, app.state.solid, app.state.step, app.state.keep, app.frame.field_bound != null]);

/** Once the surface is there in full. */
export function askParts() {
  if (!id('parts').open || app.state.value === null || !isAtRest() || parted.asked === partsQuestion()) return;
  const message = {do: 'parts', state: toMessage(app.state), refined: app.frame.field_bound != null};
  delete message.state.camera;
  if (app.link.send(message)) parted.asked = partsQuestion();
}

/** Another connection knows of no question. */
export const forgetParts = () => { parted.asked = ''; };

export function takeParts(message) {
  const {field, value, solid, step} = app.state;
  if (message.field !== field || message.isovalue !== value || message.solid !== solid || (step !== null && message.step !== step)) return;
  parted.table = message;
  document.body.dataset.parts = JSON.stringify(message);
  showParts();
}

/** Numbers of parts mean something for the surface that they were chosen for. */
export function forgetPartNumbers() {
  if (!/^(parts|not):/.test(app.state.keep)) return;
  app.state.keep = '';
  showParts();
}

export function showParts() {
  if (document.activeElement !== id('keep')) id('keep').value = app.state.keep;
  const {table} = parted, list = id('parts-rows'), rows = table?.parts ?? [];
  while (list.children.length > rows.length) list.lastChild.remove();
  rows.forEach((part, i) => fillPartRow(list.children[i] || list.appendChild(partRow(i)), part));
  id('parts-table').hidden = rows.length === 0;
  if (!table) return;
  const shown = table.kept === table.count ? '' : `, ${format.grouped(table.kept)} shown`;
  id('parts-told').textContent = table.count === 0 ? 'No surface' : `${format.grouped(table.count)} ${table.count === 1 ? 'part' : 'parts'}${shown}` +
    (table.count > rows.length ? `; the ${rows.length} largest are listed` : '');
}

function fillPartRow(row, {triangles, area, volume, kept}) {
  const [, count, size, inside] = row.children;
  row.querySelector('input').checked = kept;
  count.textContent = format.grouped(triangles);
  size.textContent = format.rounded(area, 4);
  inside.textContent = volume === null ? 'open' : format.rounded(volume, 4);
  row.classList.remove('picked');
}

/** Rows stay where their number is the same: a control keeps its focus. */
function partRow(i) {
  const row = document.createElement('tr');
  row.innerHTML = `<th scope="row"><label class="check"><input type="checkbox" aria-label="Show part ${i}"> ${i}</label></th><td></td><td></td><td></td>` +
    `<td><button type="button" title="Show this part alone" aria-label="Show part ${i} alone">Only</button></td>`;
  row.querySelector('input').addEventListener('change', () => togglePart(i));
  row.querySelector('button').addEventListener('click', () => chooseParts(`parts:${i}`));
  row.addEventListener('click', (event) => { if (!event.target.closest('label, button')) togglePart(i); });
  return row;
}

const joinedNumbers = (numbers, word) => (numbers.length > 0 ? `${word}:${numbers.sort((a, b) => a - b).join(',')}` : '');

/** Shows a part, or leaves it out. */
function togglePart(i) {
  const {keep} = app.state, {table} = parted, [word, list] = keep.split(':'), numbers = (list ?? '').split(',').filter(Boolean).map(Number);
  const other = numbers.includes(i) ? numbers.filter((one) => one !== i) : [...numbers, i];
  if (keep === '' || word === 'not') return chooseParts(joinedNumbers(other, 'not'));
  if (word === 'parts') return other.length > 0 ? chooseParts(joinedNumbers(other, 'parts')) : refusePart('One part stays.');
  const shown = table.parts.flatMap((part, k) => (part.kept !== (k === i) ? [k] : []));
  if (shown.length === 0) return refusePart('One part stays.');
  if (table.parts.filter((part) => part.kept).length < table.kept) return refusePart(`${keep} keeps parts that are not listed: choose fewer by it first.`);
  chooseParts(joinedNumbers(shown, 'parts'));
}

function refusePart(sentence) {
  say(sentence);
  showParts();
}

function chooseParts(keep) {
  app.state.keep = keep;
  say('');
  closePicked();
  showParts();
  wishSoon();
  commit();
}

/** A click on the surface tells its part. */
export function markPart(number) {
  [...id('parts-rows').children].forEach((row, i) => {
    row.classList.toggle('picked', i === number);
    if (i === number) row.scrollIntoView({block: 'nearest'});
  });
}

id('parts').addEventListener('toggle', askParts);
id('keep').addEventListener('keydown', (event) => {
  if (event.key === 'Escape') { id('keep').value = app.state.keep; id('keep').removeAttribute('aria-invalid'); }
  if (event.key !== 'Enter') return;
  const text = id('keep').value.trim().replace(/^all$/, '');
  const fits = text === '' || isKeptParts(text);
  id('keep').setAttribute('aria-invalid', !fits);
  if (fits) chooseParts(text);
  else say('Parts to keep: largest, a number of the largest, area>0.5, volume>0.01, touching:boundary, parts:0,2 or not:1.');
});
id('keep-all').addEventListener('click', () => chooseParts(''));
