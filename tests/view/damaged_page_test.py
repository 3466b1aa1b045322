# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pages that were cut or changed on their way, in Chromium: each shows its surfaces, or says a sentence; none throws or waits for ever. ISOTET_SEED chooses other damages."""
import base64
import os
import random
import sys
import tempfile
import time
import zlib

from chromium import Browser
from pages import check, isotet, run_tests

SEED = int(os.environ.get('ISOTET_SEED', '1'))
GRID = 'make:kuhn:8:sphere,gyroid'
SHOWN = 'Number(document.body.dataset.triangles) > 0'
SAID = '(() => { const m = document.getElementById("message"); return m && !m.hidden && m.textContent; })()'


def part_of(page, name):
    """Where the text of a part begins and ends."""
    mark = f'id="{name}">'
    begin = page.index(mark) + len(mark)
    return begin, page.index('</script>', begin)


def with_part(page, name, change):
    """The page with a part whose bytes, inflated, are changed."""
    begin, end = part_of(page, name)
    inside = bytearray(zlib.decompress(base64.b64decode(page[begin:end])))
    return page[:begin] + base64.b64encode(zlib.compress(bytes(change(inside)), 1)).decode() + page[end:]


def with_text(page, name, change):
    begin, end = part_of(page, name)
    return page[:begin] + change(page[begin:end]) + page[end:]


def flipped(random_, count, least=0, most=None):
    """Bits of some bytes of `least` to `most`."""
    def change(data):
        for at in random_.choices(range(least, min(len(data), most or len(data))), k=count):
            data[at] ^= 1 << random_.randrange(8)
        return data
    return change


def letters_changed(random_, count):
    def change(text):
        letters = list(text)
        for at in random_.choices(range(len(letters)), k=count):
            letters[at] = random_.choice('ABCZaz019+/')
        return ''.join(letters)
    return change


def grids_changed(page, random_):
    for count in (1, 1, 1, 3, 10, 100):
        yield f'{count} bytes of the head of the grid', with_part(page, 'grid', flipped(random_, count, 0, 4096))
    for count in (1, 1, 1, 1, 10, 1000):
        yield f'{count} bytes of the grid', with_part(page, 'grid', flipped(random_, count))
    for share in (0, 0.001, 0.3, 0.9, 0.999):
        yield f'{share} of the grid', with_part(page, 'grid', lambda data: data[:int(share * len(data))])
    yield 'another file in its place', with_part(page, 'grid', lambda data: b'# vtk DataFile Version 3.0\n' * 100)
    yield 'zeros in its place', with_part(page, 'grid', lambda data: bytes(len(data)))
    yield 'a grid behind it', with_part(page, 'grid', lambda data: data + data)


def engines_changed(page, random_):
    for count in (1, 3, 100):
        yield f'{count} bytes of the head of the engine', with_part(page, 'engine', flipped(random_, count, 0, 2000))
    for count in (1, 10, 1000):
        yield f'{count} bytes of the engine', with_part(page, 'engine', flipped(random_, count))
    for share in (0, 0.5, 0.999):
        yield f'{share} of the engine', with_part(page, 'engine', lambda data: data[:int(share * len(data))])
    yield 'an engine without anything', with_part(page, 'engine', lambda data: b'\0asm\1\0\0\0')


