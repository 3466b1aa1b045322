// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/tet_buckets.hpp"

#include <atomic>
#include <bit>

namespace isotet::core {

namespace {

constexpr unsigned least_shift = 12;       ///< 4,096 ranks: some 25,000 tets, 400 kB
constexpr std::size_t most_buckets = 2048; ///< a writer has a line of each in its second cache

} // namespace

TetBuckets::TetBuckets(std::size_t ranks, std::uint64_t tets, std::size_t writers, bool origins) {
    shift_ = std::max(least_shift, static_cast<unsigned>(std::bit_width(ranks / most_buckets)));
    buckets_.resize((ranks >> shift_) + 1);
    streams_.resize(writers * buckets());
    // Half of the last page of each stream stays empty: a twenty-fourth of the memory, or a sixth for very many writers.
    page_size_ = std::clamp<std::size_t>(std::bit_floor(2048 / writers), 16, 256);
    const std::size_t room = (tets / page_size_ + std::min<std::size_t>(streams_.size(), tets)) * page_size_;
    tets_ = Buffer<RankedTet>(room);
    if (origins) origins_ = Buffer<TetOrigin>(room);
}

void TetBuckets::add_page(Stream& stream) {
    const std::size_t page = std::atomic_ref(pages_).fetch_add(1, std::memory_order_relaxed);
    stream.pages.push_back(static_cast<std::uint32_t>(page));
    stream.next = page * page_size_;
    stream.page_end = stream.next + page_size_;
}

std::size_t TetBuckets::dealt(std::size_t bucket) const {
    std::size_t count = 0;
    for (std::size_t at = bucket; at < streams_.size(); at += buckets())
        count += streams_[at].pages.size() * page_size_ - (streams_[at].page_end - streams_[at].next);
    return count;
}

void TetBuckets::write_sorted(std::size_t bucket, std::span<const RankedTet> tets, std::span<const TetOrigin> origins) {
    Bucket& sorted = buckets_[bucket];
    sorted.size = tets.size();
    for (std::size_t at = bucket; at < streams_.size(); at += buckets()) {
        sorted.pages.insert(sorted.pages.end(), streams_[at].pages.begin(), streams_[at].pages.end());
        streams_[at] = {};
    }
    for (std::size_t begin = 0, page = 0; begin < tets.size(); begin += page_size_, ++page) {
        const std::size_t count = std::min(page_size_, tets.size() - begin), to = sorted.pages[page] * page_size_;
        std::copy_n(tets.data() + begin, count, tets_.data() + to);
        if (has_origins()) std::copy_n(origins.data() + begin, count, origins_.data() + to);
    }
}

void TetBuckets::number() {
    size_ = 0;
    for (Bucket& bucket : buckets_) {
        bucket.first = size_;
        size_ += bucket.size;
    }
}

} // namespace isotet::core
