// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_report.hpp"

#include <fmt/format.h>

#include "number_format.hpp"
#include "report.hpp"

namespace isotet::cli {

namespace {

std::string times_text(const RenderInput& input, const RenderScene& scene, const PictureNumbers& picture) {
    std::string text = "read " + seconds_text(input.read_seconds);
    if (input.pack_seconds > 0) text += ", pack " + seconds_text(input.pack_seconds);
    if (input.boundary) text += ", boundary " + seconds_text(input.boundary_seconds);
    if (input.contour)
        text += fmt::format(", upload {}, extract {}", seconds_text(scene.upload_seconds()),
                            seconds_text(scene.extract_seconds()));
    else text += ", upload " + seconds_text(scene.extract_seconds());
    return text +
           fmt::format(", draw {}, write {}", seconds_text(picture.draw_seconds), seconds_text(picture.write_seconds));
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

} // namespace

std::string percent_text(double share) { return rounded(100 * share) + " %"; }

std::string render_table(const RenderCommand& command, const RenderInput& input, const RenderScene& scene,
                         const Device& device, const PictureNumbers& picture) {
    Table table = facts();
    table.row({input.surface ? "surface" : "grid", fmt::format("{} ({})", command.grid.file, input.format)});
    if (input.contour) {
        table.row({"cells", grouped(input.cells)});
        const bool finite = input.lower <= input.upper;
        table.row({"field", finite
                                ? fmt::format("{}, {} to {}", input.field, shortest(input.lower), shortest(input.upper))
                                : input.field});
    }
    if (input.boundary) table.row({"boundary", grouped(input.boundary->triangle_count()) + " faces"});
    if (!command.sweep.empty())
        table.row({"isovalues", fmt::format("{}, {} to {}", picture.pictures, shortest(command.sweep[0]),
                                            shortest(command.sweep[1]))});
    const std::vector<std::string> isovalues = scene.isovalue_texts();
    for (std::size_t i = 0; i < isovalues.size() && command.sweep.empty(); ++i) {
        const SurfaceCounts& surface = scene.surfaces()[i];
        const std::string what = surface.isovalue ? "isovalue " + isovalues[i] : "surface";
        table.row({what, scene.tets() ? fmt::format("{} drawn, {} sent", counted(surface.tets, "tet"),
                                                    format_bytes(surface.sent_bytes))
                                      : counted(surface.triangles, "triangle")});
    }
    if (input.colors)
        table.row({"coloured by", fmt::format("{}, {} to {}", input.colors->name, rounded(input.colors->scale.lower),
                                              rounded(input.colors->scale.upper))});
    table.row({"device", fmt::format("{} ({})", device.info().name, name_of(device.info().kind))});
    if (input.contour && !scene.tets()) table.row({"engine", fmt::format("{}, {}", scene.engine(), scene.method())});
    if (scene.tets()) {
        const TetStoreReport& store = scene.tets()->report();
        table.row({"method", fmt::format("{}, index {}", scene.method(), index_name(command))});
        table.row({"store", fmt::format("{}, of them {} sent again for every picture", format_bytes(store.stored_bytes),
                                        format_bytes(store.host_bytes))});
    }
    table.row({"time", times_text(input, scene, picture)});
    const std::string count = picture.pictures == 1 ? "picture" : fmt::format("{} pictures", picture.pictures);
    table.row({count, fmt::format("{}, {} x {} ({})", picture.file, command.picture.width, command.picture.height,
                                  format_bytes(picture.bytes))});
    if (picture.differs)
        table.row({"reference",
                   fmt::format("{}: {} of the pixels differ", command.reference, percent_text(*picture.differs))});
    return table.text();
}

Json render_json(const RenderCommand& command, const RenderInput& input, const RenderScene& scene, const Device& device,
                 const PictureNumbers& picture) {
    Json report = json_report("render");
    report["input"] = json_text(command.grid.file);
    report["format"] = input.format;
    report["field"] = input.contour ? json_text(input.field) : Json(nullptr);
    report["range"] =
        input.contour && input.lower <= input.upper ? Json::array({input.lower, input.upper}) : Json(nullptr);
    report["color_by"] = input.colors ? json_text(input.colors->name) : Json(nullptr);
    report["color_range"] =
        input.colors ? Json::array({input.colors->scale.lower, input.colors->scale.upper}) : Json(nullptr);
    report["boundary_faces"] = input.boundary ? Json(input.boundary->triangle_count()) : Json(nullptr);
    Json surfaces = Json::array();
    for (const SurfaceCounts& surface : scene.surfaces()) {
        const bool tets = scene.tets() != nullptr;
        surfaces.push_back({{"isovalue", surface.isovalue ? Json(*surface.isovalue) : Json(nullptr)},
                            {"vertices", tets ? Json(nullptr) : Json(surface.vertices)},
                            {"triangles", tets ? Json(nullptr) : Json(surface.triangles)},
                            {"tets", tets ? Json(surface.tets) : Json(nullptr)},
                            {"bytes_sent", tets ? Json(surface.sent_bytes) : Json(nullptr)}});
    }
    report["surfaces"] = std::move(surfaces);
    report["device"] = {{"name", json_text(device.info().name)}, {"kind", name_of(device.info().kind)}};
    report["engine"] = scene.engine();
    report["method"] = scene.method();
    report["index"] = scene.tets() ? Json(index_name(command)) : Json(nullptr);
    report["store"] = nullptr;
    if (scene.tets()) {
        const TetStoreReport& store = scene.tets()->report();
        report["store"] = {
            {"bytes", store.stored_bytes}, {"on_device", store.device_bytes}, {"sent_every_time", store.host_bytes}};
    }
    report["seconds"] = {{"read", input.read_seconds},         {"pack", input.pack_seconds},
                         {"boundary", input.boundary_seconds}, {"upload", scene.upload_seconds()},
                         {"extract", scene.extract_seconds()}, {"draw", picture.draw_seconds},
                         {"write", picture.write_seconds}};
    report["extracting"] = json_of(scene.extract_work());
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
