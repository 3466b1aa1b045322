# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What packed files promise, measured in one run: bytes a cell, bytes read, memory, and ratios of times.

    python bench/packed_musts.py build/apps/cli/isotet                    # 29.5 million tets, 3.4 million hexahedra
    python bench/packed_musts.py build/apps/cli/isotet --side 60 --hex-side 40 --rounds 3
    python bench/packed_musts.py build/apps/cli/isotet --side 255 --bounded 2.5GB    # 100 million tets, packing too

Processor times (user and system) of whole processes, medians of alternate rounds. Cold: the file's pages are dropped by
posix_fadvise() before each. Rows of sessions need the package isotet, those of VTK vtk. At a quiet moment only.
"""

import argparse
import importlib.util
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

VTK_SCRIPT = """
import sys, vtk
reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
contour = vtk.vtkContourFilter()
contour.SetInputConnection(reader.GetOutputPort())
contour.SetInputArrayToProcess(0, 0, 0, 0, "sphere")
contour.SetValue(0, 0.5)
contour.Update()
"""


class Measured:
    """Of a process that ended: seconds of processors and of the clock, bytes from the disk, its peak of memory (at least that of
    this one when it forked: large packages are imported last)."""

    def __init__(self, command):
        start = time.perf_counter()
        child = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode != 0:
            raise SystemExit(f"{command} exited with {child.returncode}")
        self.wall = time.perf_counter() - start
        self.processors = usage.ru_utime + usage.ru_stime
        self.from_disk = 512 * usage.ru_inblock
        self.peak = 1024 * usage.ru_maxrss


def drop_pages(path):
    with open(path, "rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def alternate(rounds, *runs):
    """Medians of processor times, and of the clock."""
    times = [[run() for run in runs] for _ in range(rounds)]
    of = lambda what: [statistics.median(getattr(round_[i], what) for round_ in times) for i in range(len(runs))]
    return of("processors"), of("wall")


class Table:
    def __init__(self, folder, options):
        self.folder, self.options = folder, options

    def program(self, *words):
        return Measured([self.options.isotet, *words])

    def numbers(self, *words):
        path = self.folder / "numbers.json"
        self.program(*words, "--json", path, "-q")
        return json.loads(path.read_text())

    def row(self, what, must, aim, figure):
        print(f"| {what} | {must} | {aim} | {figure} |", flush=True)

    def ratio(self, what, must, aim, ours, other):
        (a, b), (wall_a, wall_b) = alternate(self.options.rounds, ours, other)
        self.row(what, must, aim, f"{a / b:.3f} ({a:.2f} beside {b:.2f} s; on the clock {wall_a:.2f} beside {wall_b:.2f} s)")

    def sizes(self):
        for shape, side, must, aim in (("kuhn", self.options.side, "10.4", "10.1"), ("hex", self.options.hex_side, "43", "41.5")):
            out = self.folder / f"{shape}.isotet"
            done = self.numbers("pack", f"make:{shape}:{side}:sphere", out)
            cells = done["tets"] + done["other_cells"]
            self.row(f"file, bytes a cell, {cells:,} of {shape}", must, aim, f"{done['bytes'] / cells:.2f}")
        for option, extra in (("another field", ["--fields", "sphere,gyroid"]), ("--source-cells", ["--source-cells"]),
                              ("--gradients", ["--gradients"])):
            for shape, side in (("kuhn", self.options.side), ("hex", self.options.hex_side)):
                fields = "sphere,gyroid" if "field" in option else "sphere"
                out = self.folder / "option.isotet"
                done = self.numbers("pack", f"make:{shape}:{side}:{fields}", out, *extra)
                cells = done["tets"] + done["other_cells"]
                plain = (self.folder / f"{shape}.isotet").stat().st_size
                self.row(f"{option}, bytes a cell more, {shape}", "", "", f"{(done['bytes'] - plain) / cells:.2f}")
                out.unlink()

    def packing(self):
        seconds = [self.numbers("pack", self.made, self.folder / "again.isotet")["seconds"] for _ in range(self.options.rounds)]
        shares = [one["write"] / one["pack"] for one in seconds]
        self.row("saving, with finding the boundary, beside packing", "0.25 without", "0.15", f"{statistics.median(shares):.2f}")
        (self.folder / "again.isotet").unlink()
        return statistics.median(one["pack"] for one in seconds)

    def first_surfaces(self):
        surface = ("extract", self.packed, "-f", "sphere", "-i", "0.5", "-q")
        raw = ("extract", self.vtu, "-f", "sphere", "-i", "0.5", "-q")
        pack = self.packing()
        warm = statistics.median(self.program(*surface).wall for _ in range(self.options.rounds))
        self.row("open and first surface warm, beside packing", "1/60", "1/120", f"1/{pack / warm:.0f} ({warm:.3f} beside {pack:.2f} s)")

        def cold(path, *words):
            drop_pages(path)
            return self.program(*words)

        ours, theirs = cold(self.packed, *surface), cold(self.vtu, *raw)
        self.row("first surface cold, bytes from the disk, beside the raw VTU", "1/8", "1/15",
                 f"1/{theirs.from_disk / max(ours.from_disk, 1):.1f} ({ours.from_disk / 1e6:.0f} beside {theirs.from_disk / 1e6:.0f} MB)")
        self.ratio("the same, in time", "1/5 = 0.200", "0.100", lambda: cold(self.packed, *surface), lambda: cold(self.vtu, *raw))
        if not importlib.util.find_spec("vtkmodules"):
            self.row("the same beside VTK's reader and contour", "1/12", "1/20", "no vtk")
        else:
            def by_vtk():
                drop_pages(self.vtu)
                return Measured([sys.executable, "-c", VTK_SCRIPT, self.vtu])

            self.ratio("the same beside VTK's reader and contour", "1/12 = 0.083", "0.050",
                       lambda: cold(self.packed, *surface), by_vtk)
        told = self.numbers(*surface[:-1])["packed_file"]
        self.row("bytes read, sphere through the middle, of the file", "14 / 9.5 / 4.5 %", "11 / 7 / 3.3 %",
                 f"{100 * told['bytes_read'] / told['bytes']:.1f} %, {told['reads']} reads")
        measured = self.program(*surface)
        self.row("memory of the process, first surface", "200 MB at 100 M beside the surface", "120 MB",
                 f"{measured.peak / 1e6:.0f} MB, surface included")

    def limited(self):
        gyroid = self.folder / "gyroid.isotet"
        self.program("pack", f"make:kuhn:{self.options.side}:gyroid", gyroid, "-q")
        words = ("extract", gyroid, "-i", "0")
        wanted = self.numbers(*words)["packed_file"]["peak_bytes_in_memory"]
        limit = wanted // 4
        outs = [self.folder / "all.vtp", self.folder / "limited.vtp"]
        self.program(*words, outs[0], "-q")
        self.program(*words, outs[1], "--memory", f"{limit}B", "-q")
        same = outs[0].read_bytes() == outs[1].read_bytes()
        told = self.numbers(*words, "--memory", f"{limit}B")["packed_file"]
        self.row("surface that needs four times --memory", "the same bytes, pieces within 1.1 of the limit", "",
                 f"{'the same bytes' if same else 'OTHER BYTES'}, pieces {told['peak_bytes_in_memory'] / limit:.2f} of {limit / 1e6:.0f} MB")
        self.ratio("the same, in time, beside no limit", "1.6", "1.3",
                   lambda: self.program(*words, "--memory", f"{limit}B", "-q"), lambda: self.program(*words, "-q"))
        for path in (gyroid, *outs):
            path.unlink()

    def sessions(self):
        try:
            import isotet
        except ImportError:
            return self.row("next isovalue, next step", "", "", "no package isotet")
        def timed(work):
            start = time.process_time()
            work()
            return time.process_time() - start

        in_memory = isotet.pack(isotet.make("kuhn", self.options.side, ["sphere"]))
        of_file = isotet.open(self.packed, memory=64 << 30).grid()
        values = [0.5 + 0.4 * i / (2 * self.options.rounds + 1) for i in range(2 * self.options.rounds + 2)]
        for value in values:  # brings all that they meet
            of_file.contour(value)
        a = [timed(lambda: of_file.contour(value)) for value in values]
        b = [timed(lambda: in_memory.contour(value)) for value in values]
        self.row("next isovalue, resident, beside memory", "1.05", "1.0", f"{statistics.median(a) / statistics.median(b):.2f}")
        steps = self.folder / "steps.isotet"
        self.program("pack", self.made, steps, "-q")
        self.program("pack", self.made, steps, "--append", "-q")
        next_steps, direct = [], []
        for _ in range(self.options.rounds):
            file = isotet.open(steps)
            file.contour(0.5, step=0)
            drop_pages(steps)
            next_steps.append(timed(lambda file=file: file.contour(0.5, step=1)))
            drop_pages(self.vtu)
            direct.append(self.program("extract", self.vtu, "-f", "sphere", "-i", "0.5", "--method", "direct", "-q").processors)
        a, b = statistics.median(next_steps), statistics.median(direct)
        self.row("next step cold, beside its VTU and direct", "1/10", "1/20", f"1/{b / a:.0f} ({a:.3f} beside {b:.2f} s)")

    def bounded(self):
        if not self.options.bounded:
            return
        words = ("pack", self.made, self.folder / "bounded.isotet", "-q")
        limited = lambda: self.program(*words, "--memory", self.options.bounded, "--scratch", self.folder)
        self.ratio(f"packed within {self.options.bounded}, beside in memory", "3", "1.7", limited, lambda: self.program(*words))
        measured = limited()
        same = (self.folder / "bounded.isotet").read_bytes() == self.packed.read_bytes()
        self.row("its memory, its file", "", "", f"{measured.peak / 1e9:.2f} GB, {'the same bytes' if same else 'OTHER BYTES'}")

    def all(self):
        self.made = f"make:kuhn:{self.options.side}:sphere"
        self.packed, self.vtu = self.folder / "kuhn.isotet", self.folder / "kuhn.vtu"
        print("| | must | aim | measured |\n|---|---|---|---|")
        self.sizes()
        self.program("make", "kuhn", "--side", self.options.side, "--fields", "sphere", "-o", self.vtu, "-q")
        self.first_surfaces()
        self.limited()
        self.bounded()
        self.sessions()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("isotet", type=Path)
    parser.add_argument("--side", type=int, default=170, help="cubes of six tets a side")
    parser.add_argument("--hex-side", type=int, default=150)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--bounded", default="", help="memory to pack within, too")
    parser.add_argument("--folder", type=Path, help="on the disk that counts; default: that of temporary files")
    options = parser.parse_args()
    options.isotet = options.isotet.resolve()
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        Table(Path(folder), options).all()


main()
