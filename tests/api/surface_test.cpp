// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a surface can carry: fields, normals, edge ends, source cells; each only when asked for.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/engine.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/small_grid.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

PackedGrid packed_with_everything(const Grid& grid) {
    PackOptions options;
    options.gradients = options.source_cells = true;
    return pack(grid, point_field(grid), options).value();
}

TEST(Surface, HasVerticesInTheTypeOfThePointsAlsoAroundTheOrigin) {
    Grid grid = make_grid({.shape = "kuhn", .side = 4, .fields = {"sphere"}}).value(); // from -1 to 1
    const auto single = grid.points.as<float>();
    const Array points[] = {grid.points, Array::own(std::vector<double>(single.begin(), single.end()), 3)};
    const double isovalues[] = {0.5, 99};
    for (const Array& array : points) {
        grid.points = array;
        const PackedGrid packed = pack(grid, point_field(grid)).value();
        for (const auto& found : {extract(packed, isovalues).value(), extract_by_reference(packed, isovalues).value(),
                                  extract_direct(grid, point_field(grid), isovalues).value().surfaces,
                                  extract_direct_by_reference(grid, point_field(grid), isovalues).value().surfaces})
            for (const Extraction& extraction : found) {
                EXPECT_EQ(extraction.surface.positions.type(), array.type());
                EXPECT_EQ(extraction.surface.positions.components(), 3U);
            }
    }
}

TEST(Surface, CarriesOnlyWhatWasAskedFor) {
    const Grid grid = made_grid("mixed", 5, {"sphere"});
    const PackedGrid packed = packed_with_everything(grid);
    const Surface plain = extract(packed, 0.6).value().surface;
    EXPECT_GT(plain.vertex_count(), 0u);
    EXPECT_TRUE(plain.normals.empty() && plain.edge_ends.empty() && plain.edge_weights.empty() &&
                plain.source_cells.empty());
    EXPECT_TRUE(plain.point_fields.empty() && plain.cell_fields.empty());
    EXPECT_EQ(plain.normals_kind, Normals::none);
    ExtractOptions options;
    options.point_fields = grid.point_fields; // needs edge ends inside, which stay there
    EXPECT_TRUE(extract(packed, 0.6, options).value().surface.edge_ends.empty());
}

TEST(Surface, CarriesPointFieldsOfEveryTypeInterpolated) {
    const Grid grid = made_grid("kuhn", 5, {"sphere"});
    const std::size_t points = grid.points.tuples();
    std::vector<double> pressure;
    std::vector<std::int16_t> steps;
    std::vector<float> position;
    for (std::size_t p = 0; p < points; ++p) {
        const double x = grid.points.at(p, 0);
        pressure.push_back(101325 + x);
        steps.push_back(static_cast<std::int16_t>(std::lround(10 * x)));
        for (std::size_t axis = 0; axis < 3; ++axis) position.push_back(static_cast<float>(grid.points.at(p, axis)));
    }
    ExtractOptions options;
    options.point_fields = {
        {"pressure", Array::own(pressure)}, {"steps", Array::own(steps)}, {"position", Array::own(position, 3)}};
    const Surface surface = extract(packed_with_everything(grid), 0.6, options).value().surface;
    ASSERT_EQ(surface.point_fields.size(), 3u);
    EXPECT_EQ(surface.point_fields[2].values.components(), 3u);
    EXPECT_EQ(surface.point_fields[0].values.type(), ScalarType::float64);
    EXPECT_EQ(surface.point_fields[1].values.type(), ScalarType::float64);
    EXPECT_EQ(surface.point_fields[2].values.type(), ScalarType::float32);
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto place = position_of(surface, v);
        const Field& carried = surface.point_fields[0];
        EXPECT_NEAR(carried.values.at(v), 101325 + place[0], 1e-6);
        EXPECT_NEAR(surface.point_fields[1].values.at(v), 10 * place[0], 1e-5);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(surface.point_fields[2].values.at(v, axis), place[axis], 1e-6);
    }
}

TEST(Surface, CarriesNaNOfAPointFieldAsTheCanonicalNaN) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const PackedGrid packed = pack(grid, field_of<float>({1, 0, 0, 0})).value();
    ExtractOptions options;
    options.edge_ends = true;
    options.point_fields = {{"f", Array::own(std::vector<float>{5, 7, std::bit_cast<float>(0xff801234u), 9})}};
    const Surface surface = extract(packed, 0.5, options).value().surface;
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const float value = surface.point_fields[0].values.as<float>()[v];
        const std::int64_t below = ends_of(surface, v).first;
        if (below == 2) {
            EXPECT_EQ(std::bit_cast<std::uint32_t>(value), 0x7fc00000u);
        } else {
            EXPECT_EQ(value, below == 1 ? 6 : 7);
        }
    }
}

TEST(Surface, CopiesCellFieldsInTheirOwnType) {
    Grid grid = made_grid("mixed", 4, {"plane"});
    const std::size_t cells = grid.cells.count();
    std::vector<std::uint8_t> block;
    std::vector<std::int64_t> number;
    std::vector<double> pair;
    for (std::size_t c = 0; c < cells; ++c) {
        block.push_back(static_cast<std::uint8_t>(c % 251));
        number.push_back((std::int64_t{1} << 60) + static_cast<std::int64_t>(c));
        pair.insert(pair.end(), {static_cast<double>(c), -0.1});
    }
    ExtractOptions options;
    options.source_cells = true;
    options.cell_fields = {{"block", Array::own(block)}, {"number", Array::own(number)}, {"pair", Array::own(pair, 2)}};
    const Surface surface = extract(packed_with_everything(grid), 0.1, options).value().surface;
    const auto source = surface.source_cells.as<std::int64_t>();
    ASSERT_GT(surface.triangle_count(), 0u);
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        const auto cell = static_cast<std::size_t>(source[t]);
        ASSERT_LT(cell, cells);
        EXPECT_EQ(surface.cell_fields[0].values.as<std::uint8_t>()[t], block[cell]);
        EXPECT_EQ(surface.cell_fields[1].values.as<std::int64_t>()[t], number[cell]);
        EXPECT_EQ(surface.cell_fields[2].values.as<double>()[2 * t + 1], -0.1);
    }
}

