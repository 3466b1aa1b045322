// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's pentagonal and hexagonal prisms: the surfaces of the same cells given by their faces, closed beside others.
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pack.hpp>

#include "linear/polyhedral_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

constexpr std::uint8_t pentagonal = 15, hexagonal = 16, wedge = 13, hexahedron = 12;

enum class Given { as_prisms, by_faces, both };

CellFaces faces_of_prism(const std::vector<std::int64_t>& points) {
    const std::size_t n = points.size() / 2;
    CellFaces faces(2);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t next = (i + 1) % n;
        faces[0].push_back(points[i]);
        faces[1].push_back(points[n + i]);
        faces.push_back({points[i], points[next], points[n + next], points[n + i]});
    }
    return faces;
}

/// Layers of a honeycomb whose columns stay whole, or are cut into hexahedra, or into a pentagonal prism and a wedge.
struct Honeycomb {
    Given given = Given::as_prisms;
    unsigned seed = 1;
    int side = 4, layers = 3;
    double moved = 0.05;

    Grid make() const {
        std::mt19937 random(seed), choice(seed + 1);
        std::map<std::array<int, 3>, std::int64_t> numbers;
        std::vector<std::array<int, 3>> places;
        const auto number = [&](int x, int y, int z) {
            const auto [known, is_new] = numbers.try_emplace({x, y, z}, static_cast<std::int64_t>(places.size()));
            if (is_new) places.push_back({x, y, z});
            return known->second;
        };
        PolyhedronList list;
        const auto add = [&](const std::vector<std::array<int, 2>>& polygon, int layer) {
            std::vector<std::int64_t> points;
            for (const int z : {layer, layer + 1})
                for (const auto& [x, y] : polygon) points.push_back(number(x, y, z));
            const bool listed = given == Given::by_faces || (given == Given::both && choice() % 2);
            if (polygon.size() > 4 && listed) return list.add(disordered(faces_of_prism(points), choice));
            constexpr std::uint8_t types[] = {wedge, hexahedron, pentagonal, hexagonal};
            list.add_linear(types[polygon.size() - 3], points);
        };
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                const int x = 2 * column + row % 2, y = row;
                const std::vector<std::array<int, 2>> hexagon{{x, y},         {x + 1, y},     {x + 2, y},
                                                              {x + 2, y + 1}, {x + 1, y + 1}, {x, y + 1}};
                const auto part = [&](std::initializer_list<std::size_t> corners) {
                    std::vector<std::array<int, 2>> out;
                    for (const std::size_t corner : corners) out.push_back(hexagon[corner]);
                    return out;
                };
                const unsigned cut = random() % 4;
                for (int layer = 0; layer < layers; ++layer) {
                    if (cut == 0) {
                        add(part({0, 1, 2, 3}), layer);
                        add(part({0, 3, 4, 5}), layer);
                    } else if (cut == 1) {
                        add(part({0, 1, 2, 3, 4}), layer);
                        add(part({4, 5, 0}), layer);
                    } else {
                        add(hexagon, layer);
                    }
                }
            }
        std::uniform_real_distribution<double> shift(-moved, moved);
        std::vector<double> points;
        for (const auto& [x, y, z] : places) {
            points.push_back(x + shift(random));
            points.push_back(y + ((x - y) % 2 ? -1.0 / 6 : 1.0 / 6) + shift(random));
            points.push_back(z + shift(random));
        }
        Grid grid;
        grid.points = Array::own(std::move(points), 3);
        grid.cells = list.cells();
        if (given == Given::as_prisms) grid.cells.faces = grid.cells.face_offsets = {};
        std::vector<std::int32_t> of_cells(grid.cells.count());
        for (std::size_t i = 0; i < of_cells.size(); ++i) of_cells[i] = static_cast<std::int32_t>(i % 11);
        grid.cell_fields = {{"number", Array::own(std::move(of_cells))}};
        return grid;
    }
};

PointField random_numbers(const Grid& grid, unsigned seed, unsigned count, double no_data = 0) {
    std::mt19937 random(seed);
    std::vector<float> values(grid.points.tuples());
    for (float& value : values) {
        value = static_cast<float>(random() % count);
        if (random() % 1000 < 1000 * no_data) value = std::numeric_limits<float>::quiet_NaN();
    }
    return {"value", Array::own(std::move(values)), false, {}};
}

ContourResult contoured_prisms(const Grid& grid, const PointField& field, double isovalue,
                               ContourOptions options = {}) {
    options.source_cells = true;
    const ContourInput input{grid, field, {{"again", field.values}}, grid.cell_fields};
    return Contour::create(input, options).value().extract(isovalue).value();
}

std::string bytes_of_prisms(const Grid& grid, const PointField& field, double isovalue, ContourOptions options = {}) {
    return bytes_of(contoured_prisms(grid, field, isovalue, options).surfaces[0].surface);
}

