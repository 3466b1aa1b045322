// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Frames of a grid: what is sent, what is not sent again, directly and from the packed grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/make.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/read.hpp>

#include "linear/curved_grid.hpp"
#include "support/temporary_folder.hpp"
#include "view/frame_reader.hpp"
#include "view/grid_view.hpp"

namespace isotet::test {
namespace {

using namespace view;

Grid made_grid(std::uint64_t side) {
    MakeOptions options;
    options.shape = "kuhn";
    options.side = side;
    options.fields = {"sphere", "gyroid"};
    Grid grid = make_grid(options).value();
    std::vector<float> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i % 7);
    grid.cell_fields.push_back({"seventh", Array::own(std::move(numbers))});
    std::vector<float> vectors(3 * grid.points.tuples(), 2);
    grid.point_fields.push_back({"v", Array::own(std::move(vectors), 3)});
    return grid;
}

ShowMessage show(std::uint64_t number, std::vector<double> isovalues, bool moving = false) {
    ShowMessage message;
    message.number = number;
    message.state.field = "sphere";
    message.state.isovalues = std::move(isovalues);
    message.moving = moving;
    return message;
}

GridViewOptions small_previews() {
    GridViewOptions options;
    options.preview_triangles = 500;
    return options;
}

class GridViewTest : public testing::Test {
protected:
    std::unique_ptr<GridView> view_ = GridView::create(made_grid(12), small_previews()).value();
    std::vector<std::string> known_;

    Json frame(const ShowMessage& message) {
        auto made = view_->frame(message, 0, known_, {});
        if (!made) throw std::runtime_error(made.error().message);
        return head_of(made->bytes);
    }
};

TEST_F(GridViewTest, OffersScalarsMagnitudesAndComponents) {
    std::vector<std::string> names;
    for (const OfferedField& field : view_->fields()) names.push_back(field.name);
    EXPECT_EQ(names, (std::vector<std::string>{"sphere", "gyroid", "v:mag", "v:x", "v:y", "v:z", "seventh"}));
    EXPECT_EQ(view_->fields().back().association, Association::cell);
}

TEST(OfferedFields, HaveTheMagnitudeOfComponents) {
    Grid grid;
    for (const char* name : {"vx", "vy", "vz"}) grid.point_fields.push_back({name, Array::own(std::vector<float>{1})});
    std::vector<std::string> names;
    for (const OfferedField& field : offered_fields(grid)) names.push_back(field.name);
    EXPECT_EQ(names, (std::vector<std::string>{"vx", "vy", "vz", "v:mag"}));
    grid.point_fields.clear();
    for (const char* name : {"U:x", "U:y", "U:z", "U:mag"}) // as packed files have them
        grid.point_fields.push_back({name, Array::own(std::vector<float>{1})});
    names.clear();
    for (const OfferedField& field : offered_fields(grid)) names.push_back(field.name);
    EXPECT_EQ(names, (std::vector<std::string>{"U:x", "U:y", "U:z", "U:mag"}));
}

TEST_F(GridViewTest, TheFirstSurfaceIsDirectAndThePackedGridGivesTheSame) {
    const Json direct = frame(show(1, {0.7}));
    EXPECT_EQ(direct["method"], "direct");
    ASSERT_TRUE(view_->pack("sphere", {}));
    known_.clear();
    frame(show(2, {0.5}));
    known_.clear();
    const Json packed = frame(show(3, {0.7}));
    EXPECT_EQ(packed["method"], "clusters");
    EXPECT_EQ(packed["surfaces"][0]["triangles"], direct["surfaces"][0]["triangles"]);
    EXPECT_GT(packed["surfaces"][0]["triangles"], 100);
}

TEST_F(GridViewTest, WhatThePageHasIsNotSentAgain) {
    Json head = frame(show(1, {0.7, 0.4}));
    EXPECT_TRUE(head["surfaces"][0].contains("mesh"));
    EXPECT_TRUE(head["surfaces"][1].contains("mesh"));
    head = frame(show(2, {0.6, 0.4}));
    EXPECT_TRUE(head["surfaces"][0].contains("mesh"));
    EXPECT_FALSE(head["surfaces"][1].contains("mesh")) << "the pinned surface is there already";
    known_.clear();
    head = frame(show(3, {0.6, 0.4}));
    EXPECT_TRUE(head["surfaces"][1].contains("mesh")) << "a new connection has nothing";
}

TEST_F(GridViewTest, AMovingHandGetsAPreviewAndTheRestAllOfIt) {
    Json head = frame(show(1, {0.8}, true));
    EXPECT_EQ(head["preview"], true);
    EXPECT_LT(head["surfaces"][0]["mesh"]["triangles"], head["surfaces"][0]["triangles"]);
    head = frame(show(2, {0.8}, false));
    EXPECT_EQ(head["preview"], false);
    EXPECT_EQ(head["surfaces"][0]["mesh"]["triangles"], head["surfaces"][0]["triangles"]);
    head = frame(show(3, {0.8}, true));
    EXPECT_EQ(head["preview"], false) << "the page has it in full";
    EXPECT_FALSE(head["surfaces"][0].contains("mesh"));
}

TEST_F(GridViewTest, ColoursFollowPointAndCellFieldsAndTheirRange) {
    ShowMessage message = show(1, {0.7});
    message.state.color_by = "gyroid";
    Json head = frame(message);
    EXPECT_TRUE(head["surfaces"][0]["mesh"].contains("colors_at"));
    EXPECT_LT(head["scale"]["lower"], -1.0);
    message.state.color_by = "seventh";
    head = frame(message);
    EXPECT_FALSE(head["surfaces"][0]["mesh"].contains("corners_at")) << "triangles of a cell field share no vertices";
    EXPECT_EQ(head["scale"]["classes"].size(), 7) << "few whole numbers have a colour each";
    EXPECT_EQ(head["scale"]["classes"][2]["name"], "2");
    message.state.range = ValueRange{1, 2};
    head = frame(message);
    EXPECT_EQ(head["scale"]["upper"], 2.0);
    EXPECT_FALSE(head["scale"].contains("classes"));
    message.state.range = ValueRange{-1, 2};
    message.state.logarithmic = true;
    EXPECT_FALSE(view_->frame(message, 0, known_, {}));
}

TEST_F(GridViewTest, TheBoundaryIsColouredAndStandsAlone) {
    ShowMessage message = show(1, {0.7});
    message.state.isosurfaces = false;
    message.state.colored_boundary = true;
    message.state.boundary = 1;
    message.state.color_by = "gyroid";
    EXPECT_TRUE(frame(message)["surfaces"].empty()) << "it is not found yet";
    ASSERT_TRUE(view_->find_boundary({}));
    Json head = frame(message);
    ASSERT_EQ(head["surfaces"].size(), 1);
    EXPECT_EQ(head["surfaces"][0]["kind"], "boundary");
    EXPECT_EQ(head["surfaces"][0]["triangles"], 12 * 12 * 12);
    EXPECT_TRUE(head["surfaces"][0]["mesh"].contains("colors_at"));
    EXPECT_FALSE(frame(message)["surfaces"][0].contains("mesh")) << "the page has it";
    message.state.color_by = "seventh";
    head = frame(message);
    EXPECT_TRUE(head["surfaces"][0]["mesh"].contains("colors_at"));
    EXPECT_FALSE(head["surfaces"][0]["mesh"].contains("corners_at"));
    message.state.colored_boundary = false;
    head = frame(message);
    EXPECT_FALSE(head["surfaces"][0]["mesh"].contains("colors_at"));
    message.state.isosurfaces = true;
    EXPECT_EQ(frame(message)["surfaces"].size(), 2);
}

/// The boundary of quadratic cells has points that the grid does not have.
TEST(GridViewQuadraticCells, TellTheFieldsAtEveryPointOfTheBoundary) {
    const auto linear = [](const At& p) { return p[0] + 2 * p[1] - p[2] + 5; };
    for (const unsigned seed : {1u, 2u, 3u}) {
        Grid grid = curved_grid({.side = 3, .seed = seed, .field = linear}).grid;
        std::vector<double> values, places;
        for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
            const At at{grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2)};
            values.push_back(linear(at));
            places.insert(places.end(), at.begin(), at.end());
        }
        std::vector<std::int64_t> numbers(grid.cells.count());
        std::iota(numbers.begin(), numbers.end(), 100);
        grid.point_fields = {{"p", Array::own(std::move(values))}, {"at", Array::own(std::move(places), 3)}};
        grid.cell_fields = {{"number", Array::own(std::move(numbers))}};
        const Surface boundary = boundary_of(grid).value();
        const auto view = GridView::create(grid).value();
        ASSERT_TRUE(view->find_boundary({}));
        PickMessage message;
        message.state.field = "p";
        message.boundary = true;
        std::size_t made = 0;
        for (std::size_t v = 0; v < boundary.vertex_count(); ++v) {
            if (static_cast<std::size_t>(boundary.edge_ends.at(v, 0)) < grid.points.tuples() && v % 10 != 0) continue;
            made += static_cast<std::size_t>(boundary.edge_ends.at(v, 0)) >= grid.points.tuples();
            for (std::size_t axis = 0; axis < 3; ++axis) message.point[axis] = boundary.positions.at(v, axis);
            const Picked picked = view->pick(message, {}).value();
            ASSERT_EQ(picked.values.size(), 3u);
            EXPECT_NEAR(picked.values[0].values.at(0), linear(message.point), 1e-5)
                << "seed " << seed << ", vertex " << v;
            for (std::size_t axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(picked.values[1].values.at(axis), message.point[axis], 1e-5);
            ASSERT_TRUE(picked.cell);
            EXPECT_EQ(picked.values[2].values.at(0), static_cast<double>(*picked.cell + 100));
        }
        EXPECT_GT(made, 0u) << "seed " << seed;
    }
}

