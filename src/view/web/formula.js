// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A field that is computed from others: what --field takes, typed.
import {app, id} from './app.js';
import {chooseField} from './level.js';
import {say} from './notes.js';

const formula = {asked: '', before: ''};

/** The lists of fields have it, too; a page of saved surfaces has the colours that it has. */
export function offerField(name) {
  for (const list of app.grid?.colors ? [id('field')] : [id('field'), id('color-by')])
    if (name && ![...list.options].some(({value}) => value === name)) list.add(new Option(name, name));
}

/** The field that was asked for cannot be computed: what was shown comes back. False: another one is shown. */
export function refuseFormula(sentence) {
  if (!formula.asked || app.state.field !== formula.asked) return false;
  for (const list of [id('field'), id('color-by')]) [...list.options].find(({value}) => value === formula.asked)?.remove();
  id('field').value = formula.before;
  chooseField(formula.before);
  formula.asked = '';
  id('formula').setAttribute('aria-invalid', true);
  say(sentence);
  return true;
}

id('formula').addEventListener('keydown', (event) => {
  const text = id('formula').value.trim();
  if (event.key !== 'Enter' || !text || text === app.state.field) return;
  id('formula').removeAttribute('aria-invalid');
  say('');
  const isNew = ![...id('field').options].some(({value}) => value === text);
  Object.assign(formula, {asked: isNew ? text : '', before: app.state.field});
  offerField(text);
  id('field').value = text;
  chooseField(text);
});
