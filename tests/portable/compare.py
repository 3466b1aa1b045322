# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of extract_made.cpp against those of the program, byte for byte: python3 compare.py PROGRAM COMMAND..., which may begin
with an emulator."""
import os
import re
import subprocess
import sys
import tempfile

SIZES = {b'float': 4, b'double': 8, b'uchar': 1, b'int': 4}
# Cells of all kinds: linear ones, mixed, polyhedra, quadratic ones; ties at whole values.
GRIDS = [('kuhn:12', 'sphere'), ('kuhn:9', 'integer'), ('mixed:8', 'sphere'), ('wedge:8', 'gyroid'), ('pyramid:8', 'gyroid'), ('hex:12', 'integer'),
         ('tet10:6', 'sphere'), ('kelvin:5', 'sphere'), ('shuffled:8', 'gyroid'), ('hex27:4', 'sphere')]
ISOVALUES = ['0.3', '0.7', '1']


def of_ply(path):
    """Positions, then triangles of a binary PLY of isotet."""
    with open(path, 'rb') as file:
        content = file.read()
    head, _, body = content.partition(b'end_header\n')
    vertices, triangles = (int(re.search(rb'element %s (\d+)' % name, head)[1]) for name in (b'vertex', b'face'))
    each = sum(SIZES[kind] for kind in re.findall(rb'property (\w+) \w+\n', head[:head.index(b'element face')]))
    faces = body[each * vertices:]
    size = len(faces) // max(1, triangles)
    return body[:each * vertices] + b''.join(faces[size * i + 1:size * i + 13] for i in range(triangles))


def main():
    program, *command = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix='isotet-portable-') as folder:
        for grid, field in GRIDS:
            subprocess.run([*command, folder, f'{grid}:{field}', field, *ISOVALUES], check=True, stdout=subprocess.DEVNULL)
            sizes = []
            for i, isovalue in enumerate(ISOVALUES):
                ply = os.path.join(folder, 'a.ply')
                subprocess.run([program, 'extract', f'make:{grid}:{field}', ply, '-f', field, '-i', isovalue, '--with', '', '--method', 'clusters',
                                '--tolerance', 'nodes', '--quiet'], check=True)
                expected = of_ply(ply)
                with open(os.path.join(folder, str(i)), 'rb') as file:
                    got = file.read()
                if got != expected:
                    print(f'FAILED {grid} {field} at {isovalue}: {len(got)} bytes, not those {len(expected)} of the program')
                    return 1
                sizes.append(len(got))
            print(f'ok {grid} {field}: the same {sum(sizes):,} bytes', flush=True)
    return 0


sys.exit(main())
