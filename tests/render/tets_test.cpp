// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets that are cut while they are drawn: what stores take, and the triangles of every method against the reference
// engine.
#include "render/drawing.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <string>

#include <isotet/draw_tets.hpp>
#include <isotet/paper/search.hpp>

#include "support/engines.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using Triangles = std::vector<std::array<std::array<double, 3>, 3>>;

/// Neither order nor orientation: corners ascending, triangles ascending.
Triangles as_set(Triangles triangles) {
    for (auto& triangle : triangles) std::ranges::sort(triangle);
    std::ranges::sort(triangles);
    return triangles;
}

/// Without triangles of which two corners lie in one place.
Triangles reference_triangles(const PackedGrid& packed, double isovalue) {
    const Surface surface = extract_on(Engine::reference, packed, isovalue).value().surface;
    Triangles triangles;
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        std::array<std::array<double, 3>, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto vertex = static_cast<std::size_t>(surface.triangles.at(t, k));
                triangle[k][axis] = surface.positions.at(vertex, axis);
            }
        const bool flat = triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
        if (!flat) triangles.push_back(triangle);
    }
    return as_set(std::move(triangles));
}

class Tets : public Drawing {
protected:
    void reopen_with(const vulkan::Settings& settings) {
        renderer_.reset();
        device_.reset();
        reopen(settings);
        device_.emplace(shared_context());
        renderer_.emplace(Renderer::create(*device_).value());
    }

    /// With all tets, and with the list of every index.
    void expect_reference_triangles(const PackedGrid& packed, const std::vector<double>& isovalues) {
        std::vector<TetStore> stores;
        for (const DrawMethod method : all_draw_methods)
            stores.push_back(TetStore::upload(*device_, packed, method).value());
        for (const double isovalue : isovalues) {
            SCOPED_TRACE(isovalue);
            const Triangles expected = reference_triangles(packed, isovalue);
            for (std::size_t m = 0; m < stores.size(); ++m) {
                SCOPED_TRACE(std::string(name_of(all_draw_methods[m])));
                const TetSurface all = stores[m].at(isovalue).value();
                EXPECT_EQ(all.tets(), packed.report().tets);
                EXPECT_EQ(all.sent_bytes(), 0u);
                ASSERT_TRUE(as_set(all.triangles().value()) == expected);
                const SearchIndex index =
                    all_search_indexes[static_cast<std::size_t>(indexes_asked_++) % all_search_indexes.size()];
                SCOPED_TRACE(std::string(name_of(index)));
                TetIndex candidates = TetIndex::create(packed, index).value();
                const std::span<const std::uint32_t> list = candidates.find(isovalue).value();
                const TetSurface some = stores[m].at(isovalue, list).value();
                EXPECT_EQ(some.tets(), list.size());
                EXPECT_EQ(some.sent_bytes(), 4 * list.size());
                ASSERT_TRUE(as_set(some.triangles().value()) == expected);
            }
        }
    }

private:
    int indexes_asked_ = 0;
};

TEST_F(Tets, StoresTakeWhatThePaperSays) {
    EXPECT_EQ(tet_store_bytes(DrawMethod::registers, 1000, 300, false), 4u * 68 * 1000);
    EXPECT_EQ(tet_store_bytes(DrawMethod::registers_instanced, 1000, 300, false), 64u * 1000);
    const std::uint64_t tables = 4 * (8 * 4 + 6 * 2);
    EXPECT_EQ(tet_store_bytes(DrawMethod::textures, 1000, 300, false), 16u * 1000 + 16 * 300 + tables);
    EXPECT_EQ(tet_store_bytes(DrawMethod::textures, 1000, 300, true), 16u * 1000 + 32 * 300 + tables);
    EXPECT_EQ(tet_store_bytes(DrawMethod::mesh, 1000, 300, true), 16u * 1000 + 32 * 300 + tables + 8 * 32)
        << "32 groups";
    const Grid grid = made_grid("mixed", 8, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true, .gradients = true}).value();
    const std::uint64_t tets = packed.report().tets, points = packed.report().points;
    for (const DrawMethod method : all_draw_methods)
        for (const bool gradients : {false, true}) {
            if (gradients && method != DrawMethod::textures && method != DrawMethod::mesh) continue;
            const std::uint64_t before = device_->memory_used();
            const TetStoreOptions options{.gradients = gradients, .picture_bytes = {}};
            const TetStore store = TetStore::upload(*device_, packed, method, options).value();
            EXPECT_EQ(store.report().stored_bytes, tet_store_bytes(method, tets, points, gradients)) << name_of(method);
            EXPECT_EQ(store.report().device_bytes, store.report().stored_bytes);
            const std::uint64_t taken = device_->memory_used() - before;
            EXPECT_GE(taken, store.report().stored_bytes);
            EXPECT_LT(taken, store.report().stored_bytes + 2048) << "a few bytes a buffer more";
        }
}

