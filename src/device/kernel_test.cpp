// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "device/kernel_test.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/core.h>

#include <isotet/fields.hpp>
#include <isotet/device.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "vulkan/context.hpp"
#include "vulkan/engine/kernel_hash.hpp"

namespace isotet {

namespace {

bool same_bytes(const Array& a, const Array& b) {
    return a.bytes() == b.bytes() && (a.bytes() == 0 || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

struct SmallGrid {
    const char* shape;
    const char* cells;
};

Result<void> test_on(const Device& device, const SmallGrid& small) {
    const Result<Grid> grid = make_grid({.shape = small.shape, .side = 6, .fields = {"gyroid"}});
    if (!grid) return grid.error();
    const Result<PointField> field = find_field(*grid, "gyroid");
    if (!field) return field.error();
    const Result<PackedGrid> packed = pack(*grid, *field);
    if (!packed) return packed.error();
    Result<DeviceGrid> on_device = DeviceGrid::upload(device, *packed);
    if (!on_device) return on_device.error();
    constexpr double with_ties = 0;
    const Result<Extraction> right = extract(*packed, with_ties);
    if (!right) return right.error();
    const Result<DeviceSurface> surface = on_device->extract(with_ties);
    if (!surface) return surface.error();
    const Result<Extraction> found = on_device->download(*surface);
    if (!found) return found.error();
    const bool exact = device.notices().empty();
    if (same_bytes(found->surface.triangles, right->surface.triangles) &&
        (!exact || same_bytes(found->surface.positions, right->surface.positions)))
        return {};
    return Error{
        ErrorCode::no_device,
        fmt::format("the device {} is not used: what its driver makes of isotet's kernels gives another surface of "
                    "a small grid of {} than the CPU does ({})",
                    device.info().name, small.cells, device.info().driver)};
}

/// A file beside the cache of compiled kernels, with the hash of those kernels that were right with this driver.
std::filesystem::path note_of(const Device& device) {
    std::filesystem::path note = device.context()->pipeline_cache().file();
    if (!note.empty()) note += vulkan::PipelineCache::tested_suffix;
    return note;
}

} // namespace

Result<void> test_kernels_once(const Device& device) {
    const std::filesystem::path note = note_of(device);
    const std::string hash = fmt::format("{:016x}", vulkan::kernel_hash());
    std::string noted;
    if (!note.empty() && std::ifstream(note) >> noted && noted == hash) return {};
    if (Result<void> done = test_kernels(device); !done || note.empty()) return done;
    std::error_code failed;
    std::filesystem::create_directories(note.parent_path(), failed);
    std::ofstream(note) << hash; // where that fails, the next start tests again
    return {};
}

Result<void> test_kernels(const Device& device) {
    for (const SmallGrid& small : {SmallGrid{"kuhn", "tets"}, SmallGrid{"mixed", "all kinds of cells"}})
        if (Result<void> done = test_on(device, small); !done) return done;
    return {};
}

} // namespace isotet
