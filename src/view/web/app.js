// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What all parts of the page share: the state, and what the server has said.
import {Camera} from './draw/camera.js';
import {fromAddress} from './state.js';

export const id = (name) => document.getElementById(name);
export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();

/** Of two files that isotet view has been given, this page shows the second. */
export const isSecond = new URLSearchParams(location.search).has('second');

const [token, ...rest] = location.hash.slice(1).split('&');

export const app = {
  token, state: fromAddress(rest.join('&')), camera: new Camera(),
  grid: null, maps: null, frame: null, // as the server sent them
  made: null,                          // what the last frame took that brought a surface
  scene: null,                         // null: the server draws
  link: null, slider: null, cuts: null, time: null, save: null,
  number: 0, sent: null, sentAt: new Map(), // wishes: the last number, what it asked for, and when each went
  large: 0,                                 // triangles, where they are too many for the browser
  picked: null,
  other: '', // the name of the file that is shown beside it
  changed() {}, // called where something else is to be seen
};

export const aspect = () => id('scene').clientWidth / Math.max(1, id('scene').clientHeight);

/** A field of the grid, or what may be computed from fields. */
export const mayBeField = (name) =>
    app.grid.fields.some((one) => one.name === name) || /[-()+*/^<>=!&|`]|^[xyz]$/.test(name);
