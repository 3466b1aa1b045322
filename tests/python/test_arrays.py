# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What goes in: shapes, types, orders, masks; without a copy where the library takes an array as it is."""

from fractions import Fraction

import meshio
import numpy as np
import pytest

import isotet
from conftest import same

NUMBERS = [np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64, np.float32, np.float64]


@pytest.mark.parametrize("dtype", NUMBERS)
def test_values_of_every_type_give_the_surface(tet, dtype):
    points, cells, values = tet
    surface = isotet.contour(points, cells, (4 * values).astype(dtype), 1)
    assert surface.points.tolist() == [[0.25, 0, 0], [0, 0.25, 0], [0, 0, 0.25]]


@pytest.mark.parametrize("dtype", [np.float16, np.bool_, ">f4", ">f8", ">i4", np.dtype("<f8")])
def test_other_numbers_are_converted(tet, dtype):
    points, cells, values = tet
    assert isotet.contour(points, cells, values.astype(dtype), 0.25).points[0].tolist() == [0.25, 0, 0]


@pytest.mark.parametrize("dtype", [np.complex64, np.longdouble, "U3", object, "M8[s]"])
def test_what_is_no_number_is_a_type_error(tet, dtype):
    points, cells, values = tet
    with pytest.raises(TypeError, match="values|field"):
        isotet.contour(points, cells, values.astype(dtype), 0.25)


@pytest.mark.parametrize("dtype", [np.int8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64, ">i8"])
def test_cells_of_every_integer(tet, dtype):
    points, cells, values = tet
    assert len(isotet.contour(points, cells.astype(dtype), values, 0.5).triangles) == 1


def test_cells_of_floats_are_a_type_error(tet):
    points, cells, values = tet
    with pytest.raises(TypeError, match="cells has type float64, but must have integers"):
        isotet.contour(points, cells.astype(float), values, 0.5)


def test_lists_and_tuples_are_arrays():
    surface = isotet.contour(((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)), [(0, 1, 2, 3)], (0, 1, 1, 1), 0.5)
    assert surface.points.dtype == np.float64
    assert len(surface.triangles) == 1


def test_points_keep_their_precision(tet):
    points, cells, values = tet
    assert isotet.contour(points, cells, values, 0.5).points.dtype == np.float32
    assert isotet.contour(points.astype(np.float64), cells, values, 0.5).points.dtype == np.float64


def test_order_and_strides_do_not_matter(sphere):
    points, cells, values = sphere.points, sphere.cells, sphere.fields["sphere"]
    wanted = isotet.contour(points, cells, values, 0.5)
    doubled = np.zeros((len(values), 2), values.dtype)
    doubled[:, 1] = values
    wide = np.zeros((len(points), 5), points.dtype)
    wide[:, 1:4] = points
    variants = [
        (np.asfortranarray(points), cells, values),
        (wide[:, 1:4], np.asfortranarray(cells), doubled[:, 1]),
        (points[::-1][::-1], cells, values[::-1][::-1]),
        (points, cells, values.reshape(-1, 1)),
    ]
    for variant in variants:
        assert same(isotet.contour(*variant, 0.5), wanted)


def test_read_only_arrays_go_in(tet):
    for array in tet:
        array.setflags(write=False)
    assert len(isotet.contour(*tet, 0.5).triangles) == 1


def test_no_copy_of_what_the_library_takes_as_it_is(tet):
    points, cells, values = tet
    fields = {"v": values, "p": points}
    grid = isotet.Grid(points, cells, fields=fields, cell_fields={"number": np.zeros(1)})
    assert np.shares_memory(grid.points, points)
    assert np.shares_memory(grid.cells, cells)
    assert np.shares_memory(grid.fields["v"], values)
    assert np.shares_memory(grid.fields["p"], points)
    assert not grid.points.flags.writeable
    big = isotet.Grid(points.astype(">f4"), cells)
    assert big.points.tolist() == points.tolist()


