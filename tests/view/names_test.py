# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Hostile names of fields, regions, blocks and files, and hostile addresses, in pages of one file: nothing of them runs or is loaded, and
they are shown as text. ISOTET_SEED chooses other names."""
import json
import os
import random
import sys
import tempfile
import urllib.parse

from chromium import Browser
from pages import check, choose, has_module, isotet, run_tests

SEED = int(os.environ.get('ISOTET_SEED', '1'))
# Each sets `hacked`, loads something, or breaks out of where names stand.
PARTS = ['<img src=x onerror=hacked=1>', '<svg onload=hacked=1>', '</script><script>hacked=1</script>', '</title><script>hacked=1</script>',
         '<!--<script>', '-->', ']]>', '</style>', '</textarea>', '" autofocus onfocus=hacked=1 x="', "' onmouseover='hacked=1",
         '&lt;script&gt;hacked=1&lt;/script&gt;', '&#x3c;b>', '&quot;', '&amp', '&', 'javascript:hacked=1',
         'data:text/html,<script>hacked=1</script>', '${hacked=1}', '`${hacked=1}`', '{{hacked=1}}', '\\u003cscript>hacked=1\\u003c/script>',
         '\\x3cb>', '%3Cscript%3Ehacked=1%3C/script%3E', '%', '\\', '"', "'", ';hacked=1//', "'-(hacked=1)-'", '");hacked=1;//',
         '<iframe srcdoc="<script>top.hacked=1</script>">', '<base href=https://evil.invalid/>', '<link rel=stylesheet href=https://evil.invalid/>',
         '<style>*{background:url(https://evil.invalid/)}</style>', 'url(https://evil.invalid/x)',
         '<meta http-equiv=refresh content=0;url=https://evil.invalid/>', '<a href=javascript:hacked=1>',
         '<form action=https://evil.invalid/><button>', 'id=worker', '<script id=worker type=text/plain>aGFja2VkPTE=</script>', '__proto__',
         'constructor', 'toString', 'hasOwnProperty', 'prototype', 'then', 'valueOf', '&f=x', '#', '?', '=', ',', ':', '!', '+', '*', '(', '-', '..',
         '\u2028', '\u2029', '\u202e\u05d0\u05d1', '\u2066', '\ufeff', '\u200b', '\ufffe', '\U0010ffff', '\U0001f600', 'e\u0301', '\x01', '\x1b[31m',
         '\n', '\r', '\t', '\x7f', '\x85', 'A' * 3000]
BYTES = [b'\x00', b'\xed\xa0\x80', b'\xed\xb0\x80', b'\xff', b'\xc0\xbc', b'\xf4\x90\x80\x80', b'\xe2\x80']  # a zero, halves of pairs, no UTF-8
KEYS = ['f', 'i', 'c', 'o', 'pin', 'by', 'map', 'range', 'logarithmic', 'boundary', 'isosurfaces', 'solid', 'keep', 'clip', 'slice', 'step', 'drawn',
        'span', 'scale', 'volume', 'length', 'hidden', 'cells', 'up', 'stretch', 'labels', 'camera', '__proto__']
NUMBERS = ['0', '-1', '1e999', 'NaN', '-Infinity', '1e308', '9007199254740993', '0x10', '1,2', '1,2,3', '0,0,0,0', '1,0,0,1e308', '1e-320,0,0,0', '']
DANGEROUS = 'img,iframe,object,embed,base,a,style,link,script,meta,form,video,svg,b,textarea'


class Watched(Browser):
    """It remembers what no name may do."""

    def __init__(self):
        self.heard = []
        super().__init__(480, 400)
        self.call('Network.enable')
        self.call('Page.addScriptToEvaluateOnNewDocument', source='addEventListener("securitypolicyviolation", '
                  '(event) => console.error("policy", event.violatedDirective, event.blockedURI));')

    def receive(self, limit):
        message = super().receive(limit)
        method, told = message.get('method'), message.get('params', {})
        if method == 'Page.javascriptDialogOpening':
            self.heard.append(f'a dialog: {told["message"]}')
            self.send('Page.handleJavaScriptDialog', accept=False)
        elif method == 'Network.requestWillBeSent' and not told['request']['url'].startswith(('file:', 'data:', 'blob:', 'about:')):
            self.heard.append(f'a request: {told["request"]["url"]}')
        elif method == 'Runtime.consoleAPICalled' and told['type'] in ('error', 'assert', 'warning'):
            self.heard.append(f'{told["type"]}: {[one.get("value") for one in told["args"]]}')
        elif method in ('Page.windowOpen', 'Page.frameRequestedNavigation'):
            self.heard.append(f'{method}: {told.get("url")}')
        return message


def fuzzed(random_, count, most=10 ** 4, letters=lambda name: name):
    """Names as bytes: each part alone, then some of them behind each other."""
    parts = [part.encode() for part in PARTS] + BYTES
    names = [letters(b'n' + part)[:most] for part in parts[:count]]
    while len(names) < count:
        names.append(letters(b''.join(random_.choices(parts, k=random_.randint(1, 6))))[:most])
    return [name for i, name in enumerate(names) if name and name not in names[:i]]


def cube(side):
    """Points and tets, six a cube."""
    places = range(side + 1)
    points = [(x, y, z) for z in places for y in places for x in places]
    at = lambda x, y, z: (z * (side + 1) + y) * (side + 1) + x
    paths = [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
    tets = []
    for start in [(x, y, z) for z in range(side) for y in range(side) for x in range(side)]:
        for path in paths:
            corner, corners = list(start), [at(*start)]
            for axis in path:
                corner[axis] += 1
                corners.append(at(*corner))
            tets.append(corners)
    return points, tets


def write_vtk(path, names, cell_names=(), side=3):
    """A field of each name; legacy VTK has any byte as %XX."""
    points, tets = cube(side)
    lines = ['# vtk DataFile Version 3.0', '</script><script>hacked=1</script>', 'ASCII', 'DATASET UNSTRUCTURED_GRID', f'POINTS {len(points)} float']
    lines += [' '.join(map(str, point)) for point in points] + [f'CELLS {len(tets)} {5 * len(tets)}'] + [' '.join(map(str, [4, *tet])) for tet in tets]
    lines += [f'CELL_TYPES {len(tets)}', *['10'] * len(tets)]
    for kind, all_names, values in [('POINT', names, [x - y + z + 0.1 for x, y, z in points]), ('CELL', cell_names, range(len(tets)))]:
        lines.append(f'{kind}_DATA {len(values)}')
        for i, name in enumerate(all_names):
            lines += [f'SCALARS {urllib.parse.quote(name, safe="")} float', 'LOOKUP_TABLE default', ' '.join(str(value + i) for value in values)]
    with open(path, 'w', encoding='ascii') as file:
        file.write('\n'.join(lines) + '\n')


def write_regions(path, names):
    """Gmsh: a group of cells of each name."""
    points, tets = cube(3)
    lines = ['$MeshFormat', '2.2 0 8', '$EndMeshFormat', '$PhysicalNames', str(len(names)), *[f'3 {i + 1} "{name}"' for i, name in enumerate(names)]]
    lines += ['$EndPhysicalNames', '$Nodes', str(len(points)), *[f'{i + 1} {x} {y} {z}' for i, (x, y, z) in enumerate(points)], '$EndNodes', '$Elements', str(len(tets))]
    lines += [f'{i + 1} 4 2 {i % len(names) + 1} 1 ' + ' '.join(str(corner + 1) for corner in tet) for i, tet in enumerate(tets)] + ['$EndElements', '']
    with open(path, 'w', encoding='utf-8', newline='\n') as file:
        file.write('\n'.join(lines))


def load(browser, path, extra='', there='Number(document.body.dataset.triangles) > 0'):
    browser.call('Page.navigate', url='about:blank')
    browser.open('file://' + urllib.parse.quote(os.fsencode(path)) + extra)
    browser.wait(there, 60)


def elements(browser):
    """How many there are of each kind that names could bring."""
    return browser.value('Object.fromEntries(%s.map((kind) => [kind, document.querySelectorAll(kind).length]))' % json.dumps(DANGEROUS.split(',')))


def check_harmless(browser, what, usual=None):
    browser.value('new Promise((done) => setTimeout(done, 30))')
    found = browser.value('[window.hacked, ...[...document.querySelectorAll("*")].flatMap((one) => [...one.attributes].filter(({name, value}) => '
                          '/^(on.*|autofocus)$/i.test(name) || (/^(href|src|action)$/.test(name) && !/^(data:,$|blob:|#)/.test(value))).map(({name}) => name))]')
    check(found == [None], f'seed {SEED}, {what}: a name ran, or has an attribute: {found}')
    check(usual is None or elements(browser) == usual, f'seed {SEED}, {what}: {elements(browser)} in place of {usual}')
    check(not browser.heard and not browser.errors, f'seed {SEED}, {what}: {browser.heard} {browser.errors}')


def usual_elements(browser, folder, *words):
    """Of such a page whose names are harmless."""
    grid, path = os.path.join(folder, 'harmless.vtk'), os.path.join(folder, 'harmless.html')
    write_vtk(grid, [b'a', b'b'], [b'c'])
    isotet('export', grid, path, '-f', 'a', *words)
    load(browser, path)
    return elements(browser)


def choose_value(browser, select, value):
    browser.value('(() => { const s = document.getElementById(%s); s.value = %s; s.dispatchEvent(new Event("change")); })()' % (json.dumps(select), json.dumps(value)))


def seen(names):
    """As pages show them: with a mark for what is no UTF-8."""
    return [name.decode(errors='replace') for name in names]


def is_text(name):
    return name.decode(errors='ignore').encode() == name


def hostile_grid(folder, number):
    """Its path, whose name is hostile, too."""
    random_ = random.Random(SEED)
    names = fuzzed(random_, 170)
    cells = [b'c' + name for name in random_.sample(names, 12)]
    file_names = ['<img src=x onerror=hacked=1>"\'&\u202e\u05d0\u2028\n\x1b\U0001f600.vtk', '-->\'"><script>hacked=1;\\u003c`${hacked=1}`\n&quot;.vtk', '__proto__.vtk']
    path = os.path.join(folder, file_names[number])
    write_vtk(path, names, cells)
    return path, names, cells


def module_test_names_of_fields(browser, folder):
    """In a page with the grid: each field is listed by its name, and shown."""
    usual = usual_elements(browser, folder, '--as', 'grid', '--color-by', 'b')
    grid, names, cells = hostile_grid(folder, 0)
    path = os.path.join(folder, '<b>&"\'.html')
    report = isotet('export', grid, path, '--as', 'grid', '-i', '1.6', '--color-by', 'n' + PARTS[0])
    check(len(report['fields']) == len(names), f'{len(report["fields"])} of {len(names)} fields are there')
    load(browser, path)
    check(browser.value('document.getElementById("file").textContent') == os.path.basename(grid), 'the name of the file is text')
    told = seen(names)
    check(browser.value('[...document.getElementById("field").options].map(({value}) => value)') == told, 'fields are listed by their names')
    check(browser.value('[...document.getElementById("field").options].map(({text}) => text.length)') ==
          browser.value('(%s).map((name) => new Option(name).text.length)' % json.dumps(told)), 'as text')
    check_harmless(browser, 'fields', usual)
    for name in random.Random(SEED).sample([name.decode() for name in names if is_text(name)], 40):
        choose_value(browser, 'color-by', name)
        choose_value(browser, 'field', name)
        browser.wait('document.body.dataset.field === %s && Number(document.body.dataset.triangles) > 0' % json.dumps(name))
    browser.wait('document.body.dataset.caption.includes(%s)' % json.dumps(name[:50]))
    check_harmless(browser, 'fields that are shown', usual)
    x, y, w, h = browser.box('#scene')
    browser.drag((x + w / 2, y + h / 2), (x + w / 2, y + h / 2), steps=1)
    browser.wait('document.body.dataset.picked !== undefined')
    rows = browser.value('[...document.querySelectorAll("#picked-rows th")].map((one) => one.textContent)')
    check(set(told) <= set(rows), 'values at a point have the names as text')
    check_harmless(browser, 'values at a point', usual)


def test_names_in_surfaces(browser, folder):
    """In pages of isosurfaces: field, colours and file."""
    usual = usual_elements(browser, folder, '--as', 'surfaces', '--surfaces', '2', '--color-by', 'b')
    for number in range(3):
        grid, names, _ = hostile_grid(folder, number)
        random_ = random.Random(SEED + number)
        field, colors = random_.sample([name.decode() for name in names if b'\0' not in name and is_text(name) and len(name) < 3000], 2)
        path = os.path.join(folder, f'surfaces-{number}.html')
        isotet('export', grid, path, '--as', 'surfaces', '--surfaces', '2', f'--field={field}', f'--color-by={colors}')
        load(browser, path)
        shown = browser.value('["field", "color-by"].map((name) => document.getElementById(name).value)')
        check(shown == [field, colors], f'{shown} are {[field, colors]}')
        visible = lambda text: [letter for letter in text if letter > ' ']
        check(visible(browser.value('document.title')) == visible(f'{os.path.basename(grid)} – isotet'), 'the title is text')
        check_harmless(browser, f'{[field, colors]}', usual)


def test_names_of_regions(browser, folder):
    """Listed, hidden one after another, and named by the address."""
    grid, path = os.path.join(folder, 'regions.msh'), os.path.join(folder, 'regions.html')
    names = ['<img src=x onerror=hacked=1>', '</script><script>hacked=1</script>', '&lt;b&gt;', '__proto__', 'constructor', 'a,b', '\u202e\u05d0\u2028', '${hacked=1}',
             "' onclick='hacked=1"]
    write_regions(grid, names)
    isotet('export', grid, path, '--as', 'surfaces')
    load(browser, path, there='document.body.dataset.kinds === "boundary" && document.body.dataset.classes !== ""')
    listed = browser.value('[...document.querySelectorAll("#regions-list .check")].map((one) => one.textContent)')
    check(sorted(listed) == sorted(names), f'{listed} are {names}')
    usual = elements(browser)
    for i, name in enumerate(listed):
        browser.value(f'document.querySelector("#regions-list li:nth-child({i + 1}) button").click()')
        browser.wait('document.body.dataset.hidden === %s' % json.dumps(' '.join(one for one in listed if one != name)))
    check_harmless(browser, names, usual)


def test_addresses(browser, folder):
    """What stands behind # is anybody's: nonsense in it is left out, and the page goes on."""
    grid, path = os.path.join(folder, 'steps.vtk'), os.path.join(folder, 'address.html')
    write_vtk(grid, [b'a', b'b'])
    for way in ['surfaces'] + (['grid'] if has_module(folder) else []):
        isotet('export', grid, path, '-f', 'a', '--color-by', 'b', '--as', way, *(['--surfaces', '3'] if way == 'surfaces' else []))
        load(browser, path)
        usual = elements(browser)
        random_ = random.Random(SEED)
        values = [urllib.parse.quote(part[:300]) for part in PARTS] + ['%00', '%ff', '%ed%a0%80', '%', '%%3'] + NUMBERS
        single = [f'&{key}={value}' for key in KEYS for value in random_.sample(values, 2) + ['constructor', '99']]
        several = ['&' + '&'.join(f'{key}={random_.choice(values)}' for key in random_.choices(KEYS, k=8)) for _ in range(25)]
        for state in single + several:
            browser.value('(async () => { location.hash = %s; await new Promise(requestAnimationFrame); })()' % json.dumps(state))
            found = browser.value('window.hacked === undefined')
            check(found and not browser.errors and not browser.heard, f'seed {SEED}, {way} {state}: {browser.errors} {browser.heard}')
        check_harmless(browser, way, usual)
        for state in ['&map=constructor', '&f=__proto__', '&step=99', '&i=1e999&pin=NaN,<b>,2', '&camera=constructor'] + several[:2]:
            load(browser, path, '#' + state, there='document.body.dataset.grid !== undefined && document.body.dataset.step === "ready"')
            check_harmless(browser, f'{way} {state}', usual)
        browser.value('location.hash = "&f=a&i=1.6"')
        browser.wait('document.body.dataset.field === "a" && Number(document.body.dataset.triangles) > 0')


