// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/write.hpp>

int main() {
    const isotet::Grid grid = isotet::make_grid({.shape = "kuhn", .side = 8, .fields = {"sphere"}}).value();
    const auto packed = isotet::pack(grid, isotet::find_field(grid, "sphere").value()).value();
    const isotet::Extraction sphere = isotet::extract(packed, 0.5).value();
    const auto written = isotet::write_surface(sphere.surface, "sphere.vtp");
    return written && sphere.surface.triangle_count() > 100 ? 0 : 1;
}
