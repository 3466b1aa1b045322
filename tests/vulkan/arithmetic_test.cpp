// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// divide and root of kernels/shared/arithmetic.glsl against the processor's, bit by bit. ISOTET_HARD_DIVISIONS in the
// environment sets how many hard divisions are tried: few millions in a normal run.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "test_shaders.hpp"
#include "vulkan/devices/hard_divisions.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;
using vulkan::Kernel;

constexpr std::uint32_t batch = 1 << 20;
constexpr std::uint64_t workgroup = 128;

std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }

class DeviceArithmetic : public OnDevice {
protected:
    void SetUp() override {
        // The layer's watching of every call is for other tests: here the numbers count.
        vulkan::Settings settings = watched();
        settings.watch.validation = vulkan::Validation::off;
        reopen(settings);
    }

    std::vector<float> divide(std::span<const float> a, std::span<const float> b, int units_off) {
        const Kernel& kernel =
            **context().kernels().get(vulkan::test_shaders::divide, std::array{static_cast<std::uint32_t>(units_off)});
        const Buffer up_a = take(a.size_bytes()), up_b = take(b.size_bytes()), down = take(a.size_bytes());
        context().staging().upload(up_a, 0, std::as_bytes(a)).value();
        context().staging().upload(up_b, 0, std::as_bytes(b)).value();
        struct Push {
            VkDeviceAddress a, b, quotients;
            std::uint32_t count, unused;
        };
        vulkan::Recorder recorder(context());
        recorder.dispatch(
            kernel, Push{up_a.address(), up_b.address(), down.address(), static_cast<std::uint32_t>(a.size()), 0},
            (a.size() + workgroup - 1) / workgroup, {vulkan::reads(up_a), vulkan::reads(up_b), vulkan::writes(down)});
        recorder.run().value();
        std::vector<float> quotients(a.size());
        context().staging().download(down, 0, std::as_writable_bytes(std::span(quotients))).value();
        return quotients;
    }

    std::vector<float> roots(std::uint32_t first_bits, std::uint32_t count, int units_off) {
        const Kernel& kernel =
            **context().kernels().get(vulkan::test_shaders::root, std::array{static_cast<std::uint32_t>(units_off)});
        const Buffer down = take(std::uint64_t{count} * 4);
        struct Push {
            VkDeviceAddress roots;
            std::uint32_t first_bits, count;
        };
        vulkan::Recorder recorder(context());
        recorder.dispatch(kernel, Push{down.address(), first_bits, count}, (count + workgroup - 1) / workgroup,
                          {vulkan::writes(down)});
        recorder.run().value();
        std::vector<float> found(count);
        context().staging().download(down, 0, std::as_writable_bytes(std::span(found))).value();
        return found;
    }

    /// The first case that differs, as text; empty when all agree.
    std::string wrong_division(std::span<const float> a, std::span<const float> b, int units_off) {
        const std::vector<float> found = divide(a, b, units_off);
        for (std::size_t i = 0; i < a.size(); ++i) {
            float right = a[i] / b[i];
            if (std::abs(right) < 0x1p-126f) right = std::copysign(0.0f, right);
            if (bits_of(found[i]) != bits_of(right))
                return testing::PrintToString(a[i]) + " / " + testing::PrintToString(b[i]) +
                       " with the quotient off by " + std::to_string(units_off) + ": case " + std::to_string(i);
        }
        return {};
    }

    std::string wrong_root(std::uint32_t first_bits, std::uint32_t count, int units_off) {
        const std::vector<float> found = roots(first_bits, count, units_off);
        for (std::uint32_t i = 0; i < count; ++i)
            if (bits_of(found[i]) != bits_of(std::sqrt(std::bit_cast<float>(first_bits + i))))
                return "the root of " + testing::PrintToString(std::bit_cast<float>(first_bits + i)) + " off by " +
                       std::to_string(units_off);
        return {};
    }
};

constexpr int max_units_off = 5;

/// Pairs of 24-bit significands whose quotients lie as near as `nearness` steps can to the middle between two floats.
void fill_hard(std::vector<float>& a, std::vector<float>& b, std::mt19937_64& random) {
    for (std::size_t i = 0; i < a.size();) {
        const std::uint32_t divisor = static_cast<std::uint32_t>(random() % (1 << 23)) | 1u << 23 | 1u;
        const std::uint32_t nearness = static_cast<std::uint32_t>(random() % 4);
        const std::uint32_t dividend =
            vulkan::hard_dividend(divisor, random() % 2 ? (divisor + 1) / 2 + nearness : (divisor - 1) / 2 - nearness);
        if (dividend < 1u << 23) continue;
        a[i] = static_cast<float>(dividend);
        b[i] = static_cast<float>(divisor);
        ++i;
    }
}

