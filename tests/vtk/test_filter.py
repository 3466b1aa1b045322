# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""vtkIsotetContour against vtkContourFilter."""

import unittest

import numpy as np
from isotet_vtk.vtkIsotet import vtkIsotetClip, vtkIsotetContour, vtkIsotetContourFilter, vtkIsotetReader, vtkIsotetSlice
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkObjectFactory, vtkStringArray
from vtkmodules.vtkCommonDataModel import (vtkMultiBlockDataSet, vtkPartitionedDataSet, vtkPartitionedDataSetCollection, vtkPlane,
                                           vtkPolyData, vtkSphere)
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkContourFilter
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

from grids import (HEXAHEDRON, TETS, add, area_of, corners_of, grid_of, lattice, names, open_edges, points_of, sphere, triangles_of)


def start(grid, name="r", value=0.3, kind=vtkIsotetContour):
    contour = kind()
    contour.said = []
    for event in ("ErrorEvent", "WarningEvent"):
        contour.AddObserver(event, Listener(contour.said))
    contour.SetInputDataObject(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, name)
    contour.SetValue(0, value)
    return contour


class Listener:
    """Keeps the text of warnings and errors."""

    CallDataType = "string0"

    def __init__(self, said):
        self.said = said

    def __call__(self, caller, event, text=""):
        self.said.append(text)


def run(grid, **options):
    contour = start(grid, **options)
    contour.Update()
    return contour


