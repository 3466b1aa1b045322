// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// draw() with lists of other sizes, or without leaving anything out: for tests, which find that no picture shows it.
#pragma once

#include <isotet/render.hpp>

#include "render/volume/volume_tile.hpp"

namespace isotet::render {

Result<Picture> draw_tuned(const Scene& scene, const PictureOptions& options, const VolumeTuning& tuning,
                           const Run& run, VolumeWork& work);

} // namespace isotet::render