def test_names_of_saved_files(browser, folder):
    """Typed names lead out of no folder; those that the page proposes have letters that every system takes."""
    grid, _, _ = hostile_grid(folder, 0)
    path, saved = os.path.join(folder, 'save.html'), os.path.join(folder, 'outer', 'saved')
    os.makedirs(saved)
    isotet('export', grid, path, '--as', 'surfaces', '-i', '1.6', f'--field=n{PARTS[2]}')
    load(browser, path)
    usual = elements(browser)
    browser.downloads(saved)
    hostile = ['../../out', '/etc/out', '<img src=x onerror=hacked=1>', '..\\out', 'a\u202e', '\u2028', '${hacked=1}', 'javascript:hacked=1', '', '%2e%2e%2fout', 'A' * 400]
    for kind, ending in [('surface.stl', 'stl'), ('surface.glb', 'glb'), ('seen.png', 'png')]:
        browser.click('#save-open')
        choose_value(browser, 'save-kind', kind)
        proposed = browser.value('document.getElementById("save-name").value')
        check(set(proposed) <= set('abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._+=-') and proposed[0] != '.', f'{proposed} is proposed')
        for name in hostile:
            browser.value('(() => { document.getElementById("save-told").textContent = ""; document.getElementById("save-name").value = %s; })()' % json.dumps(f'{name}.{ending}'))
            browser.click('#save-go')
            browser.wait('/^(Downloaded|The name|This page)/.test(document.getElementById("save-told").textContent)')
        browser.click('#save-close')
    check_harmless(browser, 'names of saved files', usual)
    check(os.listdir(os.path.dirname(saved)) == ['saved'], 'nothing was written beside the folder')


