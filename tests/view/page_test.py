# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The page of `isotet view` in Chromium: real mouse and keys, values read back from the page."""
import json
import os
import shlex
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import zlib

from chromium import Browser, Viewer

GRID = 'make:kuhn:16:sphere,gyroid'
SHIFT = 8
STEPS = os.path.join(os.path.dirname(__file__), '../../data/exodus/tension_tets_stress_3steps.e')
pictures = os.environ.get('ISOTET_TEST_PICTURES')  # a folder for the screenshots; without it they are not kept


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def shown(browser):
    return float(browser.value('document.body.dataset.shown'))


def start(browser, viewer, extra=''):
    """A page with its first surface in full."""
    browser.call('Page.navigate', url='about:blank')
    browser.open(viewer.address + extra)
    browser.wait('document.body.dataset.shown !== undefined && document.body.dataset.preview === "false"')
    browser.wait('document.body.dataset.step === "ready"')


def at_rest(browser, value=None):
    """The surface of the value that the page asks for is on the screen, in full."""
    if value is not None:
        browser.wait(f'Number(document.body.dataset.shown) === {value}')
    browser.wait('document.body.dataset.preview === "false" && Number(document.getElementById("slider")'
                 '.getAttribute("aria-valuenow")) === Number(document.body.dataset.shown)')


