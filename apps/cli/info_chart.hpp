// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet info --chart`: area and volume against the isovalue.
#pragma once

#include <optional>
#include <string>

#include <isotet/contour_spectrum.hpp>

#include "console.hpp"
#include "json_output.hpp"
#include "options.hpp"

namespace isotet::cli {

struct InfoChart {
    std::string field;
    ContourSpectrum spectrum;
};

/// Nothing where none is asked for.
Result<std::optional<InfoChart>> make_chart(const InfoCommand& command, const Grid& grid, Console& console);

std::string chart_table(const InfoChart& chart);
Json json_of(const InfoChart& chart);

} // namespace isotet::cli
