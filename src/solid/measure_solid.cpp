// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// measure_solid(): volume and areas of a solid's surface, from its triangles.
#include <isotet/solid.hpp>

#include <algorithm>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "solid/assemble.hpp"

namespace isotet {

namespace {

const Field* cell_field(const Surface& surface, const char* name) {
    const auto found = std::ranges::find(surface.cell_fields, name, &Field::name);
    return found == surface.cell_fields.end() ? nullptr : &*found;
}

Result<SolidMeasure> measured(const Surface& surface, const Progress& progress) {
    const Field *const boundary = cell_field(surface, "boundary"), *const patch = cell_field(surface, "patch");
    if (!boundary || boundary->values.tuples() != surface.triangle_count())
        return invalid_argument("a surface without the cell field 'boundary' is no solid's");
    if (surface.positions.tuples() > 0 && surface.triangles.type() != ScalarType::uint32)
        return invalid_argument("the triangles of a solid are of uint32");
    for (const std::uint32_t corner : surface.triangles.as<std::uint32_t>())
        if (corner >= surface.vertex_count())
            return invalid_data(
                fmt::format("a triangle has vertex {}, but there are {}", corner, surface.vertex_count()));
    const bool has_patches = patch && patch->values.tuples() == surface.triangle_count();
    SolidMeasure measure;
    measure.volume = solid::enclosed_volume(surface);
    const std::vector<double> areas = solid::areas_of(surface, 0, surface.triangle_count());
    std::map<std::int64_t, SolidPatch> patches;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (i % (1 << 16) == 0 && progress.cancelled())
            return Error{ErrorCode::cancelled, "measuring a solid was cancelled"};
        const bool on_isosurface = boundary->values.at(i) == static_cast<double>(SolidPart::isosurface);
        measure.isosurface_triangles += on_isosurface;
        (on_isosurface ? measure.isosurface_area : measure.boundary_area) += areas[i];
        const double value = has_patches ? patch->values.at(i) : -1;
        if (!(value >= 0 && value < 0x1p53)) continue;
        const auto number = static_cast<std::int64_t>(value);
        SolidPatch& one = patches[number];
        one.number = number;
        one.area += areas[i];
        ++one.triangles;
    }
    for (const auto& [number, one] : patches) measure.patches.push_back(one);
    return measure;
}

} // namespace

Result<SolidMeasure> measure_solid(const Surface& surface, const Run& run) {
    return core::carry_out("measuring a solid", run,
                           [&](const Progress& progress) { return measured(surface, progress); });
}

} // namespace isotet
