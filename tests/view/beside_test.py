# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Two pages of `isotet view` beside each other in Chromium: what they share, what each keeps, and who may frame them."""
import http.server
import os
import sys
import tempfile
import threading
import traceback

from chromium import Browser, Viewer

DATA = os.path.join(os.path.dirname(__file__), '../../data')
STEPS = os.path.join(DATA, 'exodus/tension_tets_stress_3steps.e')
GRID = 'make:kuhn:8:sphere,gyroid'
pictures = os.environ.get('ISOTET_TEST_PICTURES')  # a folder for the screenshots; without it they are not kept


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def frame(side):
    """The document in a frame; nothing before it is loaded."""
    return f'document.querySelectorAll("iframe")[{side}]?.contentDocument'


def data(side):
    return f'{frame(side)}?.body?.dataset'


def in_both(browser, condition):
    """Until it holds of the dataset `of` of both."""
    for side in range(2):
        browser.wait(f'(of => {condition})({data(side)} ?? {{}})')


def ready(browser):
    in_both(browser, 'of.step === "ready" && of.preview === "false" && of.shown !== undefined')


def start(browser, viewer, extra=''):
    """A page, and by its button two."""
    browser.call('Page.navigate', url='about:blank')
    browser.open(viewer.address + extra)
    browser.wait('document.body.dataset.step === "ready" && document.body.dataset.preview === "false"')
    browser.click('#beside')
    browser.wait('location.pathname === "/beside.html"')
    ready(browser)


def change(browser, side, control, value, kind='change'):
    browser.value(f'(() => {{ const one = {frame(side)}.getElementById("{control}"); one.value = "{value}"; one.dispatchEvent(new Event("{kind}")); }})()')


def type_value(browser, side, text):
    browser.value(f'(() => {{ const one = {frame(side)}.getElementById("value"); one.value = "{text}"; '
                  f'one.dispatchEvent(new one.ownerDocument.defaultView.KeyboardEvent("keydown", {{key: "Enter"}})); }})()')


def in_middle(browser, side):
    """Of the picture of a frame, in pixels of the window."""
    x, y, w, h = browser.value(f'(() => {{ const out = document.querySelectorAll("iframe")[{side}].getBoundingClientRect(), '
                               f'b = {frame(side)}.getElementById("scene").getBoundingClientRect(); return [out.x + b.x, out.y + b.y, b.width, b.height]; }})()')
    return x + w / 2, y + h / 2


def camera(browser, side):
    return browser.value(f'{data(side)}.camera')


def same_camera():
    """But for the last of nine digits."""
    numbers = [f"({data(side)}.camera ?? '').split(/[:,]/).slice(1).map(Number)" for side in range(2)]
    return f'{numbers[0]}.every((one, i) => Math.abs(one - {numbers[1]}[i]) < 1e-7)'


def settled(browser):
    browser.value('new Promise(done => setTimeout(done, 1800))')


def test_camera_and_isovalue_are_shared(browser, viewer):
    start(browser, viewer, '&f=sphere&i=0.7')
    in_both(browser, 'of.shown === "0.7"')
    check(browser.value('document.title') == 'make:kuhn:8:sphere,gyroid – isotet', 'the file is named once')
    for side in (0, 1):
        before = camera(browser, side)
        x, y = in_middle(browser, side)
        browser.drag((x, y), (x + 60, y + 30))
        browser.wait(f'{data(side)}.camera !== "{before}" && {same_camera()}')
        type_value(browser, side, f'0.{5 + side}')
        in_both(browser, f'of.shown === "0.{5 + side}"')
    browser.picture(pictures and f'{pictures}/beside.png')


def test_links_are_chosen(browser, viewer):
    start(browser, viewer, '&f=sphere&i=0.7')
    browser.click('#link-camera')
    browser.click('#link-value')
    before = camera(browser, 1)
    x, y = in_middle(browser, 0)
    browser.drag((x, y), (x + 60, y + 30))
    type_value(browser, 0, '0.5')
    browser.wait(f'{data(0)}.shown === "0.5" && !({same_camera()})')
    settled(browser)
    check(browser.value(f'{data(1)}.shown') == '0.7' and camera(browser, 1) == before, 'the other one stays')
    address = browser.value('location.href')
    browser.value('window.isOld = true, location.reload()')
    browser.wait(f'!window.isOld && {data(0)}?.shown === "0.5" && {data(1)}?.shown === "0.7" && {data(1)}.camera === "{before}"')
    check(not browser.value('document.getElementById("link-camera").checked'), f'the address has the links: {address}')
    browser.click('#link-camera')
    browser.wait(same_camera())
    browser.click('#link-value')
    browser.wait(f'{data(0)}.shown === {data(1)}.shown')


