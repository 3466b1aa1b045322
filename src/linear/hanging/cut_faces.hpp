// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where surfaces end among cells of which only those that isovalues cut are there: at the boundary, and at hanging points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"

namespace isotet::linear {

/// Which faces isovalues cut or touch.
class CutRule {
public:
    /// `values`   one scalar a point; borrowed
    CutRule(const Array& values, std::span<const double> isovalues);

    /// False where a value is no number.
    bool cuts(std::span<const std::uint64_t> loop) const;

    /// A bit for each face of a cell that is cut.
    std::uint32_t cut_faces(const core::WholeCell& cell) const;

private:
    double value(std::uint64_t point) const {
        if (singles_) return singles_[point];
        return doubles_ ? doubles_[point] : values_.at(point);
    }

    const Array& values_;
    const float* singles_ = nullptr;  ///< values_, where it is of this type
    const double* doubles_ = nullptr; ///< the same
    std::vector<double> isovalues_;   ///< ascending
};

/// Whether a face that is cut, and that no other cell has, lies on a larger face of another cell.
///
/// Cost     two passes over the cells, 9 to 17 bytes each, and their boxes in a tree of the cut faces that one cell has
/// Errors   out_of_memory; cancelled
Result<bool> has_smaller_cut_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                   const core::PointReader& points, const CutRule& rule, const Progress& progress);

} // namespace isotet::linear
