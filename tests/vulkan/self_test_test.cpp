// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arithmetic self-test passes on an exact device, and notices one that is not.
#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/self_test.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

PFN_vkCreateShaderModule create_shader_module = nullptr;
void (*spoil)(std::vector<std::uint32_t>& words) = nullptr;

VKAPI_ATTR VkResult VKAPI_CALL create_spoiled(VkDevice device, const VkShaderModuleCreateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkShaderModule* module) {
    std::vector<std::uint32_t> words(info->pCode, info->pCode + info->codeSize / 4);
    spoil(words);
    VkShaderModuleCreateInfo spoiled = *info;
    spoiled.pCode = words.data();
    return create_shader_module(device, &spoiled, allocator, module);
}

/// What is noticed of a device whose kernels are changed like this before the driver sees them.
std::vector<std::string> notices_with(void (*change)(std::vector<std::uint32_t>& words)) {
    spoil = change;
    vulkan::Settings settings = watched();
    settings.alter_functions = [](vulkan::DeviceFunctions& functions) {
        create_shader_module = functions.vkCreateShaderModule;
        functions.vkCreateShaderModule = &create_spoiled;
    };
    return open_software(settings)->notices();
}

constexpr std::size_t header_words = 5;
constexpr std::uint32_t op_constant = 43, op_fadd = 129, op_fmul = 133, op_fdiv = 136;

template <class F>
void for_instructions(std::vector<std::uint32_t>& words, F&& f) {
    for (std::size_t i = header_words; i < words.size(); i += words[i] >> 16) f(words[i] & 0xffff, &words[i]);
}

TEST(SelfTest, PassesOnAnExactDevice) {
    EXPECT_EQ(notices_with([](std::vector<std::uint32_t>&) {}), std::vector<std::string>());
}

TEST(SelfTest, NoticesADeviceWhoseQuotientsAndRootsAreFarOff) {
    // The scale of the significand, 2^23, a hundred units larger: more than is corrected.
    const auto notices = notices_with([](std::vector<std::uint32_t>& words) {
        for_instructions(words, [](std::uint32_t opcode, std::uint32_t* at) {
            if (opcode == op_constant && at[3] == std::bit_cast<std::uint32_t>(8388608.0f))
                at[3] = std::bit_cast<std::uint32_t>(8388708.0f);
        });
    });
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_NE(notices[0].find("is not exact (of 4096 cases, wrong: weights "), std::string::npos) << notices[0];
    EXPECT_NE(notices[0].find("surfaces may differ from the CPU's in their last bits"), std::string::npos)
        << notices[0];
}

TEST(SelfTest, NoticesADeviceThatComputesSomethingElse) {
    const auto notices = notices_with([](std::vector<std::uint32_t>& words) {
        for_instructions(words, [](std::uint32_t opcode, std::uint32_t* at) {
            if (opcode == op_fmul) *at = (*at & 0xffff0000u) | op_fadd;
        });
    });
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_NE(notices[0].find("face normals"), std::string::npos) << notices[0];
}

TEST(SelfTest, ForgivesADeviceThatDividesInexactly) {
    // a / b as a * 1.0000004 / b, about four units off: what correction is for.
    const auto notices = notices_with([](std::vector<std::uint32_t>& words) {
        for_instructions(words, [](std::uint32_t opcode, std::uint32_t* at) {
            if (opcode == op_constant && at[3] == std::bit_cast<std::uint32_t>(8388608.0f))
                at[3] = std::bit_cast<std::uint32_t>(8388611.0f);
        });
    });
    EXPECT_EQ(notices, std::vector<std::string>());
}

TEST(SelfTest, HasCasesThatRoundDifferentlyWhenContracted) {
    std::size_t differ = 0;
    for (const auto& given : vulkan::self_test_cases()) {
        const float t = std::bit_cast<float>(vulkan::self_test_answer(given).weight);
        const float fused = t == 1 ? given.b : std::fma(t, given.b - given.a, given.a);
        differ += std::bit_cast<std::uint32_t>(fused) != vulkan::self_test_answer(given).interpolated;
    }
    EXPECT_GT(differ, 200u);
}

TEST(SelfTest, HasCasesOfEveryKind) {
    std::size_t zero_weights = 0, one_weights = 0, smallest_products = 0, no_vertex_normal = 0, no_area = 0, nan = 0;
    for (const auto& given : vulkan::self_test_cases()) {
        const auto answer = vulkan::self_test_answer(given);
        const float t = std::bit_cast<float>(answer.weight);
        zero_weights += t == 0;
        one_weights += t == 1;
        const float product = std::abs(t * (given.b - given.a));
        smallest_products += product > 0 && product < 0x1p-120f;
        EXPECT_TRUE(product == 0 || product >= 0x1p-126f) << "denormal: outside of the contract";
        no_vertex_normal += std::ranges::all_of(answer.vertex_normal, [](std::uint32_t bits) { return bits == 0; });
        no_area += std::ranges::all_of(answer.face_normal, [](std::uint32_t bits) { return bits == 0; });
        for (const std::uint32_t bits :
             {answer.weight, answer.interpolated, answer.vertex_normal[0], answer.face_normal[0]})
            nan += (bits & 0x7fffffffu) >= 0x7f800000u;
        EXPECT_TRUE(t >= 0 && t <= 1) << t;
    }
    EXPECT_GT(zero_weights, 10u);
    EXPECT_GT(one_weights, 10u);
    EXPECT_GT(smallest_products, 50u);
    EXPECT_GT(no_vertex_normal, 100u);
    EXPECT_GT(no_area, 20u);
    EXPECT_EQ(nan, 0u);
}

} // namespace
} // namespace isotet::test