def test_masked_values_are_no_data(sphere):
    values = np.ma.MaskedArray(sphere.fields["sphere"], mask=False)
    wanted = isotet.contour(sphere.points, sphere.cells, values.data, 0.5)
    assert same(isotet.contour(sphere.points, sphere.cells, values, 0.5), wanted)
    values[sphere.points[:, 0] < 0] = np.ma.masked
    holed = np.where(values.mask, np.float32(np.nan), values.data)
    half = isotet.contour(sphere.points, sphere.cells, values, 0.5)
    assert 0 < len(half.triangles) < len(wanted.triangles)
    assert same(half, isotet.contour(sphere.points, sphere.cells, holed, 0.5))
    integers = np.ma.MaskedArray([0, 1, 1, 1], mask=[False, False, False, True])
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert len(isotet.contour(points, [[0, 1, 2, 3]], integers, 0.5).triangles) == 0
    with pytest.raises(ValueError, match="points is a masked array"):
        isotet.contour(np.ma.masked_less(sphere.points, 0), sphere.cells, values, 0.5)
    with pytest.raises(ValueError, match="cells is a masked array"):
        isotet.contour(sphere.points, np.ma.masked_less(sphere.cells, 1), values, 0.5)


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"points": np.zeros((4, 2))}, r"points has shape \(4, 2\), but must have shape \(N, 3\)"),
        ({"points": np.zeros(12)}, r"points has shape \(12,\)"),
        ({"cells": np.zeros((1, 3), int)}, r"cells has shape \(1, 3\), but without offsets and types must have"),
        ({"cells": np.zeros(4, int)}, r"cells has shape \(4,\)"),
        ({"values": np.zeros((4, 3))}, r"field has shape \(4, 3\), but one value a point is contoured"),
        ({"values": np.zeros((1, 2, 2))}, r"must have one or two dimensions"),
        ({"values": np.zeros(3)}, r"field 'values' has 3 values of 1 components, but the grid has 4 points"),
        ({"cells": [[0, 1, 2, 9]]}, r"tets\[0\] has point 9, but the grid has 4 points"),
        ({"cells": [[0, 1, 2, -1]]}, r"tets\[0\] has point"),
        ({"isovalues": np.nan}, "isovalue"),
        ({"normals": "smooth"}, "normals is 'smooth', but must be one of: none, gradient, face"),
        ({"ties": "both"}, "ties is 'both'"),
        ({"precision": "half"}, "precision is 'half'"),
        ({"method": "fast"}, "method is 'fast'"),
        ({"offsets": [0, 4]}, "cells need offsets and types, or neither of them"),
        ({"fields": {"t": np.zeros(5)}}, "'t'"),
        ({"cell_fields": {"t": np.zeros(5)}}, "'t'"),
        ({"fields": {"t": np.zeros((4, 0))}}, r"fields\['t'\] has shape \(4, 0\), but must have at least one component"),
        ({"cell_fields": {"t": np.zeros((1, 0))}}, r"cell_fields\['t'\] has shape \(1, 0\)"),
        ({"values": np.zeros((4, 0))}, "at least one component"),
    ],
)
def test_what_is_wrong_is_said(tet, what, message):
    points, cells, values = tet
    given = {"points": points, "cells": cells, "values": values, "isovalues": 0.5} | what
    with pytest.raises(ValueError, match=message):
        isotet.contour(**given)


def test_fields_must_be_a_mapping(tet):
    with pytest.raises(TypeError, match="fields is a ndarray, but must be names, or map names to arrays"):
        isotet.contour(*tet, 0.5, fields=np.zeros(4))


def test_one_array_for_each_kind_of_cell():
    for shape, corners in (("kuhn", 4), ("hex", 8), ("wedge", 6)):
        grid = isotet.make(shape, 4, ["sphere"])
        assert grid.cells.shape == (len(grid), corners)
        assert same(isotet.contour(grid.points, np.array(grid.cells), grid.fields["sphere"], 0.5),
                    grid.contour(0.5, fields=[]))  # fmt: skip


