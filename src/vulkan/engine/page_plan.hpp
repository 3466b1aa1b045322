// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cutting a packed grid into pages: whole clusters, and a halo of the points that these borrow from other pages, so
// that a page can be worked on without any other. kernels/shared/layout.h draws one.
#pragma once

#include <cstdint>
#include <vector>

#include "base/buffer.hpp"
#include "packed/packed.hpp"
#include "vulkan/engine/layout.hpp"

namespace isotet::vulkan {

struct PlannedPage {
    std::uint32_t first_cluster = 0, clusters = 0;
    std::uint64_t first_word = 0; ///< of the packed grid's cells
    std::uint64_t first_link = 0; ///< of the packed grid
    std::uint32_t link_words = 0; ///< of the packed grid; on the device there is one more a neighbour
    std::uint32_t neighbours = 0;
    std::uint32_t cell_words = 0, groups = 0;
    core::Buffer<std::uint32_t> halo; ///< packed points, ascending
    layout::Page layout{};            ///< all but `data` and `batch`
    std::uint32_t words = 0;          ///< all of it

    std::uint64_t bytes() const { return std::uint64_t{4} * words; }
    std::uint32_t end_cluster() const { return first_cluster + clusters; }
    std::uint32_t points() const { return layout.own_points + static_cast<std::uint32_t>(halo.size()); }
};

/// Words of a page are numbered by 32 bits, and by signed ones in kernels.
constexpr std::uint64_t max_page_bytes = std::uint64_t{1} << 30;

/// Pages of about `page_bytes`, max_page_bytes at most, each of one cluster at least, halos beside.
///
/// `packed`     single precision, fewer than 2^32 points
/// Cost         O(C + ghost points); parallel
std::vector<PlannedPage> plan_pages(const core::Packed& packed, std::uint64_t page_bytes);

/// Where the clusters of a page lie in it and what they have; `first_mask` is left to the caller.
/// `out`   page.clusters
void place_clusters(const core::Packed& packed, const PlannedPage& page, std::uint32_t page_number,
                    layout::Cluster* out);

/// Words of a cluster's masks.
std::uint64_t mask_words_of(const core::ClusterHeader& header);

/// `first_mask` of all clusters of the grid.
void number_masks(const core::Packed& packed, layout::Cluster* clusters);

/// What the device holds of a page, as it stands there. Parallel.
/// `clusters`  of this page, from place_clusters()
/// `out`       page.words words
void fill_page(const core::Packed& packed, const PlannedPage& page, const layout::Cluster* clusters,
               std::uint32_t* out);

/// An array of all points as a page has it: those of its own points, then those of its halo.
/// `from`   `components` words for each packed point
/// `out`    as many for each of page.points()
void fill_points(const std::uint32_t* from, std::size_t components, const PlannedPage& page, std::uint32_t* out);

} // namespace isotet::vulkan
