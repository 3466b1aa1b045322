// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <charconv>

#include "options/command_options.hpp"
#include "options/shape_text.hpp"

namespace isotet::cli {

namespace {

constexpr const char* clip_details = R"(
Cells with all corners in the range stay as they are. Others are cut where the isovalue crosses their edges; a piece is
a tetrahedron, pyramid, wedge or hexahedron where it has that shape, else a polyhedron, whose faces fit those of its
neighbours. --above V keeps a value of V, --below V does not.

OUT ends in .vtu or .vtk; .vtk holds no polyhedra: --no-polyhedra makes none. All fields are carried unless --with names
some; the cell field source_cell is the number of the cell in FILE. x, y and z are fields, too. With {time} or {step} in
OUT there is one file for each step, and, of .vtu files, a collection (.pvd).

Examples:
  isotet clip grid.vtu hot.vtu -f temperature --above 900
  isotet clip grid.vtu part.vtk -f density --between 0.4:0.6 --no-polyhedra
  isotet clip grid.vtu half.vtu -f x --below 0
  isotet clip run.pvd 'liquid-{step}.vtu' -f alpha --above 0.5 --all-steps
)";

void add_range(const Command& command, ClipCommand& clip) {
    const auto share = [](const std::string& text, std::optional<IsovalueShare>& end) {
        end = parse_share(text);
        return end.has_value();
    };
    const Option above = command.add_value(
        "--above",
        [&clip, share](const std::string& text) {
            clip.range = share(text, clip.shares.lower) ? SolidRange{} : SolidRange::above(parse_end("--above", text));
        },
        "V", "Keep where the field is at least V: a number, or a share such as 90%v or p95, as of isotet extract -i");
    const Option below = command.add_value(
        "--below",
        [&clip, share](const std::string& text) {
            clip.range = share(text, clip.shares.upper) ? SolidRange{} : SolidRange::below(parse_end("--below", text));
        },
        "V", "Keep where the field is below V");
    const Option between = command.add_value(
        "--between", [&clip](const std::string& text) { clip.range = parse_range("--between", text, clip.shares); },
        "A:B", "Keep where the field is at least A and below B");
    below.excludes(above);
    between.excludes(above).excludes(below);
}

} // namespace

void add_clip_command(const Command& program, ClipCommand& clip) {
    const Command command = program.add_command("clip", "Keep the cells between isovalues, cut there");
    command.add_file("FILE", clip.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("OUT", clip.out, "OUT_FILE", "The cells: .vtu or .vtk; without it only numbers are printed");
    add_field(command, clip.field,
              "The field to clip by, or an expression such as mag(U); default: the one that info says is shown first");
    add_range(command, clip);
    add_time(command, clip.grid);
    command.add_flag("--all-steps", clip.all_steps, "Every time step; OUT then needs {step} or {time}")
        .excludes(command.option("--time"))
        .excludes(command.option("--step"));
    command.add_texts(
        "--with", [&clip](const std::vector<std::string>& names) { clip.with = names; }, "FIELD[,...]",
        "Carry these fields only, separated by commas; may be repeated; an empty name carries none");
    command.add_flag("--no-polyhedra", clip.no_polyhedra,
                     "Split pieces that would be polyhedra into tetrahedra and pyramids around a point inside");
    command.add_flag("--edge-ends", clip.contour.edge_ends,
                     "Write the two grid points of each point (edge_ends) and its place between them (edge_weights)");
    command.add_flag("--split-cells", clip.contour.split_cells, "Split all cells into tetrahedra first");
    command.add_flag("--allow-empty", clip.allow_empty,
                     "Write a grid without cells where none is in the range, which else is an error, exit status 3");
    add_refinement(command, clip.contour.refine, &clip.refine_averaged);
    add_compression(command, clip.compression, ".vtu");
    command.add_choice<Precision>("--precision", clip.contour.precision,
                                  {{"float", Precision::float32}, {"double", Precision::float64}},
                                  "Precision of the points on edges, and of values there");
    add_reading(command, clip.grid, "--format");
    add_common(command, clip.common);
    command.set_common({"--field", "--above", "--below", "--between", "--all-steps", "--with"});
    command.set_details(clip_details);
}

} // namespace isotet::cli
