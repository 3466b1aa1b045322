# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages of `isotet export` in Chromium, opened from the disk: real mouse and keys, values read back from the page."""
import json
import os
import shutil
import struct
import sys
import tempfile
import urllib.parse

from chromium import Browser
from pages import check, check_small_and_keys, isotet, run_tests

GRID = 'make:kuhn:16:sphere,gyroid'
STEPS = os.path.join(os.path.dirname(__file__), '../../data/exodus/tension_tets_stress_3steps.e')


def export(folder, name, *words):
    path = os.path.join(folder, name)
    return path, isotet('export', *words[:1], path, *words[1:])


def start(browser, path, extra=''):
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + urllib.parse.quote(path) + extra)
    browser.wait('document.body.dataset.shown !== undefined && document.body.dataset.shown !== ""')


def shown(browser):
    return float(browser.value('document.body.dataset.shown'))


def at_rest(browser):
    browser.wait('Number(document.getElementById("slider").getAttribute("aria-valuenow")) === Number(document.body.dataset.shown)')


def test_opens_from_the_disk(browser, folder):
    """With the triangles that the program extracts, at every isovalue that the slider stops at."""
    path, report = export(folder, 'ball.html', GRID, '-f', 'sphere', '--surfaces', '5')
    start(browser, path)
    check(browser.value('document.title') == f'{GRID} – isotet', 'the title names the grid')
    check(browser.value('document.body.dataset.kinds') == 'surface boundary', 'the boundary is there')
    check(len(report['isovalues']) == 5, 'as many as were asked for')
    for value in report['isovalues']:
        start(browser, path, f'#&f=sphere&i={value}')
        check(shown(browser) == value, f'{value} is shown')
        counted = isotet('extract', GRID, '-f', 'sphere', '-i', repr(value))['surfaces'][0]['triangles']
        check(int(browser.value('document.body.dataset.triangles')) == counted, f'{counted} triangles at {value}')
        check(int(browser.value('document.body.dataset.drawn')) == counted, 'all of them are drawn')


def test_drag(browser, folder):
    """The slider goes from one surface to the next, and back by the browser's history."""
    path, report = export(folder, 'drag.html', GRID, '-f', 'sphere', '--as', 'surfaces')
    start(browser, path)
    first = shown(browser)
    browser.value('window.seen = []; new MutationObserver(() => seen.push(Number(document.body.dataset.shown)))'
                  '.observe(document.body, {attributes: true, attributeFilter: ["data-shown"]})')
    x, y, w, h = browser.box('#slider')
    browser.drag((x + 0.3 * w, y + h / 2), (x + 0.6 * w, y + h / 2), steps=30)
    at_rest(browser)
    seen = browser.value('seen')
    check(abs(seen[-1] - 0.6 * 3 ** 0.5) < 0.03, f'the last value is that under the hand: {seen[-1]}')
    check(set(seen) <= set(report['isovalues']), 'the slider stops at values that there are')
    browser.value('history.back()')
    browser.wait(f'Number(document.body.dataset.shown) === {first}')
    browser.click('#slider')
    at_rest(browser)
    before = shown(browser)
    browser.key('ArrowRight')
    browser.wait(f'Number(document.body.dataset.shown) > {before}')
    at_rest(browser)
    values = report['isovalues']
    check(values.index(shown(browser)) == values.index(before) + 1, 'an arrow leads to the next surface')


def test_address(browser, folder):
    """What is shown stands behind the file's name, and is there again in another window."""
    path, report = export(folder, 'state.html', GRID, '-f', 'sphere', '--surfaces', '9', '--color-by', 'gyroid')
    start(browser, path)
    browser.click('#pin')
    browser.click('[data-view="top"]')
    browser.key('ArrowLeft')
    browser.click('#slider')
    at_rest(browser)
    before = shown(browser)
    browser.key('PageUp')
    browser.wait(f'Number(document.body.dataset.shown) > {before}')
    browser.wait('location.hash.includes("pin=") && document.body.dataset.kinds.startsWith("surface surface")')
    browser.wait('document.querySelectorAll("#surfaces li").length === 2')
    at_rest(browser)
    browser.wait('location.hash.includes("i=" + document.body.dataset.shown)')
    address, data = browser.value('location.hash'), browser.value('JSON.stringify([document.body.dataset.shown, '
                                                                  'document.body.dataset.triangles, document.body.dataset.camera])')
    start(browser, path, address)
    browser.wait('document.body.dataset.kinds.startsWith("surface surface")')
    again = browser.value('JSON.stringify([document.body.dataset.shown, document.body.dataset.triangles, document.body.dataset.camera])')
    check(again == data, f'{again} is {data}')


