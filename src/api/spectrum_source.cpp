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
    const auto statistics = statistics_of(field.values);
    if (!statistics) return statistics.error();
    SpectrumSource source(grid, *cells);
    double most = std::max(std::abs(around.lower), std::abs(around.upper));
    for (const ComponentStatistics& component : *statistics) { // one, or none of an empty field
        source.range_ = {component.lower, component.upper};
        if (component.lower <= component.upper)
            most = std::max({most, std::abs(component.lower), std::abs(component.upper)});
    }
    if (most > 0) std::frexp(most, &source.exponent_);
    source.values_ = core::Buffer<double>(field.values.size());
    field.values.visit([&](auto scalars) {
        const std::size_t grain = std::size_t{1} << 16;
        core::parallel_pieces(scalars.size(), grain, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                source.values_[i] = source.in_units(static_cast<double>(scalars[i]));
        });
    });
    if (progress.cancelled()) return measuring_was_cancelled();
    return source;
}

Result<ContourSpectrum> SpectrumSource::at(std::span<const double> isovalues, SpectrumBy engine,
                                           const Progress& progress) const {
    std::vector<double> levels;
    for (const double isovalue : isovalues) levels.push_back(in_units(isovalue));
    const ops::SpectrumInput input{cells_, core::PointReader(grid_.points), {values_.data(), values_.size()}, levels};
    ops::Spectrum spectrum =
        engine == SpectrumBy::reference ? reference::contour_spectrum(input) : cpu::contour_spectrum(input, progress);
    if (progress.cancelled()) return measuring_was_cancelled();
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
