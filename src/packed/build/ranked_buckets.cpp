// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/build/ranked_buckets.hpp"

#include <atomic>
#include <bit>

namespace isotet::core {

namespace {

constexpr unsigned least_shift = 12;      ///< 4,096 ranks: some 25,000 tets, 400 kB
constexpr std::size_t max_buckets = 2048; ///< a writer has a line of each in its second cache

} // namespace

template <class Item>
RankedBuckets<Item>::RankedBuckets(std::size_t ranks, std::uint64_t items, std::size_t writers, bool origins) {
    shift_ = std::max(least_shift, static_cast<unsigned>(std::bit_width(ranks / max_buckets)));
    buckets_.resize((ranks >> shift_) + 1);
    next_.resize(writers * buckets());
    stream_pages_.resize(next_.size());
    // Half of the last page of each stream stays empty: a twenty-fourth of the memory, or a sixth for very many
    // writers.
    page_bits_ = static_cast<unsigned>(std::bit_width(std::clamp<std::size_t>(2048 / writers, 16, 256)) - 1);
    const std::size_t room = (items / page_size() + std::min<std::size_t>(next_.size(), items)) * page_size();
    items_ = Buffer<Item>(room);
    if (origins) origins_ = Buffer<CellOrigin>(room);
}

template <class Item>
std::size_t RankedBuckets<Item>::add_page(Pages& pages) {
    const std::size_t page = std::atomic_ref(pages_).fetch_add(1, std::memory_order_relaxed);
    pages.push_back(static_cast<std::uint32_t>(page));
    return page * page_size();
}

template <class Item>
std::size_t RankedBuckets<Item>::dealt(std::size_t bucket) const {
    std::size_t count = 0;
    for (std::size_t at = bucket; at < next_.size(); at += buckets())
        if (const Pages& pages = stream_pages_[at]; !pages.empty())
            count += (pages.size() - 1) * page_size() + (next_[at] - pages.back() * page_size());
    return count;
}

template <class Item>
void RankedBuckets<Item>::write_sorted(std::size_t bucket, std::span<const Item> items, std::span<const CellOrigin> origins) {
    Bucket& sorted = buckets_[bucket];
    sorted.size = items.size();
    for (std::size_t at = bucket; at < next_.size(); at += buckets()) {
        Pages& pages = stream_pages_[at];
        sorted.pages.insert(sorted.pages.end(), pages.begin(), pages.end());
        pages = {};
    }
    for (std::size_t begin = 0, page = 0; begin < items.size(); begin += page_size(), ++page) {
        const std::size_t count = std::min(page_size(), items.size() - begin), to = sorted.pages[page] * page_size();
        std::copy_n(items.data() + begin, count, items_.data() + to);
        if (has_origins()) std::copy_n(origins.data() + begin, count, origins_.data() + to);
    }
}

template <class Item>
void RankedBuckets<Item>::number() {
    size_ = 0;
    for (Bucket& bucket : buckets_) {
        bucket.first = size_;
        size_ += bucket.size;
    }
}

template class RankedBuckets<RankedTet>;
template class RankedBuckets<RankedCell>;

} // namespace isotet::core
