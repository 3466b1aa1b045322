// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/extract_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::string memory_text(const ExtractNumbers& numbers) {
    const std::string rest = fmt::format("extracting {}, whole process {}", format_bytes(numbers.transient_peak()),
                                         format_bytes(numbers.process_bytes));
    if (!numbers.pack) return rest;
    const PackReport& pack = *numbers.pack;
    std::string text = "packed " + format_bytes(pack.bytes);
    if (pack.tets > 0) {
        text += fmt::format(" ({:.1f} bytes a tet)", static_cast<double>(pack.bytes) / static_cast<double>(pack.tets));
    }
    if (pack.source_bytes > 0) text += ", source cells " + format_bytes(pack.source_bytes);
    if (pack.gradient_bytes > 0) text += ", gradients " + format_bytes(pack.gradient_bytes);
    return text + ", " + rest;
}

std::string field_text(const ExtractNumbers& numbers) {
    const FieldReport& field = numbers.field;
    std::string text = field.name + (numbers.averaged ? " (cell field, averaged to the points)" : "");
    if (field.lower <= field.upper) text += ", " + rounded_range(field.lower, field.upper);
    if (numbers.steps > 1) text += " in the last time step";
    if (field.no_data > 0) text += fmt::format(", no data at {} points", grouped(field.no_data));
    if (field.infinite > 0) text += fmt::format(", infinite at {}", grouped(field.infinite));
    return text;
}

std::string device_text(const ExtractNumbers& numbers) {
    DeviceWork sum;
    for (const SurfaceNumbers& surface : numbers.surfaces) {
        if (!surface.device) continue;
        sum.device_seconds += surface.device->device_seconds;
        sum.uploaded_bytes += surface.device->uploaded_bytes;
        sum.downloaded_bytes += surface.device->downloaded_bytes;
        sum.page_loads += surface.device->page_loads;
    }
    return fmt::format("busy {}; up {}, down {}, {} pages loaded again", seconds_text(sum.device_seconds),
                       format_bytes(sum.uploaded_bytes), format_bytes(sum.downloaded_bytes), grouped(sum.page_loads));
}

/// What packing counts.
void add_pack_rows(const PackReport& pack, Table& table) {
    table.row({"points", fmt::format("{} used", grouped(pack.points))});
    table.row({"tets", grouped(pack.tets)});
    for (const auto& [count, what] : {std::pair{pack.collapsed_tets, "collapsed tets, dropped"},
                                      {pack.repeated_tets, "repeated tets, dropped"},
                                      {pack.inverted_tets, "inverted tets"},
                                      {pack.flat_tets, "flat tets"}}) {
        if (count > 0) table.row({"", fmt::format("{} {}", grouped(count), what)});
    }
}

std::string solid_text(const SolidRange& range) {
    if (!std::isfinite(range.upper)) return "above " + shortest(range.lower);
    if (!std::isfinite(range.lower)) return "below " + shortest(range.upper);
    return fmt::format("{} to {}", shortest(range.lower), shortest(range.upper));
}

Json patches_json(const std::vector<SolidPatch>& patches) {
    Json all = Json::array();
    for (const SolidPatch& patch : patches)
        all.push_back({{"number", patch.number},
                       {"name", json_text(patch.name)},
                       {"triangles", patch.triangles},
                       {"area", patch.area}});
    return all;
}

/// The numbers of patches are those of the cell field "patch"; areas are of the one solid that there is.
void add_patches(const ExtractNumbers& numbers, Table& table) {
    for (const SolidPatch& patch : numbers.surfaces.back().solid->patches)
        table.row({"patch", fmt::format("{} {}{}", patch.number, patch.name,
                                        numbers.surfaces.size() > 1 ? "" : ", area " + rounded(patch.area))});
}

Json solid_json(const SolidNumbers& solid) {
    const auto end = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
    return {{"range", Json::array({end(solid.range.lower), end(solid.range.upper)})},
            {"volume", solid.volume},
            {"grid_volume", solid.grid_volume},
            {"isosurface_area", solid.isosurface_area},
            {"boundary_area", solid.boundary_area},
            {"open_edges", solid.open_edges},
            {"seam_edges", solid.seam_edges},
            {"unfit_edges", solid.unfit_edges},
            {"patches", patches_json(solid.patches)}};
}

std::string time_text(const ExtractNumbers& numbers) {
    std::string text = "read " + seconds_text(numbers.read_seconds);
    if (numbers.pack) text += ", pack " + seconds_text(numbers.pack_seconds);
    else if (numbers.pack_seconds > 0) text += ", make cells linear " + seconds_text(numbers.pack_seconds);
    if (numbers.look_seconds > 0) text += ", range " + seconds_text(numbers.look_seconds);
    text += ", areas " + seconds_text(numbers.measure_seconds);
    return text;
}

