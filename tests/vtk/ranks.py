# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Run by mpirun: the surfaces of ranks against that of the whole. The first argument is what to do."""

import sys

import numpy as np
from isotet_vtk.vtkIsotet import vtkIsotetContour
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkParallelMPI import vtkMPIController
from mpi4py import MPI

from grids import HEXAHEDRON, TETS, add, corners_of, grid_of, lattice, points_of

controller = vtkMPIController()
controller.Initialize()
vtkMultiProcessController.SetGlobalController(controller)
world = MPI.COMM_WORLD
rank, ranks = world.Get_rank(), world.Get_size()


def piece_of(points, cells, field, owner, ids=True, ghosts=False):
    """The cells of this rank, points in another order on every rank, with a layer of ghost cells."""
    mine = owner == rank
    taken = mine
    if ghosts:
        used = np.zeros(len(points), bool)
        used[cells[mine]] = True
        taken = used[cells].any(axis=1)
    used, local = np.unique(cells[taken], return_inverse=True)
    order = np.random.default_rng(rank).permutation(len(used))
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    used = used[order]
    marks = (~mine[taken]).astype(np.uint8) if ghosts else None
    return grid_of(points[used], place[local].reshape(-1, cells.shape[1]), {"r": field[used], "t": 2 * field[used]},
                   ids=used if ids else None, ghosts=marks)  # fmt: skip


