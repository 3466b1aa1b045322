// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any bytes, read as every format of surfaces: an error with a sentence, or a surface whose indices and lengths hold.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/surfaces/surface_parts.hpp"

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

void require_valid(const isotet::Surface& surface) {
    const std::size_t vertices = surface.vertex_count(), triangles = surface.triangle_count();
    for (const auto& field : surface.point_fields) require(field.values.tuples() == vertices);
    for (const auto& field : surface.cell_fields) require(field.values.tuples() == triangles);
    if (surface.normals_kind == isotet::Normals::gradient) require(surface.normals.tuples() == vertices);
    if (surface.normals_kind == isotet::Normals::face) require(surface.normals.tuples() == triangles);
    surface.triangles.visit([&](auto corners) {
        for (const auto corner : corners) require(static_cast<double>(corner) < static_cast<double>(vertices));
    });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // The first byte chooses the format, the empty one to test recognition; the rest is the file.
    constexpr std::array<std::string_view, 7> formats{"vtp", "ply", "stl", "obj", "vtk", "ts", ""};
    if (size == 0) return 0;
    const auto format = formats[data[0] % formats.size()];
    const auto file = isotet::io::parse_surface({reinterpret_cast<const char*>(data + 1), size - 1}, {}, format, {});
    if (file) require_valid(file->surface);
    else require(!file.error().message.empty() && file.error().code != isotet::ErrorCode::internal);
    return 0;
}
