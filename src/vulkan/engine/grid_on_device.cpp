// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/grid_on_device.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/system/memory.hpp"

namespace isotet::vulkan {

namespace {

constexpr std::uint64_t limit_32 = std::uint64_t{1} << 32;

GridNeeds needs_of(const core::Packed& packed, const std::vector<PlannedPage>& plan) {
    GridNeeds needs;
    needs.resident = ResidentSizes(packed, plan.size()).cost();
    for (const PlannedPage& page : plan) {
        const std::uint64_t cost = Memory::cost(page.bytes());
        needs.pages += cost;
        needs.largest_page = std::max(needs.largest_page, cost);
    }
    needs.page_count = plan.size();
    return needs;
}

Result<void> check(const core::Packed& packed) {
    if (!packed.single())
        return invalid_argument(
            "the grid was packed in double precision, but the vulkan engine takes single precision only");
    if (packed.points() >= limit_32)
        return invalid_argument(fmt::format("the packed grid has {} points, but the vulkan engine can number {}",
                                            packed.points(), limit_32 - 1));
    if (packed.cells.size() >= limit_32)
        return invalid_argument(
            fmt::format("the packed grid has {} words of cells, but the vulkan engine can number {}",
                        packed.cells.size(), limit_32 - 1));
    return {};
}

std::uint64_t wide(std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; }

void add(Timings& sum, Timings&& more) {
    sum.passes.insert(sum.passes.end(), std::make_move_iterator(more.passes.begin()),
                      std::make_move_iterator(more.passes.end()));
    sum.device_seconds += more.device_seconds;
    sum.waited_seconds += more.waited_seconds;
}

} // namespace

GridNeeds GridOnDevice::needs(const core::Packed& packed, std::uint64_t page_bytes) {
    return needs_of(packed, plan_pages(packed, page_bytes));
}

Result<std::unique_ptr<GridOnDevice>> GridOnDevice::upload(std::shared_ptr<Context> context,
                                                           std::shared_ptr<const core::Packed> packed,
                                                           const GridOptions& options, const Progress& progress) {
    if (auto ok = check(*packed); !ok) return ok.error();
    std::vector<PlannedPage> plan = plan_pages(*packed, options.page_bytes);
    const GridNeeds needs = needs_of(*packed, plan);
    const std::uint64_t least = needs.resident + needs.largest_page, free = context->memory().free();
    if (least > free)
        return Error{
            ErrorCode::out_of_memory,
            fmt::format(
                "the packed grid needs {} of device memory at least, but {} are free: {} for all clusters, and its "
                "largest page",
                core::format_bytes(least), core::format_bytes(free), core::format_bytes(needs.resident))};
    std::unique_ptr<GridOnDevice> grid(new GridOnDevice(std::move(context)));
    auto resident = Resident::upload(*grid->context_, *packed, plan);
    if (!resident) return std::move(resident).error();
    grid->resident_ = *std::move(resident);
    grid->cache_.emplace(*grid->context_, std::move(packed), std::move(plan), grid->resident_);
    if (auto ok = grid->cache_->load_all(options.reserve, progress); !ok) return ok.error();
    return grid;
}

Result<void> GridOnDevice::run(Recorder& recorder, WorkDone& done) {
    auto timings = recorder.run();
    if (!timings) return timings.error();
    add(done.timings, *std::move(timings));
    ++done.submissions;
    return {};
}

Result<void> GridOnDevice::run_and_read_heads(Recorder& recorder, std::span<Task> tasks, WorkDone& done) {
    constexpr std::uint64_t size = sizeof(layout::Output);
    if (results_.size() < tasks.size() * size) {
        auto taken = context_->memory().take(tasks.size() * size, Where::download, "heads of surfaces");
        if (!taken) return std::move(taken).error();
        results_ = *std::move(taken);
    }
    for (std::size_t i = 0; i < tasks.size(); ++i) recorder.copy(tasks[i].surface.head, 0, results_, i * size, size);
    if (auto ok = run(recorder, done); !ok) return ok;
    for (std::size_t i = 0; i < tasks.size(); ++i)
        std::memcpy(&tasks[i].surface.result, results_.mapped().data() + i * size, size);
    done.downloaded += tasks.size() * size;
    return {};
}

/// Makes room for what the device has counted. Pages go where surfaces need the memory.
Result<void> GridOnDevice::make_room(SurfaceBuffers& surface) {
    const std::uint64_t vertices = wide(surface.result.vertices_low, surface.result.vertices_high);
    const std::uint64_t triangles = wide(surface.result.triangles_low, surface.result.triangles_high);
    const std::uint64_t most = context_->settings().max_items;
    if (std::max(vertices, triangles) > most)
        return Error{
            ErrorCode::invalid_argument,
            fmt::format("the surface has {} vertices and {} triangles, but the vulkan engine can number {} of each",
                        vertices, triangles, most)};
    if (surface.grow(*context_, vertices, triangles, SurfaceBuffers::Room::spare)) return {};
    for (;;) {
        auto grown = surface.grow(*context_, vertices, triangles, SurfaceBuffers::Room::exact);
        if (grown || grown.error().code != ErrorCode::out_of_memory) return grown;
        if (!surface.parts().fields.empty()) return grown; // fields give way before pages do
        auto released = cache_->release_one();
        if (!released) return released.error();
        if (!*released) return grown;
    }
}

/// After counting: prepares what emitting turned out to need. Returns whether that was anything.
Result<bool> GridOnDevice::prepare_again(const Task& task, Passes& passes) {
    const layout::Output& result = task.surface.result;
    bool again = false;
    if (result.many_edges && !passes.has_emit_many()) {
        many_edges_ = again = true;
        if (auto ok = passes.make_emit_many(*context_); !ok) return ok.error();
    }
    if (!result.overflow) return again;
    if (auto ok = make_room(task.surface); !ok) return ok.error();
    return true;
}

Result<Passes> GridOnDevice::make_passes(const SurfaceParts& parts) {
    auto passes = Passes::make(*context_, resident_, parts);
    if (passes && many_edges_)
        if (auto ok = passes->make_emit_many(*context_); !ok) return ok.error();
    return passes;
}

/// All tasks in one submission; all pages that they need are there. Returns whether all was prepared for all surfaces.
Result<bool> GridOnDevice::extract_together(std::span<Task> tasks, Passes& passes, WorkDone& done) {
    Recorder recorder(*context_);
    for (const Task& task : tasks) {
        passes.begin(recorder, task);
        passes.select(recorder, task);
        passes.count(recorder, task);
        passes.scan(recorder, task);
        passes.emit(recorder, task);
        passes.finish(recorder, task);
    }
    if (auto ok = run_and_read_heads(recorder, tasks, done); !ok) return ok.error();
    bool complete = true;
    for (const Task& task : tasks) {
        auto again = prepare_again(task, passes);
        if (!again) return again.error();
        complete &= !*again;
    }
    return complete;
}

/// Runs a pass over pages that are not all there at once.
Result<void> GridOnDevice::sweep(const Task& task, std::span<const std::uint32_t> pages, const Progress& progress,
                                 WorkDone& done, void (Passes::*pass)(Recorder&, const Task&, std::uint32_t) const,
                                 const Passes& passes) {
    std::vector<std::uint32_t> left(pages.begin(), pages.end());
    while (!left.empty()) {
        auto loaded = cache_->load(left, progress);
        if (!loaded) return loaded.error();
        Recorder recorder(*context_);
        (passes.*pass)(recorder, task, cache_->batch());
        if (auto ok = run(recorder, done); !ok) return ok;
        std::erase_if(left, [&](std::uint32_t page) { return std::ranges::find(*loaded, page) != loaded->end(); });
    }
    return {};
}

Result<void> GridOnDevice::extract_paged(const Task& task, Passes& passes, const Progress& progress, WorkDone& done) {
    const std::vector<std::uint32_t> pages = cache_->hit_by(task.isovalue.value);
    {
        Recorder recorder(*context_);
        passes.begin(recorder, task);
        passes.select(recorder, task);
        if (auto ok = run(recorder, done); !ok) return ok;
    }
    if (auto ok = sweep(task, pages, progress, done, &Passes::count, passes); !ok) return ok;
    Task one[] = {task};
    for (bool prepared = false; !prepared;) {
        Recorder recorder(*context_);
        passes.begin_again(recorder, task);
        passes.scan(recorder, task);
        if (auto ok = run_and_read_heads(recorder, one, done); !ok) return ok;
        auto again = prepare_again(task, passes);
        if (!again) return again.error();
        prepared = !*again;
    }
    if (auto ok = sweep(task, pages, progress, done, &Passes::emit, passes); !ok) return ok;
    Recorder recorder(*context_);
    passes.finish(recorder, task);
    return run_and_read_heads(recorder, one, done);
}

Result<WorkDone> GridOnDevice::extract(std::span<Task> tasks, const Progress& progress) {
    if (torn_)
        return Error{ErrorCode::device_failed,
                     "another field or other points could not be set on the device before, which "
                     "left the grid there incomplete: it must be uploaded again"};
    WorkDone done;
    if (tasks.empty() || resident_.sizes().clusters == 0) return done;
    const std::uint64_t up = context_->staging().uploaded(), loads = cache_->loads();
    auto passes = make_passes(tasks.front().surface.parts());
    if (!passes) return passes.error();

    bool together = true;
    for (bool complete = false; together && !complete;) {
        for (const Task& task : tasks) together = together && cache_->touch(cache_->hit_by(task.isovalue.value));
        if (!together) break;
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "extraction was cancelled"};
        auto all = extract_together(tasks, *passes, done);
        if (!all) return all.error();
        complete = *all;
    }
    if (!together)
        for (const Task& task : tasks)
            if (auto ok = extract_paged(task, *passes, progress, done); !ok) return ok.error();
    done.uploaded = context_->staging().uploaded() - up;
    done.page_loads = cache_->loads() - loads;
    return done;
}

} // namespace isotet::vulkan
