// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// refine() and linearize() on quadratic cells: what holds on any grid, any field, any numbers.
#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>

#include "linear/curved_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

/// Triangles of tets that only one tet has, by their points.
std::size_t single_faces(const LinearGrid& linear) {
    std::map<std::array<double, 3>, int> faces;
    const TetList tets = split(linear.grid).value();
    for (const auto& tet : tets.tets)
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            std::array<double, 3> face{};
            for (std::size_t k = 0, to = 0; k < 4; ++k)
                if (k != left_out) face[to++] = static_cast<double>(tet[k]);
            std::ranges::sort(face);
            ++faces[face];
        }
    std::size_t single = 0;
    for (const auto& [face, count] : faces) {
        EXPECT_LE(count, 2);
        single += count == 1;
    }
    return single;
}

/// `turned`   tets of wedges look the other way: their first triangle faces outwards
double volume_inside(const LinearGrid& linear, bool turned = false) {
    const Array& p = linear.grid.points;
    double sum = 0;
    for (const auto& t : split(linear.grid).value().tets) {
        std::array<At, 3> e{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) e[i][k] = p.at(t[i + 1], k) - p.at(t[0], k);
        const double part =
            (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
             e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
            6;
        sum += turned ? std::abs(part) : part;
    }
    return sum;
}

/// Each single face lies on the cube [-1, 1]^3 (which points' places before a warp tell): none is open inside.
void expect_no_hole_inside(const LinearGrid& linear) {
    std::map<std::array<std::uint64_t, 3>, int> faces;
    for (const auto& tet : split(linear.grid).value().tets)
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            std::array<std::uint64_t, 3> face{};
            for (std::size_t k = 0, to = 0; k < 4; ++k)
                if (k != left_out) face[to++] = tet[k];
            std::ranges::sort(face);
            ++faces[face];
        }
    for (const auto& [face, count] : faces) {
        ASSERT_LE(count, 2);
        if (count == 2) continue;
        bool outside = false;
        for (std::size_t k = 0; k < 3; ++k)
            for (const double side : {-1.0, 1.0}) {
                bool all = true;
                for (const std::uint64_t point : face)
                    all = all && std::abs(linear.grid.points.at(point, k) - side) < 1e-9;
                outside = outside || all;
            }
        ASSERT_TRUE(outside) << "the face " << face[0] << " " << face[1] << " " << face[2] << " has one tet";
    }
}

/// Triangles by their positions, each from its lowest vertex, in order: independent of the numbers of vertices.
std::vector<std::array<double, 9>> triangles_of(const Surface& surface) {
    std::vector<std::array<double, 9>> out(surface.triangle_count());
    for (std::size_t t = 0; t < out.size(); ++t) {
        std::array<At, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c)
                corners[k][c] = surface.positions.at(static_cast<std::size_t>(surface.triangles.at(t, k)), c);
        std::ranges::rotate(corners, std::ranges::min_element(corners));
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c) out[t][3 * k + c] = corners[k][c];
    }
    std::ranges::sort(out);
    return out;
}

Surface surface_of(const LinearGrid& linear, const PointField& field, double isovalue) {
    PointField longer = field;
    longer.values = linear.extend(field.values).value();
    DirectOptions options;
    options.precision = Precision::float64;
    return extract_direct(linear.grid, longer, std::span(&isovalue, 1), options).value().surfaces.at(0).surface;
}

TEST(CurvedCells, ReproduceQuadraticFieldsAtTheirNodesInEveryKind) {
    for (const std::string shape : {"kuhn", "hex", "wedge", "pyramid", "mixed"})
        for (const unsigned seed : {1u, 2u}) {
            const CurvedGrid made =
                curved_grid({.shape = shape, .side = 2, .seed = seed, .shuffle = true, .field = quadric});
            for (const LinearGrid& linear :
                 {linearize(made.grid).value(), refine(made.grid, made.field, {.tolerance = 0.05}).value()}) {
                const Array values = linear.extend(made.field.values).value();
                for (std::size_t i = 0; i < values.tuples(); ++i) {
                    const At p{linear.grid.points.at(i, 0), linear.grid.points.at(i, 1), linear.grid.points.at(i, 2)};
                    ASSERT_NEAR(values.at(i), quadric(p), 1e-12) << shape;
                }
                ASSERT_NEAR(volume_inside(linear, shape == "wedge" || shape == "mixed"), 8, 1e-9) << shape;
            }
        }
}

