// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet make`: test grids in files.
#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/make.hpp>
#include <isotet/write.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"
#include "output/stopwatch.hpp"

namespace isotet::cli {

Result<ExitCode> run_make(const MakeCommand& command) {
    Console console(command.common);
    if (const Result<Format> format = format_for_writing(command.out, Writes::grid, command.compression); !format)
        return format.error();
    if (Result<void> paths = check_output_paths({}, {command.out, command.common.json}); !paths) return paths.error();

    const MakeOptions& options = command.grid;
    const Stopwatch making;
    const Result<Grid> grid = make_grid(options, console.run());
    if (!grid) return grid.error();
    const double make_seconds = making.seconds();

    const Stopwatch writing;
    const Result<WriteReport> written =
        write_grid(*grid, command.out, {.compression = command.compression}, console.run());
    if (!written) return written.error();
    const double write_seconds = writing.seconds();
    console.notes(written->notes);

    Table table = facts();
    table.row({"shape", fmt::format("{}, {} cubes a side", options.shape, grouped(options.side))});
    table.row({"points", grouped(grid->points.tuples())});
    table.row({"cells", grouped(grid->cells.count())});
    std::vector<std::string> names;
    for (const Field& field : grid->point_fields) {
        names.push_back(field.name);
        table.row({"field", fmt::format("{} ({})", field.name, name_of(field.values.type()))});
    }
    table.row({"time", fmt::format("make {}, write {}", seconds_text(make_seconds), seconds_text(write_seconds))});
    table.row({"file", fmt::format("{} ({})", command.out, format_bytes(written->bytes))});

    Json report = json_report("make");
    report["shape"] = options.shape;
    report["side"] = options.side;
    report["seed"] = options.seed;
    report["points"] = grid->points.tuples();
    report["cells"] = grid->cells.count();
    report["fields"] = json_texts(names);
    report["seconds"] = {{"make", make_seconds}, {"write", write_seconds}};
    report["file"] = json_text(command.out);
    report["bytes"] = written->bytes;
    return finish(console, command.common, table.text(), std::move(report));
}

} // namespace isotet::cli
