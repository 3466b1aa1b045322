// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MED: order of nodes, polyhedra, steps, profiles, values at integration points and at the nodes of each cell, groups.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <isotet/make.hpp>
#include <isotet/read.hpp>

#include "support/places.hpp"
#include "support/quadratic_files.hpp"
#include "support/temporary_folder.hpp"
#include "vtk_readers/med_writer.hpp"

namespace isotet::test {
namespace {

/// Two tets in MED's orientation, on five points.
const std::vector<double> points_of_tets{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
const MedNumbers two_tets{1, 3, 2, 4, 2, 3, 5, 4};

class ReadMed : public testing::Test {
protected:
    std::string path() const { return folder_.file("a.med"); }
    void write(const std::function<void(MedWriter&)>& put) {
        MedWriter file(path());
        file.mesh("m", points_of_tets);
        file.cells("TE4", 4, two_tets);
        put(file);
    }
    Result<ReadResult> read_with(const std::function<void(MedWriter&)>& put, const ReadOptions& options = {}) {
        write(put);
        return read(path(), options);
    }
    TemporaryFolder folder_;
};

/// NaN where the text has "-".
std::string text_of(const Array& array) {
    std::string text;
    for (const double number : numbers_of(array))
        text += (text.empty() ? "" : " ") + (std::isnan(number) ? "-" : fmt::format("{}", number));
    return text;
}

bool has_note(const ReadResult& result, std::string_view part) {
    return std::ranges::any_of(result.notes, [&](const std::string& note) { return note.find(part) != note.npos; });
}

TEST_F(ReadMed, FacesInGroupsArePatches) {
    ReadOptions options;
    options.patches = true;
    const auto result = read_with(
        [](MedWriter& file) {
            file.cells("TR3", 3, {1, 2, 3, 1, 2, 4, 2, 3, 5}, {-1, 0, -2});
            file.family("m", "F1", -1, {"inlet", "all"});
            file.family("m", "F2", -2, {"outlet"});
        },
        options);
    ASSERT_TRUE(result) << result.error().message;
    const BoundaryPatches& patches = result->grid.patches;
    EXPECT_EQ(numbers_of(patches.points), (std::vector<double>{0, 1, 2, 1, 2, 4}));
    EXPECT_EQ(numbers_of(patches.numbers), (std::vector<double>{0, 1}));
    ASSERT_EQ(patches.names.size(), 2u);
    EXPECT_EQ(patches.names[0].name, "inlet");
    EXPECT_EQ(patches.names[1].name, "outlet");
}

TEST_F(ReadMed, CellsAreTurnedToVtksOrientation) {
    const auto result = read_with([](MedWriter&) {});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.format, "med");
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 1, 4, 2, 3}));
    EXPECT_TRUE(result->grid.cells.types.empty());
    EXPECT_EQ(numbers_of(result->grid.points), points_of_tets);
    EXPECT_EQ(survey(result->grid).value().negative_tets, 0u);
}

/// A node that is taken for another breaks a quadratic field.
TEST_F(ReadMed, CurvedCellsHaveTheirNodesWhereMedPutsThem) {
    const std::vector<std::string> tet{"01", "12", "20", "03", "13", "23"},
        hex{"01", "12", "23", "30", "45", "56", "67", "74", "04", "15", "26", "37"},
        wedge{"01", "12", "20", "34", "45", "53", "03", "14", "25"},
        pyramid{"01", "12", "23", "30", "04", "14", "24", "34"};
    const auto with = [](std::vector<std::string> first, const std::vector<std::string>& more) {
        first.insert(first.end(), more.begin(), more.end());
        return first;
    };
    const std::vector<CellInFile> cells{
        {"T10", 4, tet},
        {"H20", 8, hex},
        {"H27", 8, with(hex, {"0123", "0154", "1265", "2376", "3047", "4567", "01234567"})},
        {"P15", 6, wedge},
        {"P18", 6, with(wedge, {"0143", "1254", "2035"})},
        {"P13", 5, pyramid}};
    for (const CellInFile& cell : cells) {
        std::vector<double> points, values;
        MedNumbers nodes;
        for (Position p : nodes_of(cell)) {
            p[0] = -p[0]; // MED goes around the other way
            points.insert(points.end(), p.begin(), p.end());
            values.push_back(file_quadric(p));
            nodes.push_back(static_cast<std::int64_t>(values.size()));
        }
        {
            MedWriter file(path());
            file.mesh("m", points);
            file.cells(cell.type, nodes.size(), nodes);
            file.field("f", "m", 1);
            file.step(-1, 0);
            file.values("NOE", values);
        }
        const auto result = read(path());
        ASSERT_TRUE(result) << cell.type << ": " << result.error().message;
        expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners, cell.type);
    }
}

