# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""server.py CLIENT SERVER...: starts pvserver by the command SERVER, to which a free port is added, and runs the script CLIENT by
pvpython with that port. Neither side says anything when plugins are loaded and surfaces computed."""

import os
import signal
import socket
import subprocess
import sys
import tempfile


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def said_by(output):
    return open(output.name, errors="replace").read()


def accepts(server, output):
    """Waits until the server accepts a connection; False if it ends."""
    for _ in range(400):
        if "Accepting connection" in said_by(output):
            return True
        try:
            server.wait(0.1)
            return False
        except subprocess.TimeoutExpired:
            continue
    return False


def end(server):
    """And the ranks that it has started."""
    if server.poll() is None:
        os.killpg(server.pid, signal.SIGKILL)
        server.wait()


def start(command, output):
    """Another process may take the port before the server does."""
    for _ in range(3):
        port = free_port()
        server = subprocess.Popen([*command, f"--server-port={port}"], stdout=output, stderr=output, start_new_session=True)
        if accepts(server, output):
            return server, port
        end(server)
    raise RuntimeError(f"{command} accepts no connection: {said_by(output)}")


with tempfile.NamedTemporaryFile() as output:
    server, port = start(sys.argv[2:], output)
    try:
        client = subprocess.run(["pvpython", sys.argv[1], str(port)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=110)
        status = server.wait(20)
    finally:
        end(server)
    text = said_by(output) + client.stdout.decode(errors="replace")
    assert (client.returncode, status) == (0, 0), (client.returncode, status, text)
    for word in ("ERR|", "WARN|", "rror:", "arning:", "Traceback"):
        assert word not in text, text
    print(client.stdout.decode())
