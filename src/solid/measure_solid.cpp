// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// measure_solid(): volume and areas of a solid's surface, from its triangles.
#include <isotet/solid.hpp>

#include <algorithm>
#include <map>
#include <vector>

#include "base/errors.hpp"
#include "base/guard.hpp"
#include "solid/assemble.hpp"

namespace isotet {

namespace {

const Field* cell_field(const Surface& surface, const char* name) {
    const auto found = std::ranges::find(surface.cell_fields, name, &Field::name);
    return found == surface.cell_fields.end() ? nullptr : &*found;
}

Result<SolidMeasure> measured(const Surface& surface) {
    const Field *const boundary = cell_field(surface, "boundary"), *const patch = cell_field(surface, "patch");
    if (!boundary || boundary->values.tuples() != surface.triangle_count())
        return invalid_argument("a surface without the cell field 'boundary' is no solid's");
    SolidMeasure measure;
    measure.volume = solid::enclosed_volume(surface);
    const std::vector<double> areas = solid::areas_of(surface, 0, surface.triangle_count());
    std::map<std::int64_t, SolidPatch> patches;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const bool on_isosurface = boundary->values.at(i) == static_cast<double>(SolidPart::isosurface);
        measure.isosurface_triangles += on_isosurface;
        (on_isosurface ? measure.isosurface_area : measure.boundary_area) += areas[i];
        const auto number = patch ? static_cast<std::int64_t>(patch->values.at(i)) : -1;
        if (number < 0) continue;
        SolidPatch& one = patches[number];
        one.number = number;
        one.area += areas[i];
        ++one.triangles;
    }
    for (const auto& [number, one] : patches) measure.patches.push_back(one);
    return measure;
}

} // namespace

Result<SolidMeasure> measure_solid(const Surface& surface) {
    return core::guarded("measuring a solid", [&] { return measured(surface); });
}

} // namespace isotet
