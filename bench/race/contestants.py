# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Contestants of the race: processes that are told what to do by one line, and answer by one line of JSON."""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path


class Refused(Exception):
    """A contestant answered with an error, or went away."""


class Contestant:
    """A running contestant. Each measures its own time, so the pipe costs nothing that is counted."""

    def __init__(self, name: str, command: list[str]):
        self.name = name
        self.facts = {}  # the reply to `open`
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, *words) -> dict:
        try:
            self._process.stdin.write("\t".join(str(word) for word in words) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            raise Refused(f"{self.name} ended with status {self._process.wait()} at: {' '.join(map(str, words))}")
        reply = json.loads(line)
        if "error" in reply:
            raise Refused(f"{self.name}: {reply['error']}")
        return reply

    def close(self) -> None:
        self._process.stdin.close()
        self._process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


@dataclass(frozen=True)
class Entrant:
    """Who may take part: how to start it, and what its command `open` needs besides folder and threads."""

    name: str
    command: tuple[str, ...]
    open_options: tuple[str, ...] = ()

    def start(self) -> Contestant:
        return Contestant(self.name, list(self.command))

    def start_with(self, folder: Path, threads: int) -> Contestant:
        contestant = self.start()
        contestant.facts = contestant.ask("open", folder, threads, *self.open_options)
        return contestant


def has_wheel(python: Path) -> bool:
    imports = "import vtkmodules.vtkFiltersCore, vtkmodules.util.numpy_support"
    return subprocess.run([python, "-c", imports], capture_output=True, check=False).returncode == 0


def entrants(build: Path, wheel_python: Path | None, vtk_ids: str) -> tuple[list[Entrant], dict[str, str]]:
    """Those that are there, and for those that are not, why."""
    found = [Entrant("isotet", (str(build / "bench/isotet_bench"),))]
    absent = {}
    vtk = build / "bench/vtk_rival"
    if vtk.exists():
        found.append(Entrant("vtk", (str(vtk),), (vtk_ids,)))
    else:
        absent["vtk"] = "the build found no VTK"
    if wheel_python and has_wheel(wheel_python):
        wheel = Path(__file__).with_name("vtk_wheel_rival.py")
        found.append(Entrant("wheel", (str(wheel_python), str(wheel)), (vtk_ids,)))
    else:
        absent["wheel"] = "no VTK wheel is installed: scripts/bench.sh --wheel gets it"
    return found, absent
