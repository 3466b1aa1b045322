// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour_spectrum.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <isotet/field_statistics.hpp>
#include <isotet/levels.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/reference.hpp>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "cpu/spectrum.hpp"
#include "reference/spectrum.hpp"

namespace isotet {

namespace {

constexpr std::size_t max_spectrum_isovalues = 65'536;

Result<void> check_spectrum_input(const Grid& grid, const PointField& field, std::span<const double> isovalues) {
    if (field.values.components() != 1 || field.values.tuples() != grid.points.tuples())
        return invalid_argument(fmt::format("field '{}' has {} values of {} components, but the grid has {} points and "
                                            "the contoured field must have 1 component",
                                            field.name, field.values.tuples(), field.values.components(),
                                            grid.points.tuples()));
    if (isovalues.empty() || isovalues.size() > max_spectrum_isovalues)
        return invalid_argument(
            fmt::format("{} isovalues, but there must be 1 to {}", isovalues.size(), max_spectrum_isovalues));
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        if (!std::isfinite(isovalues[i]))
            return invalid_argument(fmt::format("isovalues[{}] is {}, but must be finite", i, isovalues[i]));
        if (i > 0 && isovalues[i] < isovalues[i - 1])
            return invalid_argument(
                fmt::format("isovalues[{}] is {}, less than the one before, {}, but they must ascend", i, isovalues[i],
                            isovalues[i - 1]));
    }
    return {};
}

/// Values as the engines take them: multiplied by a power of two until none is above 1, so that no difference is infinite.
/// What is below 2^-500 then counts as 0, so that no difference is too small to divide by.
class UnitValues {
public:
    UnitValues(double lower, double upper) {
        const double most = std::max(std::abs(lower), std::abs(upper));
        if (most > 0) std::frexp(most, &exponent_);
    }
    double operator()(double value) const {
        if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
        const double small = std::ldexp(value, -exponent_);
        return std::abs(small) < 0x1p-500 ? 0 : small;
    }

private:
    int exponent_ = 0;
};

Result<core::Buffer<double>> unit_values(const Array& values, const UnitValues& unit, const Progress& progress) {
    core::Buffer<double> out(values.size());
    values.visit([&](auto scalars) {
        core::parallel_pieces(out.size(), std::size_t{1} << 16, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) out[i] = unit(static_cast<double>(scalars[i]));
        });
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "measuring was cancelled"};
    return out;
}

enum class SpectrumBy : std::uint8_t { cpu, reference };

Result<ContourSpectrum> linear_spectrum(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                        SpectrumBy engine, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = core::check_cells(grid, *cells, progress); !ok) return ok.error();
    const auto statistics = statistics_of(field.values, {.threads = core::threads_here(), .progress = {}});
    if (!statistics) return statistics.error();
    double lower = isovalues.front(), upper = isovalues.back();
    for (const ComponentStatistics& component : *statistics) { // one, or none of an empty field
        lower = std::min(lower, component.lower);
        upper = std::max(upper, component.upper);
    }
    const UnitValues unit(lower, upper);
    const auto values = unit_values(field.values, unit, progress);
    if (!values) return values.error();
    std::vector<double> levels;
    for (const double isovalue : isovalues) levels.push_back(unit(isovalue));
    const ops::SpectrumInput input{*cells, core::PointReader(grid.points), {values->data(), values->size()}, levels};
    ops::Spectrum spectrum =
        engine == SpectrumBy::reference ? reference::contour_spectrum(input) : cpu::contour_spectrum(input, progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "measuring was cancelled"};
    ContourSpectrum out;
    out.isovalues.assign(isovalues.begin(), isovalues.end());
    out.area = std::move(spectrum.area);
    out.volume_below = std::move(spectrum.volume_below);
    out.volume = spectrum.volume;
    out.tets = spectrum.tets;
    out.no_data_tets = spectrum.no_data_tets;
    return out;
}

Result<ContourSpectrum> spectrum_by(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                    SpectrumBy engine, const Run& run) {
    return core::carry_out("measuring", run, [&](const Progress& progress) -> Result<ContourSpectrum> {
        if (auto ok = check_spectrum_input(grid, field, isovalues); !ok) return ok.error();
        if (!has_cells_to_linearize(grid.cells)) return linear_spectrum(grid, field, isovalues, engine, progress);
        const Run inner{.threads = core::threads_here(), .progress = progress};
        const auto linear = linearize(grid, {}, inner);
        if (!linear) return linear.error();
        Result<Array> values = linear->extend(field.values, inner);
        if (!values) return values.error();
        const PointField continued{field.name, *std::move(values), false, {}};
        return linear_spectrum(linear->grid, continued, isovalues, engine, progress);
    });
}

} // namespace

Result<ContourSpectrum> contour_spectrum(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                         const Run& run) {
    return spectrum_by(grid, field, isovalues, SpectrumBy::cpu, run);
}

Result<ContourSpectrum> contour_spectrum_over_range(const Grid& grid, const PointField& field, std::uint64_t steps,
                                                    const Run& run) {
    if (steps < 1 || steps >= max_spectrum_isovalues)
        return invalid_argument(fmt::format("{} steps, but there must be 1 to {}", steps, max_spectrum_isovalues - 1));
    const auto statistics = statistics_of(field.values, run);
    if (!statistics) return statistics.error();
    if (statistics->size() != 1) return contour_spectrum(grid, field, std::array{0.0}, run); // which says what is wrong
    const auto [lower, upper, no_data, infinite] = statistics->front();
    if (!(lower <= upper)) return ContourSpectrum{};
    std::vector<double> isovalues{lower};
    if (lower < upper) {
        const auto between = evenly_spaced_levels(lower, upper, steps - 1);
        isovalues.insert(isovalues.end(), between.begin(), between.end());
        isovalues.push_back(upper);
    }
    return contour_spectrum(grid, field, isovalues, run);
}

Result<ContourSpectrum> contour_spectrum_by_reference(const Grid& grid, const PointField& field,
                                                      std::span<const double> isovalues, const Run& run) {
    return spectrum_by(grid, field, isovalues, SpectrumBy::reference, run);
}

} // namespace isotet
