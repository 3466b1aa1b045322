# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""A scripted hand on the slider of `isotet view`: from the value to the bytes of its surface, medians and worst.

python3 bench/view/drag.py build/release/apps/cli/isotet make:kuhn:94:sphere --from 0.5 --to 0.8 --steps 200
"""
import argparse
import base64
import json
import os
import socket
import statistics
import struct
import subprocess
import time


class Page:
    """A WebSocket of the server, by hand: the standard library has none."""

    def __init__(self, address):
        host, self.token = address.split('//')[1].split('/#')
        name, port = host.split(':')
        self.socket = socket.create_connection((name, int(port)))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f'GET /socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: Upgrade\r\n'
                            f'Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n'.encode())
        self.file = self.socket.makefile('rb', buffering=1 << 20)
        while self.file.readline() != b'\r\n':
            pass
        self.send({'do': 'hello', 'token': self.token})

    def send(self, message):
        data = json.dumps(message).encode()
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b'\xfe' + struct.pack('>H', len(data))
        self.socket.sendall(b'\x81' + size + bytes(4) + data)

    def receive(self):
        """A message (dict), or a frame: its head with the number of its bytes."""
        first, size = self.file.read(2)
        size &= 127
        if size > 125:
            size = struct.unpack('>H', self.file.read(2))[0] if size == 126 else struct.unpack('>Q', self.file.read(8))[0]
        data = self.file.read(size)
        if first & 15 == 9:  # a ping
            self.socket.sendall(b'\x8a' + bytes([0x80 | len(data)]) + bytes(4) + data)
            return self.receive()
        if first & 15 == 1:
            return json.loads(data)
        head = json.loads(data[8:8 + struct.unpack('<I', data[4:8])[0]])
        return {'say': 'frame', 'bytes': len(data), **head}

    def until(self, say, **more):
        while True:
            message = self.receive()
            if message['say'] == 'refused':
                raise SystemExit(message['sentence'])
            if message['say'] == say and all(message.get(key) == value for key, value in more.items()):
                return message


def resident(process):
    """Memory in MB: now and at most."""
    lines = dict(line.split(':') for line in open(f'/proc/{process}/status') if line.startswith('Vm'))
    return [int(lines[key].split()[0]) // 1000 for key in ('VmRSS', 'VmHWM')]


def seconds_of_processor(process):
    parts = open(f'/proc/{process}/stat').read().rsplit(')', 1)[1].split()
    return (int(parts[11]) + int(parts[12])) / os.sysconf('SC_CLK_TCK')


def told(name, values, unit='ms'):
    print(f'{name:34} median {statistics.median(values):8.2f} {unit}, worst {max(values):8.2f} {unit}')


def main():
    words = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    words.add_argument('program')
    words.add_argument('grid')
    words.add_argument('--field', default='sphere')
    words.add_argument('--from', dest='begin', type=float, default=0.5)
    words.add_argument('--to', dest='end', type=float, default=0.8)
    words.add_argument('--steps', type=int, default=200)
    words.add_argument('--rest', action='store_true', help='surfaces in full, also above the limit of previews')
    given = words.parse_args()
    began = time.monotonic()
    process = subprocess.Popen([given.program, 'view', '--no-browser', given.grid, '-f', given.field], stdout=subprocess.PIPE, text=True)
    page = Page(process.stdout.readline().strip())
    try:
        grid = page.until('grid')
        read = time.monotonic()
        state = {'field': given.field, 'isovalues': [given.begin]}
        page.send({'do': 'show', 'number': 1, 'state': state})
        first = page.until('frame', number=1)
        shown = time.monotonic()
        page.send({'do': 'shown', 'number': 1})
        page.until('progress', step='ready')
        packed = time.monotonic()
        print(f'{given.grid}: {grid["cells"]} cells; read or made in {read - began:.2f} s; first surface {shown - read:.2f} s later '
              f'({first["method"]}), packed {packed - read:.2f} s later')
        rtt, served, sizes, triangles = [], [], [], []
        for i in range(given.steps):
            state['isovalues'] = [given.begin + (given.end - given.begin) * (i + 1) / given.steps]
            start = time.monotonic()
            page.send({'do': 'show', 'number': i + 2, 'state': state, 'moving': not given.rest})
            frame = page.until('frame', number=i + 2)
            rtt.append(1e3 * (time.monotonic() - start))
            served.append(frame['wait_ms'] + frame['extract_ms'] + frame['mesh_ms'])
            sizes.append(frame['bytes'] / 1e6)
            triangles.append(frame['surfaces'][0]['triangles'])
            page.send({'do': 'shown', 'number': i + 2})
        print(f'{given.steps} values, {min(triangles)} to {max(triangles)} triangles, preview: {frame["preview"]}')
        told('value to bytes received', rtt)
        told('wait, extract, code', served)
        told('bytes', sizes, 'MB')
        before = seconds_of_processor(process.pid)
        time.sleep(5)
        print(f'idle: {20 * (seconds_of_processor(process.pid) - before):.2f} % of a core; memory now, at most: {resident(process.pid)} MB')
    finally:
        process.send_signal(2)
        process.wait()


main()
