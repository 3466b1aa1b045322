// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/packed_report.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/text.hpp>

#include "output/report.hpp"

namespace isotet::cli {

namespace {

using KindCounts = std::array<std::pair<std::uint64_t, const char*>, 4>;

KindCounts kinds_of(const PackReport& pack) {
    return {{{pack.tets, "tetrahedron"},
             {pack.pyramids, "pyramid"},
             {pack.wedges, "wedge"},
             {pack.hexahedra, "hexahedron"}}};
}

const char* precision_of(const PackedFileInfo& info) {
    return info.precision == Precision::float32 ? "float" : "double";
}

} // namespace

std::string packed_table(const PackedFileInfo& info, const std::string& path) {
    Table table = facts();
    table.row(
        {"file", fmt::format("{} (isotet {}.{}, {})", path, info.major, info.minor, format_bytes(info.file_bytes))});
    table.row({"grid", fmt::format("{} points ({}), {} cells", grouped(info.user_points), name_of(info.point_type),
                                   grouped(info.user_cells))});
    table.row({"packed", fmt::format("{} points, {} clusters in {} chunks, {} precision{}", grouped(info.report.points),
                                     grouped(info.report.clusters), grouped(info.chunks), precision_of(info),
                                     info.source_cells ? ", with source cells" : "")});
    for (const auto& [count, kind] : kinds_of(info.report))
        if (count > 0) table.row({"", fmt::format("{} {}", grouped(count), kind)});
    if (info.report.cells_left_out > 0)
        table.row({"", fmt::format("{} cells left out: not chosen, or of a type that is not contoured",
                                   grouped(info.report.cells_left_out))});
    for (std::size_t axis = 0; axis < 3; ++axis)
        table.row({axis == 0 ? "bounds" : "",
                   fmt::format("{} {}", "xyz"[axis], rounded_range(info.lower[axis], info.upper[axis]))});
    if (info.steps > 1 || !info.times.empty())
        table.row({"time steps", info.times.empty()
                                     ? grouped(info.steps)
                                     : fmt::format("{}, times {} to {}", info.steps, shortest(info.times.front()),
                                                   shortest(info.times.back()))});
    for (const PackedPointsInfo& points : info.moved_points)
        table.row({"points move",
                   fmt::format("x {}, y {}, z {} from step {} on", rounded_range(points.lower[0], points.upper[0]),
                               rounded_range(points.lower[1], points.upper[1]),
                               rounded_range(points.lower[2], points.upper[2]), points.step)});
    for (const PackedFieldInfo& field : info.fields) {
        const FieldReport& report = field.report;
        std::string text = fmt::format("{}: {}, ", report.name, name_of(field.type));
        text += report.lower <= report.upper ? rounded_range(report.lower, report.upper) : "no finite value";
        if (report.no_data > 0) text += fmt::format(", no data {}", grouped(report.no_data));
        if (field.gradients) text += ", with gradients";
        if (info.steps > 1) text += fmt::format(", step {}", field.step);
        table.row({"field", text});
    }
    for (const PackedCellFieldInfo& field : info.cell_fields) {
        std::string text = fmt::format("{}: {}", field.name, name_of(field.type));
        if (field.components > 1) text += fmt::format(", {} components", field.components);
        if (info.steps > 1) text += fmt::format(", from step {}", field.step);
        table.row({"cell field", text});
    }
    return table.text();
}

Json packed_json(const PackedFileInfo& info, const std::string& path, const std::string& command) {
    Json report = json_report(command);
    report["file"] = json_text(path);
    report["format"] = "isotet";
    report["bytes"] = info.file_bytes;
    report["points"] = info.user_points;
    report["cells"] = info.user_cells;
    Json by_type = Json::object();
    for (const auto& [count, kind] : kinds_of(info.report))
        if (count > 0) by_type[kind] = count;
    report["packed"] = {{"points", info.report.points},     {"cells_by_type", std::move(by_type)},
                        {"clusters", info.report.clusters}, {"chunks", info.chunks},
                        {"precision", precision_of(info)},  {"source_cells", info.source_cells}};
    report["cells_left_out"] = info.report.cells_left_out;
    report["bounds"] = {{"lower", info.lower}, {"upper", info.upper}};
    report["steps"] = info.steps;
    report["times"] = info.times;
    Json moved = Json::array();
    for (const PackedPointsInfo& points : info.moved_points)
        moved.push_back({{"step", points.step}, {"lower", points.lower}, {"upper", points.upper}});
    report["moved_points"] = std::move(moved);
    Json fields = Json::array();
    for (const PackedFieldInfo& field : info.fields) {
        const bool none = field.report.lower > field.report.upper;
        fields.push_back({{"name", json_text(field.report.name)},
                          {"step", field.step},
                          {"type", name_of(field.type)},
                          {"range", none ? Json(nullptr) : Json::array({field.report.lower, field.report.upper})},
                          {"nan", field.report.no_data},
                          {"infinite", field.report.infinite},
                          {"gradients", field.gradients}});
    }
    report["fields"] = std::move(fields);
    Json cell_fields = Json::array();
    for (const PackedCellFieldInfo& field : info.cell_fields)
        cell_fields.push_back({{"name", json_text(field.name)},
                               {"step", field.step},
                               {"type", name_of(field.type)},
                               {"components", field.components}});
    report["cell_fields"] = std::move(cell_fields);
    return report;
}

} // namespace isotet::cli
