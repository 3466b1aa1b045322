# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""isotet's filters and reader for ParaView, in Python: for the official binaries, which plugins in C++ cannot be built for.

Needs the package isotet in ParaView's own Python. Load this file as a plugin, on the server too (docs/paraview.md).
"""

from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from isotet.vtk import IsotetClip, IsotetContour, IsotetReader, IsotetSlice, IsotetSolid

_UPDATES = ("nothing", "field", "points", "grid")
_HINTS = '<ShowInMenu category="Common"/><Visibility replace_input="2"/>'
_INPUT = """
    <InputProperty name="Input" command="SetInputConnection">
      <ProxyGroupDomain name="groups"><Group name="sources"/><Group name="filters"/></ProxyGroupDomain>
      <DataTypeDomain name="input_type" composite_data_supported="1"><DataType value="vtkUnstructuredGrid"/></DataTypeDomain>
      {array}
      <Documentation>The grid, or the grids of a composite data set.</Documentation>
    </InputProperty>
"""
_ARRAY = '<InputArrayDomain name="scalar_array" attribute_type="point" number_of_components="1" auto_convert_association="1"/>'
_SCALARS = _INPUT.format(array=_ARRAY) + """
    <StringVectorProperty name="Scalars" command="SetInputArrayToProcess" number_of_elements="5" element_types="0 0 0 0 2"
                          animateable="0">
      <ArrayListDomain name="array_list" attribute_type="Scalars" input_domain_name="scalar_array">
        <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
      </ArrayListDomain>
      <Documentation>The point array that decides what is in the solid or clip.</Documentation>
    </StringVectorProperty>
    <DoubleVectorProperty name="Isovalues" command="SetValue" set_number_command="SetNumberOfContours" use_index="1"
                          repeat_command="1" number_of_elements="0" number_of_elements_per_command="1" animateable="1">
      <ArrayRangeDomain name="scalar_range">
        <RequiredProperties>
          <Property name="Input" function="Input"/>
          <Property name="Scalars" function="ArraySelection"/>
        </RequiredProperties>
      </ArrayRangeDomain>
      <Hints><MinimumElements count="1"/></Hints>
      <Documentation>Of solids above or below one for each; a clip above or below takes one value. Between: from the smallest to the
        largest.</Documentation>
    </DoubleVectorProperty>
    <IntVectorProperty name="Side" command="SetSide" number_of_elements="1" default_values="1" animateable="0">
      <EnumerationDomain name="enum">
        <Entry text="Above" value="1"/><Entry text="Below" value="2"/><Entry text="Between" value="3"/>
      </EnumerationDomain>
      <Documentation>Where the array is at least the isovalue, where it is less, or where it is at least the smallest and less than the
        largest isovalue.</Documentation>
    </IntVectorProperty>
"""
_TOLERANCE = """
    <DoubleVectorProperty name="Tolerance" command="SetTolerance" number_of_elements="1" default_values="0">
      <DoubleRangeDomain name="range" min="0" max="1"/>
      <Documentation>Above 0: quadratic cells are refined until the array, of slices what they carry, is within this share of its
        range of their own field; 0.001 is 0.1 %. 0: they are split at their nodes.</Documentation>
    </DoubleVectorProperty>
"""
_PRECISION = """
    <IntVectorProperty name="OutputPointsPrecision" label="Output Points Precision" command="SetOutputPointsPrecision"
                       number_of_elements="1" default_values="2" animateable="0" panel_visibility="advanced">
      <EnumerationDomain name="enum">
        <Entry text="Single" value="0"/><Entry text="Double" value="1"/><Entry text="Same as input" value="2"/>
      </EnumerationDomain>
      <Documentation>The type of the coordinates of the output. Double computes in double precision, too.</Documentation>
    </IntVectorProperty>
"""
_EXPECTED = """
    <IntVectorProperty name="ExpectedSurfaces" command="SetExpectedSurfaces" number_of_elements="1" default_values="0"
                       panel_visibility="advanced">
      <IntRangeDomain name="range" min="0"/>
      <Documentation>How many surfaces will be asked for; 0: not known.</Documentation>
    </IntVectorProperty>
