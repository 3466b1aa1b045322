// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Overlapping boxes on several levels as one grid: which cells are left, values at points, closed surfaces,
// what is broken.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/read.hpp>

#include "readers/amr_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using io::amr::CellBox;
using io::amr::Hierarchy;

ReadResult read_amr(const AmrFile& file) {
    const TemporaryFolder folder;
    auto result = read(file.write(folder.file("")));
    EXPECT_TRUE(result) << result.error().message;
    return result ? *std::move(result) : ReadResult();
}

double volume_of(const Grid& grid) { return check(boundary_of(close_hanging_points(grid)->grid).value())->volume; }

double linear(const std::array<double, 3>& p) { return 0.5 + 0.3 * p[0] - 0.7 * p[1] + 0.2 * p[2]; }

std::array<double, 3> place_of(const Grid& grid, std::size_t point) {
    return {grid.points.at(point, 0), grid.points.at(point, 1), grid.points.at(point, 2)};
}

/// The largest difference from a field at points of the cube from -1 to 1, but for those near its sides.
double error_inside(const Grid& grid, const Value& value, double margin = 1e-9) {
    double most = 0;
    for (std::size_t point = 0; point < grid.points.tuples(); ++point) {
        const auto place = place_of(grid, point);
        if (std::max({std::abs(place[0]), std::abs(place[1]), std::abs(place[2])}) < 1 - margin)
            most = std::max(most, std::abs(grid.point_fields.at(0).values.at(point) - value(place)));
    }
    return most;
}

TEST(ReadAmr, CellsUnderFinerOnesAreLeftOutAndFillTheDomain) {
    for (const std::int64_t ratio : {2, 3, 4}) {
        const ReadResult result = read_amr({nested_boxes(2, ratio)});
        const std::int64_t finer = ratio * ratio * ratio, cells = 8 * 8 - 6 + finer * (6 - 1) + finer * finer;
        EXPECT_EQ(result.grid.cells.count(), static_cast<std::size_t>(cells));
        EXPECT_NEAR(volume_of(result.grid), 8, 1e-12);
    }
}

TEST(ReadAmr, LinearFieldsOfCellsAreTheSameAtPointsOnBothSidesOfLevels) {
    for (const std::int64_t ratio : {2, 3, 4})
        EXPECT_LT(error_inside(read_amr({nested_boxes(2, ratio), linear}).grid, linear), 1e-14);
}

TEST(ReadAmr, ConstantFieldsStayConstantToTheBit) {
    const ReadResult result = read_amr({nested_boxes(2, 3), [](const auto&) { return 0.1; }});
    for (std::size_t point = 0; point < result.grid.points.tuples(); ++point)
        ASSERT_EQ(result.grid.point_fields.at(0).values.at(point), 0.1);
}

TEST(ReadAmr, SpheresAreClosedAcrossLevelsAndConvergeAtSecondOrder) {
    const Value distance = [](const std::array<double, 3>& p) { return std::hypot(p[0], p[1], p[2]); };
    constexpr double radius = 0.57, exact = 4 * std::numbers::pi * radius * radius;
    std::vector<double> errors;
    for (const std::int64_t n : {4, 8}) {
        const ReadResult result = read_amr({nested_boxes(n, 2), distance});
        const Grid grid = close_hanging_points(result.grid)->grid;
        const PointField field = find_field(grid, "s").value();
        auto session = Contour::create({grid, field, {}, {}}, {});
        const Surface surface = session->extract(radius)->surfaces[0].surface;
        const SurfaceReport report = check(surface).value();
        EXPECT_TRUE(report.closed);
        EXPECT_EQ(report.euler, 2);
        errors.push_back(std::abs(report.area / exact - 1));
    }
    EXPECT_GT(errors[0], 3 * errors[1]);
    EXPECT_LT(errors[1], 0.03);
}