def quadratic_tets(n):
    """Quadratic tets on -1/2 to 1/2, whose field "r" is the squared distance from the middle, times 2: a quadratic one."""
    side = 2 * n + 1
    axis = np.arange(side) / (2 * n) - 0.5
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    corner = np.arange(0, side - 1, 2)
    first = (corner[:, None, None] * side**2 + corner[None, :, None] * side + corner).ravel()
    steps = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
    tets = []
    for tet in TETS:
        ends = steps[tet] * 2
        nodes = [*ends] + [(ends[a] + ends[b]) // 2 for a, b in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
        tets.append(first[:, None] + np.array(nodes) @ [1, side, side**2])
    return grid_of(points, np.concatenate(tets), {"r": 2 * (points**2).sum(axis=1)}, kind=24)


def distances(surface, value=0.3):
    """The largest distance of a vertex from the sphere."""
    return np.abs(np.linalg.norm(points_of(surface), axis=1) - np.sqrt(value / 2)).max()


class Surfaces(unittest.TestCase):
    def test_has_the_arrays_and_active_arrays_of_vtk(self):
        grid = sphere()
        points, count = grid.GetNumberOfPoints(), grid.GetNumberOfCells()
        add(grid.GetPointData(), "p", np.arange(points, dtype=np.float64))
        grid.GetPointData().SetVectors(add(grid.GetPointData(), "v", np.ones((points, 3), np.float32)))
        add(grid.GetCellData(), "material", np.arange(count, dtype=np.int32))
        words = vtkStringArray()
        words.SetName("words")
        words.SetNumberOfValues(count)
        for normals in (0, 1):
            for scalars in (0, 1):
                outputs = []
                for kind in (vtkIsotetContour, vtkContourFilter):
                    contour = start(grid, kind=kind)
                    contour.SetComputeNormals(normals)
                    contour.SetComputeScalars(scalars)
                    contour.Update()
                    outputs.append(contour.GetOutput())
                ours, theirs = outputs
                self.assertEqual(names(ours.GetPointData()), names(theirs.GetPointData()))
                self.assertEqual(names(ours.GetCellData()), names(theirs.GetCellData()))
                for get in ("GetScalars", "GetVectors", "GetNormals"):
                    active = [getattr(o.GetPointData(), get)() for o in outputs]
                    self.assertEqual(*[a and (a.GetName(), a.GetDataType()) for a in active], get)

    def test_is_the_surface_of_vtk(self):
        for options in ({}, {"bits": 32}, {"dtype": np.float64}):
            grid = sphere(12, **options)
            ours, theirs = run(grid).GetOutput(), run(grid, kind=vtkContourFilter).GetOutput()
            self.assertEqual(ours.GetNumberOfPoints(), theirs.GetNumberOfPoints())
            self.assertAlmostEqual(area_of(ours), area_of(theirs), places=3)
            self.assertEqual(open_edges(ours), 0)
            self.assertEqual(ours.GetPoints().GetDataType(), theirs.GetPoints().GetDataType())

    def test_carried_arrays_keep_their_type_whatever_that_of_points(self):
        grid = sphere()
        for name, dtype in (("f", np.float32), ("d", np.float64), ("i", np.int32)):
            add(grid.GetPointData(), name, np.arange(grid.GetNumberOfPoints(), dtype=dtype))
        for precision in (0, 1, 2):
            outputs = []
            for kind in (vtkIsotetContour, vtkContourFilter):
                contour = start(grid, kind=kind)
                contour.SetOutputPointsPrecision(precision)
                contour.Update()
                outputs.append(contour.GetOutput().GetPointData())
            ours, theirs = outputs
            for name in names(theirs):
                self.assertEqual(ours.GetArray(name).GetDataType(), theirs.GetArray(name).GetDataType(), name)

    def test_is_the_same_from_32_and_64_bit_cells(self):
        for n in (1, 2):  # directly, and from packed cells
            a, b = (start(sphere(bits=bits)) for bits in (32, 64))
            for contour in (a, b):
                contour.SetExpectedSurfaces(0 if n == 1 else 100)
                contour.Update()
            self.assertEqual(points_of(a.GetOutput()).tobytes(), points_of(b.GetOutput()).tobytes())
            self.assertEqual(triangles_of(a.GetOutput()).tobytes(), triangles_of(b.GetOutput()).tobytes())

    def test_joins_several_isovalues_as_vtk_does(self):
        ours, theirs = (start(sphere(), kind=kind) for kind in (vtkIsotetContour, vtkContourFilter))
        for contour in (ours, theirs):
            contour.GenerateValues(3, 0.2, 0.4)
            contour.Update()
        self.assertEqual([ours.GetValue(i) for i in range(3)], [theirs.GetValue(i) for i in range(3)])
        values, wanted = (np.unique(vtk_to_numpy(c.GetOutput().GetPointData().GetArray("r"))) for c in (ours, theirs))
        np.testing.assert_allclose(values, np.float32([0.2, 0.3, 0.4]))
        self.assertEqual(ours.GetOutput().GetNumberOfPoints(), theirs.GetOutput().GetNumberOfPoints())

    def test_is_empty_beyond_the_range_and_without_cells(self):
        self.assertEqual(run(sphere(), value=9).GetOutput().GetNumberOfCells(), 0)
        self.assertEqual(run(grid_of(np.zeros((0, 3), np.float32), np.zeros((0, 4), int), {"r": np.zeros(0, np.float32)})).GetOutput().GetNumberOfCells(), 0)

    def test_gives_nothing_without_isovalues(self):
        for normals in (0, 1):
            contour = start(sphere())
            contour.SetComputeNormals(normals)
            contour.SetNumberOfContours(0)
            contour.Update()
            self.assertEqual((contour.GetOutput().GetNumberOfPoints(), contour.GetOutput().GetNumberOfCells()), (0, 0))
            self.assertEqual(contour.GetOutput().GetPoints().GetData().GetNumberOfComponents(), 3)
            self.assertEqual(contour.said, [])

    def test_gives_points_of_the_type_of_the_input_also_around_the_origin(self):
        points, cells, field = lattice(6)
        points -= (points.min(axis=0) + points.max(axis=0)) / 2
        for dtype in (np.float32, np.float64):
            for middle in (0, 1):
                contour = start(grid_of(points.astype(dtype) + dtype(middle), cells, {"r": field}))
                for precision, wanted in ((2, dtype), (0, np.float32), (1, np.float64)):
                    contour.SetOutputPointsPrecision(precision)
                    contour.Update()
                    self.assertEqual(points_of(contour.GetOutput()).dtype, wanted)

    def test_gives_points_in_the_precision_asked_for(self):
        grid = sphere()
        for precision, wanted in ((0, np.float32), (1, np.float64), (2, np.float32)):
            contour = start(grid)
            contour.SetOutputPointsPrecision(precision)
            contour.Update()
            self.assertEqual(points_of(contour.GetOutput()).dtype, wanted)

    def test_points_normals_to_higher_values(self):
        out = run(sphere(16)).GetOutput()
        outwards = points_of(out) - 0.47
        self.assertGreater((vtk_to_numpy(out.GetPointData().GetNormals()) * outwards).sum(axis=1).min(), 0)

    def test_leaves_out_ghost_cells(self):
        points, cells, field = lattice(8)
        ghosts = np.where(points[cells[:, 0], 0] > 0.5, 1, 0)
        for normals in (0, 1):
            whole = start(grid_of(points, cells[ghosts == 0], {"r": field}))
            marked = start(grid_of(points, cells, {"r": field}, ghosts=ghosts))
            for contour in (whole, marked):
                contour.SetComputeNormals(normals)
                contour.Update()
            self.assertTrue(corners_of(whole.GetOutput()) == corners_of(marked.GetOutput()))
            self.assertNotIn("vtkGhostType", names(marked.GetOutput().GetCellData()))

    def test_contours_polyhedra(self):
        tets = sphere(4)
        contour = start(as_polyhedra(tets))
        contour.Update()
        self.assertEqual(contour.said, [])
        self.assertTrue(corners_of(run(tets).GetOutput()) == corners_of(contour.GetOutput()))

    def test_contours_prisms_of_five_and_six_sides(self):
        for sides, kind in ((5, 15), (6, 16)):
            angle = 2 * np.pi / sides * np.arange(sides)
            ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            points = np.concatenate([np.column_stack([ring, np.full(sides, z)]) for z in (0.0, 1.0)])
            prism = grid_of(points, np.arange(2 * sides)[None], {"r": points[:, 2]}, kind=kind)
            contour = run(prism)
            self.assertEqual(contour.said, [])
            self.assertAlmostEqual(area_of(contour.GetOutput()), sides / 2 * np.sin(2 * np.pi / sides), places=6)

    def test_refines_lagrange_pyramids(self):
        base, middle = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([0.5, 0.5, 0])
        corners = np.concatenate([base, [[0.5, 0.5, 1]]])
        edges = [(corners[a] + corners[b]) / 2 for a, b in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4))]
        points = np.concatenate([corners, edges, [middle]])
        pyramid = grid_of(points, np.arange(14)[None], {"r": points[:, 2] ** 2}, kind=74)
        contour = start(pyramid, value=0.25)
        contour.SetTolerance(1e-3)
        contour.Update()
        self.assertEqual(contour.said, [])
        self.assertAlmostEqual(area_of(contour.GetOutput()), 0.25, places=3)


