# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet's commands at the sizes that users have, beside VTK's reader and contour, page cache warm, in alternating rounds. Prints a
table in Markdown: medians of wall time and of processor time, and the peak of memory, of whole processes; of VTK, which reads,
contours and writes a VTP, too, without what importing it takes.

    python bench/scale --isotet build/demo/apps/cli/isotet --vtk-python /usr/bin/python3 WHEEL/bin/python
    python bench/scale --isotet build/demo/apps/cli/isotet --quick
    python bench/scale --isotet build/demo/apps/cli/isotet --only tets_30M,hexahedra_27M --rounds 5 --base OTHER/isotet

The last interpreter makes the grids; it needs numpy and VTK 9.4 or later. With Debian's VTK 9.1 and the wheel of VTK 9.7, two
cores and one round all of it takes 11 minutes, and 14 GB in --folder, where grids stay for the next run. --quick,
grids of an eighth of the cells and one round, takes a few minutes and 2 GB.
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
# Name: what it is made of, and its side: a shape of `isotet make`; or another grid, in boxes (pieces.py) or in another form
# (variants.py); or a case of OpenFOAM of hexahedra, in parts.
GRIDS = {
    "tets_5M": ("kuhn", 94),
    "tets_30M": ("kuhn", 171),
    "tets_30M_wide": ("tets_30M", "wide"),
    "tets_30M_64_pieces": ("tets_30M", 4),
    "tets_30M_64_pieces_no_ids": ("tets_30M", -4),
    "tets_30M_zlib": ("tets_30M", "zlib"),
    "tets_30M_legacy": ("tets_30M", "legacy"),
    "tets_30M_vtkhdf": ("tets_30M", "vtkhdf"),
    "tets_100M": ("kuhn", 255),
    "tets_100M_64_pieces": ("tets_100M", 4),
    "hexahedra_27M": ("hex", 300),
    "mixed_21M": ("mixed", 170),
    "polyhedra_1M": ("kelvin", 80),
    "tet10_1M": ("tet10", 55),
    "openfoam_5M": ("foam", 171),
    "openfoam_5M_8_parts": ("foam 8", 171),
}
EXTENSIONS = {"wide": ".vtu", "zlib": ".vtu", "legacy": ".vtk", "vtkhdf": ".vtkhdf"}
COMMANDS = {
    "info --heads": ["info", "GRID", "--heads"],
    "info": ["info", "GRID"],
    "extract 1": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE, "--with", ""],
    "extract 10": ["extract", "GRID", "OUT_{value}.vtp", "-f", FIELD, "--isovalue=" + TEN, "--with", ""],
    "fields": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE],
    "source cells": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE, "--with", "", "--source-cells"],
    "gradients": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE, "--with", "", "--normals", "gradient"],
    "edge ends": ["extract", "GRID", "OUT.vtp", "-f", FIELD, "-i", ISOVALUE, "--with", "", "--edge-ends"],
    "check": ["check", "OUT.vtp", "--grid", "GRID", "-f", FIELD],  # of the surface before
    "render": ["render", "GRID", "-o", "OUT.png", "-f", FIELD, "-i", ISOVALUE],
    "render, no boundary": ["render", "GRID", "-o", "OUT.png", "-f", FIELD, "-i", ISOVALUE, "--boundary", "0"],
}


def beside(name):
    return pathlib.Path(__file__).with_name(name)


def side_of(options, what, count):
    """An eighth of the cells where all is to be quick."""
    return count // 2 if options.quick and what.split()[0] in ("kuhn", "hex", "mixed", "kelvin", "tet10", "foam") else count


def make(options, name):
    what, count = GRIDS[name]
    python = [options.vtk_python[-1], "-B"]
    side = str(side_of(options, what, count))
    if what.startswith("foam"):
        path, command = options.folder / name / "case.foam", [*python, beside("variants.py"), "foam", side, options.folder / name, FIELD]
        command += what.split()[1:]
    elif what not in GRIDS:
        path = options.folder / f"{name}.vtu"
        command = [options.isotet, "make", what, "--side", side, "--fields", FIELD, "-o", path, "-q"]
    elif isinstance(count, str):
        path = options.folder / (name + EXTENSIONS[count])
        command = [*python, beside("variants.py"), count, make(options, what), path, FIELD]
    else:
        path = options.folder / f"{name}.pvtu"
        command = [*python, beside("pieces.py"), make(options, what), path, str(abs(count)), FIELD] + ["no-ids"] * (count < 0)
    if not path.exists():
        subprocess.run([str(word) for word in command], check=True)
    return path


def warm(path):
    """Brings a grid's files into the page cache."""
    files = path.parent.rglob("*") if path.suffix == ".foam" else path.parent.glob(path.stem + "*")
    for file in files:
        if not file.is_file():
            continue
        with open(file, "rb") as stream:  # a peak of memory is inherited: this process stays small
            while stream.read(1 << 20):
                pass


