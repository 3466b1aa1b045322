// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/part_table.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

namespace isotet::jobs {

namespace {

/// A name as a cell of a table: quoted where it has to be (RFC 4180).
std::string csv_text(std::string_view name) {
    if (name.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(name);
    std::string out = "\"";
    for (const char c : name) {
        if (c == '"') out += '"';
        out += c;
    }
    return out + '"';
}

/// Of all surfaces, in the order in which they occur.
std::vector<std::string> all_fields(const ExtractNumbers& numbers) {
    std::vector<std::string> out;
    for (const SurfaceNumbers& surface : numbers.surfaces)
        if (surface.parts)
            for (const std::string& name : surface.parts->fields)
                if (std::ranges::find(out, name) == out.end()) out.push_back(name);
    return out;
}

void add_row(const SurfaceNumbers& surface, std::size_t number, const std::vector<std::string>& fields,
             std::string& out) {
    const SurfacePart& part = surface.parts->parts[number];
    out += fmt::format("{},{},{},{},{},{},{},{}", shortest(surface.isovalue),
                       surface.time ? shortest(*surface.time) : "", number, part.triangles, part.vertices,
                       shortest(part.area), part.closed ? shortest(part.volume) : "", part.closed ? 1 : 0);
    for (const auto* place : {&part.centre, &part.lower, &part.upper})
        for (const double coordinate : *place) out += "," + shortest(coordinate);
    for (const std::string& name : fields) {
        const auto& known = surface.parts->fields;
        const auto at = static_cast<std::size_t>(std::ranges::find(known, name) - known.begin());
        out += "," + (at < known.size() ? shortest(part.means[at]) : std::string());
    }
    out += "\n";
}

} // namespace

Result<std::vector<std::uint64_t>> kept_parts(const Surface& surface, const SurfaceParts& found,
                                              const std::optional<PartChoice>& choice,
                                              const std::optional<Region>& touched) {
    if (touched) return parts_touching(surface, found, *touched);
    if (choice) return chosen_parts(surface, found, *choice, PartsOf::isosurface);
    std::vector<std::uint64_t> all(found.parts.size());
    std::iota(all.begin(), all.end(), std::uint64_t{0});
    return all;
}

Result<void> measure_again(const Surface& surface, SolidNumbers& solid, const Run& run) {
    const Result<SolidMeasure> measured = measure_solid(surface, run);
    if (!measured) return measured.error();
    solid.volume = measured->volume;
    solid.isosurface_area = measured->isosurface_area;
    solid.boundary_area = measured->boundary_area;
    const bool has_patches = std::ranges::find(surface.cell_fields, "patch", &Field::name) != surface.cell_fields.end();
    if (!has_patches) solid.patches.clear();
    for (SolidPatch& patch : solid.patches) {
        const auto found = std::ranges::find(measured->patches, patch.number, &SolidPatch::number);
        const bool is_left = found != measured->patches.end();
        patch.triangles = is_left ? found->triangles : 0;
        patch.area = is_left ? found->area : 0;
    }
    return {};
}

void note_cavities(const SurfaceParts& found, const std::vector<std::uint64_t>& kept, Caller& caller) {
    std::uint64_t cavities = 0;
    for (const SurfacePart& part : found.parts) cavities += part.closed && part.volume < 0;
    for (const std::uint64_t number : kept) cavities -= found.parts[number].closed && found.parts[number].volume < 0;
    if (cavities > 0)
        caller.note(fmt::format("of the parts left out {}, of negative volume: the solid is filled there",
                                cavities == 1 ? "1 is a cavity" : grouped(cavities) + " are cavities"));
}

std::string parts_csv(const ExtractNumbers& numbers) {
    const std::vector<std::string> fields = all_fields(numbers);
    std::string out =
        "isovalue,time,part,triangles,vertices,area,volume,closed,centre_x,centre_y,centre_z,lower_x,lower_y,"
        "lower_z,upper_x,upper_y,upper_z";
    for (const std::string& name : fields) out += "," + csv_text("mean of " + name);
    out += "\n";
    for (const SurfaceNumbers& surface : numbers.surfaces)
        if (surface.parts)
            for (std::size_t i = 0; i < surface.parts->parts.size(); ++i) add_row(surface, i, fields, out);
    return out;
}

} // namespace isotet::jobs
