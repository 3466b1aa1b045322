// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets that are cut while they are drawn give the pictures of the surface that extraction makes; also where the device
// has no room for them.
#include "render/drawing.hpp"

#include <string>

#include <isotet/draw_tets.hpp>
#include <isotet/paper/search.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

class TetPictures : public Drawing {
protected:
    void SetUp() override {
        Drawing::SetUp();
        options_.camera = camera_of(View::iso);
        options_.camera.fit(scene_.bounds, 1);
        options_.samples = 1;
        grid_ = made_grid("kuhn", 12, {"gyroid"});
        packed_ = pack(grid_, point_field(grid_), {.split_cells = true, .gradients = true}).value();
    }

    /// With less memory for buffers.
    void reopen_with(std::uint64_t memory_limit) {
        renderer_.reset();
        device_.reset();
        reopen(watched(), memory_limit);
        device_.emplace(shared_context());
        renderer_.emplace(Renderer::create(*device_).value());
    }

    /// What extraction gives, from the CPU engine.
    Picture expected(double isovalue, Normals normals, double opacity) {
        ExtractOptions options;
        options.normals = normals;
        scene_.surfaces.clear();
        add(extract(packed_, isovalue, options).value().surface, color_, opacity);
        return draw();
    }
    Picture drawn(const TetSurface& tets, double opacity) {
        scene_.surfaces = {{.color = color_, .opacity = opacity, .tets = &tets}};
        return draw();
    }
    /// Rounding moves vertices by a little: pixels at edges may differ.
    static void expect_alike(const Picture& one, const Picture& other) {
        std::size_t differing = 0, seen = 0;
        for (std::size_t i = 0; i < one.pixels.size(); ++i) {
            differing += difference(one.pixels[i], other.pixels[i]) > 8;
            seen += one.pixels[i] != Pixel{255, 255, 255, 255};
        }
        EXPECT_GT(seen, one.pixels.size() / 10) << "something is seen";
        EXPECT_LT(differing, one.pixels.size() / 200);
    }

    Grid grid_;
    PackedGrid packed_;
    Color color_{0.2F, 0.5F, 0.8F, 1};
};

TEST_F(TetPictures, AreThoseOfTheExtractedSurface) {
    for (const double opacity : {1.0, 0.4}) {
        const Picture clusters = expected(0.1, Normals::none, opacity);
        for (const DrawMethod method : all_draw_methods) {
            SCOPED_TRACE(std::string(name_of(method)));
            TetStore store = TetStore::upload(*device_, packed_, method).value();
            const TetSurface all = store.at(0.1).value();
            expect_alike(drawn(all, opacity), clusters);
            EXPECT_LT(renderer_->work().uploaded_bytes, 2'000'000u) << "parameters, and once the corners of quads";
            TetIndex index = TetIndex::create(packed_, SearchIndex::span_space).value();
            const TetSurface some = store.at(0.1, index.find(0.1).value()).value();
            EXPECT_LT(some.tets(), all.tets());
            expect_alike(drawn(some, opacity), clusters);
            EXPECT_LT(renderer_->work().uploaded_bytes, 1000u) << "parameters only";
        }
    }
}

TEST_F(TetPictures, AreShadedByGradients) {
    const Picture smooth = expected(0.1, Normals::gradient, 1), flat = expected(0.1, Normals::none, 1);
    for (const DrawMethod method : {DrawMethod::textures, DrawMethod::mesh}) {
        TetStore store = TetStore::upload(*device_, packed_, method, {.gradients = true, .picture_bytes = {}}).value();
        const TetSurface tets = store.at(0.1).value();
        expect_alike(drawn(tets, 1), smooth);
    }
    std::size_t differing = 0;
    for (std::size_t i = 0; i < flat.pixels.size(); ++i) differing += difference(smooth.pixels[i], flat.pixels[i]) > 8;
    EXPECT_GT(differing, flat.pixels.size() / 50) << "faces would look otherwise";
}

