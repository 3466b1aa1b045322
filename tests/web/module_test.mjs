// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly against the program: node module_test.mjs MODULE PROGRAM. Surfaces of packed grids of all kinds of cells are
// the same bytes, and messages of a page are answered.
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {check, data, folder, median, pageModule, readPly, run} from './support.mjs';

const [module, program] = process.argv.slice(2);
const {startEngine} = await pageModule('link/engine_worker.js');
const engine = readFileSync(module), isotet = (...words) => run(program, ...words);

const none = {state: {field: '', isovalues: []}};

async function open(path, told = none) {
  const said = [];
  const isotet = await startEngine({engine, grid: new Uint8Array(readFileSync(path)), told}, (message) => said.push(message));
  return {isotet, said};
}

/** The same bytes at five isovalues. */
async function compare(name) {
  const packed = join(folder, 'grid.isotet'), ply = join(folder, 'surface.ply');
  isotet('pack', name, packed);
  const [{name: field, range: [lower, upper]}] = isotet('info', packed).fields;
  const {isotet: module, said} = await open(packed, {file: name, version: '1', state: {field, isovalues: [(lower + upper) / 2]}});
  check(said[0].text.say === 'welcome', `${name}: ${JSON.stringify(said[0])}`);
  check(said[1].text.say === 'grid' && said[1].text.fields.some((one) => one.name === field), 'the grid tells its fields');
  let triangles = 0;
  const times = [];
  for (const part of [0, 0.21, 0.5, 0.77, 1]) {
    const value = lower + part * (upper - lower);
    isotet('extract', packed, ply, '-f', field, '-i', String(value), '--with', '');
    const native = readPly(ply);
    said.length = 0;
    const start = performance.now();
    module.extract(field, value);
    times.push(performance.now() - start);
    check(said.length === 1 && said[0].positions, `${name} at ${value}: ${JSON.stringify(said[0]?.text)}`);
    check(Buffer.from(said[0].positions).equals(native.positions), `${name} at ${value}: other positions`);
    check(Buffer.from(said[0].triangles).equals(native.corners), `${name} at ${value}: other triangles`);
    triangles += native.corners.length / 12;
    said.length = 0;
    module.answer({do: 'show', number: 1, state: {field, isovalues: [value]}, moving: false});
    check(said[0].frame && said.length === 1, `${name} at ${value}: a frame comes: ${JSON.stringify(said[0]?.text)}`);
  }
  check(triangles > 0, `${name}: there are triangles`);
  console.log(`ok ${name} ${field}: ${triangles} triangles, ${median(times).toFixed(1)} ms each`);
}

for (const name of ['make:kuhn:12:sphere', 'make:mixed:8:sphere', 'make:wedge:8:gyroid', 'make:pyramid:8:gyroid', 'make:hex:12:integer',
  'make:tet10:6:sphere', 'make:kelvin:5:sphere', 'make:octree:8:sphere', 'make:hex27:4:sphere', data('vtu/artery_flow_tet_wedge.vtu')]) await compare(name);
for (const bytes of [new Uint8Array(0), new Uint8Array(5000), readFileSync(join(folder, 'grid.isotet')).subarray(0, 5000)]) {
  const said = [];
  await startEngine({engine, grid: new Uint8Array(bytes), told: none}, (message) => said.push(message));
  check(said[0].text.say === 'error', 'a file that is none is a sentence');
}
console.log('ok broken files');
