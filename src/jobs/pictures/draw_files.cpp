// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/draw_files.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <isotet/picture.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/memory.hpp>

#include "base/stopwatch.hpp"
#include "jobs/extract_notes.hpp"
#include "jobs/pictures/frame_drawer.hpp"
#include "jobs/pictures/picture_files.hpp"
#include "jobs/pictures/picture_source.hpp"
#include "jobs/pictures/picture_text.hpp"
#include "jobs/refuse.hpp"
#include "jobs/way_out.hpp"

namespace isotet::jobs {

namespace {

/// "run/grid.vtu" gives "grid.png", "make:kuhn:64" gives "kuhn.png".
std::string name_of_picture(const DrawJob& job) {
    if (!job.out.empty()) return job.out;
    const std::string& file = job.grid.file;
    constexpr std::string_view made = "make:";
    if (file.starts_with(made)) return file.substr(made.size(), file.find(':', made.size()) - made.size()) + ".png";
    return std::filesystem::path(file).stem().string() + ".png";
}

/// Shows the isovalues of a frame: as surfaces, or of a sweep through a volume as its peak of opacity or its isosurface.
Result<void> show_frame(const DrawJob& job, DrawInput& input, const std::vector<double>& isovalues, const Run& run) {
    if (!input.volume || job.sweep.empty()) return input.scene->show(isovalues, run);
    const FieldReport& field = input.scene->report().field;
    if (!draws_dirac(job))
        input.volume->opacity = opacity_of(OpacityPreset::peaks, {field.lower, field.upper}, isovalues);
    else input.volume->isosurfaces = isovalues;
    input.scene->set_volume(*input.volume);
    return input.scene->show({}, run);
}

/// Isovalues that are all outside the range of the field were not meant. Solids and volumes show something there, too.
Result<void> check_that_some_meet(const DrawJob& job, const DrawInput& input, const std::vector<double>& isovalues) {
    const bool is_asked = !job.isovalues.empty() && job.sweep.empty() && !job.solid && !draws_volume(job);
    const auto is_empty = [](const ShownSurface& surface) { return surface.triangles == 0; };
    if (!is_asked || job.allow_empty || job.all_steps || !std::ranges::all_of(input.scene->surfaces(), is_empty))
        return {};
    const std::string why = why_all_are_empty(input.scene->report().field, isovalues, job.decimal_comma);
    if (why.empty()) return {};
    return Error{ErrorCode::invalid_data, why + "; `allow_empty` draws it nevertheless"};
}

/// Extracts, draws and writes one picture after another; returns the last one.
Result<Picture> draw_frames(const std::vector<Frame>& frames, const DrawJob& job, Drawer& drawer, PictureSource& source,
                            DrawInput& input, PictureFiles& files, PictureNumbers& numbers, Caller& caller) {
    std::shared_ptr<const Picture> last;
    FrameDrawer frame_drawer(job, drawer, caller);
    PictureWriter writer(files, frames.size() > 1 && caller.run().threads != 1);
    bool sees_volume = false;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (caller.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (frames.size() > 1) caller.detail(fmt::format("picture {} of {}", i + 1, frames.size()));
        const bool next_step = i > 0 && frames[i].step != frames[i - 1].step;
        if (next_step) {
            input.scene.reset(); // the step behind is read ahead now
            Result<DrawInput> next = source.read(frames[i].step, drawer.device(), caller);
            if (!next) return Error{next.error().code, fmt::format("picture {}: {}", i + 1, next.error().message)};
            next->read_seconds += input.read_seconds;
            input = *std::move(next);
        }
        if (i == 0 || next_step || frames[i].isovalues != frames[i - 1].isovalues) {
            if (auto shown = show_frame(job, input, frames[i].isovalues, caller.run()); !shown) return shown.error();
            if (auto met = check_that_some_meet(job, input, frames[i].isovalues); !met) return met.error();
            caller.notes(input.scene->take_notes());
            note_what_is_empty(job, input, caller);
        }
        const core::Stopwatch drawing;
        Result<Picture> picture = frame_drawer.draw(input, frames[i].azimuth);
        if (!picture) return picture;
        last = std::make_shared<const Picture>(*std::move(picture));
        sees_volume = sees_volume || drawer.volume_work().segments > 0;
        numbers.draw_seconds += drawing.seconds();
        const core::Stopwatch writing;
        if (Result<void> added = writer.add(last); !added) return added.error();
        numbers.write_seconds += writing.seconds();
    }
    const core::Stopwatch writing;
    if (Result<void> finished = writer.finish(); !finished) return finished.error();
    numbers.write_seconds += writing.seconds();
    numbers.bytes = files.bytes();
    numbers.drawing = drawer.work();
    numbers.volume = drawer.volume_work();
    numbers.peak_memory = peak_resident_memory();
    numbers.camera = to_text(frame_drawer.camera());
    caller.detail("`camera` " + numbers.camera);
    if (input.volume && !sees_volume && input.volume->isosurfaces.empty())
        caller.note(fmt::format(
            "nothing of the volume is seen: in view no cell has a value of '{}' that is not transparent", input.field));
    if (const std::string film = files.film_command(job.frames_per_second); !film.empty())
        caller.note("a film of them: " + film);
    return *last;
}

/// Compares with the reference.
Result<void> compare(const Picture& picture, const Picture& reference, const DrawJob& job, PictureNumbers& numbers,
                     Caller& caller) {
    const Result<double> differs = difference(picture, reference);
    if (!differs) return differs.error();
    numbers.differs = *differs;
    if (*differs > job.threshold)
        caller.note(fmt::format("{} of the pixels differ from {}, but {} are allowed", percent_text(*differs),
                                job.reference, percent_text(job.threshold)));
    return {};
}

/// Looks at the names of all files before anything is done.
Result<PictureFiles> open_files(const DrawJob& job, std::size_t steps) {
    const Result<std::size_t> pictures = count_frames(job, steps);
    if (!pictures) return pictures.error();
    const bool is_series = job.all_steps || job.orbit > 0 || !job.sweep.empty();
    Result<PictureFiles> files = PictureFiles::open(name_of_picture(job), *pictures, is_series, job.frames_per_second);
    if (!files) return files;
    std::vector<std::string> outputs = files->names();
    outputs.insert(outputs.end(), job.other_outputs.begin(), job.other_outputs.end());
    std::vector<std::string> inputs{job.grid.file, job.reference};
    inputs.insert(inputs.end(), job.grid.other_inputs.begin(), job.grid.other_inputs.end());
    if (Result<void> paths = check_output_paths(inputs, outputs); !paths) return paths.error();
    return files;
}

/// Refuses options that say how surfaces are extracted, or coloured, where tets are drawn, and an index without them.
Result<void> check_method(const DrawJob& job) {
    if (!job.method.draw) {
        if (job.index)
            return refusal("`index` finds the tets for a method that draws tets, but surfaces are drawn: `method`");
        return {};
    }
    const std::string_view name = name_of(*job.method.draw);
    if (!job.color_by.empty()) return refusal("`color_by` colours surfaces, but `method` {} makes none", name);
    if (job.engine != EngineChoice::automatic)
        return refusal("`engine` says what extracts, but `method` {} extracts nothing", name);
    return {};
}

/// Refuses what makes no solids.
Result<void> check_drawn_solid(const DrawJob& job) {
    if (!job.solid) return {};
    if (job.method.draw)
        return refusal("`solid` draws surfaces, but `method` {} makes none", name_of(*job.method.draw));
    if (draws_volume(job)) return refusal("`solid` was asked for, which does not go with `volume`");
    if (job.engine == EngineChoice::vulkan)
        return refusal("`solid` is made by the CPU, but `engine` vulkan was asked for");
    return {};
}

/// Refuses what finds no parts of surfaces.
Result<void> check_drawn_parts(const DrawJob& job) {
    if (!job.keep) return {};
    if (job.keep->kind == PartChoice::Kind::touching && job.keep->region != "boundary")
        return refusal(
            "`keep` touching got '{}', but a picture knows only 'boundary': isotet extract keeps what touches "
            "other regions, and isotet render draws its file",
            job.keep->region);
    if (job.method.draw)
        return refusal("`keep` is for parts of surfaces, but `method` {} makes none", name_of(*job.method.draw));
    if (job.engine == EngineChoice::vulkan)
        return refusal("`keep` needs surfaces of the CPU, but `engine` vulkan was asked for");
    return {};
}

/// Refuses what does not go with a volume, or needs one.
Result<void> check_volume(const DrawJob& job) {
    if (!draws_volume(job)) {
        if (job.volume_opacity) return refusal("`opacity` by values of the field is that of a volume: `volume`");
        if (job.opacity_length) return refusal("`opacity_length` is that of a volume: `volume`");
        if (job.volume_shading) return refusal("`volume_shading` is that of a volume: `volume`");
        return {};
    }
    if (job.method.draw)
        return refusal("`volume` draws a volume, but `method` {} draws tets", name_of(*job.method.draw));
    if (job.method.extract == Method::direct)
        return refusal("`volume` needs the grid in clusters, but `method` direct packs nothing");
    if (job.opacity_length && !(*job.opacity_length > 0))
        return refusal("`opacity_length` is {}, but it must be above 0", shortest(*job.opacity_length));
    if (!job.sweep.empty() && job.volume_opacity && job.volume_opacity->preset != OpacityPreset::peaks)
        return refusal("`sweep` moves a peak of opacity through the volume, but `opacity` says where it is");
    return {};
}

Result<DrawReport> draw_all(const DrawJob& job, Caller& caller) {
    if (Result<void> fits = check_method(job); !fits) return fits.error();
    if (Result<void> fits = check_volume(job); !fits) return fits.error();
    if (Result<void> fits = check_drawn_solid(job); !fits) return fits.error();
    if (Result<void> fits = check_drawn_parts(job); !fits) return fits.error();
    // The number of steps is known only when the file was looked into; all else is checked before.
    std::optional<PictureFiles> files;
    const auto open = [&](std::size_t steps) -> Result<void> {
        Result<PictureFiles> opened = open_files(job, steps);
        if (!opened) return opened.error();
        files = *std::move(opened);
        return {};
    };
    if (!job.all_steps)
        if (Result<void> opened = open(1); !opened) return opened.error();
    std::optional<Picture> reference;
    if (!job.reference.empty()) {
        Result<Picture> read = read_picture(job.reference);
        if (!read) return read.error();
        reference = *std::move(read);
    }
    Result<Drawer> drawer = Drawer::open(job, caller);
    if (!drawer) return drawer.error();
    Result<PictureSource> source = PictureSource::open(job, caller);
    if (!source) return source.error();
    if (!files)
        if (Result<void> opened = open(source->steps()); !opened) return opened.error();
    DrawReport report;
    Result<DrawInput> input = source->read(0, drawer->device(), caller);
    if (!input) return input.error();
    report.input = *std::move(input);
    const Result<std::vector<Frame>> frames = frames_of(job, report.input, source->steps());
    if (!frames) return frames.error();
    report.pictures.file = files->out();
    report.pictures.pictures = frames->size();
    const Result<Picture> last =
        draw_frames(*frames, job, *drawer, *source, report.input, *files, report.pictures, caller);
    if (!last) return last.error();
    report.device = drawer->info();
    source->tell_what_was_read(caller);
    if (reference)
        if (Result<void> compared = compare(*last, *reference, job, report.pictures, caller); !compared)
            return compared.error();
    return report;
}

} // namespace

Result<DrawReport> draw_files(const DrawJob& job, Caller& caller) {
    return with_way_out("drawing",
                        "a packed file (isotet pack), or the picture of a surface that isotet extract wrote,",
                        [&] { return draw_all(job, caller); });
}

} // namespace isotet::jobs