def texts_changed(page, random_):
    for name in ('grid', 'engine', 'worker', 'saved'):
        begin, end = part_of(page, name)
        yield f'{name}: a letter', with_text(page, name, letters_changed(random_, 1))
        yield f'{name}: 20 letters', with_text(page, name, letters_changed(random_, 20))
        yield f'{name}: half of it', with_text(page, name, lambda text: text[:len(text) // 2])
        yield f'{name}: nothing', with_text(page, name, lambda text: '')
        yield f'{name}: no base64', with_text(page, name, lambda text: '!' + text)
        yield f'{name}: not there', page[:begin].rpartition('<script')[0] + page[end + len('</script>'):]


def cuts(page, random_):
    script = page.rindex('<script type="module">')
    for at in [0, 10, 500, page.index('<body>'), page.index('id="scene"'), *(random_.randrange(script) for _ in range(4)), len(page) - 20, script + 1000, len(page) - 2000]:
        yield f'the first {at} letters', page[:at]


def surfaces_changed(page, random_):
    yield 'nothing', page
    for what, change in [('a letter', letters_changed(random_, 1)), ('20 letters', letters_changed(random_, 20)), ('half of it', lambda text: text[:len(text) // 2]),
                         ('nothing in it', lambda text: ''), ('an empty object', lambda text: '{}'), ('null', lambda text: 'null')]:
        yield f'saved: {what}', with_text(page, 'saved', change)
    for name in ('surface-0', 'surface-1', 'boundary-0'):
        for count in (1, 20):
            yield f'{name}: {count} letters', with_text(page, name, letters_changed(random_, count))
        yield f'{name}: half of it', with_part(page, name, lambda data: data[:len(data) // 2])
        yield f'{name}: 3 bytes', with_part(page, name, flipped(random_, 3))


def open_damaged(browser, folder, what, page):
    """What it shows or says."""
    path = os.path.join(folder, 'damaged.html')
    with open(path, 'w', encoding='utf-8') as file:
        file.write(page)
    browser.call('Page.navigate', url='about:blank')
    browser.errors.clear()
    browser.open('file://' + path)
    end = time.monotonic() + 20
    while not (told := browser.value(f'document.body && ({SHOWN} || {SAID})')) and time.monotonic() < end:
        time.sleep(0.02)
    for _ in range(2):  # it goes on: what is asked now is answered, or refused
        browser.value('new Promise((done) => setTimeout(done, 30))')
    check(told, f'seed {SEED}, {what}: nothing is shown and nothing said; {browser.errors}')
    check(not browser.errors, f'seed {SEED}, {what}: {browser.errors}')
    return told


def page_of(folder, way):
    path = os.path.join(folder, f'{way}.html')
    isotet('export', GRID, path, '-f', 'sphere', '--as', way, *(['--surfaces', '3'] if way == 'surfaces' else []))
    with open(path, encoding='utf-8') as file:
        return file.read()


def damage(browser, folder, kind, way='grid'):
    """What each of the damaged pages shows or says."""
    return {what: open_damaged(browser, folder, what, page) for what, page in kind(page_of(folder, way), random.Random(SEED))}


def test_changed_grids(browser, folder):
    said = damage(browser, folder, grids_changed)
    check(all(isinstance(said[f'{share} of the grid'], str) for share in (0, 0.3, 0.999)), f'a grid that is cut is refused: {said}')


def test_changed_engines(browser, folder):
    said = damage(browser, folder, engines_changed)
    check(isinstance(said['0.5 of the engine'], str), f'an engine that is cut is refused: {said}')


def test_changed_texts(browser, folder):
    said = damage(browser, folder, texts_changed)
    check(all(isinstance(said[f'{name}: half of it'], str) for name in ('grid', 'engine')), f'what is missing is told: {said}')


def test_changed_surfaces(browser, folder):
    said = damage(browser, folder, surfaces_changed, 'surfaces')
    check(said['nothing'] is True, 'a page as it was made is shown')
    check(all(isinstance(said[f'saved: {what}'], str) for what in ('half of it', 'nothing in it', 'null')), f'what is missing is told: {said}')


def test_cut_pages(browser, folder):
    """No script is there: a sentence in the page itself comes to be seen."""
    seen = '(() => { const u = document.getElementById("unfinished"); return u && getComputedStyle(u).visibility === "visible"; })()'
    whole = page_of(folder, 'grid')
    for what, page in cuts(whole, random.Random(SEED)):
        path = os.path.join(folder, 'cut.html')
        with open(path, 'w', encoding='utf-8') as file:
            file.write(page)
        browser.call('Page.navigate', url='about:blank')
        browser.open('file://' + path)
        if 'not complete yet' in page and '</script>' not in page[page.find('<script type="module">'):]:
            check(browser.value('document.getElementById("unfinished") !== null'), f'seed {SEED}, {what}: it is not told')
        check(not browser.errors, f'seed {SEED}, {what}: {browser.errors}')
    browser.wait(seen)


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-damaged-') as folder:
        return run_tests([test for name, test in globals().items() if name.startswith('test_')], Browser(480, 400), folder)


sys.exit(main())
