// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The part of a boundary face that lies between two isovalues.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace isotet::solid {

/// Where a corner lies.
enum class Side : std::uint8_t {
    below,  ///< the lower isovalue
    inside, ///< the range
    above   ///< the upper isovalue, or at it
};

/// A vertex of a part of a face: a corner (both ends are it), or where an isovalue crosses the edge between two
/// corners.
struct PartVertex {
    std::uint8_t below = 0, above = 0; ///< corners
    bool of_upper = false;             ///< the isovalue is the upper one

    bool is_corner() const { return below == above; }
};

/// Calls f(part) with the vertices of each part, in the direction of the face: a span of PartVertex.
///
/// The isosurface cuts off each run of corners at or above its isovalue (the rule of cell_cases.hpp): a part begins with
/// each run that is not below the lower isovalue, and lacks the runs that are above the upper one.
template <class F>
void for_parts(std::span<const Side> corners, const F& f) {
    const std::size_t n = corners.size();
    std::array<PartVertex, 16> part;
    std::size_t count = 0;
    const auto corner = [&](std::size_t k) {
        part[count++] = {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k), false};
    };
    const auto cut = [&](std::size_t below, std::size_t above, bool of_upper) {
        part[count++] = {static_cast<std::uint8_t>(below), static_cast<std::uint8_t>(above), of_upper};
    };
    /// What lies on the edge from corner a to corner b, without its ends.
    const auto along = [&](std::size_t a, std::size_t b) {
        const Side from = corners[a], to = corners[b];
        if (from == Side::below && to != Side::below) cut(a, b, false);
        if ((from == Side::above) != (to == Side::above)) {
            if (to == Side::above) cut(a, b, true);
            else cut(b, a, true);
        }
        if (from != Side::below && to == Side::below) cut(b, a, false);
    };
    std::size_t start = n; // a corner below: each run begins behind one
    for (std::size_t k = 0; k < n && start == n; ++k)
        if (corners[k] == Side::below) start = k;
    const auto finish = [&] {
        if (count > 2) f(std::span<const PartVertex>(part.data(), count));
        count = 0;
    };
    const std::size_t first = start == n ? 0 : start;
    for (std::size_t step = 0; step < n; ++step) {
        const std::size_t a = (first + step) % n, b = (a + 1) % n;
        if (corners[a] == Side::inside) corner(a);
        along(a, b);
        if (corners[b] == Side::below) finish();
    }
    finish();
}

} // namespace isotet::solid
