// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight files with several time steps each, and values that are undefined or given in part.
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "vtk_readers/ensight/ensight_6_text.hpp"
#include "vtk_readers/whole_or_error.hpp"

namespace isotet::test {
namespace {

struct Format {
    bool is_gold;
    GoldForm form;
};

/// Two tetrahedra and a pyramid in two parts. Each step is moved by 10 in x.
void put_gold_geometry(GoldText& file, int step) {
    const auto moved = static_cast<float>(10 * step);
    file.line("two parts").line("for a test").line("node id off").line("element id off");
    file.line("part").integers({1}).line("solid").line("coordinates").integers({5});
    for (const auto& axis :
         {std::vector<float>{moved, 1 + moved, moved, moved, moved}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, -1}})
        file.floats(axis);
    file.line("tetra4").integers({2}).integers({1, 2, 3, 4, 1, 3, 2, 5}, 4);
    file.line("part").integers({2}).line("roof").line("coordinates").integers({5});
    for (const auto& axis : {std::vector<float>{5, 6, 6, 5, 5}, {0, 0, 1, 1, 0}, {0, 0, 0, 0, 1}}) file.floats(axis);
    file.line("pyramid5").integers({1}).integers({1, 2, 3, 4, 5}, 5);
}

void put_gold_nodes(GoldText& file, std::size_t components, int step) {
    file.line("of nodes");
    for (int part = 1; part <= 2; ++part) {
        file.line("part").integers({part}).line("coordinates");
        for (std::size_t c = 0; c < components; ++c) {
            std::vector<float> values;
            for (int i = 0; i < 5; ++i)
                values.push_back(static_cast<float>(1000 * step + 100 * part + 10 * static_cast<int>(c) + i));
            file.floats(values);
        }
    }
}

void put_gold_elements(GoldText& file, int step) {
    const auto more = static_cast<float>(1000 * step);
    file.line("of elements").line("part").integers({1}).line("tetra4").floats({7 + more, 8 + more});
    file.line("part").integers({2}).line("pyramid5").floats({9 + more});
}

template <class Text>
std::string in_steps(Text file, int first, int end, const std::function<void(Text&, int)>& put) {
    for (int step = first; step < end; ++step) {
        file.line("BEGIN TIME STEP");
        put(file, step);
        file.line("END TIME STEP");
    }
    return file.text();
}

class EnsightStepsInFiles : public testing::TestWithParam<Format> {
protected:
    struct Contents {
        std::string geometry, n, v, e;
    };
    static Contents steps(int first, int end, bool element_ids = true) {
        const auto [is_gold, form] = GetParam();
        if (is_gold)
            return {in_steps<GoldText>(GoldText(form, true), first, end, put_gold_geometry),
                    in_steps<GoldText>(GoldText(form), first, end, [](auto& f, int s) { put_gold_nodes(f, 1, s); }),
                    in_steps<GoldText>(GoldText(form), first, end, [](auto& f, int s) { put_gold_nodes(f, 3, s); }),
                    in_steps<GoldText>(GoldText(form), first, end, [](auto& f, int s) { put_gold_elements(f, s); })};
        const Ensight6Box box{form, false, element_ids, {1, 2}};
        using Text = Ensight6Text;
        return {in_steps<Text>(Text(form, true), first, end, [&](Text& f, int s) { box.put_geometry(f, s); }),
                in_steps<Text>(Text(form), first, end, [&](Text& f, int s) { Ensight6Box::put_nodes(f, 1, s); }),
                in_steps<Text>(Text(form), first, end, [&](Text& f, int s) { Ensight6Box::put_nodes(f, 3, s); }),
                in_steps<Text>(Text(form), first, end, [&](Text& f, int s) { box.put_elements(f, 1, s); })};
    }
    static std::string head() {
        return GetParam().is_gold ? "FORMAT\ntype: ensight gold\n" : "FORMAT\ntype: ensight\n";
    }
    static EnsightFolder one_file() {
        const Contents all = steps(0, 3);
        return {{"grid.geo", all.geometry},
                {"n.scl", all.n},
                {"v.vec", all.v},
                {"e.scl", all.e},
                {"a.case", head() +
                               "GEOMETRY\nmodel: 1 1 grid.geo\nVARIABLE\nscalar per node: 1 1 n n.scl\n"
                               "vector per node: 1 1 v v.vec\nscalar per element: 1 1 e e.scl\nTIME\ntime set: 1\n"
                               "number of steps: 3\ntime values: 0\n1 2\nFILE\nfile set: 1\nnumber of steps: 3\n"}};
    }
    static void expect_step(const Result<ReadResult>& result, int step) {
        ASSERT_TRUE(result) << result.error().message;
        const Grid& grid = result->grid;
        const bool is_gold = GetParam().is_gold;
        ASSERT_EQ(grid.cells.count(), is_gold ? 3u : 9u);
        EXPECT_EQ(grid.points.at(0, 0), 10 * step);
        ASSERT_EQ(grid.point_fields.size(), 2u);
        EXPECT_EQ(grid.point_fields[0].values.at(1), 1000 * step + (is_gold ? 101 : 2));
        EXPECT_EQ(grid.point_fields[1].values.at(1, 2), 1000 * step + (is_gold ? 121 : 6));
        EXPECT_EQ(grid.cell_fields.at(0).values.at(2), 1000 * step + (is_gold ? 9 : 3));
    }

