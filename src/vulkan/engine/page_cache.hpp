// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which pages of a packed grid are on the device. All of them where there is room; else the least recently used one
// goes when another is wanted.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "packed/packed.hpp"
#include "vulkan/context.hpp"
#include "vulkan/engine/page_plan.hpp"
#include "vulkan/engine/resident.hpp"

namespace isotet::vulkan {

class PageCache {
public:
    /// `resident` is borrowed; nothing is loaded yet.
    PageCache(Context& context, std::shared_ptr<const core::Packed> packed, std::vector<PlannedPage> plan,
              Resident& resident);

    const std::shared_ptr<const core::Packed>& packed() const noexcept { return packed_; }
    /// The same cells with another field or other points: pages that are loaded from now on are filled from these.
    void set_packed(std::shared_ptr<const core::Packed> packed) { packed_ = std::move(packed); }

    const std::vector<PlannedPage>& plan() const noexcept { return plan_; }
    bool is_loaded(std::uint32_t page) const noexcept { return static_cast<bool>(pages_[page].buffer); }
    const Buffer& buffer(std::uint32_t page) const noexcept { return pages_[page].buffer; }
    const layout::Page& entry(std::uint32_t page) const noexcept { return entries_[page]; }
    std::uint64_t loaded_bytes() const;
    bool complete() const; ///< all are there
    std::uint64_t loads() const noexcept { return loads_; } ///< so far

    /// Pages whose range of values holds a stored isovalue, ascending.
    std::vector<std::uint32_t> hit_by(float isovalue) const;

    /// Whether all these pages are there; they count as used now.
    bool touch(std::span<const std::uint32_t> pages);

    /// Loads pages, one at least, until all are there or only `reserve` bytes of the device's memory are free.
    Result<void> load_all(std::uint64_t reserve, const Progress& progress);

    /// Has as many of the `wanted` pages on the device together as fit, and gives them, in Page::batch, a number of
    /// their own (batch()); those that are there already first. Pages that are not wanted make room.
    ///
    /// Returns  the pages that are there: some, unless none is wanted; the caller asks again for the others
    /// Errors   out_of_memory when there is not room for a single one; machine; cancelled
    Result<std::vector<std::uint32_t>> load(std::span<const std::uint32_t> wanted, const Progress& progress);
    std::uint32_t batch() const noexcept { return batch_; }

    /// Takes the least recently used page off the device; false when none is there.
    Result<bool> release_one();

    /// Tells the device which pages are there, and where.
    Result<void> upload_table();

    /// After set_packed(): replaces parts of the pages that are there.
    Result<void> upload_values(const Progress& progress);
    Result<void> upload_gradients(const Progress& progress);
    Result<void> upload_positions(const Progress& progress);

    /// Brings the ranges of groups, as the device has worked them out, into the packed grid.
    Result<void> download_group_ranges(core::Packed& packed) const;

    /// Which pages an isovalue hits, after set_packed() with other ranges.
    void find_ranges();

private:
    struct Loaded {
        Buffer buffer;
        std::uint64_t last_use = 0;
    };

    Result<void> load_page(std::uint32_t page);
    Result<void> upload_points(const void* from, std::size_t components, std::uint32_t layout::Page::*place,
                               const Progress& progress);
    Result<void> fit_page(std::uint32_t page, std::uint64_t keep_since);
    std::uint32_t oldest(std::uint64_t before) const;
    void release(std::uint32_t page);

    Context& context_;
    std::shared_ptr<const core::Packed> packed_;
    Resident& resident_;
    std::vector<PlannedPage> plan_;
    std::vector<Loaded> pages_;
    std::vector<layout::Page> entries_;
    std::vector<core::Range<float>> ranges_;
    std::uint64_t use_ = 0, loads_ = 0;
    std::uint32_t batch_ = 0;
};

} // namespace isotet::vulkan