TEST(CurvedCells, OfAllKindsAreSplitTheSameFromBothSides) {
    for (const double keep_linear : {0.0, 0.3})
        for (const std::uint32_t seed : Seeds(1, 3)) {
            const CurvedGrid made =
                curved_grid({.side = 3, .seed = seed, .shuffle = seed > 1, .field = wave, .keep_linear = keep_linear});
            expect_no_hole_inside(linearize(made.grid).value());
            const LinearGrid refined = refine(made.grid, made.field, {.tolerance = 0.05}).value();
            ASSERT_GT(refined.refinement.tets, refined.refinement.quadratic_tets);
            expect_no_hole_inside(refined);
        }
}

TEST(CurvedCells, WithCurvedEdgesAreSplitTheSameFromBothSides) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const CurvedGrid flat = curved_grid({.side = 3, .seed = seed, .shuffle = true, .field = wave});
        const CurvedGrid bent = curved_grid({.side = 3, .seed = seed, .shuffle = true, .warp = bulge, .field = wave});
        const LinearGrid coarse = linearize(flat.grid).value();
        EXPECT_EQ(single_faces(coarse), single_faces(linearize(bent.grid).value()));
        const LinearGrid refined =
            refine(bent.grid, bent.field, {.tolerance = 0.05, .geometry_tolerance = 0.002}).value();
        EXPECT_LE(refined.refinement.geometry_bound, 0.002);
        const Surface boundary = boundary_of(refined.grid).value();
        const SurfaceReport report = check(boundary).value();
        EXPECT_EQ(report.boundary_edges, 0u);
        EXPECT_EQ(boundary.triangle_count(), single_faces(refined));
    }
}

TEST(CurvedCells, WithTiedLengthsAndRandomIntegersStayClosed) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        std::mt19937 random(seed);
        const CurvedGrid made = curved_grid(
            {.shape = seed % 2 ? "mixed" : "kuhn", .side = 2, .seed = seed, .shuffle = true, .field = [&](At) {
                 return static_cast<double>(random() % 5);
             }});
        expect_no_hole_inside(refine(made.grid, made.field, {.tolerance = 0.5}).value());
    }
}

TEST(Refine, KeepsItsBoundAtRandomPlaces) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    const CurvedGrid made = curved_grid({.shape = "kuhn", .side = 2, .seed = 2, .field = quadric});
    for (const double tolerance : some_of({0.01, 0.1, 0.001})) {
        const LinearGrid linear = refine(made.grid, made.field, {.tolerance = tolerance}).value();
        EXPECT_LE(linear.refinement.field_bound, tolerance);
        EXPECT_FALSE(linear.refinement.too_fine);
        const Array values = linear.extend(made.field.values).value();
        double worst = 0;
        for (const auto& tet : split(linear.grid).value().tets)
            for (int n = 0; n < 4; ++n) {
                std::array<double, 4> weight{};
                double sum = 0, mean = 0;
                for (double& w : weight) sum += w = -std::log(uniform(random) + 1e-12);
                At p{};
                for (std::size_t i = 0; i < 4; ++i) {
                    mean += weight[i] / sum * values.at(tet[i]);
                    for (std::size_t k = 0; k < 3; ++k) p[k] += weight[i] / sum * linear.grid.points.at(tet[i], k);
                }
                worst = std::max(worst, std::abs(mean - quadric(p)));
            }
        EXPECT_LE(worst, linear.refinement.field_bound);
        EXPECT_GT(worst, linear.refinement.field_bound / 10) << "the bound says nothing";
    }
}

/// A plane needs no bisecting, but the wave that its cut carries does; neighbours agree on both.
TEST(Refine, FollowsCarriedFieldsToo) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const CurvedGrid made = curved_grid({.side = 3, .seed = seed, .shuffle = seed > 1, .field = wave});
        std::vector<double> heights(made.grid.points.tuples());
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = made.grid.points.at(i, 2);
        const PointField plane{"z", Array::own(std::move(heights)), false, {}};
        RefineOptions options;
        const LinearGrid alone = refine(made.grid, plane, options).value();
        options.carried = {{"wave", made.field.values}};
        const LinearGrid both = refine(made.grid, plane, options).value();
        EXPECT_EQ(alone.refinement.tets, alone.refinement.quadratic_tets);
        EXPECT_GT(both.refinement.tets, both.refinement.quadratic_tets);
        expect_no_hole_inside(both);
        const double before = field_bound(alone, made.field.values).value(),
                     after = field_bound(both, made.field.values).value();
        EXPECT_LT(after, before / 8);
        options.isovalues = {0.137};
        const LinearGrid some = refine(made.grid, plane, options).value();
        EXPECT_LT(some.refinement.tets, both.refinement.tets);
        EXPECT_EQ(triangles_of(surface_of(both, plane, 0.137)), triangles_of(surface_of(some, plane, 0.137)));
    }
}

