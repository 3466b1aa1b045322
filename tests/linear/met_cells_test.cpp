// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where isovalues are expected only the polyhedra that they meet are split: with the bytes of all.
#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "linear/polyhedral_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

PointField random_field(const Grid& grid, unsigned seed, bool ties) {
    std::mt19937 random(seed);
    std::vector<float> values(grid.points.tuples());
    for (float& value : values)
        value = ties ? static_cast<float>(random() % 5) : std::uniform_real_distribution<float>(0, 4)(random);
    return {"f", Array::own(std::move(values)), false, {}};
}

ContourInput input_of(const Grid& grid, const PointField& field) {
    std::vector<std::int32_t> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int32_t>(i);
    return {grid, field, {{"again", field.values}}, {{"number", Array::own(std::move(numbers))}}};
}

/// All surfaces, one after another; what the session tells of cells goes to `told`.
std::string surfaces_of(const ContourInput& input, const ContourOptions& options, const std::vector<double>& isovalues,
                        std::vector<std::string>* told = nullptr) {
    ContourResult result = Contour::create(input, options).value().extract(isovalues).value();
    if (told) *told = result.notes;
    std::string bytes;
    for (const Extraction& one : result.surfaces) bytes += bytes_of(one.surface);
    EXPECT_EQ(result.method, Method::direct);
    return bytes + std::to_string(result.field.lower) + " " + std::to_string(result.field.upper) + " " +
           std::to_string(result.field.no_data) + " " + std::to_string(result.field.infinite);
}

/// Of hexahedra, wedges and polyhedra with hanging points, in single precision.
Grid octree(unsigned seed) {
    Grid grid = octree_grid({.seed = seed});
    std::vector<float> places;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) places.push_back(static_cast<float>(grid.points.at(i, axis)));
    grid.points = Array::own(std::move(places), 3);
    return grid;
}

Grid foam() {
    MakeOptions options;
    options.shape = "kelvin";
    options.side = 6;
    options.fields = {};
    return make_grid(options).value();
}

TEST(MetCells, GiveTheSurfacesOfAll) {
    for (const Grid& grid : {foam(), octree(3), octree(9)}) {
        for (const bool ties : {false, true}) {
            const ContourInput input = input_of(grid, random_field(grid, 5, ties));
            for (const Normals normals : {Normals::none, Normals::face, Normals::vertex, Normals::gradient}) {
                for (const std::vector<double>& isovalues :
                     {std::vector<double>{2}, std::vector<double>{0.01}, std::vector<double>{0, 1, 2.5, 4},
                      std::vector<double>{-3, 70}}) {
                    ContourOptions options{.method = Method::direct, .surfaces = 4, .normals = normals};
                    options.source_cells = true;
                    options.edge_ends = normals != Normals::face;
                    const std::string all = surfaces_of(input, options, isovalues);
                    options.expected_isovalues = isovalues;
                    EXPECT_TRUE(surfaces_of(input, options, isovalues) == all) << ties << ' ' << isovalues[0];
                }
            }
        }
    }
}

/// In double precision, far from the origin.
Grid far_away(const Grid& grid) {
    std::vector<double> places;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            places.push_back(1000.1 * static_cast<double>(axis + 1) + grid.points.at(i, axis) / 3);
    Grid moved = grid;
    moved.points = Array::own(std::move(places), 3);
    return moved;
}

/// Values of a narrow range about `base`, which are rounded from there when they are stored.
PointField double_field(const Grid& grid, unsigned seed, double base) {
    std::mt19937 random(seed);
    std::vector<double> values(grid.points.tuples());
    for (double& value : values) value = base + std::uniform_real_distribution<double>(0, 4)(random);
    return {"f", Array::own(std::move(values)), false, {}};
}

bool were_chosen(const std::vector<std::string>& told) {
    return std::ranges::any_of(
        told, [](const std::string& note) { return note.find("matter to the isovalues") != std::string::npos; });
}