TEST_F(TetPictures, SeveralSurfacesAndMeshesShareAPicture) {
    TetStore store = TetStore::upload(*device_, packed_, DrawMethod::textures).value();
    const TetSurface low = store.at(-0.3).value(), high = store.at(0.4).value();
    ExtractOptions options;
    scene_.surfaces.clear();
    add(extract(packed_, -0.3, options).value().surface, color_, 0.5);
    add(extract(packed_, 0.4, options).value().surface, color_);
    const Picture clusters = draw();
    scene_.surfaces = {{.color = color_, .opacity = 0.5, .tets = &low}, {.color = color_, .tets = &high}};
    expect_alike(draw(), clusters);
    scene_.surfaces = {{.color = color_, .opacity = 0.5, .tets = &low},
                       {.mesh = meshes_.back().get(), .color = color_}};
    expect_alike(draw(), clusters);
}

/// Three pages, of which the device has room for all, for the first, for none.
TEST_F(TetPictures, AreTheSameWhereTheDeviceHasNoRoomForAllTets) {
    grid_ = made_grid("kuhn", 29, {"gyroid"});
    packed_ = pack(grid_, point_field(grid_), {.split_cells = true, .gradients = true}).value();
    constexpr std::uint64_t page = 65'536 * 64, mega = 1'000'000;
    const std::uint64_t all_bytes = packed_.report().tets * 64;
    ASSERT_GT(all_bytes, 2 * page + mega / 2);
    ASSERT_LT(all_bytes, 3 * page);
    std::optional<Picture> opaque, translucent;
    for (const std::uint64_t pages_there : {3, 1, 0}) {
        SCOPED_TRACE(pages_there);
        const bool has_room = pages_there == 3;
        reopen_with(has_room ? 0
                             : (1 + pages_there) * page + 6 * mega + mega / 2); // with room for the page that is sent
        TetStore store = TetStore::upload(*device_, packed_, DrawMethod::registers_instanced,
                                          {.gradients = false, .picture_bytes = 6 * mega})
                             .value();
        const std::uint64_t elsewhere = has_room ? 0 : all_bytes - pages_there * page;
        EXPECT_EQ(store.report().host_bytes, elsewhere);
        EXPECT_EQ(store.report().device_bytes + elsewhere, all_bytes);
        const TetSurface all = store.at(0.1).value();
        EXPECT_EQ(all.bytes_per_picture(), elsewhere);
        for (auto* known : {&opaque, &translucent}) {
            const Picture picture = drawn(all, known == &opaque ? 1 : 0.4);
            EXPECT_GE(renderer_->work().uploaded_bytes, elsewhere);
            EXPECT_LT(renderer_->work().uploaded_bytes, 2 * elsewhere + 2 * mega)
                << "twice where fragments had no room";
            if (!*known) *known = picture;
            EXPECT_TRUE(picture.pixels == (*known)->pixels);
        }
        // Of a page in which no tet is wanted nothing is sent.
        const std::vector<std::uint32_t> list{70'000, 65'536};
        const TetSurface two = store.at(0.1, list).value();
        EXPECT_EQ(two.bytes_per_picture(), has_room ? 0 : page);
        EXPECT_LE(two.triangles().value().size(), 4u);
        EXPECT_TRUE(all.triangles().value().size() == extract(packed_, 0.1).value().surface.triangle_count());
    }
    expect_alike(*opaque, expected(0.1, Normals::none, 1));
}

TEST_F(TetPictures, NoRoomForOnePageIsAnErrorThatSaysSo) {
    reopen_with(2'000'000);
    const auto store = TetStore::upload(*device_, packed_, DrawMethod::registers);
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().code, ErrorCode::out_of_memory);
    EXPECT_NE(store.error().message.find("one page of tets"), std::string::npos) << store.error().message;
    EXPECT_TRUE(TetStore::upload(*device_, packed_, DrawMethod::textures)) << "that has room";
}

TEST_F(TetPictures, OfAFieldAreRefused) {
    TetStore store = TetStore::upload(*device_, packed_, DrawMethod::textures).value();
    const TetSurface tets = store.at(0.1).value();
    const DeviceColors colors =
        DeviceColors::of_grid(*device_, packed_, point_field(grid_).values, Association::point, {}).value();
    scene_.surfaces = {{.colors = &colors, .tets = &tets}};
    EXPECT_NE(renderer_->draw(scene_, options_).error().message.find("a field cannot colour them"), std::string::npos);
    scene_.surfaces = {{.opacity = 2, .tets = &tets}};
    EXPECT_NE(renderer_->draw(scene_, options_).error().message.find("an opacity of 2"), std::string::npos);
}

} // namespace
} // namespace isotet::test