TEST(Surface, HasTrianglesInsideTheirSourceCells) {
    const Grid grid = made_grid("hex", 6, {"gyroid"});
    ExtractOptions options;
    options.source_cells = true;
    const Surface surface = extract(packed_with_everything(grid), 0.2, options).value().surface;
    const auto source = surface.source_cells.as<std::int64_t>();
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        std::array<double, 3> lower{2, 2, 2}, upper{-2, -2, -2};
        for (std::size_t k = 0; k < 8; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto corner =
                    static_cast<std::size_t>(grid.cells.connectivity.at(8 * static_cast<std::size_t>(source[t]) + k));
                lower[axis] = std::min(lower[axis], grid.points.at(corner, axis));
                upper[axis] = std::max(upper[axis], grid.points.at(corner, axis));
            }
        for (const std::size_t v : corners_of(surface, t))
            for (std::size_t axis = 0; axis < 3; ++axis) {
                ASSERT_GE(position_of(surface, v)[axis], lower[axis] - 1e-6);
                ASSERT_LE(position_of(surface, v)[axis], upper[axis] + 1e-6);
            }
    }
}

TEST(Surface, CanBeGivenALaterFieldByItsEdgeEnds) {
    const Grid grid = made_grid("perturbed", 6, {"sphere", "gyroid"});
    ExtractOptions options;
    options.edge_ends = true;
    options.point_fields = {grid.point_fields[1]};
    const Surface surface = extract(packed_with_everything(grid), 0.6, options).value().surface;
    const auto gyroid = grid.point_fields[1].values.as<float>();
    const auto weights = surface.edge_weights.as<float>();
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto [below, above] = ends_of(surface, v);
        const float a = gyroid[static_cast<std::size_t>(below)], b = gyroid[static_cast<std::size_t>(above)];
        EXPECT_NEAR(surface.point_fields[0].values.as<float>()[v], a + weights[v] * (b - a), 1e-6);
    }
}

TEST(GradientNormals, FallBackOnTheFirstTriangleWhereTheGradientCancels) {
    // A peak in the middle of an octahedron: the gradients of the eight tets around it cancel.
    const Grid grid =
        tet_grid({{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, {{0, 1, 3, 5},
                                                                                                    {0, 3, 2, 5},
                                                                                                    {0, 2, 4, 5},
                                                                                                    {0, 4, 1, 5},
                                                                                                    {0, 3, 1, 6},
                                                                                                    {0, 2, 3, 6},
                                                                                                    {0, 4, 2, 6},
                                                                                                    {0, 1, 4, 6}});
    PackOptions pack_options;
    pack_options.gradients = true;
    const PackedGrid packed = pack(grid, field_of<float>({1, 0, 0, 0, 0, 0, 0}), pack_options).value();
    ExtractOptions gradient, face;
    gradient.normals = Normals::gradient;
    face.normals = Normals::face;
    const Surface surface = extract(packed, 0.5, gradient).value().surface,
                  faces = extract(packed, 0.5, face).value().surface;
    ASSERT_EQ(surface.triangle_count(), 8u);
    ASSERT_EQ(surface.vertex_count(), 6u);
    std::vector<bool> seen(6, false);
    for (std::size_t t = 0; t < 8; ++t)
        for (const std::size_t v : corners_of(surface, t)) {
            if (seen[v]) continue;
            seen[v] = true;
            for (std::size_t axis = 0; axis < 3; ++axis)
                EXPECT_EQ(surface.normals.at(v, axis), faces.normals.at(t, axis));
        }
}

TEST(VertexNormals, AreTheMeanOfTheFacesAroundWhateverExtracts) {
    const Grid grid = made_grid("mixed", 6, {"gyroid"});
    ExtractOptions options;
    options.normals = Normals::vertex;
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const double isovalue = 0.2;
    const DirectOptions direct{options};
    for (const Surface& surface :
         {extract(packed, isovalue, options).value().surface,
          extract_by_reference(packed, std::span(&isovalue, 1), options).value()[0].surface,
          extract_direct(grid, point_field(grid), std::span(&isovalue, 1), direct).value().surfaces[0].surface}) {
        ASSERT_GT(surface.vertex_count(), 100u);
        EXPECT_EQ(surface.normals_kind, Normals::vertex);
        const Array expected = vertex_normals(surface).value();
        ASSERT_EQ(surface.normals.bytes(), expected.bytes());
        EXPECT_EQ(std::memcmp(surface.normals.data(), expected.data(), expected.bytes()), 0);
    }
}

TEST(Extraction, NeedsTheGridNoLonger) {
    PackedGrid packed;
    {
        const Grid grid = made_grid("kuhn", 6, {"sphere"});
        packed = pack(grid, point_field(grid)).value();
    }
    EXPECT_GT(extract(packed, 0.5).value().surface.triangle_count(), 100u);
    EXPECT_EQ(extract(packed, 0.5).value().report.false_ties, 0u);
}

} // namespace
} // namespace isotet::test
