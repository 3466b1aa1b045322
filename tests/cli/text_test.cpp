// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Text for terminals and JSON.
#include <gtest/gtest.h>

#include <isotet/text.hpp>

#include "output/text.hpp"

namespace isotet::cli {
namespace {

TEST(Printable, EscapesControlCharactersAndWhatIsNotUtf8) {
    EXPECT_EQ(printable("plain caf\xC3\xA9"), "plain caf\xC3\xA9");
    EXPECT_EQ(printable("a\x1b[31m\n\t\x7f"), "a\\x1b[31m\\n\\t\\x7f");
    EXPECT_EQ(printable("caf\xE9"), "caf\\xe9");
    EXPECT_EQ(printable("\xC2\x9B"), "\\u{009b}") << "the eight-bit form of ESC [";
    EXPECT_EQ(printable("\xE2\x80\xAE"), "\\u{202e}") << "right-to-left override";
}

TEST(Printable, TakesOverlongFormsSurrogatesAndCutCharactersForBytes) {
    EXPECT_EQ(printable("\xC0\x80"), "\\xc0\\x80");
    EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");
    EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
    EXPECT_EQ(printable("\xE2\x82"), "\\xe2\\x82");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(ValidUtf8, KeepsDifferentNamesDifferent) {
    EXPECT_EQ(valid_utf8("caf\xC3\xA9\n"), "caf\xC3\xA9\n");
    EXPECT_NE(valid_utf8("caf\xE9"), valid_utf8("caf\xE8"));
}

TEST(Wrapped, BreaksAtSpacesOnly) {
    EXPECT_EQ(wrapped("aa bb cc", 5), "aa bb\ncc");
    EXPECT_EQ(wrapped("aa bb cc", 7, 2), "aa bb\n  cc");
    EXPECT_EQ(wrapped("toolongword a", 4), "toolongword\na");
}

TEST(WithOptions, WritesNamesInBackquotesAsOptions) {
    EXPECT_EQ(with_options("seams; `merge_points` 0 joins them"), "seams; --merge-points 0 joins them");
    EXPECT_EQ(with_options("`snap`, `a_b_c`"), "--snap, --a-b-c");
    for (const char* same : {"", "`", "``", "`merge_points", "`run 1.vtu`", "`A`", "a ` b ` c"})
        EXPECT_EQ(with_options(same), same);
    EXPECT_EQ(with_options("`x y`snap`"), "`x y--snap") << "the first backquote that can begins";
    EXPECT_EQ(with_options("'`foo`+1' ('`q`'): `snap` takes 'it`s's`'"), "'`foo`+1' ('`q`'): --snap takes 'it`s's`'");
    EXPECT_EQ(with_options("the grid's `snap`, points' `keep`, 'open `keep`"),
              "the grid's --snap, points' --keep, 'open --keep")
        << "apostrophes are no quotes";
}

} // namespace
} // namespace isotet::cli