TEST_F(ReadMed, LinearCellsAreSoundInOneMesh) {
    {
        MedWriter file(path());
        // A cube below a pyramid, beside a wedge and a prism of six sides.
        file.mesh("m", {0, 0, 0, 1, 0, 0, 1,  1,  0, 0, 1, 0, 0, 0, 1, 1, 0, 1,
                        1, 1, 1, 0, 1, 1, .5, .5, 2, 2, 0, 0, 2, 0, 1, // the prism
                        5, 0, 0, 6, 0, 0, 7,  1,  0, 6, 2, 0, 5, 2, 0, 4, 1, 0,
                        5, 0, 1, 6, 0, 1, 7,  1,  1, 6, 2, 1, 5, 2, 1, 4, 1, 1});
        file.cells("HE8", 8, {1, 4, 3, 2, 5, 8, 7, 6});
        file.cells("PY5", 5, {5, 8, 7, 6, 9});
        file.cells("PE6", 6, {2, 10, 3, 6, 11, 7});
        file.cells("O12", 12, {12, 17, 16, 15, 14, 13, 18, 23, 22, 21, 20, 19});
        file.cells("TR3", 3, {1, 2, 3});
    }
    const auto result = read(path());
    ASSERT_TRUE(result) << result.error().message;
    const auto report = survey(result->grid).value();
    EXPECT_EQ(report.cells, 4u) << "faces are not read";
    EXPECT_EQ(report.flat_tets + report.repeated_tets + report.cells_left_out, 0u);
}

TEST_F(ReadMed, PolyhedraHaveTheirFaces) {
    const auto result = read_with([](MedWriter& file) {
        file.polyhedra({1, 3, 2, 1, 2, 4, 2, 3, 4, 3, 1, 4}, {1, 4, 7, 10, 13}, {1, 5});
        file.field("c", "m", 1);
        file.step(-1, 0);
        file.values<double>("MAI.TE4", {2, 3});
        file.values<double>("MAI.POE", {1});
    });
    ASSERT_TRUE(result) << result.error().message;
    const Cells& cells = result->grid.cells;
    EXPECT_EQ(numbers_of(cells.types), (std::vector<double>{42, 10, 10}));
    EXPECT_EQ(numbers_of(cells.faces), (std::vector<double>{4, 3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 2, 0, 3}));
    EXPECT_EQ(text_of(result->grid.cell_fields.at(0).values), "1 2 3");
}

