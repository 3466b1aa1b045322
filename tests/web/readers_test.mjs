// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet's readers as WebAssembly, as the page without a grid has them: node readers_test.mjs MODULE PROGRAM. Grids of all formats
// are read and shown with the triangles that the program extracts; broken files are sentences.
import {readdirSync, readFileSync} from 'node:fs';
import {gzipSync} from 'node:zlib';
import {basename, join, relative} from 'node:path';
import {check, data, pageModule, run} from './support.mjs';

const [module, program] = process.argv.slice(2), engine = readFileSync(module);
const {startEngine} = await pageModule('link/engine_worker.js'), {bytesAsFile} = await pageModule('link/engine_files.js');
const {openfoamCase, pathsToRead} = await pageModule('link/dropped_files.js');

/** What the page is told of files, {path: bytes}, that are dropped. */
async function drop(contents) {
  const said = [], files = Object.fromEntries(Object.entries(contents).map(([path, bytes]) => [path, bytesAsFile(bytes)]));
  const paths = pathsToRead(Object.keys(files));
  const isotet = await startEngine({engine, files, told: {file: basename(paths[0]), version: '1', files: paths}}, (message) => said.push(message));
  return {isotet, said, find: (say) => said.find(({text}) => text?.say === say)?.text};
}

const contentsOf = (...paths) => Object.fromEntries(paths.map((path) => [basename(path), readFileSync(path)]));
const headOf = (frame) => JSON.parse(new TextDecoder().decode(new Uint8Array(frame, 8, new DataView(frame).getUint32(4, true))));

async function compare(contents, path) {
  const {isotet, said, find} = await drop(contents), grid = find('grid');
  check(grid, `${path}: ${JSON.stringify(said.at(-1)?.text)}`);
  const told = run(program, 'info', path);
  check(grid.points === told.points && grid.cells === told.cells, `${path}: ${grid.points} points, ${grid.cells} cells`);
  const {field} = grid.state;
  isotet.answer({do: 'chart', field});
  const chart = find('chart'), isovalue = 0.55 * chart.lower + 0.45 * chart.upper;
  isotet.answer({do: 'show', number: 1, state: {...grid.state, isosurfaces: true, isovalues: [isovalue]}, moving: false});
  const frame = said.find((one) => one.frame);
  check(frame, `${path}: ${find('refused')?.sentence}`);
  const shown = headOf(frame.frame).surfaces.find(({kind}) => kind === 'surface').triangles;
  const extracted = run(program, 'extract', path, '-f', field, '-i', String(isovalue), '--tolerance', 'nodes').surfaces[0].triangles;
  check(shown === extracted, `${path}: ${shown} triangles, but the program extracts ${extracted}`);
  isotet.prepare();
  check(said.at(-1).text.step === 'ready', `${path}: ${JSON.stringify(said.at(-1).text)}`);
  console.log(`ok ${path.split(/\/data\/|\/tests\//)[1]} ${field}: ${shown} triangles`);
}

for (const path of ['vtu/artery_flow_tet_wedge.vtu', 'vtu/all_dims_tets_lzma.vtu', 'vtu/polyhedron_two_pieces.vtu', 'vtu/mfem_levels_hex.vtu',
  'vtk/ugridex_all_kinds.vtk', 'vtk/mfem_levels_tet.vtk', 'msh/table_v22_binary_elementdata.msh', 'msh/inclusions_v41_binary.msh',
  'medit/cube_sphere_26k.meshb', 'gocad/geomodel3d_tsolid.so', 'avs_ucd/tet_attributes.inp'].map(data)) await compare(contentsOf(path), path);
await compare(contentsOf(data('tetgen/ellipsoid_16k.node'), data('tetgen/ellipsoid_16k.ele')), data('tetgen/ellipsoid_16k.node'));
const pieces = readdirSync(data('pvtu/monodomain'), {recursive: true}).map((name) => join(data('pvtu/monodomain'), name)).filter((path) => /vtu$/.test(path));
await compare(contentsOf(...pieces), pieces.find((path) => path.endsWith('.pvtu'))); // without their folders
await compare(Object.fromEntries(Object.entries(contentsOf(...pieces)).map(([name, bytes]) => [`dropped/${name}`, bytes])),
  pieces.find((path) => path.endsWith('.pvtu'))); // in another folder than they say

