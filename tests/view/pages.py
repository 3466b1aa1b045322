# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What tests of pages of one file share."""
import json
import os
import subprocess
import sys
import traceback


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def isotet(*words):
    """The JSON of a command."""
    run = subprocess.run([os.environ['ISOTET_PROGRAM'], *words, '--json', '-', '--quiet'], capture_output=True)
    check(run.returncode == 0, f'{words}: {run.stderr.decode(errors="replace")}')
    return json.loads(run.stdout)


def has_module(folder):
    """Whether the program has isotet as WebAssembly with its readers."""
    run = subprocess.run([os.environ['ISOTET_PROGRAM'], 'page', os.path.join(folder, 'try.html'), '--quiet'], capture_output=True)
    return run.returncode == 0


def choose(browser, files, input='#chosen-files'):
    """Files of a page without a grid."""
    document = browser.call('DOM.getDocument')['root']['nodeId']
    node = browser.call('DOM.querySelector', nodeId=document, selector=input)['nodeId']
    browser.call('DOM.setFileInputFiles', nodeId=node, files=[os.path.abspath(file) for file in files])


def check_small_and_keys(browser):
    """On a phone: nothing lies beside the screen, the Tab key leads to all that can be used, where it is seen, and arrows move the slider."""
    browser.wait('document.body.dataset.preview === "false" && document.body.dataset.step === "ready"')
    check(browser.value('[document.documentElement, document.getElementById("panel")].every((one) => one.scrollWidth <= Math.min(360, innerWidth))'),
          'nothing lies beside the screen')
    browser.value('window.controls = [...document.querySelectorAll("a[href], button, input, select, textarea, summary, [tabindex]")].filter((one) => '
                  '!one.disabled && one.tabIndex >= 0 && one.checkVisibility({visibilityProperty: true})); document.activeElement.blur()')
    count, reached = browser.value('controls.length'), set()
    check(count > 20, f'there are controls: {count}')
    for _ in range(count + 5):
        browser.key('Tab')
        at, line, inside, name = browser.value(
            '(() => { const one = document.activeElement, look = getComputedStyle(one), box = one.getBoundingClientRect(); return [controls.indexOf(one), '
            'look.outlineStyle !== "none" && parseFloat(look.outlineWidth) >= 2, box.left >= 0 && box.right <= innerWidth && box.top < innerHeight && box.bottom > 0, '
            'one.outerHTML.slice(0, 80)]; })()')
        if at < 0:
            continue
        check(line and inside, f'where the focus is can be seen: {name}')
        reached.add(at)
    missing = browser.value('controls.map((one) => one.outerHTML.slice(0, 80))')
    check(len(reached) == count, f'not reached: {[name for at, name in enumerate(missing) if at not in reached]}')
    browser.value('document.getElementById("slider").focus()')
    for key, words in [('Home', ''), ('ArrowRight', '>'), ('PageUp', '>'), ('ArrowLeft', '<'), ('End', '>'), ('PageDown', '<')]:
        before = browser.value('Number(document.getElementById("slider").getAttribute("aria-valuenow"))')
        browser.key(key)
        now = 'Number(document.getElementById("slider").getAttribute("aria-valuenow"))'
        browser.wait(f'{now} === Number(document.body.dataset.shown) && document.body.dataset.preview === "false"' + (f' && {now} {words} {before}' if words else ''))


def run_tests(tests, browser, *given):
    """0, or 1 where one fails; those of sys.argv alone, where it names some."""
    failed = 0
    try:
        for test in [test for test in tests if not sys.argv[1:] or test.__name__ in sys.argv[1:]]:
            try:
                browser.errors.clear()
                test(browser, *given)
                check(not browser.errors, f'errors of the page: {browser.errors}')
                print('ok', test.__name__, flush=True)
            except Exception:
                failed += 1
                print('FAILED', test.__name__)
                traceback.print_exc(file=sys.stdout)
    finally:
        browser.close()
    return 1 if failed else 0
