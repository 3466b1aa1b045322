// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Made grids are what the header of make.hpp says they are.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <span>

#include <gtest/gtest.h>

#include <isotet/make.hpp>

namespace {

using namespace isotet;

struct Case {
    std::string shape;
    std::uint64_t side;
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
    return info.param.shape + "_" + std::to_string(info.param.side);
}

void PrintTo(const Case& shape, std::ostream* out) { *out << "make:" << shape.shape << ":" << shape.side; }

Grid made(const std::string& shape, std::uint64_t side, std::uint64_t seed = 1, int threads = 0) {
    MakeOptions options;
    options.shape = shape;
    options.side = side;
    options.seed = seed;
    options.fields = make_fields();
    return make_grid(options, {.threads = threads}).value();
}

bool same_bytes(const Array& a, const Array& b) {
    return a.type() == b.type() && a.tuples() == b.tuples() && a.components() == b.components() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

bool same_bytes(const Grid& a, const Grid& b) {
    if (!same_bytes(a.points, b.points) || !same_bytes(a.cells.connectivity, b.cells.connectivity) ||
        !same_bytes(a.cells.offsets, b.cells.offsets) || !same_bytes(a.cells.types, b.cells.types))
        return false;
    return std::ranges::equal(a.point_fields, b.point_fields, [](const Field& f, const Field& g) {
        return f.name == g.name && same_bytes(f.values, g.values);
    });
}

std::array<double, 3> point(const Grid& grid, std::uint64_t p) {
    const auto x = grid.points.as<float>().subspan(3 * p, 3);
    return {x[0], x[1], x[2]};
}

double volume(const Grid& grid, std::uint64_t p, std::uint64_t q, std::uint64_t r, std::uint64_t s) {
    const auto a = point(grid, p), b = point(grid, q), c = point(grid, r), d = point(grid, s);
    const auto u = std::array{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const auto v = std::array{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const auto w = std::array{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0])) /
           6;
}

// VTK's faces of a cell, counter-clockwise seen from outside; of a wedge those of VTK since 9.2, and of Gmsh and Exodus.
std::vector<std::vector<std::size_t>> faces_of(int type) {
    switch (type) {
    case 10: return {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
    case 12: return {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    case 13: return {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    default: return {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    }
}

/// A face from its lowest corner, in its direction.
std::vector<std::int64_t> lowest_first(std::vector<std::int64_t> face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

/// Calls body(type, corners) for every cell.
template <class Body>
void for_cells(const Grid& grid, const Body& body) {
    const auto connectivity = grid.cells.connectivity.as<std::int32_t>();
    const std::map<int, std::size_t> sizes{{10, 4}, {12, 8}, {13, 6}, {14, 5}};
    std::size_t start = 0;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        const bool uniform = grid.cells.types.empty();
        const int type =
            uniform ? static_cast<int>(grid.cells.uniform_type) : grid.cells.types.as<std::uint8_t>()[cell];
        if (!uniform) {
            ASSERT_EQ(static_cast<std::size_t>(grid.cells.offsets.at(cell)), start);
        }
        body(type, connectivity.subspan(start, sizes.at(type)));
        start += sizes.at(type);
    }
    EXPECT_EQ(start, connectivity.size());
}

/// Directed faces of all cells and how often each occurs.
std::map<std::vector<std::int64_t>, int> directed_faces(const Grid& grid) {
    std::map<std::vector<std::int64_t>, int> faces;
    for_cells(grid, [&](int type, std::span<const std::int32_t> corners) {
        for (const auto& face : faces_of(type)) {
            std::vector<std::int64_t> points;
            for (const std::size_t corner : face) points.push_back(corners[corner]);
            ++faces[lowest_first(points)];
        }
    });
    return faces;
}

bool is_on_cube(const Grid& grid, const std::vector<std::int64_t>& face) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0})
            if (std::ranges::all_of(
                    face, [&](std::int64_t p) { return grid.points.at(static_cast<std::size_t>(p), axis) == side; }))
                return true;
    return false;
}

class MakeShape : public testing::TestWithParam<Case> {};

TEST_P(MakeShape, FillsTheCubeWithUprightCells) {
    const Grid grid = made(GetParam().shape, GetParam().side);
    double sum = 0, smallest = 8;
    for_cells(grid, [&](int type, std::span<const std::int32_t> corners) {
        // Pyramids from the cell's first corner to its faces: they add up to the cell when its faces look outward.
        double cell = 0;
        for (const auto& face : faces_of(type))
            for (std::size_t i = 2; i < face.size(); ++i)
                cell += volume(grid, corners[0], corners[face[0]], corners[face[i - 1]], corners[face[i]]);
        sum += cell;
        smallest = std::min(smallest, cell);
    });
    EXPECT_GT(smallest, 0);
    EXPECT_NEAR(sum, 8, 1e-5);
}

TEST_P(MakeShape, IsSplitIntoTetsThatFillTheCube) {
    const Grid grid = made(GetParam().shape, GetParam().side);
    const TetList list = split(grid).value();
    double sum = 0;
    for (const auto& t : list.tets) sum += std::abs(volume(grid, t[0], t[1], t[2], t[3]));
    EXPECT_NEAR(sum, 8, 1e-5);
}

TEST_P(MakeShape, HasNothingForTheSurveyToComplainOf) {
    const Grid grid = made(GetParam().shape, GetParam().side);
    const GridReport report = survey(grid).value();
    EXPECT_EQ(report.negative_tets, 0u);
    EXPECT_EQ(report.flat_tets, 0u);
    EXPECT_EQ(report.collapsed_tets, 0u);
    EXPECT_EQ(report.repeated_tets, 0u);
    EXPECT_EQ(report.unused_points, 0u);
    EXPECT_EQ(report.duplicate_points, 0u);
    EXPECT_EQ(report.boundary_faces, 12 * GetParam().side * GetParam().side);
    EXPECT_EQ(report.lower, (std::array<double, 3>{-1, -1, -1}));
    EXPECT_EQ(report.upper, (std::array<double, 3>{1, 1, 1}));
}

TEST_P(MakeShape, SharesEachInnerFaceBetweenTwoCellsInOppositeDirections) {
    const Grid grid = made(GetParam().shape, GetParam().side);
    const auto faces = directed_faces(grid);
    for (const auto& [face, count] : faces) {
        ASSERT_EQ(count, 1);
        const bool has_partner = faces.contains(lowest_first({face.rbegin(), face.rend()}));
        ASSERT_NE(has_partner, is_on_cube(grid, face));
    }
}

INSTANTIATE_TEST_SUITE_P(All, MakeShape,
                         testing::Values(Case{"kuhn", 1}, Case{"kuhn", 7}, Case{"perturbed", 9}, Case{"shuffled", 1},
                                         Case{"shuffled", 8}, Case{"layer", 1}, Case{"layer", 2}, Case{"layer", 12},
                                         Case{"hex", 1}, Case{"hex", 6}, Case{"wedge", 1}, Case{"wedge", 6},
                                         Case{"pyramid", 1}, Case{"pyramid", 5}, Case{"mixed", 1}, Case{"mixed", 2},
                                         Case{"mixed", 3}, Case{"mixed", 10}),
                         name_of);

TEST(MakeGrid, HasAsManyPointsAndCellsAsTheShapeSays) {
    const std::map<std::string, std::array<std::size_t, 2>> expected{
        {"kuhn", {343, 1296}},
        {"perturbed", {343, 1296}},
        {"shuffled", {343, 1296}},
        {"layer", {343, 1296}},
        {"hex", {343, 216}},
        {"wedge", {343, 432}},
        {"pyramid", {559, 1296}},
        {"tet10", {2197, 1296}},
        {"curved", {2197, 1296}},
        {"hex27", {2197, 216}},
        {"kelvin", {3672, 432}},
        {"octree", {3179, 2176}}, // of 216 cubes and their eighths 280 are cut: 216 + 7 * 280
        {"octree-random", {4904, 2351}},
        {"octree-bent", {4904, 2351}},
        {"octree-tets", {4904, 6 * 2351}},
        // two layers of hexahedra, two of pyramids and tets under wedges, one of each above, of 36 cubes
        {"mixed", {343 + 3 * 36, 36 * (2 * 1 + 2 * 7 + 2 + 7)}}};
    for (const std::string& shape : make_shapes()) {
        const Grid grid = made(shape, 6);
        EXPECT_EQ(grid.points.tuples(), expected.at(shape)[0]) << shape;
        EXPECT_EQ(grid.cells.count(), expected.at(shape)[1]) << shape;
    }
}

TEST(MakeGrid, HasPolyhedraWithFacesThatLookOutwards) {
    const Grid grid = made("kelvin", 3);
    const auto faces = grid.cells.faces.as<std::int32_t>();
    const auto starts = grid.cells.face_offsets.as<std::int64_t>();
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
        auto at = static_cast<std::size_t>(starts[cell]);
        double sum = 0;
        const auto count = static_cast<std::size_t>(faces[at++]);
        const auto apex = static_cast<std::uint64_t>(faces[at + 1]);
        for (std::size_t face = 0; face < count; ++face) {
            const auto corners = faces.subspan(at + 1, static_cast<std::size_t>(faces[at]));
            at += corners.size() + 1;
            for (std::size_t i = 2; i < corners.size(); ++i) {
                const double part = volume(grid, apex, static_cast<std::uint64_t>(corners[0]),
                                           static_cast<std::uint64_t>(corners[i - 1]),
                                           static_cast<std::uint64_t>(corners[i]));
                EXPECT_GT(part, -1e-9) << "cell " << cell << ", face " << face;
                sum += part;
            }
        }
        EXPECT_GT(sum, 0) << cell;
    }
}

TEST(MakeGrid, IsTheSameBytesForAnyNumberOfThreads) {
    for (const std::string& shape : make_shapes()) {
        const std::uint64_t side = shape.starts_with("octree") ? 10 : 32;
        const Grid one = made(shape, side, 5, 1);
        EXPECT_TRUE(same_bytes(one, made(shape, side, 5, 2))) << shape;
        EXPECT_TRUE(same_bytes(one, made(shape, side, 5, 7))) << shape;
    }
}

TEST(MakeGrid, CountsPointsAlongXFirst) {
    const Grid grid = made("kuhn", 2);
    EXPECT_EQ(point(grid, 1), (std::array<double, 3>{0, -1, -1}));
    EXPECT_EQ(point(grid, 3), (std::array<double, 3>{-1, 0, -1}));
    EXPECT_EQ(point(grid, 9), (std::array<double, 3>{-1, -1, 0}));
    EXPECT_EQ(point(grid, 13), (std::array<double, 3>{0, 0, 0}));
}

TEST(MakeGrid, MixesAllFourTypesFromSideThreeOn) {
    const Grid grid = made("mixed", 3);
    const auto types = grid.cells.types.as<std::uint8_t>();
    EXPECT_EQ(std::set<int>(types.begin(), types.end()), (std::set<int>{10, 12, 13, 14}));
}

TEST(MakeGrid, GradesTheLayerToAspectRatioOneThousand) {
    const Grid grid = made("layer", 50);
    const double step_x = grid.points.at(1, 0) - grid.points.at(0, 0);
    const double step_z = grid.points.at(51 * 51, 2) - grid.points.at(0, 2);
    EXPECT_NEAR(step_x / step_z, 1000, 2);
}

TEST(MakeGrid, MovesInnerPointsByAtMostAFifthOfTheSpacingAndNoOthers) {
    const Grid even = made("kuhn", 10), moved = made("perturbed", 10);
    double farthest = 0;
    for (std::size_t p = 0; p < even.points.tuples(); ++p) {
        const auto a = point(even, p), b = point(moved, p);
        const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
        const bool inner = std::ranges::all_of(a, [](double x) { return std::abs(x) < 1; });
        EXPECT_EQ(distance > 0, inner) << p;
        farthest = std::max(farthest, distance);
    }
    EXPECT_LT(farthest, 0.04 + 1e-6);
    EXPECT_GT(farthest, 0.03);
}

TEST(MakeGrid, ShufflesThePerturbedGridAndChangesNothingElse) {
    const Grid plain = made("perturbed", 5), mixed_up = made("shuffled", 5);
    const auto corners_of_tets = [](const Grid& grid) {
        std::multiset<std::set<std::array<double, 3>>> all;
        const TetList list = split(grid).value();
        for (const auto& tet : list.tets) {
            std::set<std::array<double, 3>> corners;
            for (const std::uint64_t p : tet) corners.insert(point(grid, p));
            all.insert(corners);
        }
        return all;
    };
    EXPECT_EQ(corners_of_tets(plain), corners_of_tets(mixed_up));
    EXPECT_FALSE(same_bytes(plain.points, mixed_up.points));
    const auto first = mixed_up.cells.connectivity.as<std::int32_t>().first(24);
    EXPECT_GT(std::set<int>(first.begin(), first.end()).size(), 12u); // not the eight corners of one cube
}

TEST(MakeGrid, DependsOnTheSeedWhereSomethingIsDrawn) {
    EXPECT_FALSE(same_bytes(made("perturbed", 4, 1).points, made("perturbed", 4, 2).points));
    EXPECT_FALSE(same_bytes(made("shuffled", 4, 1).cells.connectivity, made("shuffled", 4, 2).cells.connectivity));
    EXPECT_TRUE(same_bytes(made("kuhn", 4, 1).points, made("kuhn", 4, 2).points));
}

TEST(MakeGrid, NamesTheKnownShapesNearestFirstWhenAShapeIsUnknown) {
    MakeOptions options;
    options.shape = "hexx";
    const auto grid = make_grid(options);
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(grid.error().message.find("'hexx', but must be one of hex, "), std::string::npos) << grid.error().message;
}

TEST(MakeGrid, RefusesASideThatIsZeroOrHuge) {
    for (const std::uint64_t side : {std::uint64_t{0}, std::uint64_t{4097}, ~std::uint64_t{0}}) {
        MakeOptions options;
        options.side = side;
        const auto grid = make_grid(options);
        ASSERT_FALSE(grid) << side;
        EXPECT_EQ(grid.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(grid.error().message.find(std::to_string(side)), std::string::npos);
    }
}

TEST(MakeGrid, SaysHowMuchMemoryItWouldNeedBeforeItTakesIt) {
    MakeOptions options;
    options.side = 4096; // 13 TB
    const auto grid = make_grid(options);
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::out_of_memory);
}

TEST(MakeGrid, EndsWithCancelledWhenItIsCancelled) {
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto grid = make_grid({}, {.progress = progress});
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::cancelled);
}

TEST(MakeGrid, ReportsProgressThatRisesToOne) {
    std::vector<double> fractions;
    Progress progress;
    progress.report = [&](std::string_view, double fraction) { fractions.push_back(fraction); };
    make_grid({}, {.progress = progress}).value();
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_EQ(fractions.back(), 1);
}

} // namespace