/// Its faces may be of none of the cells that tets were found for.
TEST(NearestOn, SaysNoCellWhereNoneWasFound) {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    surface.triangles = Array::own(std::vector<std::int32_t>{0, 1, 2}, 3);
    for (const std::int64_t cell : {-1, 4}) {
        surface.source_cells = Array::own(std::vector<std::int64_t>{cell});
        EXPECT_EQ(nearest_on(surface, {0.2, 0.2, 1}).value().cell, cell < 0 ? std::nullopt : std::optional(cell));
    }
}

/// A shell has no isosurface and needs no packing; fields of its points and cells colour it.
TEST(GridViewFlatCells, AreColouredByFieldsOfPointsAndCells) {
    Grid grid;
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0.5F, 0}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 1, 4, 2});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 4, 7});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{9, 5});
    grid.point_fields = {{"T", Array::own(std::vector<float>{1, 2, 3, 4, 5})}};
    grid.cell_fields = {{"part", Array::own(std::vector<std::int32_t>{1, 2})}};
    const auto view = GridView::create(grid).value();
    EXPECT_TRUE(view->pack("T", {}));
    ASSERT_TRUE(view->find_boundary({}));
    for (const char* field : {"T", "part"}) {
        EXPECT_TRUE(view->chart(field, {})) << field;
        ShowMessage message = show(1, {});
        message.state.field = message.state.color_by = field;
        message.state.colored_boundary = true;
        message.state.boundary = 1;
        std::vector<std::string> known;
        const Result<view::Frame> frame = view->frame(message, 0, known, {});
        ASSERT_TRUE(frame) << frame.error().message;
        const Json head = head_of(frame->bytes);
        ASSERT_EQ(head["surfaces"].size(), 1u) << field;
        EXPECT_EQ(head["surfaces"][0]["triangles"], 3) << field;
    }
}

TEST_F(GridViewTest, AnotherFieldIsFollowedDirectlyAndPacked) {
    ShowMessage message = show(1, {0.2});
    message.state.field = "gyroid";
    const auto direct = frame(message)["surfaces"][0]["triangles"];
    ASSERT_TRUE(view_->pack("sphere", {}));
    message.state.isovalues = {0.3};
    frame(message);
    message.state.isovalues = {0.2};
    known_.clear();
    const Json packed = frame(message);
    EXPECT_EQ(packed["method"], "clusters");
    EXPECT_EQ(packed["surfaces"][0]["triangles"], direct);
}

/// A grid of which `step` changes the cells, not their number.
Grid grid_of_step(std::size_t step) {
    Grid grid = made_grid(4);
    const auto points = grid.points.as<float>();
    std::vector<float> moved(points.begin(), points.end());
    for (float& x : moved) x *= 1 + 0.25F * static_cast<float>(step);
    grid.points = Array::own(std::move(moved), 3);
    return grid;
}

TEST(GridViewSteps, EachBoundaryHasAKeyOfItsOwn) {
    GridViewOptions options;
    options.steps = 40;
    options.read_step = [](std::size_t step, const isotet::Run&) -> Result<Grid> { return grid_of_step(step); };
    const auto view = GridView::create(grid_of_step(0), options).value();
    ASSERT_TRUE(view->find_boundary({}));
    std::vector<std::string> known, keys;
    for (std::size_t step = 0; step < options.steps; ++step) {
        ShowMessage message = show(step + 1, {});
        message.state.boundary = 0.5;
        message.state.step = step;
        const auto frame = view->frame(message, 0, known, {});
        ASSERT_TRUE(frame) << frame.error().message;
        const Json surface = head_of(frame->bytes)["surfaces"][0];
        EXPECT_TRUE(surface.contains("mesh")) << "step " << step << " has the boundary of another one";
        keys.push_back(surface["key"]);
    }
    std::ranges::sort(keys);
    EXPECT_EQ(std::ranges::adjacent_find(keys), keys.end());
}

TEST(GridViewSteps, CellsOfAnotherTypeHaveAnotherBoundary) {
    const auto read = [](std::size_t step) {
        Grid grid = make_grid({.shape = "hex", .side = 3, .fields = {"sphere"}}).value();
        grid.cells.types = {};
        grid.cells.offsets = {};
        grid.cells.uniform_type = step == 0 ? CellType::hexahedron : CellType::voxel;
        return grid;
    };
    GridViewOptions options;
    options.steps = 2;
    options.read_step = [&](std::size_t step, const isotet::Run&) -> Result<Grid> { return read(step); };
    const auto view = GridView::create(read(0), options).value();
    ASSERT_TRUE(view->find_boundary({}));
    std::vector<std::string> known, keys;
    for (const std::size_t step : {0, 1}) {
        ShowMessage message = show(step + 1, {});
        message.state.boundary = 0.5;
        message.state.step = step;
        const auto frame = view->frame(message, 0, known, {});
        ASSERT_TRUE(frame) << frame.error().message;
        keys.push_back(head_of(frame->bytes)["surfaces"][0]["key"]);
    }
    EXPECT_NE(keys[0], keys[1]);
}

TEST(GridViewSteps, ABoundaryThatIsFoundTooLateIsNotThatOfAnotherStep) {
    GridViewOptions options;
    options.steps = 2;
    options.read_step = [](std::size_t step, const isotet::Run&) -> Result<Grid> { return grid_of_step(step); };
    const auto view = GridView::create(grid_of_step(0), options).value();
    std::vector<std::string> known;
    ShowMessage message = show(1, {});
    message.state.boundary = 0.5;
    message.state.step = 1;
    std::string first;
    isotet::Run meanwhile; // the page goes on to step 1
    meanwhile.progress.report = [&](std::string_view, double) {
        if (first.empty()) first = view->frame(message, 0, known, {}).value().bytes;
    };
    ASSERT_TRUE(view->find_boundary(meanwhile));
    ASSERT_FALSE(first.empty());
    const std::string key = head_of(first)["surfaces"][0]["key"];
    EXPECT_EQ(head_of(view->frame(message, 0, known, {}).value().bytes)["surfaces"][0]["key"], key);
}

TEST(GridViewFile, CellsOfAnotherFileAreNotTakenForThoseReleased) {
    for (const bool other_points : {false, true}) {
        Grid later = made_grid(4);
        if (other_points) later.points = grid_of_step(1).points;
        else {
            const auto corners = later.cells.connectivity.as<std::int32_t>();
            std::vector<std::int32_t> turned(corners.rbegin(), corners.rend());
            later.cells.connectivity = Array::own(std::move(turned), later.cells.connectivity.components());
        }
        bool changed = false;
        GridViewOptions options;
        options.read_step = [&](std::size_t, const isotet::Run&) -> Result<Grid> {
            return changed ? later : made_grid(4);
        };
        const auto view = GridView::create(made_grid(4), options).value();
        ASSERT_TRUE(view->pack("sphere", {}));
        view->rest();
        ASSERT_FALSE(view->has_cells());
        changed = true;
        const auto spectrum = view->spectrum("sphere", {});
        ASSERT_FALSE(spectrum);
        EXPECT_NE(spectrum.error().message.find("the file has changed since it was read"), std::string::npos);
        changed = false;
        EXPECT_TRUE(view->spectrum("sphere", {}));
    }
}

class CurvedGridView : public testing::Test {
protected:
    static std::unique_ptr<GridView> view_with(const std::optional<RefineOptions>& refine) {
        GridViewOptions options;
        options.refine = refine;
        return GridView::create(grid(), options).value();
    }
    static Grid grid() {
        MakeOptions options;
        options.shape = "curved";
        options.side = 3;
        options.fields = {"sphere"};
        return make_grid(options).value();
    }
    static ShowMessage refined(std::uint64_t number, std::vector<double> isovalues) {
        ShowMessage message = show(number, std::move(isovalues));
        message.refined = true;
        return message;
    }
    static std::uint64_t triangles(double isovalue, const RefineOptions& refine) {
        const Grid curved = grid();
        ContourOptions options;
        options.refine = refine;
        Contour contour =
            Contour::create({curved, PointField{"sphere", curved.point_fields[0].values, false, {}}, {}, {}}, options)
                .value();
        return contour.extract(isovalue).value().surfaces.front().surface.triangle_count();
    }
    std::vector<std::string> known_;
    Json frame(GridView& view, const ShowMessage& message) {
        auto made = view.frame(message, 0, known_, {});
        if (!made) throw std::runtime_error(made.error().message);
        return head_of(made->bytes);
    }
};

