# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The page of `isotet page` in Chromium, opened from the disk: files are dropped into it, and read by isotet as WebAssembly."""
import json
import os
import sys
import tempfile

from chromium import Browser
from pages import check, choose, isotet, run_tests

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'data')
ARTERY = os.path.join(DATA, 'vtu', 'artery_flow_tet_wedge.vtu')
FOAM = os.path.join(DATA, '..', 'tests', 'corruption', 'samples', 'openfoam')
TETGEN = [os.path.join(DATA, 'tetgen', 'ellipsoid_16k' + ending) for ending in ('.node', '.ele')]


def start(browser, path):
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + path)
    browser.wait('document.getElementById("drop") !== null')


def drop(browser, files):
    x, y, width, height = browser.box('#stage')
    data = {'items': [], 'files': [os.path.abspath(file) for file in files], 'dragOperationsMask': 1}
    for kind in ('dragEnter', 'dragOver', 'drop'):
        browser.call('Input.dispatchDragEvent', type=kind, x=x + width / 2, y=y + height / 2, data=data)


def ready(browser, name):
    browser.wait(f'document.getElementById("file").textContent === {json.dumps(name)} && document.body.dataset.step === "ready"'
                 ' && Number(document.body.dataset.triangles) > 0 && document.body.dataset.preview === "false"', 60)


def ready_as_boundary(browser, name):
    """No field of the file varies."""
    browser.wait(f'document.getElementById("file").textContent === {json.dumps(name)} && document.body.dataset.step === "ready"'
                 ' && document.body.dataset.kinds === "boundary"', 60)


def check_triangles(browser, path):
    """Those that the program extracts at the page's value."""
    field, value = browser.value('[document.body.dataset.field, document.body.dataset.shown]')
    extracted = isotet('extract', path, '-f', field, '-i', value, '--method', 'clusters')['surfaces'][0]['triangles']
    shown = int(browser.value('document.body.dataset.triangles'))
    check(shown == extracted, f'{shown} triangles of {field} at {value}, but the program extracts {extracted}')


def sentence(browser):
    browser.wait('!document.getElementById("message").hidden')
    check(browser.value('!document.getElementById("drop").hidden'), 'another file may be chosen')
    return browser.value('document.getElementById("message").textContent')


def test_files_are_chosen_and_dropped(browser, path, folder):
    start(browser, path)
    choose(browser, [ARTERY])
    ready(browser, 'artery_flow_tet_wedge.vtu')
    check_triangles(browser, ARTERY)
    # Another grid in its place.
    drop(browser, TETGEN)
    ready_as_boundary(browser, 'ellipsoid_16k.node')
    browser.click('#isosurfaces')
    ready(browser, 'ellipsoid_16k.node')
    check_triangles(browser, TETGEN[0])
    check(browser.value('document.getElementById("drop").hidden'), 'the picture is not covered')


def test_folders_of_openfoam_are_dropped(browser, path, folder):
    """The case's folder, what is in it, and files without their folders."""
    files = [os.path.join(top, name) for top, _, names in os.walk(FOAM) for name in names]
    for dropped, name in [([FOAM], 'openfoam'), ([os.path.join(FOAM, one) for one in os.listdir(FOAM)], 'OpenFOAM case'), (files, 'OpenFOAM case')]:
        start(browser, path)
        drop(browser, dropped)
        ready(browser, name)
        check_triangles(browser, FOAM)
    start(browser, path)
    choose(browser, [FOAM], '#chosen-folder')
    ready(browser, 'openfoam')
    start(browser, path)
    drop(browser, [os.path.join(FOAM, '0')])
    browser.wait('!document.getElementById("message").hidden')
    check('no format' in sentence(browser), f'a folder without a grid is a sentence: {sentence(browser)}')


def test_broken_files_are_sentences(browser, path, folder):
    start(browser, path)
    with open(ARTERY, 'rb') as file:
        whole = file.read()
    for name, content, words in [('cut.vtu', whole[:100000], 'cut short'), ('empty.vtu', b'', 'empty'), ('notes.txt', b'nothing', 'no format'),
                                 ('run.e', b'CDF\x01num_nodes', 'reader')]:
        broken = os.path.join(folder, name)
        with open(broken, 'wb') as file:
            file.write(content)
        choose(browser, [broken])
        browser.wait(f'document.getElementById("message").textContent.includes({json.dumps(words)})')
        check(name in sentence(browser), f'the sentence names the file: {sentence(browser)}')
    # And then one that is whole.
    choose(browser, TETGEN)
    ready_as_boundary(browser, 'ellipsoid_16k.node')


