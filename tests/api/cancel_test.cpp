// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Progress: every long operation can be cancelled before it starts and midway, and tells how far it is.
#include <atomic>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/engines.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using Operation = std::function<std::optional<ErrorCode>(const Progress&)>;

template <class T>
std::optional<ErrorCode> code_of(const Result<T>& result) {
    return result ? std::nullopt : std::optional(result.error().code);
}

/// Every operation of the library on one grid.
class Operations {
public:
    Operations() {
        ExtractOptions options;
        options.edge_ends = true;
        surface_ = extract(packed_, 0.1, options).value().surface;
    }
    std::vector<std::pair<std::string, Operation>> all() {
        return {
            {"survey", [this](const Progress& p) { return code_of(survey(grid_, {}, {.progress = p})); }},
            {"split", [this](const Progress& p) { return code_of(split(grid_, {.progress = p})); }},
            {"pack",
             [this](const Progress& p) { return code_of(pack(grid_, point_field(grid_), {}, {.progress = p})); }},
            {"set_field",
             [this](const Progress& p) { return code_of(packed_.with_field(point_field(grid_), {.progress = p})); }},
            {"extract", [this](const Progress& p) { return code_of(extract(packed_, 0.1, {}, {.progress = p})); }},
            {"extract by reference",
             [this](const Progress& p) {
                 return code_of(extract_on(Engine::reference, packed_, 0.1, {}, {.progress = p}));
             }},
            {"extract_direct",
             [this](const Progress& p) {
                 return code_of(extract_direct(grid_, point_field(grid_), isovalues_, {}, {.progress = p}));
             }},
            {"extract_direct by reference",
             [this](const Progress& p) {
                 return code_of(
                     extract_direct_by_reference(grid_, point_field(grid_), isovalues_, {}, {.progress = p}));
             }},
            {"check", [this](const Progress& p) { return code_of(check(surface_, {}, {.progress = p})); }},
            {"make_grid",
             [](const Progress& p) {
                 MakeOptions options;
                 options.side = 40;
                 return code_of(make_grid(options, {.progress = p}));
             }},
        };
    }

private:
    Grid grid_ = made_grid("mixed", 12, {"gyroid"});
    std::vector<double> isovalues_{0.1, 0.3};
    PackedGrid packed_ = pack(grid_, point_field(grid_)).value();
    Surface surface_;
};

TEST(Cancelling, BeforeTheStartEndsEveryOperation) {
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    Operations operations;
    for (const auto& [name, operation] : operations.all()) EXPECT_EQ(operation(progress), ErrorCode::cancelled) << name;
}

TEST(Progress, WhateverItThrowsIsAnError) {
    struct NoException {};
    Operations operations;
    for (const auto& [name, operation] : operations.all()) {
        for (const int what : {0, 1}) {
            Progress progress;
            progress.report = [&](std::string_view, double) {
                if (what == 0) throw 42;
                throw NoException{};
            };
            const bool is_quiet = name == "split" || name == "set_field";
            EXPECT_EQ(operation(progress), is_quiet ? std::nullopt : std::optional(ErrorCode::internal)) << name;
        }
    }
}

TEST(Cancelling, MidwayEndsPackingAtEveryStep) {
    const Grid grid = made_grid("kuhn", 24, {"gyroid"});
    std::vector<double> fractions;
    Progress listen;
    listen.report = [&](std::string_view, double fraction) { fractions.push_back(fraction); };
    ASSERT_TRUE(pack(grid, point_field(grid), {}, {.progress = listen}));
    ASSERT_GT(fractions.size(), 4u);
    for (const double stop : fractions) {
        if (stop >= 0.9) continue; // nearly done: it may end either way
        std::atomic<bool> cancel{false};
        Progress progress;
        progress.cancel = &cancel;
        progress.report = [&](std::string_view, double fraction) {
            if (fraction >= stop) cancel = true;
        };
        EXPECT_EQ(code_of(pack(grid, point_field(grid), {}, {.progress = progress})), ErrorCode::cancelled) << stop;
    }
}

TEST(Cancelling, MidwayEndsASurveyAtOnce) {
    const Grid grid = made_grid("mixed", 32, {"gyroid"});
    std::vector<double> fractions;
    Progress listen;
    listen.report = [&](std::string_view, double fraction) { fractions.push_back(fraction); };
    ASSERT_TRUE(survey(grid, {}, {1, listen}));
    ASSERT_GT(fractions.size(), 10u);
    for (std::size_t stop = 0; stop + 1 < fractions.size(); stop += 1 + fractions.size() / 10) {
        std::atomic<bool> cancel{false};
        int later = 0;
        Progress progress;
        progress.cancel = &cancel;
        progress.report = [&](std::string_view, double fraction) {
            later += cancel;
            if (fraction >= fractions[stop]) cancel = true;
        };
        EXPECT_EQ(code_of(survey(grid, {}, {1, progress})), ErrorCode::cancelled) << fractions[stop];
        EXPECT_EQ(later, 0) << "work went on after " << fractions[stop];
    }
}

TEST(Progress, RisesFromNothingToOneInEveryOperation) {
    Operations operations;
    for (const auto& [name, operation] : operations.all()) {
        double last = 0;
        std::atomic<int> inside{0};
        bool overlaps = false, falls = false;
        Progress progress;
        progress.report = [&](std::string_view step, double fraction) {
            overlaps |= inside++ != 0;
            falls |= fraction < last || fraction > 1 || step.empty();
            last = fraction;
            --inside;
        };
        EXPECT_EQ(operation(progress), std::nullopt) << name;
        EXPECT_FALSE(overlaps) << name;
        EXPECT_FALSE(falls) << name;
        const bool is_quiet = name == "split" || name == "set_field";
        EXPECT_TRUE(is_quiet || last == 1) << name << " ends at " << last;
    }
}

TEST(Progress, NeverFallsWhenManyThreadsPack) {
    const Grid grid = made_grid("kuhn", 48, {"plane"}); // 11 blocks
    for (int round = 0; round < 4; ++round) {
        double last = 0;
        std::atomic<int> inside{0};
        Progress progress;
        progress.report = [&](std::string_view, double fraction) {
            EXPECT_EQ(inside++, 0);
            EXPECT_GE(fraction, last);
            last = fraction;
            std::this_thread::yield(); // others come to report meanwhile
            --inside;
        };
        ASSERT_TRUE(pack(grid, point_field(grid), {}, {64, progress}));
        EXPECT_EQ(last, 1);
    }
}

} // namespace
} // namespace isotet::test