TEST_F(CurvedGridView, IsRefinedWhenAskedAndStaysSo) {
    RefineOptions refine;
    refine.relative_tolerance = 1e-4;
    const auto view = view_with(refine);
    ASSERT_TRUE(view->refines());
    const Json coarse = frame(*view, show(1, {0.7}));
    EXPECT_FALSE(coarse.contains("field_bound"));
    const Json fine = frame(*view, refined(2, {0.7}));
    EXPECT_EQ(fine["surfaces"][0]["triangles"], triangles(0.7, refine));
    EXPECT_GT(fine["surfaces"][0]["triangles"], coarse["surfaces"][0]["triangles"]);
    EXPECT_GT(fine["field_bound"], 0.0);
    EXPECT_LT(fine["field_bound"], 1e-3);
    const Json again = frame(*view, show(3, {0.7}, true));
    EXPECT_EQ(again["surfaces"][0]["key"], fine["surfaces"][0]["key"]);
    EXPECT_FALSE(again["surfaces"][0].contains("mesh")) << "the page has it";
    EXPECT_EQ(again["field_bound"], fine["field_bound"]);
    const Json pinned = frame(*view, show(4, {0.6, 0.7}));
    EXPECT_FALSE(pinned.contains("field_bound")) << "one of two is not refined";
    EXPECT_EQ(pinned["surfaces"][1]["key"], fine["surfaces"][0]["key"]);
    EXPECT_TRUE(frame(*view, refined(5, {0.6, 0.7})).contains("field_bound"));
}

TEST_F(CurvedGridView, AndPolyhedraHaveAChartOfTheirSurfaces) {
    for (const char* shape : {"curved", "kelvin"})
        for (const bool packed : {false, true}) {
            SCOPED_TRACE(std::string(shape) + (packed ? ", packed" : ""));
            MakeOptions options;
            options.shape = shape;
            options.side = 5;
            options.fields = {"sphere", "gyroid"};
            auto view = GridView::create(make_grid(options).value()).value();
            ASSERT_TRUE(!packed || view->pack("gyroid", {}));
            const Result<Chart> chart = view->chart("sphere", {});
            ASSERT_TRUE(chart) << chart.error().message;
            const Json head = frame(*view, show(1, {0.7}));
            const auto bin =
                static_cast<std::size_t>((0.7 - chart->lower) / (chart->upper - chart->lower) * Chart::bins);
            const double expected = chart->triangles[bin], there = head["surfaces"][0]["triangles"];
            EXPECT_LT(std::abs(expected - there), 0.3 * there) << expected << " of " << there;
            known_.clear();
        }
}

TEST_F(CurvedGridView, PolyhedraGiveTheSameSurfacesBeforeAndAfterPacking) {
    MakeOptions options;
    options.shape = "kelvin";
    options.side = 6;
    options.fields = {"sphere", "gyroid"};
    const auto view = GridView::create(make_grid(options).value()).value();
    const std::vector<std::vector<double>> wishes{{0.5}, {0.7}, {0.7, 0.9}, {0.5}, {99}};
    const auto triangles = [&] {
        std::vector<std::uint64_t> counts;
        for (std::size_t i = 0; i < wishes.size(); ++i) {
            known_.clear();
            ShowMessage message = show(i + 1, wishes[i]);
            message.state.slices = {{{0, 0, 1}, 0.1}};
            const Json head = frame(*view, message);
            for (const Json& surface : head["surfaces"]) counts.push_back(surface["triangles"]);
        }
        return counts;
    };
    const auto before = triangles();
    ASSERT_TRUE(view->pack("sphere", {}));
    EXPECT_EQ(triangles(), before);
    EXPECT_GT(before[0], 1000u);
    EXPECT_GT(before[1], 1000u) << "the slice";
    PickMessage pick;
    pick.state = show(1, {0.7}).state;
    pick.point = {0.7, 0, 0};
    const auto picked = view->pick(pick, {});
    ASSERT_TRUE(picked) << picked.error().message;
    EXPECT_NEAR(picked->point[0], 0.7, 0.05);
}

TEST_F(CurvedGridView, IsNotRefinedWithoutATolerance) {
    const auto view = view_with(std::nullopt);
    EXPECT_FALSE(view->refines());
    EXPECT_FALSE(frame(*view, refined(1, {0.7})).contains("field_bound"));
}

TEST_F(CurvedGridView, StaysAsItIsWhereRefiningFails) {
    RefineOptions refine;
    refine.max_tets = 10;
    const auto view = view_with(refine);
    const Json head = frame(*view, refined(1, {0.7}));
    EXPECT_FALSE(head.contains("field_bound"));
    EXPECT_GT(head["surfaces"][0]["triangles"], 10);
    ASSERT_EQ(head["notes"].size(), 2U);
    EXPECT_NE(head["notes"][0].get<std::string>().find("not refined: "), std::string::npos);
}

TEST_F(GridViewTest, OfLinearCellsHasNothingToRefine) {
    EXPECT_FALSE(view_->refines());
    ShowMessage message = show(1, {0.7});
    message.refined = true;
    EXPECT_FALSE(frame(message).contains("field_bound"));
}

ShowMessage show_volume(std::uint64_t number, const std::string& opacity, std::vector<double> isovalues = {}) {
    ShowMessage message = show(number, std::move(isovalues));
    message.state.volume = VolumeState{opacity, {}, !message.state.isovalues.empty()};
    message.state.camera = camera_of(30, 20);
    message.state.camera->fit(Box{{-1, -1, -1}, {1, 1, 1}}, 1);
    message.picture = {60, 60};
    return message;
}

TEST_F(GridViewTest, VolumesArePicturesThatFollowTheirOpacity) {
    const auto picture_of = [&](const ShowMessage& message) {
        const view::Frame made = view_->frame(message, 0, known_, {}).value();
        const Json head = head_of(made.bytes);
        return std::pair(head, made.bytes.substr(made.bytes.find("PNG")));
    };
    const auto [ramp, ramp_bytes] = picture_of(show_volume(1, "ramp"));
    EXPECT_TRUE(ramp["surfaces"].empty());
    EXPECT_EQ(ramp["picture"]["width"], 60);
    EXPECT_GT(ramp["opacity_length"].get<double>(), 0);
    EXPECT_EQ(ramp["opacity"].size(), 2U);
    EXPECT_EQ(ramp["scale"]["lower"], 0) << "of the field itself";
    const auto [points, points_bytes] = picture_of(show_volume(2, "0.5:0,0.8:1"));
    EXPECT_EQ(points["opacity"], Json::parse("[[0.5, 0.0], [0.8, 1.0]]"));
    EXPECT_NE(points_bytes, ramp_bytes);
    const auto [both, both_bytes] = picture_of(show_volume(3, "0.5:0,0.8:1", {0.4}));
    EXPECT_EQ(both["surfaces"].size(), 1U);
    EXPECT_NE(both_bytes, points_bytes);
    EXPECT_EQ(picture_of(show_volume(4, "ramp")).second, ramp_bytes) << "nothing stays of what was shown before";
    ShowMessage moving = show_volume(5, "ramp");
    moving.moving = true;
    EXPECT_EQ(head_of(view_->frame(moving, 0, known_, {})->bytes)["picture"]["width"], 20);
}

TEST_F(GridViewTest, VolumesHaveTheColoursOfTheirField) {
    ShowMessage message = show_volume(1, "ramp");
    message.state.color_by = "gyroid";
    const auto refused = view_->frame(message, 0, known_, {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("one colour scale"), std::string::npos) << refused.error().message;
    message.state.color_by = "sphere";
    EXPECT_TRUE(view_->frame(message, 0, known_, {}));
}

TEST_F(GridViewTest, WrongWishesAreErrorsAndLeaveWhatThePageHas) {
    frame(show(1, {0.7}));
    const std::vector<std::string> before = known_;
    ShowMessage message = show(2, {0.6});
    message.state.field = "nothing";
    EXPECT_FALSE(view_->frame(message, 0, known_, {}));
    message = show(3, {0.6});
    message.state.color_by = "v";
    EXPECT_FALSE(view_->frame(message, 0, known_, {}));
    EXPECT_EQ(known_, before);
    EXPECT_EQ(frame(show(4, {99}))["surfaces"][0]["triangles"], 0);
}

TEST_F(GridViewTest, ACancelledFrameIsCancelled) {
    const std::atomic<bool> cancel{true};
    const auto made = view_->frame(show(1, {0.7}), 0, known_, {0, {{}, &cancel}});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::cancelled);
}

