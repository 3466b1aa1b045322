# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A page of `isotet export` in Chromium without a graphics card: when its first surface is there, and how often it changes while the
slider is dragged: ISOTET_CHROMIUM=chromium python3 page.py PAGE"""
import os
import statistics
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'tests', 'view'))
from chromium import Browser  # noqa: E402

WATCH = '''window.seen = [];
document.addEventListener('DOMContentLoaded', () => new MutationObserver(() => {
  const {shown} = document.body.dataset;
  if (shown && shown !== window.last) { window.last = shown; requestAnimationFrame(() => seen.push(performance.now())); }
}).observe(document.body, {attributes: true, attributeFilter: ['data-shown']}));'''


def drag(browser, seconds=4):
    """Pictures a second."""
    x, y, width, height = browser.box('#slider')
    at = [x + 0.3 * width, y + height / 2]
    browser.value('seen.length = 0')
    browser.mouse('mousePressed', *at)
    begin = time.monotonic()
    while (passed := time.monotonic() - begin) < seconds:
        browser.mouse('mouseMoved', at[0] + 0.4 * width * passed / seconds, at[1])
        time.sleep(max(0, 0.016 - (time.monotonic() - begin - passed)))
    browser.mouse('mouseReleased', *at, buttons=0)
    return browser.value('seen.length') / seconds


def main():
    page, first, rates = os.path.abspath(sys.argv[1]), [], []
    for _ in range(5):
        browser = Browser()
        try:
            browser.call('Page.addScriptToEvaluateOnNewDocument', source=WATCH)
            browser.open('file://' + page)
            browser.wait('window.seen.length > 0')
            first.append(browser.value('seen[0]'))
            browser.wait('document.body.dataset.preview === "false"')
            rates.append(drag(browser))
        finally:
            browser.close()
    print(f'{os.path.getsize(page):,} bytes; first surface after {statistics.median(first):.0f} ms; '
          f'{statistics.median(rates):.0f} pictures a second while dragging')


main()
