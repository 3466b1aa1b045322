// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every index finds every active tet, on fields that are as nasty as they come, whatever was asked before.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/paper/search.hpp>

#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

std::vector<std::uint32_t> numbers(const Result<std::span<const std::uint32_t>>& found) {
    return {found.value().begin(), found.value().end()};
}

bool is_exact(SearchIndex index) {
    return index == SearchIndex::interval_tree || index == SearchIndex::seed_set || index == SearchIndex::span_space;
}

/// Builds every index on a field, and asks it for the isovalues one after another.
void expect_all_cut_tets_found(const Grid& grid, const PointField& field, const std::vector<double>& isovalues) {
    const PackedGrid packed = pack(grid, field, {.split_cells = true}).value();
    for (const SearchIndex index : all_search_indexes) {
        SCOPED_TRACE(std::string(name_of(index)));
        TetIndex tets = TetIndex::create(packed, index).value();
        ASSERT_EQ(tets.report().tets, packed.report().tets);
        for (const double isovalue : isovalues) {
            SCOPED_TRACE(isovalue);
            std::vector<std::uint32_t> cut;
            for (std::uint32_t tet = 0; tet < tets.report().tets; ++tet)
                if (tets.is_cut(tet, isovalue)) cut.push_back(tet);
            std::vector<std::uint32_t> found = numbers(tets.find(isovalue));
            std::sort(found.begin(), found.end());
            ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "a tet was found twice";
            ASSERT_TRUE(found.empty() || found.back() < tets.report().tets);
            if (is_exact(index)) ASSERT_EQ(found, cut);
            else ASSERT_TRUE(std::includes(found.begin(), found.end(), cut.begin(), cut.end()));
        }
    }
}

TEST(SearchIndexes, FindAllCutTetsOfSmoothFields) {
    for (const char* shape : {"kuhn", "shuffled", "layer", "mixed"}) {
        SCOPED_TRACE(shape);
        const Grid grid = made_grid(shape, 9, {"gyroid"});
        expect_all_cut_tets_found(grid, point_field(grid), {0, 0.01, 0.02, -0.5, -0.49, 1.2, -1.2, 5, -5, 0});
    }
}

TEST(SearchIndexes, FindAllCutTetsOfManyComponentsAndExtrema) {
    Grid grid = made_grid("shuffled", 14, {"wavelet"});
    std::vector<float> values(grid.points.tuples());
    for (std::size_t p = 0; p < values.size(); ++p) // a bump around every fifth point or so
        values[p] = static_cast<float>(std::sin(9 * grid.points.at(p, 0)) * std::sin(8 * grid.points.at(p, 1)) *
                                       std::sin(7 * grid.points.at(p, 2)));
    expect_all_cut_tets_found(grid, field_of(values), {0.9, 0.5, 0.1, 0, -0.1, -0.5, -0.9, 0.95});
}

TEST(SearchIndexes, FindAllCutTetsOfNastyFields) {
    for (const std::uint32_t seed : Seeds(1, 12)) {
        const NastyGrid g = nasty_grid(seed, {.side = 6,
                                              .values = seed % 3 ? static_cast<int>(2 + seed % 4) : 0,
                                              .no_data = seed % 2 ? 0.1 : 0,
                                              .missing = 0.2,
                                              .inverted = 0.1,
                                              .mirrored = 0.3,
                                              .repeated = 0.1});
        expect_all_cut_tets_found(g.grid, g.field, {0, 1, 0.5, -1, 1.5, 0, 1e-40, 1e30, -1e30, 2, 1});
    }
}

TEST(SearchIndexes, FindAllCutTetsOfPlateaus) {
    Grid grid = made_grid("kuhn", 10, {"plane"});
    std::vector<float> values(grid.points.tuples());
    for (std::size_t p = 0; p < values.size(); ++p)
        values[p] = static_cast<float>(std::round(2 * std::hypot(grid.points.at(p, 0), grid.points.at(p, 1))));
    expect_all_cut_tets_found(grid, field_of(values), {0, 1, 2, 0.5, 1.5, 3});
}

TEST(SearchIndexes, FindNothingInAConstantFieldOrOneWithoutData) {
    const Grid grid = made_grid("kuhn", 3, {"plane"});
    for (const float value : {1.0f, std::numeric_limits<float>::quiet_NaN()}) {
        const PackedGrid packed = pack(grid, field_of(std::vector<float>(grid.points.tuples(), value))).value();
        for (const SearchIndex index : all_search_indexes) {
            TetIndex tets = TetIndex::create(packed, index).value();
            const std::size_t expected = index == SearchIndex::none ? packed.report().tets : 0;
            for (const double isovalue : {1.0, 0.0, 2.0})
                EXPECT_EQ(tets.find(isovalue).value().size(), expected) << name_of(index);
        }
    }
}

TEST(SearchIndexes, FindTheTetsThatExtractionTakesTrianglesFrom) {
    const Grid grid = made_grid("perturbed", 8, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    ExtractOptions options;
    options.ties = Ties::keep; // one or two triangles of every active tet
    const std::uint64_t triangles = extract(packed, 0.25, options).value().surface.triangle_count();
    for (const SearchIndex index : all_search_indexes) {
        TetIndex tets = TetIndex::create(packed, index).value();
        std::uint64_t cut = 0;
        for (const std::uint32_t tet : tets.find(0.25).value()) cut += tets.is_cut(tet, 0.25);
        EXPECT_LE(cut, triangles);
        EXPECT_GE(2 * cut, triangles);
    }
}

TEST(SearchIndexes, AreTheSameForAnyNumberOfThreads) {
    const Grid grid = made_grid("shuffled", 24, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    for (const SearchIndex index : all_search_indexes) {
        TetIndex one = TetIndex::create(packed, index, {.threads = 1}).value(),
                 four = TetIndex::create(packed, index, {.threads = 4}).value();
        EXPECT_EQ(one.report().index_bytes, four.report().index_bytes);
        for (const double isovalue : {0.1, 0.2, -0.3})
            EXPECT_EQ(numbers(one.find(isovalue)), numbers(four.find(isovalue))) << name_of(index);
    }
}

TEST(SearchIndexes, OutliveThePackedGrid) {
    const Grid grid = made_grid("kuhn", 5, {"gyroid"});
    std::optional<PackedGrid> packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    for (const SearchIndex index : all_search_indexes) {
        TetIndex tets = TetIndex::create(*packed, index).value();
        const std::vector<std::uint32_t> before = numbers(tets.find(0.1));
        if (index == all_search_indexes.back()) packed.reset();
        EXPECT_EQ(numbers(tets.find(0.1)), before);
    }
}

TEST(SearchIndexes, RefuseWhatTheyCannotDo) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    TetIndex tets = TetIndex::create(packed, SearchIndex::octree).value();
    EXPECT_EQ(tets.find(std::nan("")).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(tets.find(INFINITY).error().message, "the isovalue is inf, but must be finite");
    PackOptions options;
    options.precision = Precision::float64;
    const PackedGrid in_double = pack(grid, point_field(grid), options).value();
    EXPECT_EQ(TetIndex::create(in_double, SearchIndex::seed_set).error().code, ErrorCode::invalid_argument);
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    EXPECT_EQ(TetIndex::create(packed, SearchIndex::seed_set, {.progress = progress}).error().code,
              ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::test
