// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All tets of a grid, in buckets by their lowest rank. One pass over the cells deals them out, although nobody knows
// then how many each bucket gets: tets lie in pages, and pages are added where they are wanted.
//
//   writer 0 ─┬─ bucket 0: ▓▓▓▓▓▓▓▓ ▓▓▓▓▓░░░     a writer deals out the tets of some cells, in order, into
//             └─ bucket 1: ▓▓▓░░░░░              pages of its own: so a bucket can be read in the order of
//                                                the cells
//   writer 1 ─┬─ bucket 0: ▓▓▓▓▓░░░
//             └─ bucket 1: ▓▓▓▓▓▓▓▓ ▓▓░░░░░░
//
// A bucket fits into a processor's cache, where it is sorted; it is written back into its first pages. When all are,
// the tets are numbered through, bucket by bucket.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/buffer.hpp"
#include "core/prefetch.hpp"
#include "core/ranked_tet.hpp"

namespace isotet::core {

class TetBuckets {
    using Pages = std::vector<std::uint32_t>;

public:
    TetBuckets() = default;

    /// `ranks`     every rank is below
    /// `tets`      how many will be dealt out, or more
    /// `origins`   whether origins are kept, too
    TetBuckets(std::size_t ranks, std::uint64_t tets, std::size_t writers, bool origins);

    std::size_t buckets() const { return buckets_.size(); }
    std::size_t ranks_per_bucket() const { return std::size_t{1} << shift_; }
    bool has_origins() const { return !origins_.empty(); }

    /// Deals out tets; for one thread at a time.
    class Writer {
    public:
        Writer(TetBuckets& all, std::size_t writer)
            : all_(all),
              next_(all.next_.data() + writer * all.buckets()),
              pages_(all.stream_pages_.data() + writer * all.buckets()) {}

        /// `lowest`   of the tet's ranks
        void put(const RankedTet& tet, std::uint32_t lowest, TetOrigin origin) {
            const std::size_t bucket = lowest >> all_.shift_;
            std::size_t next = next_[bucket];
            if (next % all_.page_size() == 0) next = all_.add_page(pages_[bucket]);
            constexpr std::size_t line = 64 / sizeof(RankedTet);
            prefetch(all_.tets_.data() + next + line); // there by the time this line is full
            all_.tets_[next] = tet;
            if (all_.has_origins()) all_.origins_[next] = origin;
            next_[bucket] = next + 1;
        }

    private:
        TetBuckets& all_;
        std::size_t* next_;
        Pages* pages_;
    };

    /// Calls f(tet, origin) for what was dealt out to a bucket: by writer, then in the order in which it was put there.
    template <class F>
    void for_dealt(std::size_t bucket, const F& f) const {
        for (std::size_t at = bucket; at < next_.size(); at += buckets()) {
            const Pages& pages = stream_pages_[at];
            for (std::size_t p = 0; p < pages.size(); ++p) {
                const bool last = p + 1 == pages.size();
                const std::size_t begin = pages[p] * page_size();
                const std::size_t end = last ? next_[at] : begin + page_size();
                const RankedTet* const soon = tets_.data() + (last ? begin : pages[p + 1] * page_size());
                for (std::size_t i = begin; i < end; ++i) {
                    prefetch(soon + (i - begin));
                    f(tets_[i], has_origins() ? origins_[i] : TetOrigin{});
                }
            }
        }
    }
    std::size_t dealt(std::size_t bucket) const;

    /// Writes sorted tets back, not more than were dealt out to the bucket. Buckets at the same time.
    void write_sorted(std::size_t bucket, std::span<const RankedTet> tets, std::span<const TetOrigin> origins);

    /// Numbers the sorted tets through.
    void number();

    std::uint64_t size() const { return size_; }
    RankedTet& sorted(std::size_t bucket, std::size_t i) {
        return tets_[buckets_[bucket].pages[i / page_size()] * page_size() + i % page_size()];
    }
    void copy_tets(std::uint64_t first, std::span<RankedTet> out) const {
        for_pieces(first, out.size(), [&](std::size_t position, std::size_t at, std::size_t count) {
            std::copy_n(tets_.data() + position, count, out.data() + at);
        });
    }
    void copy_origins(std::uint64_t first, std::span<TetOrigin> out) const {
        for_pieces(first, out.size(), [&](std::size_t position, std::size_t at, std::size_t count) {
            std::copy_n(origins_.data() + position, count, out.data() + at);
        });
    }
    /// Puts origins into another order, say.
    void replace_origins(std::uint64_t first, std::span<const TetOrigin> origins) {
        for_pieces(first, origins.size(), [&](std::size_t position, std::size_t at, std::size_t count) {
            std::copy_n(origins.data() + at, count, origins_.data() + position);
        });
    }
    void drop_tets() { tets_.release(); }
    void drop_origins() { origins_.release(); }

private:
    struct Bucket {
        std::uint64_t first = 0; ///< number of its first tet
        std::size_t size = 0;
        Pages pages;
    };

    std::size_t page_size() const { return std::size_t{1} << page_bits_; }
    /// Returns where it begins.
    std::size_t add_page(Pages& pages);

    /// Calls f(position, at, count) for the tets [first, first + size), wherever they lie: `at` counts from 0.
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
    unsigned page_bits_ = 0;    ///< a page has 2^page_bits_ tets
    Buffer<RankedTet> tets_;    ///< page by page
    Buffer<TetOrigin> origins_; ///< beside them, or empty
    std::size_t pages_ = 0;     ///< taken so far, by all writers
    // Streams, by writer, then bucket. What every tet needs stands close together, in a processor's first cache. Where
    // a stream's next position is the beginning of a page, that page is still to be added.
    std::vector<std::size_t> next_;
    std::vector<Pages> stream_pages_;
    std::vector<Bucket> buckets_;
    std::uint64_t size_ = 0;
};

} // namespace isotet::core
