// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lagrange cells of degree 3 and above, and Bezier cells.
#include <span>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>

#include "grid/cell/node_order.hpp"
#include "linear/curved/pyramid_weights.hpp"
#include "linear/curved_grid.hpp"

namespace isotet::test {
namespace {

using core::CellKind;

struct KindOfDegree {
    std::string shape;
    CellKind kind;
    int linear;
    std::uint8_t lagrange, bezier;
};

const std::vector<KindOfDegree> kinds{{"kuhn", CellKind::tetrahedron, 10, 71, 78},
                                      {"hex", CellKind::hexahedron, 12, 72, 79},
                                      {"wedge", CellKind::wedge, 13, 73, 80},
                                      {"pyramid", CellKind::pyramid, 14, 74, 0}};

/// Grids of one kind, and of all.
const std::vector<std::string> shapes{"kuhn", "hex", "wedge", "pyramid", "mixed"};

const KindOfDegree& kind_of_type(std::uint8_t linear_type) {
    return *std::ranges::find(kinds, static_cast<int>(linear_type), &KindOfDegree::linear);
}

/// The weights of a linear cell's corners.
std::vector<double> corner_weights(CellKind kind, const core::LatticePlace& node, unsigned degree) {
    const double u = node[0] / double(degree), v = node[1] / double(degree), w = node[2] / double(degree);
    if (kind == CellKind::tetrahedron) return {1 - u - v - w, u, v, w};
    if (kind == CellKind::wedge)
        return {(1 - u - v) * (1 - w), u * (1 - w), v * (1 - w), (1 - u - v) * w, u * w, v * w};
    if (kind == CellKind::pyramid) {
        const double a = w < 1 ? u / (1 - w) : 0, b = w < 1 ? v / (1 - w) : 0;
        return {(1 - a) * (1 - b) * (1 - w), a * (1 - b) * (1 - w), a * b * (1 - w), (1 - a) * b * (1 - w), w};
    }
    return {(1 - u) * (1 - v) * (1 - w), u * (1 - v) * (1 - w), u * v * (1 - w), (1 - u) * v * (1 - w),
            (1 - u) * (1 - v) * w,       u * (1 - v) * w,       u * v * w,       (1 - u) * v * w};
}

/// A made grid with cells of a degree; nodes at one place are one. Numbers of points are shuffled.
CurvedGrid grid_of_degree(const std::string& shape, unsigned degree, bool bezier,
                          const std::function<double(At)>& field, const std::function<At(At)>& warp = {}) {
    const Grid linear = make_grid({shape, 2, {"sphere"}, 3}).value();
    std::map<std::array<std::int64_t, 3>, std::size_t> known;
    std::vector<At> at;
    std::vector<std::size_t> cells;
    std::vector<std::int64_t> offsets{0};
    std::vector<std::uint8_t> types;
    std::size_t first = 0;
    for (std::size_t c = 0; c < linear.cells.count(); ++c) {
        const Cells& all = linear.cells;
        const KindOfDegree& kind = kind_of_type(all.types.empty() ? static_cast<std::uint8_t>(all.uniform_type)
                                                                  : all.types.as<std::uint8_t>()[c]);
        const std::size_t corners = core::corner_count(kind.kind);
        for (const auto& node : core::nodes_of_degree(kind.kind, degree, core::NodeOrder::vtk)) {
            const auto weights = corner_weights(kind.kind, node, degree);
            At place{};
            std::array<std::int64_t, 3> key{};
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t i = 0; i < corners; ++i) {
                    const auto point = static_cast<std::size_t>(all.connectivity.at(first + i));
                    place[k] += weights[i] * linear.points.at(point, k);
                }
                key[k] = std::llround(place[k] * 1e7);
            }
            const auto [found, is_new] = known.try_emplace(key, at.size());
            if (is_new) at.push_back(place);
            cells.push_back(found->second);
        }
        first += corners;
        offsets.push_back(static_cast<std::int64_t>(cells.size()));
        types.push_back(bezier ? kind.bezier : kind.lagrange);
    }
    std::vector<std::size_t> number(at.size());
    std::iota(number.begin(), number.end(), 0);
    std::ranges::shuffle(number, std::mt19937(degree));
    std::vector<double> points(3 * at.size()), values(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        std::ranges::copy(warp ? warp(at[i]) : at[i], points.begin() + static_cast<std::ptrdiff_t>(3 * number[i]));
        values[number[i]] = field(at[i]);
    }
    std::vector<std::int64_t> connectivity;
    for (const std::size_t node : cells) connectivity.push_back(static_cast<std::int64_t>(number[node]));
    CurvedGrid out;
    out.grid.points = Array::own(std::move(points), 3);
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    out.grid.cells.offsets = Array::own(std::move(offsets));
    out.grid.cells.types = Array::own(std::move(types));
    out.field = {"f", Array::own(std::move(values)), false, {}};
    return out;
}

double cubic(At p) { return p[0] * p[0] * p[0] - p[0] * p[1] * p[2] + 0.5 * p[2] * p[2] * p[1] - p[1]; }

