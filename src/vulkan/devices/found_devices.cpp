// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/found_devices.hpp"

#include <utility>

namespace isotet::vulkan {

Result<FoundDevices> find_devices(const Watch& watch, std::uint32_t version,
                                  const std::function<void(Capabilities&)>& alter) {
    FoundDevices found;
    Result<std::unique_ptr<Instance>> instance = Instance::open(watch, version);
    if (!instance) return instance.error();
    found.instance = *std::move(instance);
    Result<std::vector<VkPhysicalDevice>> handles = found.instance->devices();
    if (!handles) return handles.error();
    found.handles = *std::move(handles);
    for (const VkPhysicalDevice handle : found.handles) {
        Capabilities capabilities = ask(found.instance->call(), handle, version);
        if (alter) alter(capabilities);
        found.infos.push_back(describe(capabilities, found.infos.size()));
        found.capabilities.push_back(std::move(capabilities));
    }
    return found;
}

} // namespace isotet::vulkan