def pixels(data):
    """Width, height and rows of RGB bytes of a PNG as Chromium writes it."""
    at, packed, width, height, channels = 8, b'', 0, 0, 3
    while at < len(data):
        length, kind = struct.unpack('>I4s', data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b'IHDR':
            width, height, _, color = struct.unpack('>IIBB', body[:10])
            channels = {2: 3, 6: 4}[color]
        if kind == b'IDAT':
            packed += body
        at += length + 12
    raw, rows, before = zlib.decompress(packed), [], bytes(width * channels)
    for y in range(height):
        kind, *line = raw[y * (width * channels + 1):(y + 1) * (width * channels + 1)]
        for x, value in enumerate(line):
            left = line[x - channels] if x >= channels else 0
            corner = before[x - channels] if x >= channels else 0
            if kind == 1:
                value += left
            elif kind == 2:
                value += before[x]
            elif kind == 3:
                value += (left + before[x]) // 2
            elif kind == 4:
                guess = left + before[x] - corner
                value += min((left, before[x], corner), key=lambda near: abs(guess - near))
            line[x] = value & 255
        before = bytes(line)
        rows.append(before if channels == 3 else bytes(b for i, b in enumerate(before) if i % 4 != 3))
    return width, height, rows


def share_of_surface(browser):
    """Part of the picture's pixels that are not background: every fourth each way, without the axes."""
    ratio = browser.value('devicePixelRatio')
    x, y, w, h = (int(v * ratio) for v in browser.box('#scene'))
    _, _, rows = pixels(browser.picture())
    back = rows[y + 4][3 * (x + w - 8):3 * (x + w - 8) + 3]
    inside = [rows[j][3 * i:3 * i + 3] != back for j in range(y, y + int(0.85 * h), 4) for i in range(x + 4, x + w - 4, 4)]
    return sum(inside) / len(inside)


def test_first_surface(browser, viewer):
    start(browser, viewer, '&labels=0')
    check(0.6 < shown(browser) < 1.3, 'the first value is one with a large surface')
    check(int(browser.value('document.body.dataset.triangles')) > 1000, 'triangles are there')
    check(0.1 < share_of_surface(browser) < 0.7, 'the surface is in the picture')


def test_isovalues_outside(browser, viewer):
    """A decimal comma gives two isovalues, one of them outside the range: it is said."""
    with Viewer(GRID, '-i', '0,9') as other:
        start(browser, other)
        browser.wait('document.getElementById("notes-list").textContent.includes("did you mean 0.9?")')
        check("9 is outside the range of 'sphere', 0 to 1.73" in browser.value('document.getElementById("notes-list").textContent'), 'the range is told')
        browser.call('Page.navigate', url='about:blank')


def test_boundary_alone(browser, viewer):
    """Where only regions are known, the boundary shows them, each with a colour; the slider brings isosurfaces."""
    with Viewer(os.path.join(os.path.dirname(__file__), '../../data/gocad/geomodel3d_tsolid.so')) as other:
        start(browser, other, '&labels=0')
        browser.wait('document.body.dataset.kinds === "boundary"')
        browser.wait('document.body.dataset.classes.split(" ").length === 4')
        check(browser.value('document.getElementById("shown").textContent') == 'Boundary shown', 'it is said')
        check(browser.value('document.getElementById("boundary").value') == '1', 'it is opaque')
        check(not browser.value('document.getElementById("isosurfaces").checked'), 'there are no isosurfaces')
        x, y, w, h = (int(v) for v in browser.box('#scene'))
        _, _, rows = pixels(browser.picture())
        seen = [rows[j][3 * i:3 * i + 3] for j in range(y, y + int(0.85 * h), 4) for i in range(x + 4, x + w - 4, 4)]
        for name, fits in (('red', lambda r, g, b: r > g + 60 and r > b + 60), ('green', lambda r, g, b: g > r + 40 and g > b + 40),
                           ('blue', lambda r, g, b: b > r + 40)):
            check(any(fits(*one) for one in seen), f'a region is {name}')
        def red():
            x, y, w, h = (int(v) for v in browser.box('#scene'))
            _, _, rows = pixels(browser.picture())
            seen = [rows[j][3 * i:3 * i + 3] for j in range(y, y + int(0.85 * h), 4) for i in range(x + 4, x + w - 4, 4)]
            return sum(r > g + 60 and r > b + 60 for r, g, b in seen)

        all_red = red()
        check(browser.value('[...document.querySelectorAll("#regions-list span:last-child")].map(one => one.textContent).join()') ==
              'Region_2,Region_3,Region_1,h1_model1_1', 'regions are listed by name')
        browser.click('#regions-list li:nth-child(2) input')
        browser.wait('location.hash.includes("hidden=Region_3")')
        browser.value('new Promise(requestAnimationFrame)')
        check(red() == 0 < all_red, f'the region of this colour is hidden: {red()} of {all_red} pixels')
        browser.click('#copy-render')
        browser.wait('document.getElementById("copied").textContent.includes("\'!tvolume=Region_3\'")')
        browser.click('#regions-list li:nth-child(2) button')
        browser.wait('document.body.dataset.hidden === "Region_2 Region_1 h1_model1_1"')
        browser.value('history.back()')
        browser.wait('document.body.dataset.hidden === "Region_3" && !document.querySelector("#regions-list li:nth-child(2) input").checked')
        browser.click('#regions-all')
        browser.wait('!location.hash.includes("hidden=")')
        for region in range(1, 5):
            browser.click(f'#regions-list li:nth-child({region}) input')
        browser.wait('document.body.dataset.kinds === ""')
        check(browser.value('document.getElementById("message").hidden'), 'nothing is shown where all are hidden, and nothing is wrong')
        browser.value('new Promise(requestAnimationFrame)')
        check(red() == 0, 'nothing is seen')
        browser.click('#regions-all')
        browser.wait('!location.hash.includes("hidden=") && document.body.dataset.kinds === "boundary"')
        browser.value('new Promise(requestAnimationFrame)')
        check(red() > 0.9 * all_red, 'all are shown again')
        places = []
        for drawn in ('', 'server'):
            choose(browser, '#drawn-by', drawn)
            browser.wait(f'document.body.dataset.picture === "{drawn and "image/png"}"')
            browser.wait('document.body.dataset.step === "ready"')
            browser.value('document.activeElement.blur()')
            browser.key('v')
            browser.wait('document.body.dataset.picked')
            picked = json.loads(browser.value('document.body.dataset.picked'))
            check(browser.value('document.getElementById("picked-title").textContent') == 'On the boundary', 'a click tells the values there')
            values = {one['name']: one['values'][0] for one in picked['values']}
            check(values['tvolume'] in (0, 1, 2, 3) and picked['cell'] >= 0, f'of the cell: {picked}')
            places.append(picked['point'])
            browser.key('Escape')
        check(max(abs(a - b) for a, b in zip(*places)) < 5, f'both ways the same point: {places}')
        choose(browser, '#drawn-by', '')
        browser.wait('document.body.dataset.picture === "" && document.body.dataset.kinds === "boundary"')
        browser.value('document.getElementById("slider").focus()')
        browser.key('ArrowRight')
        at_rest(browser)
        browser.wait('document.body.dataset.kinds === "surface boundary"')
        check(browser.value('document.getElementById("boundary").value') == '0.1', 'the boundary hides no isosurface')
        check(int(browser.value('document.body.dataset.triangles')) > 0, 'there is one')
        browser.click('#isosurfaces')
        browser.wait('document.body.dataset.kinds === "boundary" && document.body.dataset.classes !== ""')
        browser.wait('location.hash.includes("isosurfaces=0") && location.hash.includes("colored=1")')
        browser.value('document.getElementById("drawn-by").value = "server"; document.getElementById("drawn-by").dispatchEvent(new Event("change"))')
        browser.wait('document.body.dataset.picture === "image/png"')
        check(len(browser.value('document.body.dataset.classes').split()) == 4, 'pictures of the server have the same classes')
        browser.call('Page.navigate', url='about:blank')


def test_blocks_by_name(browser, viewer):
    """A file with blocks and no field of them: they colour, and each can be hidden by its name; commands know them, too."""
    names = ['rotor', 'hub']
    with tempfile.TemporaryDirectory() as folder:
        for at, name in enumerate(names):
            corners = [(at + x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
            array = lambda of, values: f'<DataArray {of} format="ascii">{" ".join(map(str, values))}</DataArray>'
            with open(f'{folder}/{name}.vtu', 'w', encoding='ascii') as file:
                file.write('<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="1"><PointData>' +
                           array('type="Float32" Name="p"', [x + y for x, y, _ in corners]) + '</PointData><Points>' +
                           array('type="Float32" NumberOfComponents="3"', sum(corners, ())) + '</Points><Cells>' + array('type="Int32" Name="connectivity"', range(8)) +
                           array('type="Int32" Name="offsets"', [8]) + array('type="UInt8" Name="types"', [12]) + '</Cells></Piece></UnstructuredGrid></VTKFile>')
        with open(f'{folder}/both.vtm', 'w', encoding='ascii') as file:
            file.write('<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>' +
                       ''.join(f'<DataSet index="{i}" name="{name}" file="{name}.vtu"/>' for i, name in enumerate(names)) +
                       '</vtkMultiBlockDataSet></VTKFile>')
        with Viewer(f'{folder}/both.vtm') as other:
            start(browser, other, '&f=p&i=0.7&labels=0')
            choose(browser, '#color-by', 'block')
            browser.wait('document.body.dataset.classes === "rotor hub"')
            browser.click('#isosurfaces')
            browser.wait('document.body.dataset.kinds === "boundary"')
            before = browser.value('document.body.dataset.frame')
            browser.click('#regions-list li:nth-child(1) input')
            browser.wait('location.hash.includes("hidden=rotor") && document.body.dataset.hidden === "rotor"')
            browser.wait(f'Number(document.body.dataset.frame) > {before} && document.body.dataset.preview === "false"')
            browser.value('new Promise(done => setTimeout(done, 500))')
            browser.value('document.activeElement.blur()')
            browser.key('v')
            browser.wait('document.body.dataset.picked')
            values = {one['name']: one['values'][0] for one in json.loads(browser.value('document.body.dataset.picked'))['values']}
            check(values['block'] == 2, f'the cell is of the other block: {values}')
            browser.click('#copy-render')
            browser.wait('document.getElementById("copied").textContent.includes("--boundary-color-by block")')
            words = shlex.split(browser.value('document.getElementById("copied").textContent'))
            subprocess.run([os.environ['ISOTET_PROGRAM'], *words[1:-1], f'{folder}/p.png', '--size', '80x60', '-q'], check=True)
            browser.call('Page.navigate', url='about:blank')


def test_drag(browser, viewer):
    """The surface follows the hand: values between the ends are shown while it moves, the last one at the end."""
    start(browser, viewer)
    browser.value('window.seen = []; new MutationObserver(() => seen.push(Number(document.body.dataset.shown)))'
                  '.observe(document.body, {attributes: true, attributeFilter: ["data-shown"]})')
    x, y, w, h = browser.box('#slider')
    browser.drag((x + 0.3 * w, y + h / 2), (x + 0.6 * w, y + h / 2), steps=30)
    at_rest(browser)
    seen = browser.value('seen')
    check(abs(seen[-1] - 0.6 * 3 ** 0.5) < 0.01, f'the last value is that under the hand: {seen[-1]}')
    check(any(0.55 < value < 1.0 for value in seen[:-1]), f'values on the way are shown: {seen}')
    moving = [value for value in seen if value != seen[0]]  # the first jump is down to where the hand begins
    check(moving == sorted(moving), f'no value of the past comes late: {seen}')


def type_into(browser, box, text):
    """Replaces the text of a box."""
    browser.value(f'document.getElementById("{box}").select()')
    browser.type(text)
    browser.key('Enter')


def test_type(browser, viewer):
    start(browser, viewer)
    browser.click('#value')
    browser.value('document.getElementById("value").select()')
    browser.type('0.5')
    before = shown(browser)
    check(before != 0.5, 'nothing happens before Enter')
    browser.key('Enter')
    at_rest(browser, 0.5)
    type_into(browser, 'value', 'half')
    browser.wait('document.getElementById("value").getAttribute("aria-invalid") === "true"')
    check('number' in browser.value('document.getElementById("message").textContent'), 'the rule is told')
    check(shown(browser) == 0.5, 'the last surface stays')
    for text in ('0.6', 'half'):
        type_into(browser, 'value', text)
    at_rest(browser, 0.6)
    check('number' in browser.value('document.getElementById("message").textContent'),
          'a surface that was on its way does not wipe the rule out')
    type_into(browser, 'value', '0.7')
    at_rest(browser, 0.7)
    check(browser.value('document.getElementById("message").hidden'), 'what is right wipes it out')


def test_the_box_follows_unless_it_is_typed_in(browser, viewer):
    """It has the focus all the time. Numbers have few digits there; Enter alone changes nothing."""
    box = lambda: browser.value('document.getElementById("value").value')
    start(browser, viewer, '&f=sphere&i=0.5')
    at_rest(browser, 0.5)
    browser.click('#value')
    for text in ('0.3', '0.25'):
        type_into(browser, 'value', text)
        at_rest(browser, float(text))
    browser.value('history.back()')
    at_rest(browser, 0.3)
    check(box() == '0.3', f'Back is shown in it: {box()}')
    browser.value('document.getElementById("value").select()')
    browser.type('0.')
    browser.value('history.forward()')
    at_rest(browser, 0.25)
    check(box() == '0.', f'what is typed stays: {box()}')
    browser.key('Escape')
    check(box() == '0.25', 'until Escape')
    type_into(browser, 'value', 'half')
    browser.wait('!document.getElementById("message").hidden')
    browser.key('Escape')
    check(browser.value('document.getElementById("message").hidden'), 'Escape takes back what was said, too')
    type_into(browser, 'value', '90%v')
    browser.wait('Number(document.body.dataset.shown) > 1')
    at_rest(browser)
    value = shown(browser)
    check(len(box()) <= 8 < len(repr(value)) and abs(float(box()) - value) < 1e-5, f'{box()} of {value}')
    browser.key('Enter')
    browser.value('new Promise(done => setTimeout(done, 300))')
    check(shown(browser) == value, 'Enter alone keeps all digits')
    check(browser.value('document.activeElement.id') == 'value', 'it keeps the focus')


def test_messages_go_with_what_they_are_about(browser, viewer):
    start(browser, viewer, '&f=sphere&i=0.7&by=gyroid')
    browser.wait('document.getElementById("range-upper").value !== ""')
    browser.click('#range-lower')
    type_into(browser, 'range-lower', '500')
    browser.wait('document.getElementById("message").textContent.includes("smaller one first")')
    browser.click('#range-reset')
    browser.wait('document.getElementById("message").hidden')
    check(float(browser.value('document.getElementById("range-lower").value')) < 0, 'the ends are those of the field')


def test_orbit_pan_zoom(browser, viewer):
    start(browser, viewer)
    x, y, w, h = browser.box('#scene')
    cameras = [browser.value('document.body.dataset.camera')]

    def moved(what):
        browser.wait(f'document.body.dataset.camera !== "{cameras[-1]}"')
        browser.value('new Promise(done => setTimeout(done, 100))')
        cameras.append(browser.value('document.body.dataset.camera'))
        parts = [[float(v) for v in part.split(',')] for part in cameras[-1].split(':')[1:]]
        check(abs(sum(v * v for v in parts[1]) - 1) < 1e-6, f'{what}: the direction is a unit')
        return parts

    browser.drag((x + w / 2, y + h / 2), (x + w / 2 + 80, y + h / 2 + 40))
    moved('orbit')
    browser.drag((x + w / 2, y + h / 2), (x + w / 2 + 80, y + h / 2), modifiers=SHIFT)
    before = [float(v) for v in cameras[-1].split(':')[1].split(',')]
    check(before != moved('pan')[0], 'panning moves the target')
    near = float(cameras[-1].split(':')[4])
    browser.mouse('mouseWheel', x + w / 2, y + h / 2, button='none', buttons=0, deltaX=0, deltaY=-200)
    check(moved('zoom')[3][0] < near, 'the wheel goes nearer')
    browser.key('f')
    moved('fit')
    browser.key('1')
    check(moved('front')[1] == [0, -1, 0], 'the front looks along y')
    browser.key('5')
    browser.wait('document.body.dataset.camera.startsWith("parallel")')


def test_point_stays_under_the_pointer(browser, viewer):
    """Panning: what was under the pointer when it went down is under it afterwards."""
    start(browser, viewer)
    browser.key('1')
    browser.wait('document.body.dataset.camera.split(":")[2] === "0,-1,0"')
    x, y, w, h = browser.box('#scene')
    before = [float(v) for v in browser.value('document.body.dataset.camera').split(':')[1].split(',')]
    distance = float(browser.value('document.body.dataset.camera').split(':')[4])
    radius = shown(browser)
    browser.drag((x + w / 2, y + h / 2), (x + w / 2 + 100, y + h / 2), modifiers=SHIFT)
    browser.wait(f'Math.abs(Number(document.body.dataset.camera.split(":")[1].split(",")[0]) - {before[0]}) > 0.01')
    browser.value('new Promise(done => setTimeout(done, 100))')
    after = [float(v) for v in browser.value('document.body.dataset.camera').split(':')[1].split(',')]
    depth = distance - radius if radius < 1 else distance  # of the near side of the sphere, or of the middle
    expected = -100 / h * 2 * depth * 0.22169466264  # tan(12.5 degrees)
    check(abs(after[0] - before[0] - expected) < 0.03 * abs(expected), f'{after[0] - before[0]} in place of {expected}')


def test_keyboard_only(browser, viewer):
    start(browser, viewer)
    for _ in range(40):
        if browser.value('document.activeElement.id') == 'slider':
            break
        browser.key('Tab')
    check(browser.value('document.activeElement.id') == 'slider', 'Tab leads to the slider')
    check(browser.value('getComputedStyle(document.activeElement).outlineStyle') != 'none', 'the focus is visible')
    before = shown(browser)
    browser.key('ArrowRight')
    browser.wait(f'Number(document.body.dataset.shown) > {before}')
    at_rest(browser)
    coarse = shown(browser) - before
    middle = shown(browser)
    browser.key('ArrowRight', modifiers=SHIFT)
    browser.wait(f'Number(document.body.dataset.shown) > {middle}')
    at_rest(browser)
    check(0 < shown(browser) - middle < 0.3 * coarse, 'Shift is finer')
    middle = shown(browser)
    browser.key('PageDown')
    browser.wait(f'Number(document.body.dataset.shown) < {middle}')
    at_rest(browser)
    check(middle - shown(browser) > 5 * coarse, 'Page Down is coarser')
    browser.key('p')
    browser.wait('document.querySelectorAll("#surfaces li").length === 2')
    missing = browser.value('[...document.querySelectorAll("button, input, select, [role=slider], canvas[tabindex]")].filter(e => '
                            '!(e.getAttribute("aria-label") || e.labels?.length || e.textContent.trim())).map(e => e.id || e.outerHTML)')
    check(missing == [], f'controls without a name: {missing}')


def test_keys_of_one_character_can_be_switched_off(browser, viewer):
    """Who speaks to the machine, or hits keys by chance, sets off none; others go on."""
    start(browser, viewer)
    browser.click('#help-open')
    browser.click('#character-keys')
    browser.click('#help-close')
    browser.value('document.activeElement.blur()')
    for _ in range(2):  # it is remembered
        browser.key('p')
        browser.key('?')
        browser.value('document.getElementById("slider").focus()')
        before = shown(browser)
        browser.key('ArrowRight')
        browser.wait(f'Number(document.body.dataset.shown) > {before}')
        check(browser.value('document.querySelectorAll("#surfaces li").length') < 2, 'no surface is pinned')
        check(not browser.value('document.getElementById("help").open'), 'no help comes')
        start(browser, viewer)
    browser.click('#help-open')
    browser.click('#character-keys')
    browser.click('#help-close')
    browser.value('document.activeElement.blur()')
    browser.key('p')
    browser.wait('document.querySelectorAll("#surfaces li").length === 2')


def test_commands_name_files_of_further_steps(browser, viewer):
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, f'grid{step}.vtu') for step in (1, 2)]
        for side, file in enumerate(files, 3):
            subprocess.run([os.environ['ISOTET_PROGRAM'], 'make', 'kuhn', '--side', str(side), '-o', file, '-q'], check=True)
        with Viewer(*files, '--step', '1') as other:
            start(browser, other, '&labels=0&drawn=server')
            of_server(browser, folder)
            browser.call('Page.navigate', url='about:blank')


def test_one_page_too_many_is_told_once(browser, viewer):
    with Viewer(GRID, '--pages', '1') as other:
        start(browser, other)
        browser.value('(() => { const frame = document.createElement("iframe"); frame.src = location.href.replace("/#", "/?other#"); document.body.append(frame); })()')
        browser.wait('document.querySelector("iframe").contentDocument?.getElementById("message")?.textContent.includes("--pages N")')
        check(browser.value('document.querySelector("iframe").contentDocument.getElementById("lost").hidden'), 'nothing more is told')
        browser.call('Page.navigate', url='about:blank')


def type_value(browser, text):
    browser.value('(() => { const box = document.getElementById("value"); box.focus(); box.value = "%s"; '
                  'box.dispatchEvent(new KeyboardEvent("keydown", {key: "Enter"})); box.blur(); return 1; })()' % text)


def test_area_and_volume(browser, viewer):
    """They come when nothing moves, are curves of the chart, and those of the sphere that is shown."""
    start(browser, viewer)
    browser.wait('document.body.dataset.spectrum === "sphere"')
    type_value(browser, '0.6')
    at_rest(browser, 0.6)
    words = browser.value('document.getElementById("measures").textContent')
    area, below, share, whole = [float(word.strip(',:')) for word in words.split() if word[0].isdigit()]
    check(abs(area - 4 * 3.14159 * 0.36) < 0.1, words)
    check(abs(below - 4 / 3 * 3.14159 * 0.216) < 0.05 and whole == 8 and share == 11, words)
    before = browser.value('document.getElementById("chart").toDataURL()')
    choose(browser, '#curve', 'volume_below')
    check(before != browser.value('document.getElementById("chart").toDataURL()'), 'the curve is the same')
    choose(browser, '#field', 'gyroid')
    browser.wait('document.body.dataset.spectrum === "gyroid"')


def test_curved_cells_are_refined_at_rest(browser, viewer):
    """What moves is split at its nodes; at rest the surface is that of the command line, within the tolerance."""
    with Viewer('make:curved:4:sphere', '--tolerance', '0.01%') as curved, tempfile.TemporaryDirectory() as folder:
        start(browser, curved)
        browser.wait('document.body.dataset.bound !== ""')
        x, y, w, h = browser.box('#slider')
        browser.value('window.seen = []; new MutationObserver(() => seen.push(document.body.dataset.bound))'
                      '.observe(document.body, {attributes: true, attributeFilter: ["data-bound"]})')
        browser.drag((x + 0.3 * w, y + h / 2), (x + 0.6 * w, y + h / 2), steps=12)
        at_rest(browser)
        browser.wait('document.body.dataset.bound !== ""')
        check('' in browser.value('seen'), 'while the hand moves, nothing is refined')
        type_value(browser, '0.7')
        browser.wait('document.body.dataset.shown === "0.7" && document.body.dataset.bound !== ""')
        check(0 < float(browser.value('document.body.dataset.bound')) < 1e-3, 'the bound is told')
        check('refined: within' in browser.value('document.getElementById("facts").textContent'), 'in words, too')
        browser.picture(pictures and f'{pictures}/curved.png')
        browser.click('#copy-extract')
        browser.wait('document.getElementById("copied").textContent.includes("isotet extract")')
        words = shlex.split(browser.value('document.getElementById("copied").textContent'))
        told = subprocess.run([os.environ['ISOTET_PROGRAM'], *words[1:-1], f'{folder}/s.vtp', '--json', '-', '-q'],
                              check=True, capture_output=True, text=True)
        check(json.loads(told.stdout)['surfaces'][0]['triangles'] == int(browser.value('document.body.dataset.triangles')),
              'it is that of isotet extract')
        browser.call('Page.navigate', url='about:blank')


def test_pins_undo_and_address(browser, viewer):
    start(browser, viewer)
    first = shown(browser)
    browser.click('#pin')
    x, y, w, h = browser.box('#slider')
    browser.drag((x + 0.2 * w, y + h / 2), (x + 0.4 * w, y + h / 2), steps=4)
    at_rest(browser)
    second = shown(browser)
    check(second != first, 'the slider goes on')
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 2, 'the pinned surface stays')
    browser.wait(f'location.hash.includes("i={second}") && location.hash.includes("pin=")')
    browser.picture(pictures and f'{pictures}/pins.png')
    browser.value('history.back()')
    at_rest(browser, first)
    browser.value('history.forward()')
    at_rest(browser, second)
    browser.call('Page.reload')
    browser.wait('document.readyState === "complete" && document.body.dataset.shown !== undefined')
    at_rest(browser, second)
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 2, 'a reloaded page has its pins')


