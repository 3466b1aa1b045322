# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What comes out."""

import copy
import pickle
import sys
import threading

import numpy as np
import pytest
import pyvista

import isotet
from conftest import same


def test_methods_give_the_same_surface_in_another_order(sphere):
    direct, packed = (sphere.contour(0.5, "sphere", method=method) for method in ("direct", "clusters"))
    assert (direct.method, packed.method) == ("direct", "clusters")
    assert sorted(map(tuple, direct.points.tolist())) == sorted(map(tuple, packed.points.tolist()))
    assert same(packed, isotet.pack(sphere, values="sphere").contour(0.5, fields=sphere.fields))


def test_everything_that_can_be_asked_for(sphere):
    cells = np.arange(len(sphere))
    surface = sphere.contour(0.5, "sphere", normals="gradient", fields={"gyroid": sphere.fields["gyroid"], "p": sphere.points},
                             cell_fields={"number": cells}, edge_ends=True, source_cells=True)  # fmt: skip
    vertices, triangles = len(surface.points), len(surface.triangles)
    assert surface.normals.shape == (vertices, 3)
    assert surface.normals_kind == "gradient"
    assert np.allclose(np.linalg.norm(surface.normals, axis=1), 1, atol=1e-6)
    assert np.einsum("ij,ij->i", surface.normals, surface.points).min() > 0, "towards higher values"
    assert surface.edge_ends.shape == (vertices, 2)
    assert surface.edge_ends.dtype == np.int64
    assert surface.edge_weights.shape == (vertices,)
    assert surface.source_cells.shape == (triangles,)
    assert np.array_equal(surface.cell_fields["number"], surface.source_cells)
    assert np.allclose(surface.fields["p"], surface.points, atol=1e-6)
    assert set(surface.fields) == {"gyroid", "p"}
    faces = sphere.contour(0.5, "sphere", normals="face", fields=[])
    assert faces.normals.shape == (triangles, 3)
    assert faces.fields == {}
    assert faces.normals_kind == "face"


def test_normals_of_vertices_follow_the_surface(sphere):
    surface = sphere.contour(0.5, "sphere", normals="vertex")
    outward = surface.points / np.linalg.norm(surface.points, axis=1)[:, None]
    assert (np.einsum("ij,ij->i", surface.normals, outward) > 0.8).all()


@pytest.mark.parametrize("kind", ["none", "gradient", "vertex", "face"])
def test_every_kind_of_normals_goes_where_it_belongs(sphere, kind):
    surface = sphere.contour(0.5, "sphere", normals=kind)
    assert surface.normals_kind == kind
    of_points = {"gradient": True, "vertex": True}.get(kind, False)
    for mesh in (pyvista.wrap(surface.to_vtk()), surface.to_pyvista()):
        assert ("Normals" in mesh.point_data) == of_points
        assert ("Normals" in mesh.cell_data) == (kind == "face")
        data = mesh.point_data if of_points else mesh.cell_data
        assert kind == "none" or np.array_equal(data["Normals"], surface.normals)
        assert [len(array) for array in data.values()] == [mesh.n_points if of_points else mesh.n_cells] * len(data)
    mesh = surface.to_trimesh()
    assert of_points == np.array_equal(mesh.vertex_normals, surface.normals)
    assert kind != "face" or np.allclose(mesh.face_normals, surface.normals, atol=1e-5)
    assert surface._has_vertex_normals == of_points


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("shape", ["kuhn", "hex", "kelvin", "tet10"])
@pytest.mark.parametrize("middle", [0.0, 0.5])
def test_the_type_of_points_follows_from_that_of_the_grid_alone(dtype, shape, middle):
    made = isotet.make(shape, 4, ["sphere"])
    points = np.array(made.points, dtype)
    grid = isotet.Grid(points - (points.min(axis=0) + points.max(axis=0)) / 2 + dtype(middle), made.cells, offsets=made.offsets,
                       types=made.types, faces=made.faces, face_offsets=made.face_offsets, fields=made.fields)  # fmt: skip
    for how in ({"method": "direct"}, {"method": "clusters"}, {"method": "clusters", "split_cells": True}):
        for isovalues in (0.5, [0.5, 0.6], 99.0, []):
            assert grid.contour(isovalues, **how).points.dtype == dtype, (how, isovalues)
    assert grid.contour(0.5, precision="float64").points.dtype == np.float64
    if shape not in ("kuhn", "hex"):
        return
    packed = grid.pack()
    assert packed.contour(0.5).points.dtype == dtype
    other = np.float64 if dtype == np.float32 else np.float32
    packed.set_points(grid.points.astype(other))
    assert packed.contour(0.5).points.dtype == other