def as_polyhedra(tets):
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

    grid = vtkUnstructuredGrid()
    grid.SetPoints(tets.GetPoints())
    grid.GetPointData().ShallowCopy(tets.GetPointData())
    for c in range(tets.GetNumberOfCells()):
        corners = [tets.GetCell(c).GetPointId(i) for i in range(4)]
        if c % 2:
            grid.InsertNextCell(10, 4, corners)
            continue
        stream = vtkIdList()
        stream.InsertNextId(4)
        for left_out in range(4):
            stream.InsertNextId(3)
            for i in range(4):
                if i != left_out:
                    stream.InsertNextId(corners[i])
        grid.InsertNextCell(42, stream)
    return grid


class Kept(unittest.TestCase):
    def updates(self, contour, value):
        contour.SetValue(0, value)
        contour.Update()
        return contour.GetLastUpdate(), contour.GetUsedPackedGrids()

    def test_packs_cells_once(self):
        points, cells, field = lattice(8)
        grid = grid_of(points, cells, {"r": field, "s": 1 - field})
        contour = start(grid)
        contour.SetExpectedSurfaces(100)
        self.assertEqual(self.updates(contour, 0.3), (3, True))
        self.assertEqual(self.updates(contour, 0.31), (0, True))
        contour.SetInputArrayToProcess(0, 0, 0, 0, "s")
        self.assertEqual(self.updates(contour, 0.7), (1, True))
        moved = vtk_to_numpy(grid.GetPoints().GetData())
        moved[:] *= 2
        grid.GetPoints().GetData().Modified()
        grid.GetPoints().Modified()
        grid.Modified()
        self.assertEqual(self.updates(contour, 0.7), (2, True))
        wanted = run(grid_of(points * 2, cells, {"s": 1 - field}), name="s", value=0.7).GetOutput()
        self.assertTrue(corners_of(contour.GetOutput()) == corners_of(wanted))
        contour.SetInputDataObject(sphere(6))
        contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
        self.assertEqual(self.updates(contour, 0.3), (3, True))

    def test_knows_equal_cells_in_arrays_of_another_time_step(self):
        points, cells, field = lattice(8)
        contour = start(grid_of(points, cells, {"r": field}))
        contour.SetExpectedSurfaces(100)
        contour.Update()
        contour.SetInputDataObject(grid_of(points, cells, {"r": field * 2}))
        self.assertEqual(self.updates(contour, 0.6), (1, True))
        self.assertEqual(self.updates(contour, 0.61), (0, True))

    def test_packs_when_a_second_surface_is_wanted(self):
        contour = start(sphere())
        self.assertFalse(self.updates(contour, 0.3)[1])
        for value in np.linspace(0.2, 0.4, 30):
            self.updates(contour, value)
        self.assertTrue(contour.GetUsedPackedGrids())
        self.assertGreater(contour.GetPackedBytes(), 0)

    def test_keeps_no_array_of_vtk(self):
        for expected in (0, 100):
            grid = sphere()
            contour = start(grid)
            contour.SetExpectedSurfaces(expected)
            contour.Update()
            array = grid.GetCells().GetConnectivityArray()
            self.assertLessEqual(array.GetReferenceCount(), 2)  # the cell array's, and this one

    def test_surfaces_outlive_filter_and_input(self):
        contour = run(sphere())
        out = vtkPolyData()
        out.ShallowCopy(contour.GetOutput())
        before = corners_of(out)
        del contour
        self.assertTrue(corners_of(out) == before)
        copy = vtkPolyData()
        copy.DeepCopy(out)
        out.GetPoints().GetData().Resize(7)
        self.assertTrue(corners_of(copy) == before)