/// Boxes of one level that do not meet, on random cells of a coarser one.
std::vector<CellBox> random_boxes(const CellBox& inside, std::int64_t ratio, std::mt19937& random) {
    std::vector<CellBox> out;
    for (int number = 0; number < 3; ++number) {
        CellBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::uniform_int_distribution<std::int64_t> along(inside.first[axis], inside.last[axis]);
            const auto [low, high] = std::minmax({along(random), along(random)});
            box.first[axis] = low * ratio;
            box.last[axis] = (high + 1) * ratio - 1;
        }
        out.push_back(box); // they may meet: cells of the first one count
    }
    return out;
}

TEST(ReadAmr, RandomBoxesThatOverlapFillTheDomainOnceAndKeepLinearFields) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        std::mt19937 random(seed);
        const std::int64_t ratio = seed % 2 == 0 ? 2 : 3;
        const double fine = 1.0 / 3 / static_cast<double>(ratio), finest = fine / static_cast<double>(ratio);
        const CellBox whole{{0, 0, 0}, {5, 5, 5}};
        Hierarchy all{
            {-1, -1, -1},
            {{{1.0 / 3, 1.0 / 3, 1.0 / 3}, {whole}}, {{fine, fine, fine}, {}}, {{finest, finest, finest}, {}}}};
        all.levels[1].boxes = random_boxes(whole, ratio, random);
        all.levels[2].boxes = random_boxes(all.levels[1].boxes[0], ratio, random);
        const ReadResult result = read_amr({all, linear});
        EXPECT_NEAR(volume_of(result.grid), 8, 1e-12) << "seed " << seed;
        // Corners at the sides have cells on one side only, and what hangs between them follows.
        EXPECT_LT(error_inside(result.grid, linear, 1.0 / 3 - 1e-9), 1e-14) << "seed " << seed;
    }
}

TEST(ReadAmr, GhostCellsOfFinerBoxesCoverNothing) {
    Hierarchy all = nested_boxes(4, 2);
    all.levels.pop_back();
    AmrFile plain{all, linear}, ghosts{all, linear, std::vector<std::vector<int>>(4)};
    CellBox& box = ghosts.boxes.levels[1].boxes[0];
    const CellBox inner = box;
    for (std::size_t axis = 0; axis < 3; ++axis) { // a layer around it
        --box.first[axis];
        ++box.last[axis];
    }
    ghosts.ghosts[2].assign(box.cells(), 1);
    for (std::int64_t z = inner.first[2]; z <= inner.last[2]; ++z)
        for (std::int64_t y = inner.first[1]; y <= inner.last[1]; ++y)
            for (std::int64_t x = inner.first[0]; x <= inner.last[0]; ++x) ghosts.ghosts[2][box.cell_at({x, y, z})] = 0;
    const Grid expected = read_amr(plain).grid, found = read_amr(ghosts).grid;
    EXPECT_EQ(found.cells.count(), expected.cells.count());
    EXPECT_EQ(found.points.tuples(), expected.points.tuples());
    EXPECT_NEAR(volume_of(found), 8, 1e-12);
}

TEST(ReadAmr, CellsThatTheFileBlanksAreLeftOut) {
    AmrFile file{{{0, 0, 0}, {{{1, 1, 1}, {{{0, 0, 0}, {1, 1, 1}}}}}}, linear, {{0, 8, 0, 32, 0, 0, 0, 0}}};
    EXPECT_EQ(read_amr(file).grid.cells.count(), 6u);
}

TEST(ReadAmr, FieldsAreReadInCellsOrAtPointsAsAskedFor) {
    const TemporaryFolder folder;
    const std::string path = AmrFile{nested_boxes(2, 2), linear}.write(folder.file(""));
    const FileInfo info = inspect(path).value();
    ASSERT_EQ(info.fields.size(), 2u);
    EXPECT_EQ(info.format, "vth");
    for (const bool at_points : {false, true}) {
        ReadOptions options;
        options.point_fields = std::vector<std::string>(at_points ? 1 : 0, "s");
        options.cell_fields = std::vector<std::string>(at_points ? 0 : 1, "s");
        const Grid grid = read(path, options).value().grid;
        EXPECT_EQ(grid.point_fields.size(), at_points ? 1u : 0u);
        EXPECT_EQ(grid.cell_fields.size(), at_points ? 0u : 1u);
    }
}