def test_no_isovalues_give_a_surface_without_triangles(sphere):
    how = {"fields": {"p": sphere.points}, "cell_fields": {"n": np.arange(len(sphere))}, "normals": "gradient",
           "edge_ends": True, "source_cells": True}  # fmt: skip
    session = isotet.Contour(sphere, "sphere", **how)
    for surface in (sphere.contour([], "sphere", **how), session.contour([]), session.contour(np.empty(0))):
        assert surface.points.shape == (0, 3) and surface.triangles.shape == (0, 3) and surface.normals.shape == (0, 3)
        assert surface.edge_ends.shape == (0, 2) and surface.source_cells.shape == (0,)
        assert surface.fields["p"].shape == (0, 3)
        assert {name: values.shape for name, values in surface.cell_fields.items()} == {"n": (0,), "isovalue": (0,)}
        assert surface.to_pyvista().n_cells == 0 and surface.area == 0
    packed = isotet.pack(sphere, values="sphere").contour([])
    assert packed.points.shape == packed.triangles.shape == (0, 3)
    assert isotet.contour(sphere.points, sphere.cells, sphere.fields["sphere"], []).to_vtk().GetNumberOfPoints() == 0


def test_fields_are_named_or_given(sphere):
    assert list(sphere.contour(0.5, "sphere").fields) == ["sphere", "gyroid"]
    assert list(sphere.contour(0.5, "sphere", fields=["gyroid"]).fields) == ["gyroid"]
    computed = sphere.contour(0.5, "sphere", fields=["gyroid * 2", "mag(grad(sphere))"])
    assert list(computed.fields) == ["gyroid * 2", "mag(grad(sphere))"]
    assert np.array_equal(computed.fields["gyroid * 2"], 2 * sphere.contour(0.5, "sphere").fields["gyroid"])
    with pytest.raises(ValueError, match="no field 'nothing'"):
        sphere.contour(0.5, "sphere", fields=["nothing + 1"])
    with pytest.raises(ValueError, match="fields has no 'pressure': there are sphere, gyroid"):
        sphere.contour(0.5, "sphere", fields=["pressure"])
    with pytest.raises(ValueError, match="sphere"):
        sphere.contour(0.5, "spere")
    unnamed, named = sphere.contour(0.5), sphere.contour(0.5, sphere.first_view["field"])
    assert np.array_equal(unnamed.points, named.points)


def test_components_and_cell_fields_are_contoured(sphere):
    grid = isotet.Grid(sphere.points, sphere.cells, fields={"v": sphere.points}, cell_fields={"one": np.ones(len(sphere))})
    x = grid.contour(0.1, "v:x", fields=[])
    assert np.allclose(x.points[:, 0], 0.1, atol=1e-6)
    assert len(grid.contour(1.5, "one").triangles) == 0


def test_packed_grids_say_what_was_not_packed(sphere):
    packed = isotet.pack(sphere, values="sphere")
    for asked in ({"normals": "gradient"}, {"source_cells": True}, {"cell_fields": {"n": np.arange(len(sphere))}}):
        with pytest.raises(ValueError, match="pack"):
            packed.contour(0.5, **asked)
    packed = isotet.pack(sphere, values="sphere", gradients=True, source_cells=True)
    assert packed.contour(0.5, normals="gradient", source_cells=True).normals is not None


def clipped_ball() -> isotet.Grid:
    """Tetrahedra, wedges, hexahedra and polyhedra."""
    return isotet.make("hex", 6, ["sphere", "plane"]).clip("sphere", below=0.7)


