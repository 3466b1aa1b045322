// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which samples of a tile a triangle covers. Exact: a sample on an edge that two triangles share belongs to one of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "render/cpu/sheet.hpp"

namespace isotet::render {

/// A tile: its first sample in the picture, and its size in pixels.
struct TileFrame {
    std::int64_t x = 0, y = 0;
    std::int32_t width = 0, height = 0;
    std::int32_t samples = 0; ///< an axis and pixel
};

/// Samples of a pixel, bit `row * samples + column` each.
using SampleMask = std::uint64_t;
inline SampleMask first_samples(std::int64_t count) {
    return count >= 64 ? ~SampleMask{0} : (SampleMask{1} << count) - 1;
}

/// An edge of a triangle that lies to its right: `at(x, y)` of a sample is not negative inside.
struct FixedEdge {
    std::int64_t constant, per_x, per_y;

    FixedEdge() = default;
    FixedEdge(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
        const std::int64_t dx = bx - ax, dy = by - ay;
        const bool owns_samples_on_it = dy < 0 || (dy == 0 && dx > 0); // left edges and upper ones do
        constant = dy * ax - dx * ay - (owns_samples_on_it ? 0 : 1);
        per_x = -dy * fixed_one;
        per_y = dx * fixed_one;
    }
    std::int64_t at(std::int64_t x, std::int64_t y) const { return constant + per_x * x + per_y * y; }
};

/// The samples of a pixel at which three edges are not negative, from their values at its first sample and what is added
/// for each of the others. As many of `offsets` are read as there are samples, rounded up to a multiple of 4.
using SampleOffsets = std::array<std::array<std::int32_t, 64>, 3>;
inline SampleMask samples_inside(const std::array<std::int32_t, 3>& first, const SampleOffsets& offsets,
                                 std::size_t samples) {
    SampleMask mask = 0;
#if defined(__SSE2__)
    const __m128i a = _mm_set1_epi32(first[0]), b = _mm_set1_epi32(first[1]), c = _mm_set1_epi32(first[2]);
    const auto four = [&](std::size_t edge, std::size_t i) {
        return _mm_loadu_si128(reinterpret_cast<const __m128i*>(&offsets[edge][i]));
    };
    for (std::size_t i = 0; i < samples; i += 4) {
        const __m128i negative = _mm_or_si128(_mm_or_si128(_mm_add_epi32(a, four(0, i)), _mm_add_epi32(b, four(1, i))),
                                              _mm_add_epi32(c, four(2, i)));
        mask |= static_cast<SampleMask>(_mm_movemask_ps(_mm_castsi128_ps(negative)) ^ 15) << i;
    }
    return mask & first_samples(static_cast<std::int64_t>(samples));
#else
    for (std::size_t i = 0; i < samples; ++i)
        mask |= SampleMask{((first[0] + offsets[0][i]) | (first[1] + offsets[1][i]) | (first[2] + offsets[2][i])) >= 0}
                << i;
    return mask;
#endif
}

/// A triangle in a tile, its samples row by row.
class TileCover {
public:
    TileCover(const FixedPoint& a, const FixedPoint& b, const FixedPoint& c, const TileFrame& frame) : frame_(frame) {
        const std::int64_t x0 = frame.x * fixed_one + fixed_one / 2, y0 = frame.y * fixed_one + fixed_one / 2;
        std::array<std::int64_t, 3> x{a.x - x0, b.x - x0, c.x - x0}, y{a.y - y0, b.y - y0, c.y - y0};
        const std::int64_t doubled_area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        if (doubled_area == 0) return;
        if (doubled_area < 0) {
            std::swap(x[1], x[2]);
            std::swap(y[1], y[2]);
        }
        const auto lowest = [](std::int64_t at) {
            return std::max<std::int64_t>((at + fixed_one - 1) >> fixed_bits, 0);
        };
        const auto [left, right] = std::minmax({x[0], x[1], x[2]});
        const auto [top, bottom] = std::minmax({y[0], y[1], y[2]});
        first_x_ = lowest(left);
        first_y_ = lowest(top);
        last_x_ = std::min<std::int64_t>(right >> fixed_bits, frame.width * frame.samples - 1);
        last_y_ = std::min<std::int64_t>(bottom >> fixed_bits, frame.height * frame.samples - 1);
        is_small_ = right - left <= small && bottom - top <= small;
        for (std::size_t i = 0; i < 3; ++i) {
            edges_[i] = FixedEdge(x[i], y[i], x[(i + 1) % 3], y[(i + 1) % 3]);
            const FixedEdge& edge = edges_[i];
            if (edge.at(edge.per_x > 0 ? last_x_ : first_x_, edge.per_y > 0 ? last_y_ : first_y_) < 0) last_y_ = -1;
        }
    }

