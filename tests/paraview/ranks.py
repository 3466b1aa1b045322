# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By mpirun and pvbatch: pieces of files on several ranks. First `write` on one process, then on any number the steps `check`,
`blocks`, `solids`, `slices`, `clips` and `error`, with the plugins that ISOTET_PLUGINS names: `plugin` (in C++) and `python`."""

import pickle

from pieces import NAME, VALUES, clip_of, data, filter_of, read_pieces, slice_of, solid_of, whole_of
from support import *
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.util.vtkConstants import VTK_MULTIBLOCK_DATA_SET

# What ParaView runs on every rank. Blocks: rank k has the blocks k, k + ranks, ...; each is a third of the grid.
BLOCKS = """
import sys
sys.path.insert(0, {folder!r})
from pieces import piece_of
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
output = self.GetOutputDataObject(0)
output.SetNumberOfBlocks(5)
for piece in range(3):
    if piece % ranks == rank:
        output.SetBlock(piece + 1, piece_of(piece))
"""
# Rank k has the pieces k, k + ranks, ... in one.
PIECES = """
import sys
sys.path.insert(0, {folder!r})
from pieces import piece_of
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
pieces = range(controller.GetLocalProcessId(), 3, controller.GetNumberOfProcesses())
if len(pieces):
    self.GetOutputDataObject(0).ShallowCopy(piece_of(*pieces))
"""
BREAK = """
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController
output = self.GetOutputDataObject(0)
output.DeepCopy(self.GetInputDataObject(0, 0))
if vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 1:
    vtk_to_numpy(output.GetCells().GetConnectivityArray())[5] = 10**9
"""
KEEP = "self.GetOutputDataObject(0).ShallowCopy(self.GetInputDataObject(0, 0))"


def written(source, kind, cells=False):
    """The surface of all ranks, or their cells, on rank 0."""
    out = os.path.join(scratch, f"surface-{kind}-{'-'.join(sys.argv[1:])}-{ranks}.{'pvtu' if cells else 'pvtp'}")
    writers = simple.servermanager.writers
    writer = writers.XMLPUnstructuredGridWriter if cells else writers.XMLPPolyDataWriter
    writer(Input=source, FileName=out, DataMode="Binary").UpdatePipeline()
    if rank > 0:
        return None
    from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader, vtkXMLPUnstructuredGridReader

    reader = vtkXMLPUnstructuredGridReader() if cells else vtkXMLPPolyDataReader()
    reader.SetFileName(out)
    reader.Update()
    return reader.GetOutput()


def places_of(data):
    """The places of points, each once: pieces have those where they meet twice."""
    return {tuple(point) for point in points_of(data)}


def is_whole(surface, value):
    if rank == 0:
        assert corners_of(surface) == whole_of(value), (len(corners_of(surface)), len(whole_of(value)))
        assert open_edges(surface) == 0


def check(kind):
    filter = filter_of(kind, read_pieces())
    for value in VALUES:
        filter.Isosurfaces = [value]
        filter.UpdatePipeline()
        is_whole(written(filter, kind), value)


def solids(kind):
    """Pieces with a layer of ghost cells give the solids of the whole."""
    filter_of(kind, read_pieces())
    # Where a rank reads several pieces, points are there twice, and ParaView makes no ghost cells.
    folder = os.path.dirname(os.path.abspath(__file__))
    source = simple.ProgrammableSource(OutputDataSetType="vtkUnstructuredGrid", Script=PIECES.format(folder=folder))
    ghosts = simple.GhostCellsGenerator(Input=source)
    for value in VALUES:
        surface = written(solid_of(ghosts, value), kind)
        if rank == 0:
            assert corners_of(surface) == whole_of(f"solid-{value}") and open_edges(surface) == 0, open_edges(surface)


def slices(kind):
    filter_of(kind, read_pieces())
    for value in VALUES:
        surface = written(slice_of(read_pieces(), value), kind)
        if rank == 0:
            assert corners_of(surface) == whole_of(f"slice-{value}") and "r" in names(surface.GetPointData())


def clips(kind):
    filter_of(kind, read_pieces())
    for value in VALUES:
        clip = written(clip_of(read_pieces(), value), kind, cells=True)
        if rank == 0:
            assert (clip.GetNumberOfCells(), places_of(clip)) == whole_of(f"clip-{value}")


def blocks(kind):
    """Each rank has other blocks, or none; the output has the same ones, and surfaces fit."""
    folder = os.path.dirname(os.path.abspath(__file__))
    source = simple.ProgrammableSource(OutputDataSetType="vtkMultiblockDataSet", Script=BLOCKS.format(folder=folder))
    filter = filter_of(kind, source)
    for value in VALUES:
        filter.Isosurfaces = [value]
        is_whole(written(simple.MergeBlocks(Input=filter, OutputDataSetType="Polygonal Mesh", MergePoints=0), kind), value)
    assert filter.GetDataInformation().DataInformation.GetCompositeDataSetType() == VTK_MULTIBLOCK_DATA_SET


def error(kind):
    """Cells of one rank are broken: no rank hangs or gives a surface, and every later surface is right."""
    said = []

    def listen(caller, event, text):
        said.append(text)

    listen.CallDataType = "string0"
    vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", listen)
    broken = simple.ProgrammableFilter(Input=read_pieces(), Script=BREAK)
    filter = filter_of(kind, broken)
    filter.Isosurfaces = [VALUES[0]]
    filter.UpdatePipeline()
    assert filter.GetDataInformation().GetNumberOfCells() == 0
    if rank == 0 and kind == "plugin":
        assert any("rank 1: " in text and "1000000000" in text for text in said), said
    broken.Script = KEEP
    is_whole(written(filter, kind), VALUES[0])


if sys.argv[1] == "write":
    import pieces

    pieces.write_pieces()
    load()
    points, cells, field = data()
    source = made(grid_of(points, cells, {"r": field}))
    for value in VALUES:
        clip = fetch(clip_of(source, value))
        wholes = {value: corners_of(fetch(contour(source, value, ComputeNormals=0))),
                  f"solid-{value}": corners_of(fetch(solid_of(source, value))),
                  f"slice-{value}": corners_of(fetch(slice_of(source, value))),
                  f"clip-{value}": (clip.GetNumberOfCells(), places_of(clip))}  # fmt: skip
        for name, whole in wholes.items():
            pickle.dump(whole, open(os.path.join(scratch, f"{NAME}-{name}"), "wb"))
else:
    for kind in os.environ["ISOTET_PLUGINS"].split():
        for step in sys.argv[1:]:
            {"check": check, "blocks": blocks, "error": error, "solids": solids, "slices": slices, "clips": clips}[step](kind)
if rank == 0:
    print("ok", ranks, flush=True)
