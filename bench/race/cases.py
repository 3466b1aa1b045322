# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The grids of a race: made ones, and files."""

from dataclasses import dataclass, replace
from pathlib import Path

# Cubes along an edge, by millions of cells. Tetrahedra: six a cube.
SIDES = {0.1: 26, 0.3: 37, 1: 55, 5: 94, 30: 170, 100: 255}
SHAPES = ("kuhn", "shuffled", "layer")
# Other cells, as they are: a hexahedron a cube; layers of hexahedra, wedges, pyramids and tetrahedra, 3.6 cells a cube.
OTHERS = {"hex": {0.8: 94, 3.4: 150, 27: 300}, "mixed": {3: 94}}

# The surface of the gyroid, 55 side^2 triangles near 0; none of these is a value of a float32 field.
FIELD = "gyroid"
ISOVALUES = (-0.65, -0.35, -0.05, 0.25, 0.55)

# What is hard: the regular grid of 5 million with other arrays (bench/grid_arrays.hpp), and isovalues. Of rounded values each
# isovalue is that of one point in 40 or so.
HARD = {"double": ISOVALUES, "rounded": (-0.625, -0.375, -0.0625, 0.25, 0.5625), "no_data": ISOVALUES}


@dataclass(frozen=True)
class Case:
    name: str
    shape: str  # "file" for files
    source: str
    field: str
    isovalues: tuple[float, ...] | None  # None: spread over the range of the field
    about_cells: float = 0
    variant: str = ""  # of the arrays: bench/grid_arrays.hpp

    def choose_isovalues(self, lower: float, upper: float, count: int) -> list[float]:
        if self.isovalues is None:
            return [lower + (k + 1) * (upper - lower) / (count + 1) for k in range(count)]
        middle = len(self.isovalues) // 2
        first = max(0, min(middle - count // 2, len(self.isovalues) - count))
        return list(self.isovalues[first:first + count])


def made(shape: str, millions: float, side: int) -> Case:
    return Case(f"{shape}_{millions:g}M", shape, f"make:{shape}:{side}", FIELD, ISOVALUES, 1e6 * millions)


def file_case(path: Path, field: str) -> Case:
    return Case(path.stem, "file", str(path), field, None)


def made_cases(quick: bool, max_cells: float) -> list[Case]:
    """All shapes and sizes; quick: the regular grids up to 30 million, the others at 5 million."""
    cases = []
    for shape in SHAPES:
        for millions in SIDES:
            if quick and (millions > 30 or (shape != "kuhn" and millions != 5)):
                continue
            cases.append(made(shape, millions, SIDES[millions]))
    cases += [replace(made("kuhn", 5, SIDES[5]), name=f"kuhn_5M_{variant}", shape=f"kuhn, {variant}", isovalues=isovalues,
                      variant=variant) for variant, isovalues in HARD.items()]
    cases += [made(shape, millions, side) for shape, sides in OTHERS.items() for millions, side in sides.items()]
    return [case for case in cases if case.about_cells <= max_cells]


def shipped_files(root: Path) -> list[Case]:
    """Real grids of data/ with a field worth a surface."""
    files = [("vtu/artery_flow_tet_wedge.vtu", "Umag"), ("medit/cube_sphere_26k.meshb", "x"),
             ("vtkhdf/can_hex.hdf", "z")]
    return [file_case(root / "data" / path, field) for path, field in files]