def peak_of(number):
    """Of a process that runs, in bytes; isotet resets it between steps, so it is looked at all the time."""
    try:
        lines = pathlib.Path(f"/proc/{number}/status").read_text().splitlines()
    except OSError:
        return 0
    return max((int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM")), default=0)


def run(command):
    """Wall seconds, processor seconds and peak bytes of a process and its children; nothing where it fails."""
    begin = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    peak, number = 0, 0
    while number == 0:
        peak = max(peak, peak_of(process.pid))
        time.sleep(0.005)
        number, status, usage = os.wait4(process.pid, os.WNOHANG)
    if status != 0:
        return None
    return time.perf_counter() - begin, usage.ru_utime + usage.ru_stime, max(peak, usage.ru_maxrss * 1024)


def ours(options, isotet, path, name):
    words = {"GRID": path, "OUT.vtp": options.out / "surface.vtp", "OUT.png": options.out / "picture.png",
             "OUT_{value}.vtp": str(options.out / "surface_{value}.vtp")}  # fmt: skip
    command = [words.get(word, word) for word in COMMANDS[name]]
    return run([isotet, *command, "-q", "-j", options.threads])


def vtk_seconds(options, path, python, isovalues):
    """Wall and processor seconds and peak bytes, as of run()."""
    command = [python, "-B", beside("vtk_rival.py"), path, FIELD, isovalues, options.threads]
    said = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    return tuple(float(word) for word in said.stdout.split()) if said.returncode == 0 and said.stdout else None


def cell_of(found):
    found = [one for one in found if one]
    if not found:
        return "-"
    wall, cpu = (statistics.median(one[i] for one in found) for i in (0, 1))
    return f"{wall:.2f} ({cpu:.2f}) / {max(one[2] for one in found) / 1e6:.0f}"


def measure(options, name):
    path = make(options, name)
    warm(path)
    columns = {(isotet, command): [] for command in options.commands for isotet in options.programs}
    rivals = {(python, isovalues): [] for python in options.vtk_python for isovalues in options.vtk_isovalues}
    for _ in range(options.rounds):
        for (isotet, command), found in columns.items():
            found.append(ours(options, isotet, path, command))
        for (python, isovalues), found in rivals.items():
            found.append(vtk_seconds(options, path, python, isovalues))
    return [cell_of(found) for found in (*columns.values(), *rivals.values())]


def version_of(python):
    said = subprocess.run([python, "-c", "import vtk; print(vtk.vtkVersion().GetVTKVersion())"], capture_output=True, text=True)
    return said.stdout.strip() or "?"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--isotet", required=True)
    parser.add_argument("--vtk-python", nargs="+", default=[sys.executable], help="interpreters with VTK")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "isotet_scale")
    parser.add_argument("--only", type=lambda text: text.split(","), default=list(GRIDS), help="grids, by name")
    parser.add_argument("--commands", type=lambda text: text.split(","), default=list(COMMANDS), help="of these columns alone")
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--base", help="another isotet, whose columns stand beside those of --isotet")
    parser.add_argument("--no-vtk", action="store_true", help="without VTK's columns; VTK still makes grids")
    parser.add_argument("--quick", action="store_true", help="grids of an eighth of the cells, one round, one isovalue of VTK")
    options = parser.parse_args()
    options.rounds = options.rounds or (1 if options.quick else 3)
    options.folder = options.folder / "quick" if options.quick else options.folder
    options.folder.mkdir(parents=True, exist_ok=True)
    options.programs = [options.base, options.isotet] if options.base else [options.isotet]
    options.vtk_isovalues = [] if options.no_vtk else [ISOVALUE] if options.quick else [ISOVALUE, TEN]
    begin = time.perf_counter()
    print(f"Wall seconds (processor seconds) / MB, medians of {options.rounds} rounds, {options.threads} threads, "
          f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the start\n")  # fmt: skip
    ours_are = [command + (", base" if isotet != options.isotet else "") for command in options.commands for isotet in options.programs]
    rivals = [f"VTK {version_of(which)}, {len(values.split(','))}" for which in options.vtk_python for values in options.vtk_isovalues]
    print("| grid | " + " | ".join([*ours_are, *rivals]) + " |\n|---|" + "---:|" * (len(ours_are) + len(rivals)))
    with tempfile.TemporaryDirectory() as out:
        options.out = pathlib.Path(out)
        for name in options.only:
            print(f"| {name} | " + " | ".join(measure(options, name)) + " |", flush=True)
    print(f"\n{(time.perf_counter() - begin) / 60:.0f} minutes, load {os.getloadavg()[0]:.1f} at the end")


main()
