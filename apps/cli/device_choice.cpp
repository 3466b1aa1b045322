// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "device_choice.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "exit_code.hpp"

namespace isotet::cli {

Result<std::optional<Device>> open_device(const DeviceChoice& choice, Console& console) {
    if (choice.name == "none") return std::optional<Device>();
    Result<Device> device = Device::open({choice.name, choice.memory.value_or(0)});
    if (!device) return device.error();
    console.notes(device->notices());
    console.detail(fmt::format("device {}: {}, {}", device->info().index, device->info().name, device->info().driver));
    return std::optional<Device>(*std::move(device));
}

Result<Device> open_drawing_device(const DeviceChoice& choice, Console& console) {
    if (choice.name == "none") return usage_error("--device is none, but only a device can draw");
    Result<std::optional<Device>> device = open_device(choice, console);
    if (!device && choice.name.empty() && is_of_device(device.error().code)) {
        const Result<DeviceList> list = list_devices();
        const auto draws = [](const DeviceInfo& one) {
            return one.kind == DeviceKind::software && one.unusable.empty();
        };
        if (!list || std::ranges::none_of(list->devices, draws))
            return Error{ErrorCode::no_device, "nothing can be drawn: " + device.error().message};
        DeviceChoice software = choice;
        software.name = "software";
        device = open_device(software, console);
    }
    if (!device) return device.error();
    if ((*device)->info().kind == DeviceKind::software)
        console.note(fmt::format("a software device draws: {}", (*device)->info().name));
    return **std::move(device);
}

} // namespace isotet::cli