std::string choice_text(const ExtractNumbers& numbers) {
    std::string text = fmt::format("took {}", seconds_text(numbers.work_seconds()));
    if (numbers.peak_bytes) text += " and " + format_bytes(*numbers.peak_bytes);
    if (numbers.predicted)
        text = fmt::format("{} and {} predicted, {}", seconds_text(numbers.predicted->seconds),
                           format_bytes(numbers.predicted->bytes), text);
    return text;
}

std::string engine_text(const ExtractNumbers& numbers) {
    return numbers.on_device() ? "vulkan on " + numbers.device : std::string(numbers.engine);
}

std::string facts_table(const ExtractNumbers& numbers, bool verbose) {
    Table table = facts();
    table.row({"grid", fmt::format("{} ({}), {}", numbers.grid, numbers.format, counted(numbers.cells, "cell"))});
    if (numbers.cells_left_out > 0) table.row({"", fmt::format("{} cells left out", grouped(numbers.cells_left_out))});
    table.row({"field", field_text(numbers)});
    if (!numbers.surfaces.empty() && numbers.surfaces.back().solid) {
        table.row({"", fmt::format("volume of the grid {}", rounded(numbers.surfaces.back().solid->grid_volume))});
        add_patches(numbers, table);
    }
    if (!numbers.collection.empty()) table.row({"series", numbers.collection});
    if (!numbers.parts_table.empty()) table.row({"parts", numbers.parts_table});
    if (!verbose) return table.text();
    if (numbers.pack) add_pack_rows(*numbers.pack, table);
    table.row({"method", fmt::format("{} ({})", name_of(numbers.method), numbers.why)});
    table.row({"", choice_text(numbers)});
    table.row({"engine", fmt::format("{}, {} precision, {} thread{}", engine_text(numbers),
                                     numbers.precision == Precision::float32 ? "single" : "double", numbers.threads,
                                     numbers.threads == 1 ? "" : "s")});
    table.row({"memory", memory_text(numbers)});
    if (numbers.packed_file)
        table.row({"packed file",
                   fmt::format("read {} of {}, {} reads; {} in memory at most",
                               format_bytes(numbers.packed_file->bytes_read), format_bytes(numbers.packed_file_bytes),
                               grouped(numbers.packed_file->reads), format_bytes(numbers.packed_file->peak_bytes))});
    table.row({"time", time_text(numbers)});
    if (numbers.on_device()) table.row({"device", device_text(numbers)});
    return table.text();
}

} // namespace

std::string extract_table(const ExtractNumbers& numbers, bool verbose) {
    const auto any = [&](const auto& holds) { return std::ranges::any_of(numbers.surfaces, holds); };
    const bool times = any([](const SurfaceNumbers& surface) { return surface.time.has_value(); });
    const bool files = any([](const SurfaceNumbers& surface) { return !surface.file.empty(); });
    const bool solids = any([](const SurfaceNumbers& surface) { return surface.solid.has_value(); });
    const bool volumes = any([](const SurfaceNumbers& surface) { return surface.volumes.has_value(); });
    using enum Table::Align;
    Table table({right, right, right, right, right, right, right, right, left, right, right, right});
    table.row({solids ? "solid" : "isovalue", times ? "time" : "", "triangles", "vertices", "area",
               solids ? "volume" : "", volumes ? "volume below" : "", volumes ? "volume above" : "",
               files ? "file" : "", verbose ? "tied points" : "", verbose ? "extract" : "",
               verbose && files ? "write" : ""});
    std::vector<double> isovalues;
    for (const SurfaceNumbers& surface : numbers.surfaces) isovalues.push_back(surface.isovalue);
    const std::vector<std::string> isovalue_texts = told_apart(isovalues);
    for (std::size_t i = 0; i < numbers.surfaces.size(); ++i) {
        const SurfaceNumbers& surface = numbers.surfaces[i];
        std::vector<std::string> row{surface.solid ? solid_text(surface.solid->range) : isovalue_texts[i],
                                     surface.time ? shortest(*surface.time) : "",
                                     grouped(surface.triangles),
                                     grouped(surface.vertices),
                                     rounded(surface.area),
                                     surface.solid ? rounded(surface.solid->volume) : "",
                                     surface.volumes ? rounded(surface.volumes->below) : "",
                                     surface.volumes ? rounded(surface.volumes->above) : "",
                                     surface.file};
        if (verbose) {
            row.push_back(grouped(surface.report.tied_points));
            row.push_back(seconds_text(surface.extract_seconds));
            if (files) row.push_back(seconds_text(surface.write_seconds));
        }
        table.row(std::move(row));
    }
    return table.text() + "\n" + facts_table(numbers, verbose);
}