@pytest.mark.parametrize("grid", [clipped_ball(), isotet.make("kelvin", 4, ["sphere", "plane"]), isotet.make("tet10", 4, ["sphere", "plane"])])
def test_polyhedra_and_quadratic_cells_are_packed_as_linear_cells(grid, tmp_path):
    numbers = np.arange(len(grid))
    packed = grid.pack("sphere", source_cells=True)
    assert len(packed) == len(grid)
    how = {"fields": {"plane": grid.fields["plane"]}, "cell_fields": {"number": numbers}, "source_cells": True}
    for level in (0.4, 0.6):
        wanted = grid.contour(level, "sphere", **how)
        for some in (packed, copy.copy(packed), pickle.loads(pickle.dumps(packed))):
            got = some.contour(level, **how)
            assert got.area == pytest.approx(wanted.area, rel=1e-5) and len(got.triangles) == len(wanted.triangles)
            assert isotet.check(got).boundary_edges == isotet.check(wanted).boundary_edges
            assert np.array_equal(got.cell_fields["number"], got.source_cells)
            assert sorted(got.source_cells) == sorted(wanted.source_cells)
            assert np.sort(got.fields["plane"]) == pytest.approx(np.sort(wanted.fields["plane"]), abs=1e-5)
    for some in (packed, pickle.loads(pickle.dumps(packed))):
        some.set_field(grid.fields["plane"], name="plane")
        assert some.contour(0.1).area == pytest.approx(grid.contour(0.1, "plane").area, rel=1e-5)
        some.set_points(2 * np.asarray(grid.points))
        assert some.contour(0.1).area == pytest.approx(4 * grid.contour(0.1, "plane").area, rel=1e-5)
    with pytest.raises(ValueError, match="field 'values' has|the array has 3 tuples"):
        packed.set_field(np.zeros(3))
    with pytest.raises(ValueError, match="source cells of polyhedra and quadratic cells are not kept"):
        packed.save(tmp_path / "grid.isotet")
    grid.pack("sphere").save(tmp_path / "grid.isotet", fields={"plane": grid.fields["plane"]})
    file = isotet.open(tmp_path / "grid.isotet")
    for name in ("sphere", "plane"):
        assert file.contour(0.45, name).area == pytest.approx(grid.contour(0.45, name).area, rel=1e-5)


def test_other_cells_are_cut_as_they_are_or_split():
    grid = isotet.make("hex", 6, ["sphere"])
    whole, split = isotet.pack(grid, values="sphere"), isotet.pack(grid, values="sphere", split_cells=True)
    assert whole.report["hexahedra"] == 216 and whole.report["tets"] == 0
    assert split.report["hexahedra"] == 0 and split.report["tets"] > 1000
    assert 2 * len(whole.contour(0.5).triangles) < len(split.contour(0.5).triangles)
    for method in ("direct", "clusters"):
        once = [grid.contour(0.5, "sphere", split_cells=split_cells, method=method) for split_cells in (False, True)]
        session = isotet.Contour(grid, "sphere", split_cells=True, method=method)
        assert len(once[1].triangles) > 2 * len(once[0].triangles)
        assert same(session.contour(0.5), once[1])


def test_packed_grids_take_fields_and_points(sphere):
    packed = isotet.pack(sphere.points, sphere.cells, sphere.fields["sphere"])
    before = packed.contour(0.5)
    packed.set_field(sphere.fields["gyroid"], name="gyroid")
    assert same(packed.contour(0.5), isotet.pack(sphere, values="gyroid").contour(0.5))
    assert packed.field_report["name"] == "gyroid"
    packed.set_field(sphere.fields["sphere"])
    packed.set_points(2 * sphere.points)
    assert packed.contour(0.5).area == pytest.approx(4 * before.area)
    with pytest.raises(ValueError, match="values"):
        packed.set_field(np.zeros(3))
    with pytest.raises(ValueError):
        packed.set_points(-sphere.points)
    assert packed.contour(0.5).area == pytest.approx(4 * before.area), "as it was"
    lower, upper = packed.range
    assert (lower, upper) == (sphere.fields["sphere"].min(), sphere.fields["sphere"].max())
    assert packed.report["tets"] == len(packed) == len(sphere)
    assert 0 < packed.nbytes < 100 * len(sphere)
    with pytest.raises(TypeError, match=r"isotet.pack\(\)"):
        isotet.PackedGrid()


def test_grids_pack_themselves():
    grid = isotet.make("kuhn", 6, ["sphere", "gyroid"])
    packed = grid.pack("gyroid", source_cells=True)
    assert np.array_equal(packed.contour(0.1).points, isotet.pack(grid, values="gyroid").contour(0.1).points)
    assert packed.contour(0.1, source_cells=True).source_cells is not None


