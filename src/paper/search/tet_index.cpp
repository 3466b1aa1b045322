// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <isotet/paper/search.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "numbers/storage.hpp"
#include "packed/residency.hpp"
#include "packed/tet_table.hpp"
#include "paper/search/all_tets.hpp"
#include "paper/search/cluster_ranges.hpp"
#include "paper/search/interval_tree.hpp"
#include "paper/search/octree.hpp"
#include "paper/search/seed_set.hpp"
#include "paper/search/span_space.hpp"

namespace isotet {

namespace search {

class IndexedTets {
public:
    core::TetTable table;
    std::unique_ptr<Search> search; ///< borrows the table
    core::Storage storage;
    TetIndexReport report;
    TetNumbers found;
};

} // namespace search

namespace {

using search::IndexedTets;

std::unique_ptr<search::Search> make_search(SearchIndex index, const core::TetTable& table, const Progress& progress) {
    switch (index) {
    case SearchIndex::none: return std::make_unique<search::AllTets>(table);
    case SearchIndex::interval_tree: return std::make_unique<search::IntervalTree>(table, progress);
    case SearchIndex::octree: return std::make_unique<search::Octree>(table);
    case SearchIndex::seed_set: return std::make_unique<search::SeedSet>(table);
    case SearchIndex::span_space: return std::make_unique<search::SpanSpace>(table);
    case SearchIndex::cluster_ranges: return std::make_unique<search::ClusterRanges>(table);
    }
    return nullptr;
}

/// Of a tet, while the structure is built; besides the tables.
std::uint64_t bytes_while_building(SearchIndex index) {
    switch (index) {
    case SearchIndex::none: return 0;
    case SearchIndex::interval_tree: return 12 + 4 + 16;
    case SearchIndex::octree: return 32 + 4 + 4;
    case SearchIndex::seed_set: return 48 + 16 + 16;
    case SearchIndex::span_space: return 12 + 12;
    case SearchIndex::cluster_ranges: return 1;
    }
    return 0;
}

Result<std::unique_ptr<IndexedTets>> build_tets(const core::Packed& packed, SearchIndex index,
                                                const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "building the index was cancelled"}; };
    const std::uint64_t needed = packed.report.tets * (16 + bytes_while_building(index)) + 16 * packed.points();
    if (auto ok = core::require_memory("the index", needed); !ok) return ok.error();
    auto tets = std::make_unique<IndexedTets>();
    const core::Stopwatch table_clock;
    auto table = core::make_tet_table(packed);
    if (!table) return table.error();
    tets->table = *std::move(table);
    tets->report.table_seconds = table_clock.seconds();
    if (progress.cancelled()) return cancelled();
    progress("index", 0.2);
    const core::Stopwatch index_clock;
    tets->search = make_search(index, tets->table, progress);
    tets->report.index_seconds = index_clock.seconds();
    if (progress.cancelled()) return cancelled();
    progress("index", 1);
    tets->storage = packed.storage;
    tets->report.tets = tets->table.tets.size();
    tets->report.table_bytes = tets->table.bytes();
    tets->report.index_bytes = tets->search->bytes();
    return tets;
}

} // namespace

std::string_view name_of(SearchIndex index) noexcept {
    switch (index) {
    case SearchIndex::none: return "none";
    case SearchIndex::interval_tree: return "interval_tree";
    case SearchIndex::octree: return "octree";
    case SearchIndex::seed_set: return "seed_set";
    case SearchIndex::span_space: return "span_space";
    case SearchIndex::cluster_ranges: return "cluster_ranges";
    }
    return "";
}

TetIndex::TetIndex(std::unique_ptr<IndexedTets> tets) : tets_(std::move(tets)) {}
TetIndex::TetIndex(TetIndex&&) noexcept = default;
TetIndex& TetIndex::operator=(TetIndex&&) noexcept = default;
TetIndex::~TetIndex() = default;

Result<TetIndex> TetIndex::create(const PackedGrid& grid, SearchIndex index, const Run& run) {
    return core::carry_out("building the index", run, [&](const Progress& progress) -> Result<TetIndex> {
        const auto whole = core::whole_of(grid.shared_data(), progress);
        if (!whole) return whole.error();
        Result<std::unique_ptr<IndexedTets>> tets = build_tets(**whole, index, progress);
        if (!tets) return tets.error();
        return TetIndex(*std::move(tets));
    });
}

const TetIndexReport& TetIndex::report() const noexcept {
    static const TetIndexReport none;
    return tets_ ? tets_->report : none;
}

Result<std::span<const std::uint32_t>> TetIndex::find(double isovalue) {
    if (!tets_) return moved_from("the index");
    if (!std::isfinite(isovalue))
        return Error{ErrorCode::invalid_argument, fmt::format("the isovalue is {}, but must be finite", isovalue)};
    return core::guarded("searching tets", [&]() -> Result<std::span<const std::uint32_t>> {
        tets_->search->find(core::store_isovalue<float>(isovalue, tets_->storage).value, tets_->found);
        return std::span<const std::uint32_t>(tets_->found);
    });
}

bool TetIndex::is_cut(std::uint32_t tet, double isovalue) const {
    return tets_ && tets_->table.range(tet).holds(core::store_isovalue<float>(isovalue, tets_->storage).value);
}

} // namespace isotet
