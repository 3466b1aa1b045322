// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/part_table.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

namespace isotet::jobs {

namespace {

bool is_kept(const SurfacePart& part, std::size_t number, const PartChoice& choice) {
    switch (choice.kind) {
    case PartChoice::Kind::largest: return static_cast<double>(number) < choice.limit;
    case PartChoice::Kind::area: return part.area > choice.limit;
    case PartChoice::Kind::touching: return !part.closed;
    case PartChoice::Kind::volume: break;
    }
    return part.closed && part.volume > choice.limit;
}

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
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < found.parts.size(); ++i)
        if (!choice || is_kept(found.parts[i], i, *choice)) out.push_back(i);
    return out;
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
