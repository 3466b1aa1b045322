// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "number_format.hpp"
#include "report.hpp"

namespace isotet::cli {

namespace {

std::string times_text(const RenderInput& input, const PictureNumbers& picture) {
    const SceneReport& report = input.scene->report();
    std::string text = "read " + seconds_text(input.read_seconds);
    if (report.pack_seconds > 0) text += ", pack " + seconds_text(report.pack_seconds);
    if (report.boundary_faces > 0) text += ", boundary " + seconds_text(report.boundary_seconds);
    if (report.store) text += ", upload " + seconds_text(report.upload_seconds);
    return text + fmt::format(", {} {}, draw {}, write {}", input.is_surface ? "upload" : "extract",
                              seconds_text(report.extract_seconds), seconds_text(picture.draw_seconds),
                              seconds_text(picture.write_seconds));
}

const char* engine_name(const RenderInput& input) {
    const SceneReport& report = input.scene->report();
    return input.field.empty() || report.store ? "none" : report.on_device ? "vulkan" : "cpu";
}

std::string_view method_name(const RenderCommand& command, const RenderInput& input) {
    if (input.field.empty()) return "none";
    return command.method.draw ? name_of(*command.method.draw) : name_of(input.scene->report().method);
}

std::string_view index_name(const RenderCommand& command) { return name_of(command.index.value_or(default_index)); }

Json json_of(const DeviceWork& work) {
    Json passes = Json::array();
    for (const DevicePass& pass : work.passes) passes.push_back({{"name", pass.name}, {"seconds", pass.seconds}});
    return {{"passes", std::move(passes)},
            {"device_seconds", work.device_seconds},
            {"submissions", work.submissions},
            {"bytes_up", work.uploaded_bytes},
            {"bytes_down", work.downloaded_bytes}};
}

/// Text with a minus sign, as the scale has it, in place of a hyphen.
std::string with_minus(std::string number) {
    if (number.starts_with('-')) number.replace(0, 1, "\u2212");
    return number;
}

/// "x = 0.5", or the normal and the offset.
std::string plane_text(const Plane& plane) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = plane.normal[axis];
        if (std::abs(along) != 1 || plane.normal[(axis + 1) % 3] != 0 || plane.normal[(axis + 2) % 3] != 0) continue;
        return fmt::format("{} = {}", "xyz"[axis], rounded(plane.offset * along));
    }
    return fmt::format("({}, {}, {}) · p = {}", rounded(plane.normal[0]), rounded(plane.normal[1]),
                       rounded(plane.normal[2]), rounded(plane.offset));
}

} // namespace

std::string percent_text(double share) { return rounded(100 * share) + " %"; }

std::vector<std::string> isovalue_texts(const IsosurfaceScene& scene) {
    std::vector<double> isovalues;
    for (const ShownSurface& surface : scene.surfaces()) isovalues.push_back(surface.isovalue.value_or(0));
    return told_apart(isovalues);
}

void note_empty_surfaces(const RenderInput& input, Console& console) {
    const auto& [field, store] = std::tie(input.scene->report().field, input.scene->report().store);
    for (const ShownSurface& surface : input.scene->surfaces()) {
        if (!surface.isovalue) continue;
        // Of tets it is not known before they are drawn; values on both sides of the isovalue make a surface mostly.
        const bool shown =
            store ? field.lower < *surface.isovalue && *surface.isovalue <= field.upper : surface.triangles > 0;
        if (shown) continue;
        const std::string values = !(field.lower <= field.upper) ? fmt::format("'{}' has no finite value", input.field)
                                   : field.lower == field.upper
                                       ? fmt::format("all values of '{}' are {}", input.field, shortest(field.lower))
                                       : fmt::format("the values of '{}' go from {} to {}", input.field,
                                                     shortest(field.lower), shortest(field.upper));
        console.note(fmt::format("there is no surface at {}: {}", shortest(*surface.isovalue), values));
    }
}

