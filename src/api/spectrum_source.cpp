// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/spectrum_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include <isotet/linear_cells.hpp>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "cpu/spectrum.hpp"
#include "reference/spectrum.hpp"

namespace isotet::api {

namespace {

Result<void> check_measured_field(const Grid& grid, const PointField& field) {
    if (field.values.components() == 1 && field.values.tuples() == grid.points.tuples()) return {};
    return invalid_argument(fmt::format("field '{}' has {} values of {} components, but the grid has {} points and "
                                        "the contoured field must have 1 component",
                                        field.name, field.values.tuples(), field.values.components(),
                                        grid.points.tuples()));
}

Error measuring_was_cancelled() { return {ErrorCode::cancelled, "measuring was cancelled"}; }

} // namespace

double SpectrumSource::in_units(double value) const {
    if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    const double small = std::ldexp(value, -exponent_);
    return std::abs(small) < 0x1p-500 ? 0 : small;
}

Result<SpectrumSource> SpectrumSource::open(const Grid& grid, const PointField& field, const ValueRange& around,
                                            const Progress& progress) {
    if (auto ok = check_measured_field(grid, field); !ok) return ok.error();
    if (has_cells_to_linearize(grid.cells)) {
        const Run inner{.progress = progress};
        const auto linear = linearize(grid, {}, inner);
        if (!linear) return linear.error();
        Result<Array> values = linear->extend(field.values, inner);
        if (!values) return values.error();
        return open(linear->grid, {field.name, *std::move(values), false, {}}, around, progress);
    }
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = core::check_cells(grid, *cells, progress); !ok) return ok.error();
    SpectrumSource source(grid);
    source.cells_ = *cells;
    const double most = std::max(std::abs(around.lower), std::abs(around.upper));
    if (auto taken = source.take_values(field, most, progress); !taken) return taken.error();
    return source;
}

Result<SpectrumSource> SpectrumSource::open(const Array& points, const CellsInTurn& cells, const PointField& field) {
    SpectrumSource source(Grid{points, {}, {}, {}});
    if (auto ok = check_measured_field(source.grid_, field); !ok) return ok.error();
    source.in_turn_ = cells;
    if (auto taken = source.take_values(field, 0, {}); !taken) return taken.error();
    return source;
}

Result<void> SpectrumSource::take_values(const PointField& field, double most, const Progress& progress) {
    const auto statistics = statistics_of(field.values);
    if (!statistics) return statistics.error();
    for (const ComponentStatistics& component : *statistics) { // one, or none of an empty field
        range_ = {component.lower, component.upper};
        if (component.lower <= component.upper)
            most = std::max({most, std::abs(component.lower), std::abs(component.upper)});
    }
    if (most > 0) std::frexp(most, &exponent_);
    values_ = core::Buffer<double>(field.values.size());
    field.values.visit([&](auto scalars) {
        const std::size_t grain = std::size_t{1} << 16;
        core::parallel_pieces(scalars.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) values_[i] = in_units(static_cast<double>(scalars[i]));
        });
    });
    if (progress.cancelled()) return measuring_was_cancelled();
    return {};
}

Result<ops::Spectrum> SpectrumSource::measure(std::span<const double> levels, SpectrumBy engine,
                                              const Progress& progress) {
    if (!cells_) return measure_in_turn(levels, progress);
    const ops::SpectrumInput input{*cells_, core::PointReader(grid_.points), {values_.data(), values_.size()}, levels};
    return engine == SpectrumBy::reference ? reference::contour_spectrum(input)
                                           : cpu::contour_spectrum(input, progress);
}

/// Cells are checked when they go by for the first time.
Result<ops::Spectrum> SpectrumSource::measure_in_turn(std::span<const double> levels, const Progress& progress) {
    cpu::SpectrumPass pass(core::PointReader(grid_.points), {values_.data(), values_.size()}, levels, in_turn_.count);
    Result<void> sound;
    const auto done = in_turn_.each([&](std::uint64_t first, const Grid& some) {
        if (!sound || progress.cancelled()) return;
        const auto cells = core::CellReader::open(some);
        sound = !cells         ? Result<void>(cells.error())
                : are_checked_ ? Result<void>()
                               : core::check_cells(some, *cells, progress);
        if (sound) pass.add(*cells, first, progress);
    });
    if (!done) return done.error();
    if (!sound) return sound.error();
    are_checked_ = true;
    return pass.finish();
}

Result<ContourSpectrum> SpectrumSource::at(std::span<const double> isovalues, SpectrumBy engine,
                                           const Progress& progress) {
    std::vector<double> levels;
    for (const double isovalue : isovalues) levels.push_back(in_units(isovalue));
    auto measured = measure(levels, engine, progress);
    if (progress.cancelled()) return measuring_was_cancelled();
    if (!measured) return measured.error();
    ops::Spectrum& spectrum = *measured;
    ContourSpectrum out;
    out.isovalues.assign(isovalues.begin(), isovalues.end());
    out.area = std::move(spectrum.area);
    out.volume_below = std::move(spectrum.volume_below);
    out.volume = spectrum.volume;
    out.tets = spectrum.tets;
    out.no_data_tets = spectrum.no_data_tets;
    return out;
}

} // namespace isotet::api
