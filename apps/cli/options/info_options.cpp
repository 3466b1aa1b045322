// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

constexpr const char* info_details = R"(
A field's range is that of its finite values; no data is the number of NaN. Inverted tets are those whose sign is not
that of most. --survey counts repeated tets (with the corners of an earlier one), duplicate points (at the place of
another) and boundary faces (which the tets do not use equally often in both directions).

Several files are time steps where their names differ in numbers alone; others are told one by one.

Shown first is what isotet render, view and extract take where no field is named: the array that the file marks as its
scalars; else one with a name that people contour, such as temperature, velocity or pressure; else the one that varies
most. Where isosurfaces would say little, the boundary is drawn, coloured by it or by regions.

--chart gives areas in the square, and volumes in the cube, of the unit of the points: those of the tets that extract
--split-cells makes; quadratic cells are split at their nodes.

Examples:
  isotet info grid.vtu
  isotet info grid.vtu --chart 20 -f pressure
  isotet info grid.vtu --chart 1000 -f pressure --json -
)";

} // namespace

void add_info_command(const Command& program, InfoCommand& info) {
    const Command command = program.add_command("info", "Show what is in a grid file");
    command.add_file("FILE", info.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    add_more_files(command, info.grid);
    add_time(command, info.grid);
    add_reading(command, info.grid, "--format");
    const Option survey = command.add_flag(
        "--survey", info.survey,
        "Count repeated tets, duplicate points, boundary faces and hanging points, too: that takes about as long as "
        "reading");
    const Option chart = command.add_count(
        "--chart", {1, 65'535}, [&](std::uint64_t n) { info.chart = n; }, "N",
        "Area of the isosurface and volume below it at N + 1 isovalues, from end to end of the field's range");
    const Option all_steps =
        command.add_flag("--all-steps", info.all_steps, "Ranges of fields over all time steps, each of which is read");
    for (const char* name : {"--time", "--step"}) all_steps.excludes(command.option(name));
    const Option each_block = command.add_flag("--each-block", info.each_block,
                                               "Also cell types and ranges of each block, which is read by itself");
    command
        .add_flag("--heads", info.heads,
                  "Only what the file announces, without reading values: fields, cells, time steps, blocks")
        .excludes(survey)
        .excludes(chart)
        .excludes(each_block)
        .excludes(all_steps);
    add_field(command, info.field, "The field of the chart; default: the one that is shown first").needs(chart);
    add_common(command, info.common);
    command.set_common({"--heads", "--survey", "--chart", "--all-steps", "--time", "--json"});
    command.set_details(info_details);
}

} // namespace isotet::cli
