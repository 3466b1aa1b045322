// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What of a packed grid is always on the device, by cluster and by page; about 110 bytes a cluster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/result.hpp>

#include "vulkan/context.hpp"
#include "vulkan/engine/page_plan.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::vulkan {

/// Numbers of things that are laid out by cluster.
struct ResidentSizes {
    std::uint64_t clusters = 0, segments = 0, blocks = 0, pages = 0, mask_words = 0;
    bool with_others = false; ///< some cell is no tet

    ResidentSizes() = default;
    ResidentSizes(const core::Packed& packed, std::size_t page_count);
    std::uint64_t cost() const; ///< bytes of device memory
};

class Resident {
public:
    /// Errors   invalid_argument when a number does not fit into 32 bits; out_of_memory; machine
    static Result<Resident> upload(Context& context, const core::Packed& packed, const std::vector<PlannedPage>& pages);

    const ResidentSizes& sizes() const noexcept { return sizes_; }

    // By cluster, fixed, or replaced with the field.
    Buffer tables;     ///< layout::Tables
    Buffer pages;      ///< layout::Page
    Buffer clusters;   ///< layout::Cluster
    Buffer ranges;     ///< layout::Range
    Buffer no_data;    ///< a bit each
    Buffer cell_cases; ///< layout::cell_cases

    // Written by every extraction.
    Buffer masks;
    Buffer counts; ///< layout::Count of clusters
    Buffer sums;   ///< layout::Count of segments, then of blocks
    Buffer starts;
    Buffer selected;
    Buffer emitted;
    Buffer lists; ///< layout::Lists

    /// Addresses and sizes, and whether any point has no data.
    Result<void> upload_tables(Context& context, const core::Packed& packed);
    /// Ranges and points without data of all clusters, from the packed grid; and tables.
    Result<void> upload_ranges(Context& context, const core::Packed& packed);
    /// The other way round, as the device has worked them out.
    Result<void> download_ranges(Context& context, core::Packed& packed) const;
    Result<void> upload_pages(Context& context, std::span<const layout::Page> entries);

private:
    Result<void> take(Context& context);
    Result<void> upload_clusters(Context& context, const core::Packed& packed, const std::vector<PlannedPage>& plan);

    ResidentSizes sizes_;
};

} // namespace isotet::vulkan
