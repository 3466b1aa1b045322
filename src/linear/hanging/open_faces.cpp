// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/open_faces.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <utility>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "linear/hanging/lone_faces.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t cells_per_look = 1 << 13, points_per_clear = 1 << 16;

/// Which points faces of several cells have.
class SharedPoints {
public:
    /// `memory`   a number for each point; what it holds is lost
    explicit SharedPoints(core::Buffer<std::uint64_t> memory) : users_(std::move(memory)) {
        std::ranges::fill(users_, none);
    }

    void add(std::uint64_t cell, std::span<const std::uint64_t> loop) {
        for (const std::uint64_t point : loop) {
            const std::atomic_ref user(users_[point]);
            std::uint64_t before = user.load(std::memory_order_relaxed);
            if (before == none && user.compare_exchange_strong(before, cell, std::memory_order_relaxed)) continue;
            if (before != cell && before != several) user.store(several, std::memory_order_relaxed);
        }
    }
    bool has_any(std::span<const std::uint64_t> loop) const {
        return std::ranges::any_of(loop, [&](std::uint64_t point) { return users_[point] == several; });
    }

private:
    static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max(), several = none - 1;

    core::Buffer<std::uint64_t> users_; ///< by point: a cell, none or several
};

class OpenFaceFinder {
public:
    OpenFaceFinder(const core::CellReader& cells, const core::FaceReader& faces, const Progress& progress)
        : cells_(cells), faces_(faces), progress_(progress), sums_(cells.points()) {}

    Result<OpenFaces> find() {
        add_hashes();
        const auto found = alone();
        if (!found) return found.error();
        return shared_of(*found);
    }

private:
    void add_hashes() {
        core::parallel_ranges(sums_.size(), points_per_clear, [&](std::size_t begin, std::size_t end) {
            std::fill(sums_.begin() + begin, sums_.begin() + end, std::uint64_t{0});
        });
        core::parallel_pieces(cells_.count(), cells_per_look, progress_, [&](std::size_t begin, std::size_t end) {
            FaceWalk walk(cells_, faces_);
            if (cells_.bare_tets())
                cells_.connectivity().visit([&](const auto* corners) { add_tets(corners, begin, end, walk); });
            else
                for (std::size_t cell = begin; cell < end; ++cell) add_faces(walk, cell);
        });
    }

    void add_faces(FaceWalk& walk, std::size_t cell) {
        walk.each_hash(cell, [&](std::size_t, const FaceHash& face) { add(face.lowest, face.hash); });
    }

    /// As add_faces(): three faces of a tet have its lowest point, and the other one the next, so two sums are changed.
    template <class Index>
    void add_tets(const Index* corners, std::size_t begin, std::size_t end, FaceWalk& walk) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            std::array<std::uint64_t, 4> points;
            for (std::size_t i = 0; i < 4; ++i) points[i] = static_cast<std::uint64_t>(corners[4 * cell + i]);
            for (const auto& [a, b] : {std::pair(0, 1), {2, 3}, {0, 2}, {1, 3}, {1, 2}})
                if (points[a] > points[b]) std::swap(points[a], points[b]);
            if (points[0] == points[1] || points[1] == points[2] || points[2] == points[3]) {
                add_faces(walk, cell);
                continue;
            }
            std::array<std::uint64_t, 4> hashes;
            std::uint64_t all = 0;
            for (std::size_t i = 0; i < 4; ++i) all += hashes[i] = scattered(points[i]);
            add(points[0], scattered(all - hashes[1]) ^ scattered(all - hashes[2]) ^ scattered(all - hashes[3]));
            add(points[1], scattered(all - hashes[0]));
        }
    }

    void add(std::uint64_t point, std::uint64_t hash) {
        std::atomic_ref(sums_[point]).fetch_xor(hash, std::memory_order_relaxed);
    }

    /// Of those at points whose sums are not 0.
    Result<std::vector<FoundFace>> alone() const {
        const auto has_cell = [&](std::size_t cell) {
            return !core::is_contoured(cells_.type(cell)) || has_odd_corner(cell);
        };
        const auto has_face = [&](FaceWalk&, const OpenFaces::Place&, const FaceHash& hash) {
            return sums_[hash.lowest] != 0;
        };
        return lone_faces(cells_, faces_, has_cell, has_face, progress_);
    }

    /// Some face of it may have no neighbour.
    bool has_odd_corner(std::size_t cell) const {
        const std::uint64_t first = cells_.first(cell), count = cells_.corners(cell);
        return cells_.connectivity().visit([&](const auto* corners) {
            return std::any_of(corners + first, corners + first + count,
                               [&](auto point) { return sums_[static_cast<std::size_t>(point)] != 0; });
        });
    }

    /// A face that shares no point with those of other cells meets none. So grids where each cell has points of its own
    /// cost no more than to tell.
    OpenFaces shared_of(const std::vector<FoundFace>& found) {
        SharedPoints shared(std::move(sums_));
        core::parallel_pieces(found.size(), cells_per_look, progress_, [&](std::size_t begin, std::size_t end) {
            FaceWalk walk(cells_, faces_);
            for (std::size_t i = begin; i < end; ++i) shared.add(found[i].place.cell, walk.loop(found[i].place));
        });
        OpenFaces out;
        out.reserve(found.size(), 4 * found.size());
        FaceWalk walk(cells_, faces_);
        for (const FoundFace& face : found)
            if (const auto loop = walk.loop(face.place); shared.has_any(loop)) out.add(face.place, loop);
        return out;
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const Progress& progress_;
    core::Buffer<std::uint64_t> sums_; ///< by lowest point
};

} // namespace

Result<OpenFaces> find_open_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                  const Progress& progress) {
    if (auto fits = core::require_memory("looking for hanging points", 8 * cells.points()); !fits) return fits.error();
    return OpenFaceFinder(cells, faces, progress).find();
}

} // namespace isotet::linear
