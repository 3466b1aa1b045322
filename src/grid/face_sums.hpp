// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// At which points faces may be unbalanced, or tets repeated: two numbers a point instead of a table of faces.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

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
    /// What a tet changes.
    struct Change {
        std::uint64_t lowest, second;
        std::uint64_t at_lowest, at_second; ///< to be added to sums of faces
        std::uint64_t tet;                  ///< bits of the filter
        bool filter_of_second;
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

    /// Adds tets a few at a time: memory is asked for before it is changed.
    template <class Point>
    class Adder {
    public:
        explicit Adder(FaceSums& to) : to_(to) {}
        Adder(const Adder&) = delete;
        Adder& operator=(const Adder&) = delete;
        ~Adder() { flush(); }

        void add(const AscendingTet<Point>& tet) {
            const Change& change = changes_[count_++] = change_of(tet);
            __builtin_prefetch(&to_.sums_[change.lowest], 1);
            __builtin_prefetch(&to_.sums_[change.second], 1);
            if (count_ == changes_.size()) flush();
        }

    private:
        void flush() {
            for (std::size_t i = 0; i < count_; ++i) to_.apply(changes_[i]);
            count_ = 0;
        }

        FaceSums& to_;
        std::array<Change, 32> changes_;
        std::size_t count_ = 0;
    };

    /// Adds whole cells, whose quadrilaterals are taken as they are: one beside two triangles is doubted, too. Of cells with
    /// the same corners the later one is, as of tets.
    class CellAdder {
    public:
        explicit CellAdder(FaceSums& to) : to_(to) {}
        CellAdder(const CellAdder&) = delete;
        CellAdder& operator=(const CellAdder&) = delete;
        ~CellAdder() { flush(); }

        /// `mirrored`   its faces are clockwise seen from outside
        void add(const WholeCell& cell, bool mirrored) {
            std::uint64_t all = 0, lowest = cell.corners[0];
            with_kind(cell.kind, [&](auto kind) {
                constexpr CellShape shape = shape_of(kind);
                std::array<std::uint64_t, 8> hashes;
                for (std::size_t i = 0; i < corner_count(kind); ++i)
                    all += hashes[i] = mixed(cell.corners[i] + 0x9e3779b97f4a7c15u);
                for (std::size_t face = 0; face < shape.face_count; ++face) {
                    const FaceChange change = change_of(cell, shape.all_faces[face], hashes);
                    lowest = std::min(lowest, change.point);
                    put({change.point, mirrored ? 0 - change.sum : change.sum});
                }
            });
            cells_[cell_count_++] = {lowest, bits_of(mixed(all))};
            if (cell_count_ == cells_.size()) flush();
        }

    private:
        struct FaceChange {
            std::uint64_t point, sum;
        };
        struct CellChange {
            std::uint64_t point, bits;
        };

        static FaceChange change_of(const WholeCell& cell, const CellFace& face,
                                    const std::array<std::uint64_t, 8>& hashes) {
            std::size_t first = 0;
            for (std::size_t i = 1; i < face.count; ++i)
                if (cell.corners[face.corners[i]] < cell.corners[face.corners[first]]) first = i;
            const auto corner = [&](std::size_t i) {
                return face.corners[first + i < face.count ? first + i : first + i - face.count];
            };
            const std::size_t next = corner(1), last = corner(face.count - 1);
            const bool is_forward = cell.corners[next] < cell.corners[last];
            const std::size_t low = is_forward ? next : last, high = is_forward ? last : next;
            std::uint64_t hash = mixed(hashes[low] + cell.corners[high]);
            if (face.count == 4) hash = mixed(hash + hashes[corner(2)]);
            return {cell.corners[corner(0)], is_forward ? hash : 0 - hash};
        }

        void put(const FaceChange& change) {
            __builtin_prefetch(&to_.sums_[change.point], 1);
            faces_[face_count_++] = change;
        }

        void flush() {
            for (std::size_t i = 0; i < face_count_; ++i) to_.add_face(faces_[i].point, faces_[i].sum);
            for (std::size_t i = 0; i < cell_count_; ++i) {
                if (!to_.filter(cells_[i].point, cells_[i].bits)) continue;
                std::atomic_ref(to_.doubted_[cells_[i].point]).store(1, std::memory_order_relaxed);
            }
            face_count_ = cell_count_ = 0;
        }

        FaceSums& to_;
        std::array<CellChange, 16> cells_;
        std::array<FaceChange, 6 * 16> faces_;
        std::size_t cell_count_ = 0, face_count_ = 0;
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

    /// By point: 1 where it is doubted.
    Buffer<std::uint8_t> take_doubted() && { return std::move(doubted_); }

    static constexpr std::uint64_t bytes_per_point = 17;

private:
    template <class Point>
    static Change change_of(const AscendingTet<Point>& tet) {
        const std::array<Point, 4> p = tet.corners();
        const std::uint64_t first = mixed(p[1] + 0x9e3779b97f4a7c15u), second = mixed(p[2] + 0x9e3779b97f4a7c15u);
        // The outward faces of an upright tet are 1 2 3, 0 3 2, 0 1 3 and 0 2 1.
        const std::uint64_t p23 = mixed(second + p[3]), p13 = mixed(first + p[3]), p12 = mixed(first + p[2]);
        const std::uint64_t at_lowest = p13 - p23 - p12;
        const std::uint64_t tet_hash = mixed(first + p23 + p[0]);
        return {p[0],
                p[1],
                tet.mirrored() ? 0 - at_lowest : at_lowest,
                tet.mirrored() ? 0 - p23 : p23,
                bits_of(tet_hash),
                (tet_hash >> 24 & 1) != 0};
    }

    static std::uint64_t bits_of(std::uint64_t hash) {
        std::uint64_t bits = 0;
        for (unsigned i = 0; i < 4; ++i) bits |= std::uint64_t{1} << (hash >> 6 * i & 63);
        return bits;
    }

    void add_face(std::uint64_t point, std::uint64_t sum) {
        std::atomic_ref(sums_[point].faces).fetch_add(sum, std::memory_order_relaxed);
    }

    /// True where the filter of a point had the bits.
    bool filter(std::uint64_t point, std::uint64_t bits) {
        return (std::atomic_ref(sums_[point].tets).fetch_or(bits, std::memory_order_relaxed) & bits) == bits;
    }

    void apply(const Change& change) {
        add_face(change.lowest, change.at_lowest);
        add_face(change.second, change.at_second);
        if (!filter(change.filter_of_second ? change.second : change.lowest, change.tet)) return;
        for (const std::uint64_t point : {change.lowest, change.second})
            std::atomic_ref(doubted_[point]).store(1, std::memory_order_relaxed);
    }

    Buffer<Sums> sums_;
    Buffer<std::uint8_t> doubted_;
};

} // namespace isotet::core