TEST_F(ReadMed, FlatCellsAreReadWhereNoneHasAVolume) {
    {
        MedWriter file(path());
        file.mesh("plate", {0, 0, 1, 0, 1, 1, 0, 1, 2, 0, 2, 1}, 2);
        file.cells("PO1", 1, {6}, {0});
        file.polygons("POG", {1, 2, 3, 2, 5, 6, 3}, {1, 4, 8});
        file.cells("QU4", 4, {1, 2, 3, 4}, {-1});
        file.cells("SE2", 2, {1, 2}, {-2});
        file.cells("TR3", 3, {2, 5, 3, 5, 6, 3}, {-1, 0});
        file.family("plate", "one", -1, {"steel"});
        file.family("plate", "two", -2, {"edge"});
        file.field("u", "plate", 1);
        file.step(-1, 0);
        file.values<double>("NOE", {1, 2, 3, 4, 5, 6});
        file.field("s", "plate", 1);
        file.step(-1, 0);
        file.values<double>("MAI.QU4", {7});
        file.values<double>("MAI.TR3", {8, 9});
        file.field("e", "plate", 1);
        file.step(-1, 0);
        file.values<double>("NOE.TR3", {2, 5, 3, 5, 6, 4}, 3);
    }
    const auto result = read(path());
    ASSERT_TRUE(result) << result.error().message;
    const Grid& grid = result->grid;
    EXPECT_TRUE(has_only_flat_cells(grid.cells));
    EXPECT_EQ(text_of(grid.points), "0 0 0 1 0 0 1 1 0 0 1 0 2 0 0 2 1 0");
    EXPECT_EQ(text_of(grid.cells.types), "1 7 7 9 3 5 5");
    EXPECT_EQ(text_of(grid.cells.offsets), "0 1 4 8 12 14 17 20");
    EXPECT_EQ(text_of(grid.cells.connectivity), "5 0 1 2 1 4 5 2 0 1 2 3 0 1 1 4 2 4 5 2");
    ASSERT_EQ(grid.point_fields.size(), 2u);
    EXPECT_EQ(text_of(grid.point_fields[0].values), "- 2 3.5 - 5 6");
    EXPECT_EQ(text_of(grid.point_fields[1].values), "1 2 3 4 5 6");
    EXPECT_EQ(text_of(grid.cell_fields.at(0).values), "- - - 7 - 8 9");
    EXPECT_EQ(text_of(grid.cell_fields.at(1).values), "0 0 0 -1 -2 -1 0");
    EXPECT_TRUE(result->info.left_out.empty());
    ReadOptions options;
    options.blocks = {"steel"};
    const auto steel = read(path(), options);
    ASSERT_TRUE(steel) << steel.error().message;
    EXPECT_EQ(text_of(steel->grid.cells.types), "9 5");
}

TEST_F(ReadMed, CurvedFlatCellsHaveVtksTypes) {
    struct Flat {
        const char* type;
        std::size_t nodes;
        double vtk_type;
    };
    const std::vector<double> points(27, 0.5);
    for (const Flat& flat : {Flat{"SE3", 3, 21},
                             {"SE4", 4, 35},
                             {"TR6", 6, 22},
                             {"TR7", 7, 34},
                             {"QU8", 8, 23},
                             {"QU9", 9, 28},
                             {"PO2", 8, 36}}) {
        MedNumbers nodes;
        std::vector<double> expected;
        for (std::size_t i = 0; i < flat.nodes; ++i) {
            nodes.push_back(static_cast<std::int64_t>(i + 1));
            expected.push_back(static_cast<double>(i));
        }
        {
            MedWriter file(path());
            file.mesh("m", points);
            if (flat.vtk_type == 36) file.polygons(flat.type, nodes, {1, 9});
            else file.cells(flat.type, flat.nodes, nodes);
        }
        const auto result = read(path());
        ASSERT_TRUE(result) << flat.type << ": " << result.error().message;
        EXPECT_EQ(numbers_of(result->grid.cells.types), std::vector<double>{flat.vtk_type}) << flat.type;
        EXPECT_EQ(numbers_of(result->grid.cells.connectivity), expected) << flat.type;
    }
}

