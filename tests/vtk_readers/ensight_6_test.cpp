// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight 6 as text and binary, whole, and cut or changed: an error, never zeros. What VTK's reader mixes up is refused.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "vtk_readers/ensight_6_text.hpp"
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
    EXPECT_NE(error(7, 1).find("node 7 is there twice"), std::string::npos) << error(7, 1);
    EXPECT_NE(error(-1, 1).find("grid.geo"), std::string::npos) << error(-1, 1);
    EXPECT_NE(error(99'999'999, 1).find("too large"), std::string::npos) << error(99'999'999, 1);
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

TEST_P(Ensight6, BlocksAreReadAsFarAsVtkReadsThem) {
    const bool text = GetParam() == GoldForm::ascii;
    EXPECT_EQ(block("scalar per node", 1, 12), "read");
    EXPECT_EQ(block("scalar per element", 1, 2), "read");
    EXPECT_EQ(block("vector per element", 3, 2) == "read", text);
    for (const char* kind : {"vector per node", "tensor symm per node"})
        EXPECT_NE(block(kind, kind[0] == 'v' ? 3 : 6, 12).find("VTK's reader mixes up"), std::string::npos);
    EXPECT_NE(block("tensor symm per element", 6, 2).find("VTK's reader mixes up"), std::string::npos);
    EXPECT_EQ(block("scalar per node", 1, 12, false) == "read", !text); // 12 values fill whole lines
    EXPECT_EQ(block("scalar per element", 1, 2, false) == "read", !text);
    EXPECT_NE(block("scalar per node", 1, 11), "read");
    EXPECT_NE(block("scalar per element", 1, 3), "read");
}

TEST_P(Ensight6, TetrahedraWithNumbersOfNodesAreReadOnlyWhereVtkReadsThem) {
    Ensight6Text file(GetParam(), true);
    file.line("a").line("b").line("node id given").line("element id off").line("coordinates").integer(4);
    file.nodes({11, 12, 13, 14}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}).line("part 1").line("c");
    file.line("tetra4").integer(1).integers({{11, 12, 13, 14}});
    const std::string message = message_of(read_ensight(
        folder_, {{"grid.geo", file.text()}, {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n"}}));
    if (GetParam() == GoldForm::ascii) EXPECT_EQ(message, "read");
    else EXPECT_NE(message.find("fourth node"), std::string::npos) << message;
}

std::string name_of_6_form(const testing::TestParamInfo<GoldForm>& form) {
    constexpr const char* names[] = {"Ascii", "C", "CSwapped"};
    return names[static_cast<std::size_t>(form.param)];
}

/// Where the first count fits into the file in either byte order, or VTK's reader thinks so.
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

INSTANTIATE_TEST_SUITE_P(Forms, Ensight6, testing::Values(GoldForm::ascii, GoldForm::c, GoldForm::c_swapped),
                         name_of_6_form);

TEST(Ensight6Lines, MustStandInTheColumnsThatVtkTakes) {
    const TemporaryFolder folder;
    const Ensight6Box box;
    Ensight6Text geometry(GoldForm::ascii, true);
    const EnsightFolder files{{"grid.geo", box.put_geometry(geometry).text()},
                              {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                         "scalar per node: n n.scl\n"}};
    std::string lines;
    for (int line = 0; line < 4; ++line) lines += "1 2 3 4 5 6\n";
    const auto error = [&](const std::string& last) {
        folder.write("n.scl", "n\n" + lines + last);
        return message_of(read_ensight(folder, files));
    };
    EXPECT_EQ(error(" 1.00000e+00 2.00000e+00-3.00000e+00\n"), "read");
    EXPECT_EQ(error(" 1.00000e+00-2.00000e+00 3.00000e+00"), "read");
    for (const char* last :
         {"1 2 3\n", " 1.0000000000000 2.00000e+00 3.00000e+00\n", " 1.00000D+00 2.00000D+00 3.00000D+00\n",
          " 1.00000e+00 2.00000e+00\n", " 1.00000e+00 2.00000e+00 3.0000", "", "x\n"})
        EXPECT_NE(error(last).find("n.scl"), std::string::npos) << last << error(last);
}

TEST(Ensight6Lines, ElementsOfPartsWithOtherNumbersThanTheirPlacesAreRefused) {
    const TemporaryFolder folder;
    const Ensight6Box box{GoldForm::ascii, false, false, {3, 7}};
    Ensight6Text geometry(GoldForm::ascii, true), e(GoldForm::ascii);
    const std::string head = "FORMAT\ntype: ensight\nGEOMETRY\nmodel: grid.geo\n";
    EnsightFolder files{{"grid.geo", box.put_geometry(geometry).text()},
                        {"e.scl", box.put_elements(e, 1).text()},
                        {"a.case", head + "VARIABLE\nscalar per element: e e.scl\n"}};
    const auto refused = message_of(read_ensight(folder, files));
    EXPECT_NE(refused.find("unless parts are numbered from 1 on"), std::string::npos) << refused;
    files["a.case"] = head;
    EXPECT_EQ(message_of(read_ensight(folder, files)), "read");
}

TEST(Ensight6Binary, OfFortranIsRefused) {
    const TemporaryFolder folder;
    const Ensight6Box box{GoldForm::fortran, false, false, {1, 2}};
    Ensight6Text geometry(GoldForm::fortran, true);
    const auto refused = message_of(read_ensight(folder, {{"grid.geo", box.put_geometry(geometry).text()},
                                                          {"a.case", "FORMAT\ntype: ensight\nGEOMETRY\n"
                                                                     "model: grid.geo\n"}}));
    EXPECT_NE(refused.find("VTK's reader does not read EnSight 6 as Fortran binary"), std::string::npos) << refused;
}

} // namespace
} // namespace isotet::test
