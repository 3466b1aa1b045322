// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces from the cells that an ActiveCellFilter kept: those of all cells, byte for byte, or word that all are needed.
#include <isotet/active_cells.hpp>

#include <random>

#include "direct/direct_support.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

/// What goes by in pieces of drawn sizes, in drawn order; of 64-bit numbers if the seed says so.
Result<Cells> filtered(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                       const DirectOptions& options, std::uint32_t seed) {
    auto filter = ActiveCellFilter::create(grid.points, field, isovalues, grid.cells.uniform_type, options);
    if (!filter) return filter.error();
    std::mt19937 draw(seed);
    std::vector<std::int64_t> corners;
    grid.cells.connectivity.visit([&](auto values) { corners.assign(values.begin(), values.end()); });
    std::vector<std::pair<std::size_t, std::size_t>> pieces;
    for (std::size_t begin = 0; begin < corners.size();) {
        const std::size_t size = std::min<std::size_t>(corners.size() - begin, 1 + draw() % (seed % 2 ? 9000 : 40));
        pieces.emplace_back(begin, size);
        begin += size;
    }
    do {
        std::ranges::shuffle(pieces, draw);
        for (const auto& [begin, size] : pieces) {
            if (seed % 3 == 0) {
                filter->add(begin, Array::borrow(std::span<const std::int64_t>(corners.data() + begin, size)));
                continue;
            }
            const std::vector<std::int32_t> narrow(corners.begin() + static_cast<std::ptrdiff_t>(begin),
                                                   corners.begin() + static_cast<std::ptrdiff_t>(begin + size));
            filter->add(begin, Array::borrow(narrow));
        }
    } while (filter->next_round());
    return filter->finish();
}

/// The same with the type of each cell.
Result<Cells> filtered_by_cells(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                                const DirectOptions& options, std::uint32_t seed) {
    auto filter = ActiveCellFilter::create(grid.points, field, isovalues, std::nullopt, options);
    if (!filter) return filter.error();
    std::mt19937 draw(seed);
    const auto types = grid.cells.types.as<std::uint8_t>();
    std::vector<std::pair<std::size_t, std::size_t>> pieces;
    for (std::size_t begin = 0; begin < types.size(); begin += pieces.back().second)
        pieces.emplace_back(begin, std::min<std::size_t>(types.size() - begin, 1 + draw() % (seed % 2 ? 3000 : 5)));
    do {
        std::ranges::shuffle(pieces, draw);
        for (const auto& [begin, size] : pieces) {
            std::vector<std::int64_t> corners;
            const auto end = static_cast<std::size_t>(grid.cells.offsets.at(begin + size));
            for (auto i = static_cast<std::size_t>(grid.cells.offsets.at(begin)); i < end; ++i)
                corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
            filter->add_cells(begin, types.subspan(begin, size), Array::borrow(corners));
        }
    } while (filter->next_round());
    return filter->finish();
}

/// A grid whose cells stand one after another without types, as they are here.
Grid one_kind(const Grid& grid) {
    Grid out = grid;
    if (!grid.cells.types.empty()) {
        out.cells.uniform_type = static_cast<CellType>(grid.cells.types.as<std::uint8_t>().front());
        out.cells.types = out.cells.offsets = Array();
    }
    out.cell_fields.clear();
    return out;
}

/// How many cells have corners on both sides of an isovalue.
std::size_t count_active(const Grid& grid, const PointField& field, const std::vector<double>& isovalues) {
    const std::size_t corners = grid.cells.connectivity.tuples() / grid.cells.count();
    std::size_t active = 0;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        double least = infinity, most = -infinity;
        for (std::size_t k = 0; k < corners; ++k) {
            const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(corners * cell + k));
            least = std::min(least, field.values.at(point));
            most = std::max(most, field.values.at(point));
        }
        active += std::ranges::any_of(isovalues, [&](double value) { return least < value && value <= most; });
    }
    return active;
}

