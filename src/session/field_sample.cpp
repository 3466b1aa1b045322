// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <isotet/contour.hpp>

#include "base/guard.hpp"
#include "base/prefetch.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "linear/curved/curved_kinds.hpp"

namespace isotet {

namespace {

/// Triangles for each active cell. Tets give one where one corner is cut off, two where two are on each side. Of smooth
/// fields on regular grids, on perturbed ones and on those of data/.
constexpr std::array<double, core::cell_kind_count> triangles_per_active_cell{1.3, 1.6, 1.8, 2.1};

/// What packing and extraction take for a cell, in tets.
constexpr std::array<double, core::cell_kind_count> tets_like_a_cell{1, 2, 2.5, 3};

/// What polyhedra and cells of degree 2 become, roughly: by those of 14 faces, tetrahedra of 10 nodes, hexahedra of 27.
double triangles_of_active(std::size_t nodes) { return std::max(1.3, 0.9 * static_cast<double>(nodes) - 3); }
double tets_of(std::size_t nodes) { return std::max(1.0, 2 * static_cast<double>(nodes) - 8); }

bool is_made_linear(const core::CellReader& cells, std::size_t cell) {
    const std::uint8_t type = cells.type(cell);
    if (core::is_contoured(type)) return false;
    return core::is_polyhedral(type) || linear::layout_of(type, cells.corners(cell)) ||
           linear::high_degree_of(type, cells.corners(cell));
}

/// Of a cell as the file has it; 0 for one that is not contoured.
std::uint64_t corners_of(const core::CellReader& cells, std::size_t cell) {
    return is_made_linear(cells, cell) ? cells.corners(cell)
                                       : static_cast<std::uint64_t>(core::corners_of(cells.type(cell)));
}

/// The arrays have the cell whole, and its points. Cells of a whole grid are checked by check_cells(), which this does
/// not replace: it keeps a look at a few cells within the arrays.
bool is_within(const core::CellReader& cells, std::size_t cell) {
    const std::uint64_t corners = corners_of(cells, cell), first = cells.first(cell);
    if (corners == 0 || first > cells.connectivity_size() || cells.connectivity_size() - first < corners) return false;
    for (std::uint64_t i = 0; i < corners; ++i)
        if (cells.corner(first + i) >= cells.points()) return false;
    return true;
}

constexpr std::uint64_t cells_at_once = 256;

/// Regular grids repeat themselves from row to row: places between even steps are drawn (Weyl's sequence).
std::uint64_t drawn_cell(std::uint64_t i, std::uint64_t looked_at, std::uint64_t count) {
    const double place = (static_cast<double>(i) + std::fmod(static_cast<double>(i) * 0.618033988749895, 1.0)) /
                         static_cast<double>(looked_at);
    return std::min(static_cast<std::uint64_t>(place * static_cast<double>(count)), count - 1);
}

/// Of a cell that is within the arrays.
void prefetch_values(const core::CellReader& cells, std::size_t cell, const Array& values) {
    const auto* const bytes = static_cast<const std::byte*>(values.data());
    const std::uint64_t first = cells.first(cell), corners = corners_of(cells, cell);
    for (std::uint64_t k = 0; k < corners; ++k)
        core::prefetch(bytes + size_of(values.type()) * cells.corner(first + k));
}

} // namespace

/// Looks at cells, a batch after the other.
class FieldSample::Looker {
public:
    Looker(const core::CellReader& cells, const Array& values, bool split_cells)
        : cells_(cells), values_(values), whole_(!split_cells && !cells.only_tets()) {}

    /// Cells and values lie anywhere in memory: those of the batch are asked for before the first is looked at. Broken ones
    /// are removed.
    void look_at(std::vector<std::uint64_t>& batch) {
        for (const std::uint64_t cell : batch)
            if (cells_.first(cell) < cells_.connectivity_size()) cells_.prefetch(cell);
        std::erase_if(batch, [&](std::uint64_t cell) { return !is_within(cells_, cell); });
        for (const std::uint64_t cell : batch) prefetch_values(cells_, cell, values_);
        for (const std::uint64_t cell : batch) look_at(cell);
    }