TEST(Refine, PassesOverCarriedValuesThatAreNotThere) {
    const CurvedGrid made = curved_grid({.side = 3, .seed = 1, .field = wave});
    std::vector<double> values(made.grid.points.tuples()), heights(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = i % 11 == 3 ? NAN : made.field.values.at(i);
        heights[i] = made.grid.points.at(i, 2);
    }
    const PointField plane{"z", Array::own(std::move(heights)), false, {}};
    RefineOptions options;
    options.carried = {{"wave", Array::own(std::move(values))},
                       {"ids", Array::own(std::vector<std::int32_t>(made.grid.points.tuples(), 7))}};
    const LinearGrid linear = refine(made.grid, plane, options).value();
    EXPECT_GT(linear.refinement.tets, linear.refinement.quadratic_tets);
    expect_no_hole_inside(linear);
    options.carried[1].values = Array::own(std::vector<float>{1});
    EXPECT_EQ(refine(made.grid, plane, options).error().code, ErrorCode::invalid_argument);
}

/// Of a triquadratic hexahedron the values at vertices of the cut are near the cell's own.
TEST(Refine, FollowsTheCellsOwnFunctionsOfCarriedFields) {
    const Grid grid = make_grid({.shape = "hex27", .side = 3, .fields = {"gyroid"}}).value();
    std::vector<double> heights(grid.points.tuples());
    for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = grid.points.at(i, 2);
    const PointField plane{"z", Array::own(std::move(heights)), false, {}};
    RefineOptions options;
    options.carried = {grid.point_fields[0]};
    options.isovalues = {0.137};
    const LinearGrid linear = refine(grid, plane, options).value();
    const Surface cut = surface_of(linear, plane, 0.137);
    ASSERT_GT(cut.triangle_count(), 100u);
    // Each cube is one cell with nodes at thirds of the unit: the product of quadratic interpolants of its nodes.
    const Array carried = linear.extend(grid.point_fields[0].values).value();
    std::map<std::array<long, 3>, double> at_node;
    const auto key = [](double x, double y, double z) {
        return std::array{std::lround(3 * (x + 1)), std::lround(3 * (y + 1)), std::lround(3 * (z + 1))};
    };
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        at_node[key(grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2))] =
            grid.point_fields[0].values.at(i);
    const auto own = [&](const std::array<double, 3>& p) {
        std::array<std::array<double, 3>, 3> weight{};
        std::array<long, 3> first{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double along = 1.5 * (p[k] + 1);
            const double cell = std::clamp(std::floor(along), 0.0, 2.0), x = along - cell;
            first[k] = 2 * std::lround(cell);
            weight[k] = {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)};
        }
        double sum = 0;
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b)
                for (std::size_t c = 0; c < 3; ++c)
                    sum += weight[0][a] * weight[1][b] * weight[2][c] *
                           at_node.at({first[0] + static_cast<long>(a), first[1] + static_cast<long>(b),
                                       first[2] + static_cast<long>(c)});
        return sum;
    };
    double worst = 0;
    for (std::size_t i = 0; i < linear.grid.points.tuples(); ++i)
        worst = std::max(worst, std::abs(carried.at(i) - own({linear.grid.points.at(i, 0), linear.grid.points.at(i, 1),
                                                              linear.grid.points.at(i, 2)})));
    EXPECT_LT(worst, 0.15) << "at points";
    for (const auto& tet : split(linear.grid).value().tets) {
        std::array<double, 3> middle{};
        double mean = 0;
        for (const std::uint64_t corner : tet) {
            mean += carried.at(corner) / 4;
            for (std::size_t k = 0; k < 3; ++k) middle[k] += linear.grid.points.at(corner, k) / 4;
        }
        worst = std::max(worst, std::abs(mean - own(middle)));
    }
    EXPECT_LT(worst, 0.15) << "in tets; in those that the plane alone needs it is more than 1";
}