    TemporaryFolder folder_;
};

TEST_P(EnsightStepsInFiles, AreReadOneByOne) {
    const EnsightFolder files = one_file();
    for (const int step : {2, 0, 1}) expect_step(read_ensight(folder_, files, static_cast<std::size_t>(step)), step);
}

TEST_P(EnsightStepsInFiles, GoWithTheTimesAsTheyAreListed) {
    EnsightFolder files = one_file();
    std::string& text = files["a.case"];
    text.replace(text.find("time values: 0\n1 2"), 18, "time values: 5\n0 2");
    for (const auto& [step, place] : {std::pair{0, 1}, {1, 2}, {2, 0}})
        expect_step(read_ensight(folder_, files, static_cast<std::size_t>(step)), place);
}

TEST_P(EnsightStepsInFiles, AreFoundInTheFileThatHasThem) {
    const Contents first = steps(0, 2), second = steps(2, 3);
    EnsightFolder files{{"g05", first.geometry},  {"n05", first.n},  {"v05", first.v},  {"e05", first.e},
                        {"g07", second.geometry}, {"n07", second.n}, {"v07", second.v}, {"e07", second.e}};
    files["a.case"] = head() +
                      "GEOMETRY\nmodel: 1 1 g**\nVARIABLE\nscalar per node: 1 1 n n**\nvector per node: 1 1 v v**\n"
                      "scalar per element: 1 1 e e**\nTIME\ntime set: 1\nnumber of steps: 3\n"
                      "filename start number: 5\nfilename increment: 1\ntime values: 0 1 2\nFILE\nfile set: "
                      "1\nfilename index: 5\nnumber of steps: 2\nfilename index: 7\n"
                      "number of steps: 1\n";
    for (int step = 0; step < 3; ++step)
        expect_step(read_ensight(folder_, files, static_cast<std::size_t>(step)), step);
    files["n07"] = second.n.substr(0, second.n.size() - 90);
    expect_step(read_ensight(folder_, files, 1), 1);
    const auto cut = message_of(read_ensight(folder_, files, 2));
    EXPECT_NE(cut.find("n07"), std::string::npos) << cut;
}

TEST_P(EnsightStepsInFiles, AreErrorsWhereverAFileIsCut) {
    expect_whole_or_error(one_file(), 0);
    expect_whole_or_error(one_file(), 2);
}

TEST_P(EnsightStepsInFiles, ThatAreNotThereAreErrors) {
    EnsightFolder files = one_file();
    const Contents two = steps(0, 2);
    for (const auto& [name, content] : {std::pair("grid.geo", two.geometry), {"n.scl", two.n}, {"e.scl", two.e}}) {
        EnsightFolder fewer = files;
        fewer[name] = content;
        const auto message = message_of(read_ensight(folder_, fewer, 2));
        EXPECT_NE(message.find("step 3 is to be read, but there are 2"), std::string::npos) << message;
        EXPECT_NE(message.find(name), std::string::npos) << message;
        expect_step(read_ensight(folder_, fewer, 1), 1);
    }
}

TEST_P(EnsightStepsInFiles, WithoutAFileSectionOrWithoutTheirMarksAreRefused) {
    EnsightFolder files = one_file();
    const std::string whole = files["a.case"];
    files["a.case"] = whole.substr(0, whole.find("FILE"));
    const auto no_section = message_of(read_ensight(folder_, files));
    EXPECT_NE(no_section.find("the case has no FILE section"), std::string::npos) << no_section;
    files["a.case"] = whole;
    const auto [is_gold, form] = GetParam();
    GoldText gold(form, true);
    Ensight6Text six(form, true);
    put_gold_geometry(gold, 0);
    const Ensight6Box box{form, false, false, {1, 2}};
    files["grid.geo"] = is_gold ? gold.text() : box.put_geometry(six).text();
    const auto no_marks = message_of(read_ensight(folder_, files));
    EXPECT_NE(no_marks.find("there are 0 between BEGIN TIME STEP"), std::string::npos) << no_marks;
}

TEST_P(EnsightStepsInFiles, MayHaveOtherCounts) {
    EnsightFolder files = one_file();
    const auto [is_gold, form] = GetParam();
    GoldText gold(form), gold_geometry(form, true);
    Ensight6Text six(form), six_geometry(form, true);
    for (int step = 0; step < 2; ++step) { // the first one has one cell less
        const auto put = [&](auto& geometry, auto& e) {
            geometry.line("BEGIN TIME STEP").line("a").line("b").line("node id off").line("element id off");
            e.line("BEGIN TIME STEP").line("of elements");
        };
        const std::vector<std::vector<std::int32_t>> all{{1, 2, 3, 4}, {1, 3, 2, 5}};
        const std::vector<std::vector<std::int32_t>> cells(all.begin(), all.begin() + 1 + step);
        const std::vector<float> values(cells.size(), static_cast<float>(step));
        const auto count = static_cast<std::int32_t>(cells.size());
        if (is_gold) {
            put(gold_geometry, gold);
            gold_geometry.line("part").integers({1}).line("c").line("coordinates").integers({5});
            gold_geometry.floats({0, 1, 0, 0, 0}).floats({0, 0, 1, 0, 0}).floats({0, 0, 0, 1, -1});
            gold_geometry.line("tetra4").integers({count}).rows(cells).line("END TIME STEP");
            gold.line("part").integers({1}).line("tetra4").floats(values).line("END TIME STEP");
        } else {
            put(six_geometry, six);
            six_geometry.line("coordinates").integer(5).nodes({}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1});
            six_geometry.line("part 1").line("c").line("tetra4").integer(count).integers(cells).line("END TIME STEP");
            six.line("part 1").line("tetra4").floats(values).line("END TIME STEP");
        }
    }
    files["grid.geo"] = is_gold ? gold_geometry.text() : six_geometry.text();
    files["e.scl"] = is_gold ? gold.text() : six.text();
    files["a.case"] =
        head() + "GEOMETRY\nmodel: 1 1 grid.geo\nVARIABLE\nscalar per element: 1 1 e e.scl\n"
                 "TIME\ntime set: 1\nnumber of steps: 2\ntime values: 0 1\nFILE\nfile set: 1\nnumber of steps: 2\n";
    for (const std::size_t step : {1U, 0U}) {
        const auto result = read_ensight(folder_, files, step);
        ASSERT_TRUE(result) << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), 1 + step);
        EXPECT_EQ(result->grid.cell_fields.at(0).values.at(step), static_cast<double>(step));
    }
}