def test_cells_as_vtk_has_them():
    grid = isotet.make("mixed", 4, ["sphere"])
    again = isotet.Grid(grid.points, grid.cells, offsets=grid.offsets, types=grid.types, fields=grid.fields)
    assert set(np.unique(grid.types)) == {10, 12, 13, 14}
    assert same(again.contour(0.5), grid.contour(0.5))
    with pytest.raises(ValueError, match="types has the values 10 to 999"):
        isotet.Grid(grid.points, grid.cells, offsets=grid.offsets, types=np.array([10, 999]))


def test_cells_as_meshio_has_them(tet):
    points, cells, values = tet
    wanted = isotet.contour(points, cells, values, 0.5)
    assert same(isotet.contour(points, {"tetra": cells}, values, 0.5), wanted)
    assert np.shares_memory(isotet.Grid(points, {"tetra": cells}).cells, cells), "one kind of cell is not copied"
    assert same(isotet.contour(points, [("tetra", cells)], values, 0.5), wanted)
    with_faces = {"triangle": [[0, 1, 2]], "tetra": cells, "vertex": [[0]], "line12": [[0, 1]]}
    surface = isotet.contour(points, with_faces, values, 0.5, source_cells=True)
    assert surface.source_cells.tolist() == [1], "cells are counted in the order of the blocks"


def test_meshio_meshes(tree):
    mesh = meshio.read(tree / "data/msh/inclusions_v41_ascii.msh")
    x = mesh.points[:, 0]
    level = float((x.min() + x.max()) / 2) + 1e-3
    by_dict = isotet.contour(mesh.points, mesh.cells_dict, x, level)
    assert len(by_dict.triangles) > 0
    by_blocks = isotet.contour(mesh.points, mesh.cells, x, level)
    assert by_blocks.area == pytest.approx(by_dict.area)


def test_an_empty_surface_has_arrays(tet):
    surface = isotet.contour(*tet, 5)
    assert surface.points.shape == (0, 3)
    assert surface.triangles.shape == (0, 3)
    assert surface.area == 0
    points, cells, values = tet
    surface = isotet.contour(points.astype(float), cells, values, 5, normals="gradient", edge_ends=True, source_cells=True,
                             fields={"v": values, "p": points}, cell_fields={"n": np.array([7])})  # fmt: skip
    assert surface.points.dtype == np.float64
    assert surface.normals.shape == (0, 3)
    assert surface.edge_ends.shape == (0, 2)
    assert surface.edge_weights.shape == surface.source_cells.shape == (0,)
    assert surface.fields["p"].shape == (0, 3)
    assert surface.cell_fields["n"].dtype == np.int64
    assert len(surface.to_pyvista().point_data) == 3


def test_isovalues_of_every_kind(tet):
    one = isotet.contour(*tet, 0.5)
    for isovalue in (np.float32(0.5), np.array(0.5), [0.5], (0.5,), np.array([0.5])):
        assert same(isotet.contour(*tet, isovalue), one)
    two = isotet.contour(*tet, range(1, 3))
    assert two.cell_fields["isovalue"].tolist() == [1.0] or len(two.triangles) == 0
    many = isotet.contour(*tet, [0.25, 0.5])
    assert many.cell_fields["isovalue"].tolist() == [0.25, 0.5]
    assert len(isotet.contour(*tet, []).triangles) == 0


@pytest.mark.parametrize("isovalue", ["0.5", None, True, [True, False], ["a"], [0.5, None], [[1], [1, 2]], 1j, {}])
def test_what_is_no_isovalue_is_a_type_error(tet, isovalue):
    with pytest.raises(TypeError, match="isovalues is .*, but must be a number, or several"):
        isotet.contour(*tet, isovalue)


def test_isovalues_beyond_float64_are_a_value_error(tet):
    with pytest.raises(ValueError, match="beyond the range of float64"):
        isotet.contour(*tet, 10**400)
    assert len(isotet.contour(*tet, [10**30, Fraction(1, 2)]).triangles) == 1