def test_another_field_is_a_state_of_its_own(browser, viewer):
    """Back leads to the last value and the pins of the field before; so does choosing it again."""
    start(browser, viewer)
    browser.click('#pin')
    type_value(browser, '0.5')
    at_rest(browser, 0.5)
    choose(browser, '#field', 'gyroid')
    browser.wait('document.body.dataset.field === "gyroid"')
    at_rest(browser)
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 1, 'pins are of a field')
    gyroid = shown(browser)
    browser.value('history.back()')
    browser.wait('document.body.dataset.field === "sphere"')
    at_rest(browser, 0.5)
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 2, 'the pin is there again')
    browser.value('history.forward()')
    browser.wait('document.body.dataset.field === "gyroid"')
    at_rest(browser, gyroid)
    choose(browser, '#field', 'sphere')
    browser.wait('document.body.dataset.field === "sphere"')
    at_rest(browser, 0.5)
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 2, 'with its pin')


def type_formula(browser, text):
    browser.value('(() => { const box = document.getElementById("formula"); box.value = %s; '
                  'box.dispatchEvent(new KeyboardEvent("keydown", {key: "Enter"})); return 1; })()' % json.dumps(text))


def test_formula(browser, viewer):
    """A typed expression is a field like others; one that cannot be computed brings back what was shown."""
    start(browser, viewer)
    type_formula(browser, 'sphere + gyroid^2')
    browser.wait('document.body.dataset.field === "sphere + gyroid^2"')
    at_rest(browser)
    formula_value = shown(browser)
    check(browser.value('document.getElementById("field").value') == 'sphere + gyroid^2', 'the list names it')
    type_formula(browser, 'sphere + nothing')
    browser.wait("document.getElementById('formula').getAttribute('aria-invalid') === 'true'")
    at_rest(browser, formula_value)
    check(browser.value('document.getElementById("field").value') == 'sphere + gyroid^2', 'the field before is back')
    check("there is no field 'nothing'" in browser.value('document.body.textContent'), 'the page says what is wrong')
    browser.value('window.isOld = true, location.reload()')
    browser.wait('!window.isOld && document.body?.dataset.field === "sphere + gyroid^2"')
    at_rest(browser, formula_value)
    type_formula(browser, 'x')
    browser.wait('document.body.dataset.field === "x"')
    at_rest(browser)
    browser.value('window.isOld = true, location.reload()')
    browser.wait('!window.isOld && document.body?.dataset.field === "x"')
    at_rest(browser)


def test_colour_by_field(browser, viewer):
    start(browser, viewer)
    plain = browser.picture()
    browser.value('(() => { const s = document.getElementById("color-by"); s.value = "gyroid"; s.dispatchEvent(new Event("change")); })()')
    browser.wait('document.getElementById("range-upper").value !== ""')
    at_rest(browser)
    browser.value('new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))')
    colored = browser.picture(pictures and f'{pictures}/color.png')
    check(plain != colored, 'the picture has other colours')
    colors = {row[i:i + 3] for row in pixels(colored)[2][200:500:10] for i in range(600, 2400, 30)}
    check(len(colors) > 40, f'a colour map has many colours: {len(colors)}')
    browser.value('document.getElementById("range-upper").select()')
    browser.click('#range-upper')
    type_into(browser, 'range-upper', '-9')
    browser.wait('document.getElementById("message").textContent.includes("smaller one first")')


def test_commands(browser, viewer):
    start(browser, viewer)
    browser.click('#copy-extract')
    browser.wait('document.getElementById("copied").textContent.includes("isotet extract")')
    text = browser.value('document.getElementById("copied").textContent')
    check(f'--isovalue {browser.value("document.body.dataset.shown")}' in text, text)
    browser.click('#copy-render')
    browser.wait('document.getElementById("copied").textContent.includes("--camera")')
    browser.click('#command')
    browser.type('isotet render x.vtu -f gyroid -i 0.25,0.5 --color-by sphere')
    browser.key('Enter')
    at_rest(browser, 0.25)
    check(browser.value('document.body.dataset.field') == 'gyroid', 'the field follows')
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 2, 'a surface an isovalue')
    check(browser.value('document.getElementById("color-by").value') == 'sphere', 'the colours follow')
    check('for x.vtu' in browser.value('document.getElementById("message").textContent'), 'it says that the file is another one')
    browser.click('#command')
    browser.type(f'isotet extract {GRID} -i 0.5 --keep largest --reduce 90%')
    browser.key('Enter')
    browser.wait('document.getElementById("message").textContent === "Not taken, as the page does not have it: --reduce 90%"')
    check('keep=largest' in browser.value('location.hash'), 'the parts to keep are taken')
    browser.click('#command')
    browser.type('isotet render x -f sphere -i 0.7 --view +x --zoom 2 --scale 1,1,5 --up -y')
    browser.key('Enter')
    at_rest(browser, 0.7)
    browser.wait('document.body.dataset.camera.includes(":1,0,0:0,-1,0:")')
    check(browser.value('document.getElementById("heights-text").value + document.getElementById("up").value') == '1-y', 'heights are along y')
    check('stretch=1%2C1%2C5' in browser.value('location.hash'), 'the axes are stretched')
    near = float(browser.value('document.body.dataset.camera').split(':')[4])
    browser.value('document.activeElement.blur()')
    browser.key('f')
    browser.wait(f'document.body.dataset.camera.split(":")[4] > {1.9 * near} && document.body.dataset.camera.split(":")[4] < {2.1 * near}')
    browser.click('#command')
    browser.type(f'isotet slice {GRID} cut.vtp --plane 0,0,1@0,0,0.25 --with gyroid')
    browser.key('Enter')
    browser.wait('document.body.dataset.kinds === "slice boundary"')
    browser.wait('document.getElementById("message").textContent === "Not taken, as the page does not have it: --with gyroid"')
    check('slice=0%2C0%2C1%2C0.25' in browser.value('location.hash'), 'the plane is taken')
    browser.click('#isosurfaces')
    browser.click('#command')
    browser.type('isotet clip x.vtu y.vtu -f p --above 1')
    browser.key('Enter')
    browser.wait('document.getElementById("message").textContent.startsWith("isotet clip is not taken here")')
    type_into(browser, 'command', '$ isotet render x -f sphere -i 0.6')
    at_rest(browser, 0.6)
    browser.click('#command')
    browser.type('rm -rf /')
    browser.key('Enter')
    browser.wait('document.getElementById("message").textContent.includes("no command line of isotet")')
    check(browser.value('document.body.dataset.field') == 'sphere', 'nothing changes')


def test_reconnect(browser, viewer):
    """A connection that is lost comes back, with what was shown, and the slider works again."""
    script = browser.call('Page.addScriptToEvaluateOnNewDocument', source='window.sockets = []; window.WebSocket = class extends '
                          'WebSocket { constructor(...all) { super(...all); sockets.push(this); } };')['identifier']
    start(browser, viewer)
    browser.call('Page.removeScriptToEvaluateOnNewDocument', identifier=script)
    browser.click('#pin')
    before = shown(browser)
    browser.value('window.lost = 0; new MutationObserver(() => { if (document.body.dataset.link === "lost") ++lost; })'
                  '.observe(document.body, {attributes: true, attributeFilter: ["data-link"]})')
    frame = int(browser.value('document.body.dataset.frame'))
    browser.value('sockets[0].close()')
    browser.wait('lost === 1')
    browser.wait('document.body.dataset.link === "open"')
    browser.wait(f'Number(document.body.dataset.frame) > {frame}')
    at_rest(browser, before)
    browser.value('document.getElementById("slider").focus()')
    browser.key('PageDown')
    browser.wait(f'Number(document.body.dataset.shown) < {before}')


def test_frames_that_are_never_drawn_do_not_stop_the_server(browser, viewer):
    """A page in the background draws nothing; what it gets meanwhile it acknowledges, or no frame would follow."""
    script = browser.call('Page.addScriptToEvaluateOnNewDocument', source="""
        window.sockets = []; window.frames_got = 0; const Socket = WebSocket;
        window.WebSocket = class extends Socket { constructor(...of) { super(...of); sockets.push(this);
            this.addEventListener('message', (event) => { if (typeof event.data !== 'string') ++frames_got; }); } };""")['identifier']
    start(browser, viewer)
    browser.call('Page.removeScriptToEvaluateOnNewDocument', identifier=script)
    browser.value('frames_got = 0; window.late = []; window.soon = requestAnimationFrame;'
                  'window.requestAnimationFrame = (then) => late.push(then); document.getElementById("slider").focus()')
    for got in range(1, 5):
        browser.key('ArrowRight')
        browser.wait(f'frames_got >= {got}')
    browser.value('window.requestAnimationFrame = soon; late.forEach(soon)')
    at_rest(browser)


def choose(browser, selector, value):
    browser.value(f'(() => {{ const e = document.querySelector("{selector}"); e.value = "{value}"; '
                  'for (const kind of ["input", "change"]) e.dispatchEvent(new Event(kind)); })()')