TEST_P(EnsightStepsInFiles, MayShareAGeometryThatNamesNoSets) {
    for (const bool marked : {true, false}) {
        EnsightFolder files = one_file();
        const auto [is_gold, form] = GetParam();
        GoldText gold(form, true);
        Ensight6Text six(form, true);
        put_gold_geometry(gold, 0);
        const Ensight6Box box{form, false, false, {1, 2}};
        files["grid.geo"] = marked ? steps(0, 1).geometry : is_gold ? gold.text() : box.put_geometry(six).text();
        std::string& text = files["a.case"];
        text.replace(text.find("model: 1 1"), 10, "model:");
        for (const std::size_t step : {2U, 0U}) {
            const auto result = read_ensight(folder_, files, step);
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(result->grid.points.at(0, 0), 0);
            EXPECT_EQ(result->grid.point_fields.at(0).values.at(1),
                      1000.0 * static_cast<double>(step) + (is_gold ? 101 : 2));
        }
    }
}

TEST_P(EnsightStepsInFiles, OfVariablesWithoutAFileSetAreInTheFirstOne) {
    EnsightFolder files = one_file();
    std::string& text = files["a.case"];
    text.replace(text.find("1 1 v"), 3, "1");
    expect_step(read_ensight(folder_, files, 2), 2);
}

