// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The seeds of a random test. A failure prints the seed and the command that runs just that case again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace isotet::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_watched = true;
#elif defined(__has_feature) // clang 19
inline constexpr bool is_watched = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool is_watched = false;
#endif

/// A sixth of the seeds where every access is watched.
inline constexpr std::uint32_t seed_share = is_watched ? 6 : 1;

/// All cases; where every access is watched, every `seed_share`th, from the first on.
template <class Case>
std::vector<Case> some_of(std::initializer_list<Case> cases) {
    std::vector<Case> some;
    for (std::size_t i = 0; i < cases.size(); i += seed_share) some.push_back(cases.begin()[i]);
    return some;
}

/// `for (const std::uint32_t seed : Seeds(first, count))`. The variable ISOTET_SEED asks for one seed alone.
class Seeds {
public:
    Seeds(std::uint32_t first, std::uint32_t count)
        : first_(first), last_(first + (count + seed_share - 1) / seed_share) {
        if (const char* wanted = std::getenv("ISOTET_SEED")) {
            first_ = static_cast<std::uint32_t>(std::strtoul(wanted, nullptr, 10));
            last_ = first_ + 1;
        }
    }

    class Iterator {
    public:
        Iterator(Seeds& seeds, std::uint32_t seed) : seeds_(&seeds), seed_(seed) {}
        std::uint32_t operator*() const { return seeds_->announce(seed_); }
        Iterator& operator++() {
            ++seed_;
            return *this;
        }
        friend bool operator==(const Iterator& a, const Iterator& b) { return a.seed_ == b.seed_; }

    private:
        Seeds* seeds_;
        std::uint32_t seed_;
    };
    Iterator begin() { return {*this, first_}; }
    Iterator end() { return {*this, last_}; }

private:
    std::uint32_t announce(std::uint32_t seed) {
        const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
        trace_.reset();
        trace_.emplace(__FILE__, __LINE__,
                       "seed " + std::to_string(seed) + "; again: ISOTET_SEED=" + std::to_string(seed) +
                           " <test program> --gtest_filter='" + test.test_suite_name() + "." + test.name() + "'");
        return seed;
    }

    std::uint32_t first_, last_;
    std::optional<testing::ScopedTrace> trace_;
};

} // namespace isotet::test
