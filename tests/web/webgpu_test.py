# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet.js by WebGPU, on Chromium's software adapter: python3 webgpu_test.py NPM PROGRAM. Triangles are those of the WebAssembly engine,
vertices within one unit in the last place; a card that is missing, wrong, lost or too small is not noticed in surfaces."""
import functools
import http.server
import json
import os
import subprocess
import sys
import tempfile
import threading

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', 'view'))
from chromium import Browser  # noqa: E402

WORDS = ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader']

# Tets; all kinds of cells; ties, and clusters whose edges fill several windows; a real grid.
GRIDS = {'kuhn': 'make:kuhn:16:gyroid', 'mixed': 'make:mixed:8:sphere', 'hex': 'make:hex:10:integer', 'ties': 'make:kuhn:12:integer',
         'artery': os.path.join(HERE, '../../data/vtu/artery_flow_tet_wedge.vtu')}

BEGIN = '''(async () => {
  const {open, fromArrays, openInWorker} = await import('./isotet/isotet.js'), {gyroidGrid} = await import('./gyroid.js');
  const bits = (floats) => new Int32Array(floats.buffer, floats.byteOffset, floats.length), place = (i) => (i < 0 ? -2147483648 - i : i);
  /** [whether triangles and fields are the same, the largest distance of coordinates in units in the last place, triangles] */
  const compare = (found, right) => {
    const same = (p, q) => p.length === q.length && p.every((one, i) => one === q[i]);
    const [a, b] = [bits(found.positions), bits(right.positions)], equal = same(found.triangles, right.triangles) && a.length === b.length;
    let most = 0;
    for (let i = 0; equal && i < a.length; ++i) most = Math.max(most, Math.abs(place(a[i]) - place(b[i])));
    const normals = !right.normals || most > 0 || same(found.normals, right.normals);
    return [equal && normals && Object.keys(right.fields).every((name) => same(found.fields[name], right.fields[name])), most, right.triangles.length / 3];
  };
  const device = 'webgpu-software', grid = gyroidGrid(20);
'''

SURFACES = BEGIN + '''
  const data = await (await fetch(FILE)).arrayBuffer(), by = await OPEN(data, {name: 'grid.isotet', device}), right = await open(data, {name: 'grid.isotet'});
  const [lower, upper] = await by.range(), field = right.fields[0].name;
  let equal = true, most = 0, triangles = 0;
  for (const [part, options] of [[0.5, {}], [0.21, {normals: 'vertex'}], [0.77, {fields: [field]}], [0, {}], [1, {}], [0.5, {}]]) {
    const value = lower + part * (upper - lower), [same, distance, count] = compare(await by.contour(value, options), right.contour(value, options));
    equal &&= same;
    most = Math.max(most, distance);
    triangles += count;
  }
  const told = [by.device?.architecture, by.whyNoDevice, equal, most <= 1, triangles > 0];
  by.close();
  return told;
})()'''

# Before the grid is opened, `before` runs; after a first surface `between`.
FALLBACK = BEGIN + '''
  BEFORE
  const by = await fromArrays(grid, {device}), right = await fromArrays(grid), first = compare(await by.contour(0.1), right.contour(0.1)), had = by.device !== null;
  BETWEEN
  const second = compare(await by.contour(0.2), right.contour(0.2));
  return [first[0] && second[0], Math.max(first[1], second[1]) <= 1, had, by.device !== null, by.whyNoDevice.includes(WHY) || by.whyNoDevice];
})()'''

# What does not fit in the module's memory is for the processor, and so are all other surfaces of the grid; a module that stops is closed.
STOPPED = BEGIN + '''
  const by = await fromArrays(grid, {device}), right = await fromArrays(grid), {card} = by.grid, {exports} = card;
  let asked = 0;
  card.exports = {...exports, card_room: () => { ++asked; card.take({room: null}); }};
  for (const value of [0.1, 0.2, 0.3]) if (!compare(await by.contour(value), right.contour(value))[0]) return value;
  const seen = [asked, by.device !== null], other = await fromArrays(grid, {device});
  other.grid.card.exports = {...other.grid.card.exports, card_room: () => { throw new WebAssembly.RuntimeError('unreachable'); }};
  await other.contour(0.1);
  for (const value of [0.2, 0.3]) seen.push(await other.contour(value).then(() => 'made', ({message}) => message));
  return seen;
})()'''

# A module that can hardly grow has no room for what would go to the card.
CROWDED = BEGIN + '''
  /** The module, whose memory may have so many pages of 64 kB. */
  const limited = (module, pages) => {
    const number = (value) => (value > 127 ? [value % 128 + 128, ...number(Math.floor(value / 128))] : [value]);
    const read = (at) => { const [rest, end] = module[at] > 127 ? read(at + 1) : [0, at + 1]; return [rest * 128 + module[at] % 128, end]; };
    for (let at = 8; ;) {
      const [bytes, begin] = read(at + 1), memory = [1, 1, ...number(512), ...number(pages)];
      if (module[at] === 5) return new Uint8Array([...module.subarray(0, at), 5, memory.length, ...memory, ...module.subarray(begin + bytes)]);
      at = begin + bytes;
    }
  };
  const {useModule} = await import('./isotet/isotet.js'), data = await (await fetch('./crowded.isotet')).arrayBuffer();
  const right = await open(data), surfaces = [0.1, 0.2].map((value) => { const {positions, triangles} = right.contour(value); return {positions: positions.slice(), triangles: triangles.slice(), fields: {}}; });
  await useModule(limited(new Uint8Array(await (await fetch('./isotet/isotet_engine.wasm')).arrayBuffer()), right.memory.buffer.byteLength / 65536 + 16));
  const by = await open(data, {device}), seen = [];
  for (const [i, value] of [0.1, 0.2].entries()) seen.push(compare(await by.contour(value), surfaces[i])[0]);
  return [...seen, by.device !== null];
})()'''

# Memory that threads share.
THREADS = BEGIN + '''
  const by = await fromArrays(grid, {device, threads: 2}), right = await fromArrays(grid, {threads: 1});
  await by.contour(0.3);
  const [same, distance] = compare(await by.contour(0.1), right.contour(0.1));
  return [crossOriginIsolated, by.threads, by.device?.architecture, by.whyNoDevice, same, distance <= 1];
})()'''

WRONG = '''const make = GPUDevice.prototype.createShaderModule;
  GPUDevice.prototype.createShaderModule = function (told) { return make.call(this, {...told, code: told.code.replace('return a + rounded', 'return a - rounded')}); };'''
BROKEN = WRONG.replace("'return a - rounded'", "'return a + rounded rounded'")
LOST = '''const request = GPUAdapter.prototype.requestDevice;
  GPUAdapter.prototype.requestDevice = async function (...words) { return window.lent = await request.apply(this, words); };'''
SMALL = "Object.defineProperty(GPUSupportedLimits.prototype, 'maxStorageBufferBindingSize', {get: () => LIMIT});"
# Buffers are as small as the limits say.
BUFFERS = """for (const name of ['maxStorageBufferBindingSize', 'maxBufferSize']) Object.defineProperty(GPUSupportedLimits.prototype, name, {get: () => 1200000});
  const make = GPUDevice.prototype.createBuffer;
  GPUDevice.prototype.createBuffer = function (told) { if (told.size > 1200000) throw new Error(told.label); return make.call(this, told); };"""
# A card that takes denormals for zero and knows no infinities, of values that have both: stored ones have none.
FLUSHING = WRONG.replace("'return a + rounded', 'return a - rounded'", "'return page[push.values + point];', `var bits = page[push.values + point];"
                         " if ((bits & 0x7f800000u) == 0u || (bits & 0x7fffffffu) == 0x7f800000u) { bits = 0u; } return bits;`")
TINY = FLUSHING + '''
  grid.values.gyroid = grid.values.gyroid.map((value, i) => (i % 97 === 0 ? Infinity * value : 1e-40 * value));'''

CASES = [
    ('no adapter', "navigator.gpu.requestAdapter = async () => null;", '', 'no WebGPU', [False, False]),
    ('a wrong card', WRONG, '', 'another surface', [False, False]),
    ('kernels that are not taken', BROKEN, '', '', [False, False]),
    ('a lost card', LOST, 'window.lent.destroy();', 'lost', [True, False]),
    ('buffers that are small', BUFFERS, '', '', [True, True]),
    ('denormals and infinities', TINY, '', '', [True, True]),
    ('a grid that is too large', SMALL.replace('LIMIT', '150000'), '', '', [True, True]),
]


def main():
    npm, program = os.path.abspath(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory(prefix='isotet-webgpu-') as folder:
        os.symlink(npm, os.path.join(folder, 'isotet'))
        os.symlink(os.path.join(HERE, '../../examples/javascript/gyroid.js'), os.path.join(folder, 'gyroid.js'))
        with open(os.path.join(folder, 'page.html'), 'w', encoding='ascii') as file:
            file.write('<!doctype html><link rel="icon" href="data:,"><title>page</title>')
        os.symlink(folder, os.path.join(folder, 'isolated'))
        for name, grid in {**GRIDS, 'crowded': 'make:kuhn:80:gyroid'}.items():
            subprocess.run([program, 'pack', grid, os.path.join(folder, name + '.isotet'), '--quiet'], check=True)

        class Handler(http.server.SimpleHTTPRequestHandler):
            def end_headers(self):
                if 'isolated' in self.path + self.headers.get('Referer', ''):
                    self.send_header('Cross-Origin-Opener-Policy', 'same-origin')
                    self.send_header('Cross-Origin-Embedder-Policy', 'require-corp')
                    self.send_header('Cache-Control', 'no-store')
                super().end_headers()

            def log_message(self, *_):
                pass

        server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), functools.partial(Handler, directory=folder))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = Browser(words=WORDS)

        def expect(name, script, expected, page='page.html'):
            browser.errors.clear()
            browser.open(f'http://127.0.0.1:{server.server_port}/{page}')
            seen = browser.value(script)
            if seen != expected:
                raise AssertionError(f'{name}: {seen}, not {expected}; errors: {browser.errors}')
            print('ok webgpu:', name, flush=True)

        try:
            for name in GRIDS:
                script = SURFACES.replace('FILE', json.dumps(f'./{name}.isotet')).replace('OPEN', 'openInWorker' if name == 'mixed' else 'open')
                expect(name, script, ['swiftshader', '', True, True, True])
            expect('threads', THREADS, [True, 2, 'swiftshader', '', True, True], 'isolated/page.html')
            expect('no memory for a surface', STOPPED, [1, True, 'isotet stopped, for lack of memory perhaps (unreachable)', 'the grid was closed'])
            expect('no memory for a grid', CROWDED, [True, True, True])
            for name, before, between, why, [had, has] in CASES:
                expect(name, FALLBACK.replace('BEFORE', before).replace('BETWEEN', between).replace('WHY', json.dumps(why)), [True, True, had, has, True])
        finally:
            browser.close()
            server.shutdown()


main()
