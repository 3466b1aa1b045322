# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet.js by several threads in pages of Chromium: isolated, not, and in broken surroundings: python3 threads_test.py NPM"""
import functools
import http.server
import os
import shutil
import sys
import tempfile
import threading

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', 'view'))
from chromium import Browser  # noqa: E402

BEGIN = '''(async () => {
  const {fromArrays, fromArraysInWorker} = await import('./isotet/isotet.js'), {gyroidGrid} = await import('./gyroid.js');
  const grid = gyroidGrid(24), same = (p, q) => p.length > 0 && p.length === q.length && p.every((one, i) => one === q[i]);
'''

# By one thread, by several in the page, and by several in a worker, of which the machine tells how many.
SURFACES = BEGIN + '''
  const grids = [await fromArrays(grid, {threads: 1}), await fromArrays(grid, {threads: 2}), await fromArrays(grid, {threads: 4}), await fromArraysInWorker(grid, {threads: 4}), await fromArrays(grid)];
  let equal = true;
  for (const options of [{once: true}, {normals: 'vertex', fields: ['gyroid']}])
    for (const value of [-0.4, 0, 0.3]) {
      const [one, ...others] = await Promise.all(grids.map((each) => each.contour(value, options)));
      for (const other of others) equal &&= same(one.positions, other.positions) && same(one.triangles, other.triangles) && (!options.normals || same(one.normals, other.normals));
    }
  const threads = grids.map((each) => each.threads);
  for (const each of grids) each.close();
  return [crossOriginIsolated, threads.slice(0, 4), threads[4] === (crossOriginIsolated ? Math.min(16, navigator.hardwareConcurrency) : 1), equal];
})()'''

MEMORY = BEGIN + '''
  const {Memory} = WebAssembly;
  WebAssembly.Memory = function (options) { if (options.shared) throw new RangeError('no memory'); return new Memory(options); };
  const one = await fromArrays(grid, {threads: 4});
  return [crossOriginIsolated, one.threads, one.contour(0).triangles.length > 0];
})()'''

NO_WORKERS = BEGIN + '''
  const one = await fromArrays(grid, {threads: 4});
  return [crossOriginIsolated, one.threads, one.contour(0).triangles.length > 0];
})()'''

TRAP = BEGIN + '''
  const failing = KIND(grid, {threads: 4}), fails = async (work) => { try { await work(); return ''; } catch (error) { return error.message; } };
  const one = await failing, threads = one.threads;
  let message = '';
  for (let i = 0; message === '' && i < 50; ++i) message = await fails(() => one.contour(i / 100));
  const again = await fails(() => one.contour(0)), after = await KIND(grid, {threads: 4});
  return [threads, message.includes('a thread of isotet stopped') || message, again.includes('closed') || again, after.threads, (await after.contour(0)).triangles.length > 0];
})()'''


class Handler(http.server.SimpleHTTPRequestHandler):
    """Pages whose name has "isolated" in it are, and may be told of no workers."""

    def end_headers(self):
        of = self.path + self.headers.get('Referer', '')
        if 'isolated' in of:
            self.send_header('Cross-Origin-Opener-Policy', 'same-origin')
            self.send_header('Cross-Origin-Embedder-Policy', 'require-corp')
        if 'no_workers' in of:
            self.send_header('Content-Security-Policy', "worker-src 'none'")
        self.send_header('Cache-Control', 'no-store')
        super().end_headers()

    def log_message(self, *_):
        pass


def broken_copy(npm, to):
    """The first worker's stack ends where memory begins: it traps as soon as work needs some."""
    shutil.copytree(npm, to)
    path = os.path.join(to, 'isotet_thread.js')
    with open(path, encoding='utf8') as file:
        text = file.read()
    begin = '__stack_pointer.value = stack'
    assert begin in text
    with open(path, 'w', encoding='utf8') as file:
        file.write(text.replace(begin, '__stack_pointer.value = number === 1 ? 2048 : stack'))


def main():
    npm = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix='isotet-threads-') as folder:
        broken_copy(npm, os.path.join(folder, 'broken'))
        pages = {'isolated': npm, 'open': npm, 'isolated_memory': npm, 'isolated_no_workers': npm, 'isolated_trap': os.path.join(folder, 'broken')}
        for name, package in pages.items():
            # A folder each: what a worker loads names the folder, not the page.
            os.mkdir(os.path.join(folder, name))
            os.symlink(package, os.path.join(folder, name, 'isotet'))
            os.symlink(os.path.join(HERE, '../../examples/javascript/gyroid.js'), os.path.join(folder, name, 'gyroid.js'))
            with open(os.path.join(folder, name, 'page.html'), 'w', encoding='ascii') as file:
                file.write('<!doctype html><link rel="icon" href="data:,"><title>page</title>')
        server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), functools.partial(Handler, directory=folder))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = Browser()
        try:
            for name, page, script, expected in (
                    ('isolated', 'isolated', SURFACES, [True, [1, 2, 4, 4], True, True]),
                    ('not isolated', 'open', SURFACES, [False, [1, 1, 1, 1], True, True]),
                    ('no shared memory', 'isolated_memory', MEMORY, [True, 1, True]),
                    ('no workers', 'isolated_no_workers', NO_WORKERS, [True, 1, True]),
                    ('trap in a thread', 'isolated_trap', TRAP.replace('KIND', 'fromArrays'), [4, True, True, 1, True]),
                    ('trap in a thread of a worker', 'isolated_trap', TRAP.replace('KIND', 'fromArraysInWorker'), [4, True, True, 1, True])):
                browser.errors.clear()
                browser.open(f'http://127.0.0.1:{server.server_port}/{page}/page.html')
                seen = browser.value(script)
                errors = [error for error in browser.errors if 'no_workers' not in page]
                if seen != expected or errors:
                    raise AssertionError(f'{name}: {seen}, not {expected}; errors: {errors}')
                print('ok', name, flush=True)
        finally:
            browser.close()
            server.shutdown()


main()
