# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of `isotet export --as grid` in Chromium, opened from the disk: isotet as WebAssembly answers."""
import html
import json
import os
import subprocess
import sys
import tempfile

from chromium import Browser
from pages import check, check_small_and_keys, isotet, run_tests

GRID = 'make:kuhn:16:sphere,gyroid'
DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../data')


def start(browser, path, extra=''):
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + path + extra)
    browser.wait('document.body.dataset.shown !== undefined && document.body.dataset.shown !== ""', 60)


def triangles(browser):
    return int(browser.value('document.body.dataset.triangles'))


def type_value(browser, text):
    browser.value('document.getElementById("value").select()')
    browser.value('document.getElementById("value").focus()')
    browser.type(text)
    browser.key('Enter')
    browser.wait(f'Number(document.body.dataset.shown) === {text} && document.body.dataset.preview === "false"')


def test_any_isovalue(browser, path):
    """With the triangles that the program extracts."""
    start(browser, path)
    for value in ('0.5', '0.8123', '1.2'):
        type_value(browser, value)
        counted = isotet('extract', GRID, '-f', 'sphere', '-i', value, '--method', 'clusters')['surfaces'][0]['triangles']
        check(triangles(browser) == counted, f'{counted} triangles at {value}, {triangles(browser)} shown')


def test_drag(browser, path):
    start(browser, path)
    x, y, w, h = browser.box('#slider')
    browser.drag((x + 0.3 * w, y + h / 2), (x + 0.6 * w, y + h / 2), steps=20)
    browser.wait('document.body.dataset.preview === "false" && Number(document.getElementById("slider")'
                 '.getAttribute("aria-valuenow")) === Number(document.body.dataset.shown)')
    check(abs(float(browser.value('document.body.dataset.shown')) - 0.6 * 3 ** 0.5) < 0.02, 'the value under the hand is shown')


def test_first_picture_is_rough(browser, path):
    """And the one at rest has all pixels."""
    watch = browser.call('Page.addScriptToEvaluateOnNewDocument', source='''addEventListener('DOMContentLoaded', () => new MutationObserver(() => {
      window.first ??= document.getElementById('scene').width;
    }).observe(document.body, {attributes: true, attributeFilter: ['data-shown']}));''')
    start(browser, path)
    browser.call('Page.removeScriptToEvaluateOnNewDocument', **watch)
    whole = browser.value('document.getElementById("scene").clientWidth')
    check(browser.value('window.first') < 0.6 * whole, 'half the pixels each way')
    browser.wait(f'document.getElementById("scene").width === {whole}')


def test_fields_colours_slices(browser, path):
    start(browser, path, '#&f=gyroid&i=0.1&by=sphere&slice=0,0,1,0.2')
    browser.wait('document.body.dataset.field === "gyroid" && document.body.dataset.kinds.includes("slice")')
    check(triangles(browser) == isotet('extract', GRID, '-f', 'gyroid', '-i', '0.1')['surfaces'][0]['triangles'], 'of another field')
    browser.wait('document.body.dataset.spectrum === "gyroid"')
    check('Area' in browser.value('document.getElementById("measures").textContent'), 'area and volume come')


def test_values_at_a_point(browser, path):
    start(browser, path, '#&f=sphere&i=0.5')
    x, y, w, h = browser.box('#scene')
    browser.drag((x + w / 2, y + h / 2), (x + w / 2, y + h / 2), steps=1)
    browser.wait('document.body.dataset.picked !== undefined')
    picked = json.loads(browser.value('document.body.dataset.picked'))
    values = {one['name']: one['values'][0] for one in picked['values']}
    check(abs(values['sphere'] - 0.5) < 1e-5, f'the value there is the isovalue: {values}')
    check('gyroid' in values, 'the other field is told')


def test_in_a_frame(browser, path):
    """As notebooks show it: a document without an address."""
    with open(path, encoding='utf-8') as file:
        page = html.escape(file.read())
    outer = path.replace('grid.html', 'outer.html')
    with open(outer, 'w', encoding='utf-8') as file:
        file.write(f'<!doctype html><title>A notebook</title><iframe srcdoc="{page}" width="900" height="600"></iframe>')
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + outer)
    inside = 'document.querySelector("iframe").contentDocument.body'
    browser.wait(f'{inside} && Number({inside}.dataset.triangles) > 0', 60)
    browser.value(f'{inside}.querySelector("#pin").click()')
    browser.wait(f'{inside}.querySelectorAll("#surfaces li").length === 2')