TEST(Refine, GivesTheSameSurfacePrunedAndUnpruned) {
    for (const unsigned seed : {1u, 2u}) {
        const CurvedGrid made =
            curved_grid({.side = 3, .seed = seed, .shuffle = true, .warp = bulge, .field = wave, .keep_linear = 0.1});
        const LinearGrid all = refine(made.grid, made.field, {.tolerance = 0.05}).value();
        const std::vector<double> isovalues{0.4, -0.3, 0};
        const LinearGrid some = refine(made.grid, made.field, {.tolerance = 0.05, .isovalues = isovalues}).value();
        EXPECT_LT(some.refinement.tets, all.refinement.tets);
        EXPECT_EQ(some.refinement.isovalues, (std::vector<double>{-0.3, 0, 0.4}));
        for (const double isovalue : isovalues) {
            const Surface a = surface_of(all, made.field, isovalue), b = surface_of(some, made.field, isovalue);
            ASSERT_GT(a.triangle_count(), 100u);
            const auto mine = triangles_of(a), pruned = triangles_of(b);
            ASSERT_EQ(mine.size(), pruned.size());
            for (std::size_t t = 0; t < mine.size(); ++t)
                for (std::size_t k = 0; k < 9; ++k) ASSERT_NEAR(mine[t][k], pruned[t][k], 1e-12);
        }
    }
}

TEST(Refine, LeavesOutCellsWhereTheFieldIsJustTheIsovalue) {
    const auto plateau = [](At p) { return std::max(0.0, p[0] - 0.1) + 0.3; };
    const CurvedGrid made = curved_grid({.side = 4, .seed = 2, .shuffle = true, .warp = bulge, .field = plateau});
    const LinearGrid all = refine(made.grid, made.field, {.tolerance = 0.01}).value();
    const double isovalue = made.field.values.at(0) < 0.3001 ? made.field.values.at(0) : 0.3;
    const LinearGrid some = refine(made.grid, made.field, {.tolerance = 0.01, .isovalues = {isovalue}}).value();
    EXPECT_LT(some.refinement.tets, all.refinement.tets / 2) << "half of the grid has that value alone";
    EXPECT_EQ(triangles_of(surface_of(all, made.field, isovalue)),
              triangles_of(surface_of(some, made.field, isovalue)));

    const CurvedGrid flat = curved_grid({.side = 2, .warp = bulge, .field = [](At) { return 0.1; }});
    const LinearGrid none = refine(flat.grid, flat.field, {.isovalues = {flat.field.values.at(0)}}).value();
    EXPECT_EQ(surface_of(none, flat.field, flat.field.values.at(0)).triangle_count(), 0u);
    EXPECT_EQ(none.refinement.tets, none.grid.cells.count());
    EXPECT_LT(none.refinement.tets, refine(flat.grid, flat.field).value().refinement.tets / 8) << "one of 48";
}

TEST(Refine, OfWhatNoIsovalueMeetsIsAGridWithoutASurface) {
    const CurvedGrid made = curved_grid({.side = 2, .shuffle = true, .warp = bulge, .field = wave});
    for (const double isovalue : {-99.0, 99.0}) {
        const LinearGrid linear = refine(made.grid, made.field, {.tolerance = 0.05, .isovalues = {isovalue}}).value();
        EXPECT_GT(linear.grid.cells.count(), 0u);
        EXPECT_EQ(surface_of(linear, made.field, isovalue).triangle_count(), 0u);
        ContourOptions options;
        options.refine = RefineOptions{.tolerance = 0.05};
        Contour contour = Contour::create({made.grid, made.field, {}, {}}, options).value();
        const ContourResult result = contour.extract(isovalue).value();
        EXPECT_EQ(result.surfaces.at(0).surface.triangle_count(), 0u);
        EXPECT_GT(contour.extract(0.1).value().surfaces.at(0).surface.triangle_count(), 0u);
    }
}

TEST(Refine, GivesTheSameBytesForAnyThreadCount) {
    const CurvedGrid made = curved_grid({.side = 3, .seed = 5, .shuffle = true, .warp = bulge, .field = wave});
    const auto bytes = [](const Array& array) {
        return std::string(static_cast<const char*>(array.data()), array.bytes());
    };
    const LinearGrid one = refine(made.grid, made.field, {.tolerance = 0.05}, {.threads = 1}).value();
    for (const int threads : {2, 7}) {
        const LinearGrid many = refine(made.grid, made.field, {.tolerance = 0.05}, {.threads = threads}).value();
        EXPECT_TRUE(bytes(one.grid.points) == bytes(many.grid.points));
        EXPECT_TRUE(bytes(one.grid.cells.connectivity) == bytes(many.grid.cells.connectivity));
        EXPECT_TRUE(bytes(one.source_cells) == bytes(many.source_cells));
        EXPECT_EQ(one.refinement.field_bound, many.refinement.field_bound);
    }
}

