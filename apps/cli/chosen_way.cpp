// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "chosen_way.hpp"

#include <algorithm>

namespace isotet::cli {

const Forecast* ChosenWay::forecast() const noexcept {
    const auto found = std::ranges::find(forecasts, way, &Forecast::way);
    return found == forecasts.end() ? nullptr : &*found;
}

bool ChosenWay::takes_brute_instead(const Error& refusal) {
    const auto fitting =
        std::ranges::find_if(forecasts, [](const Forecast& one) { return one.way == Way::brute && one.fits; });
    if (refusal.code != ErrorCode::out_of_memory || brute() || fitting == forecasts.end()) return false;
    way = Way::brute;
    why += ", but packing found too little memory";
    return true;
}

} // namespace isotet::cli
