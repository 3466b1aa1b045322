// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

constexpr const char* export_details = R"(
OUT is a page that shows isosurfaces with a slider, as isotet view does, and loads nothing. It holds the packed grid,
with the fields of -f and --color-by, or without -f all point fields; where it would be larger than --max-size, those
fields that do not fit are left out, and then values are rounded to 16 bits. Or it holds N surfaces between two
isovalues, or those of -i, at one time step or all; of the N surfaces every second, third and so on, where all would be
too large. Notes tell what was done.

Examples:
  isotet export grid.vtu grid.html -f pressure
  isotet export grid.vtu grid.html -f pressure --surfaces 200 --between 0.2,0.6 --color-by temperature
  isotet export run.pvd run.html -f pressure -i 0.5 --all-steps --max-size 50MB
)";

constexpr const char* page_details = R"(
OUT is the page of isotet view with isotet in it as WebAssembly, and no grid: files are dropped into it, or chosen, and
read in the browser. Nothing of them leaves the machine. Open it from a disk, or put it on any web server.

Examples:
  isotet page isotet.html
)";

Option add_range_of_surfaces(const Command& command, ExportCommand& exported) {
    return command.add_numbers(
        "--between", exported.between, "A,B",
        "The range of --surfaces: numbers, or shares such as 5%v or p95 (of the first step); "
        "default: that of the field",
        shares_of_ends(exported.between, exported.between_shares, "two finite numbers or shares such as 90%v or p95"));
}

} // namespace

void add_export_command(const Command& program, ExportCommand& exported) {
    const Command command = program.add_command("export", "Make a page of one file with isosurfaces and a slider");
    command.add_file("FILE", exported.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("OUT", exported.out, "OUT_FILE", "The page: .html").required();
    add_field(command, exported.field,
              "The field to contour, or an expression such as mag(U); default: the one that info says is shown first");
    const Option isovalues = add_isovalues(command, exported.isovalues, exported.shares);
    command.add_choice<view::PageContent>(
        "--as", exported.as, {{"surfaces", view::PageContent::surfaces}, {"grid", view::PageContent::grid}},
        "What is in the page: isosurfaces, or the grid, with isotet as WebAssembly: any isovalue, slices, colours by "
        "all "
        "its fields; default: the grid where it fits, but surfaces with -i, --surfaces and --between");
    command
        .add_count(
            "--surfaces", {1, 10'000}, [&](std::uint64_t n) { exported.surfaces = n; }, "N",
            "N isosurfaces evenly inside the range, at short decimals; default: 63")
        .excludes(isovalues);
    add_range_of_surfaces(command, exported).excludes(isovalues);
    command.add_text("--color-by", exported.color_by, "FIELD", "Colour by this point or cell field");
    add_bytes(
        command, "--max-size", [&exported](std::uint64_t bytes) { exported.max_size = bytes; },
        "Largest size of the file; default: 20MB");
    add_refinement(command, exported.refine);
    add_time(command, exported.grid);
    command.add_flag("--all-steps", exported.all_steps, "All time steps")
        .excludes(command.option("--time"))
        .excludes(command.option("--step"));
    add_reading(command, exported.grid, "--format");
    add_common(command, exported.common);
    command.set_common({"--field", "--isovalue", "--as", "--color-by", "--all-steps", "--max-size"});
    command.set_details(export_details);
}

void add_page_command(const Command& program, PageCommand& page) {
    const Command command = program.add_command("page", "Make a page of one file into which grids are dropped");
    command.add_file("OUT", page.out, "OUT_FILE", "The page: .html").required();
    add_common(command, page.common);
    command.set_details(page_details);
}

} // namespace isotet::cli