TEST(Refine, OfASphereInSixTetsIsClosedAndNear) {
    const auto radius2 = [](At p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; };
    const CurvedGrid made = curved_grid({.shape = "kuhn", .side = 1, .field = radius2});
    const double radius = 0.7, isovalue = radius * radius;
    const LinearGrid linear = refine(made.grid, made.field, {.tolerance = 1e-3, .isovalues = {isovalue}}).value();
    const Surface sphere = surface_of(linear, made.field, isovalue);
    const SurfaceReport report = check(sphere).value();
    EXPECT_EQ(report.boundary_edges, 0u);
    EXPECT_GT(sphere.triangle_count(), 1000u);
    for (std::size_t i = 0; i < sphere.vertex_count(); ++i) {
        const double r = std::hypot(sphere.positions.at(i, 0), sphere.positions.at(i, 1), sphere.positions.at(i, 2));
        ASSERT_NEAR(r, radius, 0.002);
    }
}

/// Bisecting the longest marked edge never ends here: edges 12 and 23 are straight, and the others go round them.
TEST(Refine, EndsWhereLongEdgesAreStraight) {
    const std::vector<std::array<std::size_t, 2>> ends{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    const std::vector<double> bezier{-0.847758949, -0.853552729, -0.806562275, -0.41421406, -0.494205996, -0.146447942};
    std::vector<double> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1, 1};
    std::vector<double> values{-0.353553653, -1.06066012, -0.646446645, 0.3535541};
    for (std::size_t e = 0; e < 6; ++e) {
        const auto [a, b] = ends[e];
        for (std::size_t k = 0; k < 3; ++k) points.push_back((points[3 * a + k] + points[3 * b + k]) / 2);
        values.push_back((2 * bezier[e] + values[a] + values[b]) / 4);
    }
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 10});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{24});
    const PointField field{"f", Array::own(std::move(values)), false, {}};
    const LinearGrid linear = refine(grid, field, {.tolerance = 0.003, .isovalues = {0.2}}).value();
    EXPECT_FALSE(linear.refinement.too_fine);
    EXPECT_LE(linear.refinement.field_bound, 0.003);
    EXPECT_GT(linear.refinement.tets, 0u);
}

TEST(Refine, TellsTheBoundOfAnotherField) {
    const CurvedGrid made = curved_grid({.side = 3, .seed = 2, .shuffle = true, .warp = bulge, .field = wave});
    const CurvedGrid other = curved_grid({.side = 3, .seed = 2, .shuffle = true, .field = quadric});
    const LinearGrid linear = refine(made.grid, made.field, {.tolerance = 0.05}).value();
    EXPECT_LT(field_bound(linear, made.field.values).value(), linear.refinement.field_bound)
        << "of the quadratic field: without what the cells' own differ from it";
    const double bound = field_bound(linear, other.field.values).value();
    EXPECT_GT(bound, 0);
    const double finer = refine(other.grid, other.field, {.tolerance = bound / 4}).value().refinement.field_bound;
    EXPECT_LE(finer, bound / 4);
    const double coarse = field_bound(linearize(made.grid).value(), made.field.values).value();
    EXPECT_GT(coarse, linear.refinement.field_bound);
}

TEST(Refine, DropsTetsWithANodeThatIsNotFinite) {
    CurvedGrid made = curved_grid({.shape = "kuhn", .side = 2, .field = quadric});
    std::vector<double> values(made.field.values.as<double>().begin(), made.field.values.as<double>().end());
    values.back() = std::numeric_limits<double>::quiet_NaN();
    made.field.values = Array::own(std::move(values));
    const LinearGrid linear = refine(made.grid, made.field, {.tolerance = 0.05}).value();
    EXPECT_GT(linear.refinement.not_finite, 0u);
    EXPECT_LT(linear.refinement.not_finite, 48u);
    const Array longer = linear.extend(made.field.values).value();
    for (const auto& tet : split(linear.grid).value().tets)
        for (const std::uint64_t point : tet) ASSERT_TRUE(std::isfinite(longer.at(point)));
}

