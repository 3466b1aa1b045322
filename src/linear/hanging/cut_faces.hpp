// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where surfaces end among cells of which only those that isovalues cut are there: at the boundary, and at hanging points.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "linear/hanging/open_faces.hpp"

namespace isotet::linear {

/// Which faces isovalues cut: points on both sides, as extraction tells them (a value on the isovalue is above, none is
/// below), and values that may be rounded onto an isovalue on both.
class CutRule {
public:
    /// `values`   one scalar a point; borrowed
    CutRule(const Array& values, std::span<const double> isovalues);

    bool cuts(std::span<const std::uint64_t> loop) const;

    /// A bit for each face of a cell that is cut.
    std::uint32_t cut_faces(const core::WholeCell& cell) const;

private:
    /// No value is below all isovalues.
    double value(std::uint64_t point) const {
        const double value = singles_ ? singles_[point] : doubles_ ? doubles_[point] : values_.at(point);
        return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
    }

    const Array& values_;
    const float* singles_ = nullptr;  ///< values_, where it is of this type
    const double* doubles_ = nullptr; ///< the same
    std::vector<double> isovalues_;   ///< ascending, as the field's type has them
};

/// Faces that are cut, and that one cell has. Of a grid of which only the cells that are cut are there, these are at the
/// boundary or on larger or smaller faces.
///
/// Cost     two passes over the cells, 9 to 17 bytes each
/// Errors   out_of_memory; cancelled
Result<OpenFaces> find_lone_cut_faces(const core::CellReader& cells, const core::FaceReader& faces, const CutRule& rule,
                                      const Progress& progress);

} // namespace isotet::linear