TEST_P(EnsightStepsInFiles, AreFoundWithoutTheIndex) {
    const auto [is_gold, form] = GetParam();
    if (!is_gold || form != GoldForm::c) return;
    const auto with_index = [](std::string bytes, int wrong) {
        const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
        std::vector<std::int64_t> begins;
        for (std::size_t at = 0; (at = bytes.find("BEGIN TIME STEP", at)) != std::string::npos; at += 80)
            begins.push_back(static_cast<std::int64_t>(at) + 80);
        const auto index = static_cast<std::int64_t>(bytes.size());
        put(static_cast<std::int32_t>(begins.size()));
        for (std::size_t i = 0; i < begins.size(); ++i) put(begins[i] + (static_cast<int>(i) == wrong ? 80 : 0));
        put(std::int32_t{0});
        put(index);
        return bytes + "FILE_INDEX" + std::string(70, ' ');
    };
    EnsightFolder files = one_file();
    for (const char* name : {"grid.geo", "n.scl"}) {
        const std::string whole = files[name];
        files[name] = with_index(whole, -1);
        for (int step = 0; step < 3; ++step)
            expect_step(read_ensight(folder_, files, static_cast<std::size_t>(step)), step);
        files[name] = with_index(whole, 1);
        expect_step(read_ensight(folder_, files, 1), 1);
        files[name] = whole;
    }
}

std::string name_of_format(const testing::TestParamInfo<Format>& format) {
    constexpr const char* names[] = {"Ascii", "C", "CSwapped", "Fortran"};
    return (format.param.is_gold ? "Gold" : "Six") + std::string(names[static_cast<std::size_t>(format.param.form)]);
}

INSTANTIATE_TEST_SUITE_P(Formats, EnsightStepsInFiles,
                         testing::Values(Format{true, GoldForm::ascii}, Format{true, GoldForm::c},
                                         Format{true, GoldForm::c_swapped}, Format{true, GoldForm::fortran},
                                         Format{false, GoldForm::ascii}, Format{false, GoldForm::c},
                                         Format{false, GoldForm::c_swapped}, Format{false, GoldForm::fortran}),
                         name_of_format);

TEST(EnsightCaseFile, LeavesOutWhatIsNotKnownAndSaysSo) {
    const TemporaryFolder folder;
    GoldText geometry(GoldForm::c, true), values(GoldForm::c);
    put_gold_geometry(geometry, 0);
    put_gold_nodes(values, 1, 0);
    folder.write("grid.geo", geometry.text());
    folder.write("t.scl", values.text());
    const std::string head = "Format\n type: EnSight Gold\n GEOMETRY\n  model: grid.geo\n";
    for (const char* line : {"scalar per ulement: t t.scl", "scalar per node: t", "complex scalar per node: t t.scl",
                             "constant per case: a 1"}) {
        const auto result =
            read(folder.write("a.case", head + "VARIABLE\n " + line + "\nscalar per node: t t.scl\nQUERY\nx y: z\n"));
        ASSERT_TRUE(result) << line << ": " << result.error().message;
        EXPECT_EQ(result->info.fields.size(), 1u);
        ASSERT_EQ(result->info.left_out.size(), 2u);
        EXPECT_EQ(result->info.left_out[0].name, line);
        EXPECT_EQ(result->info.left_out[1].name, "QUERY");
    }
}

