# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# pip: medcoupling==9.15.0
# files: *.med *.vtu
"""MEDCoupling, of Salome: steps of fields at nodes, in cells and at nodes of cells, groups, profiles."""
import medcoupling as mc
from MEDLoader import MEDFileField1TS, MEDFileUMesh, WriteFieldUsingAlreadyWrittenMesh, WriteUMesh


def cube(tets, quadratic=False):
    side = mc.DataArrayDouble([i / 4 for i in range(5)])
    grid = mc.MEDCouplingCMesh()
    grid.setCoords(side, side, side)
    mesh = grid.buildUnstructured()
    if tets:
        mesh = mesh.tetrahedrize(mc.PLANAR_FACE_6)[0].buildUnstructured()
    if quadratic:
        mesh.convertLinearCellsToQuadratic(0)
    mesh.setName("a cube")
    mesh.sortCellsInMEDFileFrmt()
    return mesh


def polyhedra():
    mesh = cube(False)
    mesh.convertToPolyTypes(list(range(0, mesh.getNumberOfCells(), 3)))
    mesh.orientCorrectlyPolyhedrons()
    mesh.sortCellsInMEDFileFrmt()
    return mesh


def values(mesh, kind, name, time=0.0):
    """Cells have their numbers: MEDCoupling has no centres of curved ones."""
    field = mesh.fillFromAnalytic(mc.ON_NODES, 1, f"sin(3*x)+cos(2*y)*z+{time}")
    if kind == mc.ON_CELLS:
        field = mc.MEDCouplingFieldDouble(kind, mc.ONE_TIME)
        field.setMesh(mesh)
        field.setArray(mc.DataArrayDouble([number + time for number in range(mesh.getNumberOfCells())]))
    field.setName(name)
    field.setTime(time, int(10 * time), -1)
    return field


def values_at_nodes_of_cells(mesh):
    at_nodes = values(mesh, mc.ON_NODES, "").getArray()
    corners = mesh.getNodalConnectivity().deepCopy().toNumPyArray().reshape(mesh.getNumberOfCells(), -1)[:, 1:]
    field = mc.MEDCouplingFieldDouble(mc.ON_GAUSS_NE, mc.ONE_TIME)
    field.setMesh(mesh)
    field.setName("at corners")
    field.setTime(0.0, 0, -1)
    field.setArray(mc.DataArrayDouble(at_nodes.toNumPyArray()[corners.ravel()].copy()))
    return field


def write_group_and_profile(file_name):
    mesh = cube(True)
    file = MEDFileUMesh()
    file[0] = mesh
    half = mc.DataArrayInt.Range(0, mesh.getNumberOfCells() // 2, 1)
    half.setName("first half")
    file.setGroupsAtLevel(0, [half])
    file.write(file_name, 2)
    half.setName("profile")
    part = MEDFileField1TS()
    part.setFieldProfile(values(mesh[half], mc.ON_CELLS, "part"), file, 0, half)
    part.write(file_name, 0)


meshes = {"tet": cube(True), "hex": cube(False), "tet10": cube(True, True), "hex20": cube(False, True),
          "poly": polyhedra()}
for form, mesh in meshes.items():
    WriteUMesh(f"{form}.med", mesh, True)
    for time in (0.0, 0.1, 0.2):
        WriteFieldUsingAlreadyWrittenMesh(f"{form}.med", values(mesh, mc.ON_NODES, "u", time))
        WriteFieldUsingAlreadyWrittenMesh(f"{form}.med", values(mesh, mc.ON_CELLS, "k", time))
    values(mesh, mc.ON_NODES, "u").writeVTK(f"{form}.vtu", False)
WriteUMesh("corners.med", meshes["tet"], True)
WriteFieldUsingAlreadyWrittenMesh("corners.med", values_at_nodes_of_cells(meshes["tet"]))
write_group_and_profile("groups.med")
