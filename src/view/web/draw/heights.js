// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The axis that points upwards, and heights exaggerated. The camera sees stretched places; all else has places of the grid.
import {app, id} from '../app.js';
import {parseNumber, short} from '../format.js';
import {say} from '../notes.js';
import {factorsOf} from '../state.js';

export const stretched = (place) => place.map((v, i) => v * factorsOf(app.state)[i]);
export const unstretched = (place) => place.map((v, i) => v / factorsOf(app.state)[i]);

/** The box of the grid as it is seen: [lower, upper]. */
export const seenBox = () => [stretched(app.grid.lower), stretched(app.grid.upper)];

const upwards = () => 'xyz'.indexOf(app.state.up.slice(-1));
const mostHeights = 100; // of the slider: the text takes more

export function showHeights() {
  const factor = factorsOf(app.state)[upwards()];
  app.camera.setUp(app.state.up);
  id('up').value = app.state.up;
  id('heights').value = Math.log10(Math.max(1, Math.min(mostHeights, factor)));
  id('heights').setAttribute('aria-valuetext', `${short(factor)} times`);
  if (document.activeElement !== id('heights-text')) id('heights-text').value = short(factor);
  id('heights-text').removeAttribute('aria-invalid');
}

/** What is in the middle of the picture stays there. */
function setStretch(stretch) {
  const size = ([lower, upper]) => Math.hypot(...upper.map((u, i) => u - lower[i])) || 1, before = size(seenBox()), middle = unstretched(app.camera.target);
  app.state.stretch = stretch;
  const factor = size(seenBox()) / before;
  app.camera.target = stretched(middle);
  app.camera.distance *= factor;
  app.camera.height *= factor;
  showHeights();
}

/**
 * @param changed  by the user: is to be shown
 * @param look     from where the new axis is seen
 */
export function setUpHeights(changed, look) {
  const take = (factor) => {
    if (!app.grid?.lower) return;
    setStretch(factorsOf(app.state).map((old, i) => (i === upwards() ? factor : old)));
    changed();
  };
  id('heights').addEventListener('input', () => take(Number((10 ** Number(id('heights').value)).toPrecision(2))));
  id('heights-text').addEventListener('change', () => {
    const factor = parseNumber(id('heights-text').value);
    id('heights-text').setAttribute('aria-invalid', !(factor > 0));
    if (!(factor > 0)) return say('Heights are multiplied by a number above 0, such as 5.');
    say('');
    take(factor);
  });
  id('up').addEventListener('change', () => {
    if (!app.grid?.lower) return;
    const factor = factorsOf(app.state)[upwards()];
    app.state.up = id('up').value;
    setStretch([1, 1, 1].map((one, i) => (i === upwards() ? factor : one)));
    look();
  });
}