class Composite(unittest.TestCase):
    def halves(self, dtype=np.float64):
        points, cells, field = lattice(8, HEXAHEDRON, dtype=dtype, origin=5e5)
        left = points[cells[:, 0], 0] < 5e5 + 0.45
        ids = np.arange(len(points))
        whole = grid_of(points, cells, {"r": field}, ids=ids)
        out = []
        for part in (left, ~left):
            used, local = np.unique(cells[part], return_inverse=True)
            out.append(grid_of(points[used], local.reshape(-1, 8), {"r": field[used]}, ids=used))
        return whole, out

    def test_keeps_the_structure(self):
        _, (a, b) = self.halves()
        blocks = vtkMultiBlockDataSet()
        inner = vtkMultiBlockDataSet()
        inner.SetBlock(1, b)
        blocks.SetBlock(0, a)
        blocks.SetBlock(2, inner)
        out = run(blocks).GetOutputDataObject(0)
        self.assertEqual(out.GetClassName(), "vtkMultiBlockDataSet")
        self.assertEqual(out.GetNumberOfBlocks(), 3)
        self.assertIsNone(out.GetBlock(1))
        self.assertEqual(out.GetBlock(2).GetBlock(1).GetClassName(), "vtkPolyData")
        collection = vtkPartitionedDataSetCollection()
        for i, grid in enumerate((a, b)):
            part = vtkPartitionedDataSet()
            part.SetPartition(0, grid)
            collection.SetPartitionedDataSet(i, part)
        out = run(collection).GetOutputDataObject(0)
        self.assertEqual(out.GetClassName(), "vtkPartitionedDataSetCollection")
        self.assertGreater(out.GetPartition(1, 0).GetNumberOfCells(), 0)

    def test_blocks_fit_bit_for_bit(self):
        whole, parts = self.halves()
        blocks = vtkMultiBlockDataSet()
        for i, part in enumerate(parts):
            blocks.SetBlock(i, part)
        for expected in (0, 100):
            contour = start(blocks)
            contour.SetExpectedSurfaces(expected)
            contour.Update()
            out = contour.GetOutputDataObject(0)
            pieces = [corners_of(out.GetBlock(i)) for i in range(2)]
            self.assertTrue(pieces[0] | pieces[1] == corners_of(run(whole).GetOutput()))
            self.assertEqual(contour.said, [])

    def test_contours_blocks_that_have_the_array(self):
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, sphere())
        other = sphere(4)
        other.GetPointData().Initialize()
        blocks.SetBlock(1, other)
        contour = run(blocks)
        self.assertGreater(contour.GetOutputDataObject(0).GetBlock(0).GetNumberOfCells(), 0)
        self.assertEqual(contour.GetOutputDataObject(0).GetBlock(1).GetNumberOfCells(), 0)
        self.assertEqual(contour.said, [])

    def test_says_when_blocks_cannot_fit(self):
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, sphere())
        blocks.SetBlock(1, sphere(dtype=np.float64))
        contour = run(blocks)
        self.assertGreater(contour.GetOutputDataObject(0).GetBlock(1).GetNumberOfCells(), 0)
        self.assertIn("may not fit", contour.said[0])