    std::vector<Range> seen; ///< as FieldSample::cells_seen_
    double tets = 0;
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;

private:
    void look_at(std::uint64_t cell) {
        if (is_made_linear(cells_, cell)) {
            nodes_.clear();
            for (std::uint64_t k = 0; k < cells_.corners(cell); ++k)
                nodes_.push_back(cells_.corner(cells_.first(cell) + k));
            look_at(nodes_, tets_of(nodes_.size()), triangles_of_active(nodes_.size()));
        } else if (whole_) {
            const core::WholeCell whole = cells_.whole(cell);
            look_at(whole.kind, {whole.corners.data(), core::corner_count(whole.kind)});
        } else {
            for (const core::Tet& tet : cells_.tets(cell)) look_at(core::CellKind::tetrahedron, tet);
        }
    }

    void look_at(core::CellKind kind, std::span<const std::uint64_t> corners) {
        const auto which = static_cast<std::size_t>(kind);
        look_at(corners, tets_like_a_cell[which], triangles_per_active_cell[which]);
    }

    void look_at(std::span<const std::uint64_t> corners, double like_tets, double triangles) {
        tets += like_tets;
        const double first = values_.at(corners[0]);
        Range range{first, first, triangles};
        bool data = true;
        for (const std::uint64_t point : corners) {
            const double value = values_.at(point);
            data &= std::isfinite(value);
            range.lower = std::min(range.lower, value);
            range.upper = std::max(range.upper, value);
        }
        if (!data) return;
        lower = std::min(lower, range.lower);
        upper = std::max(upper, range.upper);
        if (range.lower < range.upper) seen.push_back(range);
    }

    const core::CellReader& cells_;
    const Array& values_;
    bool whole_;
    std::vector<std::uint64_t> nodes_;
};

Result<FieldSample> FieldSample::create(const Grid& grid, const PointField& field, bool split_cells) {
    return core::guarded("looking at the field", [&]() -> Result<FieldSample> {
        const auto cells = core::CellReader::open(grid);
        if (!cells) return cells.error();
        if (field.values.tuples() != cells->points() || (field.values.components() != 1 && !field.values.empty()))
            return Error{ErrorCode::invalid_argument,
                         fmt::format("field '{}' has {} values of {} components, but the grid has {} points and the "
                                     "contoured field must have 1 component",
                                     field.name, field.values.tuples(), field.values.components(), cells->points())};
        const std::uint64_t count = cells->count(), looked_at = std::min(count, max_cells);
        Looker looker(*cells, field.values, split_cells);
        std::vector<std::uint64_t> batch;
        for (std::uint64_t first = 0; first < looked_at; first += cells_at_once) {
            batch.clear();
            for (std::uint64_t i = first; i < std::min(looked_at, first + cells_at_once); ++i)
                batch.push_back(looked_at == count ? i : drawn_cell(i, looked_at, count));
            looker.look_at(batch);
        }

        FieldSample sample;
        sample.points_ = cells->points();
        sample.cells_seen_ = std::move(looker.seen);
        sample.lower_ = looker.lower;
        sample.upper_ = looker.upper;
        sample.cells_each_ = looked_at == 0 ? 0 : static_cast<double>(count) / static_cast<double>(looked_at);
        sample.tets_ = static_cast<std::uint64_t>(sample.cells_each_ * looker.tets);
        if (cells->only_tets()) sample.tets_ = count;
        return sample;
    });
}

double FieldSample::triangles(double isovalue) const noexcept {
    double triangles = 0;
    for (const Range& range : cells_seen_)
        if (range.lower < isovalue && isovalue <= range.upper) triangles += range.triangles;
    return cells_each_ * triangles;
}

} // namespace isotet