TEST_F(ReadMed, StepsHaveTheirTimesAndFieldsOfAllTimesHoldAtEach) {
    write([](MedWriter& file) {
        file.field("T", "m", 1);
        for (const int step : {1, 2, 10}) {
            file.step(step, 0.5 * step);
            const double base = 100.0 * step;
            file.values<double>("NOE", {base, base + 1, base + 2, base + 3, base + 4});
        }
        file.field("fixed", "m", 1, 24);
        file.step(-1, 0);
        file.values<std::int32_t>("MAI.TE4", {7, 8});
        file.field("late", "m", 1);
        file.step(10, 5);
        file.values<double>("NOE", {1, 2, 3, 4, 5});
    });
    EXPECT_EQ(inspect(path()).value().times, (std::vector<double>{0.5, 1, 5}));
    ReadOptions options;
    options.step = 1;
    const auto second = read(path(), options).value();
    EXPECT_EQ(text_of(second.grid.point_fields.at(0).values), "200 201 202 203 204");
    EXPECT_EQ(second.grid.point_fields.size(), 1u);
    EXPECT_TRUE(has_note(second, "step 1 has no values of \"late\""));
    EXPECT_EQ(second.grid.cell_fields.at(0).values.type(), ScalarType::int32);
    EXPECT_EQ(text_of(second.grid.cell_fields.at(0).values), "7 8");
    EXPECT_EQ(inspect(path(), options).value().fields.size(), 2u) << "of the step";
    EXPECT_EQ(inspect(path()).value().fields.size(), 3u) << "of all";
    options.step = 2;
    EXPECT_EQ(inspect(path(), options).value().fields.size(), 3u);
    EXPECT_EQ(read(path(), options).value().grid.point_fields.size(), 2u);
}

TEST_F(ReadMed, AMeshThatMovesIsTakenAtTheStepOfItsFields) {
    std::vector<double> moved = points_of_tets;
    for (std::size_t i = 0; i < moved.size(); i += 3) moved[i] += 10;
    write([&](MedWriter& file) {
        file.coordinates_at(3, moved);
        file.field("T", "m", 1);
        for (const int step : {2, 3}) {
            file.step(step, step);
            file.values<double>("NOE", {1, 2, 3, 4, 5});
        }
    });
    ReadOptions options;
    EXPECT_EQ(read(path(), options).value().grid.points.at(0, 0), 0);
    options.step = 1;
    EXPECT_EQ(read(path(), options).value().grid.points.at(0, 0), 10);
}

TEST_F(ReadMed, ProfilesLeaveNoDataElsewhere) {
    const auto result = read_with([](MedWriter& file) {
        file.profile("some", {5, 2});
        file.profile("second", {2});
        file.profile("first", {1});
        file.field("p", "m", 2);
        file.step(1, 0);
        file.values<double>("NOE", {50, 20, 51, 21}, 1, "some");
        file.field("c", "m", 1, 24);
        file.step(1, 0);
        file.values<std::int32_t>("MAI.TE4", {9}, 1, "second");
        file.field("both", "m", 1);
        file.step(1, 0);
        file.values<double>("MAI.TE4", {1}, 1, "first");
        file.values<double>("MAI.TE4", {2}, 1, "second");
    });
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(text_of(result->grid.point_fields.at(0).values), "- - 20 21 - - - - 50 51");
    EXPECT_EQ(result->grid.cell_fields.at(0).name, "both");
    EXPECT_EQ(text_of(result->grid.cell_fields.at(0).values), "1 2");
    EXPECT_EQ(text_of(result->grid.cell_fields.at(1).values), "- 9");
}

TEST_F(ReadMed, ValuesAtIntegrationPointsBecomeMeansOfCells) {
    const auto result = read_with([](MedWriter& file) {
        file.field("s", "m", 2);
        file.step(1, 0);
        file.values<double>("MAI.TE4", {0, 10, 100, 110, 1, 11, 101, 111}, 2); // as libmed 4.1 stores them
    });
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(text_of(result->grid.cell_fields.at(0).values), "5 6 105 106");
    EXPECT_TRUE(has_note(*result, "\"s\" has up to 2 values in a cell"));
}

