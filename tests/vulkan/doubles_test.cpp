// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// kernels/shared/exact_double.glsl against the processor's doubles, bit by bit: made of integers, whatever the numbers are, and
// the device's own as far as pictures have them.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "test_shaders.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using vulkan::Buffer;

constexpr std::array operations{"a + b",
                                "a - b",
                                "a * b",
                                "a / b",
                                "root of a",
                                "a as a float",
                                "a, cut off",
                                "the lesser",
                                "the greater",
                                "-|a|",
                                "the float in the lower half of a",
                                "a < b"};
constexpr std::uint32_t root_of = 4, cut_off = 6, float_in_half = 10;

float low_half(double x) { return std::bit_cast<float>(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(x))); }

double answer(std::uint32_t operation, double a, double b) {
    switch (operation) {
    case 0: return a + b;
    case 1: return a - b;
    case 2: return a * b;
    case 3: return a / b;
    case root_of: return std::sqrt(a);
    case 5: {
        const auto rounded = static_cast<float>(a);
        return std::isnan(rounded) ? 0x0.000007fc00000p-1022
                                   : std::bit_cast<double>(std::uint64_t{std::bit_cast<std::uint32_t>(rounded)});
    }
    case cut_off: return static_cast<double>(static_cast<std::uint32_t>(a));
    case 7: return std::min(a, b);
    case 8: return std::max(a, b);
    case 9: return -std::abs(a);
    case float_in_half: return static_cast<double>(low_half(a));
    default: return a < b ? 1 : 0;
    }
}

/// Of NaN there is one.
std::uint64_t bits_of_double(double x) { return std::isnan(x) ? 0x7ff8000000000000U : std::bit_cast<std::uint64_t>(x); }

double double_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }

struct Pairs {
    std::vector<double> a, b;

    void add(double one, double other) {
        a.push_back(one);
        b.push_back(other);
    }
};

/// What a sum, product, quotient, root or float that is a tie or all but one is made of, at any exponent.
class HardCases {
public:
    explicit HardCases(std::uint64_t seed) : random_(seed) {}

    double number() { return double_of(random_()); }
    /// Of few bits, or of many that are 1.
    double sparse(int lowest, int highest) {
        std::uint64_t fraction = random_() & (random_() % 2 ? random_() & random_() : ~std::uint64_t{0});
        const std::uint64_t kept = ~std::uint64_t{0} << random_() % 53;
        fraction = random_() % 2 ? fraction & kept : fraction | ~kept;
        const int exponent = lowest + static_cast<int>(random_() % static_cast<std::uint64_t>(highest - lowest + 1));
        return with_sign(double_of((fraction & 0xfffffffffffffU) | static_cast<std::uint64_t>(exponent + 1023) << 52));
    }
    double denormal() { return with_sign(double_of(random_() >> (12 + random_() % 52))); }
    double special() {
        constexpr std::array<double, 14> all{0,
                                             1,
                                             0.5,
                                             INFINITY,
                                             std::numeric_limits<double>::quiet_NaN(),
                                             std::numeric_limits<double>::max(),
                                             std::numeric_limits<double>::min(),
                                             std::numeric_limits<double>::denorm_min(),
                                             0x1.fffffffffffffp-1023,
                                             std::numeric_limits<float>::max(),
                                             std::numeric_limits<float>::min(),
                                             std::numeric_limits<float>::denorm_min(),
                                             0x1.ffffff8p127,
                                             0x1p-150};
        const double one = all[random_() % all.size()];
        return with_sign(random_() % 2 ? one : double_of(std::bit_cast<std::uint64_t>(one) + random_() % 5 - 2));
    }
    /// The other end of a tie of sums: half a unit of the first, or nearly.
    double half_a_unit(double x) {
        const double half = 0.5 * (std::nextafter(std::abs(x), INFINITY) - std::abs(x));
        return with_sign(random_() % 2 ? half : std::nextafter(half, random_() % 2 ? 0 : INFINITY));
    }
    /// Nearly the first: the sum cancels.
    double near(double x) {
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) ^ random_() >> (12 + random_() % 52);
        return random_() % 2 ? double_of(bits) : -double_of(bits);
    }
    /// Of 27 bits, so that products are ties of 53 bits.
    double short_number() { return std::ldexp(static_cast<double>(random_() % (1U << 27) | 1), exponent(-1000, 900)); }
    /// A product whose quotient by the other factor is exact, or as near to that as may be.
    double times_nearly(double x, double y) {
        const double product = x * y;
        return double_of(std::bit_cast<std::uint64_t>(product) + random_() % 5 - 2);
    }
    /// A product of the middle between one number and the next: a quotient or a root that is nearly a tie.
    double times_middle(double x, double y) {
        const double half = 0.5 * (std::nextafter(x, INFINITY) - x);
        return double_of(std::bit_cast<std::uint64_t>(std::fma(x, y, half * y)) + random_() % 3 - 1);
    }
    /// Between two floats, in the middle or beside it.
    double between_floats() {
        const auto low = static_cast<float>(sparse(-152, 128));
        const double high = static_cast<double>(std::nextafterf(low, INFINITY)), middle = 0.5 * (double{low} + high);
        return random_() % 2 ? middle : std::nextafter(middle, random_() % 2 ? -INFINITY : INFINITY);
    }
    int exponent(int lowest, int highest) {
        return lowest + static_cast<int>(random_() % static_cast<std::uint64_t>(highest - lowest + 1));
    }