TEST_F(GridViewTest, TheChartCountsAllPointsAndBeginsWhereASurfaceIs) {
    const Chart chart = view_->chart("sphere", {}).value();
    std::uint64_t points = 0;
    for (const std::uint64_t count : chart.points) points += count;
    EXPECT_EQ(points, 13U * 13 * 13);
    EXPECT_GT(chart.first, chart.lower);
    EXPECT_LT(chart.first, chart.upper);
    EXPECT_GT(frame(show(1, {chart.first}))["surfaces"][0]["triangles"], 0);
    const ContourSpectrum spectrum = view_->spectrum("sphere", {}).value();
    EXPECT_EQ(spectrum.isovalues.size(), 257u);
    EXPECT_EQ(spectrum.isovalues.front(), chart.lower);
    EXPECT_EQ(spectrum.isovalues.back(), chart.upper);
    EXPECT_GT(spectrum.volume, 0);
    EXPECT_FALSE(view_->spectrum("nothing", {}));
    const Chart constant = view_->chart("v:x", {}).value();
    EXPECT_EQ(constant.first, 2);
    EXPECT_FALSE(view_->chart("nothing", {}));
}

TEST_F(GridViewTest, ASliceHasThePlanesPointsAndTheValuesOfItsField) {
    ShowMessage message = show(1, {0.7});
    message.state.slices = {{{0, 0, 1}, 0.25}};
    message.state.color_by = "sphere";
    const Json head = frame(message);
    ASSERT_EQ(head["surfaces"].size(), 2U);
    EXPECT_EQ(head["surfaces"][1]["kind"], "slice");
    const Json& mesh = head["surfaces"][1]["mesh"];
    EXPECT_NEAR(mesh["lower"][2].get<double>(), 0.25, 1e-6);
    EXPECT_NEAR(mesh["upper"][2].get<double>(), 0.25, 1e-6);
    EXPECT_TRUE(mesh.contains("colors_at"));
}

TEST_F(GridViewTest, TheBoundaryComesOnceItIsFoundAndOnlyWhereItIsSeen) {
    EXPECT_EQ(frame(show(1, {0.7}))["surfaces"].size(), 1U);
    ASSERT_TRUE(view_->find_boundary({}));
    const Json head = frame(show(2, {0.7}));
    ASSERT_EQ(head["surfaces"].size(), 2U);
    EXPECT_EQ(head["surfaces"][1]["kind"], "boundary");
    EXPECT_EQ(head["surfaces"][1]["triangles"], 12 * 12 * 12);
    EXPECT_EQ(head["surfaces"][1]["opacity"], default_boundary_opacity);
    ShowMessage without = show(3, {0.7});
    without.state.boundary = 0;
    EXPECT_EQ(frame(without)["surfaces"].size(), 1U);
}

TEST_F(GridViewTest, APickHasTheIsovalueAllFieldsAndTheCell) {
    PickMessage message;
    message.state = show(1, {0.7}).state;
    const Grid grid = made_grid(12);
    message.point = {0.1, 0.2, 0.95};
    const auto picked = view_->pick(message, {});
    ASSERT_TRUE(picked) << picked.error().message;
    ASSERT_EQ(picked->values.size(), 4U);
    EXPECT_EQ(picked->values[0].name, "sphere");
    EXPECT_NEAR(picked->values[0].values.at(0), 0.7, 1e-5);
    EXPECT_EQ(picked->values[2].values, (std::vector<double>{2, 2, 2}));
    EXPECT_EQ(picked->values[3].name, "seventh");
    ASSERT_TRUE(picked->cell);
    EXPECT_EQ(picked->values[3].values.at(0), static_cast<double>(*picked->cell % 7));
    ASSERT_GE(*picked->cell, 0);
    ASSERT_LT(*picked->cell, static_cast<std::int64_t>(grid.cells.count()));
}

TEST_F(GridViewTest, ARayMeetsTheBoundaryFirstWhereItIsAmongWhatIsSeen) {
    ASSERT_TRUE(view_->find_boundary({}));
    PickMessage message;
    message.state = show(1, {0.7}).state;
    message.point = {0.1, 0.2, 9};
    message.ray = {0, 0, -1};
    auto picked = view_->pick(message, {});
    ASSERT_TRUE(picked) << picked.error().message;
    EXPECT_EQ(picked->isovalue, 0.7);
    EXPECT_FALSE(picked->boundary);
    message.boundary = true;
    picked = view_->pick(message, {});
    ASSERT_TRUE(picked) << picked.error().message;
    EXPECT_TRUE(picked->boundary);
    EXPECT_FALSE(picked->isovalue);
    EXPECT_NEAR(picked->point[2], 1, 1e-9);
    message.state.clips = {{{0, 0, 1}, 0.8}}; // which cuts that side of the boundary away
    picked = view_->pick(message, {});
    ASSERT_TRUE(picked) << picked.error().message;
    EXPECT_EQ(picked->isovalue, 0.7) << "the isosurface is behind it";
}

TEST_F(GridViewTest, ASolidIsClosedByTheBoundaryOnItsSide) {
    const Grid grid = made_grid(12);
    Solids solids = Solids::create({grid, find_field(grid, "sphere").value(), {}, {}}).value();
    ShowMessage message = show(1, {0.7});
    const Json isosurface = frame(message)["surfaces"][0];
    for (const SolidSide side : {SolidSide::above, SolidSide::below}) {
        message.state.solid = side;
        const Json solid = frame(message)["surfaces"][0];
        const SolidRange range = side == SolidSide::above ? SolidRange::above(0.7) : SolidRange::below(0.7);
        EXPECT_EQ(solid["triangles"], solids.extract(range).value().surface.triangle_count());
        EXPECT_NE(solid["key"], isosurface["key"]);
    }
    message.state.solid.reset();
    EXPECT_EQ(frame(message)["surfaces"][0]["key"], isosurface["key"]);
}

TEST_F(GridViewTest, APickOnASolidIsOnItsBoundaryToo) {
    PickMessage message;
    message.state = show(1, {0.7}).state;
    message.state.solid = SolidSide::above;
    message.point = {1, 0.9, 0.8};
    const auto picked = view_->pick(message, {});
    ASSERT_TRUE(picked) << picked.error().message;
    EXPECT_NEAR(picked->point[0], 1, 1e-6);
    EXPECT_NEAR(picked->values[0].values.at(0), std::hypot(1, 0.9, 0.8), 0.05);
    EXPECT_EQ(picked->values.size(), 4U);
}

/// Far values of a gyroid are in many parts.
class PartsTest : public testing::Test {
protected:
    std::unique_ptr<GridView> view_ = GridView::create(made_grid(16)).value();
    ShowMessage message_ = [] {
        ShowMessage message = show(1, {1.3});
        message.state.field = "gyroid";
        return message;
    }();

    std::uint64_t triangles() {
        std::vector<std::string> known;
        const auto made = view_->frame(message_, 0, known, {});
        return head_of(made.value().bytes)["surfaces"][0]["triangles"].get<std::uint64_t>();
    }
    ShownParts parts() { return view_->parts({message_.state}, {}).value(); }
    void keep(const char* choice) { message_.state.keep = parse_part_choice(choice); }
};

TEST_F(PartsTest, OfSurfacesAndSolidsAreThoseThatAreKept) {
    for (const bool packed : {false, true})
        for (const auto solid : {std::optional<SolidSide>(), std::optional(SolidSide::above)}) {
            if (packed) {
                ASSERT_TRUE(view_->pack("gyroid", {}));
            }
            message_.state.solid = solid;
            message_.state.keep.reset();
            const std::uint64_t all = triangles();
            const ShownParts whole = parts();
            ASSERT_GT(whole.parts.size(), 2u);
            ASSERT_EQ(whole.kept.size(), whole.parts.size());
            std::uint64_t sum = 0;
            for (const SurfacePart& part : whole.parts) sum += part.triangles;
            EXPECT_EQ(sum, all);
            keep("not:0");
            EXPECT_EQ(triangles(), all - whole.parts[0].triangles);
            keep("parts:1");
            EXPECT_EQ(triangles(), whole.parts[1].triangles);
            EXPECT_EQ(parts().kept, (std::vector<std::uint64_t>{1}));
            keep("touching:boundary");
            const auto open = std::ranges::count(whole.parts, false, &SurfacePart::closed); // a solid has none
            EXPECT_EQ(parts().kept.size() == static_cast<std::size_t>(open), !solid);
        }
}

