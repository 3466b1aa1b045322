// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What makes the surfaces of a page that has isotet in it, and a report of that for who asks.
import {app, id} from '../app.js';

let told = null, version = '';

export function rememberVersion(welcome) { version = welcome.version ?? ''; }

/** @param message  {info: of the graphics card, or null; why: there is none} */
export function takeCard(message) {
  told = message;
  const {info, why} = message;
  id('device-told').textContent = info ? `The graphics card makes isosurfaces (WebGPU: ${[info.vendor, info.architecture].filter(Boolean).join(' ')}); the processor does all else.` :
    `The processor makes isosurfaces: ${why}.`;
  id('device').hidden = false;
  document.body.dataset.card = info ? 'webgpu' : 'none';
}

id('report').addEventListener('click', () => {
  id('reported').textContent = 'Measuring …';
  app.link.send({do: 'measure'});
});

/** Times of both engines, as JSON that may be posted: no names of files and fields are in it. */
export async function takeMeasured({surfaces}) {
  const {points, cells} = app.grid, {extract_ms, mesh_ms} = app.made ?? {};
  const report = {isotet: version, browser: navigator.userAgent, processors: navigator.hardwareConcurrency, webgpu: told.info, why: told.why || undefined, points, cells, surfaces, shown: {extract_ms, mesh_ms}};
  const text = JSON.stringify(report, null, 1);
  try {
    await navigator.clipboard.writeText(text);
    id('reported').textContent = 'Copied.';
  } catch {
    id('reported').textContent = `The browser did not copy: ${text}`;
  }
  document.body.dataset.report = text;
}
