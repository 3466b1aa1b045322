// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/render.hpp>
#include <isotet/jobs/draw_files.hpp>

#include "jobs/pictures/drawer.hpp"

namespace isotet::jobs {

/// Draws one picture after another. All steps have the camera of the first.
class FrameDrawer {
public:
    FrameDrawer(const DrawJob& job, Drawer& drawer, Caller& caller) : job_(job), drawer_(drawer), caller_(caller) {}

    /// Draws the scene, and writes beside it what belongs to it.
    Result<Picture> draw(const DrawInput& input, double azimuth);

    const Camera& camera() const { return *camera_; } ///< of the last picture

private:
    Result<std::optional<PictureSize>> room_for(const Annotation& annotation, PictureSize whole);
    void point_camera(const DrawInput& input, double azimuth, double aspect);

    const DrawJob& job_;
    Drawer& drawer_;
    Caller& caller_;
    std::optional<Camera> camera_;
};

} // namespace isotet::jobs