void expect_field(const LinearGrid& linear, const Array& user, const std::function<double(At)>& exact,
                  const std::string& what) {
    const Array values = linear.extend(user).value();
    for (std::size_t i = 0; i < values.tuples(); ++i) {
        const At p{linear.grid.points.at(i, 0), linear.grid.points.at(i, 1), linear.grid.points.at(i, 2)};
        ASSERT_NEAR(values.at(i), exact(p), 1e-10) << what;
    }
}

/// Triangles of one tet lie on the cube's faces, and their area is the cube's: neighbours agree.
void expect_closed(const LinearGrid& linear, const std::string& what) {
    std::map<std::array<std::uint64_t, 3>, int> faces;
    for (const auto& tet : split(linear.grid).value().tets)
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            std::array<std::uint64_t, 3> face{};
            for (std::size_t k = 0, to = 0; k < 4; ++k)
                if (k != left_out) face[to++] = tet[k];
            std::ranges::sort(face);
            ++faces[face];
        }
    double area = 0;
    for (const auto& [face, count] : faces) {
        ASSERT_LE(count, 2) << what;
        if (count == 2) continue;
        At a{}, b{}, n{};
        for (std::size_t k = 0; k < 3; ++k) {
            a[k] = linear.grid.points.at(face[1], k) - linear.grid.points.at(face[0], k);
            b[k] = linear.grid.points.at(face[2], k) - linear.grid.points.at(face[0], k);
        }
        for (std::size_t k = 0; k < 3; ++k) n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        area += std::hypot(n[0], n[1], n[2]) / 2;
    }
    ASSERT_NEAR(area, 24, 1e-9) << what;
}

TEST(HighDegree, KeepsQuadraticFieldsAndNeighboursTogether) {
    for (const std::string& shape : shapes)
        for (const unsigned degree : {3u, 4u, 5u}) {
            const std::string what = shape + " " + std::to_string(degree);
            const CurvedGrid made = grid_of_degree(shape, degree, false, quadric);
            const LinearGrid linear = refine(made.grid, made.field, {.tolerance = 0.05}).value();
            EXPECT_EQ(linear.refinement.curved_cells, made.grid.cells.count()) << what;
            EXPECT_EQ(linear.refinement.left_out, 0u) << what;
            EXPECT_LE(linear.refinement.field_bound, 0.05) << what;
            expect_field(linear, made.field.values, quadric, what);
            expect_closed(linear, what);
        }
}

TEST(HighDegree, EvaluatesCubicFieldsAtThePlacesOfTheSplit) {
    for (const std::string& shape : shapes)
        for (const unsigned degree : {3u, 5u, 6u, 7u}) {
            const CurvedGrid made = grid_of_degree(shape, degree, false, cubic);
            const LinearGrid linear = linearize(made.grid).value();
            EXPECT_EQ(linear.derived.count() > 0, degree % 2 == 1);
            expect_field(linear, made.field.values, cubic, shape + " " + std::to_string(degree));
            expect_closed(linear, shape + " " + std::to_string(degree));
        }
}

TEST(HighDegree, HasOneSurfaceWithoutHolesWhereFacesAreCurved) {
    for (const std::string& shape : shapes)
        for (const bool bezier : {false, true}) {
            if (bezier && (shape == "pyramid" || shape == "mixed")) continue;
            const CurvedGrid made =
                grid_of_degree(shape, 3, bezier, [](At p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }, bulge);
            ContourOptions options;
            options.refine.emplace();
            options.refine->tolerance = 0.02;
            auto session = Contour::create({made.grid, made.field, {}, {}}, options).value();
            const ContourResult result = session.extract(0.6).value();
            ASSERT_GT(result.surfaces[0].surface.triangle_count(), 100u) << shape;
            EXPECT_EQ(check(result.surfaces[0].surface).value().boundary_edges, 0u) << shape << bezier;
        }
}

/// One cell of control points whose polynomial is known.
CurvedGrid bezier_cell(const KindOfDegree& kind, unsigned degree) {
    std::vector<double> points, values;
    std::vector<std::int64_t> connectivity;
    const double p = degree;
    for (const auto& n : core::nodes_of_degree(kind.kind, degree, core::NodeOrder::vtk)) {
        const double i = n[0], j = n[1], k = n[2];
        for (const double x : {i / p, j / p, k / p}) points.push_back(x);
        const bool flat = kind.kind != CellKind::hexahedron, simplex = kind.kind == CellKind::tetrahedron;
        const double uu = degree > 1 ? i * (i - 1) / (p * (p - 1)) : 0, uv = i * j / (flat ? p * (p - 1) : p * p),
                     uw = i * k / (simplex ? p * (p - 1) : p * p);
        values.push_back(uu - 0.7 * uv + 0.4 * uw + j / p - 0.2);
        connectivity.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    CurvedGrid out;
    out.grid.points = Array::own(std::move(points), 3);
    out.grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, static_cast<std::int64_t>(connectivity.size())});
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    out.grid.cells.types = Array::own(std::vector<std::uint8_t>{kind.bezier});
    out.field = {"f", Array::own(std::move(values)), false, {}};
    return out;
}

