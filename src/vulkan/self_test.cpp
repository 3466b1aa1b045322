// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/self_test.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

#include <fmt/core.h>

#include "numbers/arithmetic.hpp"
#include "shaders.hpp"
#include "vulkan/context.hpp"
#include "vulkan/devices/hard_divisions.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::vulkan {

namespace {

using layout::SelfTestAnswer;
using layout::SelfTestCase;

constexpr std::size_t case_count = 4096;

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers everywhere.
class Random {
public:
    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }
    std::uint32_t below(std::uint32_t limit) { return static_cast<std::uint32_t>((bits() >> 32) * limit >> 32); }

    /// Any significand, either sign, a magnitude from 2^lowest to 2^highest.
    float value(int lowest, int highest) {
        const float magnitude = static_cast<float>(below(1u << 23) | 1u << 23) * 0x1p-23f;
        const float scaled =
            std::ldexp(magnitude, lowest + static_cast<int>(below(static_cast<std::uint32_t>(highest - lowest))));
        return bits() % 2 ? scaled : -scaled;
    }

private:
    std::uint64_t state_ = 2006;
};

/// isovalue - below and above - below are these two significands; the quotient is as near to a middle as can be.
void set_hard_division(SelfTestCase& out, Random& random) {
    std::uint32_t dividend = 0, divisor = 0;
    while (dividend < 1u << 23) {
        divisor = random.below(1u << 23) | 1u << 23 | 1u;
        dividend = hard_dividend(divisor, (divisor + 1) / 2 - random.below(8));
    }
    out.below = 0;
    out.isovalue = static_cast<float>(dividend);
    out.above = static_cast<float>(divisor);
}

void set_ordinary_edge(SelfTestCase& out, Random& random, int lowest, int highest) {
    float a = random.value(lowest, highest), b = random.value(lowest, highest);
    if (b < a) std::swap(a, b);
    if (a == b) b += 1;
    out.below = a;
    out.above = b;
    out.isovalue = std::clamp(a + (b - a) * static_cast<float>(random.below(1u << 20)) * 0x1p-20f, a, b);
    if (out.isovalue == a || std::abs(out.isovalue) < 0x1p-70f) return;
    const float step = out.isovalue - std::nextafter(out.isovalue, a);
    out.rest = -step * static_cast<float>(random.below(1u << 20)) * 0x1p-20f;
}

void set_edge(SelfTestCase& out, std::size_t kind, Random& random) {
    out.a = random.value(-6, 6);
    out.b = random.value(-6, 6);
    switch (kind) {
    case 0:
    case 1: return set_hard_division(out, random);
    case 2: return set_ordinary_edge(out, random, -70, 57);
    case 3: // the smallest weights, and ends that differ in their last bits: products of about 2^-125
        set_ordinary_edge(out, random, 0, 1);
        out.below = 0;
        out.isovalue = std::ldexp(1 + static_cast<float>(random.below(1u << 20)) * 0x1p-20f, -32);
        out.rest = 0;
        out.above = 1;
        out.a = random.value(-70, -69);
        out.b = std::bit_cast<float>(std::bit_cast<std::uint32_t>(out.a) + 1 + random.below(3));
        return;
    case 4: // to infinity, from it, and between two
        out.below = random.below(2) ? -0x1p91f : random.value(-70, 57);
        out.above = random.below(2) ? 0x1p91f : 0x1p57f;
        out.isovalue = std::max(out.below, random.value(-70, 57));
        return;
    default: return set_ordinary_edge(out, random, -8, 8);
    }
}

void set_normals(SelfTestCase& out, std::size_t kind, Random& random) {
    out.code_below = static_cast<std::uint32_t>(random.bits());
    out.code_above = static_cast<std::uint32_t>(random.bits());
    const auto into_range = [](std::uint32_t code) { // -32768 is no step of a code
        if ((code & 0xffffu) == 0x8000u) code ^= 1u;
        return code >> 16 == 0x8000u ? code ^ 0x10000u : code;
    };
    out.code_below = into_range(out.code_below);
    out.code_above = into_range(out.code_above);
    if (kind == 0) out.code_above = core::zero_normal_code;
    if (kind == 1) { // opposite: they cancel in the middle
        const auto n = core::decode_normal(out.code_below);
        out.code_above = core::encode_normal({-double(n[0]), -double(n[1]), -double(n[2])});
    }
}

