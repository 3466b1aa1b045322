// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/points_on_cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "linear/hanging/cell_loops.hpp"
#include "linear/hanging/face_place.hpp"
#include "linear/hanging/near_places.hpp"

namespace isotet::linear {

namespace {

constexpr double lying_on = 1e-3;  // of a face's extent
constexpr double at_corner = 0.99; // a corner's weight

/// Which cells have their box in a tile of a box around all.
class CellsOfTiles {
public:
    /// Boxes of cells without corners are empty.
    explicit CellsOfTiles(const std::vector<Box>& boxes) {
        for (const Box& box : boxes) {
            if (box.is_empty()) continue;
            around_.add(box.lower);
            around_.add(box.upper);
        }
        // Cells that a surface cuts lie on a sheet: a tile has a few.
        side_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(boxes.size())) / 2, 1.0, 100.0));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = around_.upper[axis] - around_.lower[axis];
            tiles_[axis] = extent > 0 ? static_cast<double>(side_) / extent : 0;
        }
        first_.assign(side_ * side_ * side_ + 1, 0);
        for (std::size_t cell = 0; cell < boxes.size(); ++cell) {
            if (boxes[cell].is_empty()) continue;
            if (is_large(boxes[cell])) large_.push_back(static_cast<std::uint32_t>(cell));
            else for_tiles(boxes[cell], [&](std::size_t tile) { ++first_[tile]; });
        }
        std::uint64_t sum = 0;
        for (std::uint64_t& first : first_) first = sum += first;
        if (!(is_good_ = sum < most_entries && large_.size() <= most_large)) return;
        cells_.resize(sum);
        for (std::size_t cell = boxes.size(); cell-- > 0;)
            if (!boxes[cell].is_empty() && !is_large(boxes[cell]))
                for_tiles(boxes[cell],
                          [&](std::size_t tile) { cells_[--first_[tile]] = static_cast<std::uint32_t>(cell); });
    }

    /// False where cells are so long that tiles tell little: then at() must not be called.
    bool is_good() const { return is_good_; }

    std::span<const std::uint32_t> at(const core::Point& place) const {
        std::array<std::size_t, 3> tile;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(place[axis] >= around_.lower[axis] && place[axis] <= around_.upper[axis])) return {};
            tile[axis] = along(axis, place[axis]);
        }
        const std::size_t number = (tile[2] * side_ + tile[1]) * side_ + tile[0];
        return {cells_.data() + first_[number], static_cast<std::size_t>(first_[number + 1] - first_[number])};
    }
    /// Those that are in no tile.
    std::span<const std::uint32_t> large() const { return large_; }

private:
    static constexpr std::size_t most_tiles = 1000, most_large = 16;
    static constexpr std::uint64_t most_entries = std::uint64_t{1} << 28;

    std::size_t along(std::size_t axis, double x) const {
        const double tile = (x - around_.lower[axis]) * tiles_[axis];
        return tile > 0 ? static_cast<std::size_t>(std::min(tile, static_cast<double>(side_ - 1))) : 0;
    }
    bool is_large(const Box& box) const {
        std::size_t count = 1;
        for (std::size_t axis = 0; axis < 3; ++axis)
            count *= along(axis, box.upper[axis]) - along(axis, box.lower[axis]) + 1;
        return count > most_tiles;
    }

    template <class Use>
    void for_tiles(const Box& box, const Use& use) const {
        for (std::size_t z = along(2, box.lower[2]); z <= along(2, box.upper[2]); ++z)
            for (std::size_t y = along(1, box.lower[1]); y <= along(1, box.upper[1]); ++y)
                for (std::size_t x = along(0, box.lower[0]); x <= along(0, box.upper[0]); ++x)
                    use((z * side_ + y) * side_ + x);
    }

    Box around_;
    std::size_t side_ = 1;
    std::array<double, 3> tiles_{}; ///< in a unit of length
    std::vector<std::uint64_t> first_;
    std::vector<std::uint32_t> cells_, large_;
    bool is_good_ = true;
};

bool lies_on(CellLoops& loops, std::size_t cell, std::uint64_t point, const core::PointReader& points) {
    if (!loops.read(cell)) return false;
    const core::Point at = points[point];
    for (std::size_t face = 0; face < loops.count(); ++face) {
        Box box;
        for (const std::uint64_t corner : loops.loop(face)) box.add(points[corner]);
        const double extent = std::sqrt(core::squared_distance(box.lower, box.upper));
        const FacePlace place = place_on_face(loops.loop(face), at, points);
        const auto weights = std::span(place.weights).first(place.count);
        // Points of thin layers stand right above corners.
        if (place.distance <= lying_on * extent && std::ranges::max(weights) < at_corner) return true;
    }
    return false;
}

} // namespace

bool has_points_between(const CheckedCells& all, const Array& points, const Progress& progress) {
    const std::size_t cells = all.cells.count();
    if (cells == 0) return false;
    if (cells > std::numeric_limits<std::uint32_t>::max()) return true;
    const core::PointReader places(points);
    std::vector<Box> boxes(cells);
    std::vector<std::uint8_t> known(points.tuples()); // of the cells
    core::parallel_ranges(cells, 1 << 12, [&](std::size_t begin, std::size_t end) {
        CellLoops loops(all.cells, all.faces);
        for (std::size_t cell = begin; cell < end; ++cell) {
            const std::uint64_t first = all.cells.first(cell), count = all.cells.corners(cell);
            for (std::uint64_t i = first; i < first + count; ++i) {
                const std::uint64_t point = all.cells.corner(i);
                boxes[cell].add(places[point]);
                std::atomic_ref(known[point]).store(1, std::memory_order_relaxed);
            }
            if (count > 0) boxes[cell] = boxes[cell].wider(lying_on);
        }
    });
    const CellsOfTiles tiles(boxes);
    if (!tiles.is_good()) return true;
    std::atomic<bool> found{false};
    core::parallel_ranges(known.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        if (found.load(std::memory_order_relaxed) || progress.cancelled()) return;
        CellLoops loops(all.cells, all.faces);
        for (std::size_t point = begin; point < end; ++point) {
            if (known[point]) continue;
            const core::Point at = places[point];
            Box here;
            here.add(at);
            for (const auto near : {tiles.at(at), tiles.large()})
                for (const std::uint32_t cell : near)
                    if (boxes[cell].holds(here) && lies_on(loops, cell, point, places)) {
                        found.store(true, std::memory_order_relaxed);
                        return;
                    }
        }
    });
    return found;
}

} // namespace isotet::linear
