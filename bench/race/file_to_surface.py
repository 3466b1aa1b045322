# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""From file to surface: isotet against VTK, one isovalue, page cache warm, in alternating rounds. Prints a table in Markdown.

    python3 bench/race/file_to_surface.py --isotet build/demo/apps/cli/isotet --side 100 --vtk-python /usr/bin/python3
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

FIELD, ISOVALUE = "gyroid", 0.1
KINDS = {"raw": "raw.vtu", "lz4": "lz4.vtu", "zlib": "zlib.vtu", "base64 zlib": "base64.vtu", "legacy": "legacy.vtk",
         "vtkhdf": "vtkhdf.hdf"}


def isotet_seconds(options, path, surface):
    numbers = surface.with_suffix(".json")
    subprocess.run([options.isotet, "extract", path, "-o", surface, "-f", FIELD, "-i", str(ISOVALUE), "--json", numbers, "-q",
                    "-j", str(options.threads)], check=True)
    found = json.loads(numbers.read_text())
    return found["seconds"]["read"], found["surfaces"][0]["seconds"]["extract"], found["surfaces"][0]["triangles"]


def vtk_seconds(options, path, python):
    rival = pathlib.Path(__file__).with_name("vtk_file_rival.py")
    said = subprocess.run([python, "-B", rival, path, "--field", FIELD, "--isovalue", str(ISOVALUE), "--threads",
                           str(options.threads)], check=True, capture_output=True, text=True).stdout.split()
    return float(said[0]), float(said[1]), int(said[2])


def make_files(options, folder):
    made = folder / "made.vtu"
    subprocess.run([options.isotet, "make", "kuhn", "--side", str(options.side), "--fields", FIELD, "-o", made, "-q"], check=True)
    rival = pathlib.Path(__file__).with_name("vtk_file_rival.py")
    command = [options.vtk_python[0], "-B", rival, made]
    for kind, name in KINDS.items():
        command += ["--convert", kind, folder / name]
    subprocess.run(command, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--isotet", required=True)
    parser.add_argument("--vtk-python", nargs="+", default=["/usr/bin/python3"], help="interpreters with VTK: the faster one counts")
    parser.add_argument("--side", type=int, default=100, help="cubes along an edge, six tets each")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_files(options, folder)
        print(f"{6 * options.side ** 3:,} tets, {options.threads} threads, medians of {options.rounds} rounds, seconds\n")
        print("| file | MB | VTK: read | contour | isotet: read | extract | times as fast |\n|---|---:|---:|---:|---:|---:|---:|")
        for kind, file in KINDS.items():
            path = folder / file
            path.read_bytes()  # into the page cache
            ours, theirs = [], {python: [] for python in options.vtk_python}
            for _ in range(options.rounds):
                ours.append(isotet_seconds(options, path, folder / "surface.vtp"))
                for python, found in theirs.items():
                    found.append(vtk_seconds(options, path, python))
            middle = lambda found: [statistics.median(part) for part in list(zip(*found))[:2]]
            own, rival = middle(ours), min((middle(found) for found in theirs.values()), key=sum)
            print(f"| {kind} | {path.stat().st_size / 1e6:.0f} | {rival[0]:.2f} | {rival[1]:.2f} | {own[0]:.2f} | {own[1]:.2f} "
                  f"| {sum(rival) / sum(own):.1f} |", flush=True)


main()
