// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// At which points faces may be unbalanced, or tets repeated: two numbers a point instead of a table of faces.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/cell/cell_kind.hpp"
#include "grid/cell/split.hpp"
#include "grid/cell/with_kind.hpp"
#include "grid/face_counter.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::core {

/// For each point the sum of hashes of the faces that have it as their lowest one, signed by their direction: 0 where
/// each is used equally often in both. And a Bloom filter (Bloom 1970) of the tets that have it as their lowest or
/// second lowest point, for those that occur twice.
///
/// A point of which all faces are balanced and no tet is repeated is doubted at most by mistake of the filter; any
/// other is missed with probability 2^-64, that of a sum of hashes that is 0 by chance.
///
/// Threads   many may add
class FaceSums {
    struct Sums {
        std::uint64_t faces = 0, tets = 0;
    };

public:
    explicit FaceSums(std::uint64_t points) : sums_(points), doubted_(points) {
        parallel_ranges(points, 1 << 16, [&](std::size_t begin, std::size_t end) {
            std::fill(sums_.begin() + begin, sums_.begin() + end, Sums{});
            std::fill(doubted_.begin() + begin, doubted_.begin() + end, std::uint8_t{0});
        });
    }

    /// Doubts a point whatever its sums are.
    void doubt(std::uint64_t point) {
        std::atomic_ref(doubted_[point]).store(std::uint8_t{1}, std::memory_order_relaxed);
    }

    /// What one thread adds. Sums of points that came by lately are added up in the thread's cache, so faces between cells
    /// that follow one another mostly cancel there; memory of the others is asked for before it is changed.
    class Adder {
    public:
        explicit Adder(FaceSums& to) : to_(to), near_(near_points, Sum{no_point, 0}) {}

        /// In the end.
        void flush() {
            for (const Sum& sum : near_)
                if (sum.sum != 0) put(sum);
            near_.clear();
            flush_faces();
            flush_cells();
        }

        template <class Point>
        void add(const AscendingTet<Point>& tet) {
            const std::array<Point, 4> p = tet.corners();
            const std::uint64_t first = scattered(p[1]), second = scattered(p[2]), third = scattered(p[3]);
            // The outward faces of an upright tet are 1 2 3, 0 3 2, 0 1 3 and 0 2 1.
            const std::uint64_t p23 = folded_product(second, third), p13 = folded_product(first, third),
                                p12 = folded_product(first, second);
            const std::uint64_t at_lowest = p13 - p23 - p12;
            add_face(p[0], tet.mirrored() ? 0 - at_lowest : at_lowest);
            add_face(p[1], tet.mirrored() ? 0 - p23 : p23);
            const std::uint64_t all = folded_product(p12 + p[0], third ^ 0xA0761D6478BD642FU);
            put({(all >> 24 & 1) != 0 ? p[1] : p[0], bits_of(all), p[0], p[1]});
        }

        /// A whole cell, whose quadrilaterals are taken as they are: one beside two triangles is doubted, too. Of cells
        /// with the same corners the later one is, as of tets.
        ///
        /// `mirrored`   its faces are clockwise seen from outside
        void add(const WholeCell& cell, bool mirrored) {
            std::uint64_t all = 0, lowest = cell.corners[0];
            with_kind(cell.kind, [&](auto kind) {
                constexpr CellShape shape = shape_of(kind);
                std::array<std::uint64_t, 8> hashes;
                for (std::size_t i = 0; i < corner_count(kind); ++i) all += hashes[i] = scattered(cell.corners[i]);
                for (std::size_t i = 0; i < shape.face_count; ++i) {
                    const Sum face = sum_of(cell, shape.all_faces[i], hashes);
                    lowest = std::min(lowest, face.point);
                    add_face(face.point, mirrored ? 0 - face.sum : face.sum);
                }
            });
            put({lowest, bits_of(mixed(all)), lowest, lowest});
        }

    private:
        struct Sum {
            std::uint64_t point, sum;
        };
        /// A tet or cell, for the filter of a point; points that are doubted where it was there before.
        struct Seen {
            std::uint64_t point, bits, lowest, second;
        };

