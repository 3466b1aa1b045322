# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: ccx2paraview==3.2.0 vtk==9.7.2 numpy==2.4.6
# debian: calculix-ccx
# files: *.frd *.vtu *.vtk *.pvd
"""CalculiX: a beam of every solid element, static in two increments, and modes; text, binary, and by ccx2paraview."""
import itertools
import pathlib
import subprocess
import sys

EDGES = {"C3D10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
         "C3D15": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
         "C3D20": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]}
SPLITS = {"C3D8": [range(8)], "C3D6": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
          "C3D4": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]}
LINEAR = {"C3D10": "C3D4", "C3D15": "C3D6", "C3D20": "C3D8", "C3D20R": "C3D8"}
SIZE = (6, 2, 2)


def mesh_of(kind):
    places = [(i, 0.5 * j, 0.5 * k) for k, j, i in itertools.product(*(range(n + 1) for n in reversed(SIZE)))]
    at = lambda i, j, k: i + (SIZE[0] + 1) * (j + (SIZE[1] + 1) * k)
    corners = [[at(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
               for k, j, i in itertools.product(*(range(n) for n in reversed(SIZE)))]
    cells = [[cell[c] for c in split] for cell in corners for split in SPLITS[LINEAR.get(kind, kind)]]
    middles = {}
    for cell in cells:
        for ends in [tuple(sorted((cell[p], cell[q]))) for p, q in EDGES.get(kind.rstrip("R"), [])]:
            if ends not in middles:
                middles[ends] = len(places)
                places.append(tuple((places[ends[0]][axis] + places[ends[1]][axis]) / 2 for axis in range(3)))
            cell.append(middles[ends])
    return places, cells


def lines(numbers, first=()):
    words = [str(word) for word in (*first, *numbers)]
    return ",\n".join(",".join(words[i:i + 12]) for i in range(0, len(words), 12))


def deck(kind, output):
    places, cells = mesh_of(kind)
    fixed = [i + 1 for i, place in enumerate(places) if place[0] == 0]
    loaded = [i + 1 for i, place in enumerate(places) if place[0] == SIZE[0]]
    requests = f"*{output[0]}\nU,NT\n*{output[1]}\nS,E,ENER,ERR\n"
    return "\n".join([
        "*NODE, NSET=NALL", *(f"{i + 1},{x},{y},{z}" for i, (x, y, z) in enumerate(places)),
        f"*ELEMENT, TYPE={kind}, ELSET=EALL", *(lines([c + 1 for c in cell], [i + 1]) for i, cell in enumerate(cells)),
        "*NSET, NSET=FIX", lines(fixed), "*NSET, NSET=END", lines(loaded),
        "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000,0.3\n*DENSITY\n7.8e-9\n*EXPANSION\n1e-5",
        "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL",
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL,20", "*BOUNDARY\nFIX,1,3",
        "*STEP, NLGEOM\n*STATIC, DIRECT\n0.5,1", "*CLOAD", *(f"{node},3,-10" for node in loaded),
        "*TEMPERATURE\nNALL,60",
        requests + "*END STEP", "*STEP\n*FREQUENCY\n3", requests.replace("U,NT", "U") + "*END STEP", ""])


for kind in ("C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20", "C3D20R"):
    for form, output in (("text", ("NODE FILE", "EL FILE")), ("binary", ("NODE OUTPUT", "ELEMENT OUTPUT"))):
        if form == "binary" and kind not in ("C3D8", "C3D10"):
            continue
        name = f"{kind}_{form}"
        pathlib.Path(f"{name}.inp").write_text(deck(kind, output))
        subprocess.run(["ccx", "-i", name], check=False)
    converter = pathlib.Path(sys.executable).parent / "ccx2paraview"
    subprocess.run([converter, f"{kind}_text.frd", "vtu", "vtk"], check=False)