def test_other_fields_have_other_isovalues(browser, viewer):
    start(browser, viewer, '&f=sphere&i=0.7')
    change(browser, 1, 'field', 'gyroid')
    browser.wait(f'{data(1)}.shown !== "0.7"')
    value = browser.value(f'{data(1)}.shown')
    type_value(browser, 0, '0.5')
    browser.wait(f'{data(0)}.shown === "0.5"')
    settled(browser)
    check(browser.value(f'{data(1)}.shown') == value, 'a value of another field is not taken')


def test_two_steps(browser, viewer):
    with Viewer(STEPS, '-f', 'nodal_Cauchy_Stress_1', '--step', '1') as other:
        start(browser, other)
        change(browser, 1, 'step', 2, 'input')
        browser.wait(f'{data(1)}.step_shown === "2" && {data(1)}.chart_step === "2"')
        type_value(browser, 0, '5000')
        in_both(browser, 'of.shown === "5000"')
        check(browser.value(f'{data(0)}.step_shown') == '1', 'each has its step')
        browser.picture(pictures and f'{pictures}/beside_steps.png')
        browser.click('#link-step')  # the one that was changed last is followed
        browser.wait(f'{data(1)}.step_shown === "1"')
        change(browser, 1, 'step', 0, 'input')
        in_both(browser, 'of.step_shown === "0"')
        browser.call('Page.navigate', url='about:blank')


def test_back_undoes_in_both(browser, viewer):
    start(browser, viewer, '&f=sphere&i=0.7')
    settled(browser)
    type_value(browser, 0, '0.5')
    in_both(browser, 'of.shown === "0.5"')
    settled(browser)
    type_value(browser, 1, '0.6')
    in_both(browser, 'of.shown === "0.6"')
    settled(browser)
    browser.value('history.back()')
    in_both(browser, 'of.shown === "0.5"')
    settled(browser)
    in_both(browser, 'of.shown === "0.5"')
    browser.value('history.back()')
    in_both(browser, 'of.shown === "0.7"')


def start_files(browser, viewer):
    browser.call('Page.navigate', url='about:blank')
    browser.open(viewer.address)
    ready(browser)


def test_two_files(browser, viewer):
    """The second one begins as the first; what is changed in one is changed in the other."""
    with Viewer('make:kuhn:8:sphere,gyroid', '--beside', 'make:kuhn:12:gyroid,sphere', '-f', 'sphere') as two:
        check('/beside.html?second#' in two.address, two.address)
        start_files(browser, two)
        check([browser.value(f'{data(side)}.grid') for side in (0, 1)] == ['729 points, 3072 cells', '2197 points, 10368 cells'], 'each has its file')
        check(browser.value('document.getElementById("file").textContent') == 'make:kuhn:8:sphere,gyroid | make:kuhn:12:gyroid,sphere', 'both are named')
        browser.wait(f'{data(0)}.shown === {data(1)}.shown && {same_camera()}')
        for side in (0, 1):
            type_value(browser, side, f'0.{5 + side}')
            in_both(browser, f'of.shown === "0.{5 + side}"')
            before = camera(browser, side)
            x, y = in_middle(browser, side)
            browser.drag((x, y), (x + 60, y + 30))
            browser.wait(f'{data(side)}.camera !== "{before}" && {same_camera()}')
        browser.picture(pictures and f'{pictures}/beside_files.png')
        settled(browser)
        browser.value('window.isOld = true, location.reload()')
        browser.wait(f'!window.isOld && {data(0)}?.shown === "0.6" && {data(1)}?.shown === "0.6" && {data(1)}.grid === "2197 points, 10368 cells"')
        x, y = in_middle(browser, 1)
        browser.drag((x, y), (x + 60, y))
        browser.key('2')
        browser.wait('location.pathname === "/" && document.body?.dataset.grid === "2197 points, 10368 cells"')
        browser.key('2')
        browser.wait('location.pathname === "/beside.html"')
        in_both(browser, 'of.shown !== undefined')
        check([browser.value(f'{data(side)}.grid[0]') for side in (0, 1)] == ['7', '2'], 'the files keep their sides')
        browser.value(f'{frame(1)}.getElementById("copy-render").click()')
        browser.wait(f'{frame(1)}.getElementById("copied").textContent.startsWith("isotet render make:kuhn:12:gyroid,sphere ")')
        browser.call('Page.navigate', url='about:blank')