@pytest.mark.parametrize("shape", ["kuhn", "hex", "kelvin"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_sessions_see_what_was_changed_in_place_in_the_same_grid(shape, dtype):
    made = isotet.make(shape, 5, ["sphere"])
    points, cells, values = np.array(made.points, dtype), np.array(made.cells), np.array(made.fields["sphere"], dtype)
    carried = np.arange(len(points), dtype=float)
    grid = isotet.Grid(points, cells, offsets=made.offsets, types=made.types, faces=made.faces, face_offsets=made.face_offsets,
                       fields={"f": values, "p": carried})  # fmt: skip
    session = isotet.Contour(grid, "f", surfaces=100)
    session.prepare()

    def differs(expected, field="f", **how):
        assert session.set(grid, field, **how) == expected
        wanted = grid.contour(0.5, field, method="clusters", **how)
        assert same(session.contour(0.5), wanted)

    differs("nothing")
    values *= 2
    differs("field")
    values[0] = -1
    carried += 1
    differs("field")
    points *= 2
    differs("points")
    points += dtype(1)
    differs("points", values, fields=["p"])
    differs("nothing", values, fields=["p"])
    if made.faces is None:
        cells[:10] = cells[10]
        differs("grid")


def test_sessions_extract_while_another_thread_packs(sphere):
    session = isotet.Contour(sphere, "sphere", fields=[], extract_while_packing=True)
    meanwhile = []

    def extract():
        meanwhile.append(session.contour(0.5))

    def told(step, fraction):
        if not meanwhile:
            thread = threading.Thread(target=extract)
            thread.start()
            thread.join()

    session.prepare(progress=told)
    assert meanwhile[0].method == "direct" and same(meanwhile[0], sphere.contour(0.5, "sphere", fields=[], method="direct"))
    packed = session.contour(0.5)
    assert packed.method == "clusters" and same(packed, sphere.contour(0.5, "sphere", fields=[], method="clusters"))


def test_sessions_find_out_what_is_the_same(sphere):
    session = isotet.Contour(sphere, "sphere", surfaces=100, fields=[])
    assert session.method == "clusters"
    session.prepare()
    first = session.contour(0.5)
    assert session.range == (sphere.fields["sphere"].min(), sphere.fields["sphere"].max())
    assert session.set(sphere, "sphere", fields=[]) in ("nothing", "field")
    assert same(session.contour(0.5), first)
    elsewhere = isotet.Grid(np.array(sphere.points), np.array(sphere.cells))
    assert session.set(elsewhere, np.array(sphere.fields["gyroid"])) == "field"
    moved = np.array(sphere.points)
    grid = isotet.Grid(moved, sphere.cells)
    assert session.set(grid, sphere.fields["sphere"]) == "field"
    session.contour(0.5)
    moved *= 2  # in place, behind the session's back
    assert session.set(isotet.Grid(moved, sphere.cells), sphere.fields["sphere"]) == "points"
    assert session.contour(0.5).area == pytest.approx(4 * first.area)
    assert session.set(isotet.make("kuhn", 5, ["sphere"]), "sphere") == "grid"
    with pytest.raises(ValueError):
        session.set(sphere, np.zeros(3))


def test_arrays_are_read_only_and_copies_are_not(sphere):
    surface = sphere.contour(0.5, "sphere")
    for array in (surface.points, surface.triangles, surface.fields["sphere"]):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    mine = surface.points.copy()
    mine[0] = 7


def test_area_and_check(sphere):
    surface = sphere.contour(0.5, "sphere", edge_ends=True)
    report = isotet.check(surface, closed=True)
    assert report.sound and report["sound"] and report.closed
    assert report.area == surface.area == pytest.approx(4 * np.pi * 0.25, rel=0.2)
    assert report.euler == 2
    assert report.genus == [0]
    open_one = sphere.contour(1.2, "sphere", edge_ends=True)
    assert not isotet.check(open_one, closed=True, max_findings=2).sound
    assert 1 <= len(isotet.check(open_one, closed=True, max_findings=2).findings) <= 4
    assert isotet.check(open_one, grid=sphere, field="sphere").sound
    with pytest.raises(AttributeError):
        report.beauty  # noqa: B018
    with pytest.raises(ValueError, match="vert"):
        isotet.check(isotet.Surface([[0, 0, 0]], [[0, 0, 5]]))


@pytest.mark.parametrize("ending", ["vtp", "ply", "stl", "obj", "vtk", "ts"])
def test_written_surfaces_are_read_back(sphere, tmp_path, ending):
    surface = sphere.contour([0.4, 0.5], "sphere")
    path = tmp_path / f"surface.{ending}"
    assert isinstance(surface.write(path), list)
    if path.suffix == ".vtp":
        size = path.stat().st_size
        surface.write(path, compression="zlib")
        assert path.stat().st_size < size
    else:
        with pytest.raises(ValueError, match="has none"):
            surface.write(path, compression="lz4")
    again = isotet.read_surface(str(path))
    assert len(again.triangles) == len(surface.triangles)
    assert again.area == pytest.approx(surface.area)
    if ending == "vtp":
        assert same(again, surface)


def test_grids_are_written_and_read(tmp_path):
    grid = isotet.make("mixed", 3, ["sphere", "integer"])
    grid.write(tmp_path / "grid.vtu")
    again = isotet.read(tmp_path / "grid.vtu", fields=["sphere"])
    assert list(again.fields) == ["sphere"]
    assert same(again.contour(0.5), grid.contour(0.5, "sphere", fields=["sphere"]))
    assert again.info["fields"] == {"sphere": ("float32", 1), "integer": ("int32", 1)}
    assert isotet.inspect(tmp_path / "grid.vtu")["format"] == "vtu"
    assert again.info["times"] == []


def test_grids_are_written_compressed(tmp_path):
    grid = isotet.make("kuhn", 8, ["integer"])
    sizes = []
    for compression in ("none", "zlib", "lz4"):
        grid.write(tmp_path / "grid.vtu", compression=compression)
        sizes.append((tmp_path / "grid.vtu").stat().st_size)
        assert (isotet.read(tmp_path / "grid.vtu").fields["integer"] == grid.fields["integer"]).all()
    assert sizes[0] > 2 * sizes[1]
    with pytest.raises(ValueError, match="compression is 'gz', but must be one of: none, zlib, lz4"):
        grid.write(tmp_path / "grid.vtu", compression="gz")


def test_blocks_are_listed_and_chosen(data, reader):
    path = data / "exodus" / "mixed_blocks_hdf5.exo"
    blocks = isotet.inspect(path, reader_program=reader)["blocks"]
    assert [sorted(block) for block in blocks] == [["cells", "kind", "name", "number"]] * len(blocks)
    assert len(blocks) > 1
    for block in blocks:
        assert len(isotet.read(path, blocks=[block["number"]], reader_program=reader)) == block["cells"]
    with pytest.raises(ValueError, match="nowhere"):
        isotet.read(path, blocks=["nowhere"], reader_program=reader)
    with pytest.raises(TypeError, match="blocks is 'a', but must be a list"):
        isotet.read(path, blocks="a")


def test_regions_have_names(data):
    regions = isotet.inspect(data / "msh" / "inclusions_v41_ascii.msh")["regions"]
    assert regions and all(isinstance(number, int) and name for _, number, name in regions)


def test_of_polyhedra_only_those_are_split_that_the_isovalue_meets():
    grid = isotet.make("kelvin", 8, ["sphere"])
    once = grid.contour(0.7, "sphere")
    session = isotet.Contour(grid, "sphere", method="direct")
    assert same(once, session.contour(0.7))
    assert "matter to the isovalues" in once.notes[0]


def test_centres_of_polyhedra_take_their_cells_values():
    made = isotet.make("kelvin", 4, ["sphere"])
    numbers = np.arange(len(made)) * 31 % 17
    grid = isotet.Grid(made.points, made.cells, offsets=made.offsets, types=made.types, faces=made.faces,
                       face_offsets=made.face_offsets, fields=made.fields, cell_fields={"number": numbers})  # fmt: skip
    mean, own = grid.contour(8.5, "number"), grid.contour(8.5, "number", centre="own")
    assert len(own.triangles) > len(mean.triangles)
    session = isotet.Contour(grid, "number", centre="own")
    assert np.array_equal(session.contour(8.5).points, own.points)
    for arguments in ({"field": "sphere", "centre": "own"}, {"field": numbers, "centre": "own"},
                      {"field": "number", "centre": "middle"}):  # fmt: skip
        with pytest.raises(ValueError, match="centre is"):
            grid.contour(8.5, **arguments)


def test_points_are_merged():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, -1]], np.float32)
    torn = isotet.Grid(points, np.arange(8).reshape(2, 4), fields={"t": np.array([0, 1, 2, 3, 0.5, 1, 2, 4], np.float32)})
    grid, report = torn.merge_points()
    assert report == {"merged": 3, "collapsed_cells": 0, "jumps": {"t": 0.5}}
    assert grid.cells[1].tolist() == [0, 1, 2, 7]
    assert grid.fields["t"][0] == 0
    assert torn.merge_points(values="mean")[0].fields["t"][0] == 0.25
    with pytest.raises(ValueError, match="values is 'median', but must be lowest or mean"):
        torn.merge_points(values="median")
    with pytest.raises(ValueError, match="tolerance"):
        torn.merge_points(-1)


