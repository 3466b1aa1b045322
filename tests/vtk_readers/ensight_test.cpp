// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold in all its forms, whole, and cut or changed: an error, never zeros.
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/gold_text.hpp"

namespace isotet::test {
namespace {

/// Two tetrahedra and a pyramid in two parts, with a scalar and a vector of nodes and a scalar of elements.
class EnsightFiles : public testing::TestWithParam<GoldForm> {
protected:
    static std::string geometry() {
        GoldText file(GetParam(), true);
        file.line("two parts").line("for a test").line("node id given").line("element id off");
        file.line("part").integers({1}).line("solid").line("coordinates").integers({5}).integers({1, 2, 3, 4, 5});
        for (const auto& axis : {std::vector<float>{0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, -1}})
            file.floats(axis);
        file.line("tetra4").integers({2}).integers({1, 2, 3, 4, 1, 3, 2, 5}, 4);
        file.line("part").integers({2}).line("roof").line("coordinates").integers({5}).integers({1, 2, 3, 4, 5});
        for (const auto& axis : {std::vector<float>{5, 6, 6, 5, 5}, {0, 0, 1, 1, 0}, {0, 0, 0, 0, 1}})
            file.floats(axis);
        file.line("pyramid5").integers({1}).integers({1, 2, 3, 4, 5}, 5);
        return file.text();
    }
    static std::string of_nodes(std::size_t components) {
        GoldText file(GetParam());
        file.line("of nodes");
        for (int part = 1; part <= 2; ++part) {
            file.line("part").integers({part}).line("coordinates");
            for (std::size_t c = 0; c < components; ++c) file.floats({1, 2, 3, 4, 5});
        }
        return file.text();
    }
    static std::string of_elements() {
        GoldText file(GetParam());
        file.line("of elements");
        file.line("part").integers({1}).line("tetra4").floats({7, 8});
        return file.line("part").integers({2}).line("pyramid5").floats({9}).text();
    }

    Result<ReadResult> read_with(const std::string& name, const std::string& text) {
        folder_.write("grid.geo", geometry());
        folder_.write("t.scl", of_nodes(1));
        folder_.write("v.vec", of_nodes(3));
        folder_.write("e.scl", of_elements());
        if (!name.empty()) folder_.write(name, text);
        return read(folder_.write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                            "scalar per node: t t.scl\nvector per node: v v.vec\n"
                                            "scalar per element: e e.scl\n"));
    }

    TemporaryFolder folder_;
};

TEST_P(EnsightFiles, AreReadWhole) {
    const auto result = read_with("", "");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 3u);
    EXPECT_EQ(result->grid.point_fields.size(), 2u);
    ASSERT_EQ(result->grid.cell_fields.size(), 1u);
    EXPECT_EQ(result->grid.cell_fields[0].values.at(2), 9);
}

TEST_P(EnsightFiles, VariablesThatAreCutAreErrorsThatNameTheFile) {
    for (const auto& [name, whole] :
         {std::pair("t.scl", of_nodes(1)), {"v.vec", of_nodes(3)}, {"e.scl", of_elements()}}) {
        const std::size_t second_part = whole.find("part", whole.find("part") + 1);
        const std::size_t first_end = second_part - (GetParam() == GoldForm::fortran ? 4 : 0);
        std::vector<std::size_t> lengths{first_end + 3, whole.size() - 6};
        if (whole == of_nodes(1)) lengths.insert(lengths.end(), {0, 3, first_end - 3, whole.size() - 2});
        for (const std::size_t length : lengths) {
            const auto result = read_with(name, whole.substr(0, length));
            ASSERT_FALSE(result) << name << " cut to " << length << " of " << whole.size() << " bytes";
            EXPECT_NE(result.error().message.find(name), std::string::npos) << result.error().message;
        }
    }
}

