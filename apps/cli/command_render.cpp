// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render`: a picture of isosurfaces, or of a surface.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <isotet/annotation.hpp>
#include <isotet/compare_pictures.hpp>
#include <isotet/picture_file.hpp>
#include <isotet/render.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "device_choice.hpp"
#include "json_output.hpp"
#include "output_names.hpp"
#include "render_frames.hpp"
#include "render_input.hpp"
#include "render_report.hpp"
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

/// Draws the scene, and writes beside it what belongs to it.
Result<Picture> draw_annotated(Renderer& renderer, const RenderInput& input, const RenderCommand& command,
                               double azimuth, Console& console) {
    PictureOptions options = command.picture;
    options.camera = camera_of(command.view, command.parallel ? Projection::parallel : Projection::perspective);
    const PictureSize whole{options.width, options.height};
    options.camera.orbit(azimuth, 0);
    const Annotation annotation = annotation_of(command, input);
    std::optional<PictureSize> room;
    if (!annotation.empty()) {
        const Result<std::optional<PictureSize>> left = room_beside(annotation, whole);
        if (!left) return left.error();
        room = *left;
        if (!room) console.note(fmt::format("the picture, {} x {}, is too small for text", whole.width, whole.height));
    }
    if (room) {
        for (const std::string& text : {annotation.title, annotation.caption}) {
            const Result<std::size_t> missing = count_missing_letters(text);
            if (!missing) return missing.error();
            if (*missing == 0) continue;
            console.note(fmt::format("the font of isotet lacks letters of '{}': they are boxes in the picture", text));
            break; // the caption has the title's as a rule
        }
        options.width = room->width;
        options.height = room->height;
    }
    input.scene->fit(options.camera, static_cast<double>(options.width) / options.height,
                     command.orbit > 0 ? IsosurfaceScene::Fit::orbit : IsosurfaceScene::Fit::once);
    Result<Picture> picture = renderer.draw(input.scene->scene(), options, console.run());
    if (!picture || !room) return picture;
    return annotate(*picture, annotation, whole, options.background);
}

/// Extracts, draws and writes one picture after another; returns the last one.
Result<Picture> draw_frames(const std::vector<RenderFrame>& frames, const RenderCommand& command, Renderer& renderer,
                            RenderInput& input, PictureFiles& files, PictureNumbers& numbers, Console& console) {
    Result<Picture> picture = Error{};
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (console.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (frames.size() > 1) console.detail(fmt::format("picture {} of {}", i + 1, frames.size()));
        if (i == 0 || frames[i].isovalues != frames[i - 1].isovalues) {
            if (auto shown = input.scene->show(frames[i].isovalues, console.run()); !shown) return shown.error();
            console.notes(input.scene->take_notes());
            note_empty_surfaces(input, console);
        }
        const Stopwatch drawing;
        picture = draw_annotated(renderer, input, command, frames[i].azimuth, console);
        if (!picture) return picture;
        numbers.draw_seconds += drawing.seconds();
        const Stopwatch writing;
        if (Result<void> added = files.add(*picture); !added) return added.error();
        numbers.write_seconds += writing.seconds();
    }
    const Stopwatch writing;
    if (Result<void> finished = files.finish(); !finished) return finished.error();
    numbers.write_seconds += writing.seconds();
    numbers.bytes = files.bytes();
    numbers.drawing = renderer.work();
    return picture;
}

/// Compares with --reference.
Result<void> compare(const Picture& picture, const Picture& reference, const RenderCommand& command,
                     PictureNumbers& numbers, Console& console) {
    const Result<double> differs = difference(picture, reference);
    if (!differs) return differs.error();
    numbers.differs = *differs;
    if (*differs > command.threshold)
        console.note(fmt::format("{} of the pixels differ from {}, but {} are allowed", percent_text(*differs),
                                 command.reference, percent_text(command.threshold)));
    return {};
}

/// Looks at the names of all files before anything is done.
Result<PictureFiles> open_files(const RenderCommand& command) {
    const Result<std::size_t> pictures = count_frames(command);
    if (!pictures) return pictures.error();
    Result<PictureFiles> files = PictureFiles::open(name_of_picture(command), *pictures, command.frames_per_second);
    if (!files) return files;
    std::vector<std::string> outputs = files->names();
    outputs.push_back(command.common.json);
    if (Result<void> paths = check_output_paths({command.grid.file, command.reference}, outputs); !paths)
        return paths.error();
    return files;
}

/// Refuses options that say how surfaces are extracted, or coloured, where tets are drawn, and an index without them.
Result<void> check_method(const RenderCommand& command) {
    if (!command.method.draw) {
        if (command.index)
            return usage_error("--index finds the tets for a method that draws tets, but surfaces are drawn: --method");
        return {};
    }
    const std::string_view name = name_of(*command.method.draw);
    if (!command.color_by.empty())
        return usage_error("--color-by colours surfaces, but --method {} makes none", name);
    if (command.engine != EngineChoice::automatic)
        return usage_error("--engine says what extracts, but --method {} extracts nothing", name);
    return {};
}

} // namespace

Result<ExitCode> run_render(const RenderCommand& command) {
    Console console(command.common);
    if (Result<void> fits = check_method(command); !fits) return fits.error();
    Result<PictureFiles> files = open_files(command);
    if (!files) return files.error();
    std::optional<Picture> reference;
    if (!command.reference.empty()) {
        Result<Picture> read = read_picture(command.reference);
        if (!read) return read.error();
        reference = *std::move(read);
    }
    const Result<Device> device = open_drawing_device(command.device, console);
    if (!device) return device.error();
    Result<Renderer> renderer = Renderer::create(*device);
    if (!renderer) return renderer.error();
    Result<RenderInput> input = read_render_input(command, *device, console);
    if (!input) return input.error();
    const Result<std::vector<RenderFrame>> frames = frames_of(command, input->isovalues);
    if (!frames) return frames.error();

    PictureNumbers numbers;
    numbers.file = files->out();
    numbers.pictures = frames->size();
    const Result<Picture> last = draw_frames(*frames, command, *renderer, *input, *files, numbers, console);
    if (!last) return last.error();
    if (reference)
        if (Result<void> compared = compare(*last, *reference, command, numbers, console); !compared)
            return compared.error();
    const bool differs = numbers.differs.value_or(0) > command.threshold;
    return finish(console, command.common, render_table(command, *input, *device, numbers),
                  render_json(command, *input, *device, numbers),
                  differs ? ExitCode::check_failed : ExitCode::done);
}

} // namespace isotet::cli