/// Returns how many cells were kept; nothing where all are needed.
std::optional<std::size_t> expect_same_surfaces(const Grid& grid, const PointField& field,
                                                const std::vector<double>& isovalues, DirectOptions options,
                                                std::uint32_t seed) {
    const DirectExtraction all = extract_direct(grid, field, isovalues, options).value();
    Grid some = grid;
    const auto filter = grid.cells.types.empty() ? filtered : filtered_by_cells;
    some.cells = filter(grid, field, isovalues, options, seed).value();
    options.active_cells_only = true;
    const DirectExtraction active = extract_direct(some, field, isovalues, options).value();
    if (active.needs_all_cells) return std::nullopt;
    EXPECT_EQ(active.surfaces.size(), isovalues.size());
    for (std::size_t i = 0; i < active.surfaces.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "isovalue " << isovalues[i] << ", ties " << int(options.extract.ties));
        EXPECT_TRUE(bytes_of(active.surfaces[i].surface) == bytes_of(all.surfaces[i].surface));
        expect_same_report(active.surfaces[i].report, all.surfaces[i].report);
    }
    expect_same_report(active.field, all.field);
    EXPECT_EQ(active.coarse_tets, all.coarse_tets);
    return some.cells.count();
}

DirectOptions with_edge_ends(Ties ties, Precision precision = Precision::float32) {
    DirectOptions options;
    options.precision = precision;
    options.extract.ties = ties;
    options.extract.edge_ends = true;
    return options;
}

TEST(ActiveCells, GiveTheSurfacesOfAllCellsOfSmoothFields) {
    const std::vector<double> isovalues{-0.5, 0.1, 9};
    std::uint32_t seed = 0;
    for (const char* shape : some_of<const char*>({"kuhn", "shuffled", "hex", "wedge", "pyramid"})) {
        SCOPED_TRACE(shape);
        const Grid grid = one_kind(made_grid(shape, 24, {"gyroid"}, 7));
        const PointField field = point_field(grid, 0);
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            const auto kept = expect_same_surfaces(grid, field, isovalues, with_edge_ends(ties), ++seed);
            ASSERT_TRUE(kept);
            // A few more, of points at the ends of the range.
            EXPECT_LT(*kept, count_active(grid, field, isovalues) * 11 / 10);
        }
    }
}

TEST(ActiveCells, MayHaveTypesOfTheirOwn) {
    const Grid grid = made_grid("mixed", 20, {"gyroid", "integer"});
    for (const std::uint32_t seed : {1U, 2U})
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            const auto kept = expect_same_surfaces(grid, point_field(grid, 0), {-0.5, 0.1}, with_edge_ends(ties), seed);
            ASSERT_TRUE(kept);
            EXPECT_LT(*kept, grid.cells.count() / 2);
            EXPECT_TRUE(expect_same_surfaces(grid, point_field(grid, 1), {2}, with_edge_ends(ties), seed));
        }
}

DirectOptions with_gradients(DirectOptions options) {
    options.extract.normals = Normals::gradient;
    return options;
}

TEST(ActiveCells, HaveThoseAroundThemForGradientNormals) {
    std::uint32_t seed = 0;
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "shuffled", "hex", "wedge", "pyramid"}))
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            SCOPED_TRACE(testing::Message() << shape << ", ties " << int(ties));
            Grid grid = made_grid(shape, 24, {"gyroid", "integer"}, 7);
            if (shape != std::string_view("mixed")) grid = one_kind(grid);
            const DirectOptions options = with_edge_ends(ties, ++seed % 2 ? Precision::float32 : Precision::float64);
            const auto bare = expect_same_surfaces(grid, point_field(grid, 0), {0.1}, options, seed);
            const auto kept = expect_same_surfaces(grid, point_field(grid, 0), {0.1}, with_gradients(options), seed);
            ASSERT_TRUE(bare && kept);
            EXPECT_GT(*kept, *bare);
            EXPECT_LT(*kept, grid.cells.count() * 99 / 100);
            EXPECT_TRUE(
                expect_same_surfaces(grid, point_field(grid, 0), {-0.5, 0.1, 9}, with_gradients(options), seed));
            EXPECT_TRUE(expect_same_surfaces(grid, point_field(grid, 1), {2}, with_gradients(options), seed));
        }
}

