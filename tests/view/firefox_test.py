# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of one file in Firefox, opened from the disk: isosurfaces, and where the program has isotet as WebAssembly a grid, and files
that are chosen."""
import os
import sys
import tempfile
import traceback

from firefox import Browser
from pages import check, has_module, isotet

ARTERY = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'data', 'vtu', 'artery_flow_tet_wedge.vtu')


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


def module_test_damaged(browser, folder):
    """A part that was changed on its way is a sentence."""
    path = os.path.join(folder, 'damaged.html')
    isotet('export', ARTERY, path, '-f', 'Umag', '--as', 'grid')
    with open(path, encoding='utf-8') as file:
        page = file.read()
    for part in ('engine', 'grid', 'worker', 'saved'):
        at = page.index(f'id="{part}">') + len(f'id="{part}">')
        end = at + (page.index('</script>', at) - at) // 2
        for damaged in (page[:end] + page[page.index('</script>', at):], page[:end] + '"!"' + page[end:]):
            with open(path, 'w', encoding='utf-8') as file:
                file.write(damaged)
            browser.open('about:blank')
            browser.open('file://' + path)
            browser.wait('!document.getElementById("message").hidden')
            told = browser.value('document.getElementById("message").textContent')
            check('damaged on its way' in told, f'{part}: {told}')


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
