// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/tet_pages.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "numbers/normal_code.hpp"
#include "render/device/send.hpp"
#include "render/device/tet_records.hpp"

namespace isotet::render {

namespace {

using vulkan::Buffer;
using vulkan::Memory;
using vulkan::Where;

bool has_textures(DrawMethod method) { return method == DrawMethod::textures || method == DrawMethod::mesh; }

Result<void> check_options(const vulkan::Context& context, const core::Packed& packed, DrawMethod method,
                           const TetStoreOptions& options) {
    if (method == DrawMethod::mesh && !context.capabilities().mesh_shaders)
        return Error{ErrorCode::no_device,
                     fmt::format("the device {} has no mesh shaders (VK_EXT_mesh_shader), which the method mesh needs",
                                 context.info().name)};
    if (!options.gradients) return {};
    if (!has_textures(method))
        return invalid_argument(fmt::format(
            "the method {} was asked for gradients, but only textures and mesh keep them", name_of(method)));
    if (packed.gradients.empty())
        return invalid_argument("shading by gradients needs a grid that was packed with gradients");
    return {};
}

/// The direction of the gradient at every point, of unit length, and 0; zero where there is none.
core::Buffer<std::array<float, 4>> directions_of(const core::Packed& packed) {
    core::Buffer<std::array<float, 4>> directions(packed.gradients.size());
    core::parallel_each(directions.size(), std::size_t{1} << 16, [&](std::size_t p) {
        const std::array<int, 3> n = core::decode_normal(packed.gradients[p]);
        const double x = n[0], y = n[1], z = n[2], squares = x * x + y * y + z * z;
        const double factor = squares > 0 ? 1 / std::sqrt(squares) : 0;
        directions[p] = {static_cast<float>(x * factor), static_cast<float>(y * factor), static_cast<float>(z * factor),
                         0};
    });
    return directions;
}

/// The isovalues that cut any tet of a group.
core::Buffer<core::CutRange> group_ranges_of(const core::TetTable& table) {
    const std::size_t tets = table.tets.size();
    core::Buffer<core::CutRange> ranges((tets + layout::tet_group - 1) / layout::tet_group);
    static_assert(sizeof(core::CutRange) == sizeof(vulkan::layout::Range));
    core::parallel_each(ranges.size(), 1024, [&](std::size_t group) {
        core::CutRange all;
        const std::size_t first = group * layout::tet_group, end = std::min(first + layout::tet_group, tets);
        for (std::size_t tet = first; tet < end; ++tet) all.take_in(table.range(static_cast<std::uint32_t>(tet)));
        ranges[group] = all;
    });
    return ranges;
}

} // namespace

Result<std::shared_ptr<TetPages>> TetPages::upload(std::shared_ptr<vulkan::Context> context, const core::Packed& packed,
                                                   DrawMethod method, const TetStoreOptions& options,
                                                   const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    if (Result<void> right = check_options(*context, packed, method, options); !right) return right.error();
    const std::uint64_t table_bytes = 16 * (packed.report.tets + packed.points());
    if (Result<void> there = core::require_memory("making the tables of tets and points", table_bytes); !there)
        return there.error();
    const Result<core::TetTable> table = core::make_tet_table(packed);
    if (!table) return table.error();

    auto pages = std::make_shared<TetPages>();
    pages->context = std::move(context);
    pages->method = method;
    pages->gradients = options.gradients;
    pages->origin = packed.origin;
    pages->storage = packed.storage;
    pages->report.tets = table->tets.size();
    pages->report.points = table->points.size();
    const std::uint64_t spared = options.picture_bytes.value_or(pages->context->memory().free() / 8);
    if (has_textures(method))
        if (Result<void> done = pages->upload_points(*table, packed); !done) return done.error();
    if (Result<void> done = pages->upload_tets(*table, spared, progress); !done) return done.error();
    pages->report.stored_bytes = pages->report.device_bytes + pages->report.host_bytes;
    pages->report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return pages;
}

Result<void> TetPages::upload_points(const core::TetTable& table, const core::Packed& packed) {
    const auto keep = [&](Result<Buffer> sent, Buffer& buffer) -> Result<void> {
        if (!sent) return sent.error();
        buffer = *std::move(sent);
        report.device_bytes += buffer.size();
        return {};
    };
    Result<void> done =
        keep(send(*context, std::as_bytes(std::span(&layout::tet_tables, 1)), "tables of cases and edges"), tables);
    if (done) done = keep(send(*context, table.points, "points of tets"), points);
    if (done && gradients) done = keep(send(*context, directions_of(packed), "gradients of tets"), directions);
    if (done && method == DrawMethod::mesh)
        done = keep(send(*context, group_ranges_of(table), "ranges of groups of tets"), ranges);
    return done;
}

/// Decides which pages lie on the device: the first ones, as many as there is room for.
Result<void> TetPages::plan(std::uint64_t tets, std::uint64_t spared) {
    const auto page_bytes = [&](std::uint64_t page_tets) { return page_tets * record_bytes(method); };
    for (std::uint64_t first = 0; first < tets; first += layout::page_tets)
        pages.push_back(
            {{}, static_cast<std::uint32_t>(std::min<std::uint64_t>(layout::page_tets, tets - first)), false});
    std::uint64_t needed = 0;
    for (const Page& page : pages) needed += Memory::cost(page_bytes(page.tets));
    std::uint64_t room = context->memory().free();
    room -= std::min(room, spared);
    if (needed > room) {
        Result<Buffer> taken =
            context->memory().take(page_bytes(pages.front().tets), Where::device, "one page of tets");
        if (!taken) return taken.error();
        room -= std::min(room, Memory::cost(taken->size()));
        guest = *std::move(taken);
    }
    std::uint64_t elsewhere = 0;
    for (Page& page : pages) {
        const std::uint64_t cost = Memory::cost(page_bytes(page.tets));
        page.on_device = cost <= room;
        if (page.on_device) room -= cost;
        else {
            room = 0;
            elsewhere += cost;
        }
    }
    return core::require_memory("the part of the store for which the device has no room", elsewhere);
}

Result<void> TetPages::upload_tets(const core::TetTable& table, std::uint64_t spared, const Progress& progress) {
    if (Result<void> planned = plan(table.tets.size(), spared); !planned) return planned;
    std::uint64_t first = 0;
    for (Page& page : pages) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "uploading tets was cancelled"};
        if (Result<void> filled = fill(page, first, table); !filled) return filled;
        (page.on_device ? report.device_bytes : report.host_bytes) += page.records.size();
        first += page.tets;
        progress("upload", static_cast<double>(first) / static_cast<double>(table.tets.size()));
    }
    return {};
}

Result<void> TetPages::fill(Page& page, std::uint64_t first, const core::TetTable& table) {
    const std::uint64_t bytes = page.tets * record_bytes(method);
    Result<Buffer> taken = context->memory().take(bytes, page.on_device ? Where::device : Where::upload, "tets");
    if (!taken) return taken.error();
    page.records = *std::move(taken);
    if (!page.on_device) {
        write_records(method, table, first, page.records.mapped());
        return {};
    }
    core::Buffer<std::byte> records(bytes);
    write_records(method, table, first, {records.data(), records.size()});
    return context->staging().upload(page.records, 0, {records.data(), records.size()});
}

std::array<std::uint32_t, 5> TetPages::constants(bool has_list) const {
    const std::uint32_t shading = gradients;
    switch (method) {
    case DrawMethod::registers: return {layout::one_color, shading, layout::registers_method, has_list, shading};
    case DrawMethod::registers_instanced:
        return {layout::one_color, shading, layout::instanced_method, has_list, shading};
    case DrawMethod::textures:
    case DrawMethod::mesh: return {layout::one_color, shading, layout::textures_method, has_list, shading};
    }
    return {};
}

} // namespace isotet::render
