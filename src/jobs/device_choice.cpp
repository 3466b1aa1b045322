// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/device_choice.hpp>

#include <algorithm>

#include <fmt/format.h>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

Result<std::optional<Device>> open_device(const DeviceChoice& choice, Caller& caller) {
    if (choice.name == "none") return std::optional<Device>();
    Result<Device> device = Device::open({choice.name, choice.memory.value_or(0)});
    if (!device) return device.error();
    caller.notes(device->notices());
    caller.detail(fmt::format("device {}: {}, {}", device->info().index, device->info().name, device->info().driver));
    return std::optional<Device>(*std::move(device));
}

Result<Device> open_drawing_device(const DeviceChoice& choice, Caller& caller) {
    if (choice.name == "none") return refusal("`device` is none, but only a device can draw");
    Result<std::optional<Device>> device = open_device(choice, caller);
    if (!device && choice.name.empty() && is_of_device(device.error().code)) {
        const Result<DeviceList> list = list_devices();
        const auto draws = [](const DeviceInfo& one) {
            return one.kind == DeviceKind::software && one.unusable.empty();
        };
        if (!list || std::ranges::none_of(list->devices, draws))
            return Error{ErrorCode::no_device, "nothing can be drawn: " + device.error().message};
        DeviceChoice software = choice;
        software.name = "software";
        device = open_device(software, caller);
    }
    if (!device) return device.error();
    if ((*device)->info().kind == DeviceKind::software)
        caller.note(fmt::format("a software device draws: {}", (*device)->info().name));
    return **std::move(device);
}

} // namespace isotet::jobs
