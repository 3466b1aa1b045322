// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Structures that find the tets which an isovalue cuts, without looking at all of them.
///
/// `none`            all tets
/// `interval_tree`   McCreight's tree over the tets' ranges (Cignoni and others 1997)
/// `octree`          the min-max octree (Wilhelms, Van Gelder 1992) over the tets' centroids
/// `seed_set`        a set of seeds, and propagation across faces (Bajaj and others 1996, van Kreveld and others 1997)
/// `span_space`      a k-d tree over the tets' ranges as points of the plane (Livnat and others 1996)
/// `cluster_ranges`  ranges of clusters and of groups of 32 tets, as isotet's engines use them
enum class SearchIndex : std::uint8_t { none, interval_tree, octree, seed_set, span_space, cluster_ranges };

inline constexpr std::array all_search_indexes{SearchIndex::none,       SearchIndex::interval_tree,
                                               SearchIndex::octree,     SearchIndex::seed_set,
                                               SearchIndex::span_space, SearchIndex::cluster_ranges};

/// The name as written here.
ISOTET_API std::string_view name_of(SearchIndex index) noexcept;

struct TetIndexReport {
    std::uint64_t tets = 0;                      ///< of the packed grid
    std::uint64_t table_bytes = 0;               ///< of the tables that all indexes look through: 16 a tet, 16 a point
    std::uint64_t index_bytes = 0;               ///< of the index itself
    double table_seconds = 0, index_seconds = 0; ///< for making them
};

namespace search {
class IndexedTets;
}

/// An index over the tets of a packed grid. Tets have the numbers 0, 1, 2, ... in which they are packed.
///
/// The packed grid is not needed any more. It holds the values of the field at the time: another field needs another
/// index.
///
/// Threads   const functions are safe from many threads; find() needs the object alone
class ISOTET_API TetIndex {
public:
    /// Errors   invalid_argument for a grid packed in double; invalid_data with 2^32 - 1 tets or more; out_of_memory;
    ///          cancelled
    /// Cost     O(n log n), parallel where the structure allows; the report tells the memory
    static Result<TetIndex> create(const PackedGrid& grid, SearchIndex index, const Run& run = {});

    TetIndex(TetIndex&&) noexcept;
    TetIndex& operator=(TetIndex&&) noexcept;
    ~TetIndex();

    const TetIndexReport& report() const noexcept;

    /// The tets that may be cut: at least every tet that extract() takes triangles from, each once. `interval_tree`,
    /// `seed_set` and `span_space` find no others.
    ///
    /// Guarantees   the same order every time; the numbers stay where they are until the next call
    /// Errors       invalid_argument when the isovalue is not finite
    Result<std::span<const std::uint32_t>> find(double isovalue);

    /// Whether the isovalue cuts a tet: it has data at its corners, one of them is below, and one is not.
    bool is_cut(std::uint32_t tet, double isovalue) const;

private:
    explicit TetIndex(std::unique_ptr<search::IndexedTets> tets);
    std::unique_ptr<search::IndexedTets> tets_;
};

} // namespace isotet