TEST_F(ReadMed, ValuesAtTheNodesOfEachCellBecomeMeansAtPoints) {
    const auto result = read_with([](MedWriter& file) {
        file.field("e", "m", 1);
        file.step(1, 0);
        file.values<double>("NOE.TE4", {1, 3, 2, 4, 2, 3, 5, 6}, 4);
    });
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(text_of(result->grid.point_fields.at(0).values), "1 2 3 5 5");
    EXPECT_TRUE(has_note(*result, "'e' has a value for each node of each cell (ELNO)")) << result->notes.at(0);
    EXPECT_TRUE(has_note(*result, "differ by up to 2"));
}

/// As MED stores them.
std::string names_of_components(std::vector<std::string> names) {
    std::string all;
    for (std::string name : names) {
        name.resize(16, ' ');
        all += name;
    }
    return all;
}

TEST_F(ReadMed, SymmetricTensorsHaveVtksOrder) {
    const auto result = read_with([&](MedWriter& file) {
        const std::vector<double> values{1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6};
        file.field("SIEF", "m", 6, 6, names_of_components({"SIXX", "SIYY", "SIZZ", "SIXY", "SIXZ", "SIYZ"}));
        file.step(1, 0);
        file.values("MAI.TE4", values);
    });
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(text_of(result->grid.cell_fields.at(0).values), "1 2 3 4 6 5 1 2 3 4 6 5");
}

TEST_F(ReadMed, ComponentsWithNamesAreFieldsBehindAVector) {
    write([](MedWriter& file) {
        file.field("SIEQ", "m", 4, 6, names_of_components({"VMIS", "TRESCA", "PRIN_1", "TRIAX"}));
        file.step(1, 1);
        std::vector<double> values;
        for (int i = 0; i < 20; ++i) values.push_back(i);
        file.values("NOE", values);
        file.field("DEPL", "m", 5, 6, names_of_components({"DX", "DY", "DZ", "DRX", "DRY"}));
        file.step(1, 1);
        for (int i = 20; i < 25; ++i) values.push_back(i);
        file.values("NOE", values);
        file.field("EQ_ELGA", "m", 2, 6, names_of_components({"VMIS", "TRESCA"}));
        file.step(1, 1);
        file.values<double>("MAI.TE4", {1, 3, 5, 7, 2, 4, 6, 8}, 2);
        file.field("VARI", "m", 3, 6, names_of_components({"V1", "V2", "V3"}));
        file.step(1, 1);
        file.values<double>("MAI.TE4", {1, 2, 3, 4, 5, 6});
    });
    const auto result = read(path());
    ASSERT_TRUE(result) << result.error().message;
    std::string found;
    for (const auto* fields : {&result->grid.point_fields, &result->grid.cell_fields})
        for (const Field& field : *fields) found += fmt::format(" {} {};", field.name, text_of(field.values));
    EXPECT_EQ(found, " DEPL 0 5 10 1 6 11 2 7 12 3 8 13 4 9 14; DEPL:DRX 15 16 17 18 19; DEPL:DRY 20 21 22 23 24;"
                     " SIEQ:VMIS 0 1 2 3 4; SIEQ:TRESCA 5 6 7 8 9; SIEQ:PRIN_1 10 11 12 13 14; SIEQ:TRIAX 15 16 17 18 19;"
                     " EQ_ELGA:VMIS 2 6; EQ_ELGA:TRESCA 3 7; VARI 1 3 5 2 4 6;");
    EXPECT_EQ(result->notes.size(), 1u) << "one for both components";
    EXPECT_TRUE(has_note(*result, "\"EQ_ELGA\" has up to 2 values in a cell"));
    ReadOptions options;
    options.point_fields = {{"SIEQ:TRESCA"}};
    options.cell_fields = std::vector<std::string>();
    options.displace = "DEPL";
    const auto displaced = read(path(), options);
    ASSERT_TRUE(displaced) << displaced.error().message;
    EXPECT_EQ(displaced->grid.points.at(1, 0), 1 + 1);
    EXPECT_EQ(displaced->grid.point_fields.size(), 1u);
    EXPECT_EQ(text_of(displaced->grid.point_fields.at(0).values), "5 6 7 8 9");
}

