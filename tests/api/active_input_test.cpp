// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A session that is given active cells only gives the surfaces of all, and asks for all when it needs them.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/active_cells.hpp>
#include <isotet/contour.hpp>
#include <isotet/make.hpp>
#include <isotet/solid.hpp>

#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

class ActiveInput : public testing::Test {
protected:
    /// The grid's cells that the isovalues cut.
    /// `around`   and those around them
    ContourInput some(const std::vector<double>& isovalues, bool around = false) {
        DirectOptions direct;
        if (around) direct.extract.normals = Normals::gradient;
        auto filter = ActiveCellFilter::create(grid.points, field, isovalues, CellType::tetrahedron, direct);
        do filter->add(0, grid.cells.connectivity);
        while (filter->next_round());
        ContourInput input{grid, field, {}, {}};
        input.grid.cells = filter->finish().value();
        const auto whole = [this](const isotet::Run&) -> Result<ContourInput> {
            ++asked;
            return all();
        };
        input.part = GridPart{whole, {}, around};
        return input;
    }
    ContourInput all() const { return {grid, field, {}, {}}; }

    ContourOptions options(std::vector<double> isovalues) const {
        ContourOptions out;
        out.surfaces = isovalues.size();
        out.expected_isovalues = std::move(isovalues);
        return out;
    }

    std::string bytes_of_all(double isovalue, const ContourOptions& options) const {
        return bytes_of(Contour::create(all(), options).value().extract(isovalue).value().surfaces[0].surface);
    }

    Grid grid = make_grid({.shape = "kuhn", .side = 12, .fields = {"gyroid"}}).value();
    PointField field = point_field(grid, 0);
    int asked = 0;
};

TEST_F(ActiveInput, IsEnoughForTheExpectedIsovalues) {
    const ContourOptions chosen = options({0.1, -0.5});
    Contour contour = Contour::create(some({0.1, -0.5}), chosen).value();
    for (const double isovalue : {-0.5, 0.1}) {
        const ContourResult found = contour.extract(isovalue).value();
        EXPECT_EQ(found.method, Method::direct);
        EXPECT_EQ(found.engine, "cpu");
        EXPECT_TRUE(bytes_of(found.surfaces[0].surface) == bytes_of_all(isovalue, chosen));
    }
    EXPECT_EQ(asked, 0);
}

TEST_F(ActiveInput, IsEnoughForGradientNormalsWithTheCellsAround) {
    ContourOptions chosen = options({0.1, -0.5});
    chosen.normals = Normals::gradient;
    Contour contour = Contour::create(some({0.1, -0.5}, true), chosen).value();
    for (const double isovalue : {-0.5, 0.1})
        EXPECT_TRUE(bytes_of(contour.extract(isovalue).value().surfaces[0].surface) == bytes_of_all(isovalue, chosen));
    EXPECT_EQ(asked, 0);
}

TEST_F(ActiveInput, IsCompletedForAnotherIsovalue) {
    const ContourOptions chosen = options({0.1});
    Contour contour = Contour::create(some({0.1}), chosen).value();
    for (const double isovalue : {0.3, 0.1, 0.4})
        EXPECT_TRUE(bytes_of(contour.extract(isovalue).value().surfaces[0].surface) == bytes_of_all(isovalue, chosen));
    EXPECT_EQ(asked, 1);
}

TEST_F(ActiveInput, HasTheRangeOfTheField) {
    Contour contour = Contour::create(some({0.1}), options({0.1})).value();
    const FieldReport found = contour.field().value(), wanted = Contour::create(all()).value().field().value();
    EXPECT_EQ(found.lower, wanted.lower);
    EXPECT_EQ(found.upper, wanted.upper);
    EXPECT_EQ(asked, 0);
}

TEST_F(ActiveInput, HasANumberOfEachCell) {
    for (const std::size_t count : {1, 10'000'000})
        for (const bool narrow : {false, true}) {
            ContourInput input = some({0.1});
            input.part->cell_numbers = narrow ? Array::own(std::vector<std::uint32_t>(input.grid.cells.count()))
                                              : Array::own(std::vector<std::uint64_t>(count));
            const auto contour = Contour::create(std::move(input), options({0.1}));
            ASSERT_FALSE(contour);
            EXPECT_EQ(contour.error().code, ErrorCode::invalid_argument);
        }
}