def test_fields_that_fit(browser, path):
    """As many of the fields as there is room for; those that were named stay."""
    small, fields = path.replace('grid.html', 'small.html'), 'make:kuhn:16:sphere,gyroid,integer,torus'
    sizes = [isotet('export', fields, small, '--as', 'grid', '-f', 'sphere', *more)['bytes'] for more in ([], ['--color-by', 'torus'])]
    room = ['--max-size', str(sizes[1] + 1000)]
    report = isotet('export', fields, small, '--as', 'grid', '--color-by', 'sphere', *room)
    check(report['fields'] == ['torus', 'sphere'] and report['left_out'] == 2, f'the first field and that of the colours: {report}')
    check(report['bytes'] <= sizes[1] + 1000 and any('2 of 4 fields' in note for note in report['notes']), f'it says so: {report}')
    start(browser, small)
    check(browser.value('document.body.dataset.field') == 'torus', 'the page begins with that of isotet view')
    artery = os.path.join(DATA, 'vtu/artery_flow_tet_wedge.vtu')
    words = ['export', artery, small, '--as', 'grid', '-f', 'Umag', '--color-by', 'p', '--max-size']
    room = isotet(*words, '20MB')['bytes'] - 40000
    report = isotet(*words, str(room))
    check(report['bytes'] <= room and any('16 bits' in note for note in report['notes']), f'values are rounded, and it is told: {report}')
    ranges = [field['range'][0][1] - field['range'][0][0] for name in ('Umag', 'p') for field in isotet('info', artery)['fields'] if field['name'] == name]
    check(all(0 < change <= size / 2 ** 16 for change, size in zip(report['rounded_by'], ranges)), f'{report}')
    for words in (['--max-size', str(sizes[0] // 2)], ['-f', 'sphere', '--color-by', 'torus', '--max-size', str(sizes[0] // 2)]):
        refused = subprocess.run([os.environ['ISOTET_PROGRAM'], 'export', fields, small, '--as', 'grid', *words], capture_output=True, text=True)
        check(refused.returncode == 2 and '--max-size' in refused.stderr, f'{words}: {refused.stderr}')


def test_chooses_what_fits(browser, path):
    """The grid, unless it is too large, or certain isosurfaces are asked for, or regions are seen first."""
    page, model = path.replace('grid.html', 'chosen.html'), os.path.join(DATA, 'gocad/geomodel3d_tsolid.so')
    for words, kind, told in [([GRID], 'grid', 'has the grid'), ([GRID, '--max-size', '500kB'], 'surfaces', 'in place of the grid'),
                              ([GRID, '--surfaces', '2'], 'surfaces', ''), ([GRID, '-i', '0.5'], 'surfaces', ''),
                              ([GRID, '--between', '0.3,0.5'], 'surfaces', ''), ([model], 'surfaces', 'colours the boundary'),
                              (['make:tet10:4:sphere'], 'surfaces', 'curved cells are refined')]:
        report = isotet('export', words[0], page, *words[1:])
        check(report['kind'] == kind and any(told in note for note in report['notes'] + ['']), f'{words}: {report["kind"]}, {report["notes"]}')
    report = isotet('export', 'make:tet10:4:sphere', page, '--as', 'grid')
    check(any('curved cells are split at their nodes' in note for note in report['notes']), f'{report["notes"]}')
    for words in ([], ['--as', 'grid'], ['-f', 'sphere']):
        refused = subprocess.run([os.environ['ISOTET_PROGRAM'], 'export', GRID, page, '--color-by', 'typo', *words], capture_output=True, text=True)
        check(refused.returncode == 2 and "'typo'" in refused.stderr, f'{words}: {refused.stderr}')


def test_begins_as_the_viewer_does(browser, path):
    """Where regions are all that is known, with the boundary; with isosurfaces where a value is named."""
    page, model = path.replace('grid.html', 'model.html'), os.path.join(DATA, 'gocad/geomodel3d_tsolid.so')
    isotet('export', model, page, '--as', 'grid')
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + page)
    browser.wait('document.body.dataset.kinds === "boundary" && document.getElementById("shown").textContent === "Boundary shown"')
    browser.click('#isosurfaces')
    browser.wait('document.body.dataset.kinds === "surface boundary"')
    isotet('export', model, page, '--as', 'grid', '-i', '1.5')
    start(browser, page)
    check(browser.value('document.body.dataset.kinds') == 'surface boundary', 'the value that was named is shown')


def test_solids(browser, path):
    start(browser, path)
    type_value(browser, '0.6')
    for side in ('above', 'below'):
        before = triangles(browser)
        browser.value(f'(() => {{ const s = document.getElementById("solid"); s.value = "{side}"; s.dispatchEvent(new Event("change")); }})()')
        browser.wait(f'Number(document.body.dataset.triangles) !== {before}')
        counted = isotet('extract', GRID, '-f', 'sphere', '-i', '0.6', '--solid', side)['surfaces'][0]['triangles']
        check(triangles(browser) == counted, f'{counted} triangles of the solid {side}, {triangles(browser)} shown')
    check(browser.box('#solid')[2] > 0, 'they can be chosen')


def test_inside_other_pages(browser, path):
    """Notebooks and documents hold the page as text of a frame, and their policies hold for it, too."""
    with open(path, encoding='utf-8') as file:
        frame = f'<iframe srcdoc="{html.escape(file.read())}" style="width: 100%; height: 600px"></iframe>'
    here = "'self' 'unsafe-inline'"
    vs_code = f"default-src 'none'; script-src {here} 'unsafe-eval'; style-src {here}; img-src https: data:; connect-src https:; child-src https: data:"
    for policy, error in ((f"script-src {here} 'unsafe-eval'; worker-src blob:", None), (vs_code, None),
                          (f"script-src {here} 'unsafe-eval'; worker-src 'none'", 'lets no thread begin')):
        with tempfile.NamedTemporaryFile('w', suffix='.html', encoding='utf-8') as other:
            other.write(f'<!doctype html><meta charset="utf-8"><meta http-equiv="Content-Security-Policy" content="{policy}">{frame}')
            other.flush()
            browser.call('Page.navigate', url='about:blank')
            browser.open('file://' + other.name)
            inside = 'document.querySelector("iframe").contentDocument'
            if error:
                browser.wait(f'{inside}.getElementById("message").textContent.includes("{error}")', 60)
            else:
                browser.wait(f'Number({inside}.body.dataset.triangles) > 0', 60)
        browser.errors.clear()  # that it forbids addresses


def test_files_of_what_is_shown(browser, path):
    """Surfaces; the boundary where it is shown alone; a sentence where nothing is."""
    with tempfile.TemporaryDirectory(prefix='isotet-saved-') as folder:
        browser.downloads(folder)

        def save(name):
            browser.click('#save-open')
            browser.value('(() => { const s = document.getElementById("save-kind"); s.value = "surface.stl"; s.dispatchEvent(new Event("change")); })()')
            browser.value(f'document.getElementById("save-name").value = "{name}"')
            browser.click('#save-go')
            browser.wait('document.getElementById("save-told").textContent !== "" && !document.getElementById("save-told").textContent.startsWith("Writing")')
            told = browser.value('document.getElementById("save-told").textContent')
            browser.click('#save-close')
            if not told.startswith('Downloaded'):
                return told
            file = os.path.join(folder, name)
            browser.downloaded(file)
            return isotet('check', file)['triangles']

        start(browser, path)
        browser.wait('document.body.dataset.kinds === "surface boundary"')
        check(save('surface.stl') == triangles(browser), 'the isosurface')
        browser.value('document.getElementById("isosurfaces").click()')
        browser.wait('document.body.dataset.kinds === "boundary"')
        check(save('boundary.stl') == 6 * 2 * 16 ** 2, 'the boundary')
        browser.value('(() => { const b = document.getElementById("boundary"); b.value = "0"; b.dispatchEvent(new Event("input")); b.dispatchEvent(new Event("change")); })()')
        browser.wait('document.body.dataset.kinds === ""')
        check('Nothing is shown' in save('nothing.stl'), 'nothing is a sentence')


def test_heights_of_flat_reservoirs(browser, path):
    """As isotet view begins with them."""
    flat, page = path.replace('grid.html', 'flat.grdecl'), path.replace('grid.html', 'flat.html')
    with open(flat, 'w', encoding='ascii') as file:
        file.write('SPECGRID\n 2 1 1 1 F /\nCOORD\n 0 0 100 0 0 200  1000 0 100 1000 0 200  2000 0 100 2000 0 200\n'
                   ' 0 1000 100 0 1000 200  1000 1000 100 1000 1000 200  2000 1000 100 2000 1000 200 /\n'
                   'ZCORN\n 8*100 8*110 /\nPORO\n 0.1 0.2 /\n')
    isotet('export', flat, page, '--as', 'grid', '-f', 'PORO')
    with open(page, encoding='utf-8') as file:
        check('"stretch":[1.0,1.0,50.0]' in file.read(), 'the page begins with heights 50 times as large')
    start(browser, page)


def test_small_screens_and_keys(browser, path):
    browser.resize(360, 740, 2)
    try:
        start(browser, path, '#&f=sphere&i=0.5&by=gyroid&slice=0,0,1,0.2')
        check_small_and_keys(browser)
    finally:
        browser.resize(1280, 720)


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-export-') as folder:
        path = os.path.join(folder, 'grid.html')
        report = isotet('export', GRID, path, '--as', 'grid')
        check(report['fields'] == ['sphere', 'gyroid'], 'all fields are in the page')
        return run_tests([test for name, test in globals().items() if name.startswith('test_')], Browser(), path)


sys.exit(main())
