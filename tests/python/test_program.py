# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The same bytes as the program, for the same input and method."""

import os
import subprocess
import sys

import pytest

import isotet

FILES = [("data/vtu/artery_flow_tet_wedge.vtu", "Umag", 0.2), ("data/tetgen/ellipsoid_16k.node", "x", 0.1),
         ("data/msh/inclusions_v41_binary.msh", "y", 0.3)]  # fmt: skip


def by_program(program, *arguments):
    subprocess.run([program, "extract", *map(str, arguments)], check=True, capture_output=True, timeout=200)


@pytest.mark.parametrize(("file", "field", "isovalue"), FILES)
@pytest.mark.parametrize("method", ["direct", "clusters"])
def test_files_are_the_same(tree, program, tmp_path, file, field, isovalue, method):
    theirs, ours = tmp_path / "theirs.vtp", tmp_path / "ours.vtp"
    path = tree / file
    by_program(program, path, theirs, "-f", field, "-i", isovalue, "--method", method, "--normals", "gradient", "--edge-ends",
               "--source-cells")  # fmt: skip
    surface = isotet.read(path).contour(isovalue, field, method=method, normals="gradient", edge_ends=True, source_cells=True)
    surface.write(ours)
    assert len(surface.triangles) > 0
    assert ours.read_bytes() == theirs.read_bytes()


def test_several_isovalues_and_the_rule_of_the_method(tree, program, tmp_path):
    path = tree / FILES[0][0]
    for count in (2, 40):
        isovalues = [0.01 + 0.3 * i / count for i in range(count)]
        theirs, ours = tmp_path / "theirs.vtp", tmp_path / "ours.vtp"
        by_program(program, path, theirs, "-f", "Umag", "-i", ",".join(map(str, isovalues)))
        surface = isotet.read(path).contour(isovalues, "Umag")
        assert surface.method == ("direct" if count < 32 else "clusters")
        surface.write(ours)
        assert ours.read_bytes() == theirs.read_bytes()


def test_packed_grids_and_sessions_give_the_same(tree):
    grid = isotet.read(tree / FILES[0][0])
    wanted = grid.contour(0.2, "Umag", method="clusters")
    packed = isotet.pack(grid, values="Umag").contour(0.2, fields=grid.fields)
    session = isotet.Contour(grid, "Umag", method="clusters").contour(0.2)
    for surface in (packed, session):
        assert surface.points.tobytes() == wanted.points.tobytes()
        assert surface.triangles.tobytes() == wanted.triangles.tobytes()
        for name, values in wanted.fields.items():
            assert surface.fields[name].tobytes() == values.tobytes()


def test_the_module_runs_the_program_in_path(program, tmp_path):
    def module(path):
        environment = {**os.environ, "PATH": str(path)}
        return subprocess.run([sys.executable, "-m", "isotet", "--version"], env=environment, capture_output=True, text=True)

    (tmp_path / "isotet").symlink_to(program)
    expected = subprocess.run([program, "--version"], capture_output=True, text=True)
    assert module(tmp_path).stdout == expected.stdout
    without = module(tmp_path / "nothing")
    assert without.returncode == 1 and "the program is not in PATH" in without.stderr
