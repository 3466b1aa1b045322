// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_amr.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isotet::io::confined {
namespace {

constexpr double box_rounding = 1e-4; ///< of a cell: origins are written as text, or in single precision
constexpr double most_cells = 1 << 30;

bool is_same_spacing(const XdmfImage& a, const XdmfImage& b) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(std::abs(a.spacing[axis] - b.spacing[axis]) <= box_rounding * b.spacing[axis])) return false;
    return true;
}

/// Nothing where the origin is none of the level's points.
std::optional<amr::CellBox> box_of(const XdmfImage& grid, const amr::Level& level,
                                   const std::array<double, 3>& origin) {
    amr::CellBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place = (grid.origin[axis] - origin[axis]) / level.spacing[axis], nearest = std::round(place);
        if (!(std::abs(place - nearest) <= box_rounding) || !(std::abs(nearest) <= most_cells) || grid.cells[axis] == 0)
            return std::nullopt;
        box.first[axis] = static_cast<std::int64_t>(nearest);
        box.last[axis] = box.first[axis] + static_cast<std::int64_t>(grid.cells[axis]) - 1;
    }
    return box;
}

/// The coarser cells that a box is made of; nothing where it ends within one.
std::optional<amr::CellBox> in_coarser_cells(const amr::CellBox& box, const amr::Level& fine,
                                             const amr::Level& coarse) {
    amr::CellBox out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto ratio = static_cast<std::int64_t>(std::round(coarse.spacing[axis] / fine.spacing[axis]));
        if (ratio < 1 || box.first[axis] % ratio != 0 || (box.last[axis] + 1) % ratio != 0) return std::nullopt;
        out.first[axis] = box.first[axis] / ratio;
        out.last[axis] = (box.last[axis] + 1) / ratio - 1;
    }
    return out;
}

std::uint64_t common_cells(const amr::CellBox& a, const amr::CellBox& b) {
    amr::CellBox both;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        both.first[axis] = std::max(a.first[axis], b.first[axis]);
        both.last[axis] = std::min(a.last[axis], b.last[axis]);
        if (both.last[axis] < both.first[axis]) return 0;
    }
    return both.cells();
}

/// Whether every box lies in those of the next coarser level: else they are blocks beside each other.
bool is_nested(const amr::Hierarchy& hierarchy) {
    for (std::size_t level = 1; level < hierarchy.levels.size(); ++level) {
        const amr::Level &fine = hierarchy.levels[level], &coarse = hierarchy.levels[level - 1];
        for (const amr::CellBox& box : fine.boxes) {
            const auto cells = in_coarser_cells(box, fine, coarse);
            if (!cells) return false;
            std::uint64_t covered = 0;
            for (const amr::CellBox& other : coarse.boxes) covered += common_cells(*cells, other);
            if (covered != cells->cells()) return false;
        }
    }
    return true;
}

} // namespace

std::optional<XdmfLevels> levels_of(std::span<const XdmfImage> grids) {
    XdmfLevels out;
    out.order.resize(grids.size());
    std::iota(out.order.begin(), out.order.end(), std::size_t{0});
    std::ranges::stable_sort(out.order, std::ranges::greater(), [&](std::size_t i) { return grids[i].spacing; });
    out.hierarchy.origin = grids[out.order.front()].origin;
    const XdmfImage* coarser = nullptr;
    for (const std::size_t i : out.order) {
        if (!coarser || !is_same_spacing(grids[i], *coarser)) out.hierarchy.levels.push_back({grids[i].spacing, {}});
        coarser = &grids[i];
        amr::Level& level = out.hierarchy.levels.back();
        const auto box = box_of(grids[i], level, out.hierarchy.origin);
        if (!box) return std::nullopt;
        level.boxes.push_back(*box);
    }
    if (out.hierarchy.levels.size() < 2 || !amr::Lattice::make(out.hierarchy) || !is_nested(out.hierarchy))
        return std::nullopt;
    return out;
}

} // namespace isotet::io::confined
