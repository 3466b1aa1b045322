// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Area and volume at isovalues, the contract that every engine meets: from tets and the values at their corners to sums.
//
// A tet counts when no corner is NaN; its volume is the absolute one. At isovalue t its corners below t, strictly, are cut
// off: what they leave is the area, what they take the volume below. So a face of three corners at t counts where the
// fourth is below.
//
// Guarantees   one engine gives the same bytes for any number of threads; engines agree within 1e-12 of the largest number
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grid/cells.hpp"
#include "grid/orientation.hpp"

namespace isotet::ops {

/// `values`      one a point, NaN or at most 1 in magnitude
/// `isovalues`   ascending, at most 1 in magnitude
struct SpectrumInput {
    const core::CellReader& cells; ///< checked
    core::PointReader points;
    std::span<const double> values;
    std::span<const double> isovalues;
};

struct Spectrum {
    std::vector<double> area, volume_below; ///< at each isovalue
    double volume = 0;
    std::uint64_t tets = 0, no_data_tets = 0;
};

} // namespace isotet::ops