/// {below, tied, above, no data}^4.
TEST_F(Tets, AllCasesOfOneTetAgreeWithTheReference) {
    std::vector<std::array<double, 3>> points;
    std::vector<Corners> tets;
    std::vector<float> values;
    const float choices[4] = {-1.5F, 0.25F, 1, std::numeric_limits<float>::quiet_NaN()};
    for (int index = 0; index < 256; ++index) {
        const auto first = static_cast<std::int64_t>(points.size());
        const double x = 2 * (index % 16), y = 2 * (index / 16);
        for (const auto& [dx, dy, dz] : {std::array{0.0, 0.0, 0.0}, {1.0, 0.1, 0.0}, {0.2, 1.0, 0.0}, {0.3, 0.2, 1.0}})
            points.push_back({x + dx, y + dy, dz});
        for (int k = 0; k < 4; ++k) values.push_back(choices[index >> (2 * k) & 3]);
        tets.push_back({first, first + 1, first + 2, first + 3});
    }
    const PackedGrid packed = pack(tet_grid(points, tets), field_of(values)).value();
    // Two a tet with two corners above and two below; one a tet with both kinds otherwise, or with three ties and one
    // below.
    ASSERT_EQ(reference_triangles(packed, 0.25).size(), 2u * 6 + 44 + 4);
    expect_reference_triangles(packed, {0.25, 0.3, 0.2});
}

TEST_F(Tets, TrianglesOfNastyGridsAgreeWithTheReference) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        const NastyGrid g = nasty_grid(seed, {.side = 5,
                                              .values = seed % 3 ? static_cast<int>(2 + seed % 4) : 0,
                                              .no_data = seed % 2 ? 0.1 : 0,
                                              .missing = 0.2,
                                              .inverted = 0.1,
                                              .mirrored = 0.3,
                                              .repeated = 0.1,
                                              .wide = seed % 2 == 0});
        expect_reference_triangles(pack(g.grid, g.field, {.split_cells = true}).value(), {0, 1, 0.5});
    }
}

/// As on a graphics card, where a forgotten copy would show.
TEST_F(Tets, TrianglesAgreeWhereTheProcessorDoesNotReachTheDevice) {
    vulkan::Settings settings = watched();
    settings.force_staging = true;
    reopen_with(settings);
    const Grid grid = made_grid("mixed", 6, {"gyroid"});
    expect_reference_triangles(pack(grid, point_field(grid), {.split_cells = true}).value(), {0.1, -0.4});
}

TEST_F(Tets, NoListedTetGivesNothing) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    TetStore store = TetStore::upload(*device_, packed, DrawMethod::textures).value();
    const TetSurface none = store.at(0.1, {}).value();
    EXPECT_EQ(none.tets(), 0u);
    EXPECT_TRUE(none.triangles().value().empty());
}

TEST_F(Tets, SurfacesOutliveTheirStore) {
    const Grid grid = made_grid("kuhn", 4, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    std::optional<TetStore> store = TetStore::upload(*device_, packed, DrawMethod::registers).value();
    const TetSurface surface = store->at(0.1).value();
    store.reset();
    EXPECT_TRUE(as_set(surface.triangles().value()) == reference_triangles(packed, 0.1));
}

TEST_F(Tets, HaveMethodsWithNames) {
    for (const DrawMethod method : all_draw_methods) EXPECT_EQ(parse_draw_method(name_of(method)), method);
    EXPECT_EQ(parse_draw_method("clusters"), std::nullopt);
    EXPECT_EQ(parse_draw_method(""), std::nullopt);
}

TEST_F(Tets, MeshShadersAreAskedOfDevicesThatHaveThemOnly) {
    vulkan::Settings settings = watched();
    settings.alter_capabilities = [](vulkan::Capabilities& capabilities) { capabilities.mesh_shaders = false; };
    reopen_with(settings);
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    const auto without = TetStore::upload(*device_, packed, DrawMethod::mesh);
    ASSERT_FALSE(without);
    EXPECT_EQ(without.error().code, ErrorCode::no_device);
    EXPECT_NE(without.error().message.find("has no mesh shaders (VK_EXT_mesh_shader)"), std::string::npos)
        << without.error().message;
    TetStore textures = TetStore::upload(*device_, packed, DrawMethod::textures).value();
    const TetSurface tets = textures.at(0.1).value();
    scene_.surfaces = {{.tets = &tets}};
    EXPECT_TRUE(renderer_->draw(scene_, options_)) << "all else is as ever";
}

TEST_F(Tets, WhatCannotBeIsRefused) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    const auto error = [&](const PackedGrid& of, DrawMethod method, const TetStoreOptions& options) {
        const auto store = TetStore::upload(*device_, of, method, options);
        return store ? std::string() : store.error().message;
    };
    EXPECT_EQ(error(packed, DrawMethod::textures, {.gradients = true, .picture_bytes = {}}),
              "shading by gradients needs a grid that was packed with gradients");
    EXPECT_EQ(error(packed, DrawMethod::registers, {.gradients = true, .picture_bytes = {}}),
              "the method registers was asked for gradients, but only textures and mesh keep them");
    PackOptions in_double;
    in_double.precision = Precision::float64;
    EXPECT_NE(error(pack(grid, point_field(grid), in_double).value(), DrawMethod::textures, {}), "");
    TetStore store = TetStore::upload(*device_, packed, DrawMethod::textures).value();
    EXPECT_EQ(store.at(INFINITY).error().message, "the isovalue is inf, but must be finite");
    ASSERT_EQ(packed.report().tets, 162u);
    const std::vector<std::uint32_t> list{0, 162};
    EXPECT_EQ(store.at(0.1, list).error().message, "tet 162 shall be drawn, but the grid has 162 tets");
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    EXPECT_EQ(TetStore::upload(*device_, packed, DrawMethod::textures, {}, {.progress = progress}).error().code,
              ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::test