        static constexpr std::uint64_t no_point = UINT64_MAX;
        static constexpr std::size_t near_points = 1 << 11; ///< 32 KB

        static std::uint64_t scattered(std::uint64_t point) { return mixed(point + 0x9e3779b97f4a7c15U); }

        static Sum sum_of(const WholeCell& cell, const CellFace& face, const std::array<std::uint64_t, 8>& hashes) {
            std::size_t first = 0;
            for (std::size_t i = 1; i < face.count; ++i)
                if (cell.corners[face.corners[i]] < cell.corners[face.corners[first]]) first = i;
            const auto corner = [&](std::size_t i) {
                return face.corners[first + i < face.count ? first + i : first + i - face.count];
            };
            const std::size_t next = corner(1), last = corner(face.count - 1);
            const std::uint64_t opposite = face.count == 4 ? std::rotl(hashes[corner(2)], 32) : 0;
            const std::uint64_t hash = folded_product(hashes[next] ^ opposite, hashes[last] ^ opposite);
            return {cell.corners[corner(0)], cell.corners[next] < cell.corners[last] ? hash : 0 - hash};
        }

        void add_face(std::uint64_t point, std::uint64_t sum) {
            Sum& near = near_[point % near_points];
            if (near.point == point) {
                near.sum += sum;
                return;
            }
            if (near.sum != 0) put(near);
            near = {point, sum};
        }

        void put(const Sum& sum) {
            __builtin_prefetch(&to_.sums_[sum.point], 1);
            faces_[face_count_++] = sum;
            if (face_count_ == faces_.size()) flush_faces();
        }
        void put(const Seen& cell) {
            __builtin_prefetch(&to_.sums_[cell.point], 1);
            cells_[cell_count_++] = cell;
            if (cell_count_ == cells_.size()) flush_cells();
        }

        void flush_faces() {
            for (std::size_t i = 0; i < face_count_; ++i)
                std::atomic_ref(to_.sums_[faces_[i].point].faces).fetch_add(faces_[i].sum, std::memory_order_relaxed);
            face_count_ = 0;
        }
        void flush_cells() {
            for (std::size_t i = 0; i < cell_count_; ++i) {
                if (!to_.filter(cells_[i].point, cells_[i].bits)) continue;
                to_.doubt(cells_[i].lowest);
                to_.doubt(cells_[i].second);
            }
            cell_count_ = 0;
        }

        FaceSums& to_;
        std::vector<Sum> near_; ///< by the lowest bits of the point
        std::array<Sum, 64> faces_;
        std::array<Seen, 32> cells_;
        std::size_t face_count_ = 0, cell_count_ = 0;
    };

    /// Once all have been added. Returns how many points are doubted.
    std::uint64_t look() {
        std::atomic<std::uint64_t> doubted{0};
        parallel_ranges(sums_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            std::uint64_t here = 0;
            for (std::size_t point = begin; point < end; ++point)
                here += doubted_[point] |= static_cast<std::uint8_t>(sums_[point].faces != 0);
            doubted += here;
        });
        return doubted;
    }

    /// By point: 1 where it is doubted. The sums are freed.
    Buffer<std::uint8_t> take_doubted() {
        sums_.release();
        return std::move(doubted_);
    }

    static constexpr std::uint64_t bytes_per_point = 17;

private:
    static std::uint64_t bits_of(std::uint64_t hash) {
        std::uint64_t bits = 0;
        for (unsigned i = 0; i < 4; ++i) bits |= std::uint64_t{1} << (hash >> 6 * i & 63);
        return bits;
    }

    /// True where the filter of a point had the bits.
    bool filter(std::uint64_t point, std::uint64_t bits) {
        return (std::atomic_ref(sums_[point].tets).fetch_or(bits, std::memory_order_relaxed) & bits) == bits;
    }

    Buffer<Sums> sums_;
    Buffer<std::uint8_t> doubted_;
};

} // namespace isotet::core