TEST_F(ReadMed, GroupsAreBlocksThatMayOverlap) {
    {
        MedWriter file(path());
        file.mesh("m", points_of_tets);
        file.cells("TE4", 4, two_tets, {-1, -2});
        file.family("m", "one", -1, {"steel", "all of it"});
        file.family("m", "two", -2, {"all of it"});
        file.family("m", "of faces", -3, {"wall"});
    }
    const auto info = inspect(path()).value();
    ASSERT_EQ(info.blocks.size(), 2u);
    EXPECT_EQ(info.blocks[0].name, "all of it");
    EXPECT_EQ(info.blocks[0].cells, 2u);
    EXPECT_EQ(info.blocks[1].name, "steel");
    EXPECT_EQ(info.blocks[1].cells, 1u);
    ASSERT_EQ(info.regions.size(), 2u);
    EXPECT_EQ(info.regions[1].name, "steel, all of it");
    ReadOptions options;
    options.blocks = {"steel"};
    const auto steel = read(path(), options);
    ASSERT_TRUE(steel) << steel.error().message;
    EXPECT_EQ(steel->grid.cells.count(), 1u);
    EXPECT_EQ(steel->grid.points.tuples(), 4u);
    EXPECT_EQ(text_of(steel->grid.cell_fields.at(0).values), "-1");
    options.blocks = {"wall"};
    EXPECT_EQ(read(path(), options).error().code, ErrorCode::invalid_argument);
}

TEST_F(ReadMed, OfSeveralMeshesOneIsReadUnlessOthersAreChosen) {
    std::vector<double> beside = points_of_tets;
    for (std::size_t i = 0; i < beside.size(); i += 3) beside[i] += 10;
    {
        MedWriter file(path());
        file.mesh("a", points_of_tets);
        file.cells("TE4", 4, two_tets, {-1, -1});
        file.family("a", "one", -1, {"g"});
        file.mesh("b", beside);
        file.cells("TE4", 4, two_tets);
        file.mesh("skin", points_of_tets);
        file.cells("TR3", 3, {1, 2, 3});
        file.field("T", "b", 1);
        file.step(-1, 0);
        file.values<double>("NOE", {1, 2, 3, 4, 5});
    }
    const auto one = read(path());
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_EQ(one->grid.points.at(0, 0), 10) << "the one with a field";
    EXPECT_TRUE(has_note(*one, "one of 2 meshes is read, 'b': `block` NAME reads 'a'"));
    ASSERT_EQ(one->info.left_out.size(), 1u);
    EXPECT_EQ(one->info.left_out[0].name, "skin");
    ReadOptions options;
    options.blocks = {"a", "b"};
    EXPECT_EQ(read(path(), options).value().grid.cells.count(), 4u);
    options.blocks = {"g"};
    EXPECT_EQ(read(path(), options).value().grid.cells.count(), 2u);
}

TEST_F(ReadMed, ABrokenFieldIsLeftOutAndOthersAreRead) {
    const auto result = read_with([](MedWriter& file) {
        const auto add = [&](const char* name, const char* place, const std::vector<double>& values,
                             const std::string& profile = "MED_NO_PROFILE_INTERNAL", std::int64_t per_entity = 1) {
            file.field(name, "m", 1);
            file.step(1, 0);
            file.values(place, values, per_entity, profile);
        };
        file.profile("beyond", {6});
        add("good", "NOE", {1, 2, 3, 4, 5});
        add("short", "NOE", {1, 2, 3});
        add("beyond", "NOE", {1}, "beyond");
        add("unknown profile", "NOE", {1}, "none");
        add("nodes", "NOE.TE4", {1, 2, 3, 4, 5, 6}, "MED_NO_PROFILE_INTERNAL", 3);
        add("faces", "MAI.TR3", {1});
        file.field("type", "m", 1, 99);
        file.step(1, 0);
        file.values<double>("NOE", {1, 2, 3, 4, 5});
    });
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.point_fields.size(), 1u);
    std::vector<std::string> left_out;
    for (const LeftOut& item : result->info.left_out) left_out.push_back(item.name);
    std::ranges::sort(left_out);
    EXPECT_EQ(left_out, (std::vector<std::string>{"beyond", "faces", "nodes", "short", "type", "unknown profile"}));
    ReadOptions options;
    options.point_fields = {"short"};
    EXPECT_FALSE(read(path(), options));
}

