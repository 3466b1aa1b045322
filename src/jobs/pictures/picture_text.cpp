// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/pictures/picture_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

namespace isotet::jobs {

namespace {

/// Text with a minus sign, as the scale has it, in place of a hyphen.
std::string with_minus(std::string number) {
    if (number.starts_with('-')) number.replace(0, 1, "\u2212");
    return number;
}

/// "x = 0.5", or the normal and the offset.
std::string plane_text(const Plane& plane) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along = plane.normal[axis];
        if (std::abs(along) != 1 || plane.normal[(axis + 1) % 3] != 0 || plane.normal[(axis + 2) % 3] != 0) continue;
        return fmt::format("{} = {}", "xyz"[axis], rounded(plane.offset * along));
    }
    return fmt::format("({}, {}, {}) · p = {}", rounded(plane.normal[0]), rounded(plane.normal[1]),
                       rounded(plane.normal[2]), rounded(plane.offset));
}

/// "gyroid", or with the isovalues of surfaces that rays meet "gyroid = 0.2".
std::string volume_text(const DrawInput& input) {
    const std::vector<double>& isovalues = input.volume->isosurfaces;
    constexpr std::size_t few_isovalues = 6;
    if (isovalues.empty() || isovalues.size() > few_isovalues) return input.field;
    return fmt::format("{} = {}", input.field, fmt::join(told_apart(isovalues), ", "));
}

std::string why_not_there(double isovalue, const std::string& name, const FieldReport& field) {
    const std::string values =
        !(field.lower <= field.upper) ? fmt::format("'{}' has no finite value", name)
        : field.lower == field.upper
            ? fmt::format("all values of '{}' are {}", name, shortest(field.lower))
            : fmt::format("the values of '{}' go from {} to {}", name, shortest(field.lower), shortest(field.upper));
    return fmt::format("there is no surface at {}: {}", shortest(isovalue), values);
}

} // namespace

std::string percent_text(double share) { return rounded(100 * share) + " %"; }

std::vector<std::string> isovalue_texts(const IsosurfaceScene& scene) {
    std::vector<double> isovalues;
    for (const ShownSurface& surface : scene.surfaces()) isovalues.push_back(surface.isovalue.value_or(0));
    return told_apart(isovalues);
}

void note_what_is_empty(const DrawJob& job, const DrawInput& input, Caller& caller) {
    for (const std::size_t slice : input.scene->report().empty_slices)
        caller.note(fmt::format("the slice {} does not meet the grid", plane_text(job.slices[slice])));
    const auto& [field, store] = std::tie(input.scene->report().field, input.scene->report().store);
    for (const ShownSurface& surface : input.scene->surfaces()) {
        if (!surface.isovalue) continue;
        // Of tets it is not known before they are drawn; values on both sides of the isovalue make a surface mostly.
        const bool shown =
            store ? field.lower < *surface.isovalue && *surface.isovalue <= field.upper : surface.triangles > 0;
        if (!shown) caller.note(why_not_there(*surface.isovalue, input.field, field));
    }
    for (const double isovalue : input.volume ? input.volume->isosurfaces : std::vector<double>())
        if (!(field.lower < isovalue && isovalue <= field.upper))
            caller.note(why_not_there(isovalue, input.field, field));
}

Annotation annotation_of(const DrawJob& job, const DrawInput& input) {
    Annotation annotation;
    if (job.plain) return annotation;
    const std::vector<ShownSurface>& surfaces = input.scene->surfaces();
    const FieldReport& field = input.scene->report().field;
    std::uint64_t all = 0;
    for (const ShownSurface& surface : surfaces) all += surface.size();
    // Narrow pictures cut captions off at their end: what tells one picture of a series from another comes first.
    const std::string separator = "  ·  ";
    const auto add = [&](const std::string& text) { annotation.caption += separator + text; };
    const std::vector<std::string> values = isovalue_texts(*input.scene);
    constexpr std::size_t few = 6;
    annotation.caption = std::filesystem::path(job.grid.file).filename().string();
    if (!input.field.empty() && surfaces.size() == 1)
        add(fmt::format("{} = {}", input.field,
                        rounded(*surfaces.front().isovalue, (field.upper - field.lower) / 1000)));
    else if (!input.field.empty() && surfaces.empty() && input.volume) add(volume_text(input));
    else if (!input.field.empty() && (input.colors || job.method.draw) && surfaces.size() <= few)
        add(fmt::format("{} = {}", input.field, fmt::join(values, ", ")));
    else if (!input.field.empty()) add(fmt::format("{} at {} isovalues", input.field, surfaces.size()));
    if (input.time) add("t = " + rounded(*input.time));
    if (input.step) add(fmt::format("step {}", *input.step));
    for (const Plane& plane : job.slices) add(plane_text(plane));
    if (!input.stretch.empty())
        add(fmt::format("axes × {}, {}, {}", shortest(input.stretch[0]), shortest(input.stretch[1]),
                        shortest(input.stretch[2])));
    if (!input.is_surface) add(counted(input.cells, "cell"));
    if (all > 0) add(job.method.draw ? counted(all, "tet") + " drawn" : counted(all, "triangle"));
    // The camera follows when it is known.
    annotation.orientation = Orientation{{}, job.parallel || job.scale_bar, job.unit};
    if (input.colors && !input.colors->classes.empty()) {
        annotation.title = input.colors->name;
        for (std::size_t i = 0; i < input.colors->classes.size(); ++i)
            annotation.legend.push_back({input.colors->scale.classes[i], with_minus(input.colors->classes[i])});
        if (input.colors->has_no_data) annotation.legend.push_back({input.colors->scale.no_data, "no data"});
        return annotation;
    }
    if (input.colors) {
        annotation.title = input.colors->name;
        annotation.scale = input.colors->scale;
        if (input.volume) annotation.opacity = input.volume->opacity;
        if (input.colors->has_no_data) annotation.no_data = "no data";
    } else if (surfaces.size() > 1) {
        annotation.title = input.field;
        std::vector<std::size_t> order(surfaces.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, std::greater(), [&](std::size_t i) { return surfaces[i].isovalue; }); // largest above
        for (const std::size_t i : order)
            annotation.legend.push_back({input.scene->scene().surfaces[i].color, with_minus(values[i])});
    }
    return annotation;
}

} // namespace isotet::jobs
