// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/fields.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Isovalues that follow from the values of a field: levels in the range that they mostly lie in (typical_range()), or in
/// that of all finite ones. As ReadActiveCells::choose it goes to the reader processes, too; of any other function these
/// read all cells.
struct RangeLevels {
    std::uint64_t count = 1;
    LevelRounding rounding = LevelRounding::none;
    bool whole_range = false;

    /// Errors   invalid_data: the field has no finite value
    ISOTET_API Result<std::vector<double>> operator()(const PointField& field) const;
    /// Of a range that is known.
    ISOTET_API Result<std::vector<double>> within(const ValueRange& range, const PointField& field) const;
};

} // namespace isotet