Annotation annotation_of(const RenderCommand& command, const RenderInput& input) {
    Annotation annotation;
    if (command.plain) return annotation;
    const std::vector<ShownSurface>& surfaces = input.scene->surfaces();
    const FieldReport& field = input.scene->report().field;
    std::uint64_t all = 0;
    for (const ShownSurface& surface : surfaces) all += surface.size();
    annotation.caption = std::filesystem::path(command.grid.file).filename().string();
    if (!input.is_surface) annotation.caption += "  ·  " + counted(input.cells, "cell");
    const std::string separator = "  ·  ";
    const std::vector<std::string> values = isovalue_texts(*input.scene);
    constexpr std::size_t few = 6;
    if (!input.field.empty() && surfaces.size() == 1)
        annotation.caption +=
            separator + fmt::format("{} = {}", input.field,
                                    rounded(*surfaces.front().isovalue, (field.upper - field.lower) / 1000));
    else if (!input.field.empty() && (input.colors || command.method.draw) && surfaces.size() <= few)
        annotation.caption += separator + fmt::format("{} = {}", input.field, fmt::join(values, ", "));
    else if (!input.field.empty())
        annotation.caption += separator + fmt::format("{} at {} isovalues", input.field, surfaces.size());
    for (const Plane& plane : command.slices) annotation.caption += separator + plane_text(plane);
    if (input.time) annotation.caption += separator + "t = " + rounded(*input.time);
    if (input.step) annotation.caption += separator + fmt::format("step {}", *input.step);
    if (!command.stretch.empty())
        annotation.caption += separator + fmt::format("axes × {}, {}, {}", shortest(command.stretch[0]),
                                                      shortest(command.stretch[1]), shortest(command.stretch[2]));
    if (all > 0)
        annotation.caption +=
            separator + (command.method.draw ? counted(all, "tet") + " drawn" : counted(all, "triangle"));
    // The camera follows when it is known.
    annotation.orientation = Orientation{{}, command.parallel || command.scale_bar, command.unit};
    if (input.colors && !input.colors->classes.empty()) {
        annotation.title = input.colors->name;
        for (std::size_t i = 0; i < input.colors->classes.size(); ++i)
            annotation.legend.push_back({input.colors->scale.classes[i], with_minus(input.colors->classes[i])});
        if (input.colors->has_no_data) annotation.legend.push_back({input.colors->scale.no_data, "no data"});
        return annotation;
    }
    if (input.colors) {
        annotation.title = input.colors->name;
        annotation.scale = input.colors->scale;
        if (input.colors->has_no_data) annotation.no_data = "no data";
    } else if (surfaces.size() > 1) {
        annotation.title = input.field;
        std::vector<std::size_t> order(surfaces.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, std::greater(), [&](std::size_t i) { return surfaces[i].isovalue; }); // largest above
        for (const std::size_t i : order)
            annotation.legend.push_back({input.scene->scene().surfaces[i].color, with_minus(values[i])});
    }
    return annotation;
}

std::string render_table(const RenderCommand& command, const RenderInput& input, const std::optional<Device>& device,
                         const PictureNumbers& picture) {
    const SceneReport& report = input.scene->report();
    Table table = facts();
    table.row({input.is_surface ? "surface" : "grid", fmt::format("{} ({})", command.grid.file, input.format)});
    if (!input.is_surface) {
        table.row({"cells", grouped(input.cells)});
    }
    if (!input.field.empty()) {
        const bool finite = report.field.lower <= report.field.upper;
        table.row({"field", finite ? fmt::format("{}, {} to {}", input.field, shortest(report.field.lower),
                                                 shortest(report.field.upper))
                                   : input.field});
    }
    if (report.slice_triangles > 0) table.row({"slices", counted(report.slice_triangles, "triangle")});
    if (report.boundary_faces > 0) table.row({"boundary", grouped(report.boundary_faces) + " faces"});
    if (!command.sweep.empty())
        table.row({"isovalues", fmt::format("{}, {} to {}", picture.pictures, shortest(command.sweep[0]),
                                            shortest(command.sweep[1]))});
    const std::vector<std::string> isovalues = isovalue_texts(*input.scene);
    for (std::size_t i = 0; i < isovalues.size() && command.sweep.empty(); ++i) {
        const ShownSurface& surface = input.scene->surfaces()[i];
        const std::string what = surface.isovalue ? "isovalue " + isovalues[i] : "surface";
        table.row({what, report.store ? fmt::format("{} drawn, {} sent", counted(surface.tets, "tet"),
                                                    format_bytes(surface.sent_bytes))
                                      : counted(surface.triangles, "triangle")});
    }
    if (input.colors)
        table.row(
            {"coloured by", !input.colors->classes.empty()
                                ? fmt::format("{}, {}", input.colors->name, fmt::join(input.colors->classes, ", "))
                                : fmt::format("{}, {} to {}", input.colors->name, rounded(input.colors->scale.lower),
                                              rounded(input.colors->scale.upper))});
    if (device) table.row({"device", fmt::format("{} ({})", device->info().name, name_of(device->info().kind))});
    if (!input.field.empty() && !report.store)
        table.row({"engine", fmt::format("{}, {}", engine_name(input), method_name(command, input))});
    if (report.store) {
        const TetStoreReport& store = *report.store;
        table.row({"method", fmt::format("{}, index {}", method_name(command, input), index_name(command))});
        table.row({"store", fmt::format("{}, of them {} sent again for every picture", format_bytes(store.stored_bytes),
                                        format_bytes(store.host_bytes))});
    }
    table.row({"time", times_text(input, picture)});
    const std::string count = picture.pictures == 1 ? "picture" : fmt::format("{} pictures", picture.pictures);
    table.row({count, fmt::format("{}, {} x {} ({})", picture.file, command.picture.width, command.picture.height,
                                  format_bytes(picture.bytes))});
    if (picture.differs)
        table.row({"reference",
                   fmt::format("{}: {} of the pixels differ", command.reference, percent_text(*picture.differs))});
    return table.text();
}

