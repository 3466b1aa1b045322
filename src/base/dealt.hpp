// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Items dealt into buckets: two passes over what makes them, one that counts and one that writes, so that every bucket
// is one range of memory in the order of the sources.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::core {

template <class Item>
class Dealt {
public:
    std::size_t buckets() const { return first_.size() - 1; }
    std::span<Item> bucket(std::size_t b) { return {items_.data() + first_[b], first_[b + 1] - first_[b]}; }

    /// What a source gives its items to.
    ///
    /// `writes`   whether this is the pass that makes items
    template <bool writes_items>
    class Dealer {
    public:
        static constexpr bool writes = writes_items;

        Dealer(Item* items, std::uint64_t* next) : items_(items), next_(next) {}

        /// Deals what `make()` returns.
        template <class Make>
        void put(std::size_t bucket, const Make& make) {
            if constexpr (writes) items_[next_[bucket]] = make();
            ++next_[bucket];
        }
        /// To both buckets, once where they are the same.
        template <class Make>
        void put(std::size_t a, std::size_t b, const Make& make) {
            if constexpr (writes) {
                const Item item = make();
                items_[next_[a]] = item;
                if (a != b) items_[next_[b]] = item;
            }
            ++next_[a];
            next_[b] += a != b;
        }

    private:
        Item* items_;
        std::uint64_t* next_; ///< how many so far, or where the next one goes
    };

    /// Calls source(chunk, dealer) twice for each chunk, in parallel. All buckets are empty when cancelled.
    ///
    /// `source`     must give the same items to the same buckets in both passes
    /// Guarantees   a bucket has its items by chunk, then as they were dealt
    /// Cost         8 bytes a chunk and bucket
    template <class Source>
    static Dealt deal(std::size_t chunks, std::size_t buckets, const Source& source, const Progress& progress) {
        std::vector<std::uint64_t> next(chunks * buckets, 0);
        std::atomic<bool> complete{true};
        const auto pass = [&](auto dealer_of) {
            parallel_each(chunks, 1, [&](std::size_t chunk) {
                if (progress.cancelled()) complete = false;
                if (!complete) return;
                auto dealer = dealer_of(chunk);
                source(chunk, dealer);
            });
        };
        pass([&](std::size_t chunk) { return Dealer<false>(nullptr, next.data() + chunk * buckets); });
        Dealt dealt;
        dealt.first_.resize(buckets + 1, 0);
        if (!complete) return dealt;
        std::uint64_t sum = 0;
        for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
            dealt.first_[bucket] = sum;
            for (std::size_t chunk = 0; chunk < chunks; ++chunk) sum += std::exchange(next[chunk * buckets + bucket], sum);
        }
        dealt.first_[buckets] = sum;
        dealt.items_ = Buffer<Item>(sum);
        pass([&](std::size_t chunk) { return Dealer<true>(dealt.items_.data(), next.data() + chunk * buckets); });
        if (!complete) dealt.first_.assign(buckets + 1, 0);
        return dealt;
    }

private:
    Buffer<Item> items_;
    std::vector<std::uint64_t> first_; ///< of each bucket, and how many there are
};

} // namespace isotet::core
