// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sessions on quadratic cells: refinement for each isovalue, field and step, and what is told of it.
#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>

#include "linear/curved_grid.hpp"

namespace isotet::test {
namespace {

CurvedGrid ball(unsigned seed) {
    return curved_grid({.side = 3, .seed = seed, .shuffle = true, .field = [](At p) {
                            return p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
                        }});
}

ContourOptions refining(double tolerance) {
    ContourOptions options;
    options.refine.emplace();
    options.refine->tolerance = tolerance;
    return options;
}

TEST(CurvedSession, KeepsTheToleranceForEachIsovalue) {
    const CurvedGrid made = ball(1);
    auto session = Contour::create({made.grid, made.field, {}, {}}, refining(0.01)).value();
    EXPECT_NEAR(session.field().value().upper, 3, 1e-12);
    for (const double isovalue : {0.5, 0.25, 0.7}) {
        const ContourResult result = session.extract(isovalue).value();
        EXPECT_TRUE(result.refinement.refined);
        EXPECT_LE(result.refinement.field_bound, 0.01);
        EXPECT_EQ(result.refinement.isovalues, std::vector<double>{isovalue});
        EXPECT_NEAR(result.field.upper, 3, 1e-12);
        const Surface& surface = result.surfaces[0].surface;
        EXPECT_EQ(check(surface).value().boundary_edges, 0u);
        ASSERT_GT(surface.vertex_count(), 100u);
        for (std::size_t i = 0; i < surface.vertex_count(); ++i) {
            double r2 = 0;
            for (std::size_t k = 0; k < 3; ++k) r2 += surface.positions.at(i, k) * surface.positions.at(i, k);
            ASSERT_NEAR(r2, isovalue, 0.0101);
        }
    }
}

TEST(CurvedSession, SaysWhichBoundsAreNotAgainstVtksCells) {
    for (const char* shape : {"pyramid", "hex"}) {
        const CurvedGrid made = curved_grid({.shape = shape, .side = 2, .seed = 4, .field = wave});
        auto session = Contour::create({made.grid, made.field, {}, {}}, refining(0.05)).value();
        const ContourResult result = session.extract(0.5).value();
        const bool said = std::ranges::any_of(result.notes, [](const std::string& note) {
            return note.find("pyramids of 13 or 19 nodes") != note.npos;
        });
        EXPECT_EQ(said, std::string(shape) == "pyramid") << shape;
    }
}

TEST(CurvedSession, GivesTheUsersCellsAndCarriesFields) {
    const CurvedGrid made = ball(2);
    std::vector<double> x(made.grid.points.tuples()), number(made.grid.cells.count());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = made.grid.points.at(i, 0);
    std::iota(number.begin(), number.end(), 0);
    ContourInput input{made.grid, made.field, {{"x", Array::own(x)}}, {{"number", Array::own(number)}}};
    for (const bool refine : {true, false}) {
        ContourOptions options = refining(0.02);
        if (!refine) options.refine.reset();
        options.source_cells = true;
        auto session = Contour::create(input, options).value();
        const ContourResult result = session.extract(0.6).value();
        EXPECT_EQ(result.refinement.refined, refine);
        EXPECT_EQ(result.refinement.curved_cells, made.grid.cells.count());
        const Surface& surface = result.surfaces[0].surface;
        ASSERT_GT(surface.triangle_count(), 0u);
        for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
            ASSERT_LT(surface.source_cells.at(t), static_cast<double>(made.grid.cells.count()));
            ASSERT_EQ(surface.source_cells.at(t), surface.cell_fields[0].values.at(t));
        }
        for (std::size_t v = 0; v < surface.vertex_count(); ++v)
            ASSERT_NEAR(surface.point_fields[0].values.at(v), surface.positions.at(v, 0), 1e-5);
    }
}

TEST(CurvedSession, RefinesAgainForAnotherField) {
    const CurvedGrid made = ball(3), other = curved_grid({.side = 3, .seed = 3, .shuffle = true, .field = wave});
    auto session = Contour::create({made.grid, made.field, {}, {}}, refining(0.02)).value();
    ASSERT_TRUE(session.extract(0.5));
    ASSERT_TRUE(session.set({other.grid, other.field, {}, {}}));
    const ContourResult result = session.extract(0.5).value();
    EXPECT_LE(result.refinement.field_bound, 0.02);
    EXPECT_GT(result.surfaces[0].surface.triangle_count(), 0u);
    ASSERT_TRUE(session.set({other.grid, other.field, {}, {}}, ContourOptions{}));
    EXPECT_FALSE(session.extract(0.5).value().refinement.refined);
}

TEST(CurvedSession, RefusesPieces) {
    const CurvedGrid made = ball(4);
    ContourOptions options = refining(0.02);
    options.frame.emplace();
    const auto session = Contour::create({made.grid, made.field, {}, {}}, options);
    ASSERT_FALSE(session);
    EXPECT_EQ(session.error().code, ErrorCode::invalid_argument);
}

} // namespace
} // namespace isotet::test
