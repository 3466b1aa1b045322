# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of one file in Firefox, opened from the disk: isosurfaces, and where the program has isotet as WebAssembly a grid, and files
that are chosen."""
import json
import os
import subprocess
import sys
import tempfile
import traceback

from firefox import Browser

ARTERY = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'data', 'vtu', 'artery_flow_tet_wedge.vtu')


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def isotet(*words):
    """The JSON of a command."""
    run = subprocess.run([os.environ['ISOTET_PROGRAM'], *words, '--json', '-', '--quiet'], capture_output=True, text=True)
    check(run.returncode == 0, f'{words}: {run.stderr}')
    return json.loads(run.stdout)


def has_module(folder):
    run = subprocess.run([os.environ['ISOTET_PROGRAM'], 'page', os.path.join(folder, 'try.html'), '--quiet'], capture_output=True)
    return run.returncode == 0


def at_rest(browser):
    browser.wait('document.body.dataset.preview === "false" && Number(document.getElementById("slider")'
                 '.getAttribute("aria-valuenow")) === Number(document.body.dataset.shown) && Number(document.body.dataset.triangles) > 0')


def try_slider(browser):
    """By mouse and by keys; the picture follows."""
    at_rest(browser)
    first, picture = browser.value('document.body.dataset.shown'), browser.picture()
    x, y, w, h = browser.box('#slider')
    browser.drag((x + 0.4 * w, y + h / 2), (x + 0.6 * w, y + h / 2))
    browser.wait(f'document.body.dataset.shown !== "{first}"')
    at_rest(browser)
    before = float(browser.value('document.body.dataset.shown'))
    check(browser.picture() != picture, 'the picture follows the slider')
    browser.key('ArrowRight')
    browser.wait(f'Number(document.body.dataset.shown) > {before}')
    at_rest(browser)


def check_triangles(browser, *words):
    """Those that the program extracts at the page's value."""
    field, value = browser.value('[document.body.dataset.field, document.body.dataset.shown]')
    extracted = isotet('extract', ARTERY, '-f', field, '-i', value, *words)['surfaces'][0]['triangles']
    shown = int(browser.value('document.body.dataset.triangles'))
    check(shown == extracted, f'{shown} triangles of {field} at {value}, but the program extracts {extracted}')


def test_surfaces(browser, folder):
    path = os.path.join(folder, 'surfaces.html')
    isotet('export', ARTERY, path, '-f', 'Umag', '--surfaces', '15')
    browser.open('file://' + path)
    try_slider(browser)
    check_triangles(browser)


def test_on_a_phone(browser, folder):
    path = os.path.join(folder, 'surfaces.html')
    browser.resize(450, 740)  # no window of it is narrower
    try:
        browser.open('file://' + path)
        at_rest(browser)
        check(browser.value('document.documentElement.scrollWidth <= innerWidth'), 'nothing lies beside the screen')
    finally:
        browser.resize(1280, 800)


def module_test_grid(browser, folder):
    path = os.path.join(folder, 'grid.html')
    isotet('export', ARTERY, path, '-f', 'Umag', '--color-by', 'p', '--as', 'grid')
    browser.open('file://' + path)
    try_slider(browser)
    check_triangles(browser, '--method', 'clusters')


def module_test_files(browser, folder):
    path = os.path.join(folder, 'isotet.html')
    isotet('page', path)
    browser.open('file://' + path)
    browser.choose('#chosen-files', [ARTERY])
    browser.wait('document.body.dataset.step === "ready"')
    try_slider(browser)
    check_triangles(browser, '--method', 'clusters')


def main():
    failed = 0
    with tempfile.TemporaryDirectory(prefix='isotet-firefox-test-') as folder:
        kinds = ('test_', 'module_test_') if has_module(folder) else ('test_',)
        browser = Browser()
        try:
            for test in [f for name, f in globals().items() if name.startswith(kinds)]:
                try:
                    test(browser, folder)
                    check(not browser.errors(), f'errors of the page: {browser.errors()}')
                    print('ok', test.__name__, flush=True)
                except Exception:
                    failed += 1
                    print('FAILED', test.__name__)
                    traceback.print_exc(file=sys.stdout)
        finally:
            browser.close()
    return 1 if failed else 0


sys.exit(main())
