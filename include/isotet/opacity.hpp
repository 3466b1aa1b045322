// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How opaque a volume is, by the values of its field: as points, as text, and by presets.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/field_statistics.hpp>
#include <isotet/result.hpp>

namespace isotet {

struct OpacityPoint {
    double value = 0;   ///< of the field
    double opacity = 0; ///< 0 to 1: what a given length of this value hides

    friend bool operator==(const OpacityPoint&, const OpacityPoint&) = default;
};

/// Opacity over the values of a field: linear between points, and that of the first and the last point beyond them.
/// Two points with one value are a step. Without points everything is transparent.
struct ISOTET_API OpacityCurve {
    std::vector<OpacityPoint> points;

    double at(double value) const noexcept;
    bool is_transparent() const noexcept; ///< everywhere

    /// Errors   invalid_argument, with the number of the point: values that descend or are not finite, an opacity that
    ///          is not from 0 to 1
    Result<void> check() const;
};

enum class OpacityPreset : std::uint8_t {
    ramp,  ///< from transparent at the lower end of a range to 0.6 at the upper
    peaks, ///< narrow peaks at isovalues, transparent elsewhere
    shell  ///< transparent near both ends of a range, 0.35 between
};

/// What a text says: points, or a preset.
struct OpacityText {
    OpacityCurve curve; ///< of points
    std::optional<OpacityPreset> preset;
    std::uint64_t peaks = 0; ///< how many; 0: not said
};

/// "0:0,300:0.02,400:0.5" (value:opacity, values ascending), "ramp", "peaks", "peaks:5" or "shell".
///
/// Errors   invalid_argument: what is wrong, at which point, and the rule
ISOTET_API Result<OpacityText> parse_opacity(std::string_view text);

/// The curve of a preset. A range of one value is 0.35 opaque everywhere.
///
/// `range`    of the field, finite, lower <= upper
/// `levels`   of peaks, ascending; others take none
ISOTET_API OpacityCurve opacity_of(OpacityPreset preset, const ValueRange& range, std::span<const double> levels = {});

/// The curve that a text says; peaks are at as many levels, three where it is not said, evenly inside the range.
///
/// `range`    of the field; of presets finite, lower <= upper
ISOTET_API OpacityCurve opacity_of(const OpacityText& text, const ValueRange& range);

} // namespace isotet