class HandedToVtk(unittest.TestCase):
    def test_other_data_sets_with_a_warning(self):
        source = vtkRTAnalyticSource()
        source.Update()
        image = source.GetOutput()
        ours, theirs = run(image, name="RTData", value=150), run(image, name="RTData", value=150, kind=vtkContourFilter)
        self.assertEqual(ours.GetOutput().GetNumberOfCells(), theirs.GetOutput().GetNumberOfCells())
        self.assertEqual(len(ours.said), 1)
        self.assertIn("vtkImageData is contoured by vtkContourFilter", ours.said[0])
        ours.SetValue(0, 160)
        ours.Update()
        self.assertEqual(len(ours.said), 1)  # the same reason is not said again

    def test_other_cells_beside_isotets_own(self):
        points, cells, field = lattice(6)
        tets = grid_of(points, cells, {"r": field})
        faces = grid_of(points, cells[:, [0, 1, 2]], {"r": field}, kind=5)
        both = vtkAppendFilter()
        for part in (tets, faces):
            add(part.GetCellData(), "c", np.arange(len(cells)))
            both.AddInputData(part)
        both.Update()
        contour = run(both.GetOutput())
        self.assertIn("triangle", contour.said[0])
        out = contour.GetOutput()
        self.assertEqual(out.GetNumberOfPolys(), run(tets).GetOutput().GetNumberOfPolys())
        self.assertEqual(out.GetNumberOfLines(), run(faces, kind=vtkContourFilter).GetOutput().GetNumberOfLines())
        self.assertIn("c", names(out.GetCellData()))

    def test_quadratic_cells_are_contoured_once(self):
        corners = np.array([[5, 0, 0], [6, 0, 0], [5, 1, 0], [5, 0, 1]], np.float32)
        edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
        points = np.concatenate([corners, [(corners[a] + corners[b]) / 2 for a, b in edges]]).astype(np.float32)
        quadratic = grid_of(points, np.arange(10)[None], {"r": points[:, 0] - 5}, kind=24)
        both = vtkAppendFilter()
        for part in (sphere(), quadratic):
            both.AddInputData(part)
        both.Update()
        contour = run(both.GetOutput(), value=0.3)
        self.assertIn("quadratic", contour.said[0].lower())
        found = [run(part, kind=kind, value=0.3).GetOutput().GetNumberOfPolys()
                 for part, kind in ((sphere(), vtkIsotetContour), (quadratic, vtkContourFilter))]
        self.assertGreater(found[1], 0)
        self.assertEqual(contour.GetOutput().GetNumberOfPolys(), sum(found))

    def test_a_tolerance_refines_quadratic_cells(self):
        grid = quadratic_tets(4)
        plain = run(grid)
        self.assertIn("a Tolerance above 0 refines curved ones", plain.said[0])
        self.assertEqual(plain.GetFieldBound(), 0)
        spread = distances(plain.GetOutput())
        contour = start(grid)
        contour.SetComputeNormals(0)
        for tolerance, farthest in ((0.01, 0.02), (0.001, 0.002)):
            contour.SetTolerance(tolerance)
            contour.Update()
            self.assertEqual(contour.said, [])
            width = np.ptp(vtk_to_numpy(grid.GetPointData().GetArray("r")))
            self.assertLessEqual(contour.GetFieldBound(), tolerance * width * 1.5)
            self.assertGreater(contour.GetFieldBound(), 0)
            self.assertEqual(open_edges(contour.GetOutput()), 0)
            self.assertLess(distances(contour.GetOutput()), min(farthest, spread))
        contour.SetValue(0, 0.4)
        contour.Update()
        self.assertEqual(open_edges(contour.GetOutput()), 0)
        contour.SetTolerance(0)
        contour.SetValue(0, 0.3)
        contour.Update()
        self.assertEqual(contour.GetOutput().GetNumberOfPolys(), plain.GetOutput().GetNumberOfPolys())

    def test_solids_are_closed_and_make_up_the_grid(self):
        grid = sphere(6)

        def volume(name, *values):
            contour = start(grid, value=values[0])
            if len(values) > 1:
                contour.SetValue(1, values[1])
            getattr(contour, "SetSolidTo" + name)()
            contour.Update()
            self.assertEqual(contour.said, [])
            surface = contour.GetOutput()
            self.assertEqual(open_edges(surface), 0)
            self.assertIsNone(surface.GetPointData().GetNormals())
            self.assertEqual(surface.GetPointData().GetScalars().GetName(), "r")
            self.assertLessEqual(set(vtk_to_numpy(surface.GetCellData().GetArray("boundary"))), {0, 1})
            a, b, c = (points_of(surface)[triangles_of(surface)[:, k]].astype(float) for k in range(3))
            return (a * np.cross(b, c)).sum() / 6

        above, below, between, whole = volume("Above", 0.3), volume("Below", 0.3), volume("Between", 0.4, 0.3), volume("Below", 99)
        self.assertGreater(min(above, below, between), 0)
        self.assertAlmostEqual(above + below, whole, places=5)
        self.assertAlmostEqual(below + between, volume("Below", 0.4), places=5)

    def test_solids_are_made_of_each_block(self):
        blocks = vtkMultiBlockDataSet()
        blocks.SetNumberOfBlocks(3)
        for i in (0, 2):
            blocks.SetBlock(i, sphere(4 + i))
        contour = start(blocks)
        contour.SetSolidToBelow()
        contour.Update()
        self.assertEqual(contour.said, [])
        for i in (0, 2):
            alone = start(blocks.GetBlock(i))
            alone.SetSolidToBelow()
            alone.Update()
            solid = contour.GetOutputDataObject(0).GetBlock(i)
            self.assertEqual((open_edges(solid), solid.GetNumberOfPolys()), (0, alone.GetOutput().GetNumberOfPolys()))

    def test_a_slice_that_moves_along_its_normal_keeps_the_field(self):
        grid, plane = sphere(), vtkPlane()
        plane.SetNormal(0, 3, 4)
        slice = vtkIsotetSlice()
        slice.SetInputData(grid)
        slice.SetExpectedSurfaces(100)
        slice.SetCutFunction(plane)
        updates = []
        for origin, normal in (((0.5, 0.5, 0.5), (0, 3, 4)), ((0.5, 0.4, 0.3), (0, 3, 4)), ((0.5, 0.4, 0.3), (0, 0.6, 0.8)),
                               ((0.5, 0.5, 0.5), (1, 0, 0))):  # fmt: skip
            plane.SetOrigin(origin)
            plane.SetNormal(normal)
            slice.Update()
            updates.append(slice.GetLastUpdate())
            places = (points_of(slice.GetOutput()) - origin) @ np.array(normal)
            self.assertLess(np.abs(places).max(), 1e-6)
            self.assertEqual(names(slice.GetOutput().GetPointData()), ["r"])
        self.assertEqual(updates, [slice.GRID, slice.NOTHING, slice.NOTHING, slice.FIELD])

    def test_slices_follow_any_function(self):
        sphere_of = vtkSphere()
        sphere_of.SetCenter(0.5, 0.5, 0.5)
        sphere_of.SetRadius(0.3)
        slice = vtkIsotetSlice()
        slice.SetInputData(sphere(16))
        slice.SetCutFunction(sphere_of)
        slice.SetValue(0, 0.1)
        slice.Update()
        self.assertLess(np.abs(np.linalg.norm(points_of(slice.GetOutput()) - 0.5, axis=1) - 0.4).max(), 7e-3)
        self.assertEqual(open_edges(slice.GetOutput()), 0)
        image = vtkRTAnalyticSource()
        slice.SetInputConnection(image.GetOutputPort())
        sphere_of.SetCenter(0, 0, 0)
        sphere_of.SetRadius(5)
        slice.SetValue(0, 0)
        slice.Update()
        self.assertGreater(slice.GetOutput().GetNumberOfPolys(), 0)
        self.assertEqual(names(slice.GetOutput().GetPointData()), ["RTData"])
        slice.SetCutFunction(None)
        said = []
        slice.AddObserver("ErrorEvent", Listener(said))
        slice.Update()
        self.assertIn("no CutFunction", said[0])

    def test_the_reader_says_which_file_is_none(self):
        reader, said = vtkIsotetReader(), []
        reader.AddObserver("ErrorEvent", Listener(said))
        reader.SetFileName(__file__)
        self.assertFalse(reader.CanReadFile(__file__))
        reader.Update()
        self.assertIn(__file__, said[0])

    def test_clips_have_the_cells_of_one_side(self):
        points, cells, field = lattice(6, HEXAHEDRON, np.float64)
        grid = grid_of(points, cells, {"r": field, "n": np.arange(len(points), dtype=np.int32)})
        add(grid.GetCellData(), "material", np.arange(len(cells), dtype=np.int16))
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, grid)
        for data in (grid, blocks):
            clip = start(data, kind=vtkIsotetClip)
            clip.Update()
            self.assertEqual(clip.said, [])
            out = clip.GetOutputDataObject(0)
            out = out.GetBlock(0) if out.IsA("vtkMultiBlockDataSet") else out
            self.assertEqual(out.GetPoints().GetDataType(), 11)
            self.assertEqual(names(out.GetPointData()), ["n", "r"])
            self.assertEqual(out.GetCellData().GetArray("material").GetDataType(), 4)
            kept = vtk_to_numpy(out.GetPointData().GetArray("r"))
            self.assertGreaterEqual(kept.min(), 0.3 - 1e-12)
            self.assertEqual(kept.max(), field.max())
            self.assertTrue({tuple(p) for p in points[field >= 0.3]} <= {tuple(p) for p in points_of(out)})
            self.assertIn(42, {out.GetCellType(c) for c in range(out.GetNumberOfCells())})
            faces = vtkIdList()
            polyhedron = next(c for c in range(out.GetNumberOfCells()) if out.GetCellType(c) == 42)
            out.GetFaceStream(polyhedron, faces)
            self.assertEqual(faces.GetId(0), out.GetCell(polyhedron).GetNumberOfFaces())

    def test_clips_of_other_data_sets_are_of_their_cells(self):
        image = vtkRTAnalyticSource()
        image.Update()
        clip = start(image.GetOutput(), name="RTData", value=150, kind=vtkIsotetClip)
        clip.SetSolidToBelow()
        clip.PolyhedraOff()
        clip.Update()
        self.assertEqual(clip.said, [])
        self.assertGreater(clip.GetOutputDataObject(0).GetNumberOfCells(), 0)
        self.assertLessEqual(clip.GetOutputDataObject(0).GetPointData().GetArray("RTData").GetRange()[1], 150)
        clip = start(run(sphere()).GetOutput(), kind=vtkIsotetClip)
        clip.Update()
        self.assertIn("left out: triangle", clip.said[0])

    def test_says_why_there_is_no_solid(self):
        image = vtkRTAnalyticSource()
        image.Update()
        contour = start(image.GetOutput(), name="RTData")
        contour.SetSolidToAbove()
        contour.Update()
        self.assertIn("a Solid was asked for, but", contour.said[0])
        contour = start(sphere(2))
        contour.SetSolidToBetween()
        contour.Update()
        self.assertIn("takes two of them", contour.said[0])
        clip = start(sphere(2), kind=vtkIsotetClip)
        clip.SetSolid(vtkIsotetClip.NO_SOLID)
        clip.Update()
        self.assertIn("Solid is NO_SOLID", clip.said[0])

    def test_blocks_with_quadratic_cells_are_not_refined(self):
        blocks = vtkMultiBlockDataSet()
        for i in range(2):
            blocks.SetBlock(i, quadratic_tets(2))
        contour = start(blocks)
        contour.SetTolerance(0.01)
        contour.Update()
        self.assertIn("a Tolerance refines those of one grid on one rank", contour.said[0])
        self.assertGreater(contour.GetOutputDataObject(0).GetBlock(1).GetNumberOfPolys(), 0)

    def test_has_the_methods_of_vtkcontourfilter(self):
        self.assertEqual(set(dir(vtkContourFilter)) - set(dir(vtkIsotetContour)), set())
        ours, theirs = vtkIsotetContour(), vtkContourFilter()
        for name in ("ComputeScalars", "ComputeGradients", "UseScalarTree", "GenerateTriangles", "ArrayComponent", "Locator"):
            self.assertEqual(getattr(ours, f"Get{name}")(), getattr(theirs, f"Get{name}")(), name)

    def test_polygons_are_vtks(self):
        grid = sphere()
        ours, theirs = start(grid), start(grid, kind=vtkContourFilter)
        for contour in (ours, theirs):
            contour.GenerateTrianglesOff()
            contour.Update()
        self.assertEqual(ours.GetOutput().GetNumberOfCells(), theirs.GetOutput().GetNumberOfCells())
        self.assertIn("GenerateTriangles is off", ours.said[0])

    def test_components(self):
        grid = sphere()
        values = np.random.default_rng(1).random((grid.GetNumberOfPoints(), 3), np.float32)
        add(grid.GetPointData(), "w", values)
        for number in range(3):
            add(grid.GetPointData(), f"c{number}", np.ascontiguousarray(values[:, number]))
        contour = start(grid, name="w", value=0.5)
        for number in (0, 2, 1):
            contour.SetArrayComponent(number)
            contour.Update()
            out = contour.GetOutput()
            self.assertEqual(points_of(out).tobytes(), points_of(run(grid, name=f"c{number}", value=0.5).GetOutput()).tobytes())
            self.assertEqual("w_" + str(number) in names(out.GetPointData()), number > 0)
            self.assertIn("w", names(out.GetPointData()))
            self.assertEqual(contour.said, [])
        contour.SetExpectedSurfaces(100)
        for value in (0.55, 0.6):
            contour.SetValue(0, value)
            contour.Update()
        self.assertEqual(contour.GetLastUpdate(), 0)
        contour.SetArrayComponent(3)
        contour.Update()
        self.assertIn("the array has 3 components, but ArrayComponent is 3", contour.said[0])

    def test_components_of_other_cells(self):
        points, cells, field = lattice(6)
        faces = grid_of(points, cells[:, [0, 1, 2]], {"r": field}, kind=5)
        add(faces.GetPointData(), "w", np.stack([field * 0, field], axis=1))
        contour = start(faces, name="w")
        contour.SetArrayComponent(1)
        contour.Update()
        wanted = run(faces, kind=vtkContourFilter).GetOutput().GetNumberOfLines()
        self.assertGreater(wanted, 0)
        self.assertEqual(contour.GetOutput().GetNumberOfLines(), wanted)


