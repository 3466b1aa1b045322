// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An isovalue that moves, in Node, by one thread and by two in turn: node moving.mjs NPM PROGRAM [SIDE...], isotet.js of scripts/web.sh and
// isotet. THREADS=1,2 names the numbers of threads, NORMALS=vertex asks for normals, ROUNDS=9.
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {spawnSync} from 'node:child_process';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';

const [npm, program, ...given] = process.argv.slice(2), sides = given.length > 0 ? given.map(Number) : [55, 94];
const counts = (process.env.THREADS ?? '1,2').split(',').map(Number), options = {normals: process.env.NORMALS ?? 'none'};
const {open} = await import(resolve(npm, 'isotet.js')), folder = mkdtempSync(join(tmpdir(), 'isotet-moving-'));

for (const side of sides) {
  const file = join(folder, 'grid.isotet'), rounds = Number(process.env.ROUNDS ?? 9), values = 21, runs = [];
  spawnSync(program, ['pack', `make:kuhn:${side}:gyroid`, file, '--quiet'], {stdio: 'inherit'});
  for (const threads of counts) {
    const started = performance.now(), grid = await open(readFileSync(file), {threads});
    grid.contour(0, options);
    runs.push({grid, ready: performance.now() - started, times: [], processor: [], best: new Array(values).fill(Infinity)});
  }
  let triangles = 0;
  for (let round = 0; round < rounds; ++round)
    for (const {grid, times, processor, best} of runs)
      for (let i = 0; i < values; ++i) {
        const start = performance.now(), used = process.cpuUsage();
        triangles += grid.contour(-0.8 + 1.6 * i / (values - 1), options).triangles.length / 3;
        times.push(performance.now() - start);
        best[i] = Math.min(best[i], times.at(-1));
        processor.push((process.cpuUsage(used).user + process.cpuUsage(used).system) / 1000);
      }
  for (const {grid, ready, times, processor, best} of runs) {
    for (const all of [times, processor, best]) all.sort((a, b) => a - b);
    const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(1), median = (all) => all[Math.floor(all.length / 2)].toFixed(1);
    console.log(`${grid.cells} tets, ${grid.threads} threads: first surface ${ready.toFixed(0)} ms after opening; then ${at(0)} / ${at(0.5)} / ${at(1)} ms ` +
      `(best, median, worst of ${times.length}; the best round of each value: ${median(best)}), ${median(processor)} ms of the processor, ` +
      `${Math.round(triangles / runs.length / times.length)} triangles`);
    grid.close();
  }
}
rmSync(folder, {recursive: true});
