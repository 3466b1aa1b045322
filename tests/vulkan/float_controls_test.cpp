// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Rounding and signed zeros are asked for in the places where SPIR-V wants it.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "test_shaders.hpp"
#include "vulkan/devices/float_controls.hpp"

namespace isotet::test {
namespace {

using Words = std::vector<std::uint32_t>;

/// The instructions of a module, without its header.
std::vector<Words> instructions(std::span<const std::uint32_t> words) {
    std::vector<Words> list;
    for (std::size_t i = 5; i < words.size() && words[i] >> 16 > 0; i += words[i] >> 16)
        list.emplace_back(words.begin() + static_cast<std::ptrdiff_t>(i),
                          words.begin() + static_cast<std::ptrdiff_t>(i + (words[i] >> 16)));
    return list;
}

std::size_t place(const std::vector<Words>& list, const Words& one) {
    return static_cast<std::size_t>(std::find(list.begin(), list.end(), one) - list.begin());
}

std::size_t first_of(const std::vector<Words>& list, std::uint32_t opcode) {
    return static_cast<std::size_t>(
        std::find_if(list.begin(), list.end(), [&](const Words& one) { return (one[0] & 0xffff) == opcode; }) -
        list.begin());
}

TEST(FloatControls, ChangeNothingWhereTheDevicePromisesNothing) {
    const auto& code = vulkan::test_shaders::add;
    EXPECT_EQ(vulkan::with_float_controls(code.words, {}), Words(code.words.begin(), code.words.end()));
}

TEST(FloatControls, StandWhereTheSpecificationWantsThem) {
    const auto& code = vulkan::test_shaders::add;
    const auto before = instructions(code.words),
               after = instructions(vulkan::with_float_controls(code.words, {true, true}));
    ASSERT_EQ(after.size(), before.size() + 5);
    const std::uint32_t entry = before[first_of(before, 15)][2];
    constexpr std::uint32_t extension = 10, memory_model = 14, debug_source = 3;
    const Words rte_capability = {2u << 16 | 17, 4467}, zero_capability = {2u << 16 | 17, 4466};
    const Words rte = {4u << 16 | 16, entry, 4462, 32}, zero = {4u << 16 | 16, entry, 4461, 32};
    EXPECT_LT(place(after, rte_capability), first_of(after, extension)) << "capabilities come first";
    EXPECT_LT(place(after, zero_capability), first_of(after, extension));
    EXPECT_LT(first_of(after, memory_model), place(after, rte)) << "execution modes follow the entry point";
    EXPECT_LT(place(after, rte), first_of(after, debug_source)) << "and stand before everything of the debugger";
    EXPECT_LT(place(after, zero), first_of(after, debug_source));
    const Words& name = after[place(after, zero_capability) + 1];
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(name.data() + 1)), "SPV_KHR_float_controls");
    EXPECT_EQ(name[0], static_cast<std::uint32_t>(name.size()) << 16 | extension);
    for (const Words& one : before) EXPECT_LT(place(after, one), after.size()) << "nothing is lost";
}

TEST(FloatControls, AskOnlyForWhatIsPromised) {
    const auto& code = vulkan::test_shaders::add;
    EXPECT_EQ(instructions(vulkan::with_float_controls(code.words, {true, false})).size(),
              instructions(code.words).size() + 3);
}

} // namespace
} // namespace isotet::test
