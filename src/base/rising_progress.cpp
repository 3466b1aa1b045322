// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/rising_progress.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace isotet::core {

Progress rising(const Progress& progress) {
    Progress out;
    out.cancel = progress.cancel;
    if (!progress.report) return out;
    struct Reported {
        std::mutex mutex;
        std::map<std::string, double, std::less<>> highest; ///< by step
    };
    out.report = [reported = std::make_shared<Reported>(), &report = progress.report](std::string_view step,
                                                                                      double fraction) {
        const std::unique_lock lock(reported->mutex, std::try_to_lock);
        if (!lock) return;
        const auto [place, is_new] = reported->highest.try_emplace(std::string(step), fraction);
        if (fraction < place->second) return;
        place->second = fraction;
        report(step, fraction);
    };
    return out;
}

} // namespace isotet::core