def test_hanging_points_are_closed():
    grid = isotet.make("octree-bent", 4, ["sphere"])
    closed, report = grid.close_hanging_points()
    assert report["points"] > 0 and report["cells"] > 0 and report["open_faces"] == 0 and report["near_faces"] == 0
    assert not isotet.check(grid.contour(0.5)).closed and isotet.check(closed.contour(0.5)).closed
    assert report["differences"]["sphere"] > 0
    interpolated, _ = grid.close_hanging_points(interpolate=True)
    assert interpolated.close_hanging_points()[1]["points"] == 0
    assert np.count_nonzero(interpolated.fields["sphere"] != grid.fields["sphere"]) <= report["points"]
    assert isotet.check(interpolated.contour(0.5)).closed


def test_errors_of_files(tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        isotet.read(tmp_path / "nowhere.vtu")
    (tmp_path / "broken.vtu").write_text("<VTKFile type='UnstructuredGrid'>")
    with pytest.raises(ValueError, match="broken"):
        isotet.read(tmp_path / "broken.vtu")
    surface = isotet.make("kuhn", 3, ["sphere"]).contour(0.5)
    with pytest.raises(OSError):
        surface.write(tmp_path / "no_folder" / "s.vtp")
    with pytest.raises(ValueError, match="can be written as vtp"):
        surface.write(tmp_path / "s.png")
    assert issubclass(isotet.Error, Exception)


def test_too_much_memory_is_a_memory_error():
    with pytest.raises(MemoryError, match="needs 14.0 TB, but"):
        isotet.make("kuhn", 4096, [])


def test_surfaces_are_pickled_and_copied(sphere):
    surface = sphere.contour([0.4, 0.5], "sphere", normals="gradient", edge_ends=True, source_cells=True)
    assert same(pickle.loads(pickle.dumps(surface)), surface)
    assert same(copy.deepcopy(surface), surface)
    assert copy.copy(surface).method == surface.method


def test_own_surfaces():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    surface = isotet.Surface(corners, [[0, 1, 2]], normals=[[0, 0, 1]], fields={"t": [1, 2, 3]}, cell_fields={"c": [4]})
    assert surface.area == 0.5
    assert surface.normals_kind == "face"
    assert surface.fields["t"].tolist() == [1, 2, 3]
    with pytest.raises(ValueError, match="triangles has shape"):
        isotet.Surface(corners, [[0, 1]])
    with pytest.raises(ValueError, match="vertex -1"):
        isotet.Surface(corners, [[0, 1, -1]])


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"fields": {"t": [1, 2]}}, r"fields\['t'\] has 2 rows, but the surface has 3 vertices"),
        ({"fields": {"t": np.zeros((4, 2))}}, r"fields\['t'\] has 4 rows"),
        ({"cell_fields": {"c": [1, 2]}}, r"cell_fields\['c'\] has 2 rows, but the surface has 1 triangles"),
        ({"cell_fields": {"c": np.zeros((1, 0))}}, r"cell_fields\['c'\] has shape \(1, 0\)"),
        ({"normals": np.zeros((2, 3))}, r"normals has shape \(2, 3\), but must have shape \(3, 3\), one a vertex, or \(1, 3\)"),
        ({"normals": np.zeros(3)}, r"normals has shape \(3,\)"),
        ({"normals": np.zeros((3, 2))}, r"normals has shape \(3, 2\)"),
        ({"triangles": [[0, 1, 3]]}, "triangles has the vertex 3, but the surface has 3 vertices"),
        ({"triangles": np.array([[0, 1, 2**40]])}, f"triangles has the vertex {2**40}"),
        ({"points": np.empty((0, 3))}, "the surface has 0 vertices"),
    ],
)
def test_surfaces_of_wrong_shapes_are_refused(what, message):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    with pytest.raises(ValueError, match=message):
        isotet.Surface(**({"points": corners, "triangles": [[0, 1, 2]]} | what))