def test_slices_and_clip_planes(browser, viewer):
    start(browser, viewer, '&labels=0')
    browser.click('#add-slice')
    browser.wait('document.body.dataset.kinds.includes("slice")')
    check(browser.value('document.getElementById("color-by").value') == 'sphere', 'a slice is coloured')
    choose(browser, '#cuts .axis', 'z')
    choose(browser, '#cuts .place', '0.25')
    browser.wait('location.hash.includes("slice=0%2C0%2C1%2C0.25")')
    choose(browser, '#cuts .axis', 'free')
    check(browser.value('!document.querySelector("#cuts .normal").hidden'), 'a normal can be typed')
    choose(browser, '#cuts .normal', '1, 1, 0')
    browser.wait('location.hash.includes("slice=1%2C1%2C0%2C0")')
    at_rest(browser)
    before = share_of_surface(browser)
    choose(browser, '#boundary', '0')
    browser.wait('!document.body.dataset.kinds.includes("boundary")')
    choose(browser, '#cuts .axis', 'y')
    browser.click('#add-clip')
    choose(browser, '#cuts li:nth-child(2) .axis', 'x')
    browser.wait('location.hash.includes("clip=1%2C0%2C0%2C0")')
    at_rest(browser)
    browser.value('new Promise(done => setTimeout(done, 300))')
    check(share_of_surface(browser) < before, 'less is left')
    browser.picture(pictures and f'{pictures}/cuts.png')
    browser.click('#cuts li:nth-child(2) .flip')
    browser.wait('location.hash.includes("clip=-1%2C0%2C0%2C0")')
    browser.click('#copy-render')
    browser.wait('document.getElementById("copied").textContent.includes("--clip=-x=0")')
    check('--boundary 0 ' in browser.value('document.getElementById("copied").textContent'), 'the boundary is off there, too')
    browser.click('#cuts .remove')
    browser.wait('document.querySelectorAll("#cuts li").length === 1')
    check(overlaps(browser) == [], f'{overlaps(browser)}')


def test_solids(browser, viewer):
    """The switch shows the isosurface closed by the boundary, and the address and the command have it."""
    start(browser, viewer, '&labels=0')
    triangles = lambda: int(browser.value('document.body.dataset.triangles'))
    choose(browser, '#boundary', '0')
    browser.wait('!document.body.dataset.kinds.includes("boundary")')
    at_rest(browser)
    isosurface = triangles()
    choose(browser, '#solid', 'above')
    browser.wait(f'Number(document.body.dataset.triangles) > {isosurface}')
    browser.wait('location.hash.includes("solid=above")')
    at_rest(browser)
    browser.picture(pictures and f'{pictures}/solid.png')
    above = triangles()
    browser.click('#copy-render')
    browser.wait('document.getElementById("copied").textContent.includes("--solid above")')
    choose(browser, '#solid', 'below')
    browser.wait(f'Number(document.body.dataset.triangles) < {above}')
    choose(browser, '#solid', '')
    browser.wait(f'Number(document.body.dataset.triangles) === {isosurface} && !location.hash.includes("solid=")')


def test_parts(browser, viewer):
    """The table has the parts, largest first; a click leaves one out, and the commands and the address follow."""
    start(browser, viewer)
    choose(browser, '#field', 'gyroid')
    browser.wait('document.body.dataset.field === "gyroid"')
    type_value(browser, '1.3')
    at_rest(browser, 1.3)
    triangles = lambda: int(browser.value('document.body.dataset.triangles'))
    table = lambda: json.loads(browser.value('document.body.dataset.parts'))
    told = lambda: browser.value('document.getElementById("parts-told").textContent')
    whole = triangles()
    browser.click('#parts summary')
    browser.wait('document.body.dataset.parts')
    parts = table()['parts']
    check(len(parts) > 2 and sum(part['triangles'] for part in parts) == whole, f'all triangles are in a part: {parts}')
    check([part['area'] for part in parts] == sorted((part['area'] for part in parts), reverse=True), 'largest first')
    row = '#parts-rows tr:nth-child(1) '
    browser.click(row + 'td:nth-child(2)')
    browser.wait(f'Number(document.body.dataset.triangles) === {whole - parts[0]["triangles"]}')
    browser.wait('location.hash.includes("keep=not%3A0")')
    browser.wait('document.getElementById("parts-told").textContent.includes("shown")')
    check(f'{len(parts) - 1} shown' in told(), told())
    browser.picture(pictures and f'{pictures}/parts.png')
    browser.click('#copy-extract')
    browser.wait('document.getElementById("copied").textContent.includes("--keep not:0")')
    browser.click(row + 'button')
    browser.wait(f'Number(document.body.dataset.triangles) === {parts[0]["triangles"]}')
    browser.value('history.back(); 1')
    browser.wait(f'Number(document.body.dataset.triangles) === {whole - parts[0]["triangles"]}')
    browser.value('(() => { const box = document.getElementById("keep"); box.focus(); box.value = "2"; '
                  'box.dispatchEvent(new KeyboardEvent("keydown", {key: "Enter"})); box.blur(); return 1; })()')
    browser.wait(f'Number(document.body.dataset.triangles) === {parts[0]["triangles"] + parts[1]["triangles"]}')
    browser.wait('JSON.parse(document.body.dataset.parts).kept === 2')
    browser.click('#parts-rows tr:nth-child(2) input')  # of a rule, numbers are left
    browser.wait('location.hash.includes("keep=parts%3A0&") || location.hash.endsWith("keep=parts%3A0")')
    type_value(browser, '1.35')
    at_rest(browser, 1.35)
    check('keep=' not in browser.value('location.hash'), 'numbers are those of one value')


def test_shares_and_scales(browser, viewer):
    """The box takes 90%v and p95 as the command line; the slider goes by logarithm and by share of volume."""
    program = os.environ['ISOTET_PROGRAM']
    start(browser, viewer)
    for text in ['25%v', 'p75']:
        numbers = json.loads(subprocess.check_output([program, 'extract', GRID, '-f', 'sphere', '-i', text, '--json', '-']))
        type_value(browser, text)
        at_rest(browser, numbers['surfaces'][0]['isovalue'])
    browser.wait('document.body.dataset.spectrum === "sphere"')
    x, y, w, h = browser.box('#slider')
    choose(browser, '#scale', 'share')
    browser.drag((x + 0.3 * w, y + h / 2), (x + 0.5 * w, y + h / 2), steps=3)
    at_rest(browser)
    half = json.loads(subprocess.check_output([program, 'extract', GRID, '-f', 'sphere', '-i', '50%v', '--json', '-']))
    half = half['surfaces'][0]['isovalue']
    check(abs(shown(browser) - half) < 0.01, f'half of the volume is in the middle: {shown(browser)}, {half}')
    browser.wait('location.hash.includes("scale=share")')
    choose(browser, '#scale', 'log')
    browser.drag((x + 0.3 * w, y + h / 2), (x + 0.5 * w, y + h / 2), steps=3)
    at_rest(browser)
    lower, upper = [float(one) for one in browser.value('document.body.dataset.span').split()]
    middle = (max(lower, 1e-6 * upper) * upper) ** 0.5
    check(abs(shown(browser) / middle - 1) < 0.05, f'the middle of logarithms: {shown(browser)}, {middle}')
    before = shown(browser)
    browser.value('document.getElementById("slider").focus()')
    browser.key('ArrowRight')
    at_rest(browser)
    check(shown(browser) > before, 'a key goes on')


def test_pick(browser, viewer):
    start(browser, viewer)
    x, y, w, h = browser.box('#scene')
    at = (x + w / 2, y + h / 2)
    browser.mouse('mouseMoved', *at, button='none', buttons=0)
    browser.mouse('mousePressed', *at)
    browser.mouse('mouseReleased', *at, buttons=0)
    browser.wait('document.body.dataset.picked')
    picked = json.loads(browser.value('document.body.dataset.picked'))
    values = {one['name']: one['values'][0] for one in picked['values']}
    check(abs(values['sphere'] - shown(browser)) < 1e-4, f'the field has the isovalue there: {values}')
    check('gyroid' in values and picked['cell'] >= 0, f'the other fields, and the cell: {picked}')
    browser.picture(pictures and f'{pictures}/pick.png')
    check(browser.value('document.getElementById("picked-rows").textContent.includes("Cell")'), 'the page shows it')
    browser.key('Escape')
    browser.wait('document.getElementById("picked").hidden')
    browser.key('v')
    browser.wait('!document.getElementById("picked").hidden')
    type_value(browser, '0.4')
    at_rest(browser, 0.4)
    check(browser.value('document.getElementById("picked").hidden'), 'the point goes with its surface')


def test_a_pick_hits_what_is_seen_first(browser, viewer):
    """An opaque boundary, not the isosurface behind it; through a translucent one the isosurface."""
    told = lambda: browser.value('document.getElementById("picked-title").textContent')
    for drawn in ('', 'server'):
        for boundary, title in (('1', 'On the boundary'), ('0.1', 'sphere = 0.7')):
            start(browser, viewer, f'&f=sphere&i=0.7&boundary={boundary}&drawn={drawn}')
            browser.wait(f'document.body.dataset.picture === "{drawn and "image/png"}" && document.body.dataset.kinds.includes("boundary") === {"false" if drawn else "true"}')
            browser.value('document.activeElement.blur()')
            browser.key('v')
            browser.wait('document.body.dataset.picked')
            check(told() == title, f'boundary {boundary}, drawn {drawn}: {told()}')
            place = max(abs(v) for v in json.loads(browser.value('document.body.dataset.picked'))['point'])
            check((place > 0.999) == (boundary == '1'), f'the point is there: {place}')
            browser.key('Escape')


def test_fit_to_the_surface(browser, viewer):
    start(browser, viewer, '&f=sphere&i=0.2&boundary=0&labels=0')
    at_rest(browser, 0.2)
    before = share_of_surface(browser)
    browser.click('[data-view=surface]')
    browser.value('new Promise(done => setTimeout(done, 300))')
    check(share_of_surface(browser) > 10 * before, f'it fills the picture: {before}, {share_of_surface(browser)}')
    w, h = browser.value('[scene.clientWidth, scene.clientHeight]')
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([os.environ['ISOTET_PROGRAM'], 'render', GRID, f'{folder}/p.png', '-f', 'sphere', '-i', '0.2', '--fit', 'surface', '--boundary', '0', '--plain',
                              '--size', f'{w}x{h}', '--json', '-', '-q'], check=True, capture_output=True, text=True)
    distance = lambda camera: float(camera.split(':')[4])
    page, wanted = browser.value('document.body.dataset.camera'), json.loads(run.stdout)['camera']
    check(abs(distance(page) / distance(wanted) - 1) < 1e-3, f'as isotet render --fit surface: {page}, {wanted}')
    browser.click('[data-view=fit]')
    browser.value('new Promise(done => setTimeout(done, 300))')
    check(share_of_surface(browser) < 2 * before, 'Fit shows all')


def test_a_pinned_surface_keeps_its_colour(browser, viewer):
    color = lambda row: browser.value(f'document.querySelector("#surfaces li:nth-child({row}) input[type=color]").value')
    start(browser, viewer, '&f=sphere&i=0.7')
    at_rest(browser, 0.7)
    alone = color(1)
    browser.click('#pin')
    browser.wait('document.querySelectorAll("#surfaces li").length === 2')
    type_value(browser, '0.9')
    at_rest(browser, 0.9)
    check(color(2) == alone, f'{alone} became {color(2)}')
    check(color(1) != alone, 'the next one has another')
    moved = color(1)
    browser.click('#pin')
    browser.wait('document.querySelectorAll("#surfaces li").length === 3')
    type_value(browser, '1.1')
    at_rest(browser, 1.1)
    check([color(2), color(3)] == [alone, moved], 'also of two')


def test_sections_fold(browser, viewer):
    """By the keyboard, and they stay so in the next page; Space folds, and plays nothing."""
    title, is_open = '#view-title', 'document.querySelector("[data-fold=view]").open'
    start(browser, viewer)
    check(browser.value(is_open), 'at first it is open')
    low = browser.box('#cuts-title')[1]
    browser.value('document.querySelector("[data-fold=view] summary").focus()')
    browser.key(' ')
    browser.wait(f'!{is_open}')
    check(browser.box('#cuts-title')[1] < low - 100 and browser.box('#edges')[3] == 0, 'what is below moves up')
    check(overlaps(browser) == [], f'{overlaps(browser)}')
    browser.wait('localStorage.getItem("isotet-folded") === \'["view"]\'')
    browser.value('window.isOld = true, location.reload()')
    browser.wait('!window.isOld && document.body?.dataset.shown !== undefined')
    check(not browser.value(is_open), 'it is folded in the next page, too')
    check(browser.value(f'getComputedStyle(document.querySelector("{title}")).display') != 'none', 'its title stays')
    browser.value('document.querySelector("[data-fold=view] summary").focus()')
    browser.key('Enter')
    browser.wait(is_open)
    browser.value('document.querySelector("[data-fold=volume]").open = false')
    browser.click('#volume')
    browser.wait('document.querySelector("[data-fold=volume]").open && document.body.dataset.volume === "ramp"')
    browser.click('#volume')


