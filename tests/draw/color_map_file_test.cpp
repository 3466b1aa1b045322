// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colour maps of ParaView, against what VTK 9.7 gives for them.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/scene.hpp>

namespace isotet::test {
namespace {

std::string map_in(const std::string& space, const std::string& more = {}) {
    return R"([{"Name": "some", "ColorSpace": ")" + space +
           R"(", "RGBPoints": [0, 0.23, 0.3, 0.75, 1, 0.7, 0.02, 0.15, 3, 0.9, 0.8, 0.1])" + more + "}]";
}

using Rgb = std::array<double, 3>;

TEST(ColorMapFile, HasTheColoursOfEverySpace) {
    const std::array<double, 5> values{0.25, 0.5, 0.6, 1.7, 2.2};
    const std::vector<std::pair<const char*, std::array<Rgb, 5>>> expected{
        {"RGB",
         {{{0.3475, 0.23, 0.6},
           {0.465, 0.16, 0.45},
           {0.512, 0.132, 0.39},
           {0.77, 0.293, 0.1325},
           {0.82, 0.488, 0.12}}}},
        {"HSV",
         {{{0.3725, 0.1749, 0.7375},
           {0.6267, 0.1215, 0.725},
           {0.72, 0.1007, 0.7005},
           {0.1037, 0.0442, 0.77},
           {0.064, 0.82, 0.7055}}}},
        {"Lab",
         {{{0.4636, 0.2549, 0.5931},
           {0.5765, 0.2043, 0.4419},
           {0.6088, 0.1812, 0.383},
           {0.7851, 0.3808, 0.1559},
           {0.8362, 0.5467, 0.1485}}}},
        {"Diverging",
         {{{0.5447, 0.6886, 0.9918},
           {0.8654, 0.8654, 0.8654},
           {0.9446, 0.7945, 0.7143},
           {1.0, 0.8585, 0.659},
           {1.0, 0.961, 0.8472}}}},
        {"Step", {{{0.7, 0.02, 0.15}, {0.7, 0.02, 0.15}, {0.7, 0.02, 0.15}, {0.9, 0.8, 0.1}, {0.9, 0.8, 0.1}}}}};
    for (const auto& [space, colors] : expected) {
        const ColorMapFile map = parse_color_map_file(map_in(space)).value();
        EXPECT_EQ(map.name, "some");
        EXPECT_EQ(map.range.upper, 3);
        EXPECT_TRUE(map.opacity.points.empty());
        ColorScale scale;
        scale.colors = map.colors;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Color color = scale.color_at(values[i] / 3);
            EXPECT_NEAR(color.red, colors[i][0], 3e-3) << space << values[i];
            EXPECT_NEAR(color.green, colors[i][1], 3e-3) << space << values[i];
            EXPECT_NEAR(color.blue, colors[i][2], 3e-3) << space << values[i];
        }
    }
    EXPECT_TRUE(parse_color_map_file(map_in("LabCIEDE2000")));
    const ColorMapFile wrapped = parse_color_map_file(map_in("HSV", R"(, "HSVWrap": 1)")).value();
    EXPECT_GT(wrapped.colors[1023 / 6].red, 0.5) << "from blue over magenta to red";
    EXPECT_EQ(parse_color_map_file(map_in("RGB", R"(, "NanColor": [1, 0, 0])")).value().no_data->red, 1);
}

