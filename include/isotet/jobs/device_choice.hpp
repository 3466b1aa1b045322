// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which graphics card is used, the same in every job that can use one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <isotet/device.hpp>
#include <isotet/jobs/job.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

/// What extracts.
enum class EngineChoice : std::uint8_t { automatic, cpu, vulkan, reference };

/// Which Vulkan device, and how much of its memory.
struct DeviceChoice {
    std::string name;                    ///< as DeviceOptions::choice; "none": no device
    std::optional<std::uint64_t> memory; ///< bytes at most
};

/// Opens the device that was chosen, and notes what the user should know of it. Nothing for "none".
Result<std::optional<Device>> open_device(const DeviceChoice& choice, Caller& caller);

/// For drawing: the device that was chosen, else the best graphics card, else a software device, which is noted.
/// Errors   invalid_argument for "none"; machine when nothing can draw
Result<Device> open_drawing_device(const DeviceChoice& choice, Caller& caller);

} // namespace isotet::jobs
