// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/foreign.hpp"

#include <algorithm>

namespace isotet::io {

namespace {

/// `extensions`   separated by blanks; empty: any
/// `begins`       behind blanks and line ends; empty: anything
struct Foreign {
    std::string_view extensions, begins, is;
};

constexpr Foreign foreign[] = {
    {"", "MFEM mesh", "is MFEM's own mesh, which is not read: MFEM's ParaViewDataCollection writes VTU"},
    {"", "MFEM NURBS mesh", "is MFEM's own mesh, which is not read: MFEM's ParaViewDataCollection writes VTU"},
    {".vol", "mesh3d", "is Netgen's own mesh, which is not read: meshio or Netgen's export make a VTU or MSH of it"},
    {".inp", "*", "is an input file of Abaqus or CalculiX, which is not read: meshio or ccx2paraview make a VTU of it"},
    {".unv", "", "is an I-deas universal file, which is not read: gmsh -save -format msh41 converts the mesh"},
    {".odb", "", "is an output database of Abaqus, which is not read: Abaqus itself and odb2vtk export it"},
    {".bdf .nas .fem", "",
     "is a Nastran file, which is not read: meshio (meshio convert IN OUT.vtu) makes a VTU of it"},
    {".op2", "", "is a result file of Nastran, which is not read: pyNastran exports it"},
    {".rst .rth .cdb", "", "is a file of Ansys, which is not read: PyMAPDL and pymapdl-reader save it as VTU"},
    {".msh", "(", "is a mesh of Fluent, which is not read: ParaView and meshio convert it"},
    {".cas", "", "is a file of Fluent, which is not read: ParaView and Fluent's EnSight export convert it"},
    {"", "#!TDV", "is a Tecplot file, which is not read: ParaView and meshio (text files) convert it to VTU"},
    {".plt .szplt .tec", "",
     "is a Tecplot file, which is not read: ParaView and meshio (text files) convert it to VTU"},
    {".dat", "TITLE", "is a Tecplot file, which is not read: ParaView and meshio convert it to VTU"},
    {".dat", "VARIABLES", "is a Tecplot file, which is not read: ParaView and meshio convert it to VTU"},
    {".su2", "",
     "is a mesh of SU2, which is not read: SU2 writes Paraview files (OUTPUT_FILES), meshio converts the mesh"},
    {".pos", "", "is a view of Gmsh, which is not read: gmsh saves it as MSH (File, Export, or View.Format)"},
    {".geo .step .stp .iges .igs .brep", "", "is a geometry without cells: gmsh -3 makes a mesh of it"},
    {".bp", "", "is an ADIOS2 file, which is not read: ParaView's ADIOS2 readers convert it"},
    {".vth .vthb", "", "is a grid of AMR levels, which is not read: ParaView's Append Datasets saves it as VTU"},
    {".stl .obj .ply .off .vtp .ts", "",
     "is a surface: isotet render and isotet check take it, but it has no cells with a volume"},
    {".h5m", "\x89HDF", "is a mesh of MOAB, which is not read: its mbconvert makes a VTK file of it"},
    {"", "\x89HDF",
     "is an HDF5 file, but neither VTKHDF, CGNS, MED nor Exodus II: give the XDMF file (.xdmf) that describes it"},
    {"", "\x89PNG", "is a picture"},
    {"", "%PDF", "is a PDF document"},
    {"", "* FLAC3D", "is a grid of FLAC3D, which is not read: meshio converts it"},
    {".f3grid", "", "is a grid of FLAC3D, which is not read: meshio converts it"},
    {"", "!PERMAS", "is a mesh of PERMAS, which is not read: meshio converts it"},
    {".xml", "<dolfin", "is a mesh of DOLFIN's old format, which is not read: meshio converts it"},
    {".k .key .dyn", "", "is an input file of LS-DYNA, which is not read: LS-PrePost and meshio convert it"},
    {".d3plot", "", "is a result file of LS-DYNA, which is not read: LS-PrePost and ParaView convert it"},
    {".csv .tsv .xlsx", "", "is a table without cells"},
};

bool lists(std::string_view extensions, std::string_view extension) {
    while (!extensions.empty()) {
        const std::size_t end = std::min(extensions.find(' '), extensions.size());
        if (extensions.substr(0, end) == extension) return true;
        extensions.remove_prefix(std::min(end + 1, extensions.size()));
    }
    return false;
}

} // namespace

std::string_view foreign_file(std::string_view head, std::string_view extension) {
    head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
    for (const Foreign& file : foreign)
        if ((file.extensions.empty() || lists(file.extensions, extension)) && head.starts_with(file.begins))
            return file.is;
    return {};
}

} // namespace isotet::io
