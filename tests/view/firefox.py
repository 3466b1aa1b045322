# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Firefox on a screen of Xvfb, for without one it has no WebGL; driven through Marionette: a socket, texts of JSON behind their lengths."""
import base64
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time

PREFERENCES = {
    'marionette.port': 0,  # a free one, told in the profile
    'browser.shell.checkDefaultBrowser': False,
    'datareporting.policy.dataSubmissionEnabled': False,
    'network.captive-portal-service.enabled': False,
    'network.connectivity-service.enabled': False,
    'browser.safebrowsing.downloads.enabled': False,
    'app.update.enabled': False,
    'extensions.update.enabled': False,
    'webgl.force-enabled': True,  # on the processor
    'ui.systemUsesDarkTheme': 0,
}
ERRORS = '''return Services.console.getMessageArray().filter((one) => one instanceof Ci.nsIScriptError
  && !(one.flags & (Ci.nsIScriptError.warningFlag | Ci.nsIScriptError.infoFlag)) && /^(file|blob):/.test(one.sourceName)).map((one) => one.errorMessage);'''
KEYS = {'Enter': '\ue007', 'Tab': '\ue004', 'ArrowLeft': '\ue012', 'ArrowUp': '\ue013', 'ArrowRight': '\ue014', 'ArrowDown': '\ue015',
        'PageUp': '\ue00e', 'PageDown': '\ue00f', 'End': '\ue010', 'Home': '\ue011'}


def start_screen(width, height):
    """Xvfb, and the display that it chose."""
    read, write = os.pipe()
    process = subprocess.Popen(['Xvfb', '-displayfd', str(write), '-screen', '0', f'{width}x{height}x24', '-nolisten', 'tcp'], pass_fds=[write],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as told:
        return process, f':{told.readline().strip()}'


class Browser:
    def __init__(self, width=1280, height=800):
        self.folder = tempfile.mkdtemp(prefix='isotet-firefox-')
        self.waiting, self.number = b'', 0
        with open(os.path.join(self.folder, 'user.js'), 'w') as file:
            file.writelines(f'user_pref("{name}", {json.dumps(value)});\n' for name, value in PREFERENCES.items())
        self.screen, display = start_screen(width + 200, height + 300)
        self.process = subprocess.Popen([os.environ.get('ISOTET_FIREFOX', 'firefox-esr'), '--marionette', '--no-remote',
                                         '--remote-allow-system-access', '--profile', self.folder, 'about:blank'],
                                        env=dict(os.environ, HOME=self.folder, DISPLAY=display, MOZ_DISABLE_CONTENT_SANDBOX='1'),
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.to = socket.create_connection(('127.0.0.1', self._port()), 60)
        self.receive()  # a greeting
        self.call('WebDriver:NewSession', capabilities={'alwaysMatch': {'strictFileInteractability': False}})
        self.resize(width, height)

    def _port(self):
        told = os.path.join(self.folder, 'MarionetteActivePort')
        for _ in range(1200):
            if os.path.exists(told) and (text := open(told).read().strip()):
                return int(text)
            if self.process.poll() is not None:
                raise RuntimeError(f'Firefox ended with {self.process.returncode}')
            time.sleep(0.05)
        raise TimeoutError('Firefox did not start')

    def receive(self):
        while True:
            length, mark, rest = self.waiting.partition(b':')
            if mark and len(rest) >= int(length):
                self.waiting = rest[int(length):]
                return json.loads(rest[:int(length)])
            data = self.to.recv(1 << 20)
            if not data:
                raise RuntimeError('Firefox ended')
            self.waiting += data

    def call(self, command, **parameters):
        self.number += 1
        text = json.dumps([0, self.number, command, parameters]).encode()
        self.to.sendall(str(len(text)).encode() + b':' + text)
        _, number, error, result = self.receive()
        if error or number != self.number:
            raise RuntimeError(f'{command}: {error}')
        return result

    def resize(self, width, height):
        """Of what is inside the window."""
        self.call('WebDriver:SetWindowRect', width=width, height=height)
        more = [wanted - got for wanted, got in zip((width, height), self.value('[innerWidth, innerHeight]'))]
        self.call('WebDriver:SetWindowRect', width=width + more[0], height=height + more[1])

    def open(self, address):
        self.call('WebDriver:Navigate', url=address)

    def value(self, expression):
        """Of JavaScript in the page."""
        return self.call('WebDriver:ExecuteScript', script=f'return ({expression});', args=[])['value']

    def wait(self, expression, limit=60):
        """Until it is true."""
        end = time.monotonic() + limit
        while not (last := self.value(expression)):
            if time.monotonic() > end:
                state = self.value('JSON.stringify([document.body.dataset, document.getElementById("message")?.textContent])')
                raise AssertionError(f'never true: {expression}; the page: {state}; errors: {self.errors()}')
            time.sleep(0.02)
        return last

    def errors(self):
        """Of scripts and policies of the pages since the start."""
        self.call('Marionette:SetContext', value='chrome')
        try:
            return self.call('WebDriver:ExecuteScript', script=ERRORS, args=[])['value']
        finally:
            self.call('Marionette:SetContext', value='content')

    def box(self, selector):
        return self.value('(() => { const b = document.querySelector(%s).getBoundingClientRect(); '
                          'return [b.x, b.y, b.width, b.height]; })()' % json.dumps(selector))

    def drag(self, start, end, steps=12):
        places = [[round(a + i / steps * (b - a)) for a, b in zip(start, end)] for i in range(steps + 1)]
        moves = [{'type': 'pointerMove', 'x': x, 'y': y, 'duration': 16} for x, y in places]
        actions = [moves[0], {'type': 'pointerDown', 'button': 0}, *moves[1:], {'type': 'pointerUp', 'button': 0}]
        self.call('WebDriver:PerformActions', actions=[{'type': 'pointer', 'id': 'mouse', 'parameters': {'pointerType': 'mouse'}, 'actions': actions}])

    def key(self, key):
        code = KEYS.get(key, key)
        self.call('WebDriver:PerformActions', actions=[{'type': 'key', 'id': 'keys', 'actions': [
            {'type': 'keyDown', 'value': code}, {'type': 'keyUp', 'value': code}]}])

    def choose(self, selector, files):
        """Files of an input."""
        element = next(iter(self.call('WebDriver:FindElement', using='css selector', value=selector)['value'].values()))
        self.call('WebDriver:ElementSendKeys', id=element, text='\n'.join(os.path.abspath(file) for file in files))

    def picture(self, path=None):
        data = base64.b64decode(self.call('WebDriver:TakeScreenshot', full=False, hash=False)['value'])
        if path:
            with open(path, 'wb') as file:
                file.write(data)
        return data

    def close(self):
        try:
            self.call('Marionette:Quit', flags=['eForceQuit'])
            self.process.wait(20)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        self.to.close()
        self.screen.terminate()
        self.screen.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
