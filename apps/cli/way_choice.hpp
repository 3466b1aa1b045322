// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which engine, method and filter `isotet extract` takes, and what that was expected to cost.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/choose.hpp>
#include <isotet/result.hpp>

#include "console.hpp"
#include "extractor.hpp"
#include "options.hpp"

namespace isotet::cli {

struct ChosenWay {
    Way way = Way::clusters;
    std::string why;
    /// Of all ways that were weighed, the best first; the chosen one is among them. Empty for what is not weighed: the
    /// reference engine, and devices that were not measured.
    std::vector<Forecast> forecasts;
    bool measured = false; ///< by speeds of this machine, not typical ones

    bool brute() const noexcept { return way == Way::brute; }
    const char* method() const noexcept { return brute() ? "brute" : "clusters"; }
    const char* filter() const noexcept { return brute() ? "none" : "cluster_ranges"; }
    const Forecast* forecast() const noexcept; ///< of the chosen way
};

/// Ways that the options leave open are weighed (isotet/choose.hpp): by typical speeds; where the work takes longer than
/// measuring, by those of this machine, which are measured once and kept. A graphics card that nobody asked for is opened
/// if the CPU would extract for long, and stays open in `extractor` if it is chosen.
///
/// Errors   cancelled
Result<ChosenWay> choose_way(const ExtractCommand& command, const Task& task, Extractor& extractor, Console& console);

/// --method brute does not go with a device.
Result<void> check_method(const ExtractCommand& command, const Extractor& extractor);

} // namespace isotet::cli