    /// Calls emit(x, y, mask) for each pixel of the tile of which the triangle covers samples.
    template <class Emit>
    void each_pixel(const Emit& emit) const {
        if (first_x_ > last_x_ || first_y_ > last_y_) return;
        const std::int64_t s = frame_.samples;
        if (is_small_) return each_pixel_of_small(emit);
        std::array<double, 3> inverses{}; // of what a sample to the right adds, rounded
        for (std::size_t e = 0; e < 3; ++e)
            if (edges_[e].per_x != 0) inverses[e] = 1 / static_cast<double>(edges_[e].per_x);
        for (std::int64_t row = first_y_ / s; row <= last_y_ / s; ++row) pixel_row(row, inverses, emit);
    }

private:
    /// Up to 24 samples wide and high every sample around is tested: that takes less than to find where rows begin and
    /// end. The values of edges then fit 32 bits: 24 and 8 samples are 2^13 steps, and a value is the sum of two products.
    static constexpr std::int64_t small = 24 * fixed_one;

    template <class Emit>
    void each_pixel_of_small(const Emit& emit) const {
        const std::int64_t s = frame_.samples;
        const auto samples = static_cast<std::size_t>(s * s);
        SampleOffsets offsets;
        for (std::size_t e = 0; e < 3; ++e) {
            const auto per_x = static_cast<std::int32_t>(edges_[e].per_x),
                       per_y = static_cast<std::int32_t>(edges_[e].per_y);
            std::int32_t* offset = offsets[e].data();
            for (std::int32_t row = 0; row < frame_.samples; ++row)
                for (std::int32_t column = 0; column < frame_.samples; ++column)
                    *offset++ = per_y * row + per_x * column;
            std::fill(offset, offsets[e].data() + (samples + 3) / 4 * 4, 0);
        }
        const std::int64_t begin = first_x_ / s, end = last_x_ / s;
        std::array<std::int32_t, 3> first, per_pixel;
        for (std::size_t e = 0; e < 3; ++e) per_pixel[e] = static_cast<std::int32_t>(edges_[e].per_x * s);
        for (std::int64_t row = first_y_ / s; row <= last_y_ / s; ++row) {
            for (std::size_t e = 0; e < 3; ++e) first[e] = static_cast<std::int32_t>(edges_[e].at(begin * s, row * s));
            for (std::int64_t x = begin; x <= end; ++x) {
                if (const SampleMask mask = samples_inside(first, offsets, samples))
                    emit(static_cast<std::int32_t>(x), static_cast<std::int32_t>(row), mask);
                if (x == end) break;
                for (std::size_t e = 0; e < 3; ++e) first[e] += per_pixel[e];
            }
        }
    }

    struct Span {
        std::int64_t begin = 0, end = 0; ///< samples
    };

