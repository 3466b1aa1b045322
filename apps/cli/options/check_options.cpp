// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

constexpr const char* check_details = R"(
Fails (exit status 1) if the surface has: an edge that is used unequally often in the two directions where it must
not be; a triangle with two equal corners; a triangle that occurs twice in the same direction.

Where edges must be used equally often: with --closed everywhere; with --grid everywhere except on edges whose grid
points all lie in one boundary face of the tets that have a value at each point; with neither they are only counted.
--grid needs the point array edge_ends, which isotet extract --edge-ends writes into .vtp and .vtk, and excuses a
repeated triangle on a face with two tets on one side.

Where quadratic cells were refined for the surface, their points are derived again, as the file's field data
isotet:refinement say, or -i (all isovalues of that isotet extract) and the tolerances. Of several time steps that of
the field data isotet:time counts, else the one that isotet extract takes. Give the same --hanging-points as then: edges
at hanging points fail, where the face of a larger cell meets smaller ones (of curved cells, which are not closed there,
all open edges). With --hanging-points leave they are excused.

With --strict it also fails for: triangles of zero area, edges with more than two triangles, double sheets (two
triangles on the same corners in opposite directions), touching vertices (triangles that are not one fan), coincident
vertices.

The vertices of STL, and of several files (the pieces of isotet extract --piece), are merged first: those on one edge
of the grid (edge_ends), else those of equal coordinates. Triangles that collapse by that are counted, and no defect.
)";

} // namespace

void add_check_command(const Command& program, CheckCommand& check) {
    const Command command = program.add_command("check", "Measure a surface and check it for defects");
    command
        .add_texts(
            "SURFACE",
            [&](const std::vector<std::string>& names) {
                for (const std::string& name : names)
                    if (name.empty()) refuse_value("SURFACE", name, "the name of a file");
                check.surface = names.front();
                check.more.assign(names.begin() + 1, names.end());
            },
            "SURFACE_FILE", "A surface: .vtp, .ply, .stl, .obj, .vtk or .ts; or its pieces, one after another")
        .required();
    command.add_flag("--closed", check.closed, "Report every edge that is used unequally often in the two directions");
    const Option grid = command.add_file("--grid", check.grid.file, "FILE",
                                         "Report such edges unless they lie in one boundary face of this grid");
    add_field(command, check.field, "The field that was contoured: cells without a value do not count").needs(grid);
    command.option("--cell-field").needs(grid);
    add_time(command, check.grid);
    command.add_flag("--split-cells", check.contour.split_cells, "The surface was made with --split-cells").needs(grid);
    add_isovalues(command, check.isovalues, check.shares).needs(grid);
    add_refinement(command, check.contour.refine, &check.refine_averaged);
    for (const char* name : {"--tolerance", "--distance", "--geometry-tolerance"}) command.option(name).needs(grid);
    command.add_flag("--strict", check.strict,
                     "Fail also for flat triangles, touching vertices and the like (--help-all)");
    command.add_text("--format", check.format, "FORMAT", "Format of the surface; default: the name decides");
    add_reading(command, check.grid, "--grid-format");
    for (const char* name :
         {"--time", "--step", "--grid-format", "--displace", "--merge-points", "--hanging-points", "--keep-pieces"}) {
        command.option(name).needs(grid);
    }
    add_common(command, check.common);
    command.set_common({"--closed", "--grid", "--field", "--isovalue", "--strict", "--json"});
    command.set_details(check_details);
}

} // namespace isotet::cli