TEST(MetCells, GiveTheSurfacesOfAllInDoublePrecision) {
    for (const Grid& near : {foam(), octree(3), octree(9)}) {
        const Grid grid = far_away(near);
        for (const double base : {0.0, 300.0, -1e6}) {
            for (const double above : {0.002, 2.0, 3.99}) {
                const PointField field = double_field(grid, 7, base);
                ContourInput input = input_of(grid, field);
                input.point_fields.push_back(Field{"other", double_field(grid, 8, 7e4).values});
                ContourOptions options{.method = Method::direct, .surfaces = 1};
                options.source_cells = true;
                options.edge_ends = base != 300; // derived points have the numbers that they have among all
                const std::string all = surfaces_of(input, options, {base + above});
                options.expected_isovalues = {base + above};
                std::vector<std::string> told;
                EXPECT_TRUE(surfaces_of(input, options, {base + above}, &told) == all) << base << ' ' << above;
                EXPECT_TRUE(above > 1 || base < 0 || were_chosen(told)) << base << ": some need not be split";
            }
        }
    }
}

/// One face of each cell at a point takes the place of another one of as many corners.
void open_cells_at(Grid& grid, std::size_t point) {
    const core::CellReader cells = core::CellReader::open(grid).value();
    const core::FaceReader faces = core::FaceReader::open(grid.cells).value();
    std::vector<std::int64_t> stream;
    for (std::size_t i = 0; i < grid.cells.faces.size(); ++i) stream.push_back(static_cast<std::int64_t>(faces.at(i)));
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        bool has_it = false;
        for (std::uint64_t i = 0; i < cells.corners(cell); ++i) has_it |= cells.corner(cells.first(cell) + i) == point;
        if (!has_it) continue;
        std::map<std::int64_t, std::size_t> first_of_size;
        for (std::size_t at = faces.begin(cell) + 1; at < faces.end(cell);
             at += 1 + static_cast<std::size_t>(stream[at])) {
            const auto [known, is_new] = first_of_size.emplace(stream[at], at);
            if (is_new) continue;
            std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(known->second), stream[at] + 1,
                        stream.begin() + static_cast<std::ptrdiff_t>(at));
            break;
        }
    }
    grid.cells.faces = Array::own(std::move(stream));
}

TEST(MetCells, OpenOnesDoNotDecideHowOthersAreStored) {
    Grid grid = far_away(foam());
    std::vector<double> places(grid.points.as<double>().begin(), grid.points.as<double>().end());
    places[3 * 5] += 500; // alone at the end of the range
    grid.points = Array::own(std::move(places), 3);
    open_cells_at(grid, 5);
    ContourOptions options{.method = Method::direct, .surfaces = 1};
    const ContourInput input = input_of(grid, double_field(grid, 3, 300));
    const std::string all = surfaces_of(input, options, {300.05});
    options.expected_isovalues = {300.05};
    std::vector<std::string> told;
    EXPECT_TRUE(surfaces_of(input, options, {300.05}, &told) == all);
    EXPECT_FALSE(were_chosen(told));
}

TEST(MetCells, AreThoseOnly) {
    MakeOptions options;
    options.shape = "kelvin";
    options.side = 8;
    options.fields = {"sphere"};
    const Grid grid = make_grid(options).value();
    const PointField field = find_field(grid, "sphere").value();
    ContourOptions expecting{.method = Method::direct, .surfaces = 1};
    expecting.expected_isovalues = {0.5};
    Contour session = Contour::create({grid, field, {}, {}}, expecting).value();
    const ContourResult result = session.extract(0.5).value();
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_NE(result.notes[0].find("of 1024 polyhedra matter to the isovalues"), std::string::npos) << result.notes[0];
    EXPECT_LT(session.linear_grid()->grid.cells.count(), 22u * 300);

    ContourOptions around = expecting; // gradients need cells at the points of those
    around.normals = Normals::gradient;
    Contour beside = Contour::create({grid, field, {}, {}}, around).value();
    ASSERT_TRUE(beside.extract(0.5));
    EXPECT_GT(beside.linear_grid()->grid.cells.count(), session.linear_grid()->grid.cells.count());
    EXPECT_LT(beside.linear_grid()->grid.cells.count(), 22u * 800);

    const ContourResult other = session.extract(0.7).value(); // one that was not expected
    EXPECT_EQ(session.linear_grid()->grid.cells.count(), 22u * 1024);
    expecting.expected_isovalues.clear();
    const std::string all =
        bytes_of(Contour::create({grid, field, {}, {}}, expecting).value().extract(0.7).value().surfaces[0].surface);
    EXPECT_TRUE(bytes_of(other.surfaces[0].surface) == all);
}

