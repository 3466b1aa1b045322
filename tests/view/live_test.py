# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The folder that scripts/live.sh makes, in Chromium: the index leads to every page, and each shows its grid."""
import os
import subprocess
import sys
import tempfile

from chromium import Browser

HERE = os.path.dirname(os.path.abspath(__file__))
SHOWN = 'document.body.dataset.kinds === "boundary" || Number(document.body.dataset.triangles) > 0'
THERE = {'isotet.html': 'document.getElementById("drop") !== null'}


def main():
    with tempfile.TemporaryDirectory(prefix='isotet-live-') as folder:
        made = subprocess.run(['bash', os.path.join(HERE, '../../scripts/live.sh'), folder], capture_output=True, text=True)
        assert made.returncode == 0, made.stderr
        browser = Browser()
        try:
            browser.open(f'file://{folder}/index.html')
            pages = browser.value('[...document.links].map((one) => one.getAttribute("href"))')
            assert sorted(pages + ['index.html']) == sorted(os.listdir(folder)), f'{pages} are linked, {os.listdir(folder)} are there'
            assert len(pages) == 4, pages
            for page in pages:
                browser.call('Page.navigate', url='about:blank')
                browser.open(f'file://{folder}/{page}')
                browser.wait(THERE.get(page, SHOWN), 60)
                assert not browser.errors, f'{page}: {browser.errors}'
                print('ok', page, flush=True)
        finally:
            browser.close()
    return 0


sys.exit(main())