def contour_of(grid, **options):
    contour = vtkIsotetContour()
    contour.said = []
    for event in ("ErrorEvent", "WarningEvent"):
        contour.AddObserver(event, Listener(contour.said))
    contour.SetInputDataObject(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    contour.SetValue(0, 0.3)
    for name, value in options.items():
        getattr(contour, "Set" + name)(value)
    contour.Update()
    return contour


class Listener:
    CallDataType = "string0"

    def __init__(self, said):
        self.said = said

    def __call__(self, caller, event, text=""):
        self.said.append(text)


def whole_of(*arrays, **options):
    """On one rank alone."""
    contour = vtkIsotetContour()
    contour.SetController(None)
    contour.SetInputDataObject(grid_of(arrays[0], arrays[1], {"r": arrays[2], "t": 2 * arrays[2]}))
    contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    contour.SetValue(0, 0.3)
    for name, value in options.items():
        getattr(contour, "Set" + name)(value)
    contour.Update()
    return contour.GetOutput()


def union(surface):
    return set().union(*world.allgather(corners_of(surface)))


def owners(count, empty):
    """Random cells for all ranks but `empty`."""
    owner = np.random.default_rng(7).integers(0, ranks, count)
    owner[owner == empty] = (empty + 1) % ranks
    return owner


def fit():
    """Bit for bit the surface of the whole, whatever the types; with an empty rank; over isovalues and time steps."""
    for shape in (TETS, HEXAHEDRON):
        for dtype, origin in ((np.float32, 0), (np.float64, 5e5)):
            points, cells, field = lattice(7, shape, dtype, origin)
            owner = owners(len(cells), empty=ranks - 1 if ranks > 2 else -1)
            for expected in (0, 100):
                contour = contour_of(piece_of(points, cells, field, owner), ExpectedSurfaces=expected, ComputeNormals=0)
                assert contour.said == [], contour.said
                assert union(contour.GetOutput()) == corners_of(whole_of(points, cells, field, ComputeNormals=0))
                contour.SetValue(0, 0.33)
                contour.Update()
                assert union(contour.GetOutput()) == corners_of(whole_at(points, cells, field, 0.33))
                contour.SetInputDataObject(piece_of(points, cells, field * 1.1, owner))  # a time step
                contour.Update()
                assert union(contour.GetOutput()) == corners_of(whole_at(points, cells, field * 1.1, 0.33))


def whole_at(points, cells, field, value):
    contour = vtkIsotetContour()
    contour.SetController(None)
    contour.SetComputeNormals(0)
    contour.SetInputDataObject(grid_of(points, cells, {"r": field}))
    contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    contour.SetValue(0, value)
    contour.Update()
    return contour.GetOutput()


def without_ids():
    """The vertices are those of the whole."""
    points, cells, field = lattice(7, HEXAHEDRON, np.float64, 5e5)
    contour = contour_of(piece_of(points, cells, field, owners(len(cells), -1), ids=False))
    vertices = {tuple(p) for part in world.allgather(points_of(contour.GetOutput()).tolist()) for p in part}
    assert vertices == {tuple(p) for p in points_of(whole_of(points, cells, field)).tolist()}


def normals():
    """With a layer of ghost cells, normals are those of the whole."""
    points, cells, field = lattice(7)
    out = contour_of(piece_of(points, cells, field, owners(len(cells), -1), ghosts=True)).GetOutput()
    mine = [(tuple(p), tuple(n)) for p, n in zip(points_of(out).tolist(), vtk_to_numpy(out.GetPointData().GetNormals()).tolist())]
    found = {}
    for part in world.allgather(mine):
        for point, normal in part:
            assert found.setdefault(point, normal) == normal, "another normal on another rank"
    whole = whole_of(points, cells, field)
    wanted = vtk_to_numpy(whole.GetPointData().GetNormals())
    assert len(found) == len(wanted)
    for point, normal in zip(points_of(whole).tolist(), wanted):
        assert np.dot(found[tuple(point)], normal) > 0.9999


def errors():
    """An error on one rank is one on all; afterwards all go on."""
    points, cells, field = lattice(5)
    owner = owners(len(cells), -1)
    bad = piece_of(points, cells, field, owner)
    if rank == 1:
        vtk_to_numpy(bad.GetCells().GetConnectivityArray())[5] = 10**9
    contour = contour_of(bad)
    assert len(contour.said) == 1 and "rank 1" in contour.said[0] and "1000000000" in contour.said[0], contour.said
    assert contour.GetOutput().GetNumberOfCells() == 0
    good = piece_of(points, cells, field, owner)
    contour.SetInputDataObject(good)
    contour.Update()
    assert union(contour.GetOutput()) == corners_of(whole_of(points, cells, field))
    if rank == 0:
        good.GetPointData().GetArray("r").SetName("other")
        good.Modified()
    contour.SetValue(0, 0.31)
    contour.Update()
    assert "rank 0: there is no array" in contour.said[-1], contour.said


def missing():
    """Composite data of which no rank has the array: an error on all. One rank with it is enough."""
    points, cells, field = lattice(4)
    piece = piece_of(points, cells, field, owners(len(cells), -1))
    for holder in (-1, ranks - 1):
        blocks = vtkMultiBlockDataSet()
        blocks.SetBlock(0, grid_of(points, cells, {"other": field}))
        if rank == holder:
            blocks.SetBlock(1, piece)
        contour = contour_of(blocks)
        if holder < 0:
            assert len(contour.said) == 1 and "no point array is called 'r'" in contour.said[0], contour.said
        else:
            assert contour.said == [] and (rank != holder or contour.GetOutputDataObject(0).GetBlock(1).GetNumberOfCells() > 0)


def other_arrays():
    """Arrays that only one rank has do not stop the others."""
    points, cells, field = lattice(5)
    piece = piece_of(points, cells, field, owners(len(cells), -1))
    if rank == 0:
        add(piece.GetPointData(), "only here", np.zeros(piece.GetNumberOfPoints()))
    contour = contour_of(piece)
    assert contour.said == []
    assert union(contour.GetOutput()) == corners_of(whole_of(points, cells, field))


def nothing():
    """No rank has a cell."""
    points, cells, field = lattice(2)
    contour = contour_of(piece_of(points, cells, field, np.full(len(cells), -1)))
    assert contour.said == [] and contour.GetOutput().GetNumberOfCells() == 0


for name in sys.argv[1:]:
    globals()[name]()
    if rank == 0:
        print("ok", name, flush=True)
