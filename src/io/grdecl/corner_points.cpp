// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/grdecl/corner_points.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/pace.hpp"

namespace isotet::io::grdecl {

namespace {

/// VTK's corner for the corner (x, y, z) of a cell, x + 2 y + 4 z, where z counts downwards.
constexpr std::array<std::uint8_t, 8> corner_of_vtk{4, 5, 7, 6, 0, 1, 3, 2};

class Pillars {
public:
    explicit Pillars(const CornerPoints& grid)
        : grid_(grid), cells_(grid.cells), across_{cells_[0] + 1, cells_[1] + 1} {}

    std::size_t count() const { return across_[0] * across_[1]; }
    std::size_t cell(std::size_t x, std::size_t y, std::size_t z) const { return x + cells_[0] * (y + cells_[1] * z); }

    double depth(std::size_t x, std::size_t y, std::size_t z, unsigned corner) const {
        const std::size_t column = 2 * x + (corner & 1U), row = 2 * y + (corner >> 1U & 1U),
                          plane = 2 * z + (corner >> 2U);
        return grid_.depths[column + 2 * cells_[0] * (row + 2 * cells_[1] * plane)];
    }

    /// Calls use(cell, corner, depth) for each corner of each active cell on a pillar.
    template <class Use>
    void each_corner(std::size_t pillar, const Use& use) const {
        const std::size_t px = pillar % across_[0], py = pillar / across_[0];
        for (unsigned side = 0; side < 4; ++side) {
            // The cell on this side has the pillar at its corner (1 - dx, 1 - dy).
            const std::size_t dx = side & 1U, dy = side >> 1U;
            if (px + dx < 1 || py + dy < 1 || px + dx > cells_[0] || py + dy > cells_[1]) continue;
            const std::size_t x = px + dx - 1, y = py + dy - 1;
            const unsigned corner = static_cast<unsigned>((1 - dx) + 2 * (1 - dy));
            for (std::size_t z = 0; z < cells_[2]; ++z) {
                const std::size_t at = cell(x, y, z);
                if (!grid_.active[at]) continue;
                use(at, corner, depth(x, y, z, corner));
                use(at, corner + 4, depth(x, y, z, corner + 4));
            }
        }
    }

    /// The different depths on a pillar, the deepest first.
    void depths_on(std::size_t pillar, std::vector<double>& depths) const {
        depths.clear();
        each_corner(pillar, [&](std::size_t, unsigned, double depth) { depths.push_back(depth); });
        std::ranges::sort(depths, std::greater<>());
        depths.erase(std::ranges::unique(depths).begin(), depths.end());
    }

    std::array<double, 3> place(std::size_t pillar, double depth) const {
        const double* const p = &grid_.pillars[6 * pillar];
        const double height = p[5] - p[2];
        const double t = height == 0 ? 0 : (depth - p[2]) / height;
        const double x = p[0] + t * (p[3] - p[0]), y = p[1] + t * (p[4] - p[1]);
        if (!grid_.axes) return {x, y, 0.0 - depth};
        const MapAxes& axes = *grid_.axes;
        return {axes.origin[0] + x * axes.x[0] + y * axes.y[0], axes.origin[1] + x * axes.x[1] + y * axes.y[1],
                0.0 - depth};
    }

private:
    const CornerPoints& grid_;
    std::array<std::uint64_t, 3> cells_;
    std::array<std::size_t, 2> across_;
};

/// Makes active cells without any height inactive, and counts them.
std::uint64_t leave_out_flat(CornerPoints& grid, const Pillars& pillars) {
    std::atomic<std::uint64_t> flat = 0;
    const std::size_t nx = grid.cells[0], ny = grid.cells[1], nz = grid.cells[2];
    core::parallel_ranges(ny * nz, 64, [&](std::size_t first, std::size_t last) {
        std::uint64_t here = 0;
        for (std::size_t row = first; row < last; ++row) {
            const std::size_t y = row % ny, z = row / ny;
            for (std::size_t x = 0; x < nx; ++x) {
                std::uint8_t& active = grid.active[pillars.cell(x, y, z)];
                bool is_flat = active != 0;
                for (unsigned corner = 0; corner < 4 && is_flat; ++corner)
                    is_flat = pillars.depth(x, y, z, corner) == pillars.depth(x, y, z, corner + 4);
                if (!is_flat) continue;
                active = 0;
                ++here;
            }
        }
        flat += here;
    });
    return flat;
}

bool all_finite(const std::vector<double>& values) {
    std::atomic<bool> finite = true;
    core::parallel_ranges(values.size(), 1U << 16U, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            if (!std::isfinite(values[i])) finite = false;
    });
    return finite;
}

/// Where each pillar's points begin, and behind the last of them.
std::vector<std::uint64_t> count_points(const Pillars& pillars, const Progress& progress) {
    std::vector<std::uint64_t> begins(pillars.count() + 1);
    core::parallel_pieces(pillars.count(), 256, progress, [&](std::size_t first, std::size_t last) {
        std::vector<double> depths;
        for (std::size_t pillar = first; pillar < last; ++pillar) {
            pillars.depths_on(pillar, depths);
            begins[pillar + 1] = depths.size();
        }
    });
    for (std::size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
    return begins;
}

} // namespace

Result<Hexahedra> make_hexahedra(CornerPoints grid, const Progress& progress) {
    if (!all_finite(grid.pillars)) return Error{ErrorCode::invalid_data, "COORD has a number that is not finite"};
    if (!all_finite(grid.depths)) return Error{ErrorCode::invalid_data, "ZCORN has a number that is not finite"};
    const Pillars pillars(grid);
    Hexahedra out;
    out.flat = leave_out_flat(grid, pillars);

    std::vector<std::uint32_t> place(grid.active.size());
    for (std::size_t cell = 0; cell < grid.active.size(); ++cell) {
        if (!grid.active[cell]) continue;
        place[cell] = static_cast<std::uint32_t>(out.cells.size());
        out.cells.push_back(cell);
    }
    const auto begins = count_points(pillars, progress);
    if (progress.cancelled()) return Pace::cancelled();
    if (begins.back() > std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::invalid_data,
                     fmt::format("the grid has {} points, but isotet takes 2^32 - 1 of a corner-point grid at most",
                                 begins.back())};
    if (auto fits = core::require_memory("the grid", 32 * out.cells.size() + 24 * begins.back()); !fits)
        return fits.error();

    out.points.resize(3 * begins.back());
    out.corners.resize(8 * out.cells.size());
    std::array<std::uint8_t, 8> vtk_of_corner{};
    for (std::uint8_t k = 0; k < 8; ++k) vtk_of_corner[corner_of_vtk[k]] = k;
    core::parallel_pieces(pillars.count(), 256, progress, [&](std::size_t first, std::size_t last) {
        std::vector<double> depths;
        for (std::size_t pillar = first; pillar < last; ++pillar) {
            pillars.depths_on(pillar, depths);
            for (std::size_t i = 0; i < depths.size(); ++i)
                std::ranges::copy(pillars.place(pillar, depths[i]), &out.points[3 * (begins[pillar] + i)]);
            pillars.each_corner(pillar, [&](std::size_t cell, unsigned corner, double depth) {
                const auto at = std::ranges::lower_bound(depths, depth, std::greater<>()) - depths.begin();
                out.corners[8 * std::size_t{place[cell]} + vtk_of_corner[corner]] =
                    static_cast<std::uint32_t>(begins[pillar] + static_cast<std::uint64_t>(at));
            });
        }
    });
    if (progress.cancelled()) return Pace::cancelled();
    return out;
}

} // namespace isotet::io::grdecl