class Types(unittest.TestCase):
    def test_integers_stay_integers(self):
        for dtype in (np.int8, np.uint8, np.int16, np.int32, np.uint32, np.int64, np.uint64):
            grid = sphere()
            values = (np.arange(grid.GetNumberOfPoints()) % 100).astype(dtype)
            add(grid.GetPointData(), "n", values)
            add(grid.GetPointData(), "f", values.astype(np.float64))
            ours = [run(grid).GetOutput().GetPointData().GetArray(name) for name in ("n", "f")]
            theirs = run(grid, kind=vtkContourFilter).GetOutput().GetPointData().GetArray("n")
            self.assertEqual(ours[0].GetDataType(), theirs.GetDataType())
            np.testing.assert_array_equal(vtk_to_numpy(ours[0]), np.rint(vtk_to_numpy(ours[1])).astype(dtype))
            contoured = run(grid, name="n", value=40).GetOutput().GetPointData().GetArray("n")
            self.assertEqual(contoured.GetDataType(), theirs.GetDataType())
            self.assertEqual(set(vtk_to_numpy(contoured).tolist()), {40})


class Failing(unittest.TestCase):
    def test_says_what_is_wrong_with_a_grid(self):
        points, cells, field = lattice(3)
        cells[5, 2] = 99999
        for expected in (0, 100):
            contour = start(grid_of(points, cells, {"r": field}))
            contour.SetExpectedSurfaces(expected)
            contour.Update()
            self.assertIn("99999", contour.said[0])
            self.assertEqual(contour.GetOutput().GetNumberOfCells(), 0)

    def test_says_that_there_is_no_array(self):
        self.assertIn("no array", run(sphere(), name="other").said[0])

    def test_recovers_after_an_error(self):
        contour = run(sphere(), name="other")
        contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
        contour.Update()
        self.assertGreater(contour.GetOutput().GetNumberOfCells(), 0)

    def test_is_aborted_by_an_observer_of_progress(self):
        contour = start(sphere(24))
        contour.SetExpectedSurfaces(100)
        calls = []

        def stop(caller, event):
            calls.append(caller.GetProgress())
            caller.SetAbortExecute(1)

        contour.AddObserver("ProgressEvent", stop)
        contour.Update()
        self.assertGreater(len(calls), 0)
        self.assertEqual(contour.GetOutput().GetNumberOfCells(), 0)
        self.assertEqual(contour.said, [])