/// As of linear cells, nothing is there, which is no error.
TEST(Refine, OfACellWithoutAValueIsAGridWithoutASurface) {
    Grid grid;
    grid.points = Array::own(std::vector<double>{0,   0,   0, 1, 0,   0, 0, 1, 0,   0,   0, 1,   0.5, 0,   0,
                                                 0.5, 0.5, 0, 0, 0.5, 0, 0, 0, 0.5, 0.5, 0, 0.5, 0,   0.5, 0.5},
                             3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 10});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{24});
    for (std::size_t node = 0; node < 10; ++node)
        for (const std::vector<double>& isovalues : {std::vector<double>{}, {0.3}}) {
            std::vector<double> values;
            for (std::size_t i = 0; i < 10; ++i) values.push_back(i == node ? NAN : grid.points.at(i, 0));
            const PointField field{"x", Array::own(std::move(values)), false, {}};
            RefineOptions options;
            options.isovalues = isovalues;
            const LinearGrid linear = refine(grid, field, options).value();
            EXPECT_EQ(linear.grid.cells.count(), 1u);
            EXPECT_EQ(linear.refinement.not_finite, 1u);
            EXPECT_EQ(surface_of(linear, field, 0.3).triangle_count(), 0u) << "node " << node;
        }
}

TEST(Refine, RefusesWhatDoesNotFit) {
    CurvedGrid made = curved_grid({.shape = "kuhn", .side = 1, .field = quadric});
    EXPECT_EQ(refine(made.grid, made.field, {.tolerance = -1}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(refine(made.grid, made.field, {.relative_tolerance = 0}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(refine(made.grid, {"f", {}, false, {}}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(field_bound(linearize(made.grid).value(), {}).error().code, ErrorCode::invalid_argument);
    const auto tiny = refine(made.grid, made.field, {.tolerance = 1e-9, .max_tets = 100'000});
    ASSERT_FALSE(tiny);
    EXPECT_EQ(tiny.error().code, ErrorCode::out_of_memory) << tiny.error().message;
}

TEST(CurvedCells, WithAWrongNumberOfNodesAreRefusedByName) {
    for (const std::uint8_t type : {24, 25, 26, 27, 29, 31, 32, 33, 37}) {
        Grid grid;
        grid.points = Array::own(std::vector<double>(3 * 40, 0.5), 3);
        std::vector<std::int64_t> nodes(11);
        std::iota(nodes.begin(), nodes.end(), 0);
        grid.cells.connectivity = Array::own(nodes);
        grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 11});
        grid.cells.types = Array::own(std::vector<std::uint8_t>{type});
        const auto result = linearize(grid);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
        EXPECT_NE(result.error().message.find("has 11 nodes"), std::string::npos) << result.error().message;
        EXPECT_NE(result.error().message.find(name_of_cell_type(type)), std::string::npos) << result.error().message;
    }
}

TEST(CurvedCells, WithPointsOutOfRangeAreRefused) {
    CurvedGrid made = curved_grid({.shape = "hex", .side = 1, .field = quadric});
    std::vector<std::int64_t> nodes;
    for (std::size_t i = 0; i < made.grid.cells.connectivity.tuples(); ++i)
        nodes.push_back(static_cast<std::int64_t>(made.grid.cells.connectivity.at(i)));
    for (const std::int64_t wrong : {std::int64_t{-1}, std::int64_t{1} << 40}) {
        nodes.back() = wrong;
        made.grid.cells.connectivity = Array::own(nodes);
        const auto result = linearize(made.grid);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    }
}

TEST(CurvedCells, OfHigherDegreeAreLeftOutAndCounted) {
    CurvedGrid made = curved_grid({.shape = "kuhn", .side = 1, .field = quadric});
    std::vector<std::uint8_t> types(made.grid.cells.types.as<std::uint8_t>().begin(),
                                    made.grid.cells.types.as<std::uint8_t>().end());
    types[0] = 79;
    made.grid.cells.types = Array::own(types);
    EXPECT_EQ(linearize(made.grid).value().refinement.unknown_cells, 1u);
    std::ranges::fill(types, std::uint8_t{79});
    made.grid.cells.types = Array::own(types);
    EXPECT_EQ(linearize(made.grid).error().code, ErrorCode::invalid_data);
}

} // namespace
} // namespace isotet::test