def test_colors(browser, folder):
    path, _ = export(folder, 'colors.html', GRID, '-f', 'sphere', '--surfaces', '3', '--color-by', 'gyroid')
    start(browser, path)
    check(browser.value('document.getElementById("color-by").value') == 'gyroid', 'colours are those that were asked for')
    names = browser.value('[...document.getElementById("color-by").options].map((one) => one.value)')
    check(names == ['', 'gyroid'], f'there are no others: {names}')
    check(browser.value('[...document.querySelectorAll("[data-needs=isotet]")].every((one) => one.hidden)'), 'nothing needs isotet')


def test_says_what_can_be_typed(browser, folder):
    """The page has surfaces alone: shares of volume or points cannot be found there, so none are proposed."""
    path, _ = export(folder, 'typed.html', GRID, '-f', 'sphere', '--surfaces', '3')
    start(browser, path)
    for text in ('half', '90%v'):
        browser.value('document.getElementById("value").select()')
        browser.type(text)
        browser.key('Enter')
        browser.wait('!document.getElementById("message").hidden')
        told = browser.value('document.getElementById("message").textContent')
        check('50 %' in told and '90%v' not in told, f'{text}: "{told}"')
        browser.key('Escape')


def test_begins_with_the_boundary(browser, folder):
    """Where only regions are known, the boundary shows them, each with a colour; isosurfaces can be chosen."""
    model = os.path.join(os.path.dirname(__file__), '../../data/gocad/geomodel3d_tsolid.so')
    path, _ = export(folder, 'regions.html', model, '--surfaces', '5')
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + urllib.parse.quote(path))
    regions = 'document.body.dataset.kinds === "boundary" && document.body.dataset.classes === "Region_2 Region_3 Region_1 h1_model1_1"'
    browser.wait(regions)
    check(browser.value('document.getElementById("shown").textContent') == 'Boundary shown', 'it is said')
    check(browser.value('document.getElementById("boundary").value') == '1', 'it is opaque')
    browser.click('#regions-list li:nth-child(2) input')
    browser.wait('document.body.dataset.hidden === "Region_3"')
    browser.click('#regions-all')
    browser.click('#isosurfaces')
    browser.wait('document.body.dataset.kinds === "surface boundary" && document.body.dataset.classes === ""')
    browser.click('#isosurfaces')
    browser.wait(regions)
    path, _ = export(folder, 'surfaces.html', model, '-f', 'tvolume', '--surfaces', '5')
    start(browser, path)
    check(browser.value('document.body.dataset.kinds') == 'surface boundary', 'a field that is named has isosurfaces')


def test_files(browser, folder):
    """Surfaces are written by the page itself."""
    path, report = export(folder, 'files.html', GRID, '-f', 'sphere', '-i', '0.5')
    start(browser, path)
    saved = os.path.join(folder, 'downloads')
    os.mkdir(saved)
    browser.downloads(saved)
    for kind, ending in [('surface.stl', 'stl'), ('surface.glb', 'glb'), ('seen.png', 'png')]:
        browser.click('#save-open')
        browser.value(f'(() => {{ const s = document.getElementById("save-kind"); s.value = "{kind}"; s.dispatchEvent(new Event("change")); }})()')
        browser.value(f'document.getElementById("save-name").value = "a.{ending}"')
        browser.click('#save-go')
        browser.wait('document.getElementById("save-told").textContent.startsWith("Downloaded")')
        browser.click('#save-close')
    files = {ending: browser.downloaded(os.path.join(saved, f'a.{ending}')) for ending in ('stl', 'glb', 'png')}
    check(struct.unpack('<I', files['stl'][80:84])[0] == report['triangles'], 'the STL has all triangles')
    check(len(files['stl']) == 84 + 50 * report['triangles'], 'and ends with them')
    magic, version, length, room, _ = struct.unpack('<5I', files['glb'][:20])
    scene = json.loads(files['glb'][20:20 + room])
    check((magic, version, length) == (0x46546C67, 2, len(files['glb'])), 'the GLB has its length')
    check(scene['accessors'][1]['count'] == 3 * report['triangles'], 'and all triangles')
    check(files['png'].startswith(b'\x89PNG'), 'the picture is one')
    checked = isotet('check', os.path.join(saved, 'a.stl'))
    check(checked['triangles'] == report['triangles'], 'isotet reads the STL')


