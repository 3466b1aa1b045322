// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet.js by several threads in Node: node threads_test.mjs FOLDER PROGRAM. Surfaces are the bytes of those by one; what fails in a
// thread ends in an error. Each broken surrounding is a process of its own, which must not hang.
import {spawnSync} from 'node:child_process';
import {cpSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';
import {bytesOf, check, data, folder, median, run} from './support.mjs';

const [npm, program, broken] = process.argv.slice(2), load = (path) => import(resolve(path, 'isotet.js'));
const {gyroidGrid} = await import('../../examples/javascript/gyroid.js');

function same(a, b, what) {
  for (const name of ['positions', 'triangles', 'normals']) check(a[name] === null ? b[name] === null : bytesOf(a[name]).equals(bytesOf(b[name])), `${what}: other ${name}`);
  for (const [name, values] of Object.entries(a.fields)) check(bytesOf(values).equals(bytesOf(b.fields[name])), `${what}: other ${name}`);
}

/** Packed files: extraction alone. */
async function testFiles({open}) {
  const packed = join(folder, 'packed.isotet'), times = {};
  for (const [grid, field, ...options] of [[data('vtu/artery_flow_tet_wedge.vtu'), 'Umag'], [data('vtu/mfem_levels_hex.vtu'), 'distance'], ['make:kuhn:40:gyroid', 'gyroid'],
    ['make:kuhn:40:gyroid', 'gyroid', '--precision', 'double'], [data('vtk/tetra_mixed_orientation_int.vtk'), 'scalars']]) {
    run(program, 'pack', grid, packed, '--fields', field, ...options);
    const one = await open(readFileSync(packed)), [lower, upper] = one.range({field});
    check(one.threads === 1, 'one thread unless more are asked for');
    for (const threads of [2, 4, 7]) {
      const several = await open(readFileSync(packed), {threads});
      check(several.threads === threads, `${several.threads} threads, not ${threads}`);
      for (let i = 1; i < 20; ++i) {
        const value = lower + i / 20 * (upper - lower), options = {field, normals: i % 2 ? 'vertex' : 'none'}, start = performance.now();
        const surface = several.contour(value, options);
        (times[threads] ??= []).push(performance.now() - start);
        same(surface, one.contour(value, options), `${grid} at ${value} by ${threads}`);
      }
      several.close();
    }
    one.close();
  }
  return times;
}

/** Arrays: packed by all threads, or extracted from as they are. */
async function testArrays({fromArrays}) {
  const {points, cells, values} = gyroidGrid(48), wide = {points: Float64Array.from(points), cells, values: {x: points.filter((_, i) => i % 3 === 0), ...values}};
  const types = {connectivity: cells, offsets: Uint32Array.from({length: cells.length / 4 + 1}, (_, i) => 4 * i), types: new Uint8Array(cells.length / 4).fill(10)};
  for (const grid of [{points, cells, values}, wide, {points, cells: types, values}]) {
    const carried = Object.keys(grid.values);
    for (const threads of [2, 4]) {
      const one = await fromArrays(grid), several = await fromArrays(grid, {threads});
      for (const options of [{once: true}, {once: true, normals: 'vertex', fields: carried}, {}, {normals: 'vertex', fields: carried}])
        for (const value of [-0.4, 0, 0.7]) {
          const given = {field: 'gyroid', ...options};
          const [a, b] = [several.contour(value, given), one.contour(value, given)];
          check(a.triangles.length > 0 && a.method === b.method && a.method === (options.once ? 'direct' : 'clusters'), `arrays at ${value} by ${threads}: ${a.method}`);
          same(a, b, `arrays at ${value} by ${threads} with ${JSON.stringify(options)}`);
        }
      several.close();
      one.close();
    }
  }
  let refused = '';
  await fromArrays({points, cells: new Int32Array([0, 1, 2, 1e7]), values}, {threads: 2}).catch((error) => { refused = error.message; });
  check(refused.includes('10000000'), `"${refused}" names the point that is not there`);
}

/** Grows while threads take memory, and views are of what it is then. */
async function testGrowth({fromArrays}) {
  const grid = gyroidGrid(64), one = await fromArrays(grid), several = await fromArrays(grid, {threads: 4});
  for (const value of [0, 0.5]) same(several.contour(value, {normals: 'vertex'}), one.contour(value, {normals: 'vertex'}), `a larger grid at ${value}`);
  check(several.memory.buffer.byteLength > 64 << 20, 'the memory grew');
}

const surroundings = {
  /** The first worker's stack ends where memory begins: it traps as soon as work needs some. */
  async trap({fromArrays}) {
    const grid = gyroidGrid(24), failing = await fromArrays(grid, {threads: 4});
    let message = '';
    for (let i = 0; message === '' && i < 50; ++i) {
      try {
        failing.contour(i / 100);
      } catch (error) {
        message = error.message;
      }
    }
    check(message.includes('a thread of isotet stopped'), `the call fails: "${message}"`);
    check(failing.threads === 1, 'its threads have ended');
    try {
      failing.contour(0);
    } catch (error) {
      message = error.message;
    }
    check(message.includes('closed'), `the grid is closed: "${message}"`);
    const after = await fromArrays(grid, {threads: 4});
    check(after.threads === 1 && after.contour(0).triangles.length > 0, `grids have ${after.threads} threads afterwards`);
  },
  /** Shared memory is refused, as by browsers of 32 bits. */
  async memory({fromArrays}) {
    const {Memory} = WebAssembly;
    WebAssembly.Memory = function (options) {
      if (options.shared) throw new RangeError('no memory');
      return new Memory(options);
    };
    const grid = await fromArrays(gyroidGrid(8), {threads: 4});
    check(grid.threads === 1 && grid.contour(0).triangles.length > 0, `without shared memory there are ${grid.threads} threads`);
  },
  /** Some workers cannot begin. */
  async missing({fromArrays}) {
    const grid = await fromArrays(gyroidGrid(24), {threads: 4});
    check(grid.threads === 3 && grid.contour(0).triangles.length > 0, `there are ${grid.threads} threads, where one of four cannot begin`);
  },
  /** The module for threads was not copied with the others. */
  async module({fromArrays}) {
    const grid = await fromArrays(gyroidGrid(8), {threads: 4});
    check(grid.threads === 1 && grid.contour(0).triangles.length > 0, `without the module there are ${grid.threads} threads`);
  },
};

surroundings.lost = surroundings.trap; // and the worker cannot even say so: the call fails after half a minute

/** A copy of the package whose threads are another file: [[from, to], ...]. */
function changed(name, ...changes) {
  const copy = join(folder, name), path = join(copy, 'isotet_thread.js');
  cpSync(npm, copy, {recursive: true});
  let text = readFileSync(path, 'utf8');
  for (const [from, to] of changes) {
    check(text.includes(from), `isotet_thread.js has "${from}"`);
    text = text.replace(from, to);
  }
  writeFileSync(path, text);
  return copy;
}

if (broken) {
  await surroundings[broken](await load(npm));
  process.exit();
}

const isotet = await load(npm), times = await testFiles(isotet);
await testArrays(isotet);
await testGrowth(isotet);
console.log(`ok same bytes; ${Object.entries(times).map(([threads, all]) => `${median(all).toFixed(1)} ms by ${threads}`).join(', ')}`);
const small = ['__stack_pointer.value = stack', '__stack_pointer.value = number === 1 ? 2048 : stack'];
const copies = {
  trap: changed('trap', small),
  lost: changed('lost', small, ['exports.worker_failed();', '']),
  memory: npm,
  missing: changed('missing', ['  exports.__wasm_init_tls', "  if (number === 2) throw new Error('not this one');\n  exports.__wasm_init_tls"]),
  module: changed('module'),
};
rmSync(join(copies.module, 'isotet_engine_threads.wasm'));
for (const [name, copy] of Object.entries(copies)) {
  const ran = spawnSync(process.execPath, [fileURLToPath(import.meta.url), copy, program, name], {encoding: 'utf8', timeout: 120000});
  check(ran.status === 0, `${name}: ${ran.signal ?? ''} ${ran.stderr}`);
  console.log(`ok ${name}`);
}
const compressed = gzipSync(readFileSync(join(npm, 'isotet_engine_threads.wasm')), {level: 9}).length;
check(compressed < 700000, `isotet_engine_threads.wasm has ${compressed} bytes compressed, and may have 700,000`);
console.log(`ok isotet_engine_threads.wasm: ${compressed} bytes compressed`);
