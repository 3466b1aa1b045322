// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// GLB files of the program by Khronos' validator: surfaces, parts, colours, solids, time steps. Where it is installed:
// npm install -g gltf-validator.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const {ISOTET_PROGRAM: program, ISOTET_GLTF_VALIDATOR: modules, ISOTET_DATA: data} = process.env;
const validator = createRequire(join(modules, 'x.js'))('./gltf-validator');
const steps = join(data, 'exodus/tension_tets_stress_3steps.e'), folder = mkdtempSync(join(tmpdir(), 'isotet-glb-'));
const files = {
  surface: ['make:hex:6:sphere', '-f', 'sphere', '-i', '0.5', '--normals', 'gradient'],
  parts: ['make:kuhn:12:gyroid', '-f', 'gyroid', '-i', '0.9,0.95', '--keep', '5'],
  colours: ['make:kuhn:8:sphere,gyroid', '-f', 'sphere', '-i', '0.5', '--color-by', 'gyroid'],
  solid: ['make:mixed:6:sphere', '-f', 'sphere', '--solid', '0.4:0.6', '--normals', 'vertex'],
  steps: [steps, '-f', 'pressure', '-i', '50%v', '--all-steps', '--solid', 'below'],
  empty: ['make:hex:2:sphere', '-f', 'sphere', '-i', '9', '--allow-empty'],
};
let failures = 0;
for (const [name, words] of Object.entries(files)) {
  const path = join(folder, `${name}.glb`);
  execFileSync(program, ['extract', ...words, '-q', '-o', path]);
  const {issues, info} = await validator.validateBytes(new Uint8Array(readFileSync(path)), {uri: path});
  const found = issues.numErrors + issues.numWarnings + issues.numInfos + issues.numHints;
  const wrong = name === 'steps' && info.animationCount !== 1 ? ['the time steps are no animation'] : [];
  if (found > 0) wrong.push(...issues.messages.slice(0, 3).map(({code, pointer}) => `${code} at ${pointer}`));
  console.log(wrong.length > 0 ? 'FAILED' : 'ok', name, ...wrong);
  failures += wrong.length > 0;
}
rmSync(folder, {recursive: true});
process.exit(failures > 0 ? 1 : 0);