TEST_F(PartsTest, APickTellsThePartAndMeetsNoneThatIsLeftOut) {
    const auto part_at = [this, centre = parts().parts[0].centre] {
        const Picked picked = view_->pick({message_.state, {}, false, centre, {}, true}, {}).value();
        return std::ranges::find(picked.values, "part", &PickedValue::name)->values;
    };
    keep("parts:0");
    EXPECT_EQ(part_at(), std::vector<double>{0});
    keep("not:0");
    EXPECT_NE(part_at(), std::vector<double>{0});
}

TEST_F(GridViewTest, AnIsovalueByShareIsThatOfTheCommandLine) {
    const Grid grid = made_grid(12);
    for (const auto of : {IsovalueShare::Of::volume, IsovalueShare::Of::points}) {
        const IsovalueShare share{of, 90};
        const auto expected = isovalues_at(grid, find_field(grid, "sphere").value(), {&share, 1}).value().front();
        EXPECT_EQ(view_->isovalue_at({"sphere", {}, share}, {}).value(), expected);
    }
    EXPECT_FALSE(view_->isovalue_at({"sphere", {}, {IsovalueShare::Of::volume, 101}}, {}));
}

TEST_F(GridViewTest, APickOnASliceLiesInItsPlane) {
    PickMessage message;
    message.state = show(1, {0.7}).state;
    message.state.slices = {{{1, 1, 0}, 0.5}};
    message.slice = 0;
    message.point = {0.3, 0.3, 0.4};
    const auto picked = view_->pick(message, {});
    ASSERT_TRUE(picked) << picked.error().message;
    EXPECT_NEAR(picked->point[0] + picked->point[1], 0.5, 1e-5);
    EXPECT_NEAR(picked->point[2], 0.4, 1e-5);
}

TEST_F(GridViewTest, AMissedSurfaceIsAnError) {
    PickMessage message;
    message.state = show(1, {99}).state;
    const auto picked = view_->pick(message, {});
    ASSERT_FALSE(picked);
    EXPECT_EQ(picked.error().code, ErrorCode::invalid_data);
}

/// Steps of one grid: the field of step n is n times that of step 1. Counts what is read.
class StepsTest : public testing::Test {
protected:
    static Grid grid_of(std::size_t step) {
        Grid grid = made_grid(12);
        const auto values = grid.point_fields[0].values.as<float>();
        std::vector<float> scaled(values.begin(), values.end());
        for (float& value : scaled) value *= static_cast<float>(step);
        grid.point_fields[0].values = Array::own(std::move(scaled));
        return grid;
    }
    GridViewOptions options() {
        GridViewOptions options;
        options.step = 1;
        options.steps = 4;
        options.read_step = [this](std::size_t step, const isotet::Run&) {
            ++reads_;
            return Result<Grid>(grid_of(step));
        };
        return options;
    }
    ShowMessage at_step(std::uint64_t step, double isovalue) {
        ShowMessage message = show(++number_, {isovalue});
        message.state.step = step;
        return message;
    }
    Json frame(const ShowMessage& message) { return head_of(view_->frame(message, 0, known_, {}).value().bytes); }

    std::atomic<int> reads_{0};
    std::uint64_t number_ = 0;
    std::vector<std::string> known_;
    std::unique_ptr<GridView> view_ = GridView::create(grid_of(1), options()).value();
};

TEST_F(StepsTest, AnotherStepHasItsOwnSurfaceDirectAndPacked) {
    const Json first = frame(at_step(1, 0.7));
    EXPECT_EQ(reads_, 0);
    for (const bool packed : {false, true}) {
        if (packed) {
            ASSERT_TRUE(view_->pack("sphere", {}));
        }
        const Json second = frame(at_step(2, 1.4));
        EXPECT_EQ(second["step"], 2);
        EXPECT_EQ(second["surfaces"][0]["triangles"], first["surfaces"][0]["triangles"]);
        EXPECT_NE(second["surfaces"][0]["key"], first["surfaces"][0]["key"]);
        EXPECT_EQ(frame(at_step(1, 0.7))["surfaces"][0]["triangles"], first["surfaces"][0]["triangles"]);
    }
}

TEST_F(StepsTest, AStepThatWasReadAheadIsNotReadAgain) {
    ShowMessage message = at_step(2, 0.7);
    message.next = 3;
    frame(message);
    frame(at_step(3, 0.7));
    EXPECT_EQ(reads_, 2);
    frame(at_step(3, 0.8));
    EXPECT_EQ(reads_, 2) << "the grid is there";
}

TEST_F(StepsTest, AStepThatIsNotThereIsRefusedAndTheLastOneStays) {
    const auto refused = view_->frame(at_step(4, 0.7), 0, known_, {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("steps 0 to 3"), std::string::npos) << refused.error().message;
    EXPECT_EQ(frame(at_step(1, 0.7))["step"], 1);
}

TEST_F(StepsTest, AChartAndASpectrumAreOfTheStepThatIsAskedFor) {
    const Chart first = view_->chart("sphere", 1).value();
    frame(at_step(3, 0.7)); // of another page
    const Chart again = view_->chart("sphere", 1).value(), third = view_->chart("sphere", 3).value();
    EXPECT_EQ(again.upper, first.upper);
    EXPECT_EQ(again.first, first.first);
    EXPECT_EQ(again.triangles, first.triangles);
    EXPECT_NEAR(third.upper, 3 * first.upper, 1e-6);
    EXPECT_EQ(view_->spectrum("sphere", 1).value().isovalues.back(), first.upper);
    EXPECT_EQ(view_->step(), 1U);
    EXPECT_FALSE(view_->chart("sphere", 4));
}

TEST_F(StepsTest, AFrameTellsTheRangeOfItsFieldInItsStep) {
    const Json first = frame(at_step(1, 0.7)), third = frame(at_step(3, 0.7));
    EXPECT_EQ(first["field"], "sphere");
    EXPECT_EQ(first["range"][0], 0);
    EXPECT_NEAR(third["range"][1].get<double>(), 3 * first["range"][1].get<double>(), 1e-6);
    ShowMessage other = at_step(3, 0.7);
    other.state.field = "gyroid";
    EXPECT_LT(frame(other)["range"][0], 0);
}

/// A grid whose cells were released, beside one whose cells stay.
class LeanGridView : public testing::Test {
protected:
    int reads_ = 0, cells_more_ = 0;
    std::unique_ptr<GridView> lean_, full_ = GridView::create(made_grid(12)).value();

    LeanGridView() {
        GridViewOptions options;
        options.read_step = [this](std::size_t, const isotet::Run&) -> Result<Grid> {
            ++reads_;
            return made_grid(static_cast<std::uint64_t>(12 + cells_more_));
        };
        lean_ = GridView::create(made_grid(12), options).value();
        for (GridView* view : {lean_.get(), full_.get()}) {
            EXPECT_TRUE(view->pack("sphere", {}));
            view->rest();
        }
    }
    static std::uint64_t triangles(GridView& view, const ShowMessage& message) {
        std::vector<std::string> known;
        const Json head = head_of(view.frame(message, 0, known, {}).value().bytes);
        return head["surfaces"].back()["triangles"].get<std::uint64_t>();
    }
};

TEST_F(LeanGridView, HasNoCellsAndReadsThemForNoSurfaceOfAPointField) {
    EXPECT_FALSE(lean_->has_cells());
    EXPECT_TRUE(full_->has_cells()) << "it cannot be read again";
    EXPECT_EQ(lean_->cells(), full_->cells());
    ShowMessage message = show(1, {0.7});
    for (const char* field : {"gyroid", "sphere", "v:x"})
        for (const char* colors : {"", "gyroid", "seventh", "v:mag"}) {
            message.state.field = field;
            message.state.color_by = colors;
            EXPECT_EQ(triangles(*lean_, message), triangles(*full_, message)) << field << " by " << colors;
        }
    EXPECT_EQ(reads_, 0);
}

TEST_F(LeanGridView, ReadsTheCellsOnceForSolidsAndKeepsThem) {
    ShowMessage message = show(1, {0.7});
    message.state.solid = SolidSide::above;
    for (const double isovalue : {0.7, 0.8, 0.9}) {
        message.state.isovalues = {isovalue};
        EXPECT_EQ(triangles(*lean_, message), triangles(*full_, message));
        lean_->rest();
    }
    EXPECT_EQ(reads_, 1);
    message.state.solid.reset();
    EXPECT_EQ(triangles(*lean_, message), triangles(*full_, message));
    lean_->rest();
    EXPECT_FALSE(lean_->has_cells());
}

TEST_F(LeanGridView, SlicesAndPicksAreTheSame) {
    ShowMessage message = show(1, {0.7});
    message.state.slices = {Plane{{1, 2, 0.5}, 0.1}};
    message.state.color_by = "seventh";
    EXPECT_EQ(triangles(*lean_, message), triangles(*full_, message));
    PickMessage pick;
    pick.state = message.state;
    for (const bool of_slice : {false, true}) {
        if (of_slice) pick.slice = 0;
        pick.point = {0.31, 0.42, 0.53};
        const Picked a = lean_->pick(pick, {}).value(), b = full_->pick(pick, {}).value();
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(a.point[axis], b.point[axis], 1e-6);
        EXPECT_EQ(a.cell, b.cell);
        ASSERT_EQ(a.values.size(), b.values.size());
        for (std::size_t i = 0; i < a.values.size(); ++i)
            EXPECT_NEAR(a.values[i].values[0], b.values[i].values[0], 1e-5) << a.values[i].name;
    }
    EXPECT_EQ(reads_, 0);
}

TEST_F(LeanGridView, ARayMeetsTheFirstSurfaceThatIsNotClipped) {
    PickMessage pick;
    pick.state = show(1, {0.7, 0.5}).state;
    pick.point = {5, 0.05, 0.05};
    pick.ray = {-1, 0, 0};
    EXPECT_NEAR(lean_->pick(pick, {}).value().point[0], 0.7, 0.02);
    EXPECT_EQ(lean_->pick(pick, {}).value().isovalue, 0.7);
    pick.state.clips = {Plane{{1, 0, 0}, 0.6}};
    EXPECT_EQ(lean_->pick(pick, {}).value().isovalue, 0.5);
    pick.state.slices = {Plane{{1, 0, 0}, 0.8}};
    const Picked slice = lean_->pick(pick, {}).value();
    EXPECT_NEAR(slice.point[0], 0.8, 1e-6);
    EXPECT_FALSE(slice.isovalue);
    pick.ray = {1, 0, 0};
    EXPECT_FALSE(lean_->pick(pick, {})) << "it goes away from all";
}

TEST_F(LeanGridView, ChartsComeFromASampleAndSpectraFromTheFileReadAgain) {
    const Chart a = lean_->chart("gyroid", {}).value(), b = full_->chart("gyroid", {}).value();
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.triangles, b.triangles) << "all of so few cells are in the sample";
    EXPECT_EQ(reads_, 0);
    EXPECT_EQ(lean_->spectrum("gyroid", {}).value().area, full_->spectrum("gyroid", {}).value().area);
    EXPECT_EQ(reads_, 1);
    EXPECT_TRUE(lean_->has_cells());
    lean_->rest();
    EXPECT_FALSE(lean_->has_cells());
    ShowMessage averaged = show(1, {3});
    averaged.state.field = "seventh";
    EXPECT_EQ(triangles(*lean_, averaged), triangles(*full_, averaged));
    EXPECT_EQ(reads_, 2);
}