def module_test_dropped_files(browser, folder):
    """The page without a grid: names of files, of what they hold, and of what they name."""
    path, files = os.path.join(folder, 'isotet.html'), os.path.join(folder, 'dropped')
    os.mkdir(files)
    isotet('page', path)
    load(browser, path, there='document.getElementById("drop") !== null')
    random_ = random.Random(SEED)
    letters = lambda name: name.replace(b'/', b'\\').replace(b'\0', b'')
    valid = [name for name in fuzzed(random_, 110, 200, letters) if is_text(name)]
    usual, fields = None, fuzzed(random_, 30)
    for name in [b'__proto__', b'constructor', '\ufeffmark'.encode()] + random_.sample(valid, 6):
        file = os.path.join(files, name.decode() + '.vtk')
        own = random_.sample(fields, 5)
        write_vtk(file, own)
        choose(browser, [file])
        browser.wait('document.getElementById("file").textContent === %s && document.body.dataset.step === "ready" && document.body.dataset.kinds !== ""'
                     % json.dumps(os.path.basename(file)), 60)
        usual = usual or elements(browser)
        check(browser.value('[...document.getElementById("field").options].map(({value}) => value)') == seen(own), 'fields are listed by their names')
        check_harmless(browser, name, usual)
    # What cannot be read is a sentence with the names in it.
    for i, name in enumerate(random_.sample(valid, 4)):
        file = os.path.join(files, name.decode() + '.vtm')
        inner = '<img src=x onerror=hacked=1>'.replace('<', '&lt;')
        with open(file, 'w', encoding='utf-8') as out:
            out.write('<?xml version="1.0"?><VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>'
                      f'<DataSet index="0" name="{inner}" file="{inner}{i}.vtu"/></vtkMultiBlockDataSet></VTKFile>')
        choose(browser, [file])
        browser.wait('document.getElementById("message").textContent.includes(%s)' % json.dumps(f'<img src=x onerror=hacked=1>{i}.vtu'))
        check_harmless(browser, name, usual)


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-names-') as folder:
        kinds = ('test_', 'module_test_') if has_module(folder) else ('test_',)
        return run_tests([test for name, test in globals().items() if name.startswith(kinds)], Watched(), folder)


sys.exit(main())