def test_files_elsewhere_have_their_own_camera(browser, viewer):
    with Viewer(os.path.join(DATA, 'vtu/artery_flow_tet_wedge.vtu'), '--beside', GRID, '-f', 'Umag') as two:
        start_files(browser, two)
        check(not browser.value('document.getElementById("link-camera").checked'), 'the camera of one sees nothing of the other')
        check('Umag' in browser.value(f'{frame(1)}.getElementById("notes-list").textContent'), 'it has no such field')
        browser.call('Page.navigate', url='about:blank')


def test_a_file_that_cannot_be_read_says_so_in_its_half(browser, viewer):
    with tempfile.TemporaryDirectory() as folder:
        broken = os.path.join(folder, 'broken.vtu')
        with open(broken, 'w') as file:
            file.write('<VTKFile type="UnstructuredGrid"')
        with Viewer(GRID, '--beside', broken, '-f', 'sphere') as two:
            browser.call('Page.navigate', url='about:blank')
            browser.open(two.address)
            browser.wait(f'{data(0)}?.step === "ready" && {frame(1)}?.getElementById("message").textContent.includes("broken.vtu")')
            settled(browser)
            type_value(browser, 0, '0.5')
            browser.wait(f'{data(0)}.shown === "0.5"')
            check(browser.value(f'{frame(1)}.getElementById("lost").hidden'), 'the server goes on')
            browser.call('Page.navigate', url='about:blank')


def test_keys(browser, viewer):
    """2 shows two, and from one of them that one; what Tab reaches first are the links."""
    browser.call('Page.navigate', url='about:blank')
    browser.open(viewer.address + '&f=sphere&i=0.7')
    browser.wait('document.body.dataset.shown === "0.7"')
    browser.key('2')
    browser.wait('location.pathname === "/beside.html"')
    ready(browser)
    for name in ('link-camera', 'link-value', 'controls'):
        browser.key('Tab')
        check(browser.value('document.activeElement.id') == name, f'{name} is reached')
    browser.key(' ')
    in_both(browser, 'of !== undefined')
    for side in range(2):
        browser.wait(f'{frame(side)}.body.classList.contains("wide")')
        check(browser.value(f'{frame(side)}.getElementById("stage").clientHeight > 0.8 * {frame(side)}.defaultView.innerHeight'), 'the picture has its place')
    browser.picture(pictures and f'{pictures}/beside_wide.png')
    x, y = in_middle(browser, 1)
    browser.drag((x, y), (x + 60, y))
    browser.key('2')
    browser.wait('location.pathname === "/" && document.body?.dataset.shown === "0.7"')
    check(browser.value('document.getElementById("beside").textContent') == 'Beside', 'it is alone')


class Elsewhere(http.server.BaseHTTPRequestHandler):
    """A page of another origin with a frame."""
    framed = ''

    def do_GET(self):
        body = f'<!doctype html><title>Elsewhere</title><iframe src="{self.framed}" width="900" height="600"></iframe>'.encode()
        self.send_response(200)
        self.send_header('Content-Type', 'text/html')
        self.send_header('Content-Length', str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


def test_other_origins_cannot_frame_it(browser, viewer):
    server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), Elsewhere)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    for place in ('', 'beside.html', '?beside'):
        browser.errors.clear()
        Elsewhere.framed = viewer.address.replace('/#', f'/{place}#')
        browser.call('Page.navigate', url='about:blank')
        browser.open(f'http://127.0.0.1:{server.server_port}/{place}')
        for _ in range(100):
            if any('frame-ancestors' in error for error in browser.errors):
                break
            browser.value('new Promise(done => setTimeout(done, 50))')
        check(any('frame-ancestors' in error for error in browser.errors), f'"{place}" is refused: {browser.errors}')
    browser.call('Page.navigate', url='about:blank')
    browser.errors.clear()
    server.shutdown()


def main():
    wanted = sys.argv[1:]
    state = tempfile.TemporaryDirectory()  # for the tokens of viewers
    os.environ['XDG_STATE_HOME'] = state.name
    failures = []
    with Viewer(GRID, '--keep') as viewer:
        browser = Browser()
        try:
            for name, test in list(globals().items()):
                if not name.startswith('test_') or (wanted and name not in wanted):
                    continue
                try:
                    browser.errors.clear()
                    test(browser, viewer)
                    errors = [e for e in browser.errors if 'WebSocket connection' not in e]
                    check(not errors, f'errors of the page: {errors}')
                    print('ok', name, flush=True)
                except Exception:
                    failures.append(f'FAILED {name}\n{traceback.format_exc()}')
                    print('FAILED', name, flush=True)
        finally:
            browser.close()
    print(*failures, sep='\n')
    return 1 if failures else 0


sys.exit(main())