TEST_F(ReadMed, AFileThatIsNotSoundIsAnErrorThatSaysWhy) {
    const auto message = [&](const std::function<void(MedWriter&)>& put, std::int64_t version = 4) {
        {
            MedWriter file(path(), version);
            put(file);
        }
        const auto result = read(path());
        return result ? std::string("no error") : result.error().message;
    };
    const auto mesh = [](const std::string& type, std::size_t width, const MedNumbers& nodes) {
        return [=](MedWriter& file) {
            file.mesh("m", points_of_tets);
            file.cells(type, width, nodes);
        };
    };
    EXPECT_NE(message(mesh("TE4", 4, {1, 2, 3, 6})).find("cell 0 of TE4 has node 6, but the nodes are 1 to 5"),
              std::string::npos);
    EXPECT_NE(message(mesh("TE4", 4, {1, 2, 3, 0})).find("has node 0"), std::string::npos);
    EXPECT_NE(message(mesh("TE4", 5, {1, 2, 3, 4, 5})).find("has 5 numbers, but cells of TE4 have 4"),
              std::string::npos);
    EXPECT_NE(message([](MedWriter& file) { file.mesh("m", points_of_tets); }).find("it has no cells"),
              std::string::npos);
    EXPECT_NE(message(mesh("TR3", 3, {1, 2, 6})).find("has node 6"), std::string::npos);
    for (const MedNumbers& offsets :
         {MedNumbers{1, 4, 99}, MedNumbers{1, 3, 2}, MedNumbers{-5, 4, 6}, MedNumbers{1, 4}})
        EXPECT_NE(message([&](MedWriter& file) {
                      file.mesh("m", points_of_tets);
                      file.polygons("POG", {1, 2, 3, 4, 5}, offsets);
                  }).find("INN\" does not rise from 1"),
                  std::string::npos);
    EXPECT_NE(message([&](MedWriter& file) {
                  file.mesh("m", points_of_tets);
                  file.polygons("POG", {1, 2, 6}, {1, 4});
              }).find("a polygon has node 6"),
              std::string::npos);
    EXPECT_NE(message([](MedWriter&) {}).find("it has no mesh"), std::string::npos);
    EXPECT_NE(message(mesh("TE4", 4, two_tets), 2).find("a MED file of version 2.1, but 3.0 and later are read"),
              std::string::npos);
    EXPECT_NE(read(folder_.write("text.med", "made by Salome")).error().message.find("not a MED file"),
              std::string::npos);
    for (const MedNumbers& faces : {MedNumbers{1, 4, 99}, MedNumbers{1, 3, 2}, MedNumbers{-5, 4, 7}})
        EXPECT_NE(message([&](MedWriter& file) {
                      file.mesh("m", points_of_tets);
                      file.polyhedra({1, 2, 3, 1, 2, 4}, faces, {1, 3});
                  }),
                  "no error");
}

TEST(MedSamples, AreErrorsWhereverTheyAreCut) {
    const TemporaryFolder folder;
    const std::string whole = content_of((source_folder() / "tests/corruption/samples/med/gmsh.med").string());
    for (std::size_t length = whole.size() / 16; length < whole.size(); length += whole.size() / 16) {
        const auto result = read(folder.write("cut.med", whole.substr(0, length)));
        ASSERT_FALSE(result) << length << " of " << whole.size();
        EXPECT_NE(result.error().message.find("cut short"), std::string::npos) << result.error().message;
    }
}