TEST_F(LeanGridView, SaysThatTheFileHasChanged) {
    cells_more_ = 1;
    const auto spectrum = lean_->spectrum("gyroid", {});
    ASSERT_FALSE(spectrum);
    EXPECT_TRUE(spectrum.error().message.starts_with("the file has changed since it was read"))
        << spectrum.error().message;
}

/// The cells before a number are empty.
Grid from_cell(Grid grid, std::size_t first) {
    std::vector<std::uint8_t> types(grid.cells.count(), 10);
    std::fill_n(types.begin(), first, std::uint8_t{0});
    std::vector<std::uint64_t> offsets(types.size() + 1);
    for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = 4 * i;
    grid.cells.types = Array::own(std::move(types));
    grid.cells.offsets = Array::own(std::move(offsets));
    return grid;
}

/// "cell=N:" in place of isotet::jobs::choose_cells().
Result<Grid> cells_from(Grid grid, const std::vector<std::string>& cells) {
    const std::size_t first = std::stoul(cells.front().substr(5));
    if (first >= grid.cells.count()) return Error{ErrorCode::invalid_argument, "`cells`: none is left"};
    return from_cell(std::move(grid), first);
}

class ChosenCellsTest : public testing::Test {
protected:
    static constexpr std::size_t side = 12;
    Grid grid_ = made_grid(side);
    std::size_t half_ = grid_.cells.count() / 2;
    int reads_ = 0;
    std::unique_ptr<GridView> view_, all_ = with_boundary(grid_, {}),
                                     chosen_ = with_boundary(from_cell(grid_, half_), {});

    static std::unique_ptr<GridView> with_boundary(Grid grid, const GridViewOptions& options) {
        auto view = GridView::create(std::move(grid), options).value();
        EXPECT_TRUE(view->find_boundary({}));
        return view;
    }
    GridViewOptions options() {
        GridViewOptions options;
        options.only_cells = cells_from;
        options.read_step = [this](std::size_t, const isotet::Run&) -> Result<Grid> {
            ++reads_;
            return made_grid(side);
        };
        return options;
    }
    std::vector<std::string> from_half() const { return {"cell=" + std::to_string(half_) + ":"}; }
    static std::vector<std::uint64_t> triangles(GridView& view, const ShowMessage& message) {
        std::vector<std::string> known;
        const Json head = head_of(view.frame(message, 0, known, {}).value().bytes);
        std::vector<std::uint64_t> counts;
        for (const Json& surface : head["surfaces"]) counts.push_back(surface["triangles"].get<std::uint64_t>());
        return counts;
    }
    /// Of surfaces, solids, slices and the boundary.
    static std::vector<std::uint64_t> triangles_of_all(GridView& view, const std::vector<std::string>& cells) {
        std::vector<std::uint64_t> counts;
        for (const bool solid : {false, true}) {
            ShowMessage message = show(1, {0.7, 0.4});
            message.state.cells = cells;
            message.state.color_by = "seventh";
            message.state.boundary = 1;
            message.state.colored_boundary = solid;
            message.state.slices = {Plane{{1, 2, 0.5}, 0.1}};
            if (solid) message.state.solid = SolidSide::above;
            const auto some = triangles(view, message);
            counts.insert(counts.end(), some.begin(), some.end());
        }
        return counts;
    }
    void expect_chosen_and_all() {
        const auto all = triangles_of_all(*all_, {}), chosen = triangles_of_all(*chosen_, {});
        EXPECT_NE(chosen, all);
        for (int i = 0; i < 2; ++i) {
            EXPECT_EQ(triangles_of_all(*view_, from_half()), chosen);
            EXPECT_EQ(view_->spectrum("sphere", {}, {}, from_half()).value().area,
                      chosen_->spectrum("sphere", {}).value().area);
            EXPECT_EQ(view_->chart("sphere", {}, {}, from_half()).value().triangles,
                      chosen_->chart("sphere", {}).value().triangles);
            PickMessage pick;
            pick.state = show(1, {0.7}).state;
            pick.state.cells = from_half();
            pick.boundary = true;
            EXPECT_GE(view_->pick(pick, {}).value().cell, half_);
            view_->rest();
            EXPECT_EQ(triangles_of_all(*view_, {}), all);
            EXPECT_EQ(view_->spectrum("sphere", {}).value().area, all_->spectrum("sphere", {}).value().area);
            view_->rest();
        }
    }
};

TEST_F(ChosenCellsTest, AreThoseOfAGridThatHasNoOthersDirectAndPacked) {
    GridViewOptions without_reading = options();
    without_reading.read_step = {};
    view_ = with_boundary(grid_, without_reading);
    expect_chosen_and_all();
    ASSERT_TRUE(view_->pack("sphere", {}));
    expect_chosen_and_all();
}

TEST_F(ChosenCellsTest, PackingThatBeginsThenHasAllCells) {
    view_ = with_boundary(grid_, options());
    triangles_of_all(*view_, from_half());
    ASSERT_TRUE(view_->pack("sphere", {}));
    EXPECT_EQ(triangles_of_all(*view_, {}), triangles_of_all(*all_, {}));
}

TEST_F(ChosenCellsTest, BringReleasedCellsBack) {
    view_ = with_boundary(grid_, options());
    ASSERT_TRUE(view_->pack("sphere", {}));
    view_->rest();
    EXPECT_FALSE(view_->has_cells());
    expect_chosen_and_all();
    EXPECT_GE(reads_, 1);
    triangles(*view_, show(2, {0.7})); // without solids
    view_->rest();
    EXPECT_FALSE(view_->has_cells());
}

TEST_F(ChosenCellsTest, StayInOtherSteps) {
    GridViewOptions with_steps = options();
    with_steps.steps = 3;
    view_ = with_boundary(grid_, with_steps);
    ASSERT_TRUE(view_->pack("sphere", {}));
    ShowMessage message = show(1, {0.7});
    message.state.cells = from_half();
    const auto first = triangles(*view_, message);
    message.state.step = 2;
    EXPECT_EQ(triangles(*view_, message), first);
    EXPECT_EQ(triangles(*chosen_, show(1, {0.7})), first);
    message.state.cells.clear();
    EXPECT_EQ(triangles(*view_, message), triangles(*all_, show(1, {0.7})));
}