TEST_P(EnsightFiles, GeometryThatIsCutIsAnErrorThatNamesTheFile) {
    const std::string whole = geometry();
    const std::size_t cells = whole.find("tetra4");
    for (const std::size_t length :
         {std::size_t{3}, cells / 2, cells - 6, cells + 3, whole.size() - 6, whole.size() - 2}) {
        const auto result = read_with("grid.geo", whole.substr(0, length));
        ASSERT_FALSE(result) << "cut to " << length << " of " << whole.size() << " bytes";
        EXPECT_NE(result.error().message.find("grid.geo"), std::string::npos)
            << "cut to " << length << " of " << whole.size() << " bytes: " << result.error().message;
    }
}

TEST_P(EnsightFiles, CountsThatDoNotFitAreErrors) {
    for (const std::int32_t count : {-1, 6, 2'000'000'000}) {
        GoldText nodes(GetParam(), true), elements(GetParam(), true);
        for (GoldText* file : {&nodes, &elements})
            file->line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
        nodes.line("coordinates").integers({count}).floats({0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1});
        nodes.line("tetra4").integers({1}).integers({1, 2, 3, 4}, 4);
        elements.line("coordinates").integers({4});
        for (const auto& axis : {std::vector<float>{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}) elements.floats(axis);
        elements.line("tetra4").integers({count}).integers({1, 2, 3, 4}, 4);
        EXPECT_FALSE(read_with("grid.geo", nodes.text())) << count << " nodes";
        EXPECT_FALSE(read_with("grid.geo", elements.text())) << count << " elements";
    }
}

TEST_P(EnsightFiles, VariablesOfOtherElementsOrPartsAreErrors) {
    GoldText other(GetParam());
    other.line("of elements").line("part").integers({1}).line("hexa8").floats({7, 8});
    const auto elements = read_with("e.scl", other.text());
    ASSERT_FALSE(elements);
    EXPECT_NE(elements.error().message.find("part 1 has no elements \"hexa8\""), std::string::npos)
        << elements.error().message;
    GoldText unknown(GetParam());
    unknown.line("of elements").line("part").integers({3}).line("tetra4").floats({7, 8});
    const auto part = read_with("e.scl", unknown.text());
    ASSERT_FALSE(part);
    EXPECT_NE(part.error().message.find("the geometry has no part 3"), std::string::npos) << part.error().message;
}

std::string name_of_form(const testing::TestParamInfo<GoldForm>& form) {
    constexpr const char* names[] = {"Ascii", "C", "CSwapped", "Fortran"};
    return names[static_cast<std::size_t>(form.param)];
}

INSTANTIATE_TEST_SUITE_P(Forms, EnsightFiles,
                         testing::Values(GoldForm::ascii, GoldForm::c, GoldForm::c_swapped, GoldForm::fortran),
                         name_of_form);

TEST(EnsightSteps, AreLookedAtInTheFilesOfTheStep) {
    const TemporaryFolder folder;
    const std::string geometry =
        "a\nb\nnode id off\nelement id off\npart\n1\nc\ncoordinates\n4\n0\n1\n0\n0\n0\n0\n1\n0\n"
        "0\n0\n0\n1\ntetra4\n1\n1 2 3 4\n";
    folder.write("grid.geo", geometry);
    folder.write("t.005", "t\npart\n1\ncoordinates\n1\n2\n3\n4\n");
    folder.write("t.007", "t\npart\n1\ncoordinates\n1\n2\n");
    const std::string path = folder.write(
        "a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\nscalar per node: 1 t t.***\nTIME\n"
                  "time set: 1\nnumber of steps: 2\nfilename start number: 5\nfilename increment: 2\n"
                  "time values: 0 1\n");
    ReadOptions options;
    options.step = 0;
    const auto whole = read(path, options);
    ASSERT_TRUE(whole) << whole.error().message;
    options.step = 1;
    const auto cut = read(path, options);
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().message.find("t.007"), std::string::npos) << cut.error().message;
}

} // namespace
} // namespace isotet::test
