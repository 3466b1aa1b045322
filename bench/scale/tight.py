# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet's commands in memory control groups that get tighter, without swap: what ends well, what ends with a sentence, and
what the system kills. Needs the right to make control groups (version 1 or 2 in /sys/fs/cgroup).

    python bench/scale/tight.py --isotet build/demo/apps/cli/isotet --folder /tmp/tight [--only raw,...] [--steps 2]

The interpreter makes the grids; it needs numpy and VTK 9.4 or later. A run's limit is that of the one before, divided by
--steps, from twice what the command takes without a limit down to 10 MB. The exit status is 1 where a process was killed.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

FIELD = "gyroid"
TEN = ",".join(f"{-0.9 + 0.2 * i:.1f}" for i in range(10))
# Name: a shape of `isotet make` and its side; or another grid, in boxes (pieces.py) or in another form (variants.py).
GRIDS = {
    "raw": ("kuhn", 94),
    "zlib": ("raw", "zlib"),
    "pieces_8": ("raw", 2),
    "pieces_64": ("raw", 4),
    "mixed_cells": ("mixed", 100),
    "polyhedra": ("kelvin", 40),
    "vtkhdf": ("raw", "vtkhdf"),
    "exodus": ("raw", "exodus"),
}
ENDINGS = {"zlib": ".vtu", "vtkhdf": ".vtkhdf", "exodus": ".e"}
COMMANDS = {
    "info": ["info", "GRID"],
    "extract 1": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", "0.1"],
    "extract 10": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "--isovalue=" + TEN],
    "extract 40": ["extract", "GRID", "OUT_{value}.vtp", "-f", FIELD, "--isovalue=" + ",".join(f"{0.02 * i:.2f}" for i in range(40))],
    "slice": ["slice", "GRID", "OUT.vtp", "--plane", "z=0.1"],
    "pack": ["pack", "GRID", "OUT.isotet"],
    "render": ["render", "GRID", "-o", "OUT.png", "-f", FIELD, "-i", "0.1"],
}


class Group:
    """A control group for the program alone."""

    def __init__(self):
        mount = pathlib.Path("/sys/fs/cgroup")
        self.first = (mount / "memory").is_dir()
        base = mount / "memory" if self.first else mount
        self.folder = base / f"isotet-tight-{os.getpid()}"
        self.folder.mkdir()
        if not self.first and not (self.folder / "memory.max").exists():
            self.remove()
            sys.exit("the memory controller is not there in /sys/fs/cgroup/cgroup.subtree_control")

    def remove(self):
        time.sleep(0.5)
        self.folder.rmdir()

    def set(self, limit):
        """No limit where it is nothing."""
        def put(name, value):
            for wait in range(50):  # a reader process may be about to end
                try:
                    return (self.folder / name).write_text(str(value))
                except OSError:
                    time.sleep(0.1)

        if self.first:
            put("memory.limit_in_bytes", limit or -1)
            put("memory.swappiness", 0)
            put("memory.max_usage_in_bytes", 0)
            put("memory.force_empty", 0)  # pages of files that others left
        else:
            put("memory.max", limit or "max")
            put("memory.swap.max", 0)

    def kills(self):
        """How many processes of it the system ended."""
        name = "memory.oom_control" if self.first else "memory.events"
        match = re.search(r"^oom_kill (\d+)", (self.folder / name).read_text(), re.M)
        return int(match[1]) if match else 0

    def join(self):
        (self.folder / "cgroup.procs").write_text("0")

    def run(self, command, limit):
        """Exit status, what it said last, whether a process was killed, and the most memory that it had at once."""
        self.set(limit)
        before = self.kills()
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True, errors="replace", preexec_fn=self.join)  # fmt: skip
        peak = 0
        while process.poll() is None:
            try:
                process.wait(0.01)
            except subprocess.TimeoutExpired:
                status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
                peak = max([peak] + [int(line.split()[1]) * 1024 for line in status.splitlines() if line.startswith("VmHWM")])
        lines = process.stderr.read().strip().splitlines()
        process.stderr.close()
        return process.returncode, lines[-1] if lines else "", self.kills() > before, peak


def make(options, name):
    what, count = GRIDS[name]
    beside = pathlib.Path(__file__).with_name
    if what not in GRIDS:
        path = options.folder / f"{name}.vtu"
        command = [options.isotet, "make", what, "--side", str(count), "--fields", FIELD + ",sphere", "-o", path, "-q"]
    elif isinstance(count, str):
        path = options.folder / (name + ENDINGS[count])
        command = [sys.executable, "-B", beside("variants.py"), count, make(options, what), path, FIELD]
    else:
        path = options.folder / f"{name}.pvtu"
        command = [sys.executable, "-B", beside("pieces.py"), make(options, what), path, str(count), FIELD]
    if not path.exists():
        subprocess.run([str(word) for word in command], check=True)
    return path


def limits(most, ratio):
    limit = most
    while limit >= 10e6:
        yield int(limit) // 4096 * 4096
        limit /= ratio


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--isotet", default="build/demo/apps/cli/isotet")
    parser.add_argument("--folder", type=pathlib.Path, required=True, help="for the grids, which stay, and for results")
    parser.add_argument("--only", help="of " + ", ".join(GRIDS))
    parser.add_argument("--commands", help="of " + ", ".join(COMMANDS))
    parser.add_argument("--steps", type=float, default=2, help="a limit is the one before, divided by this")
    parser.add_argument("--most", type=float, help="the first limit; default: twice what a command takes")
    parser.add_argument("--say", action="store_true", help="print the sentences, too")
    options = parser.parse_args()
    options.folder.mkdir(exist_ok=True)
    out = options.folder / "out"
    group, killed = Group(), 0
    try:
        for name in options.only.split(",") if options.only else GRIDS:
            grid = make(options, name)
            for command in options.commands.split(",") if options.commands else COMMANDS:
                out.mkdir(exist_ok=True)
                words = [options.isotet, *(word.replace("GRID", str(grid)).replace("OUT", str(out / "o")) for word in COMMANDS[command]), "-q"]
                status, said, _, peak = group.run(words, None)
                row = [f"{name:10} {command:10} {status} {peak / 1e6:6.0f} MB |"]
                if status != 0:
                    row.append(said)
                for limit in limits(options.most or 2 * peak, options.steps):
                    status, said, kill, _ = group.run(words, limit)
                    word = "KILLED" if status == -9 else {0: "ok", 4: "said"}.get(status, f"status {status}") + " (reader killed)" * kill
                    killed += kill
                    row.append(f"{limit / 1e6:.0f} {word},")
                    if options.say and word != "ok":
                        row.append(f"\n      {said}\n     ")
                    if kill and not options.say:
                        row.append(f"({said})" if said else "")
                print(*row, flush=True)
                shutil.rmtree(out)
    finally:
        shutil.rmtree(out, ignore_errors=True)
        group.remove()
    print(f"{killed} killed")
    sys.exit(killed > 0)


if __name__ == "__main__":
    main()
