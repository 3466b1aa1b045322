// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which engine, method and filter `isotet extract` takes, and what that was expected to cost.
#pragma once

#include <isotet/choose.hpp>
#include <isotet/result.hpp>

#include "chosen_way.hpp"
#include "console.hpp"
#include "extractor.hpp"
#include "options.hpp"

namespace isotet::cli {

/// Ways that the options leave open are weighed (isotet/choose.hpp): by typical speeds; where the work takes longer
/// than measuring, by those of this machine, which are measured once and kept. A graphics card that nobody asked for is
/// opened if the CPU would extract for long, and stays open in `extractor` if it is chosen.
///
/// Errors   cancelled
Result<ChosenWay> choose_way(const ExtractCommand& command, const Task& task, Extractor& extractor, Console& console);

/// --method brute does not go with a device.
Result<void> check_method(const ExtractCommand& command, const Extractor& extractor);

} // namespace isotet::cli