def test_the_first_value_of_a_field_over_decades(browser, viewer):
    """The slider goes by logarithms, and begins in the middle decades; another field goes by values."""
    field = '10^(5*sphere/1.7321)'
    with Viewer(GRID, '-f', field) as other:
        start(browser, other)
        check(browser.value('document.getElementById("scale").value') == 'log', 'the scale is the logarithm')
        check(20 < shown(browser) < 2000, f'{shown(browser)}')
        choose(browser, '#field', 'gyroid')
        browser.wait('document.body.dataset.field === "gyroid"')
        check(browser.value('document.getElementById("scale").value') == '', 'of this field it is not')
        browser.call('Page.navigate', url='about:blank')


def test_surfaces_of_all_time_steps(browser, viewer):
    """As a command line that writes a file for each, and as one file."""
    with Viewer(STEPS) as other, tempfile.TemporaryDirectory() as folder:
        browser.downloads(folder)
        start(browser, other)
        browser.click('#copy-steps')
        browser.click('#copy-extract')
        browser.wait('document.getElementById("copied").textContent.includes("--all-steps")')
        words = shlex.split(browser.value('document.getElementById("copied").textContent'))
        check(words[-1] == 'surface-{step}.vtp' and '--step' not in words, f'{words}')
        subprocess.run([os.environ['ISOTET_PROGRAM'], *words[1:-1], f'{folder}/{words[-1]}', '-q'], check=True)
        check(len([name for name in os.listdir(folder) if name.endswith('.vtp')]) == 3, 'a file for each step')
        browser.click('#save-open')
        choose(browser, '#save-kind', 'series.glb')
        browser.wait('document.getElementById("save-command").textContent.includes("--all-steps")')
        name = browser.value('document.getElementById("save-name").value')
        browser.click('#save-go')
        browser.wait(f'document.getElementById("save-told").textContent === "Downloaded: {name}"')
        check(browser.downloaded(f'{folder}/{name}').startswith(b'glTF'), 'it is GLB')
        browser.call('Page.navigate', url='about:blank')


def test_time_steps(browser, viewer):
    """A file with steps: the slider goes to one, and playing shows one after another."""
    with Viewer(STEPS) as other:
        start(browser, other)
        check(browser.value('!document.getElementById("time").hidden'), 'there are steps')
        last = int(browser.value('document.getElementById("step").max'))
        choose(browser, '#step', str(last))
        browser.wait(f'document.body.dataset.step_shown === "{last}"')
        browser.wait(f'location.hash.includes("step={last}")')
        browser.value('window.seen = new Set(); new MutationObserver(() => seen.add(document.body.dataset.step_shown))'
                      '.observe(document.body, {attributes: true})')
        browser.click('#play')
        browser.wait(f'seen.size === {last + 1}')
        browser.picture(pictures and f'{pictures}/time.png')
        browser.click('#play')
        check(browser.value('document.getElementById("play").textContent') == 'Play', 'it stops')
        choose(browser, '#order', 'once')
        choose(browser, '#speed', '16')
        browser.click('#time-typed')
        type_into(browser, 'time-typed', '-1e9')
        browser.wait('document.body.dataset.step_shown === "0" && document.activeElement.id === "time-typed"')
        browser.click('#play')
        browser.wait(f'document.body.dataset.step_shown === "{last}" && document.getElementById("play").textContent === "Play"')
        browser.click('#copy-extract')
        browser.wait('document.getElementById("copied").textContent.includes("--step ")')
        browser.call('Page.navigate', url='about:blank')


def test_playing_the_isovalue(browser, viewer):
    """From end to end of the slider, once; keys of the box leave it the focus; letters act while a button has it."""
    start(browser, viewer, '&f=sphere&i=1.5')
    at_rest(browser, 1.5)
    choose(browser, '#order-value', 'once')
    choose(browser, '#speed-value', '16')
    browser.value('window.seen = new Set(); new MutationObserver(() => seen.add(Number(document.body.dataset.shown)))'
                  '.observe(document.body, {attributes: true})')
    browser.click('#play-value')
    browser.wait('document.getElementById("play-value").textContent === "Play" && seen.size > 5')
    at_rest(browser)
    check(abs(shown(browser) - 1.73205) < 1e-3, 'it ends at the upper end')
    seen = browser.value('[...seen]')
    check(seen == sorted(seen), f'values rise: {seen}')
    choose(browser, '#order-value', 'back')
    browser.click('#play-value')
    browser.wait(f'Number(document.body.dataset.shown) < 1.65')
    browser.key('i')  # the button has the focus
    check(browser.value('document.getElementById("play-value").textContent') == 'Play', 'a letter acts there')
    browser.click('#value')
    type_into(browser, 'value', '0,7')
    at_rest(browser, 0.7)
    check(browser.value('document.activeElement.id + document.getElementById("value").value') == 'value0.7', 'the box keeps the focus')
    browser.key('ArrowUp')
    at_rest(browser)
    check(browser.value('document.activeElement.id') == 'value' and 0.7 < shown(browser) < 0.72, 'its arrow keys change the value')
    check(float(browser.value('document.getElementById("value").value')) == shown(browser), 'which it tells')
    browser.key('p')
    check(browser.value('document.querySelectorAll("#surfaces li").length') == 1, 'letters are text there')


def at_step(browser, step):
    choose(browser, '#step', str(step))
    browser.wait(f'document.body.dataset.step_shown === "{step}" && document.body.dataset.chart_step === "{step}"')


def span(browser):
    return [float(v) for v in browser.value('document.body.dataset.span').split()]


def test_the_slider_belongs_to_the_step(browser, viewer):
    """A field that is 0 at first: its slider, chart and first value come with the step at which it varies."""
    with Viewer(STEPS, '-f', 'nodal_Cauchy_Stress_1', '--step', '0') as other:
        browser.call('Page.navigate', url='about:blank')
        browser.open(other.address)
        browser.wait('document.body.dataset.span === "0 0" && document.body.dataset.chart_step === "0"')
        at_step(browser, 2)
        lower, upper = span(browser)
        check(lower < -10000 and upper > 20000, f'{lower} to {upper}')
        browser.wait('Number(document.body.dataset.shown) !== 0 && Number(document.body.dataset.triangles) > 0')
        check(lower < shown(browser) < upper, f'the first value is of the step: {shown(browser)}')
        check('2 of 3 steps' in browser.value('document.getElementById("ends").textContent'), 'it says whose range it is')
        choose(browser, '#span', 'step')
        at_step(browser, 1)
        one = span(browser)
        check(one[1] < upper and 'step 1' in browser.value('document.getElementById("ends").textContent'), f'{one}')
        choose(browser, '#span', '')
        check(span(browser) == [min(lower, one[0]), max(upper, one[1])], 'the range grows, and never shrinks')
        check('all steps' in browser.value('document.getElementById("ends").textContent'), 'all were seen')
        browser.value('document.getElementById("slider").focus()')
        browser.key('End')
        at_rest(browser, upper)
        type_value(browser, '1,5')
        at_rest(browser, 1.5)
        for text, end in (('100%', upper), ('0 %', lower)):
            type_value(browser, text)
            at_rest(browser, end)
        type_value(browser, '1e9')
        browser.wait('document.getElementById("facts").textContent.includes("nodal_Cauchy_Stress_1 is")')
        browser.picture(pictures and f'{pictures}/steps.png')
        browser.call('Page.navigate', url='about:blank')


def test_pages_at_other_steps_have_charts_of_their_own(browser, viewer):
    with Viewer(STEPS, '-f', 'nodal_Cauchy_Stress_1', '--step', '1') as other:
        proxy = Proxy(other.port, other.address.split('#')[1])
        browser.call('Page.navigate', url='about:blank')
        browser.open(f'http://127.0.0.1:{proxy.port}/')
        first, second = (f'document.querySelectorAll("iframe")[{i}]?.contentDocument?.body?.dataset' for i in range(2))
        browser.wait(f'{first}?.step_shown === "1" && {first}.chart_step === "1"')
        of_first = browser.value(f'[{first}.span, {first}.shown]')
        browser.value('(() => { const step = document.querySelector("iframe").contentDocument.getElementById("step"); step.value = 2; '
                      'step.dispatchEvent(new Event("input")); })()')
        browser.wait(f'{first}.step_shown === "2" && {first}.chart_step === "2"')
        browser.value('document.body.append(document.querySelector("iframe").cloneNode())')
        browser.wait(f'{second}?.step_shown === "1" && {second}.chart_step === "1"')
        check(browser.value(f'[{second}.span, {second}.shown]') == of_first, 'its range and first value are those of its own step')
        check(browser.value(f'{first}.chart_step') == '2', 'the first page keeps its own')
        browser.call('Page.navigate', url='about:blank')
        proxy.listener.close()


def rendered(browser, folder):
    """Pixels of `isotet render` for the command that the page copies, at the size of its picture."""
    browser.value('document.getElementById("copied").textContent = ""')
    browser.click('#copy-render')
    browser.wait('document.getElementById("copied").textContent.includes("--camera")')
    words = shlex.split(browser.value('document.getElementById("copied").textContent'))
    w, h = browser.value('["width", "height"].map(side => document.getElementById("picture")[side])')
    path = f'{folder}/picture.png'
    subprocess.run([os.environ['ISOTET_PROGRAM'], *words[1:-1], path, '--plain', '--size', f'{w}x{h}', '-q'], check=True)
    with open(path, 'rb') as file:
        return pixels(file.read())


def of_server(browser, folder):
    """Rows of the server's picture above the axes, which become those of the copied command."""
    browser.value('new Promise(done => setTimeout(done, 500))')
    end = time.monotonic() + 30
    while True:
        seen, differ = rows_of_server(browser, folder)
        if not differ:
            return seen
        check(time.monotonic() < end, f'isotet render draws the same, but for {len(differ)} rows, {differ[:5]}')


def rows_of_server(browser, folder):
    """Those of the picture that is there, and which of them are others than those of the copied command."""
    browser.wait('document.body.dataset.preview === "false" && document.body.dataset.picture === "image/png" && document.getElementById("message").hidden')
    x, y, w, h = (int(one) for one in browser.box('#scene'))
    seen = [row[3 * x:3 * (x + w)] for row in pixels(browser.picture())[2][y:y + h - 100]]
    drawn = rendered(browser, folder)[2][:h - 100]
    return seen, [j for j in range(h - 100) if seen[j] != drawn[j]]


