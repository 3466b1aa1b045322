// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page is sent of a surface: places, normals, colours, previews.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>

#include "view/mesh.hpp"
#include "view/messages.hpp"

namespace isotet::test {
namespace {

using namespace view;

Surface sphere_surface(std::uint64_t side, double radius, const char* carried = nullptr) {
    MakeOptions options;
    options.shape = "kuhn";
    options.side = side;
    options.fields = {"sphere", "gyroid"};
    const Grid grid = make_grid(options).value();
    const PointField field = find_field(grid, "sphere").value();
    DirectOptions direct;
    if (carried) direct.extract.point_fields = {{carried, find_field(grid, carried).value().values}};
    auto made = extract_direct(grid, field, std::vector<double>{radius}, direct).value();
    return made.surfaces.front().surface;
}

std::array<double, 3> vertex_place(const Mesh& mesh, std::size_t i) {
    std::array<double, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] = mesh.box.lower[axis] +
                      mesh.vertices[i].place[axis] / 65535.0 * (mesh.box.upper[axis] - mesh.box.lower[axis]);
    return place;
}

double length(const std::array<double, 3>& p) { return std::hypot(p[0], p[1], p[2]); }

TEST(MeshOf, KeepsPlacesToA65535thOfTheBox) {
    const Surface surface = sphere_surface(16, 0.6);
    const Mesh mesh = mesh_of(surface, nullptr).value();
    ASSERT_EQ(mesh.vertices.size(), surface.vertex_count());
    ASSERT_EQ(mesh.triangle_count(), surface.triangle_count());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(vertex_place(mesh, i)[axis], surface.positions.at(i, axis), 1.2 / 65535);
}

TEST(MeshOf, NormalsOfASpherePointOutwards) {
    const Mesh mesh = mesh_of(sphere_surface(20, 0.7), nullptr).value();
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const auto [u, v] = mesh.vertices[i].normal;
        std::array<double, 3> n{u / 127.0, v / 127.0, 0};
        n[2] = 1 - std::abs(n[0]) - std::abs(n[1]);
        if (n[2] < 0) {
            const double x = n[0];
            n[0] = (1 - std::abs(n[1])) * (x < 0 ? -1 : 1);
            n[1] = (1 - std::abs(x)) * (v < 0 ? -1 : 1);
        }
        const auto p = vertex_place(mesh, i);
        const double cosine = (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) / length(n) / length(p);
        EXPECT_GT(cosine, 0.95);
    }
}

TEST(MeshOf, LeavesOutTrianglesWithVerticesThatAreNotFinite) {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, NAN, 0, 0, 0, INFINITY, 0}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 1, 3, 1, 2, 4}, 3);
    const auto mesh = mesh_of(surface, nullptr);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh->box.upper, (std::array<double, 3>{1, 1, 0}));
}

TEST(MeshOf, AnEmptySurfaceIsAnEmptyMesh) {
    const auto mesh = mesh_of(sphere_surface(4, 99), nullptr);
    ASSERT_TRUE(mesh);
    EXPECT_TRUE(mesh->vertices.empty());
    EXPECT_TRUE(mesh->box.empty());
    EXPECT_TRUE(preview_of(*mesh, 10).corners.empty());
}

TEST(MeshOf, ColoursAreTheValuesPlacesInTheMap) {
    const Surface surface = sphere_surface(12, 0.7, "gyroid");
    SurfaceColors colors{surface.point_fields.front().values, Association::point, {}};
    colors.scale.lower = -1.5;
    colors.scale.upper = 1.5;
    const Mesh mesh = mesh_of(surface, &colors).value();
    ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.colors.size(); ++i)
        EXPECT_NEAR(mesh.colors[i] / 65534.0, (colors.values.at(i) + 1.5) / 3, 1e-4);
}

TEST(MeshOf, NoDataHasAPlaceOfItsOwnAndTheEndsAreWithin) {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2}, 3);
    const SurfaceColors colors{Array::own(std::vector<float>{NAN, -5, 7}), Association::point, {}};
    EXPECT_EQ(mesh_of(surface, &colors)->colors, (std::vector<std::uint16_t>{no_data_place, 0, max_map_place}));
}

