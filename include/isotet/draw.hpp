// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing on the processor: needs no driver.
#pragma once

#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>

namespace isotet {

/// Draws a scene of surfaces in memory and of lines. Light, blending and samples are those of Renderer, which this
/// function is the reference of.
///
/// Guarantees   the same bytes for any thread count and on every machine; beside the picture of Renderer at most 1/255
///              in a channel, except in 0.1 % of the pixels
/// Cost         O(triangles + fragments); transient memory about 60 bytes a vertex, 20 a triangle
/// Errors       invalid_argument when a size, a camera, an opacity or a width is out of range, colours do not fit their
///              surface, or a surface is in a device's memory; invalid_data when a triangle has a vertex that is not
///              there, or a vertex is not finite; out_of_memory; cancelled
/// Threads      safe from many threads
/// Method       tiles of pixels; a depth buffer of samples for what is opaque, sorted lists of fragments for what is
///              not; docs/inside/render.md
ISOTET_API Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run = {});

} // namespace isotet
