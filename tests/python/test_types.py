# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Type hints hold in strict code, for mypy and pyright."""

import json
import subprocess
import sys

import pytest

from conftest import TREE

EXAMPLES = TREE / "examples/python"
TYPED = """
import numpy as np
import isotet
grid = isotet.make("kuhn", 4, ["sphere"])
values = np.zeros(len(grid.points))
surface: isotet.Surface = grid.contour(np.linspace(0, 1, 3))
surface = grid.contour(np.float32(0.5), normals="vertex")
isotet.contour(grid.points, [[0, 1, 2, 3]], values, [0.5, np.float64(0.3)])
again = isotet.Grid(grid.to_pyvista())
session = isotet.Contour(again, values)
session.set(again, [1.0, 2.0])
print(surface.to_pyvista(), surface.to_vtk(), surface.to_meshio(), surface.to_trimesh(), grid.to_meshio(), isotet.Error)
print(grid.points.shape, grid.cells.dtype, grid.fields["sphere"].max(), grid.info, grid.first_view["field"], isotet.__version__)
print(surface.points + 1, surface.triangles.shape, surface.normals, surface.fields, surface.area)
cuts = [grid.slice("z", (0, 0, 0.25), fields=["sphere"]), grid.slice_sphere((0, 0, 0), 0.5),
        grid.slice_cylinder((0, 0, 0), "z", [0.5])]
print(grid.isovalues_at([10, 50], "sphere"), grid.volumes([0.5])["area"])
packed = isotet.pack(grid.points, grid.cells, values)
packed.set_field(values)
packed.set_points(2 * grid.points)
packed.save("grid.isotet", fields={"T": values})
print(packed.contour([0.1, 0.2], fields={"p": values}), isotet.open("grid.isotet", memory=10**9).contour(0.5, "p", step=3, fields=["T"]))
ball = grid.solid("sphere", below=0.6)
print(ball.solid, isotet.parts(surface)[0], surface.keep_parts(0), ball.keep_parts(ball.parts_touching("boundary", 1)))
print(ball.reduce(0.9), isotet.Solids(grid, "sphere").solid(above=0.5), isotet.solid(grid.points, grid.cells, values, below=0.5))
grid.clip("sphere", below=0.6).write("ball.vtu")
print(isotet.Clipper(grid, "sphere").clip(above=0.5), isotet.check(surface, grid=grid, field="sphere").sound)
piece = grid.piece(0, 1)
frame = isotet.make_frame([piece.survey("p")])
print(frame.range("p"), grid.without_cells([1, 0]), isotet.number_points([grid.points]))
picture = isotet.render([surface], volume=packed, volume_opacity=[(0, 0), (5, 0.3)], color_by="p", size=(800, 600), view=(30, 20))
isotet.html(grid, "Umag", color_by="p").save("artery.html")
print(picture.shape, isotet.read("artery.vtu", fields=["p"]), isotet.inspect("artery.vtu")["fields"], isotet.formats()[0])
isotet.Surface(surface.points, surface.triangles).write("x.ply")
grid.contour(0.5, normal="face")  # type: ignore[call-arg]
"""


def test_mypy(tmp_path):
    """A comment that ignores nothing is an error, too."""
    pytest.importorskip("mypy")
    (tmp_path / "typed.py").write_text(TYPED)
    (tmp_path / "mypy.ini").write_text("[mypy]\nstrict = True\n"
                                       "[mypy-pyvista.*,vtkmodules.*,meshio.*,trimesh.*,dask.*,trame.*,trame_pyvista.*]\nfollow_imports = skip\nignore_missing_imports = True\n")  # fmt: skip
    done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", tmp_path / "cache", "typed.py", *sorted(EXAMPLES.glob("*.py"))],
                          cwd=tmp_path, capture_output=True, text=True, timeout=250, check=False)  # fmt: skip
    assert done.returncode == 0, done.stdout


def test_pyright(tmp_path):
    """In basedpyright's build, which brings its own Node. Types of PyVista's plotting and Dask's client are not known to it."""
    pytest.importorskip("basedpyright")
    (tmp_path / "typed.py").write_text(TYPED)
    settings = {"typeCheckingMode": "strict", "reportMissingTypeStubs": False, "include": [str(tmp_path / "typed.py"), str(EXAMPLES)],
                "ignore": [str(EXAMPLES / "with_dask.py")]}  # fmt: skip
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [sys.executable, "-m", "basedpyright", "-p", tmp_path, "--pythonpath", sys.executable, "--outputjson"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=250, check=False)
    told = json.loads(done.stdout)
    assert told["summary"]["filesAnalyzed"] > 5
    wrong = [f"{one['file']}:{one['range']['start']['line'] + 1}: {one['message']}" for one in told["generalDiagnostics"]
             if one["file"].endswith("typed.py") or not one.get("rule", "").startswith("reportUnknown")]  # fmt: skip
    assert not wrong, "\n".join(wrong)