Json render_json(const RenderCommand& command, const RenderInput& input, const std::optional<Device>& device,
                 const PictureNumbers& picture) {
    const SceneReport& made = input.scene->report();
    const FieldReport& range = made.field;
    Json report = json_report("render");
    report["input"] = json_text(command.grid.file);
    report["format"] = input.format;
    report["field"] = input.field.empty() ? Json(nullptr) : json_text(input.field);
    report["range"] =
        !input.field.empty() && range.lower <= range.upper ? Json::array({range.lower, range.upper}) : Json(nullptr);
    report["color_by"] = input.colors ? json_text(input.colors->name) : Json(nullptr);
    report["color_range"] =
        input.colors ? Json::array({input.colors->scale.lower, input.colors->scale.upper}) : Json(nullptr);
    report["boundary_faces"] = made.boundary_faces > 0 ? Json(made.boundary_faces) : Json(nullptr);
    Json surfaces = Json::array();
    for (const ShownSurface& surface : input.scene->surfaces()) {
        const bool tets = made.store.has_value();
        surfaces.push_back({{"isovalue", surface.isovalue ? Json(*surface.isovalue) : Json(nullptr)},
                            {"vertices", tets ? Json(nullptr) : Json(surface.vertices)},
                            {"triangles", tets ? Json(nullptr) : Json(surface.triangles)},
                            {"tets", tets ? Json(surface.tets) : Json(nullptr)},
                            {"bytes_sent", tets ? Json(surface.sent_bytes) : Json(nullptr)}});
    }
    report["surfaces"] = std::move(surfaces);
    report["camera"] = picture.camera;
    report["step"] = input.step ? Json(*input.step) : Json(nullptr);
    report["time"] = input.time ? Json(*input.time) : Json(nullptr);
    report["slice_triangles"] = made.slice_triangles > 0 ? Json(made.slice_triangles) : Json(nullptr);
    report["device"] = nullptr;
    if (device) report["device"] = {{"name", json_text(device->info().name)}, {"kind", name_of(device->info().kind)}};
    report["engine"] = engine_name(input);
    report["method"] = method_name(command, input);
    report["index"] = made.store ? Json(index_name(command)) : Json(nullptr);
    report["store"] = nullptr;
    if (made.store) {
        const TetStoreReport& store = *made.store;
        report["store"] = {
            {"bytes", store.stored_bytes}, {"on_device", store.device_bytes}, {"sent_every_time", store.host_bytes}};
    }
    report["seconds"] = {{"read", input.read_seconds},        {"pack", made.pack_seconds},
                         {"boundary", made.boundary_seconds}, {"upload", made.upload_seconds},
                         {"extract", made.extract_seconds},   {"draw", picture.draw_seconds},
                         {"write", picture.write_seconds}};
    report["extracting"] = json_of(made.extract_work);
    report["drawing"] = json_of(picture.drawing);
    report["pictures"] = picture.pictures;
    report["file"] = json_text(picture.file);
    report["width"] = command.picture.width;
    report["height"] = command.picture.height;
    report["bytes"] = picture.bytes;
    report["differs"] = picture.differs ? Json(*picture.differs) : Json(nullptr);
    return report;
}

} // namespace isotet::cli
