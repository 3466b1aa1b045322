// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All cells of a grid that will be stored, in buckets by their lowest rank. One pass over the user's cells deals them
// out, before it is known how many each bucket gets: they lie in pages, and pages are added where they are wanted.
//
//   writer 0 ─┬─ bucket 0: ▓▓▓▓▓▓▓▓ ▓▓▓▓▓░░░     a writer deals out what some cells give, in order, into
//             └─ bucket 1: ▓▓▓░░░░░              pages of its own: so a bucket can be read in the order of
//                                                the cells
//   writer 1 ─┬─ bucket 0: ▓▓▓▓▓░░░
//             └─ bucket 1: ▓▓▓▓▓▓▓▓ ▓▓░░░░░░
//
// A bucket fits into a processor's cache, where it is sorted; it is written back into its first pages. When all are,
// they are numbered through, bucket by bucket.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/buffer.hpp"
#include "base/prefetch.hpp"
#include "packed/build/ranked_cell.hpp"

namespace isotet::core {

/// `Item`   RankedTet or RankedCell
template <class Item>
class RankedBuckets {
    using Pages = std::vector<std::uint32_t>;

public:
    RankedBuckets() = default;

    /// `ranks`     every rank is below
    /// `items`     how many will be dealt out, or more
    /// `origins`   whether origins are kept, too
    RankedBuckets(std::size_t ranks, std::uint64_t items, std::size_t writers, bool origins);

    std::size_t buckets() const { return buckets_.size(); }
    std::size_t ranks_per_bucket() const { return std::size_t{1} << shift_; }
    bool has_origins() const { return !origins_.empty(); }

    /// Deals out; for one thread at a time.
    class Writer {
    public:
        Writer(RankedBuckets& all, std::size_t writer)
            : all_(all),
              next_(all.next_.data() + writer * all.buckets()),
              pages_(all.stream_pages_.data() + writer * all.buckets()) {}

        /// `lowest`   of its ranks
        void put(const Item& item, std::uint32_t lowest, CellOrigin origin) {
            const std::size_t bucket = lowest >> all_.shift_;
            std::size_t next = next_[bucket];
            if (next % all_.page_size() == 0) next = all_.add_page(pages_[bucket]);
            constexpr std::size_t line = 64 / sizeof(Item);
            prefetch(all_.items_.data() + next + line); // there by the time this line is full
            all_.items_[next] = item;
            if (all_.has_origins()) all_.origins_[next] = origin;
            next_[bucket] = next + 1;
        }

    private:
        RankedBuckets& all_;
        std::size_t* next_;
        Pages* pages_;
    };

    /// Calls f(item, origin) for what was dealt out to a bucket: by writer, then in the order in which it was put there.
    template <class F>
    void for_dealt(std::size_t bucket, const F& f) const {
        for (std::size_t at = bucket; at < next_.size(); at += buckets()) {
            const Pages& pages = stream_pages_[at];
            for (std::size_t p = 0; p < pages.size(); ++p) {
                const bool last = p + 1 == pages.size();
                const std::size_t begin = pages[p] * page_size();
                const std::size_t end = last ? next_[at] : begin + page_size();
                const Item* const soon = items_.data() + (last ? begin : pages[p + 1] * page_size());
                for (std::size_t i = begin; i < end; ++i) {
                    prefetch(soon + (i - begin));
                    f(items_[i], has_origins() ? origins_[i] : CellOrigin{});
                }
            }
        }
    }
    std::size_t dealt(std::size_t bucket) const;

    /// Writes sorted items back, not more than were dealt out to the bucket. Buckets at the same time.
    void write_sorted(std::size_t bucket, std::span<const Item> items, std::span<const CellOrigin> origins);

    /// Numbers the sorted items through.
    void number();

    std::uint64_t size() const { return size_; }
    Item& sorted(std::size_t bucket, std::size_t i) {
        return items_[buckets_[bucket].pages[i / page_size()] * page_size() + i % page_size()];
    }
    void copy_items(std::uint64_t first, std::span<Item> out) const {
        for_pieces(first, out.size(), [&](std::size_t position, std::size_t at, std::size_t count) {
            std::copy_n(items_.data() + position, count, out.data() + at);
        });
    }
    void copy_origins(std::uint64_t first, std::span<CellOrigin> out) const {
        for_pieces(first, out.size(), [&](std::size_t position, std::size_t at, std::size_t count) {
            std::copy_n(origins_.data() + position, count, out.data() + at);
        });
    }
    /// Puts origins into another order, say.
    void replace_origins(std::uint64_t first, std::span<const CellOrigin> origins) {
        for_pieces(first, origins.size(), [&](std::size_t position, std::size_t at, std::size_t count) {
            std::copy_n(origins.data() + at, count, origins_.data() + position);
        });
    }
    void drop_items() { items_.release(); }
    void drop_origins() { origins_.release(); }

private:
    struct Bucket {
        std::uint64_t first = 0; ///< number of its first item
        std::size_t size = 0;
        Pages pages;
    };

    std::size_t page_size() const { return std::size_t{1} << page_bits_; }
    /// Returns where it begins.
    std::size_t add_page(Pages& pages);

    /// Calls f(position, at, count) for the items [first, first + size), wherever they lie: `at` counts from 0.
    template <class F>
    void for_pieces(std::uint64_t first, std::size_t size, const F& f) const {
        auto bucket = std::upper_bound(buckets_.begin(), buckets_.end(), first,
                                       [](std::uint64_t number, const Bucket& b) { return number < b.first; }) -
                      1;
        for (std::size_t at = 0; at < size;) {
            const std::size_t inside = static_cast<std::size_t>(first + at - bucket->first);
            if (inside == bucket->size) {
                ++bucket;
                continue;
            }
            const std::size_t in_page = inside % page_size();
            const std::size_t count = std::min({page_size() - in_page, bucket->size - inside, size - at});
            f(bucket->pages[inside / page_size()] * page_size() + in_page, at, count);
            at += count;
        }
    }

    unsigned shift_ = 0;        ///< from a rank to its bucket
    unsigned page_bits_ = 0;    ///< a page has 2^page_bits_ items
    Buffer<Item> items_;    ///< page by page
    Buffer<CellOrigin> origins_; ///< beside them, or empty
    std::size_t pages_ = 0;     ///< taken so far, by all writers
    // Streams, by writer, then bucket. What every item needs stands close together, in a processor's first cache. Where
    // a stream's next position is the beginning of a page, that page is still to be added.
    std::vector<std::size_t> next_;
    std::vector<Pages> stream_pages_;
    std::vector<Bucket> buckets_;
    std::uint64_t size_ = 0;
};

extern template class RankedBuckets<RankedTet>;
extern template class RankedBuckets<RankedCell>;

} // namespace isotet::core
