// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The seeds of a random test. A failure prints the seed and the command that runs just that case again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace isotet::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr std::uint32_t seed_share = 6; ///< a sixth of the seeds where every access is watched
#else
inline constexpr std::uint32_t seed_share = 1;
#endif

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
