# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of `isotet export --as grid` by WebGPU, on Chromium's software adapter, and without it."""
import json
import os
import subprocess
import sys
import tempfile

from chromium import Browser

GRID = 'make:kuhn:12:sphere,gyroid'


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def isotet(*words):
    """The JSON of a command."""
    run = subprocess.run([os.environ['ISOTET_PROGRAM'], *words, '--json', '-', '--quiet'], capture_output=True, text=True)
    check(run.returncode == 0, f'{words}: {run.stderr}')
    return json.loads(run.stdout)


def show(browser, value, pinned=()):
    browser.value('document.getElementById("value").select()')
    browser.value('document.getElementById("value").focus()')
    browser.type(value)
    browser.key('Enter')
    browser.wait(f'Number(document.body.dataset.shown) === {value} && document.body.dataset.preview === "false"', 60)
    counted = sum(isotet('extract', GRID, '-f', 'sphere', '-i', one, '--method', 'clusters')['surfaces'][0]['triangles'] for one in (value, *pinned))
    shown = int(browser.value('document.body.dataset.triangles'))
    check(shown == counted, f'{counted} triangles at {value}, {shown} shown')


def start(browser, path, search=''):
    browser.errors.clear()
    browser.call('Page.navigate', url='about:blank')
    browser.open(f'file://{path}{search}')
    browser.wait('document.body.dataset.card !== undefined && document.body.dataset.shown', 60)


def report_of(browser):
    browser.click('#help-open')
    told = browser.value('document.getElementById("device-told").textContent')
    browser.click('#report')
    browser.wait('document.body.dataset.report !== undefined', 120)
    browser.click('#help-close')
    return told, json.loads(browser.value('document.body.dataset.report'))


def test_card(browser, path):
    """Surfaces that move, two at once, and a report with the times of both engines."""
    start(browser, path, '?card=any')
    check(browser.value('document.body.dataset.card') == 'webgpu', 'the card is used')
    for value in ('0.5', '0.8123'):
        show(browser, value)
    browser.click('#pin')
    show(browser, '1.1', ['0.8123'])
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 2, 'both are shown')
    told, report = report_of(browser)
    check('graphics card makes isosurfaces' in told and 'swiftshader' in told, told)
    check(report['webgpu']['architecture'] == 'swiftshader' and len(report['surfaces']) == 5, f'{report}')
    check(all(one['webgpu_ms'] > 0 and one['wasm_ms'] > 0 and one['triangles'] > 0 for one in report['surfaces']), f'{report}')
    check('sphere' not in json.dumps(report), 'no names of fields are told')


def test_without(browser, path):
    for search, why in (('', 'has no graphics card'), ('?card=off', 'off')):
        browser.errors.clear()
        browser.call('Page.navigate', url='about:blank')
        browser.open(f'file://{path}{search}')
        browser.wait('document.body.dataset.shown', 60)
        show(browser, '0.7')
        if search == '':
            browser.wait('document.body.dataset.card === "none"')
            told, report = report_of(browser)
            check(f'The processor makes isosurfaces: WebGPU {why}' in told, told)
            check(report['webgpu'] is None and report['surfaces'] == [], f'{report}')
        else:
            check(browser.value('document.body.dataset.card') is None, 'no card is asked for')


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-export-') as folder:
        path = os.path.join(folder, 'grid.html')
        isotet('export', GRID, path, '--as', 'grid')
        browser = Browser(words=['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'])
        try:
            for test in (test_card, test_without):
                test(browser, path)
                check(not browser.errors, f'errors of the page: {browser.errors}')
                print('ok', test.__name__, flush=True)
        finally:
            browser.close()


main()
