// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing on the processor: needs no driver.
#pragma once

#include <cstdint>

#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>

namespace isotet {

/// What drawing the volumes of a scene took.
struct VolumeWork {
    std::uint64_t clusters = 0; ///< that are neither transparent nor out of view
    std::uint64_t tets = 0;     ///< placed in a tile of the picture, each in each tile
    std::uint64_t segments = 0; ///< of rays in tets
    std::uint64_t bytes = 0;    ///< of memory beyond scene and picture
};

/// Draws a scene of surfaces in memory, of lines and of volumes. Light, blending and samples are those of Renderer,
/// which this function is the reference of. Through volumes one ray a pixel is followed, in its middle: what is opaque
/// ends it sample by sample, what is translucent stands where it is in the pixel's middle.
///
/// `work`       becomes what volumes took
/// Guarantees   the same bytes for any thread count and on every machine, and however points of a volume are numbered
///              and its tets ordered; without volumes, beside the picture of Renderer at most 1/255 in a channel, except
///              in 0.1 % of the pixels. What a homogeneous medium lets through is right to 2 x 10^-5
/// Cost         O(triangles + fragments); transient memory about 60 bytes a vertex, 20 a triangle. Of volumes
///              O(clusters + tets that are not transparent, in each tile + segments); 8 bytes a group of 32 tets, 3 MB a
///              thread
/// Errors       invalid_argument when a size, a camera, an opacity or a width is out of range, colours do not fit their
///              surface, a surface is in a device's memory, or a volume has no grid, or a wrong scale, opacity, length
///              or isovalue; invalid_data when a triangle has a vertex that is not there, or a vertex is not finite;
///              out_of_memory; cancelled
/// Threads      safe from many threads
/// Method       tiles of pixels; a depth buffer of samples for what is opaque, sorted lists of fragments for what is
///              not, and of segments of rays in tets; docs/inside/render.md
ISOTET_API Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run = {});
ISOTET_API Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run, VolumeWork& work);

} // namespace isotet
