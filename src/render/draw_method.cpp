// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <isotet/draw_tets.hpp>

namespace isotet {

std::string_view name_of(DrawMethod method) noexcept {
    switch (method) {
    case DrawMethod::registers: return "registers";
    case DrawMethod::registers_instanced: return "registers_instanced";
    case DrawMethod::textures: return "textures";
    case DrawMethod::mesh: return "mesh";
    }
    return "";
}

std::optional<DrawMethod> parse_draw_method(std::string_view name) noexcept {
    const auto* found = std::ranges::find(all_draw_methods, name, [](DrawMethod method) { return name_of(method); });
    return found == all_draw_methods.end() ? std::nullopt : std::optional(*found);
}

std::uint64_t tet_store_bytes(DrawMethod method, std::uint64_t tets, std::uint64_t points, bool gradients) noexcept {
    constexpr std::uint64_t texel = 16, vertices = 4, number = 4, corners = 4, group = 32, range = 8;
    constexpr std::uint64_t tables = (8 * 4 + 6 * 2) * number; // cases, edges
    const std::uint64_t textures = texel * (tets + points + (gradients ? points : 0)) + tables;
    switch (method) {
    case DrawMethod::registers: return tets * vertices * (corners * texel + number);
    case DrawMethod::registers_instanced: return tets * corners * texel;
    case DrawMethod::textures: return textures;
    case DrawMethod::mesh: return textures + (tets + group - 1) / group * range;
    }
    return 0;
}

} // namespace isotet