def test_files_of_the_boundary(browser, folder):
    """What is shown is written: the boundary where it is shown alone."""
    model = os.path.join(os.path.dirname(__file__), '../../data/gocad/geomodel3d_tsolid.so')
    path, _ = export(folder, 'model.html', model, '--surfaces', '3')
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + urllib.parse.quote(path))
    browser.wait('document.body.dataset.kinds === "boundary"')
    saved = os.path.join(folder, 'boundaries')
    os.mkdir(saved)
    browser.downloads(saved)
    browser.click('#save-open')
    browser.value('(() => { const s = document.getElementById("save-kind"); s.value = "surface.stl"; s.dispatchEvent(new Event("change")); })()')
    browser.value('document.getElementById("save-name").value = "a.stl"')
    browser.click('#save-go')
    browser.wait('document.getElementById("save-told").textContent.startsWith("Downloaded")')
    told = browser.value('document.getElementById("facts").textContent')
    browser.downloaded(os.path.join(saved, 'a.stl'))
    written = isotet('check', os.path.join(saved, 'a.stl'))['triangles']
    check(f'{written:,} triangles' in told, f'{written} triangles were written: {told}')


def test_steps(browser, folder):
    path, report = export(folder, 'steps.html', STEPS, '-f', 'nodal_Cauchy_Stress_1', '--all-steps', '--surfaces', '3')
    check(report['steps'] == 3, 'all steps are there')
    start(browser, path)
    check(not browser.value('document.getElementById("time").hidden'), 'they can be chosen')
    browser.key('.')
    browser.wait('document.body.dataset.step_shown === "1"')
    browser.wait('location.hash.includes("step=1")')


def test_hostile_names(browser, folder):
    """Names of files and fields are text, wherever they stand."""
    name = '<img src=x onerror=alert(1)> "\'&\u202e\u05d0\u2028\U0001f600.vtk'
    grid = os.path.join(folder, name)
    shutil.copy(os.path.join(folder, 'hostile.vtk'), grid)
    path, _ = export(folder, '<b>&.html', grid, '--surfaces', '2')
    start(browser, path)
    check(browser.value('document.getElementById("file").textContent') == name, 'the name of the file is text')
    check(browser.value('document.querySelectorAll("img, script[src], iframe, link[rel=stylesheet]").length') == 0, 'it is no element')
    field = browser.value('document.getElementById("field").value')
    check(field == '</script><script>document.title=1</script>', f'so is that of a field: {field}')
    check(browser.value('document.title') == f'{name} – isotet', 'no script of it ran')


def write_hostile_grid(folder):
    """One tet; VTK's legacy format codes blanks of names as %20 and so on."""
    field = '</script><script>document.title=1</script>'
    with open(os.path.join(folder, 'hostile.vtk'), 'w') as file:
        file.write('# vtk DataFile Version 3.0\nhostile\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n'
                   f'CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS {field} float\nLOOKUP_TABLE default\n0 1 2 3\n')


def test_a_broken_file_is_told(browser, folder):
    """A part that was damaged on its way is a sentence, and the page goes on."""
    path, _ = export(folder, 'whole.html', GRID, '-f', 'sphere', '-i', '0.4,0.6')
    with open(path) as file:
        text = file.read()
    mark = 'id="surface-1">'
    at = text.index(mark) + len(mark) + 400
    broken = os.path.join(folder, 'broken.html')
    with open(broken, 'w') as file:
        file.write(text[:at] + ('AAAA' if text[at:at + 4] != 'AAAA' else 'BBBB') + text[at + 4:])
    start(browser, broken, '#&f=sphere&i=0.4')
    browser.click('#slider')
    browser.key('End')
    browser.wait('document.getElementById("message").textContent.includes("cannot be shown")')
    check(shown(browser) == 0.4, 'the last surface stays')
    browser.key('Home')
    browser.wait('Number(document.getElementById("slider").getAttribute("aria-valuenow")) === 0.4')


def test_narrow(browser, folder):
    """A phone."""
    path, _ = export(folder, 'narrow.html', GRID, '-f', 'sphere', '--surfaces', '15', '--color-by', 'gyroid')
    browser.resize(360, 740, 2)
    try:
        start(browser, path)
        x, y, w, h = browser.box('#slider')
        check(x >= 0 and x + w <= 360 and y + h < 740, 'the slider is on the screen')
        check_small_and_keys(browser)
    finally:
        browser.resize(1280, 720)


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-export-') as folder:
        write_hostile_grid(folder)
        return run_tests([test for name, test in globals().items() if name.startswith('test_')], Browser(), folder)


sys.exit(main())
