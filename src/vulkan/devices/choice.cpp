// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/choice.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/core.h>

namespace isotet::vulkan {

namespace {

/// "0: NVIDIA ... (unusable: ...); 1: llvmpipe (software)".
std::string listed(std::span<const DeviceInfo> devices) {
    std::string text;
    for (const DeviceInfo& device : devices) {
        text += fmt::format("{}{}: {} ({}{}{})", text.empty() ? "" : "; ", device.index, device.name,
                            name_of(device.kind), device.unusable.empty() ? "" : "; cannot be used: ", device.unusable);
    }
    return text.empty() ? "there is none" : text;
}

/// Real GPUs, best first. Memory decides among equals, then the driver's order.
std::optional<std::size_t> best_gpu(std::span<const DeviceInfo> devices) {
    const auto rank = [&](std::size_t i) { return std::tuple(devices[i].kind, ~devices[i].memory, i); };
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (devices[i].kind == DeviceKind::software || !devices[i].unusable.empty()) continue;
        if (!best || rank(i) < rank(*best)) best = i;
    }
    return best;
}

std::optional<std::size_t> whole_number(std::string_view text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

Result<std::size_t> if_usable(std::span<const DeviceInfo> devices, std::size_t i) {
    if (devices[i].unusable.empty()) return i;
    return Error{ErrorCode::no_device,
                 fmt::format("the device {} cannot be used: {}", devices[i].name, devices[i].unusable)};
}

/// The only device of those that fit, or the only usable one.
Result<std::size_t> only(std::span<const DeviceInfo> devices, std::vector<std::size_t> fitting,
                         std::string_view choice) {
    if (fitting.empty()) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("no Vulkan device is called '{}'; devices: {}", choice, listed(devices))};
    }
    if (fitting.size() > 1) {
        std::erase_if(fitting, [&](std::size_t i) { return !devices[i].unusable.empty(); });
        if (fitting.size() != 1) {
            return Error{ErrorCode::invalid_argument,
                         fmt::format("'{}' fits more than one Vulkan device; devices: {}", choice, listed(devices))};
        }
    }
    return if_usable(devices, fitting.front());
}

} // namespace

Result<std::size_t> choose(std::span<const DeviceInfo> devices, std::string_view choice) {
    if (choice.empty()) {
        if (const auto best = best_gpu(devices)) return *best;
        return Error{ErrorCode::no_device,
                     fmt::format("no graphics card that can be used; devices: {}", listed(devices))};
    }
    if (const auto index = whole_number(choice)) {
        if (*index < devices.size()) return if_usable(devices, *index);
        return Error{ErrorCode::invalid_argument,
                     fmt::format("there is no Vulkan device {}; devices: {}", *index, listed(devices))};
    }
    std::vector<std::size_t> fitting;
    const std::string wanted = lower_case(choice);
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (wanted == "software" ? devices[i].kind == DeviceKind::software
                                 : lower_case(devices[i].name).find(wanted) != std::string::npos)
            fitting.push_back(i);
    }
    return only(devices, std::move(fitting), choice);
}

} // namespace isotet::vulkan
