// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The structs that cross to the kernels (kernels/shared/layout.h), checked against what they mirror.
#pragma once

#include <cstdint>

#include "grid/cell/case_table.hpp"
#include "grid/cell/cell_cases.hpp"
#include "packed/packed.hpp"
#include "vulkan/kernels/shared/layout.h"

namespace isotet::vulkan {

namespace layout {

static_assert(sizeof(Page) == 56 && sizeof(Cluster) == 40 && sizeof(Neighbour) == 12 && sizeof(Range) == 8);
static_assert(sizeof(Count) == 8 && sizeof(Start) == 12 && sizeof(Lists) == 48 && sizeof(DrawArguments) == 20);
static_assert(sizeof(Tables) == 116 && sizeof(Output) == 144 && sizeof(ExtractPush) == 36 && sizeof(RangesPush) == 8);
static_assert(sizeof(SurfacePush) == 8 && sizeof(FieldPush) == 28);
static_assert(group_size == core::group_size && max_cluster_points == core::max_cluster_points);
static_assert(max_cluster_groups == core::max_cluster_tets / core::group_size &&
              max_cluster_seams == 6 * core::max_cluster_tets);
static_assert(core::max_mixed_cluster_tets / core::tets_for_a_cell < 1024, "ten bits for the cells of a kind");

constexpr std::uint32_t polygon_word(const std::array<core::ActiveEdge, 4>& edges, std::uint32_t triangles) {
    std::uint32_t word = triangles << 24;
    for (unsigned k = 0; k < 4; ++k) word |= (edges[k].above + 8u * edges[k].below) << 6 * k;
    return word;
}
constexpr std::uint32_t tet_case(const core::TetCase& c) { return polygon_word(c.polygon, c.triangles); }
constexpr bool tet_cases_agree() {
    constexpr std::uint32_t cases[16] = {ISOTET_TET_CASES};
    for (unsigned index = 0; index < 16; ++index)
        if (cases[index] != tet_case(core::case_table[index])) return false;
    return true;
}
static_assert(tet_cases_agree());

/// The cases of the kinds that are no tets, as kernels look them up.
constexpr auto cell_cases = [] {
    using core::CellKind;
    constexpr std::size_t polygons =
        core::pyramid_cases.polygon_count + core::wedge_cases.polygon_count + core::hexahedron_cases.polygon_count;
    std::array<std::uint32_t, polygons_at + polygons> words{};
    std::uint32_t next = polygons_at;
    const auto add = [&](const auto& cases, std::uint32_t at) {
        for (const core::CellCase& c : cases.cases)
            words[at++] = (next + c.first) | std::uint32_t{c.polygons} << 16 | std::uint32_t{c.triangles} << 20;
        for (const core::CellPolygon& polygon : cases.all)
            words[next++] = polygon_word(polygon.edges, polygon.triangles);
    };
    add(core::pyramid_cases, pyramid_cases_at);
    add(core::wedge_cases, wedge_cases_at);
    add(core::hexahedron_cases, hexahedron_cases_at);
    return words;
}();

} // namespace layout

} // namespace isotet::vulkan