struct Range {
    double lowest, highest;
    bool operator==(const Range&) const = default;
};

Range range_of(const Array& array) {
    Range range{INFINITY, -INFINITY};
    for (const double number : numbers_of(array))
        range = {std::min(range.lowest, number), std::max(range.highest, number)};
    return range;
}

/// Counts and ranges are those of meshio 5.3.5.
TEST(MedSamples, OfGmshAreWhatMeshioReads) {
    const std::string path = (source_folder() / "tests/corruption/samples/med/gmsh.med").string();
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 113u);
    EXPECT_EQ(range_of(result->grid.points), (Range{0, 2}));
    EXPECT_EQ(result->grid.cells.count(), 48u) << "quadratic tets, without the triangles of the group 'wall'";
    EXPECT_EQ(range_of(result->grid.cells.types), (Range{24, 24}));
    EXPECT_EQ(range_of(result->grid.cell_fields.at(0).values), (Range{-3, -2}));
    ASSERT_EQ(result->info.blocks.size(), 2u);
    EXPECT_EQ(result->info.blocks[0].name + " " + result->info.blocks[1].name, "left right");
    EXPECT_EQ(result->info.blocks[0].cells + result->info.blocks[1].cells, 48u);
    ReadOptions options;
    options.blocks = {"left"};
    const auto left = read(path, options);
    ASSERT_TRUE(left) << left.error().message;
    EXPECT_EQ(range_of(left->grid.points), (Range{0, 1}));
}

TEST(MedSamples, OfMeshioAreWhatMeshioReads) {
    const auto result = read((source_folder() / "tests/corruption/samples/med/meshio.med").string());
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 36u);
    EXPECT_EQ(result->grid.cells.count(), 28u);
    EXPECT_EQ(result->grid.cells.uniform_type, CellType::wedge);
    ASSERT_EQ(result->grid.point_fields.size(), 2u);
    EXPECT_EQ(range_of(result->grid.point_fields[0].values), (Range{0, 3}));
    EXPECT_EQ(result->grid.point_fields[1].values.components(), 3u);
    EXPECT_EQ(range_of(result->grid.point_fields[1].values), (Range{0, 2}));
    EXPECT_EQ(range_of(result->grid.cell_fields.at(0).values), (Range{0, 27}));
}

TEST(MedSamples, OfThreeKindsOfCellsAreRead) {
    ReadOptions options;
    options.step = 1;
    const auto result = read((source_folder() / "tests/corruption/samples/med/results.med").string(), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(result->grid.cells.count(), 13u + 42 + 7);
    EXPECT_EQ(result->info.left_out.size(), 0u);
    const auto report = survey(result->grid).value();
    EXPECT_EQ(report.cells_left_out + report.repeated_tets + report.negative_tets, 0u);
    EXPECT_EQ(result->grid.point_fields.size(), 3u);
    EXPECT_EQ(result->grid.cell_fields.size(), 3u);
}

TEST_F(ReadMed, CornersOfManyBlocksOfTheFileComeToTheirCells) {
    const Grid made = make_grid({.shape = "kuhn", .side = 48, .fields = {}}).value();
    const std::size_t cells = made.cells.count();
    MedNumbers nodes; // MED's tets are those of VTK from the other side
    for (std::size_t cell = 0; cell < cells; ++cell)
        for (const std::size_t corner : {0, 2, 1, 3})
            nodes.push_back(static_cast<std::int64_t>(made.cells.connectivity.at(4 * cell + corner)) + 1);
    {
        MedWriter file(path());
        file.mesh("m", numbers_of(made.points));
        file.cells("TE4", 4, nodes);
    }
    const auto result = read(path());
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(numbers_of(result->grid.points), numbers_of(made.points));
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity), numbers_of(made.cells.connectivity));
}

} // namespace
} // namespace isotet::test
