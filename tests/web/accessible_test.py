# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of one file and that of `isotet view` in Chromium against axe-core's rules: python3 accessible_test.py AXE PROGRAM, axe.min.js
of npm and isotet. Pages with isotet as WebAssembly are among them where the program has it."""
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', 'view'))
from chromium import Browser, Viewer  # noqa: E402

ARTERY = os.path.join(HERE, '..', '..', 'data', 'vtu', 'artery_flow_tet_wedge.vtu')
SHOWN = 'Number(document.body.dataset.triangles) > 0'
# NAME: how it is made, and when it is there.
PAGES = {'surfaces': (['export', ARTERY, '{}', '-f', 'Umag', '--color-by', 'p', '--surfaces', '7'], SHOWN),
         'grid': (['export', ARTERY, '{}', '-f', 'Umag', '--color-by', 'p', '--as', 'grid'], SHOWN),
         'files': (['page', '{}'], 'document.getElementById("drop") !== null')}


def pages(program, folder):
    """(NAME, ADDRESS, when it is there) of each that the program can make."""
    for name, (words, there) in PAGES.items():
        path = os.path.join(folder, f'{name}.html')
        run = subprocess.run([program, *[word.format(path) for word in words], '--quiet'], capture_output=True, text=True)
        if run.returncode == 0:
            yield name, 'file://' + path, there
        elif 'WebAssembly' not in run.stderr:
            raise AssertionError(f'{name}: {run.stderr}')
    os.environ['ISOTET_PROGRAM'] = program
    with Viewer(ARTERY, '-f', 'Umag', '--color-by', 'p', '--keep') as viewer:
        yield 'view', viewer.address, SHOWN
        yield 'view folded', viewer.address, f'{SHOWN} && (document.querySelectorAll("details").forEach((one) => {{ one.open = false; }}), true)'


def faults(browser):
    told = browser.value('axe.run().then((told) => told.violations.map(({id, help, nodes}) => [id, help, nodes.map(({html}) => html.slice(0, 120))]))')
    return json.dumps(told, indent=1) if told else ''


def main():
    axe, program = sys.argv[1:]
    with open(axe, encoding='utf-8') as file:
        script = file.read()
    failed = 0
    with tempfile.TemporaryDirectory(prefix='isotet-axe-') as folder:
        browser = Browser()
        try:
            for name, address, there in pages(program, folder):
                for width, height, scheme in ((1280, 800, 'light'), (1280, 800, 'dark'), (360, 740, 'light')):
                    browser.resize(width, height)
                    browser.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': scheme}])
                    browser.call('Page.navigate', url='about:blank')
                    browser.open(address)
                    browser.wait(there, 60)
                    browser.value(f'(() => {{ {script}; window.axe = axe; }})()')
                    found = faults(browser)
                    failed += bool(found)
                    print('FAILED' if found else 'ok', name, width, scheme, found, flush=True)
        finally:
            browser.close()
    return 1 if failed else 0


sys.exit(main())