TEST(ActiveCells, HaveThoseAroundThemInRandomGrids) {
    int compared = 0, needed_all = 0;
    for (const std::uint32_t seed : Seeds(1, 60)) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const NastyGrid g = nasty_grid(seed, {.side = 4 + int(seed) % 6,
                                              .values = 2 + int(seed) % 5,
                                              .no_data = seed % 2 ? 0.05 : 0,
                                              .missing = 0.1 * (seed % 4),
                                              .repeated = 0.1});
        const DirectOptions options = with_edge_ends(seed % 3 ? Ties::merge : Ties::keep);
        const auto kept = expect_same_surfaces(one_kind(g.grid), g.field, {0.5, 1}, with_gradients(options), seed);
        (kept ? compared : needed_all) += 1;
    }
    if (compared + needed_all >= 10) { // not one seed alone
        EXPECT_GT(compared, 0);
    }
}

TEST(ActiveCells, AreAddedTwiceForGradientNormals) {
    const Grid grid = one_kind(made_grid("kuhn", 4, {"gyroid"}));
    const std::vector<double> isovalues{0.1};
    for (const bool gradients : {false, true}) {
        const DirectOptions options = gradients ? with_gradients({}) : DirectOptions{};
        auto filter =
            ActiveCellFilter::create(grid.points, point_field(grid, 0), isovalues, CellType::tetrahedron, options)
                .value();
        filter.add(0, grid.cells.connectivity);
        if (gradients) {
            EXPECT_EQ(filter.finish().error().code, ErrorCode::invalid_argument);
        }
        EXPECT_EQ(filter.next_round(), gradients);
        if (gradients) filter.add(0, grid.cells.connectivity);
        EXPECT_FALSE(filter.next_round());
        EXPECT_TRUE(filter.finish());
    }
}

TEST(ActiveCells, RefuseTypesThatAreNotTakenAndCornersThatDoNotFit) {
    const Grid grid = made_grid("mixed", 3, {"gyroid"});
    const std::vector<double> isovalues{0.1};
    const std::vector<std::int32_t> corners{0, 1, 2, 3, 4};
    for (const std::vector<std::uint8_t>& types : {std::vector<std::uint8_t>{7}, {24}, {10}, {10, 10}, {1, 10, 10}}) {
        auto filter = ActiveCellFilter::create(grid.points, point_field(grid, 0), isovalues, std::nullopt).value();
        filter.add_cells(0, types, Array::borrow(corners));
        const auto cells = filter.finish();
        ASSERT_FALSE(cells);
        EXPECT_EQ(cells.error().code, ErrorCode::invalid_data);
    }
}

/// Of random grids most are no trouble; where flat tets are cut or unused points decide, all cells are asked for.
TEST(ActiveCells, GiveTheSurfacesOfAllCellsOfRandomGrids) {
    int compared = 0, needed_all = 0;
    for (const std::uint32_t seed : Seeds(1, 60)) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const NastyGrid g = nasty_grid(seed, {.side = 3 + int(seed) % 6,
                                              .values = 2 + int(seed) % 5,
                                              .no_data = seed % 2 ? 0.05 : 0,
                                              .missing = seed % 7 == 0 ? 0.97 : 0.1 * (seed % 4),
                                              .inverted = seed % 4 ? 0 : 0.2,
                                              .repeated = 0.1,
                                              .wide = seed % 5 == 0});
        DirectOptions options =
            with_edge_ends(seed % 2 ? Ties::merge : Ties::keep, seed % 3 ? Precision::float32 : Precision::float64);
        options.extract.point_fields = {{"value", g.field.values}};
        const auto kept = expect_same_surfaces(one_kind(g.grid), g.field, {0, 0.5, 1, 40}, options, seed);
        (kept ? compared : needed_all) += 1;
    }
    if (compared + needed_all >= 10) { // not one seed alone
        EXPECT_GT(compared, needed_all);
    }
}

