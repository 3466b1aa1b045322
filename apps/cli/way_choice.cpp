// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "way_choice.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "kept_speeds.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

constexpr double worth_measuring = 4; ///< seconds of work: twice what measuring takes
constexpr double worth_a_device =
    5; ///< seconds of extraction: opening a device and measuring it takes about half of that

bool device_may_be_taken(const ExtractCommand& command) {
    return command.engine == EngineChoice::automatic && command.device.name.empty() &&
           command.method != MethodChoice::brute;
}

bool is_open(const ExtractCommand& command, Way way) {
    if (command.method == MethodChoice::automatic) return true;
    return (way == Way::brute) == (command.method == MethodChoice::brute);
}

std::vector<Forecast> weigh_open(const ExtractCommand& command, const Task& task, const Speeds& speeds,
                                 const DeviceSpeeds* device) {
    std::vector<Forecast> forecasts = weigh(task, speeds, device);
    std::erase_if(forecasts, [&](const Forecast& one) { return !is_open(command, one.way); });
    return forecasts;
}

/// Those of this machine if they are kept, or worth measuring; typical ones otherwise.
Result<Speeds> speeds_for(const ExtractCommand& command, const Task& task, Console& console, bool& measured) {
    const int threads = command.common.threads;
    const std::string key = processor_key(threads);
    const std::optional<Speeds> kept = kept_speeds(key);
    measured = kept.has_value();
    if (kept) return *kept;
    if (weigh_open(command, task, typical_speeds(), nullptr).front().seconds < worth_measuring) return typical_speeds();
    console.detail("measuring the speed of " + key);
    const Result<Speeds> speeds = measure_speeds(threads, console.progress());
    if (!speeds && speeds.error().code == ErrorCode::cancelled) return speeds;
    if (!speeds) return typical_speeds(); // too little memory to measure: the work itself may still fit
    keep(key, *speeds);
    measured = true;
    return speeds;
}

/// Opens a graphics card and measures it, if there is one and it may pay.
Result<std::optional<DeviceSpeeds>> consider_device(const ExtractCommand& command, const Task& task,
                                                    const Speeds& speeds, Extractor& extractor, Console& console) {
    const Forecast best = weigh_open(command, task, speeds, nullptr).front();
    const double packing =
        speeds.pack_call + static_cast<double>(task.tets) * speeds.pack_tet; // which a device needs, too
    if (!device_may_be_taken(command) || best.seconds - packing < worth_a_device || !extractor.open_unasked())
        return std::optional<DeviceSpeeds>();
    const std::string key = device_key(extractor.device()->info(), command.common.threads);
    if (const std::optional<DeviceSpeeds> kept = kept_device_speeds(key)) return kept;
    console.detail("measuring the speed of " + key);
    const Result<DeviceSpeeds> measured =
        measure_speeds(*extractor.device(), command.common.threads, console.progress());
    if (!measured && measured.error().code == ErrorCode::cancelled) return measured.error();
    if (!measured) return std::optional<DeviceSpeeds>();
    keep(key, *measured);
    return std::optional<DeviceSpeeds>(*measured);
}

std::string why_of(const ChosenWay& choice, const Task& task) {
    std::string text = fmt::format("auto: {} surface{}", rounded(task.surfaces), task.surfaces == 1 ? "" : "s");
    for (const Forecast& one : choice.forecasts)
        text += fmt::format(", {} {}{}", name_of(one.way), seconds_text(one.seconds),
                            one.fits ? "" : " and too much memory");
    return text + (choice.measured ? "" : ", by typical speeds");
}

} // namespace

Result<void> check_method(const ExtractCommand& command, const Extractor& extractor) {
    if (command.method != MethodChoice::brute || !extractor.wants_device()) return {};
    return Error{ErrorCode::invalid_argument,
                 "--method brute was asked for, but devices take packed grids only: clusters"};
}

Result<ChosenWay> choose_way(const ExtractCommand& command, const Task& task, Extractor& extractor, Console& console) {
    ChosenWay choice;
    const bool method_asked = command.method != MethodChoice::automatic;
    if (extractor.device()) { // named, or asked for
        choice.way = Way::device_clusters;
        choice.why = method_asked ? "asked for" : "auto: devices take packed grids";
        return choice;
    }
    const Result<Speeds> speeds = speeds_for(command, task, console, choice.measured);
    if (!speeds) return speeds.error();
    const auto device = consider_device(command, task, *speeds, extractor, console);
    if (!device) return device.error();
    Task with_device = task;
    if (*device) with_device.device_memory_free = extractor.device()->memory_free();
    choice.forecasts = weigh_open(command, with_device, *speeds, *device ? &**device : nullptr);
    choice.way = choice.forecasts.front().way;
    choice.why = method_asked && choice.forecasts.size() == 1 ? "asked for" : why_of(choice, task);
    if (choice.way != Way::device_clusters) extractor.close();
    // Chosen as for the CPU engine; how long it takes nobody foretells.
    if (command.engine == EngineChoice::reference) choice.forecasts.clear();
    return choice;
}

} // namespace isotet::cli