std::string error_of(const AmrFile& file) {
    const TemporaryFolder folder;
    const auto result = read(file.write(folder.file("")));
    EXPECT_FALSE(result);
    if (result) return {};
    EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    return result.error().message;
}

void expect_error(const AmrFile& file, const std::string& text) {
    const std::string error = error_of(file);
    EXPECT_NE(error.find(text), std::string::npos) << error;
}

AmrFile with_index(const std::string& from, const std::string& to) {
    AmrFile file{nested_boxes(2, 2)};
    file.changed_index = [=](std::string text) {
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos);
        return text.replace(at, from.size(), to);
    };
    return file;
}

TEST(ReadAmr, WhatDoesNotFitIsAnErrorThatSaysSo) {
    AmrFile file{nested_boxes(2, 2)};
    file.boxes.levels[2].spacing = {0.3, 0.125, 0.125};
    expect_error(file,
                 "the spacing along x is 0.25 in level 1 and 0.3 in level 2: that of a level must be a whole multiple");
    file = {nested_boxes(2, 2)};
    file.boxes.levels[1].boxes[0].last[0] += 40;
    expect_error(file, "reaches out of the boxes of level 0");
    file = {nested_boxes(2, 2)};
    file.boxes.levels.pop_back();
    file.boxes.levels[1].boxes[0].first[1] += 1;
    expect_error(file, "of level 0 is covered by cells of finer levels in part");
    file = {nested_boxes(2, 2)};
    file.moved_image = 0.1;
    expect_error(file, "along x, but its box from -1 to 1");
    expect_error(with_index("amr_box=\"0 3 0 3 0 1\"", "amr_box=\"0 3 0 3 0 2\""),
                 "the image has 3 points along z, but its box has 3 cells: one more point must be there");
    expect_error(with_index("amr_box=\"0 3", "amr_box=\"4 3"), "box 0 of level 0 goes from cell 4 to 3 along x");
    expect_error(with_index("amr_box=\"0 3", "amr_box=\"0 x"), "amr_box of an element DataSet is");
    expect_error(with_index(" file=\"0.vti\"", ""), "box 0 of level 0 names the file '', but must name a .vti");
    expect_error(with_index("spacing=\"0.5 0.5 0.5\"", ""), "spacing of an element Block is '', not 3 numbers");
    expect_error(with_index("spacing=\"0.5 0.5", "spacing=\"0 0.5"),
                 "the spacing of level 0 along x is 0, but must be above 0");
    expect_error(with_index("level=\"1\"", "level=\"2\""), "level '2' stands where level 1 should");
    expect_error(with_index("\"XYZ\"", "\"XY\""), "must be of three dimensions");
}

TEST(ReadAmr, AMissingPieceIsAnErrorWithItsName) {
    const TemporaryFolder folder;
    const std::string path = AmrFile{nested_boxes(2, 2)}.write(folder.file(""));
    std::filesystem::remove(folder.file("3.vti"));
    const auto result = read(path);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::file);
    EXPECT_NE(result.error().message.find("3.vti"), std::string::npos);
}

TEST(AmrLattice, TakesSpacingsOfSixDigits) {
    io::amr::Hierarchy boxes;
    for (const double spacing : {0.833333, 0.416667, 0.208333, 0.104167})
        boxes.levels.push_back({{spacing, spacing, spacing}, {{{0, 0, 0}, {1, 1, 1}}}});
    EXPECT_EQ(io::amr::Lattice::make(boxes).value().steps(0, 0), 8);
    boxes.levels[3].spacing[1] = 0.10418;
    EXPECT_FALSE(io::amr::Lattice::make(boxes));
}

} // namespace
} // namespace isotet::test
