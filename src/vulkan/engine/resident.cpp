// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/resident.hpp"

#include <array>
#include <limits>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "vulkan/engine/address.hpp"

namespace isotet::vulkan {

namespace {

std::uint64_t pieces(std::uint64_t n, std::uint64_t size) { return (n + size - 1) / size; }

/// A resident array: where it is kept, and how large it is.
struct KeptArray {
    Buffer Resident::* buffer;
    const char* name;
    std::uint64_t bytes;
};

std::array<KeptArray, 13> arrays(const ResidentSizes& sizes) {
    const std::uint64_t c = sizes.clusters;
    return {{{&Resident::tables, "tables", sizeof(layout::Tables)},
             {&Resident::pages, "page table", sizes.pages * sizeof(layout::Page)},
             {&Resident::clusters, "clusters", c * sizeof(layout::Cluster)},
             {&Resident::ranges, "ranges", c * sizeof(layout::Range)},
             {&Resident::no_data, "clusters without data", 4 * pieces(c, 32)},
             {&Resident::cell_cases, "cases of cells", sizeof layout::cell_cases},
             {&Resident::masks, "masks", 4 * sizes.mask_words},
             {&Resident::counts, "counts", c * sizeof(layout::Count)},
             {&Resident::sums, "sums of counts", (sizes.segments + sizes.blocks) * sizeof(layout::Count)},
             {&Resident::starts, "starts", c * sizeof(layout::Start)},
             {&Resident::selected, "selected clusters", 4 * c},
             {&Resident::emitted, "clusters to emit", 4 * c},
             {&Resident::lists, "lists of clusters", sizeof(layout::Lists)}}};
}

template <class T>
std::span<const std::byte> bytes_of(const T& array) {
    return std::as_bytes(std::span(array.data(), array.size()));
}

} // namespace

ResidentSizes::ResidentSizes(const core::Packed& packed, std::size_t page_count)
    : clusters(packed.clusters()),
      segments(pieces(clusters, layout::segment_clusters)),
      blocks(pieces(segments, layout::block_segments)),
      pages(page_count) {
    for (const core::ClusterHeader& h : packed.headers) {
        mask_words += mask_words_of(h);
        with_others |= h.others() != 0;
    }
}

std::uint64_t ResidentSizes::cost() const {
    std::uint64_t sum = 0;
    for (const KeptArray& array : arrays(*this)) sum += Memory::cost(array.bytes);
    return sum;
}

Result<void> Resident::take(Context& context) {
    for (const KeptArray& array : arrays(sizes_)) {
        auto buffer = context.memory().take(array.bytes, Where::device, array.name);
        if (!buffer) return std::move(buffer).error();
        this->*array.buffer = *std::move(buffer);
    }
    return {};
}

Result<void> Resident::upload_clusters(Context& context, const core::Packed& packed,
                                       const std::vector<PlannedPage>& plan) {
    std::vector<layout::Cluster> records(packed.clusters());
    core::parallel_each(plan.size(), 1, [&](std::size_t i) {
        place_clusters(packed, plan[i], static_cast<std::uint32_t>(i), records.data() + plan[i].first_cluster);
    });
    number_masks(packed, records.data());
    return context.staging().upload(clusters, 0, bytes_of(records));
}

Result<void> Resident::upload_tables(Context& context, const core::Packed& packed) {
    layout::Tables t{};
    t.pages = address_of(pages);
    t.clusters = address_of(clusters);
    t.ranges = address_of(ranges);
    t.no_data = address_of(no_data);
    t.masks = address_of(masks);
    t.counts = address_of(counts);
    t.segments = address_of(sums);
    t.blocks = address_of(sums, sizes_.segments * sizeof(layout::Count));
    t.starts = address_of(starts);
    t.selected = address_of(selected);
    t.emitted = address_of(emitted);
    t.lists = address_of(lists);
    t.cell_cases = address_of(cell_cases);
    t.cluster_count = static_cast<std::uint32_t>(sizes_.clusters);
    t.groups_per_axis = context.groups_per_axis();
    t.any_no_data = packed.field_report.no_data > 0;
    return context.staging().upload(tables, 0, std::as_bytes(std::span(&t, 1)));
}

Result<void> Resident::upload_ranges(Context& context, const core::Packed& packed) {
    std::vector<std::uint32_t> bits(pieces(packed.clusters(), 32));
    for (std::size_t c = 0; c < packed.clusters(); ++c) bits[c / 32] |= std::uint32_t{packed.has_no_data[c]} << c % 32;
    if (auto ok = context.staging().upload(no_data, 0, bytes_of(bits)); !ok) return ok;
    static_assert(sizeof(core::Range<float>) == sizeof(layout::Range));
    if (auto ok = context.staging().upload(ranges, 0, bytes_of(packed.as<float>().ranges)); !ok) return ok;
    return upload_tables(context, packed);
}

Result<void> Resident::download_ranges(Context& context, core::Packed& packed) const {
    core::SharedBuffer<core::Range<float>>& to = packed.as<float>().ranges;
    if (auto ok = context.staging().download(ranges, 0, std::as_writable_bytes(std::span(to.data(), to.size()))); !ok)
        return ok;
    std::vector<std::uint32_t> bits(pieces(packed.clusters(), 32));
    if (auto ok = context.staging().download(no_data, 0, std::as_writable_bytes(std::span(bits))); !ok) return ok;
    for (std::size_t c = 0; c < packed.clusters(); ++c) packed.has_no_data[c] = bits[c / 32] >> c % 32 & 1;
    return {};
}

Result<void> Resident::upload_pages(Context& context, std::span<const layout::Page> entries) {
    return context.staging().upload(pages, 0, std::as_bytes(entries));
}

Result<Resident> Resident::upload(Context& context, const core::Packed& packed, const std::vector<PlannedPage>& plan) {
    Resident resident;
    resident.sizes_ = ResidentSizes(packed, plan.size());
    // Kernels take the numbers of words and clusters as signed.
    constexpr std::uint64_t limit = std::numeric_limits<std::int32_t>::max();
    if (resident.sizes_.mask_words > limit)
        return Error{
            ErrorCode::invalid_argument,
            fmt::format(
                "the packed grid has {} clusters with masks of {} words, but the vulkan engine can number {} words",
                resident.sizes_.clusters, resident.sizes_.mask_words, limit)};
    if (auto ok = resident.take(context); !ok) return ok.error();
    if (auto ok = resident.upload_clusters(context, packed, plan); !ok) return ok.error();
    if (auto ok = context.staging().upload(resident.cell_cases, 0, bytes_of(layout::cell_cases)); !ok)
        return ok.error();
    if (auto ok = resident.upload_ranges(context, packed); !ok) return ok.error();
    return resident;
}

} // namespace isotet::vulkan
