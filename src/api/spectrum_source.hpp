// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid and a field, prepared to be measured at isovalues more than once.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <isotet/fields.hpp>
#include <isotet/isovalues.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "ops/spectrum.hpp"

namespace isotet::api {

enum class SpectrumBy : std::uint8_t { cpu, reference };

class SpectrumSource {
public:
    /// Makes cells linear and checks them.
    /// `around`   isovalues that will be asked for are in this range or in that of the field
    /// Errors     as contour_spectrum()
    static Result<SpectrumSource> open(const Grid& grid, const PointField& field, const ValueRange& around,
                                       const Progress& progress);

    /// The same of linear cells that go by.
    static Result<SpectrumSource> open(const Array& points, const CellsInTurn& cells, const PointField& field);

    /// Of the field's finite values; lower > upper: there is none.
    const ValueRange& range() const noexcept { return range_; }

    /// `isovalues`   ascending
    /// Errors        cancelled; those of cells that go by
    Result<ContourSpectrum> at(std::span<const double> isovalues, SpectrumBy engine, const Progress& progress);

private:
    explicit SpectrumSource(Grid grid) : grid_(std::move(grid)) {}

    /// `most`   in magnitude of the isovalues
    Result<void> take_values(const PointField& field, double most, const Progress& progress);
    Result<ops::Spectrum> measure(std::span<const double> levels, SpectrumBy engine, const Progress& progress);
    Result<ops::Spectrum> measure_in_turn(std::span<const double> levels, const Progress& progress);

    /// Values as the engines take them: multiplied by a power of two until none is above 1, so that no difference is
    /// infinite. What is below 2^-500 then counts as 0, so that no difference is too small to divide by.
    double in_units(double value) const;

    Grid grid_; ///< keeps what the reader borrows
    std::optional<core::CellReader> cells_;
    CellsInTurn in_turn_; ///< where there are none
    bool are_checked_ = false;
    core::Buffer<double> values_; ///< in units
    ValueRange range_;
    int exponent_ = 0;
};

} // namespace isotet::api
