// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render`: a picture of isosurfaces, or of a surface.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <isotet/annotation.hpp>
#include <isotet/compare_pictures.hpp>
#include <isotet/picture_file.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "drawer.hpp"
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

/// Where the options want the camera; fit() does the rest, unless it is all given.
Camera camera_of_command(const RenderCommand& command) {
    const Projection projection = command.parallel ? Projection::parallel : Projection::perspective;
    if (command.camera) return *command.camera;
    if (!command.angles.empty())
        return camera_of(command.angles[0], command.angles[1], command.up.value_or(UpAxis::plus_z), projection);
    return command.up ? camera_of(command.view, *command.up, projection) : camera_of(command.view, projection);
}

/// Draws one picture after another. All steps have the camera of the first.
class FrameDrawer {
public:
    FrameDrawer(const RenderCommand& command, Drawer& drawer, Console& console)
        : command_(command), drawer_(drawer), console_(console) {}

    /// Draws the scene, and writes beside it what belongs to it.
    Result<Picture> draw(const RenderInput& input, double azimuth);

    const Camera& camera() const { return *camera_; } ///< of the last picture

private:
    Result<std::optional<PictureSize>> room_for(const Annotation& annotation, PictureSize whole);
    void point_camera(const RenderInput& input, double azimuth, double aspect);

    const RenderCommand& command_;
    Drawer& drawer_;
    Console& console_;
    std::optional<Camera> camera_;
};

/// What text leaves of the picture; nothing where there is none, or where it is too small.
Result<std::optional<PictureSize>> FrameDrawer::room_for(const Annotation& annotation, PictureSize whole) {
    if (annotation.empty()) return std::optional<PictureSize>();
    Result<std::optional<PictureSize>> room = room_beside(annotation, whole);
    if (!room) return room;
    if (!*room) {
        console_.note(fmt::format("the picture, {} x {}, is too small for text", whole.width, whole.height));
        return room;
    }
    for (const std::string& text : {annotation.title, annotation.caption}) {
        const Result<std::size_t> missing = count_missing_letters(text);
        if (!missing) return missing.error();
        if (*missing == 0) continue;
        console_.note(fmt::format("the font of isotet lacks letters of '{}': they are boxes in the picture", text));
        break; // the caption has the title's as a rule
    }
    return room;
}

void FrameDrawer::point_camera(const RenderInput& input, double azimuth, double aspect) {
    if (camera_ && command_.all_steps) return;
    camera_ = camera_of_command(command_);
    camera_->orbit(azimuth, 0);
    if (command_.camera) return;
    if (command_.fit_surface) input.scene->fit_surfaces(*camera_, aspect);
    else
        input.scene->fit(*camera_, aspect,
                         command_.orbit > 0 ? IsosurfaceScene::Fit::orbit : IsosurfaceScene::Fit::once);
    camera_->zoom(command_.zoom);
}

Result<Picture> FrameDrawer::draw(const RenderInput& input, double azimuth) {
    PictureOptions options = command_.picture;
    const PictureSize whole{options.width, options.height};
    Annotation annotation = annotation_of(command_, input);
    const Result<std::optional<PictureSize>> room = room_for(annotation, whole);
    if (!room) return room.error();
    if (*room) {
        options.width = (*room)->width;
        options.height = (*room)->height;
    }
    point_camera(input, azimuth, static_cast<double>(options.width) / options.height);
    options.camera = *camera_;
    Result<Picture> picture = drawer_.draw(input.scene->scene(), options, console_.run());
    if (!picture || !*room) return picture;
    if (annotation.orientation) annotation.orientation->camera = *camera_;
    return annotate(*picture, annotation, whole, options.background);
}

