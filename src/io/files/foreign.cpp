// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/foreign.hpp"

#include <algorithm>
#include <cstdint>

#include "io/files/text_scanner.hpp"

namespace isotet::io {

namespace {

using namespace std::string_view_literals;

/// `extensions`   separated by blanks; empty: any
/// `begins`       behind blanks and line ends; empty: anything
/// `looks`        of the head; null: as anything
struct Foreign {
    std::string_view extensions, begins, is;
    bool (*looks)(std::string_view head) = nullptr;

    bool tells_by_content() const { return !begins.empty() || looks; }
};

bool has(std::string_view head, std::string_view text) { return head.find(text) != std::string_view::npos; }

constexpr std::string_view hdf5 = "\x89HDF";

bool looks_like_salome(std::string_view head) { return has(head, "STUDY_STRUCTURE") && !has(head, "VTKHDF"); }
bool looks_like_fluent_hdf5(std::string_view head) {
    return has(head, "settings\0"sv) && (has(head, "meshes\0"sv) || has(head, "results\0"sv));
}
bool looks_like_silo(std::string_view head) { return has(head, "_silolibinfo"); }
/// New versions write comments before it.
bool looks_like_netgen(std::string_view head) { return TextScanner(head, '#').word() == "mesh3d"; }
bool looks_like_ugrid(std::string_view head) { return has(head, "UGRID"); }

/// The numbers of vertices, triangles and edges, then a vertex: coordinates in 2D or 3D and a label.
bool looks_like_freefem(std::string_view head) {
    TextScanner text(head);
    std::uint64_t count = 0;
    double number = 0;
    for (int i = 0; i < 3; ++i)
        if (!text.number_of_line(count)) return false;
    if (!text.at_line_end()) return false;
    text.next_line();
    for (int i = 0; i < 3; ++i)
        if (!text.number_of_line(number)) return false;
    return true;
}

/// A record of Fortran: the name, length and type of an array.
bool looks_like_eclipse(std::string_view head) {
    static constexpr std::string_view types[] = {"INTE", "REAL", "DOUB", "CHAR", "LOGI", "MESS", "C0"};
    return head.size() >= 24 &&
           std::ranges::any_of(types, [&](std::string_view type) { return head.substr(16).starts_with(type); });
}

/// Binary, or text: the number of blocks, their points along each axis, coordinates. In a molecule a title is second.
bool looks_like_plot3d(std::string_view head) {
    constexpr std::size_t two_integers = 8;
    if (has(head.substr(0, two_integers), "\0"sv)) return true;
    TextScanner text(head);
    std::uint64_t blocks = 0, points = 0;
    double coordinate = 0;
    if (!text.number_of_line(blocks) || !text.at_line_end()) return false;
    for (int i = 0; i < 3; ++i)
        if (!text.number(points) || points == 0) return false;
    return text.number(coordinate);
}

constexpr Foreign foreign[] = {
    {"", "MFEM mesh", "is MFEM's own mesh, which is not read: MFEM's ParaViewDataCollection writes VTU"},
    {"", "MFEM NURBS mesh", "is MFEM's own mesh, which is not read: MFEM's ParaViewDataCollection writes VTU"},
    {".vol", "", "is Netgen's own mesh, which is not read: meshio or Netgen's export make a VTU or MSH of it",
     looks_like_netgen},
    {".inp", "*", "is an input file of Abaqus or CalculiX, which is not read: meshio or ccx2paraview make a VTU of it"},
    {".unv", "", "is an I-deas universal file, which is not read: gmsh -save -format msh41 converts the mesh"},
    {".odb", "", "is an output database of Abaqus, which is not read: Abaqus itself and odb2vtk export it"},
    {".bdf .nas .fem", "",
     "is a Nastran file, which is not read: meshio (meshio convert IN OUT.vtu) makes a VTU of it"},
    {".op2", "", "is a result file of Nastran, which is not read: pyNastran exports it"},
    {".rst .rth .cdb", "", "is a file of Ansys, which is not read: PyMAPDL and pymapdl-reader save it as VTU"},
    {".msh", "(", "is a mesh of Fluent, which is not read: meshio and OpenFOAM's fluentMeshToFoam convert it"},
    {".msh", "", "is a mesh of FreeFem, which is not read: FreeFem's savemesh (.mesh) and savevtk write what is",
     looks_like_freefem},
    {".msh", "MESH", "is a mesh of GiD, which is not read: GiD's Gmsh and VTK exports write what is"},
    {".msh", "*", "is a mesh of CalculiX (cgx), which is not read: meshio converts it (--input-format abaqus)"},
    {".h5", hdf5, "is an HDF5 file of Fluent, which is not read: ParaView's Fluent CFF reader saves it as VTU",
     looks_like_fluent_hdf5},
    {"", hdf5, "is a study of Salome: its Mesh module exports the meshes in it as MED", looks_like_salome},
    {"", hdf5, "is a Silo file, which is not read: VisIt exports it as VTK", looks_like_silo},
    {"", "<<PDB:", "is a Silo file, which is not read: VisIt exports it as VTK"},
    {"", "!<<PDB:", "is a Silo file, which is not read: VisIt exports it as VTK"},
    {".silo", "", "is a Silo file, which is not read: VisIt exports it as VTK"},
    {"", "\0\0\0\x10"sv,
     "is a binary file of Eclipse, which is not read: xtgeo writes the grid and its properties as GRDECL",
     looks_like_eclipse},
    {".egrid .fegrid .unrst .funrst .init .finit", "",
     "is a file of Eclipse, which is not read: xtgeo writes the grid and its properties as GRDECL"},
    {"", "CONTROL INFO", "is a neutral file of Gambit, which is not read: ParaView's Gambit reader saves it as VTU"},
    {".neu", "", "is a neutral file of Gambit, which is not read: ParaView's Gambit reader saves it as VTU"},
    {"", "CDF", "is a NetCDF file of 2D cells (UGRID), which is not read: ParaView's UGRID reader saves it as VTU",
     looks_like_ugrid},
    {".ugrid", "", "is a mesh of AFLR3, which is not read: meshio converts it"},
    {".p3d .xyz .x .q", "", "is a PLOT3D file, which is not read: ParaView's PLOT3D reader saves it as VTS",
     looks_like_plot3d},
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
    {".off", "", "is a surface in OFF, which is not read: meshio and trimesh make a PLY of it"},
    {".stl .obj .ply .vtp .ts .3mf", "",
     "is a surface: isotet render and isotet check take it, but it has no cells with a volume"},
    {".h5m", hdf5, "is a mesh of MOAB, which is not read: its mbconvert makes a VTK file of it"},
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

/// Of files that are none of these.
constexpr Foreign containers[] = {
    {"", hdf5,
     "is an HDF5 file, but neither VTKHDF, CGNS, MED nor Exodus II: give the XDMF file (.xdmf) that describes it, if "
     "there is one"},
    {"", "CDF", "is a NetCDF file, but not Exodus II"},
};

bool lists(std::string_view extensions, std::string_view extension) {
    while (!extensions.empty()) {
        const std::size_t end = std::min(extensions.find(' '), extensions.size());
        if (extensions.substr(0, end) == extension) return true;
        extensions.remove_prefix(std::min(end + 1, extensions.size()));
    }
    return false;
}

bool fits(const Foreign& file, std::string_view head, std::string_view extension) {
    return (file.extensions.empty() || lists(file.extensions, extension)) && head.starts_with(file.begins) &&
           (!file.looks || file.looks(head));
}

std::string_view behind_blanks(std::string_view head) {
    return head.substr(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
}

} // namespace

std::string_view foreign_file(std::string_view head, std::string_view extension) {
    head = behind_blanks(head);
    for (const Foreign& file : foreign)
        if (fits(file, head, extension)) return file.is;
    for (const Foreign& file : containers)
        if (fits(file, head, extension)) return file.is;
    return {};
}

std::string_view foreign_content(std::string_view head, std::string_view extension) {
    head = behind_blanks(head);
    for (const Foreign& file : foreign)
        if (file.tells_by_content() && fits(file, head, extension)) return file.is;
    return {};
}

} // namespace isotet::io
