// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight 6 as text and binary, whole, and cut or changed: an error, never zeros.
#include <array>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "vtk_readers/ensight/ensight_6_text.hpp"
#include "vtk_readers/whole_or_error.hpp"

namespace isotet::test {
namespace {

const std::string box_variables = "VARIABLE\nscalar per node: n n.scl\nvector per node: v v.vec\n"
                                  "tensor symm per node: t t.ten\nscalar per element: e e.scl\n"
                                  "vector per element: w w.vec\n";

class Ensight6 : public testing::TestWithParam<GoldForm> {
protected:
    EnsightFolder files(bool node_ids = false, bool element_ids = false) const {
        const Ensight6Box box{GetParam(), node_ids, element_ids, {1, 2}};
        EnsightFolder all;
        Ensight6Text geometry(GetParam(), true), n(GetParam()), v(GetParam()), t(GetParam()), e(GetParam()),
            w(GetParam());
        all["grid.geo"] = box.put_geometry(geometry).text();
        all["n.scl"] = Ensight6Box::put_nodes(n, 1).text();
        all["v.vec"] = Ensight6Box::put_nodes(v, 3).text();
        all["t.ten"] = Ensight6Box::put_nodes(t, 6).text();
        all["e.scl"] = box.put_elements(e, 1).text();
        all["w.vec"] = box.put_elements(w, 3).text();
        all["a.case"] = "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n" + box_variables;
        return all;
    }
    /// The error of the box with another file, or "read".
    std::string with(const std::string& name, const std::string& content) const {
        EnsightFolder all = files();
        all[name] = content;
        return message_of(read_ensight(folder_, all));
    }
    /// Two cubes as one block, and the values of its points and cells.
    std::string block(const std::string& kind, std::size_t components, std::size_t values, bool is_last = true) const {
        Ensight6Text geometry(GetParam(), true), file(GetParam());
        geometry.line("a").line("b").line("node id off").line("element id off").line("coordinates").integer(0);
        file.line("values");
        for (int part = 1; part <= (is_last ? 1 : 2); ++part) {
            geometry.line(fmt::format("part {}", part)).line("c").line("block").integers({{3, 2, 2}});
            std::vector<float> xyz;
            for (int axis = 0; axis < 3; ++axis)
                for (int i = 0; i < 12; ++i)
                    xyz.push_back(static_cast<float>(axis == 0 ? i % 3 + 5 * part : axis == 1 ? i / 3 % 2 : i / 6));
            for (int axis = 0; axis < 3; ++axis)
                if (GetParam() == GoldForm::ascii)
                    geometry.floats({xyz.begin() + 12 * axis, xyz.begin() + 12 * axis + 12});
            if (GetParam() != GoldForm::ascii) geometry.floats(xyz);
            file.line(fmt::format("part {}", part)).line("block");
            for (std::size_t c = 0; c < components; ++c) file.floats(Ensight6Box::values(values, 0));
        }
        return message_of(read_ensight(folder_, {{"grid.geo", geometry.text()},
                                                 {"x", file.text()},
                                                 {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"
                                                            "VARIABLE\n" +
                                                                kind + ": x x\n"}}));
    }