TEST_F(GridViewTest, PicturesHaveTheBoundaryAlone) {
    ShowMessage message = show(1, {0.7});
    message.picture = {120, 90};
    message.state.isosurfaces = false;
    message.state.boundary = 1;
    message.state.color_by = "gyroid";
    message.state.colored_boundary = true;
    message.state.camera = camera_of(30, 20);
    message.state.camera->distance = 8;
    const std::size_t seen = view_->frame(message, 0, known_, {}).value().bytes.size();
    message.state.boundary = 0;
    EXPECT_GT(seen, view_->frame(message, 0, known_, {}).value().bytes.size() + 1000);
}

TEST_F(ChosenCellsTest, PicturesHaveNoOthers) {
    view_ = with_boundary(grid_, options());
    ShowMessage message = show(1, {0.7});
    message.picture = {120, 90};
    message.state.boundary = 1;
    message.state.camera = camera_of(30, 20);
    message.state.camera->distance = 8;
    const auto bytes = [&](GridView& view) {
        std::vector<std::string> known;
        return view.frame(message, 0, known, {}).value().bytes;
    };
    const auto end_of = [](const std::string& frame) { return frame.substr(frame.size() - 400); };
    const std::string all = bytes(*view_), chosen = bytes(*chosen_);
    message.state.cells = from_half();
    const std::string now = bytes(*view_);
    EXPECT_EQ(end_of(now), end_of(chosen));
    EXPECT_NE(end_of(now), end_of(all));
}

TEST_F(ChosenCellsTest, ThatLeaveNothingAreRefusedAndTheGridStays) {
    view_ = with_boundary(grid_, options());
    ShowMessage message = show(1, {0.7});
    message.state.cells = {"cell=99999999:"};
    std::vector<std::string> known;
    EXPECT_FALSE(view_->frame(message, 0, known, {}));
    EXPECT_EQ(triangles_of_all(*view_, {}), triangles_of_all(*all_, {}));
}

/// A grid that lies in a packed file of two steps, beside the same grid in memory.
class GridViewOfFile : public testing::Test {
protected:
    TemporaryFolder folder_;
    std::string path_ = folder_.file("grid.isotet");
    int reads_ = 0;
    Grid grid_ = made_grid(12);
    std::unique_ptr<GridView> of_file_, full_;

    GridViewOfFile() {
        grid_.cell_fields.clear();
        grid_.point_fields.pop_back(); // the vectors: a packed file has scalars
        const PackedGrid sphere = pack(grid_, find_field(grid_, "sphere").value(), {.source_cells = true}).value();
        const PackedGrid gyroid = sphere.with_field(find_field(grid_, "gyroid").value()).value();
        PackedWriter writer = PackedWriter::create(sphere, path_, {.more_fields = {gyroid}, .time = 0}).value();
        writer.add_step(sphere.with_field(doubled("sphere")).value(), 1).value();
        writer.add_field(gyroid).value();
        writer.commit().value();
        full_ = GridView::create(grid_).value();
        EXPECT_TRUE(full_->pack("sphere", {}));
        EXPECT_TRUE(full_->find_boundary({}));
        GridViewOptions options;
        options.steps = 2;
        options.packed = PackedFile::open(path_).value();
        options.cells = grid_.cells.count();
        options.read_step = [this](std::size_t step, const isotet::Run&) { return read_step(step, 100); };
        options.only_cells = cells_from;
        options.read_cells = [this](std::size_t step, const isotet::Run&) {
            ++reads_;
            return read_step(step, 0);
        };
        of_file_ = GridView::create(read_step(0, 100).value(), options).value();
        EXPECT_TRUE(of_file_->pack("sphere", {}));
        EXPECT_TRUE(of_file_->find_boundary({}));
    }
    PointField doubled(const char* name) const {
        PointField field = find_field(grid_, name).value();
        std::vector<float> values;
        for (const float value : field.values.as<float>()) values.push_back(2 * value);
        field.values = Array::own(std::move(values));
        return field;
    }
    Result<Grid> read_step(std::size_t step, std::uint64_t cells) const {
        ReadOptions options;
        options.step = step;
        options.some_cells = cells;
        Result<ReadResult> result = read(path_, options);
        if (!result) return result.error();
        return std::move(result->grid);
    }
    static Json head(GridView& view, const ShowMessage& message) {
        std::vector<std::string> known;
        return head_of(view.frame(message, 0, known, {}).value().bytes);
    }
    static std::vector<std::uint64_t> triangles(GridView& view, const ShowMessage& message) {
        std::vector<std::uint64_t> counts;
        const Json all = head(view, message);
        for (const Json& surface : all["surfaces"]) counts.push_back(surface["triangles"].get<std::uint64_t>());
        return counts;
    }
};

TEST_F(GridViewOfFile, ShowsTheSameSurfacesSlicesAndBoundaryWithoutReadingCells) {
    EXPECT_FALSE(of_file_->has_cells());
    EXPECT_EQ(of_file_->cells(), full_->cells());
    EXPECT_EQ(of_file_->points(), full_->points());
    ShowMessage message = show(1, {0.7, 0.4});
    message.state.slices = {Plane{{1, 2, 0.5}, 0.1}};
    message.state.boundary = 0.5;
    for (const char* field : {"gyroid", "sphere", "x", "sphere + gyroid"})
        for (const char* colors : {"", "gyroid", "sphere"}) {
            message.state.field = field;
            message.state.color_by = colors;
            EXPECT_EQ(triangles(*of_file_, message), triangles(*full_, message)) << field << " by " << colors;
        }
    PickMessage pick;
    pick.state = show(1, {0.7}).state;
    pick.point = {0.31, 0.42, 0.53};
    const Picked a = of_file_->pick(pick, {}).value(), b = full_->pick(pick, {}).value();
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(a.point[axis], b.point[axis], 1e-6);
    EXPECT_EQ(a.cell, b.cell) << "the file has source cells";
    const Chart chart = of_file_->chart("sphere", {}).value(), expected = full_->chart("sphere", {}).value();
    EXPECT_EQ(chart.points, expected.points);
    EXPECT_GT(chart.triangles[Chart::bins / 2], 0);
    EXPECT_EQ(reads_, 0);
    EXPECT_FALSE(of_file_->has_cells());
}

TEST_F(GridViewOfFile, ShowsStepsByTheirValuesAlone) {
    ShowMessage message = show(1, {1.4});
    message.state.step = 1;
    ShowMessage half = show(1, {0.7});
    EXPECT_EQ(triangles(*of_file_, message), triangles(*full_, half)) << "values are twice as large";
    EXPECT_EQ(head(*of_file_, message)["range"][1], 2 * full_->chart("sphere", {}).value().upper);
    message.state.step = 0;
    EXPECT_EQ(triangles(*of_file_, message), triangles(*full_, show(1, {1.4})));
    EXPECT_EQ(reads_, 0);
}

TEST_F(GridViewOfFile, ShowsPointsThatMove) {
    std::vector<float> far(grid_.points.as<float>().begin(), grid_.points.as<float>().end());
    for (float& x : far) x *= 2;
    const PackedGrid moved =
        PackedFile::open(path_).value().load("sphere").value().with_points(Array::own(std::move(far), 3)).value();
    PackedWriter::append(moved, path_, 2).value().commit().value();
    GridViewOptions options;
    options.steps = 3;
    options.packed = PackedFile::open(path_).value();
    options.cells = grid_.cells.count();
    options.read_step = [this](std::size_t step, const isotet::Run&) { return read_step(step, 100); };
    options.read_cells = [this](std::size_t step, const isotet::Run&) { return read_step(step, 0); };
    const auto view = GridView::create(read_step(0, 100).value(), options).value();
    EXPECT_TRUE(view->find_boundary({}));
    ShowMessage message = show(1, {0.7});
    message.state.boundary = 1;
    message.state.slices = {Plane{{1, 2, 0.5}, 0.5}};
    const auto near = triangles(*view, message);
    message.state.step = 2;
    EXPECT_NE(triangles(*view, message), near);
    message.state.slices = {Plane{{1, 2, 0.5}, 1}};
    EXPECT_EQ(triangles(*view, message), near);
    PickMessage pick;
    pick.state = message.state;
    pick.boundary = true;
    pick.point = {2, 0.1, 0.2};
    EXPECT_NEAR(view->pick(pick, {}).value().point[0], 2, 1e-6) << "a boundary of twice the size";
}