class Replacing(unittest.TestCase):
    def tearDown(self):
        vtkIsotetContourFilter.SetEnabled(False)
        vtkIsotetContourFilter.Clear()

    def test_is_off_unless_switched_on(self):
        make = vtkObjectFactory.CreateInstance
        self.assertFalse(vtkIsotetContourFilter.GetEnabled())
        self.assertIsNone(make("vtkContourFilter"))
        vtkIsotetContourFilter.SetEnabled(True)
        self.assertEqual(make("vtkContourFilter").GetClassName(), "vtkIsotetContourFilter")
        self.assertIsNone(make("vtkPolyData"))
        vtkIsotetContourFilter.SetEnabled(False)
        self.assertIsNone(make("vtkContourFilter"))

    def test_gives_the_surface_of_isotet(self):
        grid = sphere(12)
        contour = run(grid, kind=vtkIsotetContourFilter)
        self.assertTrue(contour.GetUsedIsotet())
        self.assertTrue(corners_of(contour.GetOutput()) == corners_of(run(grid).GetOutput()))
        self.assertEqual(contour.GetOutput().GetPointData().GetScalars().GetName(), "r")

    def test_leaves_to_vtk_what_isotet_does_not_do(self):
        source = vtkRTAnalyticSource()
        source.Update()
        flat = grid_of(*lattice(4)[:1], lattice(4)[1][:, :3], {"r": lattice(4)[2]}, kind=5)
        for data, name, value in ((source.GetOutput(), "RTData", 150), (flat, "r", 0.3)):
            ours, theirs = (run(data, name=name, value=value, kind=k) for k in (vtkIsotetContourFilter, vtkContourFilter))
            self.assertFalse(ours.GetUsedIsotet())
            self.assertEqual(ours.said, [])
            self.assertEqual(ours.GetOutput().GetNumberOfCells(), theirs.GetOutput().GetNumberOfCells())

    def test_pieces_in_double_precision_meet_without_a_word_to_each_other(self):
        whole, parts = Composite().halves()
        pieces = [corners_of(run(part, kind=vtkIsotetContourFilter).GetOutput()) for part in parts]
        vertices = {corner for piece in pieces for triangle in piece for corner in triangle}
        wanted = {c for t in corners_of(run(whole, kind=vtkIsotetContourFilter).GetOutput()) for c in t}
        self.assertTrue(vertices == wanted)


if __name__ == "__main__":
    unittest.main()
