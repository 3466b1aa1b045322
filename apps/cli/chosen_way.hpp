// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The way that was chosen, and what the others were expected to cost.
#pragma once

#include <string>
#include <vector>

#include <isotet/choose.hpp>
#include <isotet/result.hpp>

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

    /// Where packing, which was chosen, was refused for want of memory: brute becomes the way, if it was weighed and
    /// fits.
    bool takes_brute_instead(const Error& refusal);
};

} // namespace isotet::cli
