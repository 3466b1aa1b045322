// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render`: a picture of isosurfaces, or of a surface.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <isotet/render.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "device_choice.hpp"
#include "json_output.hpp"
#include "number_format.hpp"
#include "output_paths.hpp"
#include "render_input.hpp"
#include "report.hpp"
#include "stopwatch.hpp"

namespace isotet::cli {

namespace {

/// "run/grid.vtu" gives "grid.png", "make:kuhn:64" gives "kuhn.png".
std::string name_of_picture(const RenderCommand& command) {
    if (!command.out.empty()) return command.out;
    const std::string& file = command.grid.file;
    constexpr std::string_view made = "make:";
    if (file.starts_with(made)) return file.substr(made.size(), file.find(':', made.size()) - made.size()) + ".png";
    return std::filesystem::path(file).stem().string() + ".png";
}

/// The device that was chosen, else the best graphics card, else a software device, which is noted.
Result<Device> open_drawing_device(const DeviceChoice& choice, Console& console) {
    if (choice.name == "none") return Error{ErrorCode::invalid_argument, "--device is none, but only a device can draw"};
    Result<std::optional<Device>> device = open_device(choice, console);
    if (!device && choice.name.empty() && device.error().code == ErrorCode::machine) {
        DeviceChoice software = choice;
        software.name = "software";
        const std::string no_card = device.error().message;
        device = open_device(software, console);
        if (!device) {
            const std::string& no_software = device.error().message;
            return Error{device.error().code,
                         "nothing can be drawn: " + (no_software == no_card ? no_card : fmt::format("{}; and {}", no_card, no_software))};
        }
    }
    if (!device) return device.error();
    if ((*device)->info().kind == DeviceKind::software) console.note(fmt::format("a software device draws: {}", (*device)->info().name));
    return **std::move(device);
}

/// Isosurfaces have colours of their own: from the dark to the light of the map, in the order of their values.
Color color_of(const RenderInput& input, std::size_t surface) {
    const DrawnSurface neutral;
    if (input.isovalues.size() < 2) return neutral.color;
    const auto below = std::ranges::count_if(input.isovalues, [&](double value) { return value < input.isovalues[surface]; });
    return color_at(ColorMap::viridis, 0.15 + 0.75 * static_cast<double>(below) / static_cast<double>(input.isovalues.size() - 1));
}

/// What was drawn, with what is in the device's memory for it.
struct Uploaded {
    std::vector<DeviceMesh> meshes;
    Scene scene;
};

Result<Uploaded> upload(const RenderInput& input, const Device& device) {
    Uploaded uploaded;
    for (const Surface& surface : input.surfaces) {
        Result<DeviceMesh> mesh = DeviceMesh::upload(device, surface);
        if (!mesh) return mesh.error();
        uploaded.meshes.push_back(*std::move(mesh));
    }
    for (std::size_t i = 0; i < uploaded.meshes.size(); ++i) {
        DrawnSurface drawn;
        drawn.mesh = &uploaded.meshes[i];
        drawn.color = color_of(input, i);
        uploaded.scene.surfaces.push_back(drawn);
    }
    uploaded.scene.bounds = input.bounds;
    return uploaded;
}

/// How long what took.
struct RenderSeconds {
    double upload = 0, draw = 0, write = 0;
};

std::string render_table(const RenderCommand& command, const RenderInput& input, const Device& device, const RenderSeconds& seconds,
                         const std::string& out, std::uint64_t bytes) {
    Table table = facts();
    table.row({input.from_grid ? "grid" : "surface", fmt::format("{} ({})", command.grid.file, input.format)});
    if (input.from_grid) {
        table.row({"cells", grouped(input.cells)});
        table.row({"field", fmt::format("{}, {} to {}", input.field, shortest(input.lower), shortest(input.upper))});
    }
    for (std::size_t i = 0; i < input.surfaces.size(); ++i) {
        const std::string what = input.from_grid ? fmt::format("isovalue {}", rounded(input.isovalues[i])) : "triangles";
        table.row({what, grouped(input.surfaces[i].triangle_count()) + (input.from_grid ? " triangles" : "")});
    }
    table.row({"device", fmt::format("{} ({})", device.info().name, name_of(device.info().kind))});
    std::string times = "read " + seconds_text(input.read_seconds);
    if (input.from_grid) times += fmt::format(", pack {}, extract {}", seconds_text(input.pack_seconds), seconds_text(input.extract_seconds));
    times += fmt::format(", upload {}, draw {}, write {}", seconds_text(seconds.upload), seconds_text(seconds.draw), seconds_text(seconds.write));
    table.row({"time", times});
    table.row({"picture", fmt::format("{}, {} x {} ({})", out, command.picture.width, command.picture.height, bytes_text(bytes))});
    return table.text();
}

Json render_json(const RenderCommand& command, const RenderInput& input, const Device& device, const DeviceWork& work,
                 const RenderSeconds& seconds, const std::string& out, std::uint64_t bytes) {
    Json report = json_report("render");
    report["input"] = json_text(command.grid.file);
    report["format"] = input.format;
    report["field"] = input.from_grid ? json_text(input.field) : Json(nullptr);
    report["range"] = input.from_grid ? Json({input.lower, input.upper}) : Json(nullptr);
    Json surfaces = Json::array();
    for (std::size_t i = 0; i < input.surfaces.size(); ++i) {
        surfaces.push_back({{"isovalue", input.from_grid ? Json(input.isovalues[i]) : Json(nullptr)},
                            {"vertices", input.surfaces[i].vertices()},
                            {"triangles", input.surfaces[i].triangle_count()}});
    }
    report["surfaces"] = std::move(surfaces);
    report["device"] = {{"name", json_text(device.info().name)}, {"kind", name_of(device.info().kind)}};
    report["seconds"] = {{"read", input.read_seconds}, {"pack", input.pack_seconds}, {"extract", input.extract_seconds},
                         {"upload", seconds.upload},   {"draw", seconds.draw},       {"write", seconds.write}};
    Json passes = Json::array();
    for (const DevicePass& pass : work.passes) passes.push_back({{"name", pass.name}, {"seconds", pass.seconds}});
    report["drawing"] = {{"passes", std::move(passes)},
                         {"device_seconds", work.device_seconds},
                         {"submissions", work.submissions},
                         {"bytes_up", work.uploaded_bytes},
                         {"bytes_down", work.downloaded_bytes}};
    report["file"] = json_text(out);
    report["width"] = command.picture.width;
    report["height"] = command.picture.height;
    report["bytes"] = bytes;
    return report;
}

} // namespace

Result<ExitCode> run_render(const RenderCommand& command) {
    Console console(command.common);
    const std::string out = name_of_picture(command);
    if (!out.ends_with(".png")) return Error{ErrorCode::invalid_argument, fmt::format("the name of the output is '{}', but it must end in .png", out)};
    if (Result<void> paths = check_output_paths({command.grid.file}, {out, command.common.json}); !paths) return paths.error();
    const Result<Device> device = open_drawing_device(command.device, console);
    if (!device) return device.error();
    Result<Renderer> renderer = Renderer::make(*device);
    if (!renderer) return renderer.error();
    const Result<RenderInput> input = read_render_input(command, console);
    if (!input) return input.error();

    RenderSeconds seconds;
    const Stopwatch uploading;
    const Result<Uploaded> uploaded = upload(*input, *device);
    if (!uploaded) return uploaded.error();
    seconds.upload = uploading.seconds();

    PictureOptions options = command.picture;
    options.camera = camera_of(command.view, command.parallel ? Projection::parallel : Projection::perspective);
    options.camera.fit(input->bounds, static_cast<double>(options.width) / options.height);
    const Stopwatch drawing;
    const Result<Picture> picture = renderer->draw(uploaded->scene, options, console.progress());
    if (!picture) return picture.error();
    seconds.draw = drawing.seconds();

    const Stopwatch writing;
    const Result<std::uint64_t> bytes = write_picture(*picture, out);
    if (!bytes) return bytes.error();
    seconds.write = writing.seconds();
    if (Result<void> printed = console.print(render_table(command, *input, *device, seconds, out, *bytes)); !printed) return printed.error();
    Json report = render_json(command, *input, *device, renderer->work(), seconds, out, *bytes);
    report["notes"] = json_texts(console.noted());
    if (Result<void> written = write_json(report, command.common.json, console.progress()); !written) return written.error();
    return ExitCode::done;
}

} // namespace isotet::cli