/// Of the cells `numbers` say which.
Array numbered(const Array& cells, const Array& numbers) {
    std::vector<std::int64_t> out;
    for (const std::int64_t cell : cells.as<std::int64_t>())
        out.push_back(static_cast<std::int64_t>(numbers.as<std::uint64_t>()[static_cast<std::size_t>(cell)]));
    return Array::own(std::move(out));
}

void expect_equal(const Array& found, const Array& wanted) {
    ASSERT_EQ(found.tuples(), wanted.tuples());
    ASSERT_GT(found.tuples(), 0);
    EXPECT_TRUE(std::ranges::equal(found.as<std::int64_t>(), wanted.as<std::int64_t>()));
}

/// Of a file some of whose cells were left out, say: none is missing for good.
TEST_F(ActiveInput, NumbersSourceCells) {
    std::vector<std::uint64_t> sevens(grid.cells.count());
    for (std::size_t cell = 0; cell < sevens.size(); ++cell) sevens[cell] = 7 * cell;
    const Array numbers = Array::own(std::move(sevens));
    ContourInput input = all();
    input.part = GridPart{{}, numbers};
    ContourOptions chosen;
    chosen.source_cells = true;
    for (const Method method : {Method::direct, Method::clusters}) {
        chosen.method = method;
        const auto plain = Contour::create(all(), chosen).value().extract(0.1).value();
        const auto found = Contour::create(input, chosen).value().extract(0.1).value();
        expect_equal(found.surfaces[0].surface.source_cells, numbered(plain.surfaces[0].surface.source_cells, numbers));
    }
    const SolidRange above{0.1};
    expect_equal(Solids::create(input, chosen).value().extract(above).value().surface.source_cells,
                 numbered(Solids::create(all(), chosen).value().extract(above).value().surface.source_cells, numbers));
    expect_equal(Clipper::create(input, chosen).value().clip(above).value().source_cells,
                 numbered(Clipper::create(all(), chosen).value().clip(above).value().source_cells, numbers));
    input.part->cell_numbers = Array::own(std::vector<std::uint64_t>(3));
    EXPECT_EQ(Clipper::create(input, chosen).error().code, ErrorCode::invalid_argument);
}

/// What surfaces carry of points is not read again.
TEST_F(ActiveInput, KeepsFieldsOfPointsWhenItIsCompleted) {
    std::vector<std::uint64_t> ones(grid.cells.count(), 1);
    ContourInput input = some({0.1});
    input.point_fields = {{"gyroid", field.values}};
    input.part->whole = [&](const isotet::Run&) {
        ContourInput out;
        out.grid = grid;
        out.cell_fields = {{"one", Array::own(std::move(ones))}};
        return Result<ContourInput>(std::move(out));
    };
    Contour contour = Contour::create(input, options({0.1})).value();
    const Surface surface = contour.extract(0.2).value().surfaces[0].surface;
    ASSERT_EQ(surface.point_fields.size(), 1);
    EXPECT_EQ(surface.point_fields[0].values.tuples(), surface.vertex_count());
    ASSERT_EQ(surface.cell_fields.size(), 1);
    EXPECT_EQ(surface.cell_fields[0].values.at(0), 1);
}

TEST_F(ActiveInput, IsCompletedForOptionsThatNeedAllCells) {
    std::vector<ContourOptions> each(6, options({0.1}));
    each[0].normals = Normals::gradient; // of which the input has not the cells around
    each[1].source_cells = true;         // of which the input has no numbers
    each[2].method = Method::clusters;
    each[3].expected_isovalues.clear();
    each[4].surfaces = 1000;
    each[5].engine = reference_engine();
    for (std::size_t i = 0; i < each.size(); ++i) {
        SCOPED_TRACE(i);
        asked = 0;
        Contour contour = Contour::create(some({0.1}), each[i]).value();
        const ContourResult found = contour.extract(0.1).value();
        EXPECT_TRUE(bytes_of(found.surfaces[0].surface) == bytes_of_all(0.1, each[i]));
        EXPECT_EQ(asked, 1);
    }
}