TEST_F(DeviceArithmetic, RoundsTheHardestDivisionsAsTheProcessorDoes) {
    const char* asked = std::getenv("ISOTET_HARD_DIVISIONS");
    const std::uint64_t count = asked ? std::stoull(asked) : 4 * batch;
    std::mt19937_64 random(1);
    std::vector<float> a(batch), b(batch);
    for (std::uint64_t done = 0; done < count; done += batch) {
        fill_hard(a, b, random);
        ASSERT_EQ(wrong_division(a, b, 0), "") << "batch " << done / batch;
    }
}

TEST_F(DeviceArithmetic, DivisionsAreHard) {
    std::mt19937_64 random(1);
    std::vector<float> a(1000), b(1000);
    fill_hard(a, b, random);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_LT(a[i], b[i]);
        const double quotient = double(a[i]) / double(b[i]) * 0x1p24; // from 2^23 to 2^24
        EXPECT_LT(std::abs(quotient - std::floor(quotient) - 0.5), 1e-6) << a[i] << " / " << b[i];
    }
}

TEST_F(DeviceArithmetic, CorrectsQuotientsThatAreOffByAFewUnits) {
    std::mt19937_64 random(2);
    std::vector<float> a(batch / 4), b(batch / 4);
    fill_hard(a, b, random);
    for (int off = -max_units_off; off <= max_units_off; ++off) EXPECT_EQ(wrong_division(a, b, off), "");
    EXPECT_NE(wrong_division(a, b, 100), "") << "nothing corrects so much";
}

TEST_F(DeviceArithmetic, DividesNumbersOfAnySizeAndSign) {
    std::mt19937_64 random(3);
    std::vector<float> a(batch), b(batch);
    // Numerators and denominators of contract size: exponents from -96 to 92, and significands of few and of many bits.
    const auto number = [&] {
        const std::uint32_t mask = ~0u << random() % 24;
        const auto exponent = static_cast<std::uint32_t>(127 - 96 + random() % 189);
        return std::bit_cast<float>(static_cast<std::uint32_t>(random() & 1) << 31 | exponent << 23 |
                                    (static_cast<std::uint32_t>(random()) & mask & 0x7fffffu));
    };
    for (std::size_t i = 0; i < a.size(); ++i) {
        do {
            a[i] = random() % 64 ? number() : 0.0f;
            b[i] = random() % 64 ? number() : a[i];
        } while (b[i] == 0 || std::isinf(a[i] / b[i]) || std::abs(a[i] / b[i]) == 0x1p-126f);
    }
    for (const int off : {0, -max_units_off, max_units_off}) EXPECT_EQ(wrong_division(a, b, off), "");
}

TEST_F(DeviceArithmetic, RoundsTheRootOfEverySignificandAsTheProcessorDoes) {
    // From 1 to 4: all significands with even and with odd exponents.
    for (std::uint32_t first = bits_of(1.0f); first < bits_of(4.0f); first += batch)
        ASSERT_EQ(wrong_root(first, batch, 0), "");
}

TEST_F(DeviceArithmetic, CorrectsRootsThatAreOffByAFewUnits) {
    for (int off = -max_units_off; off <= max_units_off; ++off) {
        EXPECT_EQ(wrong_root(bits_of(1.0f), batch / 4, off), "");
        EXPECT_EQ(wrong_root(bits_of(2.0f) - batch / 8, batch / 4, off), "");
        EXPECT_EQ(wrong_root(bits_of(4.0f) - batch / 4, batch / 4, off), "");
    }
    EXPECT_NE(wrong_root(bits_of(1.0f), batch / 4, 100), "") << "nothing corrects so much";
}

TEST_F(DeviceArithmetic, TakesRootsOfNumbersOfAnySize) {
    for (std::uint32_t exponent = 1; exponent < 255; ++exponent)
        EXPECT_EQ(wrong_root(exponent << 23 | exponent * 1000, 2000, 0), "");
    EXPECT_EQ(roots(0, 1, 0)[0], 0.0f);
}

} // namespace
} // namespace isotet::test