TEST(MetCells, FollowAnotherFieldAndPackingTakesAll) {
    const Grid grid = octree(4);
    ContourOptions options{.surfaces = 2};
    options.expected_isovalues = {2, 3};
    Contour session = Contour::create(input_of(grid, random_field(grid, 1, false)), options).value();
    const ContourInput next = input_of(grid, random_field(grid, 2, true));
    ASSERT_TRUE(session.extract(2));
    EXPECT_EQ(session.set(next).value(), ContourUpdate::grid);
    const std::string second = bytes_of(session.extract(3).value().surfaces[0].surface);
    options.expected_isovalues.clear();
    EXPECT_TRUE(second == bytes_of(Contour::create(next, options).value().extract(3).value().surfaces[0].surface));

    options.method = Method::clusters;
    EXPECT_EQ(session.set(next, options).value(), ContourUpdate::grid);
    const ContourResult packed = session.extract(3).value();
    EXPECT_EQ(packed.method, Method::clusters);
    EXPECT_TRUE(bytes_of(packed.surfaces[0].surface) ==
                bytes_of(Contour::create(next, options).value().extract(3).value().surfaces[0].surface));
}

TEST(MetCells, AreNotChosenWhereOthersDecide) {
    const Grid grid = octree(4);
    const auto splits_all = [&](PointField field, ContourOptions options) {
        options.method = Method::direct;
        options.surfaces = 1;
        options.expected_isovalues = {2};
        std::vector<std::string> told;
        surfaces_of({grid, std::move(field), {}, {}}, options, {2}, &told);
        return told.size() == 1 && told[0].find("matter to") == std::string::npos;
    };
    std::vector<float> x;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) x.push_back(static_cast<float>(grid.points.at(i, 0)));
    const PointField field{"x", Array::own(std::move(x)), false, {}};
    EXPECT_FALSE(splits_all(field, {}));
    EXPECT_FALSE(splits_all(field, {.normals = Normals::face}));
    EXPECT_FALSE(splits_all(field, {.edge_ends = true}));
    std::vector<std::int32_t> integers(grid.points.tuples(), 1);
    EXPECT_TRUE(splits_all({"f", Array::own(std::move(integers)), false, {}}, {})) << "rounded by the range of all";
    std::vector<float> tiny(grid.points.tuples(), 1e-35F);
    EXPECT_TRUE(splits_all({"f", Array::own(std::move(tiny)), false, {}}, {})) << "scaled by the range of all";
}

TEST(MetCells, KeepThoseWithoutData) {
    const Grid grid = foam();
    PointField field = random_field(grid, 3, false);
    std::vector<float> values(field.values.as<float>().begin(), field.values.as<float>().end());
    for (std::size_t i = 0; i < values.size(); i += 7) values[i] = i % 2 ? NAN : -INFINITY;
    field.values = Array::own(std::move(values));
    ContourOptions options{.method = Method::direct, .surfaces = 1};
    const std::string all = surfaces_of(input_of(grid, field), options, {2});
    options.expected_isovalues = {2};
    EXPECT_TRUE(surfaces_of(input_of(grid, field), options, {2}) == all);
}

TEST(MetCells, NeedOneValueAPoint) {
    const Grid grid = octree_grid({.seed = 4});
    const Array few = Array::own(std::vector<float>(3));
    EXPECT_EQ(linearize(grid, {.isovalues = {1}, .values = few}).error().code, ErrorCode::invalid_argument);
}

TEST(DerivedPoints, InsidePolyhedraHaveNoValueOutsideTheirCorners) {
    const Grid grid = octree_grid({.seed = 3});
    const LinearGrid linear = linearize(grid).value();
    const auto first = linear.derived.first.as<std::uint64_t>(), points = linear.derived.points.as<std::uint64_t>();
    const Array values = random_field(grid, 8, false).values, longer = linear.extend(values).value();
    for (std::uint64_t row = 0; row < linear.derived.count(); ++row) {
        double lower = INFINITY, upper = -INFINITY;
        for (std::uint64_t i = first[row]; i < first[row + 1]; ++i) {
            lower = std::min(lower, values.at(points[i]));
            upper = std::max(upper, values.at(points[i]));
        }
        ASSERT_GE(longer.at(linear.user_points + row), lower);
        ASSERT_LE(longer.at(linear.user_points + row), upper);
    }
}

} // namespace
} // namespace isotet::test