// A case of OpenFOAM: its folder, what is in it, its files packed, and files without folders.
const foam = join(data('.'), '../tests/corruption/samples/openfoam');
const inCase = Object.fromEntries(readdirSync(foam, {recursive: true, withFileTypes: true}).filter((entry) => entry.isFile())
  .map((entry) => join(entry.parentPath ?? entry.path, entry.name)).map((path) => [relative(foam, path), readFileSync(path)]));
const places = (contents, change) => Object.fromEntries(Object.entries(contents).map(([path, bytes]) => change(path, bytes)));
await compare(places(inCase, (path, bytes) => [`cavity/${path}`, bytes]), foam);
await compare(inCase, foam);
await compare(places(inCase, (path, bytes) => [`a/b/${path}${path.endsWith('.foam') ? '' : '.gz'}`, path.endsWith('.foam') ? bytes : gzipSync(bytes)]), foam);
const numbers = (text) => text.split('(').pop().split(')')[0].trim().split(/\s+/).map(Number);
const binary = (text) => Buffer.concat([Buffer.from(text.replace('ascii', 'binary').replace(/\([^)]*\)[\s\S]*/, '(')), Buffer.from(new Float64Array(numbers(text)).buffer), Buffer.from(text.match(/\)[^)]*$/)[0])]);
await compare(places(inCase, (path, bytes) => [path, path === '0/p' ? binary(bytes.toString()) : bytes]), foam);
const flat = places(inCase, (path, bytes) => [basename(path), bytes]), {place} = openfoamCase(Object.keys(flat));
await compare(places(flat, (path, bytes) => [place(path), bytes]), foam);

const whole = readFileSync(data('vtu/artery_flow_tet_wedge.vtu'));
for (const [name, bytes] of [['a.vtu', whole.subarray(0, 100000)], ['b.vtu', whole.subarray(0, whole.length - 200)], ['c.vtu', new Uint8Array(0)],
  ['d.txt', Buffer.from('nothing')], ['e.vtkhdf', Buffer.from('\x89HDF\r\n\x1a\n', 'latin1')], ['f.pvtu', readFileSync(pieces.find((path) => path.endsWith('.pvtu')))],
  ['<img src=x>.node', Buffer.from('1 3 0 0\n1 0 0 0\n')]]) {
  const {find, said} = await drop({[name]: bytes});
  check(find('error')?.sentence.length > 10, `${name}: ${JSON.stringify(said.at(-1))}`);
  console.log(`ok ${name}: ${find('error').sentence.slice(0, 120)}`);
}

const cutCase = places(inCase, (path, bytes) => [`cut/${path}`, path.endsWith('faces') ? bytes.subarray(0, bytes.length - 90) : bytes]);
const {find: findInCut} = await drop(cutCase);
check(findInCut('error')?.sentence.includes('cut/constant/polyMesh/faces'), JSON.stringify(findInCut('error')));

for (const [paths, folder, placed] of [
  [['c/constant/polyMesh/faces', 'c/0/p'], 'c'], [['c/processor0/constant/polyMesh/faces', 'c/processor1/constant/polyMesh/faces.gz'], 'c'],
  [['constant/air/polyMesh/faces'], '.'], [['polyMesh/faces', 'polyMesh/points', 'polyMesh/owner', '0.5/p'], '.', 'constant/polyMesh/faces'],
  [['c/faces', 'c/points', 'c/owner', 'c/U'], '.', 'constant/polyMesh/faces']]) {
  const found = openfoamCase(paths);
  check(found?.folder === folder && found.place(paths[0]) === (placed ?? paths[0]), `${paths}: ${found?.folder}`);
}
check(openfoamCase(['faces', 'a.vtu']) === null, 'a mesh has points, too');
check(JSON.stringify(pathsToRead(['c/constant/polyMesh/faces', 'c/VTK/c_1.vtk'])) === '["c"]', 'a case is read, not what was made of it');
check(JSON.stringify(pathsToRead(['b_10.vtu', 'b_9.vtu', 'x.png'])) === '["b_9.vtu","b_10.vtu"]', 'files of a kind are steps');
check(JSON.stringify(pathsToRead(['a_0.vtu', 'a.pvtu'])) === '["a.pvtu"]', 'what names others is read');
check(JSON.stringify(pathsToRead(['a.sol', 'a.mesh'])) === '["a.mesh"]', 'a solution is no mesh');
