// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the tests of isotet as WebAssembly share: the program to compare with, and its files.
import {spawnSync} from 'node:child_process';
import {cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
export const data = (path) => join(here, '../../data', path);
export const folder = mkdtempSync(join(tmpdir(), 'isotet-web-'));
process.on('exit', () => rmSync(folder, {recursive: true}));

export function check(condition, what) {
  if (!condition) throw new Error(what);
}

/** The JSON of a command of the program. */
export function run(program, ...words) {
  const ran = spawnSync(program, [...words, '--json', '-', '--quiet'], {encoding: 'utf8', maxBuffer: 1e9});
  check(ran.status === 0, `isotet ${words.join(' ')}: ${ran.stderr}`);
  return JSON.parse(ran.stdout);
}

/** Positions and triangles of a binary PLY of isotet: three numbers each, and int32 behind a count of 3. */
export function readPly(path) {
  const bytes = readFileSync(path), end = bytes.indexOf('end_header\n') + 11, head = bytes.toString('latin1', 0, end);
  const [vertices, triangles] = ['vertex', 'face'].map((name) => Number(head.match(new RegExp(`element ${name} (\\d+)`))[1]));
  const each = [...head.slice(0, head.indexOf('element face')).matchAll(/property (\w+) /g)].map(([, type]) => ({float: 4, double: 8, uchar: 1, int: 4}[type])).reduce((a, b) => a + b, 0);
  const positions = bytes.subarray(end, end + each * vertices), corners = Buffer.alloc(12 * triangles);
  const faces = end + each * vertices, size = (bytes.length - faces) / Math.max(1, triangles);
  for (let i = 0; i < triangles; ++i) bytes.copy(corners, 12 * i, faces + size * i + 1, faces + size * i + 13);
  return {positions, corners};
}

export const bytesOf = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);

/** Modules of the page, which Node takes where a package.json says that they are modules. */
export async function pageModule(name) {
  const modules = join(folder, 'page');
  cpSync(join(here, '../../src/view/web'), modules, {recursive: true});
  writeFileSync(join(modules, 'package.json'), '{"type": "module"}');
  return import(join(modules, name));
}

export const median = (numbers) => numbers.sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
