// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Undo: the address holds the state.
import {app, mayBeField} from './app.js';
import {fromAddress, toAddress} from './state.js';

let commitTimer = 0, nameTimer = 0;
/** A page in a notebook's frame has no address. */
const hasAddress = location.protocol !== 'about:';
const address = () => `#${app.token}&${toAddress(app.state)}`;

export function commit() {
  clearTimeout(commitTimer);
  commitTimer = 0;
  app.state.camera = app.grid ? app.camera.text() : app.state.camera;
  if (hasAddress && location.hash !== address()) history.pushState(null, '', address());
}

/** The address as it is now becomes that of the state. */
export const nameState = () => { if (hasAddress) history.replaceState(null, '', address()); };

export function commitSoon() {
  clearTimeout(commitTimer);
  commitTimer = setTimeout(commit, 500);
}

/** A change that another page made is no state to come back to: it is named only. */
export function follow(change) {
  if (commitTimer) commit();
  change();
  clearTimeout(commitTimer);
  commitTimer = 0;
  clearTimeout(nameTimer);
  nameTimer = setTimeout(() => {
    app.state.camera = app.camera.text();
    nameState();
  }, 500);
}

/** The browser's back and forward; `show` puts the state on the screen. */
export function onReturn(show) {
  addEventListener('popstate', () => {
    clearTimeout(commitTimer);
    clearTimeout(nameTimer);
    const [sameToken, ...parts] = location.hash.slice(1).split('&');
    if (sameToken !== app.token) return location.reload();
    app.state = fromAddress(parts.join('&'));
    if (!app.grid || !mayBeField(app.state.field)) app.state.field = app.grid?.state.field || app.state.field;
    show();
  });
}
