// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Results of CalculiX, as its version 2.20 writes them, in all forms, and broken.
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/frd/read_frd.hpp"

namespace isotet::test {
namespace {

using FrdPlace = std::array<double, 3>;

enum class FrdForm : char { short_text = '0', long_text = '1', binary_float = '2', binary_double = '3' };

/// Blocks of a file, one after another.
class FrdText {
public:
    explicit FrdText(FrdForm form) : form_(form) {
        text_ = "    1C\n    1UUSER\n    1UPGM               CalculiX\n";
    }

    static int number_of(std::size_t node) { return 5 + 7 * static_cast<int>(node); }

    FrdText& nodes(const std::vector<FrdPlace>& places) {
        header("    2C", places.size());
        for (std::size_t i = 0; i < places.size(); ++i)
            record(number_of(i), std::vector<double>(places[i].begin(), places[i].end()));
        return end();
    }
    FrdText& begin_elements(std::size_t count) {
        header("    3C", count);
        return *this;
    }
    FrdText& element(int number, int type, const std::vector<int>& nodes) {
        if (is_binary()) {
            for (const int value : {number, type, 0, 1}) put(value);
            for (const int node : nodes) put(node);
            return *this;
        }
        const std::size_t width = form_ == FrdForm::short_text ? 5 : 10, on_line = form_ == FrdForm::short_text ? 15 : 10;
        text_ += fmt::format(" -1{:{}}{:5}{:5}{:5}", number, width, type, 0, 1);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            text_ += fmt::format("{}{:{}}", i % on_line == 0 ? "\n -2" : "", nodes[i], width);
        text_ += '\n';
        return *this;
    }
    FrdText& begin_values(int step, double value, std::size_t nodes, const std::string& name,
                          const std::vector<std::string>& components) {
        text_ += fmt::format("    1PSTEP{:26}{:12}{:12}\n", step, 1, 1);
        text_ += fmt::format("  100CL  101{:<12.10g}{:12}{:20}{:2}{:5}{:10}{:2}\n", value, nodes, "", 0, step, "",
                             static_cast<char>(form_));
        text_ += fmt::format(" -4  {:8}{:5}    1\n", name, components.size() + 1);
        for (const std::string& component : components) text_ += fmt::format(" -5  {:8}    1    2    1    0\n", component);
        text_ += " -5  ALL         1    2    0    0    1ALL\n";
        return *this;
    }
    FrdText& record(int number, const std::vector<double>& values) {
        if (is_binary()) {
            put(number);
            for (const double value : values) {
                if (form_ == FrdForm::binary_double) put(value);
                else put(static_cast<float>(value));
            }
            return *this;
        }
        const std::size_t width = form_ == FrdForm::short_text ? 5 : 10;
        text_ += fmt::format(" -1{:{}}", number, width);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i > 0 && i % 6 == 0) text_ += fmt::format("\n -2{:{}}", "", width);
            text_ += fmt::format("{:12.5E}", values[i]);
        }
        text_ += '\n';
        return *this;
    }
    FrdText& end() {
        if (!is_binary()) text_ += " -3\n";
        return *this;
    }
    std::string text() const { return text_ + " 9999\n"; }

private:
    bool is_binary() const { return form_ == FrdForm::binary_float || form_ == FrdForm::binary_double; }
    void header(const char* key, std::size_t count) {
        text_ += fmt::format("{}{:18}{:12}{:37}{}\n", key, "", count, "", static_cast<char>(form_));
    }
    template <class Number>
    void put(Number value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        text_.append(bytes, sizeof value);
    }

    FrdForm form_;
    std::string text_;
};

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