def test_threads_change_nothing(sphere):
    assert same(sphere.contour(0.3, "gyroid", threads=1), sphere.contour(0.3, "gyroid", threads=2))


def test_what_is_shown(sphere):
    assert repr(sphere) == "<isotet.Grid: 343 points, 1296 cells, fields sphere, gyroid>"
    surface = sphere.contour([0.4, 0.5], "sphere", fields=[])
    assert repr(surface) == f"<isotet.Surface: {len(surface.points)} vertices, {len(surface.triangles)} triangles, fields isovalue>"
    assert "1296 cells, field sphere" in repr(isotet.pack(sphere, values="sphere"))
    assert "27 cells, field sphere" in repr(isotet.pack(isotet.make("hex", 3, ["sphere"])))
    session = isotet.Contour(sphere, "sphere", surfaces=100)
    assert repr(session) == "<isotet.Contour: not packed, next clusters>"
    session.prepare()
    assert repr(session) == f"<isotet.Contour: packed, {session.nbytes} bytes, next clusters>"
    assert repr(isotet.Solids(sphere, "sphere")) == "<isotet.Solids: of a volume of 8>"
    for name in isotet.__all__:
        assert getattr(isotet, name).__doc__, name


def test_other_packages(sphere):
    surface = sphere.contour(0.5, "sphere", normals="gradient")
    mesh = surface.to_trimesh()
    assert mesh.is_watertight
    assert mesh.area == pytest.approx(surface.area)
    assert np.array_equal(mesh.faces, surface.triangles)
    assert np.allclose(mesh.vertex_normals, surface.normals, atol=1e-6)
    assert np.array_equal(mesh.vertex_attributes["gyroid"], surface.fields["gyroid"])
    assert np.array_equal(surface.to_meshio().cells_dict["triangle"], surface.triangles)
    polydata = surface.to_pyvista()
    assert polydata.is_manifold
    assert np.array_equal(polydata.regular_faces, surface.triangles)
    assert np.array_equal(polydata["gyroid"], surface.fields["gyroid"])
    assert np.array_equal(polydata.point_data["Normals"], surface.normals)


