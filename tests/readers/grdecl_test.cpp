// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Corner-point grids: places of points, faults, cells without height, lists with repeats, included files, broken decks.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/read.hpp>

#include "io/grdecl/read_grdecl.hpp"
#include "readers/grdecl_sample.hpp"
#include "readers/sample_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

io::grdecl::DeckText deck_of(const std::string& text) { return {"deck", nullptr, text}; }

Result<io::grdecl::DeckText> nothing_to_include(std::string_view name) {
    return Error{ErrorCode::file, std::string(name) + " is not there"};
}

Result<ReadResult> parse(const std::string& text, const ReadOptions& options = {}) {
    return io::parse_grdecl(deck_of(text), nothing_to_include, options, {});
}

ReadResult parsed(const std::string& text, const ReadOptions& options = {}) { return parse(text, options).value(); }

std::string grdecl_error(const std::string& text) {
    const auto result = parse(text);
    return result ? "no error" : result.error().message;
}

/// The surface of a coordinate, judged on its grid.
SurfaceReport surface_of(const Grid& grid, const char* field, double isovalue) {
    ContourInput input;
    input.grid = grid;
    input.field = find_field(grid, field).value();
    ContourOptions options;
    options.edge_ends = true;
    auto session = Contour::create(input, options).value();
    const auto result = session.extract(isovalue).value();
    CheckOptions rules;
    rules.grid = &grid;
    return check(result.surfaces[0].surface, rules).value();
}

TEST(ReadGrdecl, PutsPointsOnInclinedPillars) {
    const Grid grid = parsed(grdecl_box({2, 1, 1, 2, even_layers(0)}, "")).grid;
    ASSERT_EQ(grid.points.tuples(), 12u);
    ASSERT_EQ(grid.cells.count(), 2u);
    for (std::size_t i = 0; i < 12; ++i) {
        const double depth = i % 2 == 0 ? 104 : 100, t = (depth - 100) / 100;
        const double x = 10 * static_cast<double>(i / 2 % 3), y = 10 * static_cast<double>(i / 6);
        EXPECT_EQ(grid.points.at(i, 0), x + 25 * t) << i;
        EXPECT_EQ(grid.points.at(i, 1), y - 5 * t) << i;
        EXPECT_EQ(grid.points.at(i, 2), -depth) << i;
    }
    EXPECT_EQ(values_of(grid.cells.connectivity),
              (std::vector<double>{0, 2, 8, 6, 1, 3, 9, 7, 2, 4, 10, 8, 3, 5, 11, 9}));
    EXPECT_EQ(survey(grid)->negative_tets, 0u);
}

TEST(ReadGrdecl, LeavesFaultsOpenUnlessCornersMeet) {
    struct Case {
        double throw_;
        std::uint64_t points, pieces;
    };
    // 5 x 4 pillars; those of the fault have 3 points, or 3 for each side; with a throw of one layer two of them meet.
    for (const Case& c : {Case{0, 60, 1}, Case{1, 72, 2}, Case{4, 64, 1}, Case{8, 68, 1}, Case{100, 72, 2}}) {
        const Grid grid = parsed(grdecl_box({4, 3, 2, 2, even_layers(c.throw_)}, "")).grid;
        EXPECT_EQ(grid.points.tuples(), c.points) << c.throw_;
        const SurfaceReport report = surface_of(grid, "y", 12.3);
        EXPECT_TRUE(report.sound);
        EXPECT_GT(report.triangles, 0u);
        if (c.throw_ != 8) { // then the blocks meet in an edge only
            EXPECT_EQ(report.components, c.pieces) << c.throw_;
        }
    }
}

TEST(ReadGrdecl, LeavesOutInactiveCellsAndThoseWithoutHeight) {
    // The lower of two layers ends at x = 2 of 4: wedges there, and no height beyond.
    const auto ends = [](int x, int, int z, int) { return 100 + 4 * std::min(z, 1) + (z == 2 && x < 2 ? 3.0 : 0.0); };
    const ReadResult result = parsed(grdecl_box({4, 3, 2, 4, ends}, "ACTNUM\n 23*1 0 /\n"));
    EXPECT_EQ(result.grid.cells.count(), 24u - 1u - 5u);
    EXPECT_EQ(result.grid.points.tuples(), 2u * 20u + 8u);
    EXPECT_NE(std::ranges::find(result.notes, "cells without height are left out: 5"), result.notes.end());
    EXPECT_NE(std::ranges::find(result.notes, "inactive cells are left out (ACTNUM): 1"), result.notes.end());
    for (const auto& [field, isovalue] : {std::pair("y", 7.0), std::pair("z", -105.0), std::pair("x", 11.0)}) {
        const SurfaceReport report = surface_of(result.grid, field, isovalue);
        EXPECT_TRUE(report.sound) << field;
        EXPECT_EQ(report.components, 1u) << field;
    }
}