void set_triangle(SelfTestCase& out, std::size_t kind, Random& random) {
    const int highest = kind == 0 ? 90 : 4;
    for (float& x : out.corners) x = random.value(kind == 0 ? -70 : -4, highest);
    if (kind == 1) // no area
        for (std::size_t axis = 0; axis < 3; ++axis)
            out.corners[6 + axis] = 2 * out.corners[3 + axis] - out.corners[axis];
    if (kind == 2) // corners that nearly coincide
        for (std::size_t i = 3; i < 9; ++i)
            out.corners[i] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(out.corners[i % 3]) + random.below(4));
}

std::uint32_t bits_of(float x) { return std::bit_cast<std::uint32_t>(x); }

/// How many of the cases differ in each part, as text: "weights 12, face normals 3".
std::string differences(std::span<const SelfTestCase> cases, std::span<const SelfTestAnswer> answers) {
    std::size_t weights = 0, interpolated = 0, vertex_normals = 0, face_normals = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const SelfTestAnswer right = self_test_answer(cases[i]);
        weights += answers[i].weight != right.weight;
        interpolated += answers[i].interpolated != right.interpolated;
        vertex_normals += !std::ranges::equal(answers[i].vertex_normal, right.vertex_normal);
        face_normals += !std::ranges::equal(answers[i].face_normal, right.face_normal);
    }
    std::string text;
    for (const auto& [count, what] : {std::pair{weights, "weights"},
                                      {interpolated, "interpolated values"},
                                      {vertex_normals, "vertex normals"},
                                      {face_normals, "face normals"}})
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", what, count);
    return text;
}

} // namespace

std::vector<SelfTestCase> self_test_cases() {
    Random random;
    std::vector<SelfTestCase> cases(case_count);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        set_edge(cases[i], i % 8, random);
        set_normals(cases[i], i / 8 % 8, random);
        set_triangle(cases[i], i / 64 % 8, random);
    }
    return cases;
}

SelfTestAnswer self_test_answer(const SelfTestCase& given) {
    SelfTestAnswer answer{};
    const float t = core::edge_weight<float>({given.isovalue, given.rest}, given.below, given.above);
    const auto vertex = core::vertex_normal(given.code_below, given.code_above, t);
    const auto corner = [&](std::size_t i) {
        return core::Vector<float>{given.corners[3 * i], given.corners[3 * i + 1], given.corners[3 * i + 2]};
    };
    const auto face = core::face_normal(corner(0), corner(1), corner(2));
    answer.weight = bits_of(t);
    answer.interpolated = bits_of(core::interpolate(given.a, given.b, t));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        answer.vertex_normal[axis] = bits_of(vertex[axis]);
        answer.face_normal[axis] = bits_of(face[axis]);
    }
    return answer;
}

Result<std::string> self_test(Context& context) {
    const std::vector<SelfTestCase> cases = self_test_cases();
    std::vector<SelfTestAnswer> answers(cases.size());
    Result<Buffer> given =
        context.memory().take(std::span(cases).size_bytes(), Where::upload, "cases of the self-test");
    if (!given) return given.error();
    Result<Buffer> taken =
        context.memory().take(std::span(answers).size_bytes(), Where::download, "answers of the self-test");
    if (!taken) return taken.error();
    const Result<const Kernel*> kernel = context.kernels().get(shaders::self_test);
    if (!kernel) return kernel.error();
    if (Result<void> up = context.staging().upload(*given, 0, std::as_bytes(std::span(cases))); !up) return up.error();

    struct Push {
        VkDeviceAddress cases, answers;
        std::uint32_t count, unused;
    };
    constexpr std::size_t workgroup = 64;
    Recorder recorder(context);
    recorder.dispatch(**kernel, Push{given->address(), taken->address(), case_count, 0}, case_count / workgroup,
                      {reads(*given), writes(*taken)});
    if (Result<Timings> ran = recorder.run(); !ran) return ran.error();
    if (Result<void> down = context.staging().download(*taken, 0, std::as_writable_bytes(std::span(answers))); !down)
        return down.error();
    const std::string wrong = differences(cases, answers);
    if (wrong.empty()) return std::string();
    return fmt::format(
        "the arithmetic of the device {} is not exact (of {} cases, wrong: {}): surfaces may differ from the CPU's "
        "in their last bits",
        context.info().name, case_count, wrong);
}

} // namespace isotet::vulkan