TEST(EnsightCaseFile, WithALineThatDoesNotBelongThereIsAnError) {
    const TemporaryFolder folder;
    GoldText geometry(GoldForm::c, true), values(GoldForm::c);
    put_gold_geometry(geometry, 0);
    put_gold_nodes(values, 1, 0);
    folder.write("grid.geo", geometry.text());
    folder.write("t.scl", values.text());
    const auto error = [&](const std::string& text) { return message_of(read(folder.write("a.case", text))); };
    const std::string head = "FORMAT\ntype:  ensight gold\n\nGEOMETRY\nmodel: grid.geo\n", tail = "VARIABLE\n";
    EXPECT_EQ(error(head + "# a comment\n\n" + tail + "scalar  per\tnode:  t  t.scl\r\nconstant per case: a 1\n"),
              "read");
    EXPECT_EQ(error(head + tail + "scalar per node :t t.scl\n"), "read");
    EXPECT_EQ(error(head + tail +
                    "scalar per node: t t.scl\nTIME\ntime set: 1\nnumber of steps: 1\ntime values: 0\n"
                    "MATERIAL\nmaterial set number: 1\n"),
              "read");
    for (const char* line : {"scalar per node t t.scl", "scalar per", "some words"}) {
        const auto message = error(head + tail + line + "\n");
        EXPECT_NE(message.find("stands where a variable was expected"), std::string::npos) << message;
    }
    for (const char* line : {"variabel", "scalar per node: t t.scl"}) {
        const auto message = error(head + line + "\n");
        EXPECT_NE(message.find("stands where model: was expected"), std::string::npos) << message;
    }
    for (const char* line : {"type: enright", "type: ensight silver", "typ: ensight gold"}) {
        const auto message = error("FORMAT\n" + std::string(line) + head.substr(head.find("\n\n")));
        EXPECT_NE(message.find("type: ensight gold"), std::string::npos) << message;
    }
    const auto model = error("FORMAT\ntype: ensight gold\nGEOMETRY\n" + tail + "scalar per node: t t.scl\n");
    EXPECT_NE(model.find("names no geometry"), std::string::npos) << model;
}

/// Values of five nodes in each of two parts.
class EnsightUndefined : public testing::TestWithParam<GoldForm> {
protected:
    using Fill = std::function<void(GoldText&)>;
    Result<ReadResult> read_values(const std::string& kind, const Fill& fill) {
        GoldText values(GetParam());
        values.line("values").line("part").integers({1});
        fill(values);
        return read_ensight(folder_, files(kind, values.text()));
    }
    static EnsightFolder files(const std::string& kind, const std::string& values) {
        GoldText geometry(GetParam(), true);
        put_gold_geometry(geometry, 0);
        return {{"grid.geo", geometry.text()},
                {"x", values},
                {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n" + kind + ": x x\n"}};
    }

    TemporaryFolder folder_;
};

TEST_P(EnsightUndefined, ValuesAreNaN) {
    const auto result = read_values("scalar per node", [](GoldText& file) {
        file.line("coordinates undef").floats({-9}).floats({1, -9, 3, 4, 5});
        file.line("part").integers({2}).line("coordinates").floats({6, 7, 8, 9, 10});
    });
    ASSERT_TRUE(result) << result.error().message;
    const Array& values = result->grid.point_fields.at(0).values;
    EXPECT_EQ(values.at(0), 1);
    EXPECT_TRUE(std::isnan(values.at(1)));
    EXPECT_EQ(values.at(9), 10);
}

TEST_P(EnsightUndefined, ValueThatNoNodeHasIsNoHindrance) {
    const auto result = read_values("scalar per node", [](GoldText& file) {
        file.line("coordinates undef").floats({-9}).floats({1, 2, 3, 4, 5});
        file.line("part").integers({2}).line("coordinates").floats({6, 7, 8, 9, 10});
    });
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < 10; ++i)
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(i), static_cast<double>(i + 1));
}

