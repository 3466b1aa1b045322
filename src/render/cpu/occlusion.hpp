// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How much of what surrounds it each place of an opaque surface sees: folds and hollows become darker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/progress.hpp>

#include "render/cpu/bins.hpp"
#include "render/cpu/sheet.hpp"

namespace isotet::render {

/// From the depths of the picture at half its size. Of places on opposite sides of one, within a reach, the mean height above
/// it counts, so a plane is open however it is seen, and no normals are needed.
///
/// Guarantees   the same for any thread count and on every machine
/// Memory       3 bytes a pixel
class Occlusion {
public:
    Occlusion(const std::vector<Sheet>& sheets, const Bins& bins, const Tiling& tiling, const Screen& screen,
              const Progress& progress);

    /// 1: nothing is in the way; 0: nothing is seen.
    /// `x`, `y`   a pixel
    /// `depth`    of what is seen there
    float openness(std::int64_t x, std::int64_t y, float depth) const;

private:
    void find_distances(const std::vector<Sheet>& sheets, const Bins& bins, const Screen& screen,
                        const Progress& progress);
    void find_openness(const Progress& progress);
    float openness_at(std::int64_t x, std::int64_t y) const;
    void smooth(const Progress& progress);
    float distance_of(float depth) const;
    std::size_t place(std::int64_t x, std::int64_t y) const { return static_cast<std::size_t>(y * width_ + x); }

    Tiling tiling_;
    std::int64_t width_, height_; ///< of half the picture
    bool parallel_;
    float depth_shift_, depth_factor_;   ///< distance = factor / (depth - shift), or factor * depth
    float right_, down_;                 ///< a pixel of half the picture in the scene, at a distance of 1 or at any
    std::vector<float> distances_;       ///< along the view; INFINITY where nothing is
    std::vector<float> openness_;
};

} // namespace isotet::render
