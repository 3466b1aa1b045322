// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The slot by itself: what is taken, what is dropped, what is cancelled. Time is what the test says.
#include <gtest/gtest.h>

#include <random>

#include "view/server/slot.hpp"

namespace isotet::test {
namespace {

using view::Slot;
using End = Slot<int>::End;

TEST(Slot, GivesTheNewestOfABurstAndNothingElse) {
    Slot<int> slot;
    for (int wish = 1; wish <= 100; ++wish) slot.put(wish);
    EXPECT_EQ(slot.take(0), 100);
    slot.finish(End::frame);
    EXPECT_EQ(slot.take(1), std::nullopt);
}

TEST(Slot, GivesNothingWhileWorkGoesOn) {
    Slot<int> slot;
    slot.put(1);
    EXPECT_EQ(slot.take(0), 1);
    slot.put(2);
    EXPECT_EQ(slot.take(0), std::nullopt);
    slot.finish(End::frame);
    EXPECT_EQ(slot.take(0), 2);
}

TEST(Slot, BeginsNothingWithTwoFramesOnTheWay) {
    Slot<int> slot;
    for (int frame = 1; frame <= 2; ++frame) {
        slot.put(frame);
        EXPECT_EQ(slot.take(0), frame);
        slot.finish(End::frame);
    }
    slot.put(3);
    EXPECT_EQ(slot.take(0), std::nullopt);
    slot.put(4);
    slot.acknowledge();
    EXPECT_EQ(slot.take(0), 4);
}

TEST(Slot, CountsNoAcknowledgementsInAdvance) {
    Slot<int> slot;
    for (int i = 0; i < 10; ++i) slot.acknowledge();
    for (int frame = 1; frame <= 2; ++frame) {
        slot.put(frame);
        EXPECT_TRUE(slot.take(0));
        slot.finish(End::frame);
    }
    slot.put(3);
    EXPECT_FALSE(slot.take(0));
}

TEST(Slot, RefusalsAreNotOnTheWay) {
    Slot<int> slot;
    for (int wish = 1; wish <= 5; ++wish) {
        slot.put(wish);
        EXPECT_EQ(slot.take(0), wish);
        slot.finish(End::nothing);
    }
    EXPECT_EQ(slot.on_the_way(), 0U);
}

TEST(Slot, CancelsOnlyWorkThatIsLongAndHasASuccessor) {
    Slot<int> slot({.max_on_the_way = 2, .patience = 0.1, .max_cancelled = 2});
    slot.put(1);
    ASSERT_TRUE(slot.take(10));
    EXPECT_FALSE(slot.is_stale(20)) << "nothing newer waits";
    slot.put(2);
    EXPECT_FALSE(slot.is_stale(10.05)) << "it has hardly begun";
    EXPECT_TRUE(slot.is_stale(10.2));
    slot.finish(End::cancelled);
    EXPECT_FALSE(slot.is_stale(30)) << "nothing is going on";
}

TEST(Slot, LetsTheThirdInARowEnd) {
    Slot<int> slot({.max_on_the_way = 2, .patience = 0.1, .max_cancelled = 2});
    double now = 0;
    int cancelled = 0;
    for (int wish = 0; wish < 3; ++wish) {
        slot.put(wish);
        ASSERT_TRUE(slot.take(now));
        slot.put(wish + 1);
        now += 1;
        if (!slot.is_stale(now)) break;
        slot.finish(End::cancelled);
        ++cancelled;
    }
    EXPECT_EQ(cancelled, 2);
    slot.finish(End::frame);
    ASSERT_TRUE(slot.take(now));
    slot.put(9);
    EXPECT_TRUE(slot.is_stale(now + 1)) << "after a frame the count begins anew";
}

/// An engine that takes a random time, a hand that moves at random, a page that acknowledges late.
TEST(Slot, TheLastFrameAnswersTheLastWishWhateverTheTiming) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto part = [&] { return std::uniform_real_distribution(0.0, 1.0)(random); };
        Slot<int> slot;
        double now = 0, ends = 0;
        int wish = 0, working_on = 0, shown = 0, begun = 0, in_a_row = 0;
        const auto advance = [&] {
            if (slot.is_working() && slot.is_stale(now)) {
                slot.finish(End::cancelled);
                ASSERT_LE(++in_a_row, 2);
            } else if (slot.is_working() && now >= ends) {
                slot.finish(End::frame);
                ASSERT_GT(working_on, shown) << "an older wish after a newer one";
                shown = working_on;
                in_a_row = 0;
            }
            ASSERT_LE(slot.on_the_way(), 2U);
            if (const auto next = slot.take(now)) {
                working_on = *next;
                ends = now + 0.4 * part();
                ++begun;
            }
            if (slot.on_the_way() > 0 && part() < 0.4) slot.acknowledge();
        };
        for (int move = 0; move < 200; ++move, now += 0.016) {
            slot.put(++wish);
            advance();
        }
        for (int quiet = 0; quiet < 300; ++quiet, now += 0.016) advance();
        EXPECT_EQ(shown, wish);
        EXPECT_LE(begun, wish);
    }
}

} // namespace
} // namespace isotet::test