"""
_THREADS = """
    <IntVectorProperty name="NumberOfThreads" label="Number Of Threads" command="SetNumberOfThreads" number_of_elements="1"
                       default_values="0" animateable="0" panel_visibility="advanced">
      <IntRangeDomain name="range" min="0"/>
      <Documentation>At most so many threads on each rank; 0: as many as the rank may use.</Documentation>
    </IntVectorProperty>
"""


@smproxy.filter(name="IsotetContour", label="Isotet Contour")
@smhint.xml(_HINTS)
@smproperty.xml(_INPUT.format(array=_ARRAY) + """
    <StringVectorProperty name="ContourBy" label="Contour By" command="SetInputArrayToProcess" number_of_elements="5"
                          element_types="0 0 0 0 2" animateable="0">
      <ArrayListDomain name="array_list" attribute_type="Scalars" input_domain_name="scalar_array">
        <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
      </ArrayListDomain>
      <Documentation>The point array whose isosurfaces are computed.</Documentation>
    </StringVectorProperty>
    <DoubleVectorProperty name="Isosurfaces" command="SetValue" set_number_command="SetNumberOfContours" use_index="1"
                          repeat_command="1" number_of_elements="0" number_of_elements_per_command="1" animateable="1">
      <ArrayRangeDomain name="scalar_range">
        <RequiredProperties>
          <Property name="Input" function="Input"/>
          <Property name="ContourBy" function="ArraySelection"/>
        </RequiredProperties>
      </ArrayRangeDomain>
      <Documentation>The values of the isosurfaces.</Documentation>
    </DoubleVectorProperty>
    <IntVectorProperty name="ComputeNormals" command="SetComputeNormals" number_of_elements="1" default_values="1">
      <BooleanDomain name="bool"/>
      <Documentation>Give each point a normal along the gradient of the array, towards higher values.</Documentation>
    </IntVectorProperty>
    <IntVectorProperty name="ComputeScalars" command="SetComputeScalars" number_of_elements="1" default_values="1">
      <BooleanDomain name="bool"/>
      <Documentation>Give each point the array that is contoured: its isovalue.</Documentation>
    </IntVectorProperty>
""" + _TOLERANCE + _PRECISION + _EXPECTED + _THREADS + """
    <IntVectorProperty name="LastUpdate" command="GetLastUpdateNumber" information_only="1" default_values="0">
      <SimpleIntInformationHelper/>
      <Documentation>What the last execution had to do before it extracted: 0 nothing, 1 store values, 2 store points, 3 take
        another grid.</Documentation>
    </IntVectorProperty>
    <IdTypeVectorProperty name="PackedBytes" command="GetPackedBytes" information_only="1" default_values="0">
      <SimpleIdTypeInformationHelper/>
      <Documentation>The memory that packed grids take, of this process.</Documentation>
    </IdTypeVectorProperty>
""")
class IsotetContourPython(IsotetContour):
    """The blocks of all ranks are contoured as one grid. States and scripts are those of the plugin in C++."""

    def __init__(self):
        super().__init__()
        self.SetController(vtkMultiProcessController.GetGlobalController())

    def GetLastUpdateNumber(self) -> int:
        return _UPDATES.index(self.GetLastUpdate())


@smproxy.filter(name="IsotetSlice", label="Isotet Slice")
@smhint.xml(_HINTS)
@smproperty.xml(_INPUT.format(array="") + """
    <ProxyProperty name="CutFunction" label="Slice Type" command="SetCutFunction">
      <ProxyGroupDomain name="groups"><Group name="implicit_functions"/></ProxyGroupDomain>
      <ProxyListDomain name="proxy_list">
        <Proxy group="implicit_functions" name="Plane"/>
        <Proxy group="implicit_functions" name="Box"/>
        <Proxy group="implicit_functions" name="Sphere"/>
        <Proxy group="implicit_functions" name="Cylinder"/>
      </ProxyListDomain>
      <Documentation>Along what is cut.</Documentation>
    </ProxyProperty>
    <DoubleVectorProperty name="InputBounds" information_only="1">
      <BoundsDomain name="bounds"><RequiredProperties><Property name="Input" function="Input"/></RequiredProperties></BoundsDomain>
      <Documentation>The bounds of the grid.</Documentation>
    </DoubleVectorProperty>
    <DoubleVectorProperty name="ContourValues" label="Slice Offset Values" command="SetValue"
                          set_number_command="SetNumberOfContours" use_index="1" repeat_command="1" number_of_elements="1"
                          number_of_elements_per_command="1" default_values="0" animateable="1" panel_visibility="advanced">
      <BoundsDomain name="bounds" mode="magnitude">
        <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
      </BoundsDomain>
      <Hints><MinimumElements count="1"/></Hints>
      <Documentation>Distances from the plane along its normal, or outwards from the surface of a sphere or cylinder: a slice for
        each.</Documentation>
    </DoubleVectorProperty>
