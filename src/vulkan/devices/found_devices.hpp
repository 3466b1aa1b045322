// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All Vulkan devices of this machine, with what each can do.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/result.hpp>

#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/instance.hpp"

namespace isotet::vulkan {

struct FoundDevices {
    std::unique_ptr<Instance> instance;
    std::vector<VkPhysicalDevice> handles;
    std::vector<Capabilities> capabilities;
    std::vector<DeviceInfo> infos;
};

/// `version`  the newest version of Vulkan that is used
/// `alter`    changes what devices say of themselves, for tests; may be empty
/// Errors     machine when there is no loader, no driver, or either fails
Result<FoundDevices> find_devices(const Watch& watch, std::uint32_t version,
                                  const std::function<void(Capabilities&)>& alter);

} // namespace isotet::vulkan
