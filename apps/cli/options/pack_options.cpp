// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

constexpr const char* pack_details = R"(
A packed file holds the grid as isotet works on it, in half the size of its arrays. Every command reads it as a grid;
extract reads only what its isovalues meet.

Examples:
  isotet pack grid.vtu grid.isotet
  isotet extract grid.isotet -f pressure -i 0.5 -o front.vtp
  isotet pack run.pvd run.isotet --all-steps --fields p,T
  isotet pack huge.vtu huge.isotet --memory 8GB --scratch /data
  isotet check grid.isotet
)";

} // namespace

void add_pack_command(const Command& program, PackCommand& pack) {
    const Command command = program.add_command("pack", "Pack a grid into a file that opens at once");
    command.add_file("FILE", pack.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("OUT", pack.out, "OUT_FILE", "The packed file: .isotet").required();
    command.add_texts(
        "--fields", [&](const std::vector<std::string>& names) { pack.fields = names; }, "FIELD[,...]",
        "The fields to pack, separated by commas; may be repeated. Default: all point fields of one or three "
        "components, or else the field that info says is shown first");
    command.add_texts(
        "--cell-fields", [&](const std::vector<std::string>& names) { pack.cell_fields = names; }, "FIELD[,...]",
        "Pack these cell fields as they are, and source cells, for --with and --color-by");
    command.add_flag("--cell-field", pack.cell_field,
                     "A name that is both a point and a cell field means the cell field");
    add_time(command, pack.grid);
    command.add_flag("--all-steps", pack.all_steps, "All time steps; they must have the same cells")
        .excludes(command.option("--time"))
        .excludes(command.option("--step"));
    command.add_flag(
        "--append", pack.append,
        "Add the time step, or all, to OUT, which has the same cells: with its fields, precision and so on");
    command.add_flag("--source-cells", pack.pack.source_cells,
                     "Keep the numbers of cells, for extract --source-cells: 4 bytes a tet, 8 another cell");
    command.add_flag("--gradients", pack.pack.gradients,
                     "Keep gradients, for --normals gradient: 4 bytes a point, a field and a step");
    command.add_flag("--split-cells", pack.pack.split_cells, "Split pyramids, wedges and hexahedra into tets first");
    command.add_choice<Precision>("--precision", pack.pack.precision,
                                  {{"float", Precision::float32}, {"double", Precision::float64}},
                                  "Precision of the packed grid");
    add_bytes(command, "--memory", pack.memory,
              "Aim for less memory than this, such as 2GB: what needs more lies in files meanwhile; default: half of "
              "what is free with --scratch, else no limit");
    command.add_file("--scratch", pack.scratch, "FOLDER", "The folder of these files; default: that of OUT");
    add_reading(command, pack.grid, "--format");
    add_common(command, pack.common);
    command.set_common({"--fields", "--all-steps", "--append", "--time", "--step", "--split-cells"});
    command.set_details(pack_details);
}

} // namespace isotet::cli