TEST(ReadGrdecl, KnowsRepeatsDefaultsRegionsAndSections) {
    const ReadResult result = parsed(grdecl_sample());
    ASSERT_EQ(result.grid.cells.count(), 3u);
    ASSERT_EQ(result.grid.cell_fields.size(), 3u);
    EXPECT_EQ(values_of(find(result.grid.cell_fields, "PORO")->values), (std::vector<double>{.25, .25, .5}));
    EXPECT_EQ(find(result.grid.cell_fields, "SATNUM")->values.type(), ScalarType::int32);
    EXPECT_EQ(values_of(find(result.grid.cell_fields, "SATNUM")->values), (std::vector<double>{1, 2, 3}));
    EXPECT_TRUE(find(result.grid.cell_fields, "FIPNUM"));
    EXPECT_NE(std::ranges::find(result.notes,
                                "keywords that change lists, or refine cells, are not carried out: BOX, EQUALS"),
              result.notes.end());
    const auto all = parsed(replaced(grdecl_sample(), "3*1 0 /", "4*1 /"));
    EXPECT_TRUE(std::isnan(find(all.grid.cell_fields, "PORO")->values.at(3, 0))) << "1* is no value";
}

TEST(ReadGrdecl, ReadsWhatIsAskedFor) {
    ReadOptions options;
    options.cell_fields = {"SATNUM"};
    const ReadResult result = parsed(grdecl_sample(), options);
    ASSERT_EQ(result.grid.cell_fields.size(), 1u);
    EXPECT_EQ(result.info.fields.size(), 3u);
}

TEST(ReadGrdecl, TurnsTheGridByMapaxes) {
    // The origin at 1000, 2000; x to the north, y to the west.
    const std::string axes = "MAPAXES\n 999 2000 1000 2000 1000 2007 /\n";
    const std::string box = grdecl_box({1, 1, 1, 1, even_layers(0)}, axes);
    const Grid plain = parsed(replaced(box, "MAPAXES", "NOTHING")).grid;
    const Grid turned = parsed(box).grid;
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(turned.points.at(i, 0), 1000 - plain.points.at(i, 1));
        EXPECT_EQ(turned.points.at(i, 1), 2000 + plain.points.at(i, 0));
        EXPECT_EQ(turned.points.at(i, 2), plain.points.at(i, 2));
    }
    for (const char* placed : {"GRIDUNIT\n METRES MAP /\n", "GRIDUNIT\n'FEET' '' /\nMAPUNITS\n METRES /\n"})
        EXPECT_EQ(parsed(box + placed).grid.points.at(0, 0), plain.points.at(0, 0)) << placed;
    EXPECT_EQ(grdecl_error(replaced(box, "1000 2007", "1000 2000")),
              "deck: line 18: MAPAXES: has an axis whose length is zero or not finite");
}

