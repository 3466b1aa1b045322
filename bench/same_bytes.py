#!/usr/bin/env python3
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Whether two builds of isotet write the same bytes: surfaces, solids, slices, pictures and reports of all grids of data/ and
of made ones, by both programs.

    python3 bench/same_bytes.py OLD NEW [--only NAME] [--folder DATA]

Prints each case that differs, and how many were the same. Exit status 1: some differ.
"""

import argparse
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile

MADE = [f"make:{shape}:{side}:gyroid,integer" for shape, side in
        (("kuhn", 20), ("shuffled", 20), ("hex", 20), ("wedge", 16), ("pyramid", 14), ("mixed", 16), ("layer", 12),
         ("octree", 4), ("kelvin", 8), ("tet10", 6), ("hex27", 6))]
# Of each: the arguments behind the grid; {} is the output.
CASES = {
    "middle.ply": ["extract", "{}", "--with", ""],
    "levels.vtp": ["extract", "{}", "--levels", "3", "--source-cells", "--edge-ends"],
    "clusters.vtp": ["extract", "{}", "--levels", "3", "--method", "clusters"],
    "direct.vtp": ["extract", "{}", "--levels", "2", "--method", "direct", "--normals", "gradient"],
    "double.stl": ["extract", "{}", "--levels", "1", "--precision", "double"],
    "solid.ply": ["extract", "{}", "--levels", "1", "--solid", "above"],
    "clip.vtu": ["clip", "{}", "--above", "50%v"],
    "slice.vtp": ["slice", "{}", "--along", "z", "--count", "2"],
    "picture.png": ["render", "{}", "--size", "320x240"],
    "faces.png": ["render", "{}", "--size", "160x120", "--boundary", "0.3", "--levels", "2", "--normals", "gradient"],
    "info.json": ["info", "--survey", "--json", "{}"],
}
TIMES = re.compile(rb'"[a-z_]*(seconds|bytes|threads|schema|predicted[a-z_]*)": *[^,}\n]*')


def run(program, grid, name, folder):
    """The result of a case: status, what was said of errors, and what was written."""
    out = folder / name
    out.unlink(missing_ok=True)
    command, *rest = [argument.replace("{}", str(out)) for argument in CASES[name]]
    done = subprocess.run([program, command, grid, *rest, "-q"], capture_output=True, timeout=600, check=False)
    written = out.read_bytes() if out.exists() else b""
    if name.endswith(".json"):
        written = TIMES.sub(b"", written)
    said = done.stderr.replace(str(out).encode(), b"OUT")
    return done.returncode, said.decode(errors="replace").strip(), hashlib.sha256(written).hexdigest(), len(written)


def grids_of(folder):
    names = [path for path in sorted(folder.rglob("*")) if path.is_file() and path.suffix not in (".md", ".txt", ".node", ".h5")]
    return [str(path) for path in names if "licences" not in path.parts]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--only", default="", help="cases or grids whose name has this")
    parser.add_argument("--folder", default=pathlib.Path(__file__).resolve().parent.parent / "data", type=pathlib.Path)
    options = parser.parse_args()
    same = written = 0
    differ = []
    with tempfile.TemporaryDirectory() as temporary:
        for grid in grids_of(options.folder) + MADE:
            for name in CASES:
                if options.only not in f"{name} {grid}":
                    continue
                old, new = (run(program, grid, name, pathlib.Path(temporary)) for program in (options.old, options.new))
                if old == new:
                    same += 1
                    written += old[3] > 0
                    continue
                differ.append(name)
                print(f"{grid} {name}: exit status {old[0]} and {new[0]}, {old[3]} and {new[3]} bytes")
                if old[1] != new[1]:
                    print(f"  old: {old[1][:300]}\n  new: {new[1][:300]}")
                sys.stdout.flush()
    print(f"{same} the same, of which {written} wrote a file; {len(differ)} differ")
    return 1 if differ or not written else 0


if __name__ == "__main__":
    sys.exit(main())