TEST(Prisms, GiveTheSurfaceOfTheSameCellsByFaces) {
    const Grid prisms = Honeycomb().make(), faces = Honeycomb{.given = Given::by_faces}.make();
    for (const double no_data : {0.0, 0.05})
        for (const unsigned values : {2u, 1000u}) {
            const PointField field = random_numbers(prisms, 3, values, no_data);
            const double isovalue = values / 2.0;
            for (const Method method : {Method::clusters, Method::direct})
                for (const Normals normals : {Normals::none, Normals::gradient}) {
                    const ContourOptions options{.method = method, .normals = normals, .edge_ends = true};
                    EXPECT_TRUE(bytes_of_prisms(prisms, field, isovalue, options) ==
                                bytes_of_prisms(faces, field, isovalue, options));
                }
        }
    EXPECT_EQ(contoured_prisms(prisms, random_numbers(prisms, 3, 5), 2).cells_left_out, 0u);
}

TEST(Prisms, LeaveNoHoleBesideOtherCells) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const Grid grid = Honeycomb{.given = Given::both, .seed = seed}.make();
        for (const bool split_cells : {false, true})
            for (const unsigned values : {2u, 4u}) {
                const PointField field = random_numbers(grid, seed, values);
                ContourOptions options{.split_cells = split_cells};
                options.edge_ends = true;
                const auto result = contoured_prisms(grid, field, 1, options);
                const CheckOptions against{.grid = &grid, .field = &field, .split_cells = split_cells};
                const SurfaceReport found = check(result.surfaces[0].surface, against).value();
                ASSERT_TRUE(found.sound) << "seed " << seed << ": "
                                         << (found.findings.empty() ? "" : found.findings[0].what);
            }
    }
}

TEST(Prisms, AreCountedByTypeAndFillTheirSpace) {
    const Grid grid = Honeycomb{.moved = 0}.make();
    const GridReport report = survey(grid).value();
    EXPECT_GT(report.cells_by_type.at(pentagonal), 0u);
    EXPECT_GT(report.cells_by_type.at(hexagonal), 0u);
    EXPECT_EQ(report.cells_left_out, 0u);
    EXPECT_EQ(report.inverted_tets, 0u);
    const std::vector<double> volumes = relative_volumes(grid).value();
    double sum = 0;
    for (const double volume : volumes) sum += volume / 6;
    EXPECT_NEAR(sum, 4 * 4 * 3 * 2, 1e-9) << "a hexagon has the area of two squares";
    const LinearizeReport split = linearize(grid).value().report;
    EXPECT_EQ(split.polyhedra, report.cells_by_type.at(pentagonal) + report.cells_by_type.at(hexagonal));
    EXPECT_EQ(split.centred, split.polyhedra);
    EXPECT_EQ(split.folded + split.open, 0u);
    EXPECT_TRUE(has_cells_to_linearize(grid.cells));
    EXPECT_TRUE(Contour::contours(pentagonal) && Contour::contours(hexagonal));
    EXPECT_GT(boundary_of(grid).value().triangle_count(), 0u);
}

TEST(Prisms, AreSplitOnlyWhereAnIsovalueMeetsThem) {
    const Grid grid = Honeycomb{.side = 6}.make();
    const PointField field = random_numbers(grid, 2, 3);
    ContourOptions options{.method = Method::direct, .surfaces = 1};
    const std::string all = bytes_of_prisms(grid, field, 1.5, options);
    options.expected_isovalues = {1.5};
    EXPECT_TRUE(bytes_of_prisms(grid, field, 1.5, options) == all);
    PointField high = field;
    std::vector<float> values(grid.points.tuples());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(grid.points.at(i, 2));
    high.values = Array::own(std::move(values));
    const auto met = linearize(grid, {.isovalues = {0.5}, .values = high.values}).value().report;
    EXPECT_GT(met.unmet, 0u);
    EXPECT_GT(met.centred, 0u);
}

TEST(Prisms, AverageCellFieldsAndKeepTheirOwnValues) {
    const Grid prisms = Honeycomb().make(), faces = Honeycomb{.given = Given::by_faces}.make();
    for (const bool own : {false, true}) {
        FindFieldOptions options;
        options.keep_cell_values = own;
        const PointField field = find_field(prisms, "number", options).value(),
                         same = find_field(faces, "number", options).value();
        EXPECT_TRUE(bytes_of_prisms(prisms, field, 4.5) == bytes_of_prisms(faces, same, 4.5)) << own;
    }
}

TEST(Prisms, FollowPointNumbers) {
    Grid prisms = Honeycomb().make(), faces = Honeycomb{.given = Given::by_faces}.make();
    std::vector<std::int64_t> numbers(prisms.points.tuples());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int64_t>(7 * (numbers.size() - i));
    prisms.point_numbers = faces.point_numbers = Array::own(numbers);
    const PointField field = random_numbers(prisms, 4, 9);
    EXPECT_TRUE(bytes_of_prisms(prisms, field, 4.5) == bytes_of_prisms(faces, field, 4.5));
}

