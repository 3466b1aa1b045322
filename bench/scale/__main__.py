# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet's commands at the sizes that users have, beside VTK's reader and contour, page cache warm, in alternating rounds. Prints a
table in Markdown: medians of wall time and the peak of memory, of whole processes; of VTK, which reads, contours and writes a VTP,
too, without what importing it takes.

    python bench/scale --isotet build/demo/apps/cli/isotet --vtk-python /usr/bin/python3 WHEEL/bin/python
    python bench/scale --isotet build/demo/apps/cli/isotet --only tets_30M,hexahedra_27M --rounds 5

The interpreter needs numpy and vtk. Grids take 0.1 to 2.4 GB each in --folder, and stay there for the next run.
"""
import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

FIELD, ISOVALUE = "gyroid", "0.1"
TEN = ",".join(f"{-0.9 + 0.2 * i:.1f}" for i in range(10))
# Name: shape and cubes along an edge of `isotet make`, or the grid that is cut, and boxes along an edge.
GRIDS = {
    "tets_5M": ("kuhn", 94),
    "tets_30M": ("kuhn", 171),
    "tets_30M_64_pieces": ("tets_30M", 4),
    "tets_100M": ("kuhn", 255),
    "hexahedra_27M": ("hex", 300),
    "mixed_21M": ("mixed", 170),
    "polyhedra_1M": ("kelvin", 80),
    "tet10_1M": ("tet10", 55),
}
COMMANDS = {
    "info --heads": ["info", "GRID", "--heads"],
    "info": ["info", "GRID"],
    "extract 1": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE, "--with", ""],
    "extract 10": ["extract", "GRID", "OUT_{value}.vtp", "-f", FIELD, "--isovalue=" + TEN, "--with", ""],
    "edge ends": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE, "--with", "", "--edge-ends"],
    "check": ["check", "OUT.vtp", "--grid", "GRID", "-f", FIELD],  # of the surface before
    "render": ["render", "GRID", "-o", "OUT.png", "-f", FIELD, "-i", ISOVALUE],
    "render, no boundary": ["render", "GRID", "-o", "OUT.png", "-f", FIELD, "-i", ISOVALUE, "--boundary", "0"],
}


def make(options, name):
    what, count = GRIDS[name]
    if what in GRIDS:
        whole, path = make(options, what), options.folder / f"{name}.pvtu"
        if not path.exists():
            program = pathlib.Path(__file__).with_name("pieces.py")
            subprocess.run([sys.executable, "-B", program, whole, path, str(count), FIELD], check=True)
        return path
    path = options.folder / f"{name}.vtu"
    if not path.exists():
        subprocess.run([options.isotet, "make", what, "--side", str(count), "--fields", FIELD, "-o", path, "-q"], check=True)
    return path


def warm(path):
    """Brings a grid's files into the page cache."""
    for file in path.parent.glob(path.stem + "*"):
        with open(file, "rb") as stream:  # a peak of memory is inherited: this process stays small
            while stream.read(1 << 20):
                pass


def run(command):
    """Seconds and peak bytes of a process and its children; nothing where it fails."""
    begin = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    return (time.perf_counter() - begin, usage.ru_maxrss * 1024) if status == 0 else None


def ours(options, path, name):
    words = {"GRID": path, "OUT.vtp": options.out / "surface.vtp", "OUT.png": options.out / "picture.png",
             "OUT_{value}.vtp": str(options.out / "surface_{value}.vtp")}  # fmt: skip
    command = [words.get(word, word) for word in COMMANDS[name]]
    return run([options.isotet, *command, "-q", "-j", options.threads])


def vtk_seconds(options, path, python, isovalues):
    rival = pathlib.Path(__file__).with_name("vtk_rival.py")
    said = subprocess.run([python, "-B", rival, path, FIELD, isovalues, str(options.threads)], capture_output=True, text=True)
    return sum(float(word) for word in said.stdout.split()[:3]) if said.returncode == 0 else None


def cell_of(found):
    found = [one for one in found if one]
    if not found:
        return "-"
    if isinstance(found[0], float):
        return f"{statistics.median(found):.2f}"
    return f"{statistics.median(one[0] for one in found):.2f} / {max(one[1] for one in found) / 1e6:.0f}"


def measure(options, name):
    path = make(options, name)
    warm(path)
    columns = {command: [] for command in options.commands}
    rivals = {(python, isovalues): [] for python in options.vtk_python for isovalues in (ISOVALUE, TEN)}
    for _ in range(options.rounds):
        for command, found in columns.items():
            found.append(ours(options, path, command))
        for (python, isovalues), found in rivals.items():
            found.append(vtk_seconds(options, path, python, isovalues))
    return [cell_of(found) for found in (*columns.values(), *rivals.values())]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--isotet", required=True)
    parser.add_argument("--vtk-python", nargs="+", default=[sys.executable], help="interpreters with VTK")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "isotet_scale")
    parser.add_argument("--only", type=lambda text: text.split(","), default=list(GRIDS), help="grids, by name")
    parser.add_argument("--commands", type=lambda text: text.split(","), default=list(COMMANDS), help="of these columns alone")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    print(f"Seconds / MB, medians of {options.rounds} rounds, {options.threads} threads, load {os.getloadavg()[0]:.1f} at the start\n")
    rivals = [f"VTK {which}, {count}" for which in options.vtk_python for count in (1, 10)]
    print("| grid | " + " | ".join([*options.commands, *rivals]) + " |\n|---|" + "---:|" * (len(options.commands) + len(rivals)))
    with tempfile.TemporaryDirectory() as out:
        options.out = pathlib.Path(out)
        for name in options.only:
            print(f"| {name} | " + " | ".join(measure(options, name)) + " |", flush=True)


main()
