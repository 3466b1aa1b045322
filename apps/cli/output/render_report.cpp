// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/render_report.hpp"

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::string times_text(const DrawInput& input, const PictureNumbers& picture) {
    const SceneReport& report = input.scene->report();
    std::string text = "read " + seconds_text(input.read_seconds);
    if (report.pack_seconds > 0) text += ", pack " + seconds_text(report.pack_seconds);
    if (report.boundary_faces > 0) text += ", boundary " + seconds_text(report.boundary_seconds);
    if (report.store) text += ", upload " + seconds_text(report.upload_seconds);
    return text + fmt::format(", {} {}, draw {}, write {}", input.is_surface ? "upload" : "extract",
                              seconds_text(report.extract_seconds), seconds_text(picture.draw_seconds),
                              seconds_text(picture.write_seconds));
}

const char* engine_name(const DrawInput& input) {
    const SceneReport& report = input.scene->report();
    return input.field.empty() || report.store ? "none" : report.on_device ? "vulkan" : "cpu";
}

std::string_view method_name(const DrawJob& job, const DrawInput& input) {
    if (input.field.empty()) return "none";
    return job.method.draw ? name_of(*job.method.draw) : name_of(input.scene->report().method);
}

/// As `opacity` takes it.
std::string opacity_text(const OpacityCurve& opacity) {
    std::string text;
    for (const OpacityPoint& point : opacity.points)
        text += fmt::format("{}{}:{}", text.empty() ? "" : ",", rounded(point.value), rounded(point.opacity));
    return text;
}

Json volume_json(const DrawInput& input, const PictureNumbers& picture) {
    if (!input.volume) return nullptr;
    Json opacity = Json::array();
    for (const OpacityPoint& point : input.volume->opacity.points)
        opacity.push_back(Json::array({point.value, point.opacity}));
    return {{"opacity", std::move(opacity)},       {"opacity_length", input.scene->report().opacity_length},
            {"shading", input.volume->shaded},     {"isovalues", input.volume->isosurfaces},
            {"clusters", picture.volume.clusters}, {"tets", picture.volume.tets},
            {"segments", picture.volume.segments}, {"bytes", picture.volume.bytes}};
}

std::string_view index_name(const DrawJob& job) { return name_of(job.index.value_or(default_index)); }

Json json_of(const DeviceWork& work) {
    Json passes = Json::array();
    for (const DevicePass& pass : work.passes) passes.push_back({{"name", pass.name}, {"seconds", pass.seconds}});
    return {{"passes", std::move(passes)},
            {"device_seconds", work.device_seconds},
            {"submissions", work.submissions},
            {"bytes_up", work.uploaded_bytes},
            {"bytes_down", work.downloaded_bytes}};
}

} // namespace

std::string render_table(const DrawJob& job, const DrawReport& drawn) {
    const auto& [input, device, picture] = drawn;
    const SceneReport& report = input.scene->report();
    Table table = facts();
    table.row({input.is_surface ? "surface" : "grid", fmt::format("{} ({})", job.grid.file, input.format)});
    if (!input.is_surface) {
        table.row({"cells", grouped(input.cells)});
    }
    if (!input.field.empty()) {
        const bool finite = report.field.lower <= report.field.upper;
        table.row(
            {"field", finite ? fmt::format("{}, {}", input.field, rounded_range(report.field.lower, report.field.upper))
                             : input.field});
    }
    if (!job.slices.empty()) table.row({"slices", counted(report.slice_triangles, "triangle")});
    if (report.boundary_faces > 0) table.row({"boundary", grouped(report.boundary_faces) + " faces"});
    if (!job.sweep.empty())
        table.row({"isovalues",
                   fmt::format("{}, {} to {}", picture.pictures, shortest(input.sweep[0]), shortest(input.sweep[1]))});
    const std::vector<std::string> isovalues = isovalue_texts(*input.scene);
    for (std::size_t i = 0; i < isovalues.size() && job.sweep.empty(); ++i) {
        const ShownSurface& surface = input.scene->surfaces()[i];
        const std::string what = surface.isovalue ? "isovalue " + isovalues[i] : "surface";
        table.row({what, report.store ? fmt::format("{} drawn, {} sent", counted(surface.tets, "tet"),
                                                    format_bytes(surface.sent_bytes))
                                      : counted(surface.triangles, "triangle")});
    }
    if (input.volume) {
        const VolumeWork& work = picture.volume;
        if (!input.volume->opacity.points.empty())
            table.row({"opacity",
                       fmt::format("{} of {}", opacity_text(input.volume->opacity), rounded(report.opacity_length))});
        table.row(
            {"volume", fmt::format("{} in {}, {}, {}", counted(work.tets, "tet"), counted(work.clusters, "cluster"),
                                   counted(work.segments, "segment"), format_bytes(work.bytes))});
    }
    if (input.colors)
        table.row(
            {"coloured by", !input.colors->classes.empty()
                                ? fmt::format("{}, {}", input.colors->name, fmt::join(input.colors->classes, ", "))
                                : fmt::format("{}, {} to {}", input.colors->name, rounded(input.colors->scale.lower),
                                              rounded(input.colors->scale.upper))});
    if (device) table.row({"device", fmt::format("{} ({})", device->name, name_of(device->kind))});
    if (!input.field.empty() && !report.store)
        table.row({"engine", fmt::format("{}, {}", engine_name(input), method_name(job, input))});
    if (report.store) {
        const TetStoreReport& store = *report.store;
        table.row({"method", fmt::format("{}, index {}", method_name(job, input), index_name(job))});
        table.row({"store", fmt::format("{}, of them {} sent again for every picture", format_bytes(store.stored_bytes),
                                        format_bytes(store.host_bytes))});
    }
    table.row({"time", times_text(input, picture)});
    const std::string count = picture.pictures == 1 ? "picture" : fmt::format("{} pictures", picture.pictures);
    table.row({count, fmt::format("{}, {} x {} ({})", picture.file, job.picture.width, job.picture.height,
                                  format_bytes(picture.bytes))});
    if (picture.differs)
        table.row(
            {"reference", fmt::format("{}: {} of the pixels differ", job.reference, percent_text(*picture.differs))});
    return table.text();
}

Json render_json(const DrawJob& job, const DrawReport& drawn) {
    const auto& [input, device, picture] = drawn;
    const SceneReport& made = input.scene->report();
    const FieldReport& range = made.field;
    Json report = json_report("render");
    report["input"] = json_text(job.grid.file);
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
    report["volume"] = volume_json(input, picture);
    report["camera"] = picture.camera;
    report["step"] = input.step ? Json(*input.step) : Json(nullptr);
    report["time"] = input.time ? Json(*input.time) : Json(nullptr);
    report["slice_triangles"] = job.slices.empty() ? Json(nullptr) : Json(made.slice_triangles);
    report["device"] = nullptr;
    if (device) report["device"] = {{"name", json_text(device->name)}, {"kind", name_of(device->kind)}};
    report["engine"] = engine_name(input);
    report["method"] = method_name(job, input);
    report["index"] = made.store ? Json(index_name(job)) : Json(nullptr);
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
    report["peak_memory"] = picture.peak_memory ? Json(*picture.peak_memory) : Json(nullptr);
    report["pictures"] = picture.pictures;
    report["file"] = json_text(picture.file);
    report["width"] = job.picture.width;
    report["height"] = job.picture.height;
    report["bytes"] = picture.bytes;
    report["differs"] = picture.differs ? Json(*picture.differs) : Json(nullptr);
    return report;
}

} // namespace isotet::cli
