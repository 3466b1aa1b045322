// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/pictures/frame_drawer.hpp"

#include <fmt/format.h>

#include "jobs/pictures/picture_text.hpp"

namespace isotet::jobs {

namespace {

/// Where the options want the camera; fit() does the rest, unless it is all given. Isosurfaces of flat grids would be lines
/// along their thin axis.
Camera camera_of_command(const DrawJob& job, const DrawInput& input) {
    const Projection projection = job.parallel ? Projection::parallel : Projection::perspective;
    if (job.camera) return *job.camera;
    if (!job.angles.empty())
        return camera_of(job.angles[0], job.angles[1], job.up.value_or(UpAxis::plus_z), projection);
    const bool along_thin_axis = input.isovalues.empty() && !input.volume && job.sweep.empty() && job.orbit == 0;
    const Box& box = input.scene->bounds();
    const View view = job.view.value_or(along_thin_axis && !box.empty() ? best_view_of(box) : View::iso);
    return job.up ? camera_of(view, *job.up, projection) : camera_of(view, projection);
}

} // namespace

/// What text leaves of the picture; nothing where there is none, or where it is too small.
Result<std::optional<PictureSize>> FrameDrawer::room_for(const Annotation& annotation, PictureSize whole) {
    if (annotation.empty()) return std::optional<PictureSize>();
    Result<std::optional<PictureSize>> room = room_beside(annotation, whole);
    if (!room) return room;
    if (!*room) {
        caller_.note(fmt::format("the picture, {} x {}, is too small for text", whole.width, whole.height));
        return room;
    }
    for (const std::string& text : {annotation.title, annotation.caption}) {
        const Result<std::size_t> missing = count_missing_letters(text);
        if (!missing) return missing.error();
        if (*missing == 0) continue;
        caller_.note(fmt::format("the font of isotet lacks letters of '{}': they are boxes in the picture", text));
        break; // the caption has the title's as a rule
    }
    return room;
}

void FrameDrawer::point_camera(const DrawInput& input, double azimuth, double aspect) {
    if (camera_ && job_.all_steps) return;
    camera_ = camera_of_command(job_, input);
    camera_->orbit(azimuth, 0);
    if (job_.camera) return;
    if (job_.fit_surface) input.scene->fit_surfaces(*camera_, aspect);
    else input.scene->fit(*camera_, aspect, job_.orbit > 0 ? IsosurfaceScene::Fit::orbit : IsosurfaceScene::Fit::once);
    camera_->zoom(job_.zoom);
}

Result<Picture> FrameDrawer::draw(const DrawInput& input, double azimuth) {
    PictureOptions options = job_.picture;
    const PictureSize whole{options.width, options.height};
    Annotation annotation = annotation_of(job_, input);
    const Result<std::optional<PictureSize>> room = room_for(annotation, whole);
    if (!room) return room.error();
    if (*room) {
        options.width = (*room)->width;
        options.height = (*room)->height;
    }
    point_camera(input, azimuth, static_cast<double>(options.width) / options.height);
    options.camera = *camera_;
    options.occlusion = job_.occlusion.value_or(default_occlusion);
    Result<Picture> picture = drawer_.draw(input.scene->scene(), options, caller_.run());
    if (!picture || !*room) return picture;
    if (annotation.orientation) annotation.orientation->camera = *camera_;
    return annotate(*picture, annotation, whole, options.background);
}

} // namespace isotet::jobs