TEST(ColorMapFile, HasTheOpacityWithMidpointsAndSharpness) {
    const std::string points =
        R"({"Points": [0, 0, 0.5, 0, 1, 0.8, 0.3, 0, 2, 0.2, 0.5, 0.4, 3, 1, 0.7, 1, 4, 0.1, 0.5, 0]})";
    const OpacityCurve curve = parse_color_map_file(points).value().opacity;
    const std::array<double, 33> expected{0,       0.1,    0.2,     0.3,     0.4,     0.5,     0.6,     0.7, 0.8,
                                          0.675,   0.55,   0.46786, 0.41429, 0.36071, 0.30714, 0.25357, 0.2, 0.20023,
                                          0.20773, 0.2694, 0.6,     0.9306,  0.99227, 0.99977, 1,       1,   1,
                                          1,       1,      1,       0.1,     0.1,     0.1};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(curve.at(static_cast<double>(i) / 8), expected[i], i > 27 ? 1e-9 : 2e-3) << i;
    EXPECT_TRUE(curve.check());
    EXPECT_EQ(parse_opacity_file(points).value().curve.points, curve.points);
}

TEST(ColorMapFile, OpacityMayBeTheTextOfAnOption) {
    const std::vector<OpacityPoint> expected{{0, 0}, {300, 0.02}, {400, 0.5}};
    for (const char* text :
         {"0:0,300:0.02,400:0.5", "0:0\n300:0.02\r\n 400:0.5 \n", "# points\n0:0, # first\n300:0.02 400:0.5"})
        EXPECT_EQ(parse_opacity_file(text).value().curve.points, expected) << text;
    EXPECT_EQ(parse_opacity_file(" peaks:4\n").value().peaks, 4u);
    EXPECT_FALSE(parse_opacity_file("# nothing"));
    EXPECT_FALSE(parse_opacity_file("0:0,1"));
}

TEST(ColorMapFile, TellsWhatIsWrong) {
    const auto message = [](const std::string& text, const char* name = "") {
        const Result<ColorMapFile> map = parse_color_map_file(text, name);
        return map ? std::string() : map.error().message;
    };
    const auto says = [&](const std::string& text, const char* what) {
        EXPECT_NE(message(text).find(what), std::string::npos) << text << ": " << message(text);
    };
    says("", "not JSON");
    says("<ColorMaps/>", "not JSON");
    says("3", "not a list of colour maps");
    says("[]", "not a list of colour maps");
    says("[3]", "not a list of colour maps");
    says(R"({"Name": "n"})", "neither RGBPoints nor Points");
    says(R"({"Name": "n", "IndexedColors": [0, 0, 1]})", "colours of categories");
    says(R"({"RGBPoints": [0, 1, 1]})", "RGBPoints is not a list of four numbers a point");
    says(R"({"RGBPoints": [0, 1, 1, "x"]})", "RGBPoints is not a list of four numbers a point");
    says(R"({"RGBPoints": {"a": 1}})", "RGBPoints is not a list of four numbers a point");
    says(R"({"RGBPoints": [0, 1, 1, 1]})", "of one value only");
    says(R"({"RGBPoints": [1, 1, 1, 1, 1, 0, 0, 0]})", "of one value only");
    says(R"({"RGBPoints": [0, 1, 1, 1, -1, 0, 0, 0]})",
         "point 2 of its RGBPoints is at -1, but values must be finite and ascend");
    says(R"({"RGBPoints": [0, 1, 1, 1, 1, 0, 2, 0]})",
         "point 2 of its RGBPoints has 2, but must have numbers from 0 to 1");
    says(R"({"Points": [0, 1, 0.5, 0, 1, -1, 0.5, 0]})", "point 2 of its Points has -1");
    says(R"({"ColorSpace": "CMYK", "RGBPoints": [0, 1, 1, 1, 1, 0, 0, 0]})", "in the space 'CMYK', but RGB, HSV, Lab");
    says(R"([{"Name": "a"}, {"Name": "b"}])", "2 colour maps, and one must be named: 'a', 'b'");
    EXPECT_NE(message(map_in("RGB"), "other").find("no colour map 'other', but 'some'"), std::string::npos);
    EXPECT_EQ(message(map_in("RGB"), "some"), "");
    EXPECT_NE(parse_opacity_file(map_in("RGB")).error().message.find("no Points of opacity"), std::string::npos);
}

} // namespace
} // namespace isotet::test
