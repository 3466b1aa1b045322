// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Counts repeated tets and unbalanced faces among tets that fit into a processor's cache.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>

#include "grid/cells.hpp"

namespace isotet::core {

/// A tet by its corners in ascending order, with two bits beside: which way round they are, and whether its cell is of an
/// ordered type (cells.hpp).
template <class Point>
class AscendingTet {
public:
    /// `mirrored`   whether the tet's stored form is the mirror image of `tet`
    static AscendingTet make(const Tet& tet, bool mirrored) {
        AscendingTet out;
        for (std::size_t k = 0; k < 4; ++k) out.corners_[k] = static_cast<Point>(tet[k]);
        const auto order = [&](std::size_t i, std::size_t j) {
            const Point a = out.corners_[i], b = out.corners_[j];
            mirrored ^= b < a;
            out.corners_[i] = std::min(a, b);
            out.corners_[j] = std::max(a, b);
        };
        order(0, 1);
        order(2, 3);
        order(0, 2);
        order(1, 3);
        order(1, 2);
        out.corners_[0] |= mirrored ? flag : Point{0};
        return out;
    }
    AscendingTet of_ordered_cell() const {
        AscendingTet out = *this;
        out.corners_[1] |= flag;
        return out;
    }
    std::array<Point, 4> corners() const {
        return {static_cast<Point>(corners_[0] & ~flag), static_cast<Point>(corners_[1] & ~flag), corners_[2],
                corners_[3]};
    }
    /// Whether the ascending order is the mirror image of the stored form.
    bool mirrored() const { return corners_[0] & flag; }
    bool is_ordered() const { return corners_[1] & flag; }

    /// Every point number is below this.
    static constexpr std::uint64_t max_points = std::uint64_t{1} << (std::numeric_limits<Point>::digits - 1);

private:
    static constexpr Point flag = static_cast<Point>(max_points);
    std::array<Point, 4> corners_;
};

/// A hash table with linear probing, cleared without giving its memory back. An item has a `key`, an array of point
/// numbers of which the last is never 0.
template <class Item>
class OpenTable {
public:
    /// `items`   about so many different ones will be added; with more the table grows
    void clear(std::size_t items) {
        bits_ = std::max(6, static_cast<int>(std::bit_width(items + items / 4)));
        places_.assign(std::size_t{1} << bits_, Item{});
        size_ = 0;
    }
    std::size_t size() const { return size_; }

    /// Calls use(item) for every item, in the order of the table.
    template <class Use>
    void for_each(const Use& use) const {
        for (const Item& item : places_)
            if (!is_empty(item)) use(item);
    }

    /// The item with this key, which is added where there is none.
    template <class Key>
    Item& operator[](const Key& key) {
        if (size_ + size_ / 2 > places_.size()) grow();
        Item& item = place_of(key);
        size_ += is_empty(item);
        item.key = key;
        return item;
    }

private:
    static bool is_empty(const Item& item) { return item.key.back() == 0; }

    template <class Key>
    Item& place_of(const Key& key) {
        // Multilinear hashing (Lemire, Kaser 2014): the high bits of a sum of products.
        constexpr std::array<std::uint64_t, 4> factors = {0x9e3779b97f4a7c15u, 0xbf58476d1ce4e5b9u, 0x94d049bb133111ebu,
                                                          0xd6e8feb86659fd93u};
        std::uint64_t sum = 0;
        for (std::size_t k = 0; k < key.size(); ++k) sum += factors[k] * key[k];
        std::size_t at = sum >> (64 - bits_);
        while (!(places_[at].key == key || is_empty(places_[at]))) at = (at + 1) & (places_.size() - 1);
        return places_[at];
    }

    void grow() {
        ++bits_;
        std::vector<Item> old(std::size_t{1} << bits_);
        old.swap(places_);
        for (const Item& item : old)
            if (!is_empty(item)) place_of(item.key) = item;
    }

    std::vector<Item> places_;
    int bits_ = 0;
    std::size_t size_ = 0;
};

/// How tets are dealt to buckets: by their two lowest points, those of a bucket being numbers in a row.
///
/// A face's lowest point is the tet's lowest or second lowest one. So a bucket has all tets whose faces it counts, and
/// of each of them it counts the faces with their lowest point in it.
struct PointBuckets {
    unsigned shift = 0;
    std::size_t of(std::uint64_t point) const { return static_cast<std::size_t>(point >> shift); }
};

/// Counts of some buckets.
struct FaceCounts {
    std::uint64_t repeated = 0;   ///< tets with the corners of an earlier one
    std::uint64_t unbalanced = 0; ///< faces that tets (but repeated ones) do not use equally often in both directions
};

/// Counts bucket after bucket; keeps its tables for the next one.
template <class Point>
class FaceCounter {
public:
    /// Adds what is found among a bucket's tets. Stops early when cancelled.
    /// `is_here(point)`   whether faces with this lowest point are counted: all tets that have it as their lowest or
    ///                    second lowest one are there
    template <class IsHere>
    void add(std::span<const AscendingTet<Point>> tets, const IsHere& is_here, const Progress& progress,
             FaceCounts& counts) {
        tets_.clear(tets.size());
        faces_.clear(2 * tets.size()); // most are used twice
        for (std::size_t i = 0; i < tets.size(); ++i) {
            if (i % tets_between_looks == 0 && progress.cancelled()) return;
            const std::array<Point, 4> p = tets[i].corners();
            const bool lowest_is_here = is_here(p[0]), second_is_here = is_here(p[1]);
            const std::size_t different = tets_.size();
            SeenTet& seen = tets_[p];
            const bool repeats = tets_.size() == different;
            counts.repeated += lowest_is_here && repeats;
            const bool turned_over = tets[i].is_ordered() && !seen.turned[tets[i].mirrored()];
            seen.turned[tets[i].mirrored()] = true;
            if (repeats && !turned_over) continue;
            // The outward faces of an upright tet are 1 2 3, 0 3 2, 0 1 3 and 0 2 1.
            const Balance sign = tets[i].mirrored() ? -1 : 1;
            if (second_is_here) use({p[1], p[2], p[3]}, sign, counts);
            if (!lowest_is_here) continue;
            use({p[0], p[2], p[3]}, -sign, counts);
            use({p[0], p[1], p[3]}, sign, counts);
            use({p[0], p[1], p[2]}, -sign, counts);
        }
    }

    /// Calls found(points, mirrored) for each unbalanced face of the last bucket, in no particular order: its points
    /// ascending, and whether it faces outwards in the mirrored order.
    template <class Found>
    void each_unbalanced(const Found& found) const {
        faces_.for_each([&](const Face& face) {
            if (face.balance != 0) found(face.key, face.balance < 0);
        });
    }

private:
    static constexpr std::size_t tets_between_looks = 1 << 16;
    using Balance = std::make_signed_t<Point>;

    /// Parts of one polyhedron may be the same tet, one of them inside out: both count.
    struct SeenTet {
        std::array<Point, 4> key{};
        std::array<bool, 2> turned{}; ///< whether it was seen as it stands, and mirrored
    };
    struct Face {
        std::array<Point, 3> key{};
        Balance balance = 0; ///< uses in the one direction less those in the other
    };

    void use(const std::array<Point, 3>& points, Balance sign, FaceCounts& counts) {
        Face& face = faces_[points];
        counts.unbalanced -= face.balance != 0;
        face.balance += sign;
        counts.unbalanced += face.balance != 0;
    }

    OpenTable<SeenTet> tets_;
    OpenTable<Face> faces_;
};

} // namespace isotet::core
