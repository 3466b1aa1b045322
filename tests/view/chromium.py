# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Chromium without a window, driven through its DevTools pipe: descriptors 3 and 4, JSON ended by a zero byte."""
import base64
import glob
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


class Browser:
    def __init__(self, width=1280, height=720, ratio=1, dark=False, words=()):
        self.folder = tempfile.mkdtemp(prefix='isotet-chromium-')
        to_read, self.to = os.pipe()
        self.come, to_write = os.pipe()
        words = [os.environ.get('ISOTET_CHROMIUM', 'chromium'), *words, '--headless=new', '--remote-debugging-pipe', '--no-first-run',
                 '--no-default-browser-check', '--disable-background-networking', '--disable-component-update', '--disable-sync',
                 '--disable-dev-shm-usage', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--hide-scrollbars',
                 f'--user-data-dir={self.folder}', f'--window-size={width},{height}']
        if os.geteuid() == 0:
            words.append('--no-sandbox')  # root has none; the page is our own

        def descriptors():
            # First out of the way: 3 or 4 may be one of the pipes' own numbers.
            read, write = os.dup(to_read), os.dup(to_write)
            high_read, high_write = 200, 201
            os.dup2(read, high_read)
            os.dup2(write, high_write)
            os.dup2(high_read, 3)
            os.dup2(high_write, 4)

        self.process = subprocess.Popen(words + ['about:blank'], preexec_fn=descriptors, close_fds=False,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self.waiting = b''
        self.number = 0
        self.session = None
        self.errors = []
        targets = self.call('Target.getTargets')['targetInfos']
        page = next(t for t in targets if t['type'] == 'page')
        self.session = self.call('Target.attachToTarget', targetId=page['targetId'], flatten=True)['sessionId']
        self.call('Runtime.enable')
        self.call('Page.enable')
        self.call('Log.enable')
        self.resize(width, height, ratio)
        self.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}])

    def resize(self, width, height, ratio=1):
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=ratio, mobile=False)

    def send(self, method, **parameters):
        self.number += 1
        message = {'id': self.number, 'method': method, 'params': parameters}
        if self.session:
            message['sessionId'] = self.session
        data = json.dumps(message).encode() + b'\0'
        while data:
            data = data[os.write(self.to, data):]
        return self.number

    def receive(self, limit):
        end = time.monotonic() + limit
        while b'\0' not in self.waiting:
            left = end - time.monotonic()
            if left <= 0 or not select.select([self.come], [], [], left)[0]:
                raise TimeoutError(f'Chromium said nothing for {limit} s')
            data = os.read(self.come, 1 << 20)
            if not data:
                raise RuntimeError('Chromium ended')
            self.waiting += data
        text, self.waiting = self.waiting.split(b'\0', 1)
        message = json.loads(text)
        if message.get('method') == 'Runtime.exceptionThrown':
            details = message['params']['exceptionDetails']
            self.errors.append(details.get('exception', {}).get('description', details['text']))
        if message.get('method') == 'Log.entryAdded' and message['params']['entry']['level'] == 'error':
            self.errors.append(message['params']['entry']['text'])
        return message

    def call(self, method, limit=60, **parameters):
        number = self.send(method, **parameters)
        while True:
            message = self.receive(limit)
            if message.get('id') != number:
                continue
            if 'error' in message:
                raise RuntimeError(f'{method}: {message["error"]}')
            return message['result']

    def open(self, address):
        self.call('Page.navigate', url=address)
        self.wait('document.readyState === "complete" && location.protocol !== "about:"')

    def value(self, expression):
        """Of JavaScript in the page."""
        result = self.call('Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True)
        if 'exceptionDetails' in result:
            raise RuntimeError(result['exceptionDetails']['exception'].get('description', expression))
        return result['result'].get('value')

    def wait(self, expression, limit=30):
        """Until it is true; what it was last is told where it is not."""
        end = time.monotonic() + limit
        while True:
            try:
                last = self.value(expression)
            except RuntimeError as error:  # a page that is loaded again
                if 'navigated' not in str(error):
                    raise
                last = None
            if last:
                return last
            if time.monotonic() > end:
                state = self.value('JSON.stringify([document.body.dataset, document.getElementById("message")?.textContent])')
                raise AssertionError(f'never true: {expression}; the page: {state}; errors: {self.errors}')
            time.sleep(0.02)

    def box(self, selector):
        """x, y, width, height of an element."""
        return self.value('(() => { const b = document.querySelector(%s).getBoundingClientRect(); '
                          'return [b.x, b.y, b.width, b.height]; })()' % json.dumps(selector))

    def mouse(self, kind, x, y, button='left', buttons=1, modifiers=0, **more):
        self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, button=button, buttons=buttons, modifiers=modifiers,
                  clickCount=0 if kind == 'mouseMoved' else 1, **more)

    def drag(self, start, end, steps=12, modifiers=0, button='left'):
        self.mouse('mouseMoved', *start, button='none', buttons=0, modifiers=modifiers)
        self.mouse('mousePressed', *start, modifiers=modifiers, button=button)
        for i in range(1, steps + 1):
            part = i / steps
            self.mouse('mouseMoved', start[0] + part * (end[0] - start[0]), start[1] + part * (end[1] - start[1]),
                       modifiers=modifiers, button=button)
        self.mouse('mouseReleased', *end, buttons=0, modifiers=modifiers, button=button)

    def click(self, selector):
        self.value(f'document.querySelector({json.dumps(selector)}).scrollIntoView({{block: "nearest"}})')
        x, y, width, height = self.box(selector)
        at = (x + width / 2, y + height / 2)
        self.mouse('mouseMoved', *at, button='none', buttons=0)
        self.mouse('mousePressed', *at)
        self.mouse('mouseReleased', *at, buttons=0)

    def key(self, key, modifiers=0, text=None):
        codes = {'Enter': 13, 'Tab': 9, 'Escape': 27, 'ArrowLeft': 37, 'ArrowUp': 38, 'ArrowRight': 39, 'ArrowDown': 40,
                 'PageUp': 33, 'PageDown': 34, 'Home': 36, 'End': 35, ' ': 32}
        code = codes.get(key, ord(key.upper()) if len(key) == 1 else 0)
        if text is None and len(key) == 1:
            text = key
        if key == 'Enter':
            text = '\r'
        more = {'text': text} if text else {}
        self.call('Input.dispatchKeyEvent', type='keyDown', key=key, windowsVirtualKeyCode=code, modifiers=modifiers, **more)
        self.call('Input.dispatchKeyEvent', type='keyUp', key=key, windowsVirtualKeyCode=code, modifiers=modifiers)

    def type(self, text):
        self.call('Input.insertText', text=text)

    def downloads(self, folder):
        """Files that pages offer go there."""
        self.call('Browser.setDownloadBehavior', behavior='allow', downloadPath=folder)

    def downloaded(self, path, limit=30):
        """Waits for a file of downloads() to be whole, and returns its bytes: an empty one holds the name until then."""
        end = time.monotonic() + limit
        while not (os.path.exists(path) and os.path.getsize(path)) or glob.glob(os.path.join(glob.escape(os.path.dirname(path)), '*.crdownload')):
            if time.monotonic() > end:
                raise AssertionError(f'{path} was not downloaded within {limit} s')
            time.sleep(0.02)
        with open(path, 'rb') as file:
            return file.read()

    def picture(self, path=None):
        data = base64.b64decode(self.call('Page.captureScreenshot', format='png')['data'])
        if path:
            with open(path, 'wb') as file:
                file.write(data)
        return data

    def close(self):
        try:
            self.send('Browser.close')
            self.process.wait(10)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        os.close(self.to)
        os.close(self.come)
        shutil.rmtree(self.folder, ignore_errors=True)


class Viewer:
    """`isotet view`, and its address."""

    def __init__(self, *words, environment=None):
        surroundings = dict(os.environ, **(environment or {}))
        surroundings.pop('SSH_CONNECTION', None)
        self.process = subprocess.Popen([os.environ['ISOTET_PROGRAM'], 'view', '--no-browser', *words], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True, env=surroundings)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError(self.process.stderr.read())
        self.port = int(self.address.split(':')[2].split('/')[0])

    def stop(self):
        """By Ctrl-C: its exit status."""
        self.process.send_signal(2)
        status = self.process.wait(20)
        self.process.stdout.close()
        self.process.stderr.close()
        return status

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.stop()
