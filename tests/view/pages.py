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