def test_names_are_text(browser, path, folder):
    name = '<img src=x onerror=document.body.dataset.hacked=1>"\'&.vtu'
    hostile = os.path.join(folder, name)
    with open(ARTERY, 'rb') as file:
        content = file.read().replace(b'Name="Umag"', b'Name="&lt;b&gt;"')
    with open(hostile, 'wb') as file:
        file.write(content)
    start(browser, path)
    choose(browser, [hostile])
    ready(browser, name)
    check(browser.value('[...document.querySelectorAll("#field option")].some((one) => one.textContent === "<b>")'), 'a field is called so')
    check(browser.value('document.images.length === 0 && !document.body.dataset.hacked && !document.querySelector("#panel b")'), 'no name is HTML')


def test_small_screens_and_keys(browser, path, folder):
    browser.resize(360, 640)
    start(browser, path)
    x, _, width, _ = browser.box('#drop')
    check(x >= 0 and x + width <= 360, f'the invitation is inside: {x} to {x + width}')
    check(browser.value('document.documentElement.scrollWidth <= 360'), 'nothing is wider than the screen')
    for _ in range(12):
        browser.key('Tab')
        if browser.value('document.activeElement.textContent === "Choose files…"'):
            break
    check(browser.value('document.activeElement.textContent === "Choose files…"'), 'the Tab key leads to the button')
    browser.resize(1280, 720)


def test_large_files_show_progress(browser, path, folder):
    """100 MB: how far it is, then a surface while the grid is packed; another file that is chosen meanwhile comes in its place."""
    large = os.path.join(folder, 'large.vtu')
    isotet('make', 'kuhn', '--side', '88', '--fields', 'sphere', '-o', large)
    check(os.path.getsize(large) > 90e6, 'it is large')
    start(browser, path)
    browser.value('(() => { window.told = []; const bar = document.getElementById("progress-bar"); new MutationObserver(() => '
                  'document.getElementById("progress").hidden || told.push([document.getElementById("progress-text").textContent.split(",")[0], bar.value])).observe(bar, {attributes: true}); })()')
    choose(browser, [large])
    browser.wait('document.body.dataset.kinds && document.body.dataset.step === "ready"', 120)
    told = browser.value('told')
    for words in ('Reading', 'Packing'):
        parts = [part for step, part in told if step == words]
        check(len(set(parts)) > 5, f'{words}: {parts}')
    check({step for step, _ in told} <= {'Reading', 'Packing', 'Finding the boundary'}, f'steps are words: {told}')
    start(browser, path)
    choose(browser, [large])
    browser.wait('document.getElementById("progress-bar").value > 0')
    choose(browser, [ARTERY])
    ready(browser, 'artery_flow_tet_wedge.vtu')
    check_triangles(browser, ARTERY)
    os.remove(large)


def test_grids_too_large_are_sentences(browser, path, folder):
    """More than a page may have: of a header that the file does not keep, and of grids whose points and cells are not in the file."""
    start(browser, path)
    image = '<?xml version="1.0"?><VTKFile type="ImageData" version="1.0"><ImageData WholeExtent="{0}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{0}"/></ImageData></VTKFile>'
    array = '<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="ascii">0 0 0</DataArray>'
    cells = ''.join(array.format('Int64', name, 1) for name in ('connectivity', 'offsets', 'types'))
    grids = {'header.vtu': '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid><Piece NumberOfPoints="2000000000" '
                           f'NumberOfCells="2000000000"><Points>{array.format("Float64", "points", 3)}</Points><Cells>{cells}</Cells></Piece></UnstructuredGrid></VTKFile>',
             'image.vti': image.format('0 2000 0 2000 0 2000'), 'smaller.vti': image.format('0 600 0 600 0 600'),
             'image.vtk': '# vtk DataFile Version 3.0\nlarge\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1500 1500 1500\nORIGIN 0 0 0\nSPACING 1 1 1\n'}
    for name, content in grids.items():
        large = os.path.join(folder, name)
        with open(large, 'w', encoding='ascii') as file:
            file.write(content)
        choose(browser, [large])
        words = 'are announced' if name == 'header.vtu' else '4 GB'
        browser.wait(f'document.getElementById("message").textContent.includes({json.dumps(words)}) && !document.getElementById("drop").hidden', 60)
        # And then one that fits.
        choose(browser, TETGEN)
        ready_as_boundary(browser, 'ellipsoid_16k.node')


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-page-') as folder:
        path = os.path.join(folder, 'isotet.html')
        isotet('page', path)
        return run_tests([test for name, test in globals().items() if name.startswith('test_')], Browser(), path, folder)


sys.exit(main())
