// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// "kuhn:64:gyroid,sphere" is understood, and what is not like it is refused.
#include <gtest/gtest.h>

#include <isotet/make.hpp>

namespace {

using namespace isotet;
using Names = std::vector<std::string>;

TEST(ParseMake, TakesShapeSideAndFieldsApart) {
    const MakeOptions options = parse_make("kuhn:64:gyroid,sphere").value();
    EXPECT_EQ(options.shape, "kuhn");
    EXPECT_EQ(options.side, 64u);
    EXPECT_EQ(options.fields, (Names{"gyroid", "sphere"}));
}

TEST(ParseMake, KeepsTheDefaultFieldsWhenNoneAreNamed) {
    EXPECT_EQ(parse_make("mixed:3").value().fields, MakeOptions{}.fields);
}

TEST(ParseMake, RefusesTextOfAnotherForm) {
    for (const char* text : {"", "kuhn", "kuhn:", "kuhn:x", "kuhn:-4", "kuhn: 4", "kuhn:4.5",
                             "kuhn:99999999999999999999", "kuhn:4:sphere:gyroid", "kuhn:0x10"}) {
        const auto options = parse_make(text);
        ASSERT_FALSE(options) << text;
        EXPECT_EQ(options.error().code, ErrorCode::invalid_argument);
    }
}

TEST(ParseMake, LeavesWrongNamesToMakeGrid) {
    const auto options = parse_make("kuhn:4:");
    ASSERT_TRUE(options);
    EXPECT_FALSE(make_grid(*options));
}

} // namespace