@pytest.mark.parametrize(
    ("error", "message", "how"),
    [
        (TypeError, "normals is True, but must be text", {"normals": True}),
        (TypeError, "ties is 1, but must be text", {"ties": 1}),
        (TypeError, "precision is <class .*, but must be text", {"precision": np.float64}),
        (ValueError, "threads is -1, but must be 0, for all, or a number of threads", {"threads": -1}),
        (TypeError, "threads is 'two', but must be an integer", {"threads": "two"}),
    ],
)
def test_wrong_options_are_said_in_a_sentence(tet, error, message, how):
    with pytest.raises(error, match=message):
        isotet.contour(*tet, 0.5, **how)
    with pytest.raises(error, match=message):
        isotet.Grid(*tet[:2], fields={"v": tet[2]}).contour(0.5, **how)


def test_wrong_cells_are_said(tet):
    points, cells, values = tet
    with pytest.raises(TypeError, match="cells has type bool, but must have integers"):
        isotet.contour(points, cells.astype(bool), values, 0.5)
    with pytest.raises(ValueError, match="cells has the number 9223372036854775808, but numbers must be below 2"):
        isotet.contour(points, np.array([[0, 1, 2, 2**63]], np.uint64), values, 0.5)


def test_tables_are_arrays(tet):
    class Table:  # as of pandas: an array that has items, too
        def __init__(self, array):
            self._array = array

        def __array__(self, dtype=None, copy=None):
            return self._array

        def items(self):
            return [(str(i), column) for i, column in enumerate(self._array.T)]

        def __bool__(self):
            raise ValueError("The truth value is ambiguous")

    points, cells, values = tet
    surface = isotet.contour(Table(points), Table(cells), values, 0.5, fields=Table(points))
    assert same(surface, isotet.contour(points, cells, values, 0.5, fields={"0": points[:, 0], "1": points[:, 1], "2": points[:, 2]}))


def test_checking_against_a_grid_says_what_the_surface_lacks(sphere):
    with pytest.raises(ValueError, match="contour it with edge_ends=True"):
        isotet.check(sphere.contour(0.5, "sphere"), grid=sphere)
    assert isotet.check(sphere.contour(0.5, "sphere", edge_ends=True), grid=sphere).sound
    for isovalue in (99, []):
        assert isotet.check(sphere.contour(isovalue, "sphere"), grid=sphere).sound


def test_components_are_a_vector(tet):
    points, cells, values = tet
    grid = isotet.Grid(points, cells, fields={"VelocityX": 2 * values, "VelocityY": 3 * values, "VelocityZ": 6 * values})
    assert np.array_equal(grid.contour(3.5, "Velocity:mag").points, isotet.contour(points, cells, values, 0.5).points)
    assert np.array_equal(grid.contour(3.5, "mag(Velocity)").points, isotet.contour(points, cells, values, 0.5).points)
    with pytest.raises(ValueError, match="3 components"):
        grid.contour(1, "Velocity")


def test_without_a_name_the_field_that_is_shown_first_is_taken(tet):
    points, cells, values = tet
    grid = isotet.Grid(points, cells, fields={"ids": values + np.arange(4), "foo": 7 * values + 0.1, "T": values})
    assert grid.first_view == {"field": "T", "draw": "isosurfaces", "cell_field": False, "why": "its name"}
    assert np.array_equal(grid.contour(0.5).points, isotet.contour(points, cells, values, 0.5).points)
    assert isotet.Grid(points, cells).first_view["field"] is None


def test_a_field_that_the_file_marks_comes_first(tet, tmp_path):
    points, cells, values = tet
    path = tmp_path / "a.vtu"
    grid = isotet.Grid(points, cells, fields={"T": values, "foo": 0.5 * values})
    grid.write(path)
    text = path.read_bytes().replace(b"<PointData>", b'<PointData Scalars="foo">')
    assert b'Scalars="foo"' in text
    path.write_bytes(text)
    assert isotet.read(path).first_view["field"] == "foo"