def test_pictures_of_the_server(browser, viewer):
    """JPEG while the hand moves; at rest exactly the pixels of `isotet render`."""
    start(browser, viewer, '&labels=0')
    browser.click('#pin')
    choose(browser, '#color-by', 'gyroid')
    choose(browser, '#drawn-by', 'server')
    browser.wait('document.body.dataset.picture === "image/png"')
    browser.value('window.kinds = new Set(); new MutationObserver(() => kinds.add(document.body.dataset.picture))'
                  '.observe(document.body, {attributes: true})')
    before = browser.value('document.body.dataset.camera')
    x, y, w, h = (int(v) for v in browser.box('#scene'))
    browser.drag((x + w / 2, y + h / 2), (x + w / 2 + 90, y + h / 2 + 30), steps=20)
    x0, y0, w0, h0 = browser.box('#slider')
    browser.drag((x0 + 0.4 * w0, y0 + h0 / 2), (x0 + 0.5 * w0, y0 + h0 / 2), steps=10)
    browser.wait('kinds.has("image/jpeg")')
    check(browser.value('document.body.dataset.camera') != before, 'the camera moves')
    browser.wait('document.body.dataset.picture === "image/png" && document.body.dataset.preview === "false"')
    at_rest(browser)
    check('chosen' in browser.value('document.getElementById("facts").textContent'), 'why the server draws is told')
    browser.value('new Promise(done => setTimeout(done, 400))')
    _, _, page = pixels(browser.picture(pictures and f'{pictures}/server.png'))
    with tempfile.TemporaryDirectory() as folder:
        _, _, drawn = rendered(browser, folder)
    rows = range(0, h - 100)  # above the axes
    differ = sum(page[y + j][3 * x:3 * (x + w)] != drawn[j] for j in rows)
    check(len(set(drawn[h // 2][i:i + 3] for i in range(0, 3 * w, 3))) > 20, 'there is something to see')
    check(differ == 0, f'{differ} of {len(rows)} rows differ')
    choose(browser, '#drawn-by', '')
    browser.wait('document.body.dataset.picture === "" && document.getElementById("picture").hidden')


def test_surfaces_that_are_too_large_are_drawn_by_the_server(browser, viewer):
    """The reason is told, values are told under the pointer, and smaller surfaces are the browser's again."""
    start(browser, viewer, '&iso=0.9')
    browser.value('document.body.dataset.most = 2000')
    type_value(browser, '0.8')
    browser.wait('document.body.dataset.picture === "image/png" && document.body.dataset.shown === "0.8"')
    check('too many for the browser' in browser.value('document.getElementById("facts").textContent'), 'the reason is told')
    x, y, w, h = browser.box('#scene')
    at = (x + w / 2, y + h / 2)
    browser.mouse('mouseMoved', *at, button='none', buttons=0)
    browser.mouse('mousePressed', *at)
    browser.mouse('mouseReleased', *at, buttons=0)
    browser.wait('!document.getElementById("picked").hidden')
    rows = browser.value('document.getElementById("picked").textContent')
    check('sphere = 0.8' in rows and 'Cell' in rows, rows)
    place = [float(v) for v in browser.value('document.querySelector("#picked-rows td").textContent').split(',')]
    check(abs(sum(v * v for v in place) - 0.64) < 0.02, f'{place}')
    browser.key('Escape')
    type_value(browser, '0.2')
    browser.wait('document.body.dataset.picture === "" && document.getElementById("picture").hidden')
    browser.value('delete document.body.dataset.most')


def test_playing_without_isosurfaces(browser, viewer):
    """Each frame shows the next value, also a volume without its surfaces; a frame that is refused ends it."""
    start(browser, viewer, '&f=sphere&i=0.7&labels=0&volume=ramp')
    browser.wait('document.body.dataset.volume === "ramp" && document.body.dataset.picture === "image/png"')
    check(browser.value('document.getElementById("shown").textContent') == 'Volume shown', 'no isosurface is shown')
    browser.value('window.seen = new Set(); window.seeing = setInterval(() => seen.add(document.getElementById("slider").getAttribute("aria-valuenow")), 20)')
    browser.click('#play-value')
    browser.wait('seen.size > 4', 60)
    browser.value('clearInterval(seeing)')
    browser.click('#play-value')
    browser.wait('document.getElementById("play-value").textContent === "Play"')
    start(browser, viewer, '&f=sphere&i=0.7&by=gyroid&range=-1,1')
    browser.click('#play-value')
    browser.wait('Number(document.body.dataset.shown) > 0.75')
    browser.value('document.getElementById("logarithmic").click()')
    browser.wait('document.getElementById("message").textContent.includes("logarithmic") && document.getElementById("play-value").textContent === "Play"')
    browser.call('Page.navigate', url='about:blank')


def flat_reservoir(folder):
    """Two cells, 2000 wide and 10 high: heights are drawn 50 times as large."""
    path = os.path.join(folder, 'flat.grdecl')
    with open(path, 'w', encoding='ascii') as file:
        file.write('SPECGRID\n 2 1 1 1 F /\nCOORD\n 0 0 100 0 0 200  1000 0 100 1000 0 200  2000 0 100 2000 0 200\n'
                   ' 0 1000 100 0 1000 200  1000 1000 100 1000 1000 200  2000 1000 100 2000 1000 200 /\n'
                   'ZCORN\n 8*100 8*110 /\nPORO\n 0.1 0.2 /\n')
    return path


def test_heights_of_flat_reservoirs(browser, viewer):
    """A command line without --scale has the heights that isotet render gives them, and one is written where they are not stretched."""
    heights = 'document.getElementById("heights-text").value'
    with tempfile.TemporaryDirectory() as folder, Viewer(flat_reservoir(folder)) as other:
        start(browser, other)
        browser.wait(f'{heights} === "50"')
        browser.call('Page.navigate', url='about:blank')
        start(browser, other, '&f=PORO&by=PORO&isosurfaces=0&colored=1&boundary=1&i=0.15')
        browser.wait(f'{heights} === "1"')
        browser.click('#copy-render')
        browser.wait('document.getElementById("copied").textContent.includes("--scale 1,1,1")')
        browser.click('#command')
        browser.type('isotet render x --boundary-color-by PORO')
        browser.key('Enter')
        browser.wait(f'{heights} === "50" && location.hash.includes("stretch=1%2C1%2C50")')
        browser.click('#command')
        browser.type('isotet render x --boundary-color-by PORO --scale 1,1,1')
        browser.key('Enter')
        browser.wait(f'{heights} === "1"')
        browser.call('Page.navigate', url='about:blank')


def test_long_names_of_hidden_classes(browser, viewer):
    """A message takes 4096 bytes a choice: names are shared out."""
    start(browser, viewer)
    sizes = browser.value("import('./state.js').then(({cellsOf}) => cellsOf({cells: ['a=1'], colorBy: 'region', hidden: "
                          "['x'.repeat(3000), 'y'.repeat(3000), 'z', 'é'.repeat(2100)]}).map((one) => one.length))")
    check(sizes == [3, 3008, 3010], f'{sizes}')


def test_hiding_leaves_places_without_data(browser, viewer):
    """Three cells of the regions 1, 2 and none: those of a hidden region go, of all that is shown; grey ones stay."""
    def count():
        """Pixels that are grey, and all others that are not background."""
        browser.value('new Promise(requestAnimationFrame)')
        x, y, w, h = (int(v * browser.value('devicePixelRatio')) for v in browser.box('#scene'))
        _, _, rows = pixels(browser.picture())
        back = rows[y + 4][3 * (x + w - 8):3 * (x + w - 8) + 3]
        seen = [rows[j][3 * i:3 * i + 3] for j in range(y, y + int(0.85 * h), 4) for i in range(x + 4, x + w - 4, 4)]
        grey = sum(one != back and max(one) - min(one) < 4 for one in seen)
        return grey, sum(one != back for one in seen) - grey

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'three.vtk')
        with open(path, 'w', encoding='ascii') as file:
            points = [f'{x} {y} {z}' for x in range(4) for y in range(2) for z in range(2)]
            cells = [f'8 {" ".join(str(4 * c + k) for k in (0, 4, 6, 2, 1, 5, 7, 3))}' for c in range(3)]
            file.write('\n'.join(['# vtk DataFile Version 3.0', 'three', 'ASCII', 'DATASET UNSTRUCTURED_GRID', 'POINTS 16 float', *points,
                                  'CELLS 3 27', *cells, 'CELL_TYPES 3', '12', '12', '12', 'CELL_DATA 3', 'SCALARS region float 1',
                                  'LOOKUP_TABLE default', '1', '2', 'nan', '']))
        with Viewer(path) as other:
            counts, view = [], '&labels=0&f=region&by=region&isosurfaces=0&colored=1&boundary=1&i=1.5'
            for hidden in ('', '&hidden=1', '&hidden=2', '&hidden=1&hidden=2'):
                start(browser, other, view + hidden)
                browser.wait('document.body.dataset.kinds === "boundary" && document.querySelectorAll("#regions-list li").length === 2')
                counts.append(count())
                if not hidden:
                    view += '&camera=' + browser.value('document.body.dataset.camera')
            (grey, colored), *rest = counts
            check(grey > 100 and all(one >= 0.9 * grey for one, _ in rest), f'places without data stay: {counts}')
            check(rest[0][1] < 0.8 * colored and rest[1][1] < 0.8 * colored and rest[2][1] < 0.05 * colored, f'regions go: {counts}')
            start(browser, other, view + '&drawn=server')
            pictures = [of_server(browser, folder)]
            for region, left_out in ((2, '2'), (1, '2,1')):
                browser.click(f'#regions-list li:nth-child({region}) input')
                pictures.append(of_server(browser, folder))
                check(f"'!region={left_out}'" in browser.value('document.getElementById("copied").textContent'), 'it names what is hidden')
            check(pictures[0] != pictures[1] != pictures[2], 'regions go')
            for cells, chosen in (("'!region=2'", 'hidden=2'), ('region=:1', 'cells=region%3D%3A1')):
                browser.click('#command')
                browser.type(f'isotet render {path} --boundary-color-by region --cells {cells}')
                browser.key('Enter')
                browser.wait(f'location.hash.includes("{chosen}")')
                browser.value('document.activeElement.blur()')
            check(browser.value('document.getElementById("cells-text").textContent') == 'region=:1', 'it is told which cells are shown')
            browser.click('#labels-on')
            check(of_server(browser, folder) != pictures[0], 'others are left out')
            browser.click('#cells-all')
            browser.wait('!location.hash.includes("cells=") && document.getElementById("cells").hidden')
            browser.call('Page.navigate', url='about:blank')


def test_volume(browser, viewer):
    """The field as a volume: presets, a curve that the hand drags, surfaces with it, the address and the command line."""
    at_rest_in_full = 'document.body.dataset.preview === "false" && document.body.dataset.picture === "image/png"'
    start(browser, viewer, '&labels=0')
    value = shown(browser)
    browser.click('#volume')
    browser.wait(f'document.body.dataset.volume === "ramp" && {at_rest_in_full}')
    check(browser.value('document.getElementById("shown").textContent') == 'Volume shown', 'it says what is shown')
    check(0.1 < share_of_surface(browser) < 0.9, 'the volume is in the picture')
    check(browser.value('document.getElementById("color-by").disabled'), 'it has colours of its own')
    ramp = browser.picture(pictures and f'{pictures}/volume.png')
    choose(browser, '#opacity-preset', 'peaks')
    browser.wait(f'document.body.dataset.volume === "peaks" && {at_rest_in_full}')
    check(browser.picture() != ramp, 'peaks are another picture')
    points = browser.value('document.body.dataset.curve').split(',')
    check(len(points) > 6, f'the curve of the preset is shown: {points}')
    choose(browser, '#opacity-text', '0.3:0,0.7:0.3')
    browser.wait(f'document.body.dataset.volume === "0.3:0,0.7:0.3" && {at_rest_in_full}')
    check(browser.value('document.getElementById("opacity-preset").value') == '', 'points are no preset')

    browser.value('document.getElementById("opacity-curve").scrollIntoView()')
    x, y, w, h = browser.box('#opacity-curve')
    lower, upper = span(browser)
    at = x + (0.7 - lower) / (upper - lower) * w, y + 4 + (h - 8) * (1 - 0.3 ** 0.5)
    browser.value('window.numbers = []; new MutationObserver(() => numbers.push(Number(document.body.dataset.frame)))'
                  '.observe(document.body, {attributes: true, attributeFilter: ["data-frame"]})')
    browser.drag(at, (at[0] - 20, y + 6), steps=20)
    browser.wait('document.body.dataset.volume.endsWith(":" + document.body.dataset.curve.split(":").pop())')
    browser.wait(f'document.body.dataset.volume === document.body.dataset.curve && {at_rest_in_full}')
    dragged, opacity = map(float, browser.value('document.body.dataset.volume').split(',')[1].split(':'))
    check(dragged < 0.7 and opacity > 0.8, f'the point follows the hand: {dragged}:{opacity}')
    numbers = browser.value('numbers')
    check(numbers == sorted(numbers), f'no picture of the past comes late: {numbers}')

    before = browser.picture()
    browser.click('#volume-surfaces')
    browser.wait(f'Number(document.body.dataset.shown) === {value} && {at_rest_in_full}')
    check(browser.picture() != before, 'the surface is drawn with it')
    browser.wait('location.hash.includes("surfaces=1")')
    before, number = browser.picture(), browser.value('Number(document.body.dataset.frame)')
    browser.click('#volume-shaded')
    browser.wait(f'Number(document.body.dataset.frame) > {number} && location.hash.includes("shaded=1") && {at_rest_in_full}')
    check(browser.picture() != before, 'the volume is lit')
    curve = browser.value('document.body.dataset.curve')
    browser.click('#copy-render')
    browser.wait(f'document.getElementById("copied").textContent.includes("--volume --opacity {curve} --volume-shading")')
    browser.call('Page.reload')
    browser.wait('document.readyState === "complete" && document.body.dataset.shown !== undefined')
    browser.wait(f'document.body.dataset.volume === "{curve}" && {at_rest_in_full}')
    choose(browser, '#opacity-text', '0.5:0,0.3:1')
    browser.wait('document.getElementById("message").textContent.includes("ascend")')
    choose(browser, '#field', 'gyroid')
    browser.wait(f'document.body.dataset.volume === "ramp" && document.body.dataset.field === "gyroid" && {at_rest_in_full}')
    browser.click('#volume')
    browser.wait('document.body.dataset.volume === "" && document.body.dataset.picture === ""')


def test_without_webgl_the_server_draws(browser, viewer):
    script = browser.call('Page.addScriptToEvaluateOnNewDocument', source='HTMLCanvasElement.prototype.getContext = (get => function(kind, '
                          '...more) { return kind === "webgl2" ? null : get.call(this, kind, ...more); })(HTMLCanvasElement.prototype'
                          '.getContext)')['identifier']
    start(browser, viewer)
    browser.call('Page.removeScriptToEvaluateOnNewDocument', identifier=script)
    browser.wait('document.body.dataset.picture === "image/png"')
    check('no WebGL2' in browser.value('document.getElementById("facts").textContent'), 'the reason is told')
    check(0.1 < share_of_surface(browser) < 0.7, 'the surface is in the picture')
    browser.key('1')
    browser.wait('document.body.dataset.camera.split(":")[2] === "0,-1,0"')
    at_rest(browser)


def test_save(browser, viewer):
    """By name into the folder of --out; without it as downloads only."""
    start(browser, viewer)
    browser.click('#save-open')
    check(browser.value('document.querySelector("#save-to [value=out]").disabled'), 'without --out nothing is saved on the server')
    browser.key('Escape')
    with tempfile.TemporaryDirectory() as folder, Viewer(GRID, '--out', folder) as other:
        start(browser, other)
        browser.value('document.activeElement.blur()')
        browser.key('s')
        browser.wait('document.getElementById("save").open')
        for kind, name in (('picture.png', 'a picture.png'), ('surface.ply', 'a.ply'), ('turn.webp', 'turn.webp')):
            choose(browser, '#save-kind', kind)
            choose(browser, '#save-to', 'out')
            for field, value in (('name', name), ('width', '200'), ('height', '150'), ('pictures', '3')):
                choose(browser, '#save-' + field, value)
            browser.picture(pictures and f'{pictures}/save-{kind}.png')
            browser.click('#save-go')
            browser.wait('document.getElementById("save-told").textContent.startsWith("Saved")')
            check(os.path.getsize(f'{folder}/{name}') > 1000, f'{name} is there')
        choose(browser, '#save-name', 'turn.webp')
        browser.click('#save-go')
        browser.wait('document.getElementById("save-told").textContent.includes("there already")')
        choose(browser, '#save-name', '../turn2.webp')
        browser.click('#save-go')
        browser.wait('document.getElementById("save-told").textContent.includes("no name of a file")')
        check(len(os.listdir(folder)) == 3, 'nothing else was written')
        browser.call('Page.navigate', url='about:blank')


def test_labels_full_screen_and_reset(browser, viewer):
    start(browser, viewer)
    type_value(browser, '0.7')
    at_rest(browser, 0.7)
    browser.wait(f'document.body.dataset.caption === "{GRID}  ·  sphere = 0.7"')
    browser.click('#pin')
    type_value(browser, '0.5')
    at_rest(browser, 0.5)
    browser.wait(f'document.body.dataset.caption === "{GRID}  ·  sphere = 0.5, 0.7"')
    choose(browser, '#color-by', 'gyroid')
    browser.wait('document.getElementById("range-upper").value !== ""')
    at_rest(browser)
    browser.picture(pictures and f'{pictures}/labels.png')
    painted = 'labels.getContext("2d").getImageData(0, 0, labels.width, labels.height).data.some(v => v !== 0)'
    check(browser.value(painted), 'a scale is there')
    browser.value('document.activeElement.blur()')
    browser.key('l')
    browser.wait(f'document.body.dataset.caption === "" && !({painted})')
    browser.key('h')
    check(browser.value('scene.clientWidth === innerWidth'), 'the picture takes the place of the panel')
    browser.key('h')
    browser.click('#full-screen')
    browser.wait('document.fullscreenElement !== null')
    browser.click('#full-screen')
    browser.wait('document.fullscreenElement === null')
    browser.click('#reset')
    browser.wait('document.querySelectorAll("#surfaces li").length === 1 && document.getElementById("color-by").value === ""')
    at_rest(browser)
    check(browser.value('document.getElementById("labels-on").checked'), 'labels are there again')
    browser.value('history.back()')
    browser.wait('document.querySelectorAll("#surfaces li").length === 2 && document.getElementById("color-by").value === "gyroid"')


def test_notes_stay(browser, viewer):
    """Notes about the file are in a list until that is closed, whatever frames come."""
    with tempfile.TemporaryDirectory() as folder:
        with open(f'{folder}/two.vtk', 'w') as file:
            file.write('# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n'
                       '0 0 0 1 0 0 0 1 0 0 0 1\n1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 4 5 6 7\nCELL_TYPES 2\n10 10\n'
                       'POINT_DATA 8\nSCALARS p float\nLOOKUP_TABLE default\n0 1 1 1 1 1 1 2\n')
        with Viewer(f'{folder}/two.vtk') as other:
            start(browser, other)
            type_value(browser, '0.5')
            at_rest(browser, 0.5)
            check('coincide' in browser.value('document.getElementById("notes-list").textContent'), 'the note is there')
            count = browser.value('document.getElementById("notes-list").childElementCount')
            title = browser.value('document.getElementById("notes-title").textContent')
            check(title == f'{count} note' + ('s' if count > 1 else ''), 'and counted')
            check(browser.value('document.getElementById("message").hidden'), 'no message covers the picture')
            browser.call('Page.navigate', url='about:blank')


def test_downloads(browser, viewer):
    """Without --out: the picture as seen, and files that isotet writes, in several parts where they are large."""
    start(browser, viewer)
    type_value(browser, '0.7')
    at_rest(browser, 0.7)
    with tempfile.TemporaryDirectory() as folder:
        browser.downloads(folder)
        browser.click('#save-open')
        browser.wait('document.getElementById("save").open')

        def download(kind, name):
            choose(browser, '#save-kind', kind)
            check(browser.value('document.getElementById("save-name").value') == name, browser.value('document.getElementById("save-name").value'))
            browser.click('#save-go')
            browser.wait(f'document.getElementById("save-told").textContent === "Downloaded: {name}"')
            return browser.downloaded(f'{folder}/{name}')

        stem = GRID.replace(':', '_').replace(',', '_') + '-sphere-0.7'
        width, height, _ = pixels(download('seen.png', f'{stem}.png'))
        check([width, height] == browser.value('[scene.clientWidth, scene.clientHeight]'), f'{width} x {height}')
        stl = download('surface.stl', f'{stem}-1.stl')
        triangles = int(browser.value('document.body.dataset.triangles'))
        check(len(stl) == 84 + 50 * triangles and struct.unpack('<I', stl[80:84])[0] == triangles, f'{len(stl)} bytes')
        command = browser.value('document.getElementById("save-command").textContent')
        check('isotet extract' in command and command.endswith(f'-o {stem}-2.stl'), command)
        browser.picture(pictures and f'{pictures}/download.png')
        solid = download('above.stl', f'{stem}-above-2.stl')
        inside, = struct.unpack('<I', solid[80:84])
        check(inside > triangles and len(solid) == 84 + 50 * inside, f'the solid is closed by the boundary of the grid: {inside} triangles')
        check('--solid above' in browser.value('document.getElementById("save-command").textContent'), 'the command is that of the solid')
        check(download('surface.vtp', f'{stem}-3.vtp').startswith(b'<?xml'), 'a VTP')
        browser.key('Escape')


def check_picture(browser, most=0.03):
    """The page beside `isotet render` of the copied command: at rest nearly all pixels agree, edges aside."""
    browser.value('document.getElementById("copied").textContent = ""')
    browser.click('#copy-render')
    browser.wait('document.getElementById("copied").textContent.includes("--camera")')
    browser.value('new Promise(done => setTimeout(done, 400))')
    x, y, w, h = (int(v) for v in browser.box('#scene'))
    _, _, page = pixels(browser.picture())
    words = shlex.split(browser.value('document.getElementById("copied").textContent'))
    with tempfile.TemporaryDirectory() as folder:
        path = f'{folder}/picture.png'
        subprocess.run([os.environ['ISOTET_PROGRAM'], *words[1:-1], path, '--plain', '--size', f'{w}x{h}', '-q'], check=True)
        with open(path, 'rb') as file:
            width, height, drawn = pixels(file.read())
    check((width, height) == (w, h), 'the sizes are the same')
    differ = count = 0
    for j in range(0, int(0.85 * h), 3):
        for i in range(0, w, 3):
            a, b = page[y + j][3 * (x + i):3 * (x + i) + 3], drawn[j][3 * i:3 * i + 3]
            count += b != b'\xff\xff\xff'
            differ += max(abs(p - q) for p, q in zip(a, b)) > 12
    check(count > 2000, f'the renderer shows the surface: {count}')
    check(differ < most * count, f'{differ} of {count} pixels differ')



def test_the_picture_is_that_of_the_renderer(browser, viewer):
    """WebGL beside `isotet render`."""
    start(browser, viewer, '&labels=0')
    browser.click('#value')
    type_into(browser, 'value', '0.7')
    at_rest(browser, 0.7)
    choose(browser, '#boundary', '0')
    choose(browser, '#color-by', 'gyroid')
    browser.value('document.activeElement.blur()')
    browser.wait('document.getElementById("range-upper").value !== "" && !document.body.dataset.kinds.includes("boundary")')
    at_rest(browser)
    check_picture(browser)


def test_the_first_view_is_that_of_the_renderer(browser, viewer):
    """The points of the boundary fill the picture, not the corners of the box."""
    data = os.path.join(os.path.dirname(__file__), '../../data')
    numbers = lambda camera: [float(v) for part in camera.split(':')[1:] for v in part.split(',')]
    for name in (f'{data}/gocad/geomodel3d_tsolid.so', f'{data}/vtu/artery_flow_tet_wedge.vtu'):
        with Viewer(name) as other:
            start(browser, other)
            browser.wait('document.body.dataset.kinds.includes("boundary")')
            w, h = browser.value('[scene.clientWidth, scene.clientHeight]')
            with tempfile.TemporaryDirectory() as folder:
                run = subprocess.run([os.environ['ISOTET_PROGRAM'], 'render', name, f'{folder}/p.png', '--plain', '--size', f'{w}x{h}', '--json', '-', '-q'],
                                     check=True, capture_output=True, text=True)
            wanted, page = json.loads(run.stdout)['camera'], browser.value('document.body.dataset.camera')
            size = numbers(wanted)[9]
            far = [abs(a - b) / (size if i < 3 or i == 9 else 1) for i, (a, b) in enumerate(zip(numbers(page), numbers(wanted)))]
            check(max(far[:-1]) < 1e-4, f'{name}: {page} and {wanted}')
            browser.call('Page.navigate', url='about:blank')


def test_heights_and_the_axis_upwards(browser, viewer):
    """Stretched as `isotet render --scale` has it; points and planes stay those of the grid."""
    start(browser, viewer, '&f=sphere&labels=0&boundary=0&i=0.7')
    before = browser.value('document.body.dataset.camera')
    browser.click('#heights-text')
    type_into(browser, 'heights-text', '3')
    browser.wait(f'document.body.dataset.camera !== "{before}" && location.hash.includes("stretch=1%2C1%2C3")')
    check(abs(float(browser.value('document.getElementById("heights").value')) - 0.477) < 0.01, 'the slider follows')
    browser.value('document.activeElement.blur()')
    browser.key('f')
    choose(browser, '#color-by', 'gyroid')
    browser.wait('document.getElementById("range-upper").value !== ""')
    browser.value('document.activeElement.blur()')
    at_rest(browser)
    browser.click('#add-clip')
    browser.wait('document.querySelectorAll("#cuts li").length === 1')
    browser.value('document.querySelector("#cuts .axis").value = "free"; document.querySelector("#cuts .axis").dispatchEvent(new Event("change"))')
    browser.value('document.querySelector("#cuts .normal").value = "0.2, 0, 1"; document.querySelector("#cuts .normal").dispatchEvent(new Event("change"))')
    browser.value('document.activeElement.blur()')
    check_picture(browser, 0.06)  # a clipped edge is long
    check('--scale 1,1,3' in browser.value('document.getElementById("copied").textContent'), 'the command says it')
    places = []
    for drawn in ('', 'server'):
        choose(browser, '#drawn-by', drawn)
        browser.wait(f'document.body.dataset.picture === "{drawn and "image/png"}"')
        at_rest(browser)
        browser.value('document.activeElement.blur()')
        browser.key('v')
        browser.wait('document.body.dataset.picked')
        picked = json.loads(browser.value('document.body.dataset.picked'))
        value = next(one['values'][0] for one in picked['values'] if one['name'] == 'sphere')
        check(abs(value - 0.7) < 1e-4, f'a point of the surface: {picked}')
        places.append(picked['point'])
        browser.key('Escape')
    check(max(abs(a - b) for a, b in zip(*places)) < 0.02, f'both ways the same point: {places}')
    choose(browser, '#drawn-by', '')
    choose(browser, '#up', 'y')
    browser.wait('document.body.dataset.camera.split(":")[3].split(",")[1] > 0.5 && location.hash.includes("up=y") && location.hash.includes("stretch=1%2C3%2C1")')
    browser.value('document.activeElement.blur()')
    browser.key('1')
    browser.wait('document.body.dataset.camera.includes(":0,0,1:0,1,0:") && location.hash.includes("%3A0%2C0%2C1%3A0%2C1%2C0%3A")')
    browser.value('history.back()')
    browser.wait('document.getElementById("up").value === "y" && !document.body.dataset.camera.includes(":0,0,1:0,1,0:")')
    browser.value('window.isOld = true, location.reload()')
    browser.wait('!window.isOld && document.getElementById("up")?.value === "y" && document.getElementById("heights-text")?.value === "3"')
    browser.call('Page.navigate', url='about:blank')


class Proxy:
    """Answers below /node/host/ with what the viewer says, as JupyterHub and Open OnDemand do, and at / with a frame."""

    def __init__(self, port, token):
        self.to, self.token, self.dead = port, token, False
        self.listener = socket.create_server(('127.0.0.1', 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                connection, _ = self.listener.accept()
            except OSError:
                return
            threading.Thread(target=self.pass_on, args=(connection,), daemon=True).start()

    def pass_on(self, connection):
        head = b''
        while b'\r\n\r\n' not in head:
            part = connection.recv(65536)
            if not part:
                return
            head += part
        if not head.startswith(b'GET /node/host/'):
            body = f'<iframe src="/node/host/#{self.token}" width="900" height="600"></iframe>'.encode()
            connection.sendall(b'HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nConnection: close\r\nContent-Length: %d\r\n\r\n' % len(body) + body)
            return connection.close()
        other = socket.create_connection(('127.0.0.1', self.to))
        other.sendall(head.replace(b'GET /node/host/', b'GET /', 1))

        def copy(a, b):
            try:
                while part := a.recv(65536):
                    if not self.dead:
                        b.sendall(part)
            except OSError:
                pass
            for one in (a, b):
                try:
                    one.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass
        threading.Thread(target=copy, args=(connection, other), daemon=True).start()
        copy(other, connection)


def test_in_a_frame_below_a_proxy_path(browser, viewer):
    proxy = Proxy(viewer.port, viewer.address.split('#')[1])
    browser.call('Page.navigate', url='about:blank')
    browser.open(f'http://127.0.0.1:{proxy.port}/')
    inside = 'document.querySelector("iframe").contentDocument'
    browser.wait(f'{inside}?.body?.dataset.shown !== undefined && {inside}.body.dataset.preview === "false"')
    check(browser.value(f'{inside}.defaultView.location.pathname') == '/node/host/', 'it stays below the path')
    browser.picture(pictures and f'{pictures}/frame.png')
    browser.call('Page.navigate', url='about:blank')
    proxy.listener.close()


def test_unix_socket(browser, viewer):
    with tempfile.TemporaryDirectory() as folder:
        path = f'{folder}/socket'
        with Viewer('make:kuhn:4:sphere', '--listen', f'unix:{path}'):
            check(os.stat(path).st_mode & 0o777 == 0o600, 'only its owner may open it')
            with socket.socket(socket.AF_UNIX) as to:
                to.connect(path)
                to.sendall(b'GET / HTTP/1.1\r\nHost: localhost:8123\r\n\r\n')
                check(to.recv(65536).startswith(b'HTTP/1.1 200'), 'it gives the page')
        check(not os.path.exists(path), 'the socket goes with the program')


def test_wrong_token(browser, viewer):
    browser.call('Page.navigate', url='about:blank')
    browser.open(viewer.address.split('#')[0] + '#0123456789')
    browser.wait('document.getElementById("message").textContent.includes("earlier run")')


def overlaps(browser):
    """Texts that are cut, and controls over others."""
    return browser.value('''(() => {
      const bad = [], seen = [...document.querySelectorAll('#panel button, #panel input, #panel select, #panel h2, #slider')]
        .filter(e => e.getClientRects().length && !e.closest('.unseen')).map(e => [e, e.getBoundingClientRect()]);
      for (const [e, b] of seen) {
        if (b.left < -0.5 || b.right > innerWidth + 0.5) bad.push('outside: ' + (e.id || e.textContent));
        if (e.scrollWidth > e.clientWidth + 1 && e.tagName === 'BUTTON') bad.push('cut: ' + (e.id || e.textContent));
      }
      for (let i = 0; i < seen.length; ++i) for (let j = i + 1; j < seen.length; ++j) {
        const [a, p] = seen[i], [b, q] = seen[j];
        if (a.contains(b) || b.contains(a)) continue;
        if (p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 1 && q.top < p.bottom - 1)
          bad.push('over each other: ' + (a.id || a.textContent) + ', ' + (b.id || b.textContent));
      }
      if (document.documentElement.scrollWidth > innerWidth) bad.push('the page scrolls sideways');
      return bad;
    })()''')


def test_layout(browser, viewer):
    for width, height, ratio in ((1280, 720, 1), (390, 844, 1), (1280, 720, 2)):
        browser.resize(width, height, ratio)
        try:
            start(browser, viewer)
            browser.click('#pin')
            browser.wait('document.body.dataset.spectrum !== ""')
            choose(browser, '#curve', 'area')
            browser.wait(f'scene.width === {ratio} * scene.clientWidth')  # the pixels of the screen, at rest
            check(overlaps(browser) == [], f'{width} x {height}: {overlaps(browser)}')
            browser.picture(pictures and f'{pictures}/{width}x{height}@{ratio}.png')
        finally:
            browser.resize(1280, 720)


def contrasts(browser):
    """Texts below 4.5 : 1 against what is behind them."""
    return browser.value('''(() => {
      const rgb = t => t.match(/[\\d.]+/g).map(Number);
      const light = c => { const [r, g, b] = c.map(v => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; });
        return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
      const behind = e => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c.length === 3 || c[3] > 0) return c.slice(0, 3); } return [255, 255, 255]; };
      const bad = [];
      for (const e of document.querySelectorAll('h1, h2, span, label, button, select, input, p, li')) {
        if (!e.getClientRects().length || e.matches('[type=color], [type=range], [type=checkbox]')) continue;
        const a = light(rgb(getComputedStyle(e).color).slice(0, 3)), b = light(behind(e));
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        if (ratio < 4.5) bad.push((e.id || e.textContent || e.tagName) + ' ' + ratio.toFixed(2));
      }
      return bad;
    })()''')


def test_contrast_light_and_dark(browser, viewer):
    for scheme in ('light', 'dark'):
        browser.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': scheme}])
        start(browser, viewer)
        check(contrasts(browser) == [], f'{scheme}: {contrasts(browser)}')
        browser.picture(pictures and f'{pictures}/{scheme}.png')
    browser.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': 'light'}])


def test_end(browser, viewer):
    start(browser, viewer)
    check(viewer.stop() == 0, 'Ctrl-C ends it without an error')
    browser.wait('!document.getElementById("lost").hidden')
    check('No connection' in browser.value('document.getElementById("lost").textContent'), 'the page says so at once')


def test_a_file_that_cannot_be_read_is_told_in_the_page(browser, viewer):
    with tempfile.TemporaryDirectory() as folder:
        with open(f'{folder}/bad.vtk', 'w') as file:
            file.write('# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n'
                       'CELLS 1 5\n4 0 1 2 9\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS p float\nLOOKUP_TABLE default\n0 1 1 1\n')
        with Viewer(f'{folder}/bad.vtk') as other:
            browser.open(other.address)
            browser.wait('document.getElementById("message").textContent.includes("has point 9") && !document.getElementById("lost").hidden')
            check('has ended' in browser.value('document.getElementById("lost").textContent'), 'it does not try again')
            check(other.process.wait(20) == 3, 'the exit status is that of a broken file')
            check('has point 9' in other.process.stderr.read(), 'and the terminal tells it, too')


def test_a_line_that_is_dead_is_noticed(browser, viewer):
    """A line that passes nothing on, and does not end: the page tries again by itself."""
    with Viewer(GRID) as other:
        proxy = Proxy(other.port, '')
        browser.open(f'http://127.0.0.1:{proxy.port}/node/host/#{other.address.split("#")[1]}')
        browser.wait('document.body.dataset.shown !== undefined')
        at_rest(browser)
        proxy.dead = True
        browser.value('document.body.dataset.silence = 1000')
        browser.wait('document.body.dataset.link === "lost"')
        proxy.dead = False
        browser.value('delete document.body.dataset.silence')
        browser.wait('document.body.dataset.link === "open"')
        at_rest(browser)
        proxy.listener.close()
        browser.call('Page.navigate', url='about:blank')


def test_ends_with_ssh(browser, viewer):
    """Without a terminal, ssh's end is that of its lines."""
    process = subprocess.Popen([os.environ['ISOTET_PROGRAM'], 'view', 'make:kuhn:4:sphere'], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, env=dict(os.environ, SSH_CONNECTION='10.0.0.1 1 10.0.0.2 22'))
    check(process.stdout.readline().startswith(b'http://'), 'it serves')
    process.stdin.close()
    process.stdout.close()
    check(process.wait(20) == 0, 'it ends without an error')


def main():
    wanted = sys.argv[1:]
    state = tempfile.TemporaryDirectory()  # for the tokens of viewers
    os.environ['XDG_STATE_HOME'] = state.name
    tests = [f for name, f in globals().items() if name.startswith('test_') and (not wanted or name in wanted)]
    failures = []
    with Viewer(GRID, '--keep') as viewer:  # while pages of other viewers are tried
        browser = Browser()
        try:
            for test in tests:
                try:
                    browser.errors.clear()
                    test(browser, viewer)
                    errors = [e for e in browser.errors if 'WebSocket connection' not in e]
                    check(not errors, f'errors of the page: {errors}')
                    print('ok', test.__name__, flush=True)
                except Exception:
                    failures.append(f'FAILED {test.__name__}\n{traceback.format_exc()}')
                    print('FAILED', test.__name__, flush=True)
        finally:
            browser.close()
    print(*failures, sep='\n')
    return 1 if failures else 0


sys.exit(main())