TEST_P(EnsightUndefined, VectorsAndElementsAreRead) {
    const auto vectors = read_values("vector per node", [](GoldText& file) {
        file.line("coordinates undef").floats({-9});
        for (int c = 0; c < 3; ++c) file.floats({1, 2, -9, 4, 5});
    });
    const auto elements = read_values("scalar per element", [](GoldText& file) {
        file.line("tetra4 undef").floats({-9}).floats({7, 8}).line("part").integers({2}).line("pyramid5").floats({9});
    });
    ASSERT_TRUE(elements) << elements.error().message;
    EXPECT_EQ(elements->grid.cell_fields.at(0).values.at(2), 9);
    ASSERT_TRUE(vectors) << vectors.error().message;
    EXPECT_EQ(vectors->grid.point_fields.at(0).values.at(4, 2), 5);
    EXPECT_TRUE(std::isnan(vectors->grid.point_fields.at(0).values.at(2, 1)));
}

TEST_P(EnsightUndefined, PartialValuesAreNaNElsewhere) {
    const auto read_list = [&](const std::vector<std::int32_t>& list) {
        return read_values("scalar per node", [&](GoldText& file) {
            file.line("coordinates partial").integers({static_cast<std::int32_t>(list.size())}).integers(list);
            file.floats(std::vector<float>(list.size(), 4));
            file.line("part").integers({2}).line("coordinates").floats({6, 7, 8, 9, 10});
        });
    };
    const auto result = read_list({2, 5});
    ASSERT_TRUE(result) << result.error().message;
    const Array& values = result->grid.point_fields.at(0).values;
    for (const std::size_t i : {0u, 2u, 3u}) EXPECT_TRUE(std::isnan(values.at(i))) << i;
    for (const std::size_t i : {1u, 4u}) EXPECT_EQ(values.at(i), 4) << i;
    EXPECT_EQ(values.at(9), 10);
    for (const std::int32_t node : {0, 6, -1, 2'000'000'000}) {
        const auto wrong = message_of(read_list({2, node}));
        EXPECT_NE(wrong.find("x: "), std::string::npos) << node << ": " << wrong;
    }
}

TEST_P(EnsightUndefined, ValuesAreErrorsWhereverTheFileIsCut) {
    GoldText values(GetParam());
    values.line("values").line("part").integers({1}).line("coordinates undef").floats({-9}).floats({1, 2, 3, 4, 5});
    values.line("part").integers({2});
    values.line("coordinates partial").integers({2}).integers({1, 3}).floats({6, 7});
    EnsightFolder all = files("scalar per node", values.text());
    const std::size_t second =
        all["x"].find("part", all["x"].find("part") + 1) - (GetParam() == GoldForm::fortran ? 4 : 0);
    for (std::size_t length = 1; length < all["x"].size(); ++length) {
        if (length == second) continue; // a whole file that has no values of the second part
        EnsightFolder cut = all;
        cut["x"].resize(length);
        for (const auto& [name, content] : cut) folder_.write(name, content);
        const auto checked = check_case(folder_.file("a.case"), 0);
        EXPECT_FALSE(checked) << length;
    }
}

std::string name_of_gold_form(const testing::TestParamInfo<GoldForm>& form) {
    constexpr const char* names[] = {"Ascii", "C", "CSwapped", "Fortran"};
    return names[static_cast<std::size_t>(form.param)];
}

INSTANTIATE_TEST_SUITE_P(Forms, EnsightUndefined,
                         testing::Values(GoldForm::ascii, GoldForm::c, GoldForm::c_swapped, GoldForm::fortran),
                         name_of_gold_form);

} // namespace
} // namespace isotet::test
