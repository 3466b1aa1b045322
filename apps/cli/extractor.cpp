// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "extractor.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "device_choice.hpp"
#include "number_format.hpp"

namespace isotet::cli {

bool Extractor::wants_device() const {
    if (command_.engine == EngineChoice::vulkan) return true;
    return command_.engine == EngineChoice::automatic && !command_.device.name.empty() &&
           command_.device.name != "none";
}

Result<void> Extractor::open() {
    const bool named = !command_.device.name.empty() || command_.device.memory;
    if (named && (command_.engine == EngineChoice::cpu || command_.engine == EngineChoice::reference))
        return Error{ErrorCode::invalid_argument, "a device is asked for, but only --engine vulkan and auto use one"};
    if (!wants_device()) return {};
    if (command_.device.name == "none")
        return Error{ErrorCode::invalid_argument, "--engine vulkan needs a device, but --device is none"};
    Result<std::optional<Device>> device = open_device(command_.device, console_);
    if (!device) return device.error().code == ErrorCode::machine ? without_device(device.error()) : device.error();
    device_ = *std::move(device);
    return {};
}

bool Extractor::open_unasked() {
    Result<Device> device = Device::open({{}, command_.device.memory.value_or(0)});
    if (!device) return false;
    console_.notes(device->notices());
    device_ = *std::move(device);
    return true;
}

Result<void> Extractor::without_device(const Error& error) {
    if (command_.engine == EngineChoice::vulkan || error.code == ErrorCode::cancelled) return error;
    console_.note(fmt::format("{}: the CPU extracts instead", error.message));
    surface_ = {};
    grid_.reset();
    device_.reset();
    return {};
}

Result<void> Extractor::load(const PackedGrid& packed) {
    packed_ = &packed;
    if (!device_) return {};
    DeviceGridOptions options;
    options.page_bytes = std::clamp<std::uint64_t>(device_->memory_free() / 16, 16 << 10, options.page_bytes);
    const DeviceGridNeeds needs = DeviceGrid::needs(packed, options);
    if (needs.pages > 0) {
        console_.detail(fmt::format("the packed grid takes {} of device memory, {} at least; {} are free",
                                    bytes_text(needs.all()), bytes_text(needs.least()),
                                    bytes_text(device_->memory_free())));
    }
    Result<DeviceGrid> grid = DeviceGrid::upload(*device_, packed, options, {.progress = console_.progress()});
    if (!grid) return without_device(grid.error());
    grid_ = *std::move(grid);
    if (!grid_->complete()) {
        console_.note(
            fmt::format("not all of the packed grid, {}, fits into the device's memory: its parts come and go",
                        bytes_text(needs.all())));
    }
    return {};
}

Result<bool> Extractor::left_to_cpu(const Result<void>& set) {
    if (set) return false;
    const ErrorCode code = set.error().code;
    if (code != ErrorCode::machine && code != ErrorCode::out_of_memory) return set.error();
    if (Result<void> instead = without_device(set.error()); !instead) return instead.error();
    return true;
}

Result<void> Extractor::set_field(PackedGrid& packed, const PointField& field, int threads) {
    const Run run{threads, console_.progress()};
    if (grid_) {
        const Result<bool> left = left_to_cpu(grid_->set_field(field, run));
        if (!left) return left.error();
        if (!*left) {
            packed = grid_->packed();
            return {};
        }
    }
    Result<PackedGrid> changed = packed.with_field(field, run);
    if (!changed) return changed.error();
    packed = *changed;
    return {};
}

Result<void> Extractor::set_points(PackedGrid& packed, const Array& points, int threads) {
    const Run run{threads, console_.progress()};
    if (grid_) {
        const Result<bool> left = left_to_cpu(grid_->set_points(points, run));
        if (!left) return left.error();
        if (!*left) {
            packed = grid_->packed();
            return {};
        }
    }
    Result<PackedGrid> changed = packed.with_points(points, run);
    if (!changed) return changed.error();
    packed = *changed;
    return {};
}

Result<Extraction> Extractor::extract_on_device(double isovalue, const ExtractOptions& options) {
    if (Result<void> done = grid_->extract(isovalue, surface_, options, console_.progress()); !done)
        return done.error();
    DeviceWork work = grid_->work();
    Result<Extraction> extraction = grid_->download(surface_, console_.progress());
    if (!extraction) return extraction;
    work.downloaded_bytes += grid_->work().downloaded_bytes;
    last_ = {work.device_seconds, work.uploaded_bytes, work.downloaded_bytes, work.page_loads};
    return extraction;
}

Result<std::vector<Extraction>> Extractor::extract(std::span<const double> isovalues, const ExtractOptions& options) {
    last_.reset();
    std::vector<Extraction> done;
    while (grid_ && done.size() < isovalues.size()) {
        Result<Extraction> extraction = extract_on_device(isovalues[done.size()], options);
        if (extraction) done.push_back(*std::move(extraction));
        else if (Result<void> instead = without_device(extraction.error()); !instead) return instead.error();
    }
    if (done.size() == isovalues.size()) return done;
    last_.reset();
    auto rest = isotet::extract(*packed_, isovalues.subspan(done.size()), options, console_.progress());
    if (!rest) return rest;
    std::move(rest->begin(), rest->end(), std::back_inserter(done));
    return done;
}

const char* Extractor::engine_name() const {
    if (device_) return "vulkan";
    return command_.engine == EngineChoice::reference ? "reference" : "cpu";
}

std::string Extractor::engine_text() const {
    return device_ ? fmt::format("{} on {}", engine_name(), device_->info().name) : engine_name();
}

} // namespace isotet::cli