    /// The samples of a row that are inside all edges. An estimate of where each edge crosses it is less than one
    /// sample off within the tile; then exact tests.
    Span span_of(std::int64_t y, const std::array<double, 3>& inverses) const {
        std::int64_t begin = first_x_, end = last_x_ + 1;
        for (std::size_t e = 0; e < 3; ++e) {
            const FixedEdge& edge = edges_[e];
            const std::int64_t at_0 = edge.constant + edge.per_y * y;
            const auto is_inside = [&](std::int64_t x) { return at_0 + edge.per_x * x >= 0; };
            const double crossing = -static_cast<double>(at_0) * inverses[e];
            const auto limited = [&](double x) {
                return static_cast<std::int64_t>(
                    std::min(std::max(x, static_cast<double>(begin)), static_cast<double>(end)));
            };
            if (edge.per_x > 0) {
                std::int64_t x = limited(crossing);
                x += !is_inside(x);
                x += !is_inside(x);
                begin = x;
            } else if (edge.per_x < 0) {
                const std::int64_t x = limited(crossing + 1);
                end = x > begin && !is_inside(x - 1) ? x - 1 : x + (x < end && is_inside(x));
            } else if (at_0 < 0) {
                return {};
            }
            if (begin >= end) return {};
        }
        return {begin, end};
    }

    template <class Emit>
    void pixel_row(std::int64_t row, const std::array<double, 3>& inverses, const Emit& emit) const {
        const std::int64_t s = frame_.samples, first = std::max(row * s, first_y_),
                           last = std::min(row * s + s - 1, last_y_);
        std::array<Span, 8> spans;
        std::int64_t begin = INT64_MAX, end = 0, full_begin = 0, full_end = INT64_MAX;
        for (std::int64_t y = first; y <= last; ++y) {
            const Span& span = spans[static_cast<std::size_t>(y - row * s)] = span_of(y, inverses);
            if (span.begin == span.end) {
                full_end = 0;
                continue;
            }
            begin = std::min(begin, span.begin);
            end = std::max(end, span.end);
            full_begin = std::max(full_begin, span.begin);
            full_end = std::min(full_end, span.end);
        }
        if (begin >= end) return;
        if (last - first + 1 < s) full_end = 0;
        for (std::int64_t x = begin / s; x <= (end - 1) / s; ++x) {
            SampleMask mask = 0;
            if (x * s >= full_begin && (x + 1) * s <= full_end) {
                mask = first_samples(s * s);
            } else {
                for (std::int64_t y = first; y <= last; ++y) {
                    const Span& span = spans[static_cast<std::size_t>(y - row * s)];
                    const std::int64_t from = std::max(span.begin - x * s, std::int64_t{0}),
                                       to = std::min(span.end - x * s, s);
                    if (from < to) mask |= (first_samples(to) & ~first_samples(from)) << ((y - row * s) * s);
                }
                if (mask == 0) continue;
            }
            emit(static_cast<std::int32_t>(x), static_cast<std::int32_t>(row), mask);
        }
    }

    const TileFrame& frame_;
    std::array<FixedEdge, 3> edges_{};
    std::int64_t first_x_ = 0, first_y_ = 0, last_x_ = -1, last_y_ = -1;
    bool is_small_ = false;
};

/// Depth over a tile: linear in the place of a sample, and nowhere beyond that of the corners.
struct DepthPlane {
    double at_first = 0, per_x = 0, per_y = 0; ///< of the tile's first sample; a sample to the right, and downwards
    float lower = 0, upper = 0;

    DepthPlane(const FixedPoint& a, const FixedPoint& b, const FixedPoint& c, const TileFrame& frame)
        : lower(std::min({a.depth, b.depth, c.depth})), upper(std::max({a.depth, b.depth, c.depth})) {
        const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
        const double doubled_area = bx * cy - cx * by;
        const double b_depth = double{b.depth} - a.depth, c_depth = double{c.depth} - a.depth;
        if (doubled_area != 0) {
            per_x = (b_depth * cy - c_depth * by) / doubled_area * fixed_one;
            per_y = (c_depth * bx - b_depth * cx) / doubled_area * fixed_one;
        }
        at_first = a.depth + (static_cast<double>(frame.x) + 0.5 - a.x / double{fixed_one}) * per_x +
                   (static_cast<double>(frame.y) + 0.5 - a.y / double{fixed_one}) * per_y;
    }
};

} // namespace isotet::render
