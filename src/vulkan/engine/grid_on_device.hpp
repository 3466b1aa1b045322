// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed grid on a device, and extraction from it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "packed/packed.hpp"
#include "vulkan/context.hpp"
#include "vulkan/engine/carried_fields.hpp"
#include "vulkan/engine/page_cache.hpp"
#include "vulkan/engine/passes.hpp"
#include "vulkan/engine/resident.hpp"
#include "vulkan/engine/surface_buffers.hpp"

namespace isotet::vulkan {

struct GridOptions {
    std::uint64_t page_bytes = std::uint64_t{32} << 20;
    std::uint64_t reserve = 0; ///< device memory that uploading leaves free for surfaces
};

/// Device memory that a grid takes.
struct GridNeeds {
    std::uint64_t resident = 0;     ///< always there
    std::uint64_t pages = 0;        ///< all of them; fewer will do
    std::uint64_t largest_page = 0; ///< `resident` and this is the least
    std::size_t page_count = 0;
};

/// What one call cost.
struct WorkDone {
    Timings timings;
    std::uint64_t uploaded = 0, downloaded = 0; ///< bytes over the bus
    std::uint64_t page_loads = 0;
    std::uint32_t submissions = 0;
};

/// Threads   one call at a time
class GridOnDevice {
public:
    static GridNeeds needs(const core::Packed& packed, std::uint64_t page_bytes);

    /// Errors     invalid_argument for a double packing, or one with more points or tets than fit into 32 bits;
    ///            out_of_memory, before anything is uploaded, when resident arrays and a page do not fit; machine;
    ///            cancelled
    static Result<std::unique_ptr<GridOnDevice>> upload(std::shared_ptr<Context> context,
                                                        std::shared_ptr<const core::Packed> packed,
                                                        const GridOptions& options, const Progress& progress);

    /// Extracts one surface for every task; all have the same parts, and were prepared.
    ///
    /// Errors   invalid_argument when a surface has 2^32 vertices or triangles or more; machine, also when set_field()
    ///          or set_points() failed before; out_of_memory; cancelled
    Result<WorkDone> extract(std::span<Task> tasks, const Progress& progress);

    /// Replaces the field: uploads values, works out ranges on the device, and brings these into `packed`.
    ///
    /// `packed`   a copy of packed() after core::store_values(), and store_gradients() where there are gradients
    /// Errors     out_of_memory; machine; cancelled. Nothing can be extracted from the grid on the device then
    Result<WorkDone> set_field(std::shared_ptr<core::Packed> packed, const Progress& progress);

    /// Replaces the points: uploads positions and gradients of the pages that are there.
    ///
    /// `packed`   a copy of packed() with other points
    /// Errors     as above
    Result<WorkDone> set_points(std::shared_ptr<const core::Packed> packed, const Progress& progress);

    /// Point fields that surfaces carry, by packed point.
    CarriedFields& fields() noexcept { return fields_; }

    Context& context() const noexcept { return *context_; }
    const std::shared_ptr<Context>& shared_context() const noexcept { return context_; }
    std::uint64_t device_bytes() const { return resident_.sizes().cost() + cache_->loaded_bytes(); }
    bool complete() const { return cache_->complete(); }
    const std::shared_ptr<const core::Packed>& packed() const noexcept { return cache_->packed(); }
    const PageCache& pages() const noexcept { return *cache_; }
    const Resident& resident() const noexcept { return resident_; }

private:
    explicit GridOnDevice(std::shared_ptr<Context> context) : context_(std::move(context)) {}

    Result<Passes> make_passes(const SurfaceParts& parts);
    Result<bool> extract_together(std::span<Task> tasks, Passes& passes, WorkDone& done);
    Result<void> extract_paged(const Task& task, Passes& passes, const Progress& progress, WorkDone& done);
    Result<void> sweep(const Task& task, std::span<const std::uint32_t> pages, const Progress& progress, WorkDone& done,
                       void (Passes::*pass)(Recorder&, const Task&, std::uint32_t) const, const Passes& passes);
    Result<void> find_ranges(core::Packed& packed, WorkDone& done);
    Result<void> run(Recorder& recorder, WorkDone& done);
    Result<void> run_and_read_heads(Recorder& recorder, std::span<Task> tasks, WorkDone& done);
    Result<bool> prepare_again(const Task& task, Passes& passes);
    Result<void> make_room(SurfaceBuffers& surface);

    std::shared_ptr<Context> context_;
    Resident resident_;
    std::optional<PageCache> cache_;
    CarriedFields fields_;
    Buffer results_;          ///< heads of surfaces, on their way to the processor
    bool torn_ = false;       ///< setting a field or points ended half-way
    bool many_edges_ = false; ///< some cluster had many active edges once
};

} // namespace isotet::vulkan
