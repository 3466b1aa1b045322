# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""vtkIsotetContour against VTK's filters in one pipeline: a moving isovalue, what the filter adds to the library, memory.

    PYTHONPATH=build/dev/lib/isotet-python /usr/bin/python3 bench/vtk/filter.py [--million-tets 5] [--repeats 15] [--threads 2]
    mpirun -np 2 --bind-to core /usr/bin/python3 bench/vtk/filter.py --threads 1 --ranks

Prints medians in milliseconds, with the smallest and largest.
"""

import argparse
import os
import sys
import time

import numpy as np

parser = argparse.ArgumentParser()
parser.add_argument("--million-tets", type=float, default=5)
parser.add_argument("--repeats", type=int, default=15)
parser.add_argument("--threads", type=int, default=2)
parser.add_argument("--ranks", action="store_true", help="each rank has a slab of the grid; only isotet is measured")
parser.add_argument("--slow", action="store_true", help="vtkContourFilter, too")
options = parser.parse_args()
os.environ["VTK_SMP_MAX_THREADS"] = str(options.threads)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "vtk"))
from grids import area_of, grid_of, lattice  # noqa: E402
from isotet_vtk.vtkIsotet import vtkIsotetContour  # noqa: E402
from vtkmodules.vtkFiltersCore import vtkContour3DLinearGrid, vtkContourFilter  # noqa: E402

rank, ranks, world = 0, 1, None
if options.ranks:
    from mpi4py import MPI
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    from vtkmodules.vtkParallelMPI import vtkMPIController

    controller = vtkMPIController()
    controller.Initialize()
    vtkMultiProcessController.SetGlobalController(controller)
    world = MPI.COMM_WORLD
    rank, ranks = world.Get_rank(), world.Get_size()


def resident():
    """Bytes of memory that are this process's own."""
    with open("/proc/self/statm") as file:
        return (int(file.read().split()[1])) * os.sysconf("SC_PAGE_SIZE")


def trim():
    import ctypes

    ctypes.CDLL(None).malloc_trim(0)


def say(*words):
    if rank == 0:
        print(*words, flush=True)


def made():
    n = round((options.million_tets * 1e6 / 6) ** (1 / 3))
    points, cells, field = lattice(n)
    if ranks > 1:
        share = len(cells) // ranks
        used, local = np.unique(cells[rank * share : (rank + 1) * share if rank + 1 < ranks else None], return_inverse=True)
        return grid_of(points[used], local.reshape(-1, 4), {"r": field[used]})
    return grid_of(points, cells, {"r": field})


def medians(times):
    times = 1e3 * np.array(times)
    return f"{np.median(times):8.2f} ms ({times.min():.2f} to {times.max():.2f})"


def values(count):
    return np.linspace(0.30, 0.42, count)


def time_of(contour):
    if world:
        world.Barrier()
    start = time.perf_counter()
    contour.Update()
    took = time.perf_counter() - start
    return world.allreduce(took, op=MPI.MAX) if world else took


def measure_vtk(grid, kind):
    contour = kind()
    if kind is vtkContour3DLinearGrid:
        contour.MergePointsOn()
        contour.SetComputeNormals(0)
        contour.SetInterpolateAttributes(0)
    else:
        contour.SetComputeNormals(0)
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    times = []
    for value in values(options.repeats):
        contour.SetValue(0, value)
        times.append(time_of(contour))
    area = area_of(contour.GetOutputDataObject(0))
    say(f"{kind.__name__:24s} {medians(times)}   area of the last {area:.6f}")
    return np.median(times)


def main():
    grid = made()
    say(f"{grid.GetNumberOfCells() / 1e6:.2f} million tets a rank, {ranks} ranks, {options.threads} threads a rank, {options.repeats} isovalues")
    rivals = [] if options.ranks else [vtkContour3DLinearGrid] + ([vtkContourFilter] if options.slow else [])
    rival_times = {kind: measure_vtk(grid, kind) for kind in rivals}

    trim()
    before = resident()
    contour = vtkIsotetContour()
    contour.SetComputeNormals(0)
    contour.SetExpectedSurfaces(1000)
    contour.SetNumberOfThreads(options.threads)
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "r")
    contour.SetValue(0, 0.25)
    say(f"first surface, packing        {1e3 * time_of(contour):8.2f} ms")
    times, added = [], []
    for value in values(options.repeats):
        contour.SetValue(0, value)
        times.append(time_of(contour))
        added.append(times[-1] - contour.GetExtractSeconds())
        assert contour.GetLastUpdate() == 0 and contour.GetUsedPackedGrids()
    out = contour.GetOutput()
    say(f"{'vtkIsotetContour':24s} {medians(times)}   area of the last {area_of(out):.6f}, {out.GetNumberOfPolys()} triangles")
    say(f"{'  of it not extraction':24s} {medians(added)}")
    for kind, took in rival_times.items():
        say(f"{took / np.median(times):.1f} times the speed of {kind.__name__}")
    trim()
    surface = 1024 * out.GetActualMemorySize()
    over = resident() - before - contour.GetPackedBytes() - surface
    say(f"memory: packed {contour.GetPackedBytes() / 1e6:.1f} MB, surface {surface / 1e6:.1f} MB, beside them {over / 1e6:.1f} MB")


main()