""" + _TOLERANCE + _PRECISION + _EXPECTED + _THREADS)
class IsotetSlicePython(IsotetSlice):
    def __init__(self):
        super().__init__()
        self.SetController(vtkMultiProcessController.GetGlobalController())


@smproxy.filter(name="IsotetSolid", label="Isotet Solid")
@smhint.xml(_HINTS)
@smproperty.xml(_SCALARS + """
    <IntVectorProperty name="ComputeScalars" command="SetComputeScalars" number_of_elements="1" default_values="1">
      <BooleanDomain name="bool"/>
      <Documentation>Give each point the array that decides.</Documentation>
    </IntVectorProperty>
""" + _TOLERANCE + _PRECISION + _THREADS)
class IsotetSolidPython(IsotetSolid):
    def __init__(self):
        super().__init__()
        self.SetController(vtkMultiProcessController.GetGlobalController())


@smproxy.filter(name="IsotetClip", label="Isotet Clip")
@smhint.xml(_HINTS)
@smproperty.xml(_SCALARS + """
    <IntVectorProperty name="Polyhedra" command="SetPolyhedra" number_of_elements="1" default_values="1" animateable="0">
      <BooleanDomain name="bool"/>
      <Documentation>Cut cells of other shapes are polyhedra. Off: they are split into tetrahedra and pyramids.</Documentation>
    </IntVectorProperty>
""" + _TOLERANCE + _PRECISION + _THREADS)
class IsotetClipPython(IsotetClip):
    def __init__(self):
        super().__init__()
        self.SetController(vtkMultiProcessController.GetGlobalController())


@smproxy.reader(name="IsotetReader", label="Isotet Reader", extensions="isotet", file_description="isotet packed grid")
@smproperty.xml("""
    <StringVectorProperty name="FileName" command="SetFileName" number_of_elements="1" animateable="0">
      <FileListDomain name="files"/>
      <Documentation>The packed file.</Documentation>
    </StringVectorProperty>
    <DoubleVectorProperty name="TimestepValues" label="Timestep Values" repeatable="1" information_only="1">
      <TimeStepsInformationHelper/>
      <Documentation>The times of the file.</Documentation>
    </DoubleVectorProperty>
    <StringVectorProperty name="PointArrayInfo" command="GetPointDataArraySelection" number_of_elements_per_command="2"
                          information_only="1" si_class="vtkSIDataArraySelectionProperty">
      <Documentation>The fields of the file, and whether they are read.</Documentation>
    </StringVectorProperty>
    <StringVectorProperty name="PointArrayStatus" label="Point Arrays" command="GetPointDataArraySelection"
                          information_property="PointArrayInfo" number_of_elements_per_command="2" element_types="2 0"
                          repeat_command="1" animateable="0" si_class="vtkSIDataArraySelectionProperty">
      <ArraySelectionDomain name="array_list">
        <RequiredProperties><Property name="PointArrayInfo" function="ArrayList"/></RequiredProperties>
      </ArraySelectionDomain>
      <Documentation>Which fields are read.</Documentation>
    </StringVectorProperty>
""" + _THREADS)
class IsotetReaderPython(IsotetReader):
    def __init__(self):
        super().__init__()
