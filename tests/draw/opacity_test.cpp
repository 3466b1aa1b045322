// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Opacity as text and by presets.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/scene.hpp>

namespace isotet::test {
namespace {

TEST(Opacity, IsReadFromText) {
    const OpacityText text = parse_opacity("0:0,300:0.02,4e2:0.5").value();
    EXPECT_EQ(text.curve.points, (std::vector<OpacityPoint>{{0, 0}, {300, 0.02}, {400, 0.5}}));
    EXPECT_FALSE(text.preset);
    EXPECT_EQ(parse_opacity("ramp").value().preset, OpacityPreset::ramp);
    EXPECT_EQ(parse_opacity("shell").value().preset, OpacityPreset::shell);
    EXPECT_EQ(parse_opacity("peaks").value().peaks, 0u);
    EXPECT_EQ(parse_opacity("peaks:5").value().peaks, 5u);
}

TEST(Opacity, WrongTextsAreToldWithPlaceAndRule) {
    const auto message = [](const char* text) { return parse_opacity(text).error().message; };
    EXPECT_NE(message("").find("has no points"), std::string::npos);
    EXPECT_NE(message("0:0,300").find("has '300' as point 2"), std::string::npos);
    EXPECT_NE(message("0:0,,3:1").find("has '' as point 2"), std::string::npos);
    EXPECT_NE(message("0:0,1:1,").find("has '' as point 3"), std::string::npos);
    EXPECT_NE(message("0:x").find("has '0:x' as point 1"), std::string::npos);
    EXPECT_NE(message("0:0.5:1").find("as point 1"), std::string::npos);
    EXPECT_NE(message("rampe").find("ramp, peaks"), std::string::npos);
    EXPECT_NE(message("peaks:0").find("has '0' peaks"), std::string::npos);
    EXPECT_NE(message("peaks:x").find("has 'x' peaks"), std::string::npos);
    EXPECT_NE(message("0:0,1:1.5").find("point 2 of the opacity has 1.5, but opacity must be from 0 to 1"),
              std::string::npos);
    EXPECT_NE(message("0:-0.1").find("point 1"), std::string::npos);
    EXPECT_NE(message("0:nan").find("must be from 0 to 1"), std::string::npos);
    EXPECT_NE(message("0:0,nan:1").find("point 2 of the opacity has the value nan"), std::string::npos);
    EXPECT_NE(message("inf:1").find("must be finite"), std::string::npos);
    EXPECT_NE(message("3:0,2:1").find("point 2 of the opacity has the value 2 behind 3"), std::string::npos);
}

TEST(Opacity, IsLinearBetweenPointsAndConstantBeyond) {
    const OpacityCurve curve{{{1, 0.2}, {3, 0.6}, {3, 0.1}, {4, 0.3}}};
    EXPECT_EQ(curve.at(-5), 0.2);
    EXPECT_NEAR(curve.at(2), 0.4, 1e-12);
    EXPECT_EQ(curve.at(3), 0.1) << "a step";
    EXPECT_EQ(curve.at(9), 0.3);
    EXPECT_EQ(OpacityCurve().at(1), 0);
    EXPECT_TRUE((OpacityCurve{{{0, 0}, {1, 0}}}.is_transparent()));
}

TEST(Opacity, PresetsShowSomethingOfEveryRange) {
    const std::vector<double> levels{-1, 0, 0.1}, one{5};
    for (const OpacityPreset preset : {OpacityPreset::ramp, OpacityPreset::peaks, OpacityPreset::shell}) {
        const OpacityCurve curve = opacity_of(preset, {-2, 2}, levels);
        EXPECT_TRUE(curve.check());
        EXPECT_FALSE(curve.is_transparent());
        EXPECT_FALSE(opacity_of(preset, {5, 5}, one).is_transparent()) << "a range of one value";
    }
    const OpacityCurve peaks = opacity_of(OpacityPreset::peaks, {-2, 2}, levels);
    EXPECT_GT(peaks.at(-1), 0.9);
    EXPECT_EQ(peaks.at(-0.5), 0);
    EXPECT_GT(peaks.at(0.1), 0.9);
    EXPECT_EQ(opacity_of(OpacityPreset::shell, {0, 10}).at(0.5), 0);
}

} // namespace
} // namespace isotet::test
