// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Joined surfaces are the surfaces, one after another, with what all of them carry.
#include <algorithm>

#include <gtest/gtest.h>

#include "check/made_surface.hpp"

namespace {

using namespace isotet;
using namespace isotet::test;

template <class T>
std::vector<T> values(const Array& array) {
    const auto all = array.as<T>();
    return {all.begin(), all.end()};
}

Field field(const std::string& name, std::vector<float> values) { return {name, Array::own(std::move(values))}; }

TEST(JoinSurfaces, PutsOneAfterAnotherAndMovesNumbers) {
    const Surface joined = join({surface_of(square()), surface_of(octahedron())}, {0.5, 2});
    EXPECT_EQ(joined.vertex_count(), 10u);
    EXPECT_EQ(joined.triangle_count(), 10u);
    EXPECT_EQ(joined.triangles.type(), ScalarType::uint32);
    EXPECT_EQ(joined.triangles.at(2, 0), 4);
    EXPECT_EQ(joined.positions.at(4, 0), 1);
    ASSERT_EQ(joined.cell_fields.size(), 1u);
    EXPECT_EQ(joined.cell_fields[0].name, "isovalue");
    EXPECT_EQ(values<double>(joined.cell_fields[0].values), (std::vector<double>{0.5, 0.5, 2, 2, 2, 2, 2, 2, 2, 2}));
    EXPECT_EQ(check(joined).value().components, 2u);
}

TEST(JoinSurfaces, DropsFieldsThatNotAllHave) {
    Surface a = surface_of(square()), b = surface_of(square());
    a.point_fields = {field("p", {1, 2, 3, 4}), field("only a", {0, 0, 0, 0})};
    b.point_fields = {field("only b", {0, 0, 0, 0}), field("p", {5, 6, 7, 8})};
    a.source_cells = Array::own(std::vector<std::int64_t>{7, 8});
    const Surface joined = join({a, b}, {});
    ASSERT_EQ(joined.point_fields.size(), 1u);
    EXPECT_EQ(joined.point_fields[0].name, "p");
    EXPECT_EQ(values<float>(joined.point_fields[0].values), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_TRUE(joined.source_cells.empty());
    EXPECT_TRUE(joined.cell_fields.empty());
}

TEST(JoinSurfaces, WidensFieldsOfDifferentTypes) {
    Surface a = surface_of(square()), b = surface_of(square());
    a.point_fields = {field("same", {1, 2, 3, 4}), field("other", {1, 2, 3, 4})};
    b.point_fields = {field("same", {5, 6, 7, 8}), {"other", Array::own(std::vector<double>{0.1, 6, 7, 8})}};
    const Surface joined = join({a, b}, {});
    ASSERT_EQ(joined.point_fields.size(), 2u);
    EXPECT_EQ(joined.point_fields[0].values.type(), ScalarType::float32);
    EXPECT_EQ(values<double>(joined.point_fields[1].values), (std::vector<double>{1, 2, 3, 4, 0.1, 6, 7, 8}));
}

TEST(JoinSurfaces, LetsEmptySurfacesDecideNothing) {
    Surface a = surface_of(square());
    a.point_fields = {field("p", {1, 2, 3, 4})};
    a.edge_ends = Array::own(std::vector<std::int64_t>(8), 2);
    const Surface joined = join({Surface{}, a, Surface{}}, {1, 2, 3});
    EXPECT_EQ(joined.point_fields.size(), 1u);
    EXPECT_EQ(joined.edge_ends.tuples(), 4u);
    EXPECT_EQ(joined.positions.type(), a.positions.type());
    EXPECT_EQ(values<double>(joined.cell_fields.at(0).values), (std::vector<double>{2, 2}));
}

TEST(JoinSurfaces, WidensPositionsOfDifferentTypes) {
    Surface a = surface_of(square()), b = surface_of(square());
    b.positions =
        Array::own(std::vector<double>{4000000.1, 0, 0, 4000001.1, 0, 0, 4000001.1, 1, 0, 4000000.1, 1, 0}, 3);
    const Surface joined = join({a, b}, {});
    EXPECT_EQ(joined.positions.type(),
              a.positions.type() == ScalarType::float64 ? a.positions.type() : ScalarType::float64);
    EXPECT_EQ(joined.positions.at(5, 0), 4000001.1);
}

TEST(JoinSurfaces, KeepsNormalsOnlyOfOneKind) {
    Surface a = surface_of(square()), b = surface_of(square());
    a.normals_kind = b.normals_kind = Normals::face;
    a.normals = b.normals = Array::own(std::vector<float>{0, 0, 1, 0, 0, 1}, 3);
    EXPECT_EQ(join({a, b}, {}).normals.tuples(), 4u);
    EXPECT_EQ(join({a, b}, {}).normals_kind, Normals::face);
    b.normals_kind = Normals::none;
    b.normals = {};
    EXPECT_EQ(join({a, b}, {}).normals_kind, Normals::none);
    EXPECT_TRUE(join({a, b}, {}).normals.empty());
}

TEST(JoinSurfaces, MakesAnEmptySurfaceOfNothing) {
    EXPECT_EQ(join({}, {}).vertex_count(), 0u);
    EXPECT_TRUE(check(join({Surface{}, Surface{}}, {1, 2})).value().clean);
}

} // namespace
