// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/parallel.hpp"
#include "numbers/at_level.hpp"
#include "render/cpu/clip.hpp"
#include "render/cpu/raster.hpp"

namespace isotet::render {

namespace {

constexpr float reach = 0.35F;      ///< in the scene: farther away nothing is in the way
constexpr float widest_reach = 96;  ///< in pixels of half the picture
constexpr float least_reach = 1.5F; ///< below which nothing can be told
constexpr float slack = 0.05F;      ///< of a horizon's sine: curved surfaces are made of flat triangles
constexpr float gain = 1.7F;        ///< hollows are seldom closed on all sides
constexpr std::size_t slices = 4, steps = 4, places_around = slices * steps;
constexpr std::int64_t pattern = 4; ///< pixels after which directions repeat; they are averaged over as many

/// Directions of the slices and places of the steps, other ones at each pixel of the pattern.
struct Look {
    std::array<float, places_around> cosines, sines, parts; ///< of the directions and of the reach, slice by slice
};

const std::array<Look, pattern * pattern>& looks() {
    static const std::array<Look, pattern * pattern> all = [] {
        // A permutation of 0 to 15 such that neighbours differ much.
        constexpr std::array<std::size_t, 16> turns{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
        std::array<Look, pattern * pattern> made{};
        const auto rounded = [](double x) { return static_cast<float>(std::round(x * 4096) / 4096); };
        for (std::size_t i = 0; i < made.size(); ++i) {
            for (std::size_t place = 0; place < places_around; ++place) {
                const std::size_t slice = place / steps, step = place % steps;
                const double angle =
                    std::numbers::pi * (static_cast<double>(slice) + static_cast<double>(turns[i]) / 16) / slices;
                made[i].cosines[place] = rounded(std::cos(angle));
                made[i].sines[place] = rounded(std::sin(angle));
                const float part = (static_cast<float>(step) + static_cast<float>(turns[(5 * i + 3) % 16] + 1) / 16) /
                                   static_cast<float>(steps);
                made[i].parts[place] = part * part; // more of them near by
            }
        }
        return made;
    }();
    return all;
}

/// From 256ths of a sample to those of a pixel of half the picture.
FixedPoint halved(const FixedPoint& point, std::int32_t samples) {
    const std::int32_t by = 2 * samples;
    const auto part = [&](std::int32_t at) { return at >= 0 ? at / by : -((-at + by - 1) / by); };
    return {part(point.x), part(point.y), point.depth};
}

double length_of(const Row& row) { return std::sqrt(dot(row.along, row.along)); }

} // namespace

Occlusion::Occlusion(const std::vector<Sheet>& sheets, const Bins& bins, const Tiling& tiling, const Screen& screen,
                     const Progress& progress)
    : tiling_(tiling),
      width_((tiling.width + 1) / 2),
      height_((tiling.height + 1) / 2),
      parallel_(screen.sight.parallel),
      depth_shift_(0),
      depth_factor_(static_cast<float>(1 / length_of(screen.sight.z))),
      right_(static_cast<float>(4 / (tiling.width * length_of(screen.sight.x)))),
      down_(static_cast<float>(4 / (tiling.height * length_of(screen.sight.y)))),
      distances_(static_cast<std::size_t>(width_ * height_), INFINITY),
      openness_(distances_.size(), 1.0F) {
    if (!parallel_) {
        const Row &z = screen.sight.z, &w = screen.sight.w;
        const double shift = dot(z.along, w.along) / dot(w.along, w.along);
        depth_shift_ = static_cast<float>(shift);
        depth_factor_ = static_cast<float>(z.shift - shift * w.shift);
    }
    find_distances(sheets, bins, screen, progress);
    find_openness(progress);
    smooth(progress);
}

float Occlusion::distance_of(float depth) const {
    return parallel_ ? depth_factor_ * depth : depth_factor_ / (depth - depth_shift_);
}

/// What is opaque and lit; lines are not in the way of light.
void Occlusion::find_distances(const std::vector<Sheet>& sheets, const Bins& bins, const Screen& screen,
                               const Progress& progress) {
    const auto side = static_cast<std::int64_t>(tiling_.side / 2);
    const auto draw_tile = [&](std::size_t tile) {
        const std::int64_t left = static_cast<std::int64_t>(tile % tiling_.columns()) * side,
                           top = static_cast<std::int64_t>(tile / tiling_.columns()) * side;
        const TileFrame frame{left, top, static_cast<std::int32_t>(std::min(side, width_ - left)),
                              static_cast<std::int32_t>(std::min(side, height_ - top)), 1};
        const auto farthest_in_tile = [&] {
            float farthest = 0;
            for (std::int64_t y = top; y < top + frame.height; ++y)
                farthest = std::max(farthest, *std::max_element(&distances_[place(left, y)],
                                                                &distances_[place(left, y)] + frame.width));
            return farthest;
        };
        constexpr std::size_t triangles_between = 64;
        std::size_t drawn = 0;
        for (const BinEntry& entry : bins.of(tile)) {
            const Sheet& sheet = sheets[entry.sheet];
            if (sheet.translucent || !sheet.lit) continue;
            if (++drawn % triangles_between == 0 && entry.nearest >= farthest_in_tile())
                break; // nor is what follows seen
            const FixedPolygon polygon = polygon_of(sheet, entry.triangle, screen.sight);
            for (std::size_t i = 2; i < polygon.count; ++i) {
                const auto samples = static_cast<std::int32_t>(tiling_.samples);
                const FixedPoint a = halved(polygon.points[0], samples), b = halved(polygon.points[i - 1], samples),
                                 c = halved(polygon.points[i], samples);
                const TileCover cover(a, b, c, frame);
                const DepthPlane plane(a, b, c, frame);
                cover.each_pixel([&](std::int32_t x, std::int32_t y, SampleMask) {
                    const auto depth = static_cast<float>(plane.at_first + x * plane.per_x + y * plane.per_y);
                    float& nearest = distances_[place(left + x, top + y)];
                    nearest = std::min(nearest, std::clamp(depth, plane.lower, plane.upper));
                });
            }
        }
        for (std::int64_t y = top; y < top + frame.height; ++y)
            for (std::int64_t x = left; x < left + frame.width; ++x) {
                float& at = distances_[place(x, y)];
                if (at < INFINITY) at = distance_of(at);
            }
    };
    core::parallel_pieces(tiling_.tiles(), 4, progress, [&](std::size_t begin, std::size_t end) {
        core::at_level([&] {
            for (std::size_t tile = begin; tile < end; ++tile) draw_tile(tile);
        });
    });
}

void Occlusion::find_openness(const Progress& progress) {
    core::parallel_pieces(static_cast<std::size_t>(height_), 8, progress, [&](std::size_t begin, std::size_t end) {
        core::at_level([&] {
            for (auto y = static_cast<std::int64_t>(begin); y < static_cast<std::int64_t>(end); ++y)
                for (std::int64_t x = 0; x < width_; ++x) openness_[place(x, y)] = openness_at(x, y);
        });
    });
}

float Occlusion::openness_at(std::int64_t x, std::int64_t y) const {
    const float distance = distances_[place(x, y)];
    if (!(distance < INFINITY)) return 1;
    const float down = parallel_ ? down_ : down_ * distance;
    const float pixels = std::min(reach / down, widest_reach);
    if (pixels < least_reach) return 1;
    const float square = pixels * down * pixels * down;
    const float to_right = static_cast<float>(2 * x + 1 - width_) / 2,
                to_bottom = static_cast<float>(2 * y + 1 - height_) / 2;
    const Look& look = looks()[static_cast<std::size_t>(y % pattern * pattern + x % pattern)];
    using Places = std::array<float, places_around>;
    std::array<std::int32_t, places_around> dx, dy;
    for (std::size_t i = 0; i < places_around; ++i) {
        const float radius = 1 + look.parts[i] * (pixels - 1);
        dx[i] = static_cast<std::int32_t>(std::floor(radius * look.cosines[i] + 0.5F));
        dy[i] = static_cast<std::int32_t>(std::floor(radius * look.sines[i] + 0.5F));
    }
    std::array<Places, 2> there; // on opposite sides
    for (std::size_t i = 0; i < places_around; ++i)
        for (const std::int64_t side : {1, -1}) {
            const std::int64_t at_x = x + side * dx[i], at_y = y + side * dy[i];
            const bool is_inside = at_x >= 0 && at_y >= 0 && at_x < width_ && at_y < height_;
            there[side < 0][i] = is_inside ? distances_[place(at_x, at_y)] : INFINITY;
        }
    // The sine of how high a place beside this one stands above it, less the farther away it is; -1 where nothing is.
    const float per_x = right_, per_y = down_, narrows = parallel_ ? 0.0F : 1.0F; // no bool: for vectors
    const auto height = [=](float right, float below, float distance_there) {
        const float farther = distance_there - distance;
        const float scale = narrows != 0 ? distance_there : 1, shift = narrows != 0 ? farther : 0;
        const float across = (right * scale + to_right * shift) * per_x,
                    along = (below * scale + to_bottom * shift) * per_y;
        const float length = across * across + along * along + farther * farther;
        const float part = length / square, sine = (1 - part * part) * (1 - farther / std::sqrt(length)) - 1;
        return distance_there < INFINITY && length < square ? sine : -1.0F;
    };
    Places heights;
    for (std::size_t i = 0; i < places_around; ++i) {
        const auto right = static_cast<float>(dx[i]), below = static_cast<float>(dy[i]);
        heights[i] = 0.5F * (height(right, below, there[0][i]) + height(-right, -below, there[1][i])) - slack;
    }
    float closed = 0;
    for (std::size_t slice = 0; slice < slices; ++slice) {
        float highest = 0; // of opposite places: in a plane they stand as high as each other, one above and one below
        for (std::size_t step = 0; step < steps; ++step) highest = std::max(highest, heights[slice * steps + step]);
        closed += highest;
    }
    return std::max(0.0F, 1 - gain * closed / slices);
}

/// The mean over as many pixels as the pattern has, of those of the same surface.
void Occlusion::smooth(const Progress& progress) {
    std::vector<float> smoothed(openness_.size());
    core::parallel_pieces(static_cast<std::size_t>(height_), 8, progress, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<std::int64_t>(begin); y < static_cast<std::int64_t>(end); ++y)
            for (std::int64_t x = 0; x < width_; ++x) {
                const float distance = distances_[place(x, y)];
                float sum = 0, count = 0;
                for (std::int64_t j = std::max<std::int64_t>(y - 2, 0); j < std::min(y + 2, height_); ++j)
                    for (std::int64_t i = std::max<std::int64_t>(x - 2, 0); i < std::min(x + 2, width_); ++i) {
                        if (!(std::abs(distances_[place(i, j)] - distance) < reach / 4)) continue;
                        sum += openness_[place(i, j)];
                        count += 1;
                    }
                smoothed[place(x, y)] = count > 0 ? sum / count : 1;
            }
    });
    openness_ = std::move(smoothed);
}

float Occlusion::openness(std::int64_t x, std::int64_t y, float depth) const {
    const float distance = distance_of(depth);
    // The two nearest pixels each way: three quarters of the one, a quarter of the other.
    const std::int64_t near_x = x / 2, near_y = y / 2;
    const std::int64_t far_x = std::clamp<std::int64_t>(near_x + (x % 2 ? 1 : -1), 0, width_ - 1),
                       far_y = std::clamp<std::int64_t>(near_y + (y % 2 ? 1 : -1), 0, height_ - 1);
    float sum = 0, weights = 0;
    const auto add = [&](std::int64_t at_x, std::int64_t at_y, float weight) {
        const float there = distances_[place(at_x, at_y)];
        if (!(there < INFINITY)) return;
        weight *= std::max(1e-3F, 1 - std::abs(there - distance) * (4 / reach));
        sum += weight * openness_[place(at_x, at_y)];
        weights += weight;
    };
    add(near_x, near_y, 0.5625F);
    add(far_x, near_y, 0.1875F);
    add(near_x, far_y, 0.1875F);
    add(far_x, far_y, 0.0625F);
    return weights > 0 ? sum / weights : 1;
}

} // namespace isotet::render
