// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// --device and --device-memory, the same in every command that can use a graphics card.
#pragma once

#include <optional>

#include <isotet/device.hpp>
#include <isotet/result.hpp>

#include "console.hpp"
#include "options.hpp"

namespace isotet::cli {

/// Opens the device that was chosen, and notes what the user should know of it. Nothing for --device none.
Result<std::optional<Device>> open_device(const DeviceChoice& choice, Console& console);

/// For drawing: the device that was chosen, else the best graphics card, else a software device, which is noted.
/// Errors   invalid_argument for --device none; machine when nothing can draw
Result<Device> open_drawing_device(const DeviceChoice& choice, Console& console);

} // namespace isotet::cli
