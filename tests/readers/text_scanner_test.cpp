// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/text_scanner.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace isotet::test {
namespace {

using io::parse_number;
using io::TextScanner;

constexpr double infinity = std::numeric_limits<double>::infinity();

double number(std::string_view word) {
    double value = -12345;
    EXPECT_TRUE(parse_number(word, value)) << word;
    return value;
}

TEST(TextScannerNumbers, AreTheNearestDoubles) {
    EXPECT_EQ(number("0.1"), 0.1);
    EXPECT_EQ(number("-1.7976931348623157e308"), -std::numeric_limits<double>::max());
    EXPECT_EQ(number("4.9e-324"), std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(number("12"), 12);
    EXPECT_EQ(number(".5"), 0.5);
    EXPECT_EQ(number("5."), 5);
    EXPECT_TRUE(std::signbit(number("-0")));
}

TEST(TextScannerNumbers, MayBeWrittenAsFortranDoes) {
    EXPECT_EQ(number("+5"), 5);
    EXPECT_EQ(number("1.0D+05"), 1e5);
    EXPECT_EQ(number("1.0d5"), 1e5);
    EXPECT_EQ(number("-1.5E-03"), -1.5e-3);
    EXPECT_EQ(number("1.234-105"), 1.234e-105);
    EXPECT_EQ(number("1.234+105"), 1.234e105);
}

TEST(TextScannerNumbers, MayBeInfiniteOrNaN) {
    EXPECT_TRUE(std::isnan(number("nan")));
    EXPECT_TRUE(std::isnan(number("-NaN")));
    EXPECT_EQ(number("inf"), infinity);
    EXPECT_EQ(number("-Infinity"), -infinity);
}

TEST(TextScannerNumbers, ThatAreTooLargeOrSmallBecomeInfiniteOrZero) {
    EXPECT_EQ(number("1e400"), infinity);
    EXPECT_EQ(number("-1e400"), -infinity);
    EXPECT_EQ(number("1e-400"), 0);
    EXPECT_EQ(number("1" + std::string(400, '0')), infinity);
    EXPECT_EQ(number("0." + std::string(400, '0') + "1"), 0);
    EXPECT_EQ(number("0." + std::string(400, '0') + "1e800"), infinity);
    EXPECT_EQ(number("1e99999999999999999999"), infinity);
    EXPECT_EQ(number("1e-99999999999999999999"), 0);
}

TEST(TextScannerNumbers, AreRefusedWhenSomethingFollows) {
    double value = 0;
    for (const char* word : {"1.5x", "1,5", "", "-", "+", "+-1", "--1", "1e", "0x10", "1.0D", "e5", "1..2"}) {
        EXPECT_FALSE(parse_number(word, value)) << word;
    }
    std::int32_t integer = 0;
    for (const char* word : {"1.0", "1e3", "2147483648", "+-1", "+", "- 1"})
        EXPECT_FALSE(parse_number(word, integer)) << word;
    EXPECT_TRUE(parse_number("+2147483647", integer));
    EXPECT_EQ(integer, 2147483647);
}

TEST(TextScanner, StaysOnTheWordThatIsNoNumber) {
    TextScanner scanner("  12 word");
    double value = 0;
    EXPECT_TRUE(scanner.number(value));
    EXPECT_FALSE(scanner.number(value));
    EXPECT_EQ(scanner.word(), "word");
    EXPECT_TRUE(scanner.at_end());
}

TEST(TextScanner, PassesOverComments) {
    TextScanner scanner("1 # one 2\n# three\n3#four\n", '#');
    int value = 0;
    EXPECT_TRUE(scanner.number(value));
    EXPECT_TRUE(scanner.at_line_end());
    EXPECT_FALSE(scanner.number_of_line(value));
    EXPECT_TRUE(scanner.number(value));
    EXPECT_EQ(value, 3);
    EXPECT_TRUE(scanner.at_end());
}

TEST(TextScanner, KnowsQuotedWordsAndWholeLines) {
    TextScanner scanner("\"two words\" three\n\n  a whole line \r\nnext");
    EXPECT_EQ(scanner.quoted_of_line(), "two words");
    EXPECT_EQ(scanner.quoted_of_line(), "three");
    EXPECT_EQ(scanner.quoted_of_line(), "");
    EXPECT_EQ(scanner.line(), "a whole line");
    EXPECT_EQ(scanner.line(), "next");
}

TEST(TextScanner, TellsWhereItStands) {
    TextScanner scanner("a\nb c\x01\xff");
    EXPECT_EQ(scanner.where(), "line 1 ('a')");
    scanner.next_line();
    scanner.word();
    scanner.at_line_end();
    EXPECT_EQ(scanner.where(), "line 2 ('c\\x01\\xff')");
    scanner.word();
    EXPECT_EQ(scanner.where(), "line 2 (the end)");
}

TEST(TextInQuotes, IsAsItIsButForWhatTerminalsObey) {
    EXPECT_EQ(io::in_quotes("d\xc3\xa9"
                            "bit \xe2\x88\x86p"),
              "'d\xc3\xa9"
              "bit \xe2\x88\x86p'");
    EXPECT_EQ(io::in_quotes("a\n\x1b[1m\x7f\xc2\x9b\xe9"), "'a\\x0a\\x1b[1m\\x7f\\xc2\\x9b\\xe9'");
    std::string many;
    for (int i = 0; i < 41; ++i) many += "\xc3\xa9";
    EXPECT_EQ(io::in_quotes(many), "'" + many.substr(0, 80) + "...'");
}

} // namespace
} // namespace isotet::test