def test_surfaces_show_themselves_in_notebooks(sphere, monkeypatch, capsys):
    surface = sphere.contour(0.5, "sphere", normals="gradient")
    plotted = []
    monkeypatch.setattr(pyvista.PolyData, "plot", lambda mesh, **how: plotted.append((mesh.n_cells, how)))
    surface._ipython_display_()
    assert plotted == [(len(surface.triangles), {"notebook": True, "smooth_shading": True})]
    sphere.contour(9, "sphere")._ipython_display_()
    assert len(plotted) == 1, "nothing to plot"
    monkeypatch.setitem(sys.modules, "pyvista", None)  # not installed
    with pytest.raises(NotImplementedError):  # IPython then takes the picture
        surface._ipython_display_()
    assert len(plotted) == 1
    assert capsys.readouterr().out.splitlines()[-1] == repr(sphere.contour(9, "sphere"))


def test_pictures_stand_in_for_plots(sphere, tmp_path):
    surface = sphere.contour(0.5, "sphere")
    (tmp_path / "surface.png").write_bytes(surface._repr_png_())
    assert np.array_equal(pyvista.read_texture(tmp_path / "surface.png").to_array(),
                          isotet.render(surface, size=(800, 600)))  # fmt: skip
    assert "data:image/png;base64," in surface._repr_html_() and "&lt;isotet.Surface" in surface._repr_html_()
    nothing = sphere.contour(9, "sphere")
    assert nothing._repr_png_() is None and nothing._repr_html_().startswith("<pre>")


def test_a_solid_is_closed_and_the_two_sides_make_up_the_grid():
    grid = isotet.make("mixed", 6, ["gyroid"])
    solids = isotet.Solids(grid, "gyroid", cell_fields=[])
    above, below = solids.solid(above=0.2), solids.solid(below=0.2)
    for solid in (above, below):
        assert solid.solid["open_edges"] == 0
        assert isotet.check(solid, closed=True).sound
        assert set(np.unique(solid.cell_fields["boundary"])) == {0, 1}
        assert solid.solid["isosurface_triangles"] == (solid.cell_fields["boundary"] == 0).sum()
    assert abs(above.solid["volume"] + below.solid["volume"] - solids.grid_volume) < 1e-5
    assert grid.contour(0.2, "gyroid").solid is None
    with pytest.raises(ValueError, match="above, below or both"):
        solids.solid()
    with pytest.raises(ValueError, match="must ascend"):
        solids.solid(above=1, below=0)


