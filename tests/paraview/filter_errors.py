# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""By pvbatch: what the filters of the plugin that ISOTET_PLUGINS names say where they make nothing."""

from support import *
from vtkmodules.vtkCommonCore import vtkOutputWindow

load(os.environ["ISOTET_PLUGINS"])
said = []


def listen(caller, event, text):
    said.append(text)


listen.CallDataType = "string0"
vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", listen)


def fails(filter, *words):
    filter.UpdatePipeline()
    assert filter.GetDataInformation().GetNumberOfCells() == 0
    assert all(any(word in text for text in said) for word in words), (words, said)
    del said[:]


points, cells, field = lattice(4)
source = made(grid_of(points, cells, {"r": field}))
for kind, what in ((simple.IsotetSolid, "Solid"), (simple.IsotetClip, "clip")):
    fails(kind(Input=source, Scalars=["POINTS", "q"], Isovalues=[0.3]), "no point array", "'q'")
    fails(kind(Input=source, Scalars=["POINTS", "r"], Isovalues=[0.3], Side="Between"), what, "two of them")
    fails(kind(Input=source, Scalars=["POINTS", "r"], Isovalues=[float("nan")]), "nan")
fails(simple.IsotetClip(Input=source, Scalars=["POINTS", "r"], Isovalues=[0.3, 0.4]), "takes one value, but there are 2")
slice = simple.IsotetSlice(Input=source)
slice.SliceType.Normal = [0, 0, 0]
fails(slice, "normal")
broken = os.path.join(scratch, f"broken-{os.environ['ISOTET_PLUGINS']}-{os.getpid()}.isotet")
with open(broken, "wb") as file:
    file.write(b"no packed file" * 100)
fails(simple.IsotetReader(FileName=broken), broken)
fails(simple.IsotetReader(FileName=broken + ".gone"), broken + ".gone")
os.remove(broken)
print("ok")