TEST_F(GridViewOfFile, ReadsAllCellsWhereSomeAreChosenAndGivesThemBack) {
    ShowMessage message = show(1, {0.7});
    message.state.boundary = 1;
    const auto all = triangles(*of_file_, message);
    const std::size_t half = grid_.cells.count() / 2;
    const auto chosen = GridView::create(from_cell(read_step(0, 0).value(), half)).value(); // in the order of the file
    EXPECT_TRUE(chosen->find_boundary({}));
    const auto expected = triangles(*chosen, message);
    message.state.cells = {"cell=" + std::to_string(half) + ":"};
    EXPECT_EQ(triangles(*of_file_, message), expected);
    EXPECT_EQ(reads_, 1);
    message.state.step = 1;
    message.state.isovalues = {1.4};
    EXPECT_EQ(triangles(*of_file_, message), expected) << "values are twice as large";
    EXPECT_EQ(reads_, 1);
    message = show(2, {0.7});
    message.state.step = 0;
    message.state.boundary = 1;
    EXPECT_EQ(triangles(*of_file_, message), all);
    of_file_->rest();
    EXPECT_FALSE(of_file_->has_cells());
}

TEST_F(GridViewOfFile, ReadsAllCellsForSolidsAndGivesThemBack) {
    ShowMessage message = show(1, {0.7});
    message.state.solid = SolidSide::above;
    EXPECT_EQ(triangles(*of_file_, message), triangles(*full_, message));
    EXPECT_EQ(reads_, 1);
    message.state.solid.reset();
    EXPECT_EQ(triangles(*of_file_, message), triangles(*full_, message));
    of_file_->rest();
    EXPECT_FALSE(of_file_->has_cells());
    EXPECT_TRUE(of_file_->spectrum("sphere", {}));
    EXPECT_EQ(reads_, 2);
}

TEST_F(GridViewOfFile, DrawsVolumesSlicesAndBoundaryWithoutReadingCells) {
    const auto picture_of = [](GridView& view, const ShowMessage& message) {
        std::vector<std::string> known;
        const std::string bytes = view.frame(message, 0, known, {}).value().bytes;
        return bytes.substr(bytes.find("PNG"));
    };
    for (const char* opacity : {"ramp", "0.5:0,0.8:1"}) {
        const ShowMessage message = show_volume(1, opacity);
        EXPECT_TRUE(picture_of(*of_file_, message) == picture_of(*full_, message)) << opacity;
    }
    ShowMessage message = show_volume(2, "ramp", {0.7});
    message.state.volume.reset();
    message.state.isosurfaces = true;
    message.state.color_by = "gyroid";
    const std::string surface = picture_of(*of_file_, message);
    message.state.slices = {Plane{{1, 2, 0.5}, 0.1}};
    message.state.boundary = 0.5;
    message.state.colored_boundary = true;
    EXPECT_FALSE(picture_of(*of_file_, message) == surface);
    message.state.step = 1;
    EXPECT_FALSE(picture_of(*of_file_, message) == surface);
    EXPECT_EQ(reads_, 0);
    message.state.solid = SolidSide::above;
    EXPECT_FALSE(picture_of(*of_file_, message).empty());
    EXPECT_EQ(reads_, 1);
}

/// The same with two cell fields, one of few whole numbers, which change from one step to the next.
class GridViewOfCellFields : public GridViewOfFile {
protected:
    std::unique_ptr<GridView> of_cells_, all_;

    GridViewOfCellFields() {
        path_ = folder_.file("cells.isotet");
        const PackedGrid sphere = pack(grid_, find_field(grid_, "sphere").value(), {.source_cells = true}).value();
        PackedWriter writer = PackedWriter::create(sphere, path_, {.more_fields = {}, .time = 0}).value();
        for (const Field& field : cell_fields(0)) writer.add_cell_field(field).value();
        writer.add_step(sphere.with_field(doubled("sphere")).value(), 1).value();
        for (const Field& field : cell_fields(1)) writer.add_cell_field(field).value();
        writer.commit().value();
        Grid with = grid_;
        with.cell_fields = cell_fields(0);
        all_ = GridView::create(std::move(with)).value();
        EXPECT_TRUE(all_->pack("sphere", {}));
        EXPECT_TRUE(all_->find_boundary({}));
        GridViewOptions options;
        options.steps = 2;
        options.packed = PackedFile::open(path_).value();
        options.cells = grid_.cells.count();
        options.read_step = [this](std::size_t step, const isotet::Run&) { return read_step(step, 100); };
        options.read_cells = [this](std::size_t step, const isotet::Run&) {
            ++reads_;
            return read_step(step, 0);
        };
        of_cells_ = GridView::create(read_step(0, 100).value(), options).value();
        EXPECT_TRUE(of_cells_->find_boundary({}));
    }
    std::vector<Field> cell_fields(std::size_t step) const {
        std::vector<double> numbers(grid_.cells.count());
        std::vector<std::int32_t> regions(numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] = static_cast<double>(i) / 3 + static_cast<double>(step);
            regions[i] = static_cast<std::int32_t>(i % 5 + step);
        }
        return {{"number", Array::own(std::move(numbers))}, {"region", Array::own(std::move(regions))}};
    }
    static ShowMessage colored_by(const char* color) {
        ShowMessage message = show(1, {0.7});
        message.state.color_by = color;
        message.state.slices = {Plane{{1, 2, 0.5}, 0.1}};
        return message;
    }
};

TEST_F(GridViewOfCellFields, ColoursAsTheGridInMemoryDoesWithoutReadingCells) {
    ASSERT_EQ(of_cells_->fields().size(), 3u);
    EXPECT_EQ(of_cells_->fields()[1].name, "number");
    EXPECT_EQ(of_cells_->fields()[1].association, Association::cell);
    for (const char* color : {"number", "region"}) {
        const ShowMessage message = colored_by(color);
        const Json a = head(*of_cells_, message), b = head(*all_, message);
        EXPECT_EQ(a["scale"], b["scale"]) << color;
        EXPECT_EQ(a["scale"].contains("classes"), std::string(color) == "region");
        EXPECT_EQ(triangles(*of_cells_, message), triangles(*all_, message)) << color;
        PickMessage pick;
        pick.state = message.state;
        pick.point = {0.31, 0.42, 0.53};
        const Picked picked = of_cells_->pick(pick, {}).value();
        const auto value = std::ranges::find(picked.values, color, &PickedValue::name);
        ASSERT_NE(value, picked.values.end()) << color;
        const auto cell = static_cast<std::size_t>(picked.cell.value());
        EXPECT_EQ(value->values[0], cell_fields(0)[std::string(color) == "region"].values.at(cell));
    }
    ShowMessage next = colored_by("number");
    next.state.step = 1;
    EXPECT_EQ(head(*of_cells_, next)["scale"]["lower"], 1);
    ShowMessage picture = show_volume(2, "ramp", {0.7});
    picture.state.volume.reset();
    picture.state.isosurfaces = true;
    picture.state.color_by = "region";
    EXPECT_EQ(head(*of_cells_, picture)["picture"]["width"], 60);
    EXPECT_EQ(reads_, 0);
}

TEST_F(GridViewOfCellFields, ColoursSolidsAndTheBoundaryWithTheCellsOfTheStep) {
    for (const char* color : {"number", "region"}) {
        ShowMessage message = colored_by(color);
        message.state.slices.clear();
        message.state.solid = SolidSide::above;
        EXPECT_EQ(triangles(*of_cells_, message), triangles(*all_, message)) << color;
        message.state.solid.reset();
        message.state.boundary = 1;
        message.state.colored_boundary = true;
        EXPECT_EQ(triangles(*of_cells_, message), triangles(*all_, message)) << color;
        ShowMessage picture = show_volume(2, "ramp", {0.7});
        picture.state.volume.reset();
        picture.state.isosurfaces = true;
        picture.state.boundary = 1;
        picture.state.colored_boundary = true;
        picture.state.color_by = color;
        EXPECT_EQ(head(*of_cells_, picture)["picture"]["width"], 60);
    }
    EXPECT_EQ(reads_, 1);
    PickMessage pick;
    pick.state.boundary = 1;
    pick.boundary = true;
    pick.point = {0.31, 0.42, 0};
    for (const std::uint64_t step : {0, 1}) {
        ShowMessage message = show(3, {0.7});
        message.state.step = step;
        triangles(*of_cells_, message);
        const Picked picked = of_cells_->pick(pick, {}).value();
        const auto value = [&](const char* name) {
            return std::ranges::find(picked.values, name, &PickedValue::name)->values.at(0);
        };
        EXPECT_EQ(std::llround(3 * (value("number") - static_cast<double>(step))) % 5 + static_cast<int>(step),
                  value("region"))
            << step;
    }
    EXPECT_EQ(reads_, 2) << "the cells of the other step came with its fields";
}

TEST(SampleOfCells, HasCellsOfTheGridAndSaysHowManyEachStandsFor) {
    const Grid grid = made_grid(20);
    const CellSample sample = sample_of_cells(grid);
    EXPECT_LT(sample.grid.cells.count(), grid.cells.count());
    EXPECT_DOUBLE_EQ(sample.cells_each * static_cast<double>(sample.grid.cells.count()),
                     static_cast<double>(grid.cells.count()));
    EXPECT_TRUE(survey(sample.grid));
}

} // namespace
} // namespace isotet::test
