// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/float_controls.hpp"

#include <cstring>
#include <string_view>

namespace isotet::vulkan {

namespace {

// Numbers of the SPIR-V specification and of SPV_KHR_float_controls.
constexpr std::size_t header_words = 5;
constexpr std::uint32_t op_extension = 10, op_entry_point = 15, op_execution_mode = 16, op_capability = 17;
constexpr std::uint32_t signed_zero_inf_nan_preserve_capability = 4466, rounding_mode_rte_capability = 4467;
constexpr std::uint32_t signed_zero_inf_nan_preserve = 4461, rounding_mode_rte = 4462;
constexpr std::uint32_t width = 32;

std::uint32_t first_word(std::uint32_t opcode, std::size_t words) {
    return static_cast<std::uint32_t>(words) << 16 | opcode;
}

std::vector<std::uint32_t> extension(std::string_view name) {
    std::vector<std::uint32_t> words(2 + name.size() / 4, 0); // the text ends with at least one zero
    words[0] = first_word(op_extension, words.size());
    std::memcpy(&words[1], name.data(), name.size());
    return words;
}

} // namespace

std::vector<std::uint32_t> with_float_controls(std::span<const std::uint32_t> words, FloatControls controls) {
    std::vector<std::uint32_t> capabilities, modes;
    std::uint32_t entry = 0;
    std::size_t after_capabilities = header_words, after_modes = 0;
    for (std::size_t i = header_words; i < words.size();) {
        const std::uint32_t opcode = words[i] & 0xffff, length = words[i] >> 16;
        if (length == 0) break;
        if (opcode == op_entry_point) entry = words[i + 2];
        i += length;
        if (opcode == op_capability) after_capabilities = i;
        if (opcode == op_entry_point || opcode == op_execution_mode) after_modes = i;
    }
    const auto add = [&](std::uint32_t capability, std::uint32_t mode) {
        capabilities.insert(capabilities.end(), {first_word(op_capability, 2), capability});
        modes.insert(modes.end(), {first_word(op_execution_mode, 4), entry, mode, width});
    };
    if (controls.rounds_to_nearest_even) add(rounding_mode_rte_capability, rounding_mode_rte);
    if (controls.keeps_signed_zero) add(signed_zero_inf_nan_preserve_capability, signed_zero_inf_nan_preserve);
    std::vector<std::uint32_t> out(words.begin(), words.end());
    if (modes.empty() || after_modes == 0) return out;
    const std::vector<std::uint32_t> asked = extension("SPV_KHR_float_controls");
    capabilities.insert(capabilities.end(), asked.begin(), asked.end());
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(after_modes), modes.begin(), modes.end());
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(after_capabilities), capabilities.begin(), capabilities.end());
    return out;
}

} // namespace isotet::vulkan