TEST(ActiveCells, LeaveOutWhereThereIsNoData) {
    Grid grid = one_kind(made_grid("hex", 30, {"gyroid"}));
    std::vector<float> values(grid.point_fields[0].values.as<float>().begin(),
                              grid.point_fields[0].values.as<float>().end());
    for (std::size_t i = 0; i < values.size() / 2; ++i) values[i] = std::numeric_limits<float>::quiet_NaN();
    const PointField field{"half", Array::borrow(values), false, ""};
    const auto kept = expect_same_surfaces(grid, field, {0.1}, with_edge_ends(Ties::merge), 3);
    ASSERT_TRUE(kept);
    // A cell for each point without data at most: such points are counted.
    EXPECT_LT(*kept, grid.cells.count() * 3 / 4);
}

TEST(ActiveCells, AreAskedForAllWhenAFlatTetIsCut) {
    Grid grid;
    const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
    const std::vector<std::int32_t> tets{0, 1, 2, 3, 4, 6, 5, 1};
    const std::vector<float> values{0, 1, 0, 1, 0, 1, 0};
    grid.points = Array::borrow(points, 3);
    grid.cells.connectivity = Array::borrow(tets);
    const PointField field{"f", Array::borrow(values), false, ""};
    EXPECT_FALSE(expect_same_surfaces(grid, field, {0.5}, with_edge_ends(Ties::merge), 1));
}

TEST(ActiveCells, RefuseNumbersThatAreNoPoints) {
    const Grid grid = one_kind(made_grid("kuhn", 4, {"gyroid"}));
    for (const std::int64_t wrong :
         {std::int64_t{-1}, std::int64_t{125}, std::int64_t{127}, std::int64_t{1} << 32, std::int64_t{1} << 62}) {
        std::vector<std::int64_t> corners(grid.cells.connectivity.tuples());
        grid.cells.connectivity.visit([&](auto values) { corners.assign(values.begin(), values.end()); });
        corners[77] = wrong;
        Grid broken = grid;
        broken.cells.connectivity = Array::borrow(corners);
        for (const std::uint32_t seed : {3U, 6U, 9U}) { // 64 bits
            const auto cells = filtered(broken, point_field(grid, 0), {0.1}, {}, seed);
            ASSERT_FALSE(cells) << wrong;
            EXPECT_EQ(cells.error().code, ErrorCode::invalid_data);
        }
    }
}

TEST(ActiveCells, RefuseCoordinatesThatAreNotFinite) {
    Grid grid = one_kind(made_grid("hex", 4, {"gyroid"}));
    std::vector<float> points(grid.points.as<float>().begin(), grid.points.as<float>().end());
    points[3 * 62 + 1] = std::numeric_limits<float>::infinity();
    grid.points = Array::borrow(points, 3);
    const auto cells = filtered(grid, point_field(grid, 0), {0.1}, {}, 1);
    ASSERT_FALSE(cells);
    EXPECT_EQ(cells.error().code, ErrorCode::invalid_data);
}

TEST(ActiveCells, RefuseWhatNeedsAllCells) {
    const Grid grid = one_kind(made_grid("kuhn", 2, {"gyroid"}));
    const PointField field = point_field(grid, 0);
    const double isovalue = 0;
    const std::vector<double> too_many(ActiveCellFilter::max_isovalues + 1, isovalue);
    for (int which = 0; which < 4; ++which) {
        DirectOptions options;
        if (which == 1) options.frame.emplace();
        const std::span<const double> isovalues =
            which == 0 ? std::span(too_many) : std::span(&isovalue, which == 2 ? 0 : 1);
        PointField other = field;
        if (which == 3) other.values = Array();
        const auto filter = ActiveCellFilter::create(grid.points, other, isovalues, CellType::tetrahedron, options);
        ASSERT_FALSE(filter) << which;
        EXPECT_EQ(filter.error().code, ErrorCode::invalid_argument);
        if (which != 1) continue;
        options.active_cells_only = true;
        EXPECT_FALSE(extract_direct(grid, field, isovalues, options)) << which;
    }
}

} // namespace
} // namespace isotet::test