Json extract_json(const char* command, const ExtractNumbers& numbers) {
    Json report = json_report(command);
    report["grid"] = json_text(numbers.grid);
    report["format"] = numbers.format;
    report["cells"] = numbers.cells;
    report["points"] = numbers.pack ? Json(numbers.pack->points) : Json(nullptr);
    report["tets"] = numbers.pack ? Json(numbers.pack->tets) : Json(nullptr);
    report["cells_left_out"] = numbers.cells_left_out;
    const RefinementReport& curved = numbers.refinement;
    report["curved"] =
        curved.curved_cells + curved.unknown_cells == 0
            ? Json(nullptr)
            : Json({{"cells", curved.curved_cells},
                    {"cells_left_out", curved.unknown_cells},
                    {"refined", curved.refined},
                    {"tets", curved.tets},
                    {"points", curved.points},
                    {"tolerance", curved.refined && curved.tolerance > 0 ? Json(curved.tolerance) : Json(nullptr)},
                    {"field_bound", curved.refined ? Json(curved.field_bound) : Json(nullptr)},
                    {"geometry_bound", curved.geometry_bound},
                    {"distance", curved.distance > 0 ? Json(curved.distance) : Json(nullptr)}});
    report["field"] = json_text(numbers.field.name);
    const bool finite = numbers.field.lower <= numbers.field.upper;
    report["range"] = finite ? Json::array({numbers.field.lower, numbers.field.upper}) : Json(nullptr);
    report["no_data_points"] = numbers.field.no_data;
    report["engine"] = std::string(numbers.engine);
    report["method"] = name_of(numbers.method);
    report["method_why"] = numbers.why;
    report["predicted"] = numbers.predicted
                              ? Json({{"seconds", numbers.predicted->seconds}, {"bytes", numbers.predicted->bytes}})
                              : Json(nullptr);
    report["packed_file"] = numbers.packed_file ? Json{{"bytes", numbers.packed_file_bytes},
                                                       {"bytes_read", numbers.packed_file->bytes_read},
                                                       {"reads", numbers.packed_file->reads},
                                                       {"bytes_in_memory", numbers.packed_file->bytes},
                                                       {"peak_bytes_in_memory", numbers.packed_file->peak_bytes}}
                                                : Json(nullptr);
    report["measured"] = {{"seconds", numbers.work_seconds()},
                          {"bytes", numbers.peak_bytes ? Json(*numbers.peak_bytes) : Json(nullptr)}};
    report["precision"] = numbers.precision == Precision::float32 ? "float" : "double";
    report["threads"] = numbers.threads;
    report["seconds"] = {{"read", numbers.read_seconds},
                         {"pack", numbers.pack_seconds},
                         {"range", numbers.look_seconds},
                         {"areas", numbers.measure_seconds}};
    const PackReport pack = numbers.pack.value_or(PackReport{});
    report["bytes"] = {{"packed", pack.bytes},
                       {"sources", pack.source_bytes},
                       {"normals", pack.gradient_bytes},
                       {"transient_peak", numbers.transient_peak()}};
    Json list = Json::array();
    for (const SurfaceNumbers& surface : numbers.surfaces) {
        const auto& ties = surface.report.false_ties;
        list.push_back({{"isovalue", surface.isovalue},
                        {"time", surface.time ? Json(*surface.time) : Json(nullptr)},
                        {"tied_points", surface.report.tied_points},
                        {"false_ties", ties ? Json(*ties) : Json(nullptr)},
                        {"vertices", surface.vertices},
                        {"triangles", surface.triangles},
                        {"area", surface.area},
                        {"seconds", {{"extract", surface.extract_seconds}, {"write", surface.write_seconds}}},
                        {"file", surface.file.empty() ? Json(nullptr) : json_text(surface.file)}});
        if (surface.parts)
            list.back()["parts"] = {{"found", surface.parts->parts.size()}, {"kept", surface.parts_kept}};
        if (surface.solid) list.back()["solid"] = solid_json(*surface.solid);
        if (surface.volumes) {
            list.back()["volume_below"] = surface.volumes->below;
            list.back()["volume_above"] = surface.volumes->above;
        }
        if (surface.device)
            list.back()["device"] = {{"seconds", surface.device->device_seconds},
                                     {"bytes_up", surface.device->uploaded_bytes},
                                     {"bytes_down", surface.device->downloaded_bytes},
                                     {"page_loads", surface.device->page_loads}};
    }
    report["surfaces"] = std::move(list);
    report["collection"] = numbers.collection.empty() ? Json(nullptr) : json_text(numbers.collection);
    return report;
}

} // namespace isotet::cli
