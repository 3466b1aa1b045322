// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is done when packing was chosen, but finds too little memory.
#include <gtest/gtest.h>

#include "chosen_way.hpp"

namespace isotet::cli {
namespace {

const Error refusal{ErrorCode::out_of_memory, "packing the grid needs 2 GB, but 1 GB is free"};

ChosenWay packing_chosen(bool brute_fits) {
    ChosenWay choice;
    choice.why = "auto: 9 surfaces";
    choice.forecasts = {{.way = Way::clusters, .seconds = 1, .bytes = 100, .fits = true},
                        {.way = Way::brute, .seconds = 9, .bytes = 10, .fits = brute_fits}};
    return choice;
}

TEST(ChosenWay, FallsBackToBruteWherePackingIsRefusedForMemory) {
    ChosenWay choice = packing_chosen(true);
    EXPECT_TRUE(choice.takes_brute_instead(refusal));
    EXPECT_TRUE(choice.brute());
    EXPECT_EQ(choice.why, "auto: 9 surfaces, but packing found too little memory");
    ASSERT_NE(choice.forecast(), nullptr);
    EXPECT_EQ(choice.forecast()->seconds, 9);
    EXPECT_FALSE(choice.takes_brute_instead(refusal)) << "brute itself was refused";
}

TEST(ChosenWay, StaysWhereBruteWouldNotHelp) {
    ChosenWay choice = packing_chosen(false);
    EXPECT_FALSE(choice.takes_brute_instead(refusal)) << "brute does not fit";
    choice = packing_chosen(true);
    EXPECT_FALSE(choice.takes_brute_instead({ErrorCode::cancelled, "interrupted"}));
    choice.forecasts.pop_back();
    EXPECT_FALSE(choice.takes_brute_instead(refusal)) << "brute was not open: --method clusters";
    EXPECT_EQ(choice.way, Way::clusters);
    EXPECT_EQ(choice.why, "auto: 9 surfaces");
}

} // namespace
} // namespace isotet::cli
