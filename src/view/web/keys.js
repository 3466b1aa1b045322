// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Keys that work anywhere but in texts; those of one character can be switched off (WCAG 2.1.4).
import {app, id} from './app.js';
import {toggleBeside} from './beside.js';
import {valuePlayer} from './level.js';
import {lookFrom, toggleFullScreen, togglePanel} from './looking.js';
import {closePicked, pickAt} from './picked.js';
import {pin} from './surfaces.js';

id('help-open').addEventListener('click', () => id('help').showModal());
id('help-close').addEventListener('click', () => id('help').close());

const charactersKey = 'isotet-keys';
try {
    id('character-keys').checked = localStorage.getItem(charactersKey) !== 'off';
} catch { /* they are on */
}
id('character-keys').addEventListener('change', () => {
    try {
        localStorage.setItem(charactersKey, id('character-keys').checked ? 'on' : 'off');
    } catch { /* kept until the page goes */
    }
});

const keys = {
  f: () => lookFrom('fit'), Home: () => lookFrom('fit'), 1: () => lookFrom('front'), 3: () => lookFrom('right'), 7: () => lookFrom('top'),
  s: () => app.save.open(), v: () => pickAt(0, 0), ' ': () => app.time.toggle(), ',': () => { app.time.stop(); app.time.on.go((app.state.step ?? 0) - 1); }, '.': () => { app.time.stop(); app.time.on.go((app.state.step ?? 0) + 1); },
  Escape: closePicked, 9: () => lookFrom('oblique'), 5: () => id('parallel').click(), e: () => id('edges').click(), b: () => id('outline').click(), p: pin,
  '[': () => app.slider.step(-1), ']': () => app.slider.step(1), '{': () => app.slider.step(-0.1), '}': () => app.slider.step(0.1), '?': () => id('help').showModal(),
  i: () => valuePlayer.toggle(), u: toggleFullScreen, h: togglePanel, l: () => id('labels-on').click(), 2: toggleBeside,
};
addEventListener('keydown', (event) => {
  const typing = event.target.matches('input[type=text], select') || id('help').open || id('save').open || (event.key === ' ' && event.target.matches('button, input, summary'));
  if (event.key.length === 1 && event.key !== ' ' && !id('character-keys').checked) return;
  if (event.key === 'Home' && event.target.matches('input[type=range]')) return; // its start
  const action = keys[event.key] || keys[event.key.toLowerCase()];
  if (typing || event.ctrlKey || event.altKey || event.metaKey || !action) return;
  event.preventDefault();
  action();
});
