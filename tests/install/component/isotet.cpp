// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays in, a surface out, by every engine that isotet::isotet has.
#include <isotet/fields.hpp>
#include <isotet/contour.hpp>
#include <isotet/make.hpp>

int main() {
    isotet::Grid grid = isotet::make_grid({.side = 8}).value();
    const isotet::PointField field = isotet::find_field(grid, "sphere").value();
    std::size_t triangles[2];
    for (const auto& engine : {isotet::cpu_engine(), isotet::reference_engine()}) {
        isotet::Contour contour = isotet::Contour::create({grid, field, {}, {}}, {.engine = engine}).value();
        triangles[engine->name() == "cpu"] = contour.extract(0.5).value().surfaces[0].surface.triangle_count();
    }
    return triangles[0] > 0 && triangles[0] == triangles[1] ? 0 : 1;
}