    TemporaryFolder folder_;
};

TEST_P(Ensight6, IsReadWhole) {
    for (const bool node_ids : {false, true}) {
        for (const bool element_ids : {false, true}) {
            const auto result = read_ensight(folder_, files(node_ids, element_ids));
            ASSERT_TRUE(result) << result.error().message;
            const Grid& grid = result->grid;
            ASSERT_EQ(grid.cells.count(), 9u);
            ASSERT_EQ(grid.point_fields.size(), 3u);
            ASSERT_EQ(grid.cell_fields.size(), 2u);
            for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
                const double node = grid.points.at(i, 0) + 3 * grid.points.at(i, 1) + 9 * grid.points.at(i, 2);
                EXPECT_EQ(grid.point_fields[0].values.at(i), node + 1);
                EXPECT_EQ(grid.point_fields[1].values.at(i, 2), 3 * node + 3);
                EXPECT_EQ(grid.point_fields[2].values.at(i, 4), 6 * node + 6); // VTK has yz before xz
            }
            for (std::size_t i = 0; i < 9; ++i) {
                EXPECT_EQ(grid.cell_fields[0].values.at(i), static_cast<double>(i + 1));
                EXPECT_EQ(grid.cell_fields[1].values.at(i, 1), static_cast<double>(3 * i + 2));
            }
        }
    }
}

TEST_P(Ensight6, IsAnErrorWhereverAFileIsCut) { expect_whole_or_error(files()); }

TEST_P(Ensight6, WithNumbersOfNodesAndElementsIsAnErrorWhereverItIsCut) {
    EnsightFolder all = files(true, true);
    for (const char* name : {"n.scl", "v.vec", "t.ten", "e.scl", "w.vec"}) all.erase(name);
    all["a.case"] = "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n";
    expect_whole_or_error(all);
}

TEST_P(Ensight6, CountsThatDoNotFitAreErrors) {
    const auto nodes = [&](std::int32_t count) {
        Ensight6Text file(GetParam(), true);
        file.line("a").line("b").line("node id off").line("element id off").line("coordinates").integer(count);
        file.nodes({}, std::vector<float>(27 * 3, 1));
        return file.line("part 1").line("c").line("tetra4").integer(1).integers({{1, 2, 3, 4}}).text();
    };
    const auto elements = [&](std::int32_t count, std::int32_t node) {
        Ensight6Text file(GetParam(), true);
        file.line("a").line("b").line("node id off").line("element id off").line("coordinates").integer(27);
        file.nodes({}, std::vector<float>(27 * 3, 1));
        return file.line("part 1").line("c").line("tetra4").integer(count).integers({{1, 2, 3, node}}).text();
    };
    EnsightFolder all = files();
    all["a.case"] = "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n";
    const auto error = [&](const std::string& geometry) {
        all["grid.geo"] = geometry;
        return message_of(read_ensight(folder_, all));
    };
    EXPECT_EQ(error(nodes(27)), "read");
    EXPECT_EQ(error(elements(1, 4)), "read");
    for (const std::int32_t count : {-1, 0, 1, 26, 28, 2'000'000'000}) EXPECT_NE(error(nodes(count)), "read") << count;
    for (const std::int32_t count : {-1, 0, 2, 2'000'000'000}) EXPECT_NE(error(elements(count, 4)), "read") << count;
    for (const std::int32_t node : {-1, 0, 28, 2'000'000'000}) EXPECT_NE(error(elements(1, node)), "read") << node;
}

TEST_P(Ensight6, NumbersOfNodesMustBeThereOnce) {
    const auto error = [&](std::int32_t number, std::int32_t corner) {
        Ensight6Text file(GetParam(), true);
        file.line("a").line("b").line("node id given").line("element id off").line("coordinates").integer(27);
        std::vector<std::int32_t> numbers;
        std::vector<float> xyz;
        for (std::int32_t i = 0; i < 27; ++i) {
            numbers.push_back(i == 5 ? number : i + 1);
            for (const int x : {i % 3, i / 3 % 3, i / 9}) xyz.push_back(static_cast<float>(x));
        }
        file.nodes(numbers, xyz).line("part 1").line("c").line("tetra4").integer(1).integers({{corner, 2, 4, 10}});
        return message_of(read_ensight(
            folder_, {{"grid.geo", file.text()}, {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"}}));
    };
    EXPECT_EQ(error(60, 1), "read");
    EXPECT_NE(error(60, 6).find("has node 6, which is not there"), std::string::npos) << error(60, 6);
    EXPECT_NE(error(60, 61).find("has node 61"), std::string::npos) << error(60, 61);
    EXPECT_NE(error(7, 1).find("node 7 occurs twice"), std::string::npos) << error(7, 1);
    EXPECT_EQ(error(99'999'999, 1), "read");
}

TEST_P(Ensight6, PartsAndTypesOfElementsOfVariablesMustFit) {
    const auto error = [&](const std::function<void(Ensight6Text&)>& fill) {
        Ensight6Text file(GetParam());
        fill(file.line("of elements").line("part 1"));
        return with("e.scl", file.text());
    };
    const auto unknown = error([](auto& file) { file.line("tetra4").floats({1, 2, 3, 4}); });
    EXPECT_NE(unknown.find("part 1 has no elements 'tetra4'"), std::string::npos) << unknown;
    const auto part = error([](auto& file) { file.line("hexa8").floats({1, 2, 3, 4}).line("part 5").line("hexa8"); });
    EXPECT_NE(part.find("the geometry has no part 5"), std::string::npos) << part;
    const auto lacking = error(
        [](auto& file) { file.line("hexa8").floats({1, 2, 3, 4}).line("part 2").line("hexa8").floats({5, 6, 7}); });
    EXPECT_NE(lacking.find("2 elements \"penta6\", but there are no values"), std::string::npos) << lacking;
    const auto twice =
        error([](auto& file) { file.line("hexa8").floats({1, 2, 3, 4}).line("hexa8").floats({1, 2, 3, 4}); });
    EXPECT_NE(twice.find("are there twice"), std::string::npos) << twice;
    EXPECT_NE(error([](auto& file) { file.line("hexa8").floats({1, 2, 3}); }), "read");
    EXPECT_NE(error([](auto& file) { file.line("hexa8").floats({1, 2, 3, 4, 5}); }), "read");
}

TEST_P(Ensight6, BlocksAreReadWithAllKindsOfValues) {
    for (const std::size_t components : {std::size_t{1}, std::size_t{3}, std::size_t{6}}) {
        const std::string kind = components == 1 ? "scalar" : components == 3 ? "vector" : "tensor symm";
        for (const bool is_last : {true, false}) {
            EXPECT_EQ(block(kind + " per node", components, 12, is_last), "read");
            EXPECT_EQ(block(kind + " per element", components, 2, is_last), "read");
        }
        EXPECT_NE(block(kind + " per node", components, 11), "read");
        EXPECT_NE(block(kind + " per element", components, 3), "read");
    }
}

TEST_P(Ensight6, BlocksHaveTheirVectorsComponentByComponent) {
    ASSERT_EQ(block("vector per node", 3, 12), "read");
    Ensight6Text file(GetParam());
    file.line("values").line("part 1").line("block");
    for (int c = 0; c < 3; ++c) file.floats(Ensight6Box::values(12, c));
    folder_.write("x", file.text());
    const auto result = read_ensight(folder_, {});
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < 12; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(result->grid.point_fields.at(0).values.at(i, c), static_cast<double>(1000 * c + i + 1));
}

TEST_P(Ensight6, BlankedNodesTakeTheirCellsAway) {
    Ensight6Text file(GetParam(), true);
    file.line("a").line("b").line("node id off").line("element id off").line("coordinates").integer(0);
    file.line("part 1").line("c").line("block iblanked").integers({{3, 2, 2}});
    std::vector<float> xyz;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 12; ++i)
            xyz.push_back(static_cast<float>(axis == 0 ? i % 3 : axis == 1 ? i / 3 % 2 : i / 6));
    if (GetParam() == GoldForm::ascii)
        for (int axis = 0; axis < 3; ++axis) file.floats({xyz.begin() + 12 * axis, xyz.begin() + 12 * axis + 12});
    else file.floats(xyz);
    if (GetParam() == GoldForm::ascii) file.integers({{1, 1, 1, 1, 1, 0, 1, 1, 1, 1}, {1, 1}});
    else file.integers({{1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1}});
    const auto result = read_ensight(
        folder_, {{"grid.geo", file.text()}, {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"}});
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.cells.count(), 1u);
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_LE(result->grid.points.at(static_cast<std::size_t>(result->grid.cells.connectivity.at(i)), 0), 1);
}

TEST_P(Ensight6, TetrahedraMayHaveNumbersOfNodes) {
    Ensight6Text file(GetParam(), true);
    file.line("a").line("b").line("node id given").line("element id off").line("coordinates").integer(4);
    file.nodes({14, 12, 13, 11}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}).line("part 1").line("c");
    file.line("tetra4").integer(1).integers({{11, 12, 13, 14}});
    const auto result = read_ensight(
        folder_, {{"grid.geo", file.text()}, {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"}});
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(result->grid.cells.connectivity.at(i), (std::array{3, 1, 2, 0}[i]));
}

TEST_P(Ensight6, CurvedElementsKeepTheirNodes) {
    Ensight6Text file(GetParam(), true);
    file.line("a").line("b").line("node id off").line("element id off").line("coordinates").integer(10);
    file.nodes({}, {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1});
    file.line("part 1").line("c").line("tetra10").integer(1).integers({{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}});
    const auto result = read_ensight(
        folder_, {{"grid.geo", file.text()}, {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"}});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.types.at(0), 24);
    EXPECT_EQ(result->grid.cells.connectivity.size(), 10u);
}

TEST_P(Ensight6, PartsMayHaveAnyNumbers) {
    const Ensight6Box box{GetParam(), false, false, {7, 3}};
    Ensight6Text geometry(GetParam(), true), e(GetParam());
    const auto result = read_ensight(folder_, {{"grid.geo", box.put_geometry(geometry).text()},
                                               {"e.scl", box.put_elements(e, 1).text()},
                                               {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                                          "scalar per element: e e.scl\n"}});
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(result->grid.cell_fields.at(0).values.at(i), static_cast<double>(i + 1));
}

std::string name_of_6_form(const testing::TestParamInfo<GoldForm>& form) {
    constexpr const char* names[] = {"Ascii", "C", "CSwapped", "Fortran"};
    return names[static_cast<std::size_t>(form.param)];
}

/// Where the first count fits into the file in either byte order.
TEST_P(Ensight6, NumbersThatLookLikeOthersInTheOtherByteOrderAreRead) {
    for (const std::int32_t count : {64, 256, 320, 512}) {
        Ensight6Text file(GetParam(), true), values(GetParam());
        file.line("a").line("b").line("node id off").line("element id off").line("coordinates").integer(count);
        std::vector<float> xyz;
        for (int i = 0; i < count; ++i)
            for (const int x : {i % 2, i / 2 % 2, i / 4}) xyz.push_back(static_cast<float>(x));
        file.nodes({}, xyz).line("part 1").line("c").line("hexa8");
        std::vector<std::vector<std::int32_t>> rows(count == 64 ? 1 : 20'000, {1, 2, 4, 3, 5, 6, 8, 7});
        file.integer(static_cast<std::int32_t>(rows.size())).integers(rows);
        values.line("n").floats(Ensight6Box::values(static_cast<std::size_t>(count), 0));
        const auto result = read_ensight(folder_, {{"grid.geo", file.text()},
                                                   {"n.scl", values.text()},
                                                   {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"
                                                              "VARIABLE\nscalar per node: n n.scl\n"}});
        ASSERT_TRUE(result) << count << ": " << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), rows.size());
        EXPECT_EQ(result->grid.points.at(7, 2), 1);
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(7), 8);
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, Ensight6,
                         testing::Values(GoldForm::ascii, GoldForm::c, GoldForm::c_swapped, GoldForm::fortran),
                         name_of_6_form);

TEST(Ensight6Lines, HaveNumbersBetweenSpacesOrInColumns) {
    const TemporaryFolder folder;
    const Ensight6Box box;
    Ensight6Text geometry(GoldForm::ascii, true);
    const EnsightFolder files{{"grid.geo", box.put_geometry(geometry).text()},
                              {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                         "scalar per node: n n.scl\n"}};
    std::string lines;
    for (int line = 0; line < 4; ++line) lines += "1 2 3 4 5 6\n";
    const auto read_last = [&](const std::string& last) {
        folder.write("n.scl", "n\n" + lines + last);
        return read_ensight(folder, files);
    };
    for (const char* last :
         {" 1.00000e+00 2.00000e+00-3.00000e+00\n", " 1.00000e+00 2.00000e+00-3.00000e+00", "1 2 -3\n", "1\n2\n-3\n",
          " 1.0000000000000 2.00000e+00 -3\n", " 1.00000D+00 2.00000D+00-3.00000D+00\n", "1.00000000002.0000000000-3\n",
          "1.00000e+0002.00000e+000-3.00000e+000\n"}) {
        const auto result = read_last(last);
        ASSERT_TRUE(result) << last << result.error().message;
        const Array& values = result->grid.point_fields.at(0).values;
        for (std::size_t i = 24; i < 27; ++i) EXPECT_EQ(values.at(i), (std::array{1, 2, -3}[i - 24])) << last;
    }
    for (const char* last : {" 1.00000e+00 2.00000e+00\n", " 1.00000e+00 2.00000e+00 3.0000", "", "x\n", "1 2 3 4\n"})
        EXPECT_NE(message_of(read_last(last)).find("n.scl"), std::string::npos) << last;
}

TEST(Ensight6Lines, HaveIntegersInColumnsOfEight) {
    const TemporaryFolder folder;
    const std::string nodes = "a\nb\nnode id given\nelement id given\ncoordinates\n4\n"
                              "10000000 0.00000e+00 0.00000e+00 0.00000e+00\n"
                              "10000001 1.00000e+00 0.00000e+00 0.00000e+00\n"
                              "  999999 0.00000e+00 1.00000e+00 0.00000e+00\n"
                              "10000003 0.00000e+00 0.00000e+00 1.00000e+00\n";
    const auto result =
        read_ensight(folder, {{"grid.geo", nodes + "part 1\nc\ntetra4\n1\n1234567810000000100000011000000310000003\n"},
                              {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"}});
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(result->grid.cells.connectivity.at(i), (std::array{0, 1, 3, 3}[i]));
}

} // namespace
} // namespace isotet::test
