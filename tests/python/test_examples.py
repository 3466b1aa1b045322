# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Every example runs, from any folder, and leaves what it says."""

import os
import subprocess
import sys

import pytest

import isotet
from conftest import TREE

FOLDER = TREE / "examples/python"
LEAVES = {
    "cfd_with_pyvista": ["artery.png", "slider.png"],
    "first_contour": ["surface.png", "surface.vtp"],
    "numpy_only": ["torus.ply"],
    "time_series": [f"wave_{step:02}.vtp" for step in range(40)],
    "with_dask": [],
}


def run(path, folder) -> str:
    done = subprocess.run([sys.executable, "-W", "error::DeprecationWarning", path], cwd=folder, capture_output=True, text=True,
                          timeout=250, check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_all_are_known():
    assert {path.stem for path in FOLDER.glob("*.py")} == {*LEAVES, "trame_slider"}


@pytest.mark.parametrize("name", LEAVES)
def test_runs(name, tmp_path):
    if name == "with_dask":
        pytest.importorskip("distributed")
    told = run(FOLDER / f"{name}.py", tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == LEAVES[name]
    assert all((tmp_path / file).stat().st_size > 1000 for file in LEAVES[name])
    if name == "numpy_only":
        assert "closed: True, handles: [1]" in told
    if name == "with_dask":
        assert "the same as those of the whole: True" in told
    if name == "time_series":
        assert "step 1: <isotet.Surface" in told and "new: field, clusters" in told
        assert isotet.read_surface(tmp_path / "wave_39.vtp").area > 1


def test_the_slider_of_trame_moves_the_surface(tmp_path):
    """The page is made, and its state changed as a browser does; it is not served."""
    pytest.importorskip("trame_pyvista")
    code = (
        "from trame.app import get_server\n"
        "import trame_slider\n"
        "server = get_server('test'); contour = trame_slider.make_app(server); server.state.ready()\n"
        "first = contour.GetOutput().GetNumberOfCells()\n"
        "server.state.isovalue = 0.3; server.state.flush()\n"
        "assert contour.GetValue(0) == 0.3 and 0 < contour.GetOutput().GetNumberOfCells() < first\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(FOLDER), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=250,
                          check=False)  # fmt: skip
    assert done.returncode == 0, done.stderr
