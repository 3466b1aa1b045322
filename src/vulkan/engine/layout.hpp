// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The structs that cross to the kernels (kernels/shared/layout.h), checked against what they mirror.
#pragma once

#include <cstdint>

#include "core/case_table.hpp"
#include "core/packed.hpp"
#include "vulkan/kernels/shared/layout.h"
#include "vulkan/memory.hpp"

namespace isotet::vulkan {

namespace layout {

static_assert(sizeof(Page) == 52 && sizeof(Cluster) == 32 && sizeof(Neighbour) == 12 && sizeof(Range) == 8);
static_assert(sizeof(Count) == 8 && sizeof(Start) == 12 && sizeof(Lists) == 48 && sizeof(DrawArguments) == 20);
static_assert(sizeof(Tables) == 108 && sizeof(Output) == 144 && sizeof(ExtractPush) == 36 && sizeof(RangesPush) == 8);
static_assert(sizeof(SurfacePush) == 8 && sizeof(FieldPush) == 28);
static_assert(group_size == core::group_size && max_cluster_points == core::max_cluster_points);
static_assert(max_cluster_groups == core::max_cluster_tets / core::group_size &&
              max_cluster_seams == 6 * core::max_cluster_tets);

constexpr std::uint32_t tet_case(const core::TetCase& c) {
    std::uint32_t word = std::uint32_t{c.triangles} << 16;
    for (unsigned k = 0; k < 4; ++k) word |= (c.polygon[k].above + 4u * c.polygon[k].below) << 4 * k;
    return word;
}
constexpr bool tet_cases_agree() {
    constexpr std::uint32_t cases[16] = {ISOTET_TET_CASES};
    for (unsigned index = 0; index < 16; ++index)
        if (cases[index] != tet_case(core::case_table[index])) return false;
    return true;
}
static_assert(tet_cases_agree());

} // namespace layout

inline layout::Address address_at(std::uint64_t address) {
    return {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32)};
}
inline layout::Address address_of(const Buffer& buffer, std::uint64_t offset = 0) {
    return address_at(buffer ? buffer.address() + offset : 0);
}

} // namespace isotet::vulkan
