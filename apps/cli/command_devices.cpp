// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet devices`: which Vulkan devices there are, and whether they can be used.
#include <fmt/format.h>

#include <isotet/device.hpp>
#include <isotet/jobs/device_choice.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::string use_text(const DeviceInfo& device, const DeviceList& list) {
    if (!device.unusable.empty()) return "cannot be used: " + device.unusable;
    if (list.best == device.index) return "used without --device";
    if (device.kind == DeviceKind::software) return "used only by --device software";
    return fmt::format("used by --device {}", device.index);
}

std::string memory_text(const DeviceInfo& device) {
    return fmt::format("{}{}{}", format_bytes(device.memory),
                       device.memory_free_known ? fmt::format(", {} free", format_bytes(device.memory_free)) : "",
                       device.unified_memory ? ", shared with the processor" : "");
}

void add_rows(Table& table, const DeviceInfo& device, const DeviceList& list) {
    table.row({fmt::format("device {}", device.index), fmt::format("{} ({})", device.name, name_of(device.kind))});
    table.row({"", use_text(device, list)});
    table.row({"driver", device.driver});
    table.row({"Vulkan", device.api});
    if (device.memory == 0) return; // nothing more is known of devices before Vulkan 1.1
    table.row({"memory", memory_text(device)});
    table.row({"largest buffer", format_bytes(device.allocation_limit)});
    table.row({"workgroups",
               fmt::format("{} x {} x {} of up to {}", grouped(device.workgroups[0]), grouped(device.workgroups[1]),
                           grouped(device.workgroups[2]), grouped(device.workgroup_size))});
    table.row({"shared memory", fmt::format("{} a workgroup", format_bytes(device.shared_memory))});
    table.row({"subgroup", grouped(device.subgroup_size)});
    table.row({"copies", device.transfer_queue ? "on a queue of their own" : "on the queue of the kernels"});
    if (!device.timestamps) table.row({"times", "of single passes cannot be measured"});
}

Json json_of(const DeviceInfo& device) {
    return {{"index", device.index},
            {"name", json_text(device.name)},
            {"kind", name_of(device.kind)},
            {"unusable", device.unusable.empty() ? Json(nullptr) : Json(json_text(device.unusable))},
            {"driver", json_text(device.driver)},
            {"vulkan", device.api},
            {"memory", device.memory},
            {"memory_free", device.memory_free_known ? Json(device.memory_free) : Json(nullptr)},
            {"unified_memory", device.unified_memory},
            {"largest_buffer", device.allocation_limit},
            {"workgroups", device.workgroups},
            {"workgroup_size", device.workgroup_size},
            {"shared_memory", device.shared_memory},
            {"subgroup_size", device.subgroup_size},
            {"transfer_queue", device.transfer_queue},
            {"timestamps", device.timestamps}};
}

/// What --device found out: the list is that device alone then.
struct Tested {
    bool opened = false;
    bool exact = false;
};

Result<Tested> test_chosen(const DeviceChoice& choice, DeviceList& list, Console& console) {
    if (choice.name.empty()) return Tested{};
    const Result<std::optional<Device>> device = open_device(choice, console);
    if (!device) return device.error();
    if (!*device) return usage_error("--device none is no device that could be opened");
    list.devices = {(*device)->info()};
    return Tested{true, (*device)->notices().empty()};
}

} // namespace

Result<ExitCode> run_devices(const DevicesCommand& command) {
    Console console(command.common);
    if (Result<void> paths = check_output_paths({}, {command.common.json}); !paths) return paths.error();
    Result<DeviceList> list = list_devices();
    if (!list) return list.error();
    const Result<Tested> tested = test_chosen(command.device, *list, console);
    if (!tested) return tested.error();

    Table table = facts();
    for (const DeviceInfo& device : list->devices) {
        if (!table.empty()) table.row({});
        add_rows(table, device, *list);
    }
    if (tested->opened) table.row({"arithmetic", tested->exact ? "exact" : "not exact"});
    if (!list->unavailable.empty()) console.note(list->unavailable + "; isotet works on the CPU");
    else if (!list->best && !tested->opened)
        console.note("there is no graphics card that can be used; isotet works on the CPU");

    Json report = json_report("devices");
    report["unavailable"] = list->unavailable.empty() ? Json(nullptr) : Json(json_text(list->unavailable));
    report["best"] = list->best ? Json(*list->best) : Json(nullptr);
    Json devices = Json::array();
    for (const DeviceInfo& device : list->devices) devices.push_back(json_of(device));
    report["devices"] = std::move(devices);
    report["exact"] = tested->opened ? Json(tested->exact) : Json(nullptr);
    return finish(console, command.common, table.text(), std::move(report));
}

} // namespace isotet::cli