TEST(Prisms, AreJoinedByMergedPoints) {
    Grid grid = Honeycomb{.given = Given::both}.make();
    const std::size_t count = grid.points.tuples();
    std::vector<double> points(grid.points.as<double>().begin(), grid.points.as<double>().end());
    points.insert(points.end(), grid.points.as<double>().begin(), grid.points.as<double>().end());
    std::vector<std::int64_t> corners(grid.cells.connectivity.as<std::int64_t>().begin(),
                                      grid.cells.connectivity.as<std::int64_t>().end());
    const auto offsets = grid.cells.offsets.as<std::int64_t>();
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell)
        if (cell % 2 && grid.cells.types.at(cell) != 42)
            for (std::int64_t i = offsets[cell]; i < offsets[cell + 1]; ++i)
                corners[static_cast<std::size_t>(i)] += static_cast<std::int64_t>(count);
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    const auto joined = merge_points(grid);
    ASSERT_TRUE(joined) << joined.error().message;
    EXPECT_GT(joined->merged, 0u);
    const PointField field = random_numbers(grid, 4, 3);
    ContourOptions options;
    options.edge_ends = true;
    const auto result = contoured_prisms(joined->grid, field, 1.5, options);
    CheckOptions against;
    against.grid = &joined->grid;
    against.field = &field;
    const SurfaceReport found = check(result.surfaces[0].surface, against).value();
    EXPECT_TRUE(found.sound) << (found.findings.empty() ? "" : found.findings[0].what);
}

TEST(Prisms, OfRepeatedPointsAreTheShapeThatIsLeft) {
    Grid grid = Honeycomb{.side = 1, .layers = 1, .moved = 0}.make();
    const auto made_of = [&](std::uint8_t type, const std::vector<std::int64_t>& points) {
        PolyhedronList list;
        list.add_linear(type, points);
        grid.cells = list.cells();
        grid.cells.faces = grid.cells.face_offsets = {};
        grid.cell_fields.clear();
        return linearize(grid);
    };
    ASSERT_EQ(grid.points.tuples(), 12u);
    const auto box = made_of(pentagonal, {0, 1, 2, 3, 3, 6, 7, 8, 9, 9});
    EXPECT_EQ(box->report.known_shapes, 1u) << "a hexahedron";
    EXPECT_EQ(box->grid.cells.types.at(0), hexahedron);
    EXPECT_EQ(made_of(hexagonal, {0, 1, 2, 3, 3, 3, 6, 7, 8, 9, 9, 9})->report.known_shapes, 1u);
    const auto flat = made_of(pentagonal, {0, 1, 1, 0, 0, 0, 1, 1, 0, 0});
    ASSERT_FALSE(flat);
    EXPECT_NE(flat.error().message.find("do not close"), std::string::npos) << flat.error().message;
}

TEST(Prisms, ThatAreBrokenAreErrors) {
    const auto error_of = [](std::uint8_t type, const std::vector<std::int64_t>& points, double first_x = 0) {
        std::vector<double> places(36, 0);
        places[0] = first_x;
        PolyhedronList list;
        list.add_linear(type, points);
        Grid grid;
        grid.points = Array::own(std::move(places), 3);
        grid.cells = list.cells();
        grid.cells.faces = grid.cells.face_offsets = {};
        const auto linear = linearize(grid);
        EXPECT_EQ(survey(grid).error().message, linear.error().message);
        return linear.error().message;
    };
    EXPECT_EQ(error_of(pentagonal, {0, 1, 2, 3, 4, 5, 6, 7, 8}),
              "cells[0] (pentagonal prism) has 9 corners, but must have 10");
    EXPECT_EQ(error_of(hexagonal, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 0}),
              "cells[0] (hexagonal prism) has 13 corners, but must have 12");
    EXPECT_EQ(error_of(hexagonal, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12}),
              "cells[0] (hexagonal prism) has point 12, but the grid has 12 points");
    EXPECT_EQ(error_of(hexagonal, {0, 1, 2, 3, 4, -5, 6, 7, 8, 9, 10, 11}),
              "cells[0] (hexagonal prism) has point -5, but the grid has 12 points");
    EXPECT_EQ(error_of(pentagonal, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, NAN),
              "points[0] has x coordinate nan, but cells use the point, and coordinates must be finite and below 2^91");
}

TEST(Prisms, AreRefusedByPackingWithTheNameOfWhatHelps) {
    Grid grid = Honeycomb{.side = 1, .layers = 1}.make();
    PolyhedronList list;
    list.add_linear(hexagonal, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
    grid.cells = list.cells();
    grid.cells.faces = grid.cells.face_offsets = {};
    grid.cell_fields.clear();
    const auto packed = pack(grid, random_numbers(grid, 1, 2));
    ASSERT_FALSE(packed);
    EXPECT_NE(packed.error().message.find("linearize()"), std::string::npos) << packed.error().message;
}

} // namespace
} // namespace isotet::test