TEST(MeshOf, CellColoursGiveEachTriangleItsOwn) {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}, 3);
    const SurfaceColors colors{Array::own(std::vector<float>{0, 1}), Association::cell, {}};
    const Mesh mesh = mesh_of(surface, &colors).value();
    EXPECT_TRUE(mesh.flat);
    EXPECT_EQ(mesh.vertices.size(), 6U);
    EXPECT_EQ(mesh.colors, (std::vector<std::uint16_t>{0, 0, 0, max_map_place, max_map_place, max_map_place}));
}

TEST(PreviewOf, HasAboutAsManyTrianglesAsAskedForAndStaysASphere) {
    const Mesh mesh = mesh_of(sphere_surface(48, 0.8), nullptr).value();
    for (const std::size_t wanted : {2000U, 8000U}) {
        const Mesh preview = preview_of(mesh, wanted);
        EXPECT_GT(preview.triangle_count(), wanted / 2);
        EXPECT_LT(preview.triangle_count(), wanted * 2);
        for (std::size_t i = 0; i < preview.vertices.size(); ++i)
            EXPECT_NEAR(length(vertex_place(preview, i)), 0.8, 0.02);
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (std::size_t i = 0; i < preview.corners.size(); i += 3)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = preview.corners[i + k], b = preview.corners[i + (k + 1) % 3];
                EXPECT_NE(a, b);
                ASSERT_LT(a, preview.vertices.size());
                edges.emplace(a, b);
            }
        std::size_t open = 0;
        for (const auto& [a, b] : edges) open += edges.contains({b, a}) ? 0 : 1;
        EXPECT_EQ(open, 0U) << "a closed surface has become open";
    }
}

TEST(PreviewOf, IsTheMeshItselfWhereThatIsSmall) {
    const Mesh mesh = mesh_of(sphere_surface(8, 0.7), nullptr).value();
    EXPECT_EQ(preview_of(mesh, 1'000'000).corners, mesh.corners);
}

TEST(AddMesh, PlacesAreMultiplesOfEightAndHoldTheArrays) {
    Mesh mesh = mesh_of(sphere_surface(8, 0.7), nullptr).value();
    mesh.colors.assign(mesh.vertices.size(), 7);
    Blocks blocks;
    blocks.add(std::vector<char>(3, 'x'));
    const MeshPlaces places = add_mesh(mesh, blocks);
    EXPECT_FALSE(places.wide);
    for (const std::size_t at : {places.vertices, places.corners, places.colors.value()}) EXPECT_EQ(at % 8, 0U);
    std::uint16_t corner = 0;
    std::memcpy(&corner, blocks.bytes().data() + places.corners + 2, 2);
    EXPECT_EQ(corner, mesh.corners[1]);
    EXPECT_EQ(std::memcmp(blocks.bytes().data() + places.vertices, mesh.vertices.data(), 8 * mesh.vertices.size()), 0);
}

TEST(FrameBytes, BlocksBeginAtAMultipleOfEightBehindTheHead) {
    const Mesh mesh = mesh_of(sphere_surface(6, 0.7), nullptr).value();
    for (const char* key : {"a", "ab", "abc", "abcd", "abcde", "abcdef", "abcdefg", "abcdefgh"}) {
        FrameFacts facts;
        facts.number = 3;
        const std::string bytes = frame_bytes(facts, {{key, 0.5, {}, &mesh, 9}, {"known", 1, {}, nullptr, 4}});
        ASSERT_EQ(bytes.substr(0, 4), "isof");
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 4, 4);
        const auto head = parse_json(bytes.substr(8, length));
        ASSERT_TRUE(head);
        const Json& surfaces = (*head)["surfaces"];
        EXPECT_FALSE(surfaces[1].contains("mesh"));
        const std::size_t at = (8 + length + 7) / 8 * 8 + surfaces[0]["mesh"]["vertices_at"].get<std::size_t>();
        EXPECT_EQ(std::memcmp(bytes.data() + at, mesh.vertices.data(), 8 * mesh.vertices.size()), 0);
    }
}

} // namespace
} // namespace isotet::test
