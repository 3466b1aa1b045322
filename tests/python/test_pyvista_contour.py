# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What PyVista's own tests ask of contour, asked of both: its calls, its outputs, its errors."""

import numpy as np
import pytest
import pyvista as pv

import isotet.pyvista  # noqa: F401 - the accessor, without an installation too


@pytest.fixture(params=["image", "hexahedra", "tets", "rectilinear", "structured"])
def mesh(request):
    image = pv.ImageData(dimensions=(10, 9, 8), spacing=(1.0, 1.0, 1.5))
    image["dist"] = np.linalg.norm(image.points - [4, 4, 5], axis=1)
    image["x"] = image.points[:, 0].astype(np.float32)
    image.cell_data["cell"] = np.arange(image.n_cells)
    image.set_active_scalars("dist")
    made = {"image": lambda: image, "hexahedra": image.cast_to_unstructured_grid, "rectilinear": image.cast_to_rectilinear_grid,
            "tets": lambda: image.cast_to_unstructured_grid().triangulate(), "structured": image.cast_to_structured_grid}[request.param]()
    made.set_active_scalars("dist", preference="point")
    return made


@pytest.fixture(params=["pyvista", "isotet"])
def contour(mesh, request):
    return mesh.contour if request.param == "pyvista" else mesh.isotet.contour


CALLS = [
    {},
    {"isosurfaces": 3},
    {"isosurfaces": 1, "rng": [3.0, 3.0]},
    {"isosurfaces": [2.5]},
    {"isosurfaces": (2.5, 3.5)},
    {"isosurfaces": np.array([2.5, 3.5])},
    {"isosurfaces": np.array([3], np.int32)},
    {"isosurfaces": 5, "rng": [1.0, 4.0]},
    {"isosurfaces": 5, "rng": np.array([1, 4])},
    {"isosurfaces": [4.3], "scalars": "x"},
    {"isosurfaces": [2.5], "compute_normals": True},
    {"isosurfaces": [2.5], "compute_gradients": True},
    {"isosurfaces": [2.5], "compute_scalars": False},
    {"isosurfaces": [2.5], "method": "contour", "progress_bar": False},
    {"isosurfaces": [2.5], "preference": "point"},
    {"isosurfaces": []},
    {"isosurfaces": [1000.0]},
]


def levels(surface, name):
    return set(np.round(np.float32(surface.point_data[name]), 4).tolist())


@pytest.mark.parametrize("how", CALLS, ids=str)
def test_calls_give_what_pyvista_gives(mesh, how):
    ours, theirs = mesh.isotet.contour(**how), mesh.contour(**how)
    assert isinstance(ours, pv.PolyData)
    assert (ours.n_cells == 0) == (theirs.n_cells == 0)
    assert ours.area == pytest.approx(theirs.area, rel=0.02)
    if not ours.n_cells:
        return
    if "Gradients" in theirs.point_data:  # of images and the like
        del theirs.point_data["Gradients"]
    assert set(ours.point_data) - {"Normals"} == set(theirs.point_data) - {"Normals"}
    assert ("Normals" in ours.point_data) == how.get("compute_normals", False)
    count = how.get("isosurfaces", 10)
    several = (count if isinstance(count, int) else len(count)) > 1
    assert ("isovalue" in ours.cell_data) == several, "the only array that PyVista's has not"
    assert {name: ours.cell_data[name].dtype for name in ours.cell_data if name != "isovalue"} == {
        name: theirs.cell_data[name].dtype for name in theirs.cell_data}  # fmt: skip
    is_image = isinstance(mesh, (pv.ImageData, pv.RectilinearGrid))  # whose origin and spacing are of double precision
    assert ours.points.dtype == (np.float64 if is_image else theirs.points.dtype)
    assert ours.is_all_triangles
    if not any(how is call for call in CALLS[:2]):  # at the ends of the range VTK has points without area
        assert np.allclose(ours.bounds, theirs.bounds, atol=0.05)
    if how.get("compute_scalars", True):
        name = how.get("scalars", "dist")
        assert levels(ours, name) <= levels(theirs, name)
        assert ours.active_scalars_name == mesh.active_scalars_name


@pytest.mark.parametrize(
    ("kind", "how"),
    [
        (TypeError, {"isosurfaces": pv.PolyData()}),
        (TypeError, {"isosurfaces": None}),
        (TypeError, {"isosurfaces": "3"}),
        (TypeError, {"rng": {}}),
        (ValueError, {"rng": [1]}),
        (ValueError, {"rng": [2, 1]}),
        (TypeError, {"scalars": "cell"}),
        (TypeError, {"scalars": 2}),
        ((TypeError, KeyError), {"scalars": "nope"}),
        (ValueError, {"method": "nope"}),
    ],
    ids=str,
)
def test_errors_are_of_pyvistas_types(contour, kind, how):
    with pytest.raises(kind):
        contour(**how)


def test_a_mesh_without_arrays_is_refused(mesh, contour):
    mesh.clear_data()
    with pytest.raises(Exception, match="No data|must have scalar"):  # noqa: B017, PT011 - PyVista has several
        contour()


def test_values_are_stored_as_contour_data(mesh):
    values = np.array(mesh["x"]) * 2
    ours = mesh.isotet.contour([9.0], values)
    assert "Contour Data" in mesh.point_data and np.unique(ours["Contour Data"]).tolist() == [9.0]


def test_the_mesh_stays_as_it_is(mesh):
    before = mesh.copy()
    mesh.isotet.contour([2.5], "dist", compute_normals=True)
    assert mesh == before and mesh.active_scalars_name == "dist"


def test_a_scalar_that_is_missing_is_both_errors(mesh):
    with pytest.raises(TypeError, match="there is no array 'nope': the mesh has"):
        mesh.isotet.contour(scalars="nope")
    with pytest.raises(KeyError):
        mesh.isotet.contour(scalars="nope")
