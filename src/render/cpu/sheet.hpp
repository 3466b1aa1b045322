// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is drawn, placed in the picture: the vertices and triangles of a surface, or of lines.
#pragma once

#include <array>
#include <cstdint>

#include <isotet/result.hpp>
#include <isotet/scene.hpp>

#include "base/buffer.hpp"
#include "render/color/linear_light.hpp"
#include "render/space.hpp"

namespace isotet::render {

/// Places in the picture are counted in 256ths of a sample, as graphics cards do: triangles that share an edge then
/// have just the same edge.
inline constexpr int fixed_bits = 8;
inline constexpr std::int32_t fixed_one = 1 << fixed_bits;

/// A corner of triangles as tiles fill them.
struct FixedPoint {
    std::int32_t x, y;
    float depth; ///< 0 nearest, 1 farthest
};

/// A vertex in the picture.
///
/// `x`, `y`   in samples from the upper left corner of the picture, times w
struct PlacedVertex {
    double x, y, w;
    std::array<float, 3> place; ///< in the scene
};
inline constexpr std::int32_t out_of_view = INT32_MIN;

enum class Coloring : std::uint8_t { one_color, by_vertex, by_triangle };

/// A surface, or lines of one colour (`lit` is false), ready to be drawn.
struct Sheet {
    core::Buffer<PlacedVertex> vertices;
    core::Buffer<FixedPoint> fixed; ///< where they are; x is `out_of_view` where triangles must be clipped first
    core::Buffer<std::uint32_t> triangles; ///< three vertices each
    core::Buffer<float> normals;           ///< three a vertex, or empty
    core::Buffer<float> values, table;     ///< color_places() and color_table()
    Coloring coloring = Coloring::one_color;
    float log_factor = 0;
    Light color{}, no_data{};
    float log_transparency = 0; ///< log2(1 - opacity) of the sheet seen at a right angle
    bool translucent = false, lit = true;

    std::size_t triangle_count() const noexcept { return triangles.size() / 3; }
};

/// The picture in samples, and how the scene is seen.
struct Screen {
    Sight sight;
    std::uint32_t width = 0, height = 0; ///< pixels
    std::uint32_t samples = 0;           ///< an axis and pixel

    PlacedVertex placed(const std::array<float, 3>& place) const;
    FixedPoint fixed(const PlacedVertex& vertex) const;
};

/// Where a vertex is; out_of_view before the nearest and behind the farthest depth, and far beside the picture.
FixedPoint fixed_point(double x, double y, double z, double w);

/// Errors   as draw()
Result<Sheet> sheet_of(const DrawnSurface& drawn, const Space& space, const Screen& screen);

/// Errors   as draw()
Result<Sheet> sheet_of(const DrawnLines& lines, const Space& space, const Screen& screen);

} // namespace isotet::render
