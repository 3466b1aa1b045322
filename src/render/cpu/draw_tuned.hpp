// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// draw() with lists of other sizes, or without leaving anything out: for tests, which find that no picture shows it. And
// with rays that a device follows, which no picture shows either.
#pragma once

#include <isotet/render.hpp>

#include "render/volume/volume_tile.hpp"

namespace isotet::render {

Result<Picture> draw_tuned(const Scene& scene, const PictureOptions& options, const VolumeTuning& tuning,
                           const Run& run, VolumeWork& work);

/// `follower`   of rays through volumes; null: the processor
Result<Picture> draw_with(const Scene& scene, const PictureOptions& options, const VolumeTuning& tuning,
                          RayFollower* follower, const Progress& progress, VolumeWork& work);

} // namespace isotet::render
