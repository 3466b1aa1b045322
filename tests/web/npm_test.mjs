// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet.js in Node: node npm_test.mjs FOLDER PROGRAM. Surfaces of files of all kinds of cells are the bytes of the program's.
import {readFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {gzipSync} from 'node:zlib';
import {bytesOf, check, data, folder, median, readPly, run} from './support.mjs';

const [npm, program] = process.argv.slice(2);
const {fromArrays, open, useModule} = await import(resolve(npm, 'isotet.js'));

async function fails(work, words) {
  try {
    await work();
  } catch (error) {
    check(error.message.includes(words), `"${error.message}" has not "${words}"`);
    return;
  }
  throw new Error(`this must fail: ${words}`);
}

async function compare(path, field) {
  const grid = await open(readFileSync(path), {name: path}), told = run(program, 'info', path), ply = join(folder, 'surface.ply');
  check(grid.points === told.points && grid.cells === told.cells, `${path}: ${grid.points} points, ${grid.cells} cells`);
  const [lower, upper] = grid.range({field});
  let triangles = 0;
  for (const part of [0.2, 0.5, 0.81]) {
    const value = lower + part * (upper - lower);
    run(program, 'extract', path, ply, '-f', field, '-i', String(value), '--with', '', '--method', 'clusters', '--tolerance', 'nodes');
    const native = readPly(ply), surface = grid.contour(value, {field});
    check(bytesOf(surface.positions).equals(native.positions), `${path} at ${value}: other positions`);
    check(bytesOf(surface.triangles).equals(native.corners), `${path} at ${value}: other triangles`);
    triangles += surface.triangles.length / 3;
  }
  check(triangles > 0, `${path}: there are triangles`);
  console.log(`ok ${path.split('/data/')[1]} ${field}: ${triangles} triangles`);
  grid.close();
}

for (const [path, field] of [['vtu/artery_flow_tet_wedge.vtu', 'Umag'], ['vtu/mfem_levels_hex.vtu', 'distance'], ['vtu/mfem_levels_wedge.vtu', 'distance'],
  ['vtu/polyhedron_two_pieces.vtu', 'x'], ['vtu/quadratic_tets_96.vtu', 'Polynomial'], ['vtu/dealii_refined_ball.vtu', 'radius'], ['vtu/all_dims_tets_lzma.vtu', 'x'],
  ['vtk/ugridex_all_kinds.vtk', 'scalars'], ['vtk/tetra_mixed_orientation_int.vtk', 'scalars'], ['msh/table_v22_binary_elementdata.msh', 'z'],
  ['medit/cube_sphere_26k.meshb', 'x'], ['avs_ucd/tet_attributes.inp', 'itp1']]) await compare(data(path), field);

// The README's two tetrahedra.
const points = new Float64Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1]), cells = new Int32Array([0, 1, 2, 3, 1, 2, 3, 4]);
const temperature = new Float32Array([10, 20, 30, 40, 80]), grid = await fromArrays({points, cells, values: {temperature}});
const {positions, triangles, normals, fields} = grid.contour(25, {normals: 'vertex', fields: ['temperature', 'x']});
check(positions.length === 3 * 5 && triangles.length === 9 && normals.length === positions.length, `${positions.length / 3} vertices, ${triangles.length / 3} triangles`);
check(fields.temperature.every((value) => Math.abs(value - 25) < 1e-5), 'the field is the isovalue on its surface');
check(fields.x.every((x, i) => Math.abs(x - positions[3 * i]) < 1e-6), 'coordinates are carried');
check(String(grid.range()) === '10,80', 'the range of the values');
const mixed = await fromArrays({points, cells: {connectivity: cells, offsets: new Int32Array([0, 4, 8]), types: new Uint8Array([10, 10])}, values: temperature});
check(bytesOf(mixed.contour(25).triangles).equals(bytesOf(grid.contour(25).triangles)), 'cells with types are the same');
check(grid.contour(1000).triangles.length === 0, 'outside of the range is nothing');

await fails(() => grid.contour(NaN), 'finite');
await fails(() => grid.contour(1, {field: 'pressure'}), 'pressure');
await fails(() => fromArrays({points, cells: new Int32Array([0, 1, 2, 9]), values: temperature}), '9');
await fails(() => fromArrays({points: [0, 1], cells, values: temperature}), 'points');
await fails(async () => (await fromArrays({points, cells, values: new Float32Array(3)})).contour(1), '3');
await fails(() => open(new Uint8Array(100)), 'format');
await fails(() => open(readFileSync(data('vtu/artery_flow_tet_wedge.vtu')).subarray(0, 90000)), 'cut short');
grid.close();
await fails(() => grid.contour(25), 'closed');

// A packed file, and that it is not slower with time.
run(program, 'pack', 'make:kuhn:40:gyroid,sphere', join(folder, 'packed.isotet'));
const packed = await open(readFileSync(join(folder, 'packed.isotet'))), times = [];
for (let i = 0; i < 21; ++i) {
  const start = performance.now();
  packed.contour(-0.5 + i / 20, {field: 'gyroid'});
  times.push(performance.now() - start);
}
check(packed.fields.map(({name}) => name).join() === 'gyroid,sphere', 'fields of a packed file');
const carried = packed.contour(0.1, {field: 'gyroid', fields: ['sphere', 'gyroid']}).fields;
check(carried.sphere.some((value) => value > 0.5) && carried.gyroid.every((value) => Math.abs(value - 0.1) < 1e-5), 'a packed file carries its fields');
run(program, 'pack', 'make:kuhn:12:gyroid', join(folder, 'double.isotet'), '--precision', 'double');
const wide = (await open(readFileSync(join(folder, 'double.isotet')))).contour(0.25, {normals: 'vertex'});
run(program, 'extract', 'make:kuhn:12:gyroid', join(folder, 'double.ply'), '-f', 'gyroid', '-i', '0.25', '--with', '', '--method', 'clusters', '--precision', 'double');
check(wide.triangles.length > 0 && bytesOf(wide.triangles).equals(readPly(join(folder, 'double.ply')).corners), 'a packed file in double precision');
console.log(`ok arrays, errors, packed: ${median(times).toFixed(1)} ms a surface`);

// The module that pages load for arrays and packed files; it alone says so of other files.
const small = readFileSync(join(npm, 'isotet_engine.wasm')), compressed = gzipSync(small, {level: 9}).length;
check(compressed < 700000, `isotet_engine.wasm has ${compressed} bytes compressed, and may have 700,000`);
await useModule(small);
await fails(() => open(readFileSync(data('vtk/ugridex_all_kinds.vtk')), {name: 'a.vtk'}), 'isotet_engine_readers.wasm');
console.log(`ok isotet_engine.wasm: ${compressed} bytes compressed`);