const std::vector<FrdPlace> hexahedron{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<FrdPlace> wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
const Pairs hexahedron_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
const Pairs wedge_edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4}, {2, 5}, {3, 4}, {4, 5}, {5, 3}};
const Pairs hexahedron_edges_of_vtk{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                    {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
const Pairs wedge_edges_of_vtk{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};

std::vector<FrdPlace> with_middles(std::vector<FrdPlace> corners, const Pairs& edges) {
    for (const auto& [a, b] : edges) {
        FrdPlace middle{};
        for (std::size_t k = 0; k < 3; ++k) middle[k] = (corners[a][k] + corners[b][k]) / 2;
        corners.push_back(middle);
    }
    return corners;
}

std::vector<int> numbers(std::size_t count) {
    std::vector<int> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(FrdText::number_of(i));
    return all;
}

constexpr std::array forms{FrdForm::short_text, FrdForm::long_text, FrdForm::binary_float, FrdForm::binary_double};

TEST(ReadFrd, HasMiddleNodesWhereVtkPutsThem) {
    struct Cell {
        int type;
        std::uint8_t vtk_type;
        const std::vector<FrdPlace>& corners;
        const Pairs &edges, &edges_of_vtk;
    };
    for (const FrdForm form : forms)
        for (const Cell& cell : {Cell{4, 25, hexahedron, hexahedron_edges, hexahedron_edges_of_vtk},
                                 Cell{5, 26, wedge, wedge_edges, wedge_edges_of_vtk}}) {
            const std::vector<FrdPlace> places = with_middles(cell.corners, cell.edges);
            FrdText file(form);
            file.nodes(places).begin_elements(1).element(3, cell.type, numbers(places.size())).end();
            const auto result = io::parse_frd(file.text(), {}, {});
            ASSERT_TRUE(result) << result.error().message;
            const Cells& cells = result->grid.cells;
            ASSERT_EQ(cells.types.at(0), cell.vtk_type);
            const std::vector<FrdPlace> expected = with_middles(cell.corners, cell.edges_of_vtk);
            for (std::size_t i = 0; i < expected.size(); ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_EQ(result->grid.points.at(static_cast<std::size_t>(cells.connectivity.at(i)), k), expected[i][k])
                        << static_cast<char>(form) << " node " << i;
        }
}

/// A tetrahedron and a shell, two steps at one time, the second without one node.
std::string steps(FrdForm form) {
    FrdText file(form);
    file.nodes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    file.begin_elements(2).element(1, 3, numbers(4)).element(2, 7, numbers(3)).end();
    for (const int step : {1, 2}) {
        const double s = step;
        file.begin_values(step, 0.5, 4, "DISP", {"D1", "D2", "D3"});
        for (int i = 0; i < 4; ++i) file.record(FrdText::number_of(static_cast<std::size_t>(i)), {-s, -2.5 * i, -3});
        file.end().begin_values(step, 0.5, step == 1 ? 4 : 3, "HFL", {"F1", "F2", "F3", "F4", "F5", "F6", "F7"});
        for (int i = 0; i < (step == 1 ? 4 : 3); ++i)
            file.record(FrdText::number_of(static_cast<std::size_t>(i)), {1, 2, 3, 4, 5, 6, 7. + i});
        file.end();
    }
    return file.text();
}

TEST(ReadFrd, GivesTheFieldsOfAStepWithoutMagnitudes) {
    for (const FrdForm form : forms) {
        SCOPED_TRACE(static_cast<char>(form));
        ReadOptions options;
        options.step = 1;
        const auto result = io::parse_frd(steps(form), options, {});
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->info.times, (std::vector<double>{0.5, 0.5})) << "modes of one frequency are two steps";
        ASSERT_EQ(result->grid.point_fields.size(), 2u);
        const Field& displacement = result->grid.point_fields[0];
        EXPECT_EQ(displacement.name, "DISP");
        ASSERT_EQ(displacement.values.components(), 3u);
        EXPECT_EQ(displacement.values.at(3, 0), -2);
        EXPECT_EQ(displacement.values.at(3, 1), -7.5) << "numbers that touch are told apart by their columns";
        const Field& seven = result->grid.point_fields[1];
        ASSERT_EQ(seven.values.components(), 7u);
        EXPECT_EQ(seven.values.at(2, 6), 9) << "from the second line";
        EXPECT_TRUE(std::isnan(seven.values.at(3, 6))) << "the block has no such node";
        EXPECT_EQ(result->grid.cells.types.at(1), 5) << "shells are triangles, and left out";
        const auto info = io::inspect_frd(steps(form), {});
        ASSERT_TRUE(info);
        EXPECT_EQ(info->fields.size(), 2u);
    }
}

TEST(ReadFrd, GivesComponentsWithNamesAsFields) {
    for (const FrdForm form : forms) {
        SCOPED_TRACE(static_cast<char>(form));
        FrdText file(form);
        file.nodes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).begin_elements(1).element(1, 3, numbers(4)).end();
        const auto add = [&](const std::string& name, const std::vector<std::string>& components) {
            file.begin_values(1, 1, 4, name, components);
            for (int i = 0; i < 4; ++i) {
                std::vector<double> values;
                for (std::size_t c = 0; c < components.size(); ++c) values.push_back(10. * i + static_cast<double>(c));
                file.record(FrdText::number_of(static_cast<std::size_t>(i)), values);
            }
            file.end();
        };
        add("CONTACT", {"COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"});
        add("STRESS", {"SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"});
        add("MOVED", {"D1", "D2", "D3", "R1", "R2"});
        add("PAIR", {"RE", "IM"});
        add("SAME", {"A", "A", "B", "C"});
        const auto info = io::inspect_frd(file.text(), {});
        ASSERT_TRUE(info) << info.error().message;
        std::string found;
        for (const FieldInfo& field : info->fields) found += fmt::format(" {} {}", field.name, field.components);
        EXPECT_EQ(found, " CONTACT:COPEN 1 CONTACT:CSLIP1 1 CONTACT:CSLIP2 1 CONTACT:CPRESS 1 CONTACT:CSHEAR1 1 "
                         "CONTACT:CSHEAR2 1 STRESS 6 MOVED 3 MOVED:R1 1 MOVED:R2 1 PAIR:RE 1 PAIR:IM 1 SAME 4");
        ReadOptions options;
        options.point_fields = {{"CONTACT:CPRESS", "MOVED", "MOVED:R2"}};
        const auto result = io::parse_frd(file.text(), options, {});
        ASSERT_TRUE(result) << result.error().message;
        const std::vector<Field>& fields = result->grid.point_fields;
        ASSERT_EQ(fields.size(), 3u) << "nothing else is kept";
        EXPECT_EQ(fields[0].name, "CONTACT:CPRESS");
        EXPECT_EQ(fields[0].values.components(), 1u);
        EXPECT_EQ(fields[0].values.at(2), 23);
        EXPECT_EQ(fields[1].values.at(2, 1), 21);
        EXPECT_EQ(fields[2].values.at(3), 34);
    }
}

TEST(ReadFrd, IsAnErrorOrSaysWhatIsMissingWhereverItIsCut) {
    for (const FrdForm form : forms) {
        const std::string whole = steps(form);
        const std::size_t mesh = whole.find("    1PSTEP"), last = whole.rfind(" 9999");
        for (std::size_t length = 0; length < last; length += 3) {
            const auto result = io::parse_frd(std::string_view(whole).substr(0, length), {}, {});
            if (length + 3 < mesh) {
                EXPECT_FALSE(result) << static_cast<char>(form) << " cut to " << length;
            }
            if (!result) continue;
            EXPECT_EQ(result->grid.points.tuples(), 4u);
            for (const Field& field : result->grid.point_fields) EXPECT_EQ(field.values.tuples(), 4u);
        }
    }
}

TEST(ReadFrd, SaysWhatStandsBehindABrokenLine) {
    const std::string whole = steps(FrdForm::long_text);
    const auto sound = io::parse_frd(whole, {}, {});
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_TRUE(sound->info.left_out.empty());
    std::string without_end = whole; // of the first field: the blocks behind are still read
    without_end.erase(whole.find(" -3\n", whole.find("  100CL")), 4);
    const auto ended = io::parse_frd(without_end, {}, {});
    ASSERT_TRUE(ended) << ended.error().message;
    EXPECT_EQ(ended->info.times, sound->info.times);
    EXPECT_EQ(ended->info.fields.size(), sound->info.fields.size());
    std::string broken_head = whole;
    broken_head.replace(whole.find("  100CL"), 7, "  x00CL");
    const auto headless = io::parse_frd(broken_head, {}, {});
    ASSERT_TRUE(headless) << headless.error().message;
    ASSERT_EQ(headless->info.left_out.size(), 1u);
    EXPECT_NE(headless->info.left_out[0].reason.find(fmt::format("the first at byte {}", whole.find("  100CL"))),
              std::string::npos)
        << headless->info.left_out[0].reason;
    std::string long_block = steps(FrdForm::binary_float);
    long_block.replace(long_block.find("  100CL") + 24, 12, fmt::format("{:12}", 99999999));
    const auto cut = io::parse_frd(long_block, {}, {});
    ASSERT_TRUE(cut) << cut.error().message;
    EXPECT_NE(cut->info.left_out.back().reason.find("announces more values than are left"), std::string::npos);
}

TEST(ReadFrd, BrokenMeshesAreErrorsAndBrokenFieldsAreLeftOut) {
    const std::string whole = steps(FrdForm::long_text);
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = whole;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    const auto expect_error = [](const std::string& text, const std::string& part) {
        const auto result = io::parse_frd(text, {}, {});
        ASSERT_FALSE(result) << part;
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    };
    expect_error(changed(" -2         5        12", " -2         5        13"), "element 1 has node 13, which is not there");
    expect_error(changed(" -1         1    3", " -1         1    4"), "element 1 of type 4 has 4 nodes, but must have 20");
    expect_error(changed("\n -1        12 1", "\n -1         5 1"), "node");
    expect_error(changed(" 1.00000E+00 0.00000E+00 0.00000E+00", " 1.00000E+00 0.0000xE+00 0.00000E+00"), "value 2 of node 12 is no number");
    std::string field = whole;
    field.replace(field.find("-1.00000E+00"), 12, "-1.0000xE+00");
    const auto result = io::parse_frd(field, {}, {});
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_EQ(result->info.left_out[0].name, "DISP");
    EXPECT_NE(result->info.left_out[0].reason.find("value 1 of node 5 is no number"), std::string::npos);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].name, "HFL");
}

TEST(ReadFrd, IsKnownByItsFirstLines) {
    EXPECT_TRUE(io::looks_like_frd(steps(FrdForm::long_text)));
    EXPECT_FALSE(io::looks_like_frd("    1C is a line\nof something else\n"));
    EXPECT_FALSE(io::looks_like_frd("*NODE\n1, 0, 0, 0\n"));
}

} // namespace
} // namespace isotet::test
