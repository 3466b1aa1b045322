// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// average_to_points() of cells that are never in memory as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "grid/values/running_mean.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet::core {

/// Means of cell values at points, of linear cells that go by once, in their order.
///
/// Memory   16 bytes a point, 24 a corner of the cells at hand
class ISOTET_API CellMeans {
public:
    /// `points`   of the whole grid
    explicit CellMeans(const Array& points);

    /// Whether all points may be contoured.
    bool are_sound() const { return sound_; }

    /// The next cells: those of a grid with the same points, which are checked; of cells without a value
    /// none need be there. `values` from tuple `first` on are theirs.
    void add(const CellReader& cells, const Array& values, Scalar scalar, std::size_t first);

    /// The values of average_to_points(), when all cells were added.
    /// `type`   of the values of cells
    Array finish(ScalarType type) &&;

    /// parse_scalar()
    static std::optional<Scalar> scalar_called(std::string_view text);
    /// scalar_of()
    static Array scalar_of_cells(const Array& values, Scalar scalar);
    static std::uint64_t bytes(std::uint64_t points) { return points * sizeof(RunningMean); }

private:
    struct Share { ///< of a cell in the mean at a point
        std::uint64_t point;
        double value, volume;
    };

    PointReader points_;
    bool sound_;
    Buffer<RunningMean> means_;              ///< `weights` below 0: so many cells, none of which has a volume
    std::vector<std::vector<Share>> shares_; ///< of the cells at hand, by task and by part of the points
};

} // namespace isotet::core