private:
    double with_sign(double x) { return random_() % 2 ? x : -x; }

    std::mt19937_64 random_;
};

Pairs any_pairs(std::size_t count) {
    HardCases cases(7);
    Pairs out;
    for (std::size_t i = 0; i < count; ++i) {
        out.add(cases.number(), cases.number());
        const double x = cases.sparse(-1022, 1023), y = cases.sparse(-1022, 1023), small = cases.sparse(-60, 60);
        out.add(x, y);
        out.add(x, cases.half_a_unit(x));
        out.add(x, cases.near(x));
        out.add(small, cases.sparse(-60, 60));
        out.add(small, cases.sparse(-1022, 1023));
        out.add(cases.special(), cases.special());
        out.add(cases.special(), x);
        out.add(y, cases.special());
        out.add(cases.denormal(), cases.denormal());
        out.add(cases.denormal(), small);
        out.add(cases.short_number(), cases.short_number());
        out.add(std::ldexp(cases.sparse(0, 0), -500 + cases.exponent(-60, 60)), cases.sparse(-570, -510));
        out.add(cases.times_nearly(small, y), y);
        out.add(cases.times_nearly(y, y), y);                     // also as a root
        out.add(cases.sparse(-1022, -900), cases.sparse(0, 122)); // to denormal quotients
        out.add(cases.between_floats(), 1);
    }
    return out;
}

/// As pictures have them: no denormal number, nor results of that kind, and nothing infinite.
Pairs pairs_of_pictures(std::size_t count) {
    HardCases cases(8);
    Pairs out;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = cases.sparse(-60, 60), y = cases.sparse(-60, 60);
        out.add(x, y);
        out.add(x, cases.half_a_unit(x));
        out.add(cases.times_nearly(x, y), y);
        out.add(cases.times_nearly(y, y), y);
        out.add(cases.times_middle(x, y), y);
        out.add(cases.times_middle(y, y), y);
        out.add(0, x);
    }
    return out;
}

class DeviceDoubles : public OnDevice {
protected:
    std::vector<double> answers(const vulkan::ShaderCode& code, const Pairs& pairs, std::uint32_t operation) {
        const vulkan::Kernel& kernel = **context().kernels().get(code);
        const std::uint64_t bytes = pairs.a.size() * sizeof(double);
        const Buffer a = take(bytes), b = take(bytes), down = take(bytes);
        context().staging().upload(a, 0, std::as_bytes(std::span(pairs.a))).value();
        context().staging().upload(b, 0, std::as_bytes(std::span(pairs.b))).value();
        struct Push {
            VkDeviceAddress a, b, answers;
            std::uint32_t count, operation;
        };
        vulkan::Recorder recorder(context());
        recorder.dispatch(
            kernel,
            Push{a.address(), b.address(), down.address(), static_cast<std::uint32_t>(pairs.a.size()), operation},
            (pairs.a.size() + 127) / 128, {vulkan::reads(a), vulkan::reads(b), vulkan::writes(down)});
        recorder.run().value();
        std::vector<double> found(pairs.a.size());
        context().staging().download(down, 0, std::as_writable_bytes(std::span(found))).value();
        return found;
    }
    void expect_exact(const vulkan::ShaderCode& code, const Pairs& pairs, std::uint32_t operation) {
        const std::vector<double> found = answers(code, pairs, operation);
        std::size_t wrong = 0, first = 0;
        for (std::size_t i = found.size(); i-- > 0;) {
            if (bits_of_double(found[i]) == bits_of_double(answer(operation, pairs.a[i], pairs.b[i]))) continue;
            ++wrong;
            first = i;
        }
        if (wrong == 0) return;
        const double right = answer(operation, pairs.a[first], pairs.b[first]);
        ADD_FAILURE() << std::hexfloat << operations[operation] << ": " << wrong << " wrong; a = " << pairs.a[first]
                      << ", b = " << pairs.b[first] << " gives " << found[first] << ", not " << right;
    }
};

/// Numbers from 0 to 2^20.
Pairs places(std::size_t count) {
    std::mt19937_64 random(9);
    Pairs out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<double>(random() % (1U << 20));
        for (const double x : {at, std::nextafter(at, INFINITY), std::nextafter(at + 1, 0), at + 0.5,
                               std::ldexp(at, -static_cast<int>(random() % 1074))})
            out.add(x, 0);
    }
    out.add(-0.0, 0);
    return out;
}

TEST_F(DeviceDoubles, OfIntegersAreTheProcessorsWhateverTheyAre) {
    const Pairs pairs = any_pairs(20000);
    for (std::uint32_t operation = 0; operation < operations.size(); ++operation)
        expect_exact(vulkan::test_shaders::integer_doubles, operation == cut_off ? places(20000) : pairs, operation);
}

TEST_F(DeviceDoubles, OfItsOwnAreTheProcessorsInPictures) {
    if (!context().capabilities().features.shaderFloat64) return; // a device that was named
    const Pairs pairs = pairs_of_pictures(20000);
    for (std::uint32_t operation = 0; operation < operations.size(); ++operation) {
        Pairs given = operation == cut_off ? places(20000) : pairs;
        for (double& x : given.a) {
            if (operation == root_of) x = std::abs(x);
            if (operation == float_in_half)
                x = std::bit_cast<double>(std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(x))});
        }
        expect_exact(vulkan::test_shaders::doubles, given, operation);
    }
}

} // namespace
} // namespace isotet::test
