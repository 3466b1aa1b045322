// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The structs that cross to the drawing shaders (kernels/scene.h), checked, and how they are filled.
#pragma once

#include <array>
#include <cstddef>

#include <isotet/picture.hpp>

#include "grid/cell/case_table.hpp"
#include "render/color/color_places.hpp"
#include "render/color/linear_light.hpp"
#include "render/kernels/scene.h"
#include "vulkan/engine/address.hpp"
#include "vulkan/engine/layout.hpp"

namespace isotet::render {

namespace layout {

static_assert(sizeof(View) == 64 + 12 + 4 + 12 + 4 * 4 + 4 * 8 + 12 + 4);
static_assert(sizeof(Mesh) == 8 * 8 + 3 * 12 + 3 * 4 && sizeof(Lines) == 8 + 12 + 4 + 4);
static_assert(sizeof(FragmentList) == 4 && sizeof(Fragment) == 16);
static_assert(sizeof(TetRegisters) == 68 && sizeof(TetTables) == 176 && sizeof(TetPage) == sizeof(Mesh) + 6 * 8 + 12);
static_assert(sizeof(TwinPush) == 20 && page_tets % tet_group == 0);
static_assert(table_entries == entries_per_map);
static_assert(sizeof(DrawPush) == 16 && sizeof(ResolvePush) == 8);

/// What marching tetrahedra looks up, by the same numbers in C++ and in shaders.
inline constexpr TetTables tet_tables{{ISOTET_HALF_CASES}, {ISOTET_TET_EDGES}};

/// Whether the row of a case, or of its complement, is the polygon of the table of the engines: the same edges, from
/// the same one on, so that the same diagonal cuts a quad; one way around or the other.
constexpr bool row_agrees(unsigned index) {
    const core::TetCase& whole = core::case_table[index];
    const uint* row = tet_tables.cases + std::size_t{4} * (index < 8 ? index : 15 - index);
    const auto is = [&](unsigned k, unsigned place) {
        const core::ActiveEdge& edge = whole.polygon[place];
        const uint lower = edge.above < edge.below ? edge.above : edge.below;
        const uint higher = edge.above < edge.below ? edge.below : edge.above;
        return tet_tables.edges[2 * row[k]] == lower && tet_tables.edges[2 * row[k] + 1] == higher;
    };
    if (whole.edges == 4) return is(0, 0) && is(2, 2) && ((is(1, 1) && is(3, 3)) || (is(1, 3) && is(3, 1)));
    return is(0, 0) && row[3] == row[2] && ((is(1, 1) && is(2, 2)) || (is(1, 2) && is(2, 1)));
}
constexpr bool half_cases_agree() {
    for (unsigned index = 1; index < 15; ++index)
        if (!row_agrees(index)) return false;
    return true;
}
static_assert(half_cases_agree());

inline vec3 vector(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

} // namespace layout

/// A colour in linear light.
inline layout::vec3 light_of(const Color& color) {
    const Light light = linear_light(color);
    return {light[0], light[1], light[2]};
}

} // namespace isotet::render