TEST_F(ActiveInput, CanFollowAnotherOneInASession) {
    const ContourOptions chosen = options({0.1});
    Contour contour = Contour::create(all(), chosen).value();
    ASSERT_TRUE(contour.extract(0.1));
    ASSERT_TRUE(contour.set(some({0.1}), chosen));
    EXPECT_TRUE(bytes_of(contour.extract(0.1).value().surfaces[0].surface) == bytes_of_all(0.1, chosen));
    EXPECT_EQ(asked, 0);
    ContourOptions packed = chosen;
    packed.method = Method::clusters;
    ASSERT_TRUE(contour.set(some({0.1}), packed));
    EXPECT_TRUE(bytes_of(contour.extract(0.2).value().surfaces[0].surface) == bytes_of_all(0.2, packed));
    EXPECT_EQ(asked, 1);
}

TEST_F(ActiveInput, IsCompletedAsItWasWhenAnotherGridIsSetMeanwhile) {
    // A point that no cell uses, far away in place and value: what is stored follows from cells that were left out.
    std::vector<double> points, values;
    for (std::size_t i = 0; i < grid.points.size(); ++i) points.push_back(grid.points.as<float>()[i]);
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) values.push_back(field.values.at(i) / 3);
    points.insert(points.end(), {1e9, 1e9, 1e9});
    values.push_back(1e30);
    grid.points = Array::own(std::move(points), 3);
    grid.point_fields.clear();
    field = field_of(std::move(values));
    const ContourOptions chosen = options({0.1});
    const std::string wanted = bytes_of_all(0.1, chosen);
    Contour contour = Contour::create(some({0.1}), chosen).value();
    EXPECT_TRUE(bytes_of(contour.extract(0.1).value().surfaces[0].surface) == wanted);
    ASSERT_EQ(asked, 1);

    const Grid other = make_grid({.shape = "kuhn", .side = 3, .fields = {"sphere"}}).value();
    ASSERT_TRUE(contour.set(some({0.1}), chosen));
    bool was_set = false;
    isotet::Run meanwhile; // as another thread would, while nothing is locked
    meanwhile.progress.report = [&](std::string_view, double) {
        if (std::exchange(was_set, true)) return;
        EXPECT_TRUE(contour.set({other, point_field(other), {}, {}}, chosen));
    };
    const auto found = contour.extract(0.1, meanwhile);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(was_set);
    EXPECT_TRUE(bytes_of(found->surfaces[0].surface) == wanted) << "of one grid, with the options of the other";
    EXPECT_TRUE(bytes_of(contour.extract(0.5).value().surfaces[0].surface) ==
                bytes_of(Contour::create({other, point_field(other), {}, {}}, chosen)
                             .value()
                             .extract(0.5)
                             .value()
                             .surfaces[0]
                             .surface));
}

TEST_F(ActiveInput, FiltersThatWereMovedFromAnswerPolitely) {
    auto filter = ActiveCellFilter::create(grid.points, field, std::vector<double>{0.1}, CellType::tetrahedron).value();
    const ActiveCellFilter other = std::move(filter);
    filter.add(0, grid.cells.connectivity); // NOLINT(bugprone-use-after-move): that is what is tested
    const auto cells = filter.finish();
    ASSERT_FALSE(cells);
    EXPECT_EQ(cells.error().code, ErrorCode::invalid_argument);
}

TEST_F(ActiveInput, PassesOnTheErrorOfReadingAll) {
    ContourInput input = some({0.1});
    input.part->whole = [](const isotet::Run&) -> Result<ContourInput> { return Error{ErrorCode::file, "gone"}; };
    Contour contour = Contour::create(input, options({0.1})).value();
    const auto failed = contour.extract(0.2);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::file);
    EXPECT_TRUE(contour.extract(0.1)); // the session stays usable
    ContourOptions gradients = options({0.1});
    gradients.normals = Normals::gradient;
    EXPECT_EQ(Contour::create(input, gradients).error().code, ErrorCode::file);
}

} // namespace
} // namespace isotet::test
