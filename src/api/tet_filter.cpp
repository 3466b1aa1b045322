// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include <isotet/search.hpp>

#include "core/guard.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "core/storage.hpp"
#include "core/tet_table.hpp"
#include "search/all_tets.hpp"
#include "search/cluster_ranges.hpp"
#include "search/interval_tree.hpp"
#include "search/octree.hpp"
#include "search/seed_set.hpp"
#include "search/span_space.hpp"

namespace isotet {

namespace search {

class FilteredTets {
public:
    core::TetTable table;
    std::unique_ptr<Search> search; ///< borrows the table
    core::Storage storage;
    TetFilterReport report;
    TetNumbers found;
};

} // namespace search

namespace {

using search::FilteredTets;

std::unique_ptr<search::Search> make_search(Filter filter, const core::TetTable& table) {
    switch (filter) {
    case Filter::none: return std::make_unique<search::AllTets>(table);
    case Filter::interval_tree: return std::make_unique<search::IntervalTree>(table);
    case Filter::octree: return std::make_unique<search::Octree>(table);
    case Filter::seed_set: return std::make_unique<search::SeedSet>(table);
    case Filter::span_space: return std::make_unique<search::SpanSpace>(table);
    case Filter::cluster_ranges: return std::make_unique<search::ClusterRanges>(table);
    }
    return nullptr;
}

/// Of a tet, while the structure is built; besides the tables.
std::uint64_t bytes_while_building(Filter filter) {
    switch (filter) {
    case Filter::none: return 0;
    case Filter::interval_tree: return 12 + 4 + 16;
    case Filter::octree: return 32 + 4 + 4;
    case Filter::seed_set: return 48 + 16 + 16;
    case Filter::span_space: return 12 + 12;
    case Filter::cluster_ranges: return 1;
    }
    return 0;
}

class Clock {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Result<std::unique_ptr<FilteredTets>> build_tets(const core::Packed& packed, Filter filter, const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "building the filter was cancelled"}; };
    const std::uint64_t needed = packed.report.tets * (16 + bytes_while_building(filter)) + 16 * packed.points();
    if (auto ok = core::require_memory("the filter", needed); !ok) return ok.error();
    auto tets = std::make_unique<FilteredTets>();
    const Clock table_clock;
    auto table = core::make_tet_table(packed);
    if (!table) return table.error();
    tets->table = *std::move(table);
    tets->report.table_seconds = table_clock.seconds();
    if (progress.cancelled()) return cancelled();
    progress("filter", 0.2);
    const Clock filter_clock;
    tets->search = make_search(filter, tets->table);
    tets->report.filter_seconds = filter_clock.seconds();
    if (progress.cancelled()) return cancelled();
    progress("filter", 1);
    tets->storage = packed.storage;
    tets->report.tets = tets->table.tets.size();
    tets->report.table_bytes = tets->table.bytes();
    tets->report.filter_bytes = tets->search->bytes();
    return tets;
}

} // namespace

std::string_view name_of(Filter filter) noexcept {
    switch (filter) {
    case Filter::none: return "none";
    case Filter::interval_tree: return "interval_tree";
    case Filter::octree: return "octree";
    case Filter::seed_set: return "seed_set";
    case Filter::span_space: return "span_space";
    case Filter::cluster_ranges: return "cluster_ranges";
    }
    return "";
}

TetFilter::TetFilter(std::unique_ptr<FilteredTets> tets) : tets_(std::move(tets)) {}
TetFilter::TetFilter(TetFilter&&) noexcept = default;
TetFilter& TetFilter::operator=(TetFilter&&) noexcept = default;
TetFilter::~TetFilter() = default;

Result<TetFilter> TetFilter::build(const PackedGrid& grid, Filter filter, int threads, const Progress& progress) {
    return core::guarded("building the filter", [&]() -> Result<TetFilter> {
        Result<std::unique_ptr<FilteredTets>> tets = Error{};
        core::with_threads(threads, [&] { tets = build_tets(grid.data(), filter, progress); });
        if (!tets) return tets.error();
        return TetFilter(*std::move(tets));
    });
}

const TetFilterReport& TetFilter::report() const noexcept { return tets_->report; }

Result<const std::vector<std::uint32_t>*> TetFilter::find(double isovalue) {
    if (!std::isfinite(isovalue))
        return Error{ErrorCode::invalid_argument, fmt::format("the isovalue is {}, but must be finite", isovalue)};
    return core::guarded("searching tets", [&]() -> Result<const std::vector<std::uint32_t>*> {
        tets_->search->find(core::store_isovalue<float>(isovalue, tets_->storage).value, tets_->found);
        return &tets_->found;
    });
}

bool TetFilter::is_cut(std::uint32_t tet, double isovalue) const {
    return tets_->table.range(tet).holds(core::store_isovalue<float>(isovalue, tets_->storage).value);
}

} // namespace isotet