TEST(HighDegree, TakesBezierNodesAsControlPoints) {
    const auto exact = [](At p) { return p[0] * p[0] - 0.7 * p[0] * p[1] + 0.4 * p[0] * p[2] + p[1] - 0.2; };
    for (const KindOfDegree& kind : std::span(kinds).first(3))
        for (const unsigned degree : {2u, 3u, 4u, 5u}) {
            const CurvedGrid made = bezier_cell(kind, degree);
            const LinearGrid linear = refine(made.grid, made.field, {.tolerance = 0.01}).value();
            EXPECT_GT(linear.derived.count(), 0u);
            // user points are control points: only the others lie on the field
            const Array values = linear.extend(made.field.values).value();
            for (std::size_t i = linear.user_points; i < values.tuples(); ++i) {
                const At p{linear.grid.points.at(i, 0), linear.grid.points.at(i, 1), linear.grid.points.at(i, 2)};
                ASSERT_NEAR(values.at(i), exact(p), 1e-10) << kind.shape << degree;
            }
        }
}

TEST(HighDegree, LeavesOutBezierPyramidsAndCountsThem) {
    CurvedGrid made = grid_of_degree("hex", 3, false, quadric);
    std::vector<std::uint8_t> types(made.grid.cells.count(), kinds[1].lagrange);
    types[0] = 81;
    made.grid.cells.types = Array::own(std::move(types));
    const LinearGrid linear = linearize(made.grid).value();
    EXPECT_EQ(linear.refinement.unknown_cells, 1u);
    EXPECT_EQ(linear.refinement.curved_cells, made.grid.cells.count() - 1);
}

TEST(HighDegree, ListsEachNodeOfAPyramidOnce) {
    for (unsigned degree = 1; degree <= core::max_degree; ++degree)
        for (const auto order : {core::NodeOrder::vtk, core::NodeOrder::gmsh}) {
            std::set<core::LatticePlace> places;
            for (const auto& place : core::nodes_of_degree(CellKind::pyramid, degree, order)) {
                EXPECT_LE(std::max(place[0], place[1]) + place[2], static_cast<int>(degree));
                places.insert(place);
            }
            EXPECT_EQ(places.size(), core::node_count(CellKind::pyramid, degree)) << degree;
        }
}

/// (xy / (1 - z))^(p - m) times a polynomial of degree m.
double rational(double x, double y, double z, int p, int m) {
    const double whole = std::pow(x - 0.5 * y + 0.2, m);
    if (m == p) return whole;
    return z < 1 ? std::pow(x * y / (1 - z), p - m) * whole : 0;
}

TEST(HighDegree, EvaluatesPyramidsInTheirSpaceOfRationalFunctions) {
    for (const unsigned degree : {3u, 5u, 7u, 9u}) {
        const linear::PyramidWeights inside(degree);
        const auto nodes = core::nodes_of_degree(CellKind::pyramid, degree, core::NodeOrder::vtk);
        const unsigned steps = degree + 1;
        const auto p = static_cast<int>(degree);
        for (std::uint16_t z = 0; z < steps; ++z)
            for (std::uint16_t y = 0; y + z <= static_cast<int>(steps); ++y)
                for (std::uint16_t x = 0; x + z <= static_cast<int>(steps); ++x) {
                    const std::vector<double> weights = inside.at({x, y, z}, steps);
                    double sum = 0, on_base = 0;
                    for (std::size_t i = 0; i < nodes.size(); ++i) {
                        sum += weights[i];
                        if (z == 0 && nodes[i][2] > 0) on_base += std::abs(weights[i]);
                    }
                    ASSERT_NEAR(sum, 1, 1e-13);
                    ASSERT_NEAR(on_base, 0, 1e-13) << "the base decides alone";
                    for (const int m : {0, 1, p - 1, p}) {
                        double value = 0;
                        for (std::size_t i = 0; i < nodes.size(); ++i)
                            value += weights[i] * rational(nodes[i][0] / double(p), nodes[i][1] / double(p),
                                                           nodes[i][2] / double(p), p, m);
                        ASSERT_NEAR(value, rational(x / double(steps), y / double(steps), z / double(steps), p, m),
                                    1e-12)
                            << degree << " " << m << ": " << x << " " << y << " " << z;
                    }
                }
    }
}

TEST(HighDegree, NamesTheCellWithAPointThatIsNotThere) {
    CurvedGrid made = grid_of_degree("kuhn", 3, false, quadric);
    std::vector<std::int64_t> connectivity;
    for (std::size_t i = 0; i < made.grid.cells.connectivity.tuples(); ++i)
        connectivity.push_back(static_cast<std::int64_t>(made.grid.cells.connectivity.at(i)));
    connectivity[20 + 15] = 100000;
    made.grid.cells.connectivity = Array::own(std::move(connectivity));
    const auto result = linearize(made.grid);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("cell 1 "), std::string::npos) << result.error().message;
}

} // namespace
} // namespace isotet::test
