# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The pages of examples/javascript in Chromium: python3 examples_test.py NPM NODE_MODULES, isotet.js and a folder with three and vtk.js."""
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

WORKER = '''(async () => {
  const {fromArraysInWorker, fromArrays} = await import('./node_modules/isotet/isotet.js'), {gyroidGrid} = await import('./gyroid.js');
  const remote = await fromArraysInWorker(gyroidGrid(8)), local = await fromArrays(gyroidGrid(8));
  const [a, b] = [await remote.contour(0.3, {fields: ['gyroid']}), local.contour(0.3, {fields: ['gyroid']})];
  const refused = await remote.contour(0, {field: 'pressure'}).catch((error) => error.message);
  remote.close();
  const same = (p, q) => p.length > 0 && p.length === q.length && p.every((one, i) => one === q[i]);
  return [same(a.positions, b.positions) && same(a.triangles, b.triangles) && same(a.fields.gyroid, b.fields.gyroid), refused.includes('pressure')];
})()'''


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def triangles(browser):
    return int(browser.value('document.getElementById("told").textContent').split()[0])


def test_example(browser, address, name):
    browser.errors.clear()
    browser.open(f'{address}/{name}')
    browser.wait('document.body.dataset.ready === "1"', 60)
    before = triangles(browser)
    picture = browser.picture(os.environ.get('ISOTET_PICTURES') and os.path.join(os.environ['ISOTET_PICTURES'], name + '.png'))
    browser.value('isovalue.value = 0.9; isovalue.dispatchEvent(new Event("input"))')
    check(0 < triangles(browser) < before, f'{name}: the surface follows the slider')
    check(browser.picture() != picture, f'{name}: so does the picture')
    check(not browser.errors, f'{name}: errors of the page: {browser.errors}')
    print('ok', name, before, 'triangles', flush=True)


def main():
    npm, modules = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix='isotet-examples-') as folder:
        shutil.copytree(os.path.join(HERE, '..', '..', 'examples', 'javascript'), folder, dirs_exist_ok=True)
        os.mkdir(os.path.join(folder, 'node_modules'))
        for name, path in (('isotet', npm), ('three', os.path.join(modules, 'three')), ('vtk.js', os.path.join(modules, 'vtk.js'))):
            os.symlink(os.path.abspath(path), os.path.join(folder, 'node_modules', name))
        server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), functools.partial(Quiet, directory=folder))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f'http://127.0.0.1:{server.server_port}'
        browser = Browser()
        try:
            for name in ('three.html', 'vtk.html'):
                test_example(browser, address, name)
            check(browser.value(WORKER) == [True, True], 'the same surface from a thread, and its errors')
            print('ok in a worker')
        finally:
            browser.close()
            server.shutdown()


main()
