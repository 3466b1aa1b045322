# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Isotet Contour for ParaView, in Python: for the official binaries, which plugins in C++ cannot be built for.

Needs the package isotet in ParaView's own Python. Load this file as a plugin, on the server too (docs/paraview.md).
"""

from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from isotet.vtk import IsotetContour

_UPDATES = ("nothing", "field", "points", "grid")


@smproxy.filter(name="IsotetContour", label="Isotet Contour")
@smhint.xml('<ShowInMenu category="Common"/><Visibility replace_input="2"/>')
@smproperty.xml("""
    <InputProperty name="Input" command="SetInputConnection">
      <ProxyGroupDomain name="groups"><Group name="sources"/><Group name="filters"/></ProxyGroupDomain>
      <DataTypeDomain name="input_type" composite_data_supported="1"><DataType value="vtkUnstructuredGrid"/></DataTypeDomain>
      <InputArrayDomain name="scalar_array" attribute_type="point" number_of_components="1" auto_convert_association="1"/>
      <Documentation>The grid, or the grids of a composite data set, which are contoured as one.</Documentation>
    </InputProperty>
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
    <DoubleVectorProperty name="Tolerance" command="SetTolerance" number_of_elements="1" default_values="0">
      <DoubleRangeDomain name="range" min="0" max="1"/>
      <Documentation>Above 0: quadratic cells are refined until the array is within this share of its range of their own field;
        0.001 is 0.1 %. 0: they are split at their nodes.</Documentation>
    </DoubleVectorProperty>
    <IntVectorProperty name="OutputPointsPrecision" label="Output Points Precision" command="SetOutputPointsPrecision"
                       number_of_elements="1" default_values="2" animateable="0" panel_visibility="advanced">
      <EnumerationDomain name="enum">
        <Entry text="Single" value="0"/><Entry text="Double" value="1"/><Entry text="Same as input" value="2"/>
      </EnumerationDomain>
      <Documentation>The type of the coordinates of the output. Double computes in double precision, too.</Documentation>
    </IntVectorProperty>
    <IntVectorProperty name="ExpectedSurfaces" command="SetExpectedSurfaces" number_of_elements="1" default_values="0"
                       panel_visibility="advanced">
      <IntRangeDomain name="range" min="0"/>
      <Documentation>How many surfaces will be asked for; 0: not known.</Documentation>
    </IntVectorProperty>
    <IntVectorProperty name="NumberOfThreads" label="Number Of Threads" command="SetNumberOfThreads" number_of_elements="1"
                       default_values="0" animateable="0" panel_visibility="advanced">
      <IntRangeDomain name="range" min="0"/>
      <Documentation>At most so many threads on each rank; 0: as many as the rank may use.</Documentation>
    </IntVectorProperty>
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
