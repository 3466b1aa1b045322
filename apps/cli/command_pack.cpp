// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet pack`: from a grid file to a packed file.
#include <algorithm>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/text.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::uint64_t stored_cells(const PackReport& pack) { return pack.tets + pack.pyramids + pack.wedges + pack.hexahedra; }

std::string pack_table(const PackJob& job, const PackNumbers& done) {
    Table table = facts();
    table.row({"grid", fmt::format("{} ({})", done.grid, done.format)});
    table.row({"cells", grouped(done.cells)});
    table.row({"packed", fmt::format("{} points, {} tets, {} other cells", grouped(done.pack.points),
                                     grouped(done.pack.tets), grouped(stored_cells(done.pack) - done.pack.tets))});
    for (const FieldReport& field : done.fields)
        table.row({"field", fmt::format("{}: {} to {}", field.name, shortest(field.lower), shortest(field.upper))});
    if (done.steps > 1) table.row({"time steps", grouped(done.steps)});
    table.row({"time", fmt::format("read {}, pack {}, write {}", seconds_text(done.read_seconds),
                                   seconds_text(done.pack_seconds), seconds_text(done.write_seconds))});
    if (done.scratch_bytes) table.row({"scratch", format_bytes(done.scratch_bytes) + " at most"});
    table.row({"file", fmt::format("{} ({}, {:.1f} bytes a cell)", job.out, format_bytes(done.bytes),
                                   static_cast<double>(done.bytes) /
                                       static_cast<double>(std::max<std::uint64_t>(stored_cells(done.pack), 1)))});
    return table.text();
}

} // namespace

Result<ExitCode> run_pack(const PackCommand& command) {
    Console console(command.common);
    PackJob job = command;
    job.other_outputs = {command.common.json};
    const Result<PackNumbers> done = pack_file(job, console);
    if (!done) return done.error();
    std::vector<std::string> names;
    for (const FieldReport& field : done->fields) names.push_back(field.name);
    Json report = json_report("pack");
    report["grid"] = json_text(done->grid);
    report["format"] = done->format;
    report["cells"] = done->cells;
    report["points"] = done->pack.points;
    report["tets"] = done->pack.tets;
    report["other_cells"] = stored_cells(done->pack) - done->pack.tets;
    report["fields"] = json_texts(names);
    report["steps"] = done->steps;
    report["seconds"] = {{"read", done->read_seconds}, {"pack", done->pack_seconds}, {"write", done->write_seconds}};
    report["scratch_bytes"] = done->scratch_bytes;
    report["file"] = json_text(job.out);
    report["bytes"] = done->bytes;
    return finish(console, command.common, pack_table(job, *done), std::move(report));
}

} // namespace isotet::cli
