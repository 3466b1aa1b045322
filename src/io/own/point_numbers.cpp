// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_map>

#include "io/own/point_numbers.hpp"

namespace isotet::io {
namespace {

using Place = std::array<double, 3>;

Place place(const Piece& piece, std::uint64_t point) {
    Place result{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        result[axis] = piece.grid.points.at(point, axis) + 0.0; // -0 becomes +0
    return result;
}

/// Pieces written by different processes may have rounded a shared point differently, in float32 at the worst.
bool same_place(const Place& a, const Place& b) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(std::abs(a[axis] - b[axis]) <= 1e-5 * (1e-30 + std::abs(a[axis]) + std::abs(b[axis])))) return false;
    return true;
}

struct HashPlace {
    std::size_t operator()(const Place& place) const noexcept {
        std::uint64_t hash = 0;
        for (double coordinate : place) {
            std::uint64_t bits;
            std::memcpy(&bits, &coordinate, sizeof bits);
            hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

std::uint64_t all_points(const std::vector<Piece>& pieces) {
    std::uint64_t count = 0;
    for (const Piece& piece : pieces) count += piece.grid.points.tuples();
    return count;
}

struct Known {
    std::uint64_t number;
    std::size_t piece;
};

struct Bounds {
    Place low{}, high{};
    bool hold(const Place& place) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!(place[axis] >= low[axis] && place[axis] <= high[axis])) return false;
        return true;
    }
};

Bounds bounds_of(const Piece& piece) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::size_t i = 0; i < piece.grid.points.tuples(); ++i) {
        const Place here = place(piece, i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bounds.low[axis] = std::min(bounds.low[axis], here[axis]);
            bounds.high[axis] = std::max(bounds.high[axis], here[axis]);
        }
    }
    return bounds;
}

/// Only points that lie in the box of another piece can coincide with one of its points: most are never looked up.
bool in_another(const std::vector<Bounds>& bounds, std::size_t piece, const Place& place) {
    for (std::size_t other = 0; other < bounds.size(); ++other)
        if (other != piece && bounds[other].hold(place)) return true;
    return false;
}

} // namespace

PointNumbers number_one_after_another(const std::vector<Piece>& pieces) {
    PointNumbers result;
    for (const Piece& piece : pieces) {
        result.first.push_back(result.count);
        result.count += piece.grid.points.tuples();
    }
    return result;
}

std::optional<PointNumbers> number_by_ids(const std::vector<Piece>& pieces) {
    struct First {
        std::uint64_t number;
        Place place;
    };
    PointNumbers result;
    std::unordered_map<std::uint64_t, First> known;
    known.reserve(all_points(pieces));
    for (const Piece& piece : pieces) {
        auto& numbers = result.numbers.emplace_back(piece.grid.points.tuples());
        const bool fits = piece.point_ids.visit([&](auto ids) {
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                const Place here = place(piece, i);
                const auto [entry, is_new] =
                    known.try_emplace(static_cast<std::uint64_t>(ids[i]), First{result.count, here});
                if (is_new) ++result.count;
                else if (!same_place(entry->second.place, here)) return false;
                else ++result.joined;
                numbers[i] = entry->second.number;
            }
            return true;
        });
        if (!fits) return std::nullopt;
    }
    return result;
}

PointNumbers number_by_coordinates(const std::vector<Piece>& pieces) {
    PointNumbers result;
    std::vector<Bounds> bounds;
    for (const Piece& piece : pieces) bounds.push_back(bounds_of(piece));
    std::unordered_map<Place, Known, HashPlace> known;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        auto& numbers = result.numbers.emplace_back(pieces[p].grid.points.tuples());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const Place here = place(pieces[p], i);
            if (!in_another(bounds, p, here)) {
                numbers[i] = result.count++;
                continue;
            }
            const auto [entry, is_new] = known.try_emplace(here, Known{result.count, p});
            const bool other_piece = !is_new && entry->second.piece != p;
            numbers[i] = other_piece ? entry->second.number : result.count;
            if (other_piece) ++result.joined, result.joined_points.push_back({p, i});
            else ++result.count;
        }
    }
    return result;
}

} // namespace isotet::io