/// Extracts, draws and writes one picture after another; returns the last one.
Result<Picture> draw_frames(const std::vector<RenderFrame>& frames, const RenderCommand& command, Drawer& drawer,
                            RenderSource& source, RenderInput& input, PictureFiles& files, PictureNumbers& numbers,
                            Console& console) {
    std::shared_ptr<const Picture> last;
    FrameDrawer frame_drawer(command, drawer, console);
    PictureWriter writer(files, frames.size() > 1 && console.run().threads != 1);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (console.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (frames.size() > 1) console.detail(fmt::format("picture {} of {}", i + 1, frames.size()));
        const bool next_step = i > 0 && frames[i].step != frames[i - 1].step;
        if (next_step) {
            Result<RenderInput> next = source.read(frames[i].step, drawer.device(), console);
            if (!next) return next.error();
            next->read_seconds += input.read_seconds;
            input = *std::move(next);
        }
        if (i == 0 || next_step || frames[i].isovalues != frames[i - 1].isovalues) {
            if (auto shown = input.scene->show(frames[i].isovalues, console.run()); !shown) return shown.error();
            console.notes(input.scene->take_notes());
            note_empty_surfaces(input, console);
        }
        const Stopwatch drawing;
        Result<Picture> picture = frame_drawer.draw(input, frames[i].azimuth);
        if (!picture) return picture;
        last = std::make_shared<const Picture>(*std::move(picture));
        numbers.draw_seconds += drawing.seconds();
        const Stopwatch writing;
        if (Result<void> added = writer.add(last); !added) return added.error();
        numbers.write_seconds += writing.seconds();
    }
    const Stopwatch writing;
    if (Result<void> finished = writer.finish(); !finished) return finished.error();
    numbers.write_seconds += writing.seconds();
    numbers.bytes = files.bytes();
    numbers.drawing = drawer.work();
    numbers.camera = to_text(frame_drawer.camera());
    console.detail("--camera " + numbers.camera);
    if (const std::string film = files.film_command(command.frames_per_second); !film.empty())
        console.note("a film of them: " + film);
    return *last;
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
Result<PictureFiles> open_files(const RenderCommand& command, std::size_t steps) {
    const Result<std::size_t> pictures = count_frames(command, steps);
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
    if (!command.color_by.empty()) return usage_error("--color-by colours surfaces, but --method {} makes none", name);
    if (command.engine != EngineChoice::automatic)
        return usage_error("--engine says what extracts, but --method {} extracts nothing", name);
    return {};
}

} // namespace

Result<ExitCode> run_render(const RenderCommand& command) {
    Console console(command.common);
    if (Result<void> fits = check_method(command); !fits) return fits.error();
    // The number of steps is known only when the file was looked into; all else is checked before.
    std::optional<PictureFiles> files;
    const auto open = [&](std::size_t steps) -> Result<void> {
        Result<PictureFiles> opened = open_files(command, steps);
        if (!opened) return opened.error();
        files = *std::move(opened);
        return {};
    };
    if (!command.all_steps)
        if (Result<void> opened = open(1); !opened) return opened.error();
    std::optional<Picture> reference;
    if (!command.reference.empty()) {
        Result<Picture> read = read_picture(command.reference);
        if (!read) return read.error();
        reference = *std::move(read);
    }
    Result<Drawer> drawer = Drawer::open(command, console);
    if (!drawer) return drawer.error();
    Result<RenderSource> source = RenderSource::open(command, console);
    if (!source) return source.error();
    if (!files)
        if (Result<void> opened = open(source->steps()); !opened) return opened.error();
    Result<RenderInput> input = source->read(0, drawer->device(), console);
    if (!input) return input.error();
    const Result<std::vector<RenderFrame>> frames = frames_of(command, input->isovalues, source->steps());
    if (!frames) return frames.error();

    PictureNumbers numbers;
    numbers.file = files->out();
    numbers.pictures = frames->size();
    const Result<Picture> last = draw_frames(*frames, command, *drawer, *source, *input, *files, numbers, console);
    if (!last) return last.error();
    if (reference)
        if (Result<void> compared = compare(*last, *reference, command, numbers, console); !compared)
            return compared.error();
    const bool differs = numbers.differs.value_or(0) > command.threshold;
    return finish(console, command.common, render_table(command, *input, drawer->device(), numbers),
                  render_json(command, *input, drawer->device(), numbers),
                  differs ? ExitCode::check_failed : ExitCode::done);
}

} // namespace isotet::cli