def test_parts_are_told_and_kept():
    surface = isotet.make("kuhn", 20, ["gyroid"]).contour(0.95, "gyroid")
    table = isotet.parts(surface)
    assert len(table) > 1 and [part["area"] for part in table] == sorted((part["area"] for part in table), reverse=True)
    assert table[0]["means"]["gyroid"] == pytest.approx(0.95, abs=1e-3)
    largest = surface.keep_parts()
    reduced = largest.reduce(0.5)
    assert 0 < len(reduced.triangles) < 0.6 * len(largest.triangles)
    with pytest.raises(ValueError, match="share"):
        largest.reduce(1)
    assert len(largest.triangles) == table[0]["triangles"]
    assert set(largest.cell_fields["part"]) == {0}
    assert len(surface.keep_parts(range(len(table))).triangles) == len(surface.triangles)
    with pytest.raises(ValueError, match="part"):
        surface.keep_parts(len(table))


def test_solids_are_measured_again_where_parts_or_triangles_go():
    solid = isotet.make("kuhn", 20, ["gyroid"]).solid("gyroid", above=0.95)
    table = isotet.parts(solid)
    largest = solid.keep_parts()
    assert largest.solid["volume"] == pytest.approx(table[0]["volume"], rel=1e-12)
    assert largest.solid["boundary_area"] == pytest.approx(table[0]["area"] * table[0]["means"]["boundary"], rel=1e-9)
    assert largest.solid["grid_volume"] == solid.solid["grid_volume"] and largest.solid["open_edges"] == 0
    reduced = solid.reduce(0.6)
    assert reduced.solid["volume"] == pytest.approx(sum(part["volume"] for part in isotet.parts(reduced)), rel=1e-9)
    assert reduced.solid["isosurface_area"] + reduced.solid["boundary_area"] == pytest.approx(reduced.area, rel=1e-9)
    assert reduced.solid["isosurface_triangles"] == np.count_nonzero(reduced.cell_fields["boundary"] == 0)


def test_parts_that_touch_a_region_are_told():
    solid = isotet.make("kuhn", 20, ["gyroid"]).solid("gyroid", above=0.95)
    touching = solid.parts_touching("boundary", 1)
    on_boundary = [i for i, part in enumerate(isotet.parts(solid)) if part["means"]["boundary"] > 0]
    assert touching == on_boundary and solid.parts_touching("boundary", (0.5, 2)) == touching
    assert set(solid.keep_parts(touching).cell_fields["part"]) == set(touching)
    with pytest.raises(ValueError, match="no cell field 'material'"):
        solid.parts_touching("material", 3)


def test_clipped_cells_carry_fields_and_numbers_and_fill_the_solid():
    grid = isotet.make("mixed", 6, ["gyroid", "plane"])
    clipper = isotet.Clipper(grid, "gyroid", edge_ends=True)
    part = clipper.clip(above=0.2)
    assert set(part.fields) == {"gyroid", "plane", "edge_ends", "edge_weights"}
    source = part.cell_fields["source_cell"]
    assert (np.diff(source) >= 0).all()
    assert part.info["whole_cells"] + part.info["cut_cells"] == len(np.unique(source))
    solid = isotet.Solids(part, "plane").solid(above=-9)
    assert solid.solid["open_edges"] == 0
    assert abs(solid.solid["volume"] - grid.solid("gyroid", above=0.2).solid["volume"]) < 1e-5
    without = clipper.clip(above=0.2, polyhedra=False)
    assert part.info["polyhedra"] > 0 and without.info["polyhedra"] == 0 and without.faces is None
    with pytest.raises(ValueError, match="above, below or both"):
        clipper.clip()
    with pytest.raises(ValueError, match="must ascend"):
        clipper.clip(above=1, below=0)


def test_clips_without_cells_go_everywhere(tmp_path):
    nothing = isotet.make("mixed", 4, ["sphere"]).clip("sphere", below=-1)
    assert len(nothing) == 0 and nothing.fields["sphere"].shape == nothing.cell_fields["source_cell"].shape == (0,)
    assert nothing.to_vtk().GetNumberOfCells() == 0
    assert nothing.to_pyvista().n_cells == 0
    assert nothing.to_meshio().cells == []
    nothing.write(tmp_path / "nothing.vtu")
    for again in (isotet.Grid(nothing.to_pyvista()), isotet.Grid(nothing.to_meshio()), isotet.read(tmp_path / "nothing.vtu")):
        assert len(again) == 0