TEST(ReadGrdecl, ReadsListsThatAreLongerThanAPieceOfWork) {
    CornerPointBox box{100, 100, 10, 50, even_layers(1)};
    std::string list = "PORO\n";
    for (int i = 0; i < 99'990; ++i) list += std::to_string(i) + (i % 10 == 9 ? " -- tenth / of\n" : " ");
    const ReadResult result = parsed(grdecl_box(box, list + " 10*-1 /\n"));
    const Array& poro = find(result.grid.cell_fields, "PORO")->values;
    ASSERT_EQ(poro.tuples(), 100'000u);
    for (std::size_t i = 0; i < poro.tuples(); ++i)
        ASSERT_EQ(poro.at(i, 0), i < 99'990 ? static_cast<double>(i) : -1.0);
}

TEST(ReadGrdecl, FollowsIncludedFilesBelowItsFolder) {
    const TemporaryFolder folder;
    const std::string box = grdecl_box({2, 1, 2, 1, even_layers(1)}, "");
    const std::size_t zcorn = box.find("ZCORN");
    std::filesystem::create_directory(folder.file("parts"));
    folder.write("case.grdecl", box.substr(0, zcorn) + "INCLUDE\n 'parts/zcorn.inc' /\n\nINCLUDE parts/poro.inc /\n");
    folder.write("parts/zcorn.inc", box.substr(zcorn));
    folder.write("parts/poro.inc", "PORO\n 4*0.25 /\n");
    const auto result = read(folder.file("case.grdecl"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.format, "grdecl");
    EXPECT_EQ(result->grid.cells.count(), 4u);
    EXPECT_EQ(result->info.files.size(), 3u) << "files that must not be written over";
    EXPECT_EQ(inspect(folder.file("case.grdecl"))->files.size(), 3u);

    folder.write("windows.grdecl", box.substr(0, zcorn) + "INCLUDE\n 'parts\\zcorn.inc' /\n");
    EXPECT_TRUE(read(folder.file("windows.grdecl")));
    folder.write("parts/up.grdecl", box + "INCLUDE\n '..\\case.grdecl' /\n");
    EXPECT_NE(read(folder.file("parts/up.grdecl")).error().message.find("climbs out"), std::string::npos);

    const TemporaryFolder elsewhere;
    elsewhere.write("poro.inc", "PORO\n 4*0.5 /\n");
    folder.write("outside.grdecl", box + "INCLUDE\n '" + elsewhere.file("poro.inc") + "' /\n");
    ReadOptions options;
    const auto refused = read(folder.file("outside.grdecl"), options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("an absolute path"), std::string::npos) << refused.error().message;
    options.allow_outside = true;
    EXPECT_TRUE(read(folder.file("outside.grdecl"), options));

    folder.write("parts/a.inc", "INCLUDE\n 'parts/b.inc' /\n");
    folder.write("parts/b.inc", "INCLUDE\n 'parts/a.inc' /\n");
    folder.write("circle.grdecl", box + "INCLUDE\n 'parts/a.inc' /\n");
    const auto circle = read(folder.file("circle.grdecl"));
    ASSERT_FALSE(circle);
    EXPECT_NE(circle.error().message.find("includes itself"), std::string::npos) << circle.error().message;
}

TEST(ReadGrdecl, RefusesWhatItCannotTake) {
    const std::string box = grdecl_box({2, 1, 1, 1, even_layers(1)}, "PORO\n 0.5 0.25 /\n");
    EXPECT_EQ(grdecl_error(replaced(box, "SPECGRID", "SPECGRIB")),
              "deck: has neither SPECGRID nor DIMENS, so it is no corner-point grid");
    EXPECT_EQ(grdecl_error(replaced(box, "2 1 1 1 F", "2 0 1 1 F")),
              "deck: line 3: SPECGRID: begins with '2 0 1 1 F ', but three numbers of cells, at least 1, are the rule");
    EXPECT_EQ(grdecl_error(replaced(box, "1 F /", "1 T /")),
              "deck: line 3: SPECGRID: is a grid in cylindrical coordinates, which isotet does not take");
    EXPECT_EQ(grdecl_error(replaced(box, "1 F /", "2 F /")),
              "deck: line 3: SPECGRID: has 2 reservoirs, but isotet takes 1");
    EXPECT_EQ(grdecl_error(replaced(box, "2 1 1 1 F", "3 1 1 1 F")),
              "deck: line 6: COORD: has 36 numbers, but 3 x 1 x 1 cells need 48");
    EXPECT_EQ(grdecl_error(replaced(box, "100 25", "100 2x")), "deck: line 6: COORD: has '2x', which is no number");
    EXPECT_EQ(grdecl_error(replaced(box, "ZCORN", "ZCORM")), "deck: has no ZCORN");
    EXPECT_EQ(grdecl_error(replaced(box, "0.25 /", "0.25")),
              "deck: line 20: PORO: has no '/' at its end: the file is cut short");
    EXPECT_EQ(grdecl_error(replaced(box, "0.5 0.25", "x*0.5")), "no error") << "words: no list";
    EXPECT_EQ(grdecl_error(replaced(box, "0.5 0.25", "0*0.5")), "deck: line 20: PORO: has '0*0.5', which is no number");
    EXPECT_EQ(grdecl_error(replaced(box, "0.5 0.25", "0.5 a")), "deck: line 20: PORO: has 'a', which is no number");
    EXPECT_EQ(grdecl_error(replaced(box, "PORO\n 0.5", "SATNUM\n 1.5")),
              "deck: line 20: SATNUM: has 1.5, but regions have whole numbers below 2^31");
    EXPECT_EQ(
        grdecl_error(replaced(box, "2 1 1 1 F", "99999 99999 99999 1 F")),
        "deck: line 3: SPECGRID: has 99999 x 99999 x 99999 cells, but isotet takes 2^32 - 1 of a corner-point grid "
        "at most");
    EXPECT_EQ(grdecl_error("SPECGRID\n1 1 1 1 F /\nDX\n10 /\n"),
              "deck: has no COORD: grids of DX, DY, DZ and TOPS are not corner-point grids");
    EXPECT_EQ(grdecl_error(replaced(box, " 101", " 1*")), "deck: ZCORN has a number that is not finite");
}

TEST(ReadGrdecl, TakesNoMemoryForRepeatsThatCannotFit) {
    const std::string text = "SPECGRID\n 60000 60000 1 1 F /\nCOORD\n 21600720006*0 /\nZCORN\n 28800000000*0 /\n";
    const auto result = parse(text);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::out_of_memory) << result.error().message;
}

} // namespace
} // namespace isotet::test
