// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/sheet.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "render/check_drawing.hpp"
#include "render/color/color_places.hpp"
#include "render/mesh_arrays.hpp"

namespace isotet::render {

namespace {

constexpr std::size_t vertex_grain = std::size_t{1} << 12;
constexpr double farthest_beside = 1 << 20; ///< samples; products of places then fit 64 bits

Result<void> take_values(Sheet& sheet, const SurfaceColors& colors, const MeshArrays& mesh) {
    if (Result<void> fits = check_count(colors.values.tuples(), mesh.vertices, mesh.triangle_count, colors.association);
        !fits)
        return fits;
    Result<core::Buffer<float>> places =
        color_places(colors.values, colors.values.tuples(), [](std::uint64_t i) { return i; }, colors.scale);
    if (!places) return places.error();
    sheet.values = *std::move(places);
    sheet.table = color_table(colors.scale);
    sheet.coloring = colors.association == Association::cell ? Coloring::by_triangle : Coloring::by_vertex;
    sheet.log_factor = log_factor_of(colors.scale);
    sheet.no_data = linear_light(colors.scale.no_data);
    return {};
}

/// Both ends of a line as a rectangle of its width, in vertices 0 to 3.
void widen_line(PlacedVertex a, PlacedVertex b, double half_width, double lift, PlacedVertex* rectangle,
                FixedPoint* fixed, const Sight& sight) {
    // What lies behind the eye has no place in the picture: the line ends where it gets there.
    const double nearest = 1e-5 * std::max(a.w, b.w);
    const auto mixed = [](const PlacedVertex& from, const PlacedVertex& to, double part) {
        PlacedVertex vertex = from;
        vertex.x += (to.x - from.x) * part;
        vertex.y += (to.y - from.y) * part;
        vertex.w += (to.w - from.w) * part;
        for (std::size_t axis = 0; axis < 3; ++axis)
            vertex.place[axis] += (to.place[axis] - from.place[axis]) * static_cast<float>(part);
        return vertex;
    };
    if (a.w < nearest) a = mixed(b, a, (b.w - nearest) / (b.w - a.w));
    if (b.w < nearest) b = mixed(a, b, (a.w - nearest) / (a.w - b.w));
    const double dx = b.x / b.w - a.x / a.w, dy = b.y / b.w - a.y / a.w, length = std::sqrt(dx * dx + dy * dy);
    const double along_x = length > 0 ? dx / length * half_width : half_width,
                 along_y = length > 0 ? dy / length * half_width : 0;
    for (int corner = 0; corner < 4; ++corner) {
        const bool at_end = corner == 1 || corner == 2, left = corner < 2;
        PlacedVertex vertex = at_end ? b : a;
        const double end = at_end ? 1 : -1, side = left ? 1 : -1;
        vertex.x += (end * along_x - side * along_y) * vertex.w;
        vertex.y += (end * along_y + side * along_x) * vertex.w;
        const double z = sight.z.at({vertex.place[0], vertex.place[1], vertex.place[2]});
        fixed[corner] = fixed_point(vertex.x, vertex.y, z < 0 ? z : std::max(z - lift * vertex.w, 0.0), vertex.w);
        rectangle[corner] = vertex;
    }
}

} // namespace

FixedPoint fixed_point(double x, double y, double z, double w) {
    const double reach = farthest_beside * w;
    if (!(w > 0) || !(z >= 0) || !(z <= w) || !(std::abs(x) <= reach) || !(std::abs(y) <= reach))
        return {out_of_view, 0, 0};
    const auto fixed = [&](double at) { return static_cast<std::int32_t>(std::lrint(at / w * fixed_one)); };
    return {fixed(x), fixed(y), static_cast<float>(z / w)};
}

PlacedVertex Screen::placed(const std::array<float, 3>& place) const {
    const Vector point{place[0], place[1], place[2]};
    PlacedVertex vertex;
    vertex.place = place;
    vertex.w = sight.w.at(point);
    vertex.x = (sight.x.at(point) + vertex.w) * (0.5 * width * samples);
    vertex.y = (sight.y.at(point) + vertex.w) * (0.5 * height * samples);
    return vertex;
}

FixedPoint Screen::fixed(const PlacedVertex& vertex) const {
    return fixed_point(vertex.x, vertex.y, sight.z.at({vertex.place[0], vertex.place[1], vertex.place[2]}), vertex.w);
}

Result<Sheet> sheet_of(const DrawnSurface& drawn, const Space& space, const Screen& screen) {
    if (Result<void> right = check_opacity(drawn.opacity); !right) return right.error();
    if (!drawn.triangles)
        return invalid_argument("a surface in a device's memory, but the CPU draws what is in the machine's");
    Result<MeshArrays> mesh = MeshArrays::of(*drawn.triangles);
    if (!mesh) return mesh.error();
    Sheet sheet;
    if (drawn.values)
        if (Result<void> taken = take_values(sheet, *drawn.values, *mesh); !taken) return taken.error();
    sheet.color = linear_light(drawn.color);
    sheet.translucent = drawn.opacity < 1;
    sheet.log_transparency = static_cast<float>(std::log2(1 - std::min(drawn.opacity, 0.999)));
    const std::array<double, 3> origin = space.place(mesh->origin);
    const auto scale = static_cast<float>(space.scale());
    std::array<float, 3> offset{};
    for (std::size_t axis = 0; axis < 3; ++axis) offset[axis] = static_cast<float>(origin[axis]);
    sheet.vertices = core::Buffer<PlacedVertex>(mesh->vertices);
    sheet.fixed = core::Buffer<FixedPoint>(mesh->vertices);
    core::parallel_each(mesh->vertices, vertex_grain, [&](std::size_t i) {
        std::array<float, 3> place{};
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = mesh->positions[3 * i + axis] * scale + offset[axis];
        sheet.vertices[i] = screen.placed(place);
        sheet.fixed[i] = screen.fixed(sheet.vertices[i]);
    });
    sheet.triangles = std::move(mesh->triangles);
    sheet.normals = std::move(mesh->normals);
    return sheet;
}

Result<Sheet> sheet_of(const DrawnLines& lines, const Space& space, const Screen& screen) {
    if (Result<void> right = check_lines(lines); !right) return right.error();
    Sheet sheet;
    sheet.lit = false;
    sheet.color = linear_light(lines.color);
    const std::size_t count = lines.lines.size();
    sheet.vertices = core::Buffer<PlacedVertex>(4 * count);
    sheet.fixed = core::Buffer<FixedPoint>(4 * count);
    sheet.triangles = core::Buffer<std::uint32_t>(6 * count);
    core::parallel_each(count, vertex_grain, [&](std::size_t i) {
        std::array<PlacedVertex, 2> ends;
        for (std::size_t end = 0; end < 2; ++end) {
            const std::array<double, 3> place = space.place(lines.lines[i][end]);
            ends[end] = screen.placed(
                {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])});
        }
        widen_line(ends[0], ends[1], lines.width / 2 * screen.samples, lines.lift, sheet.vertices.data() + 4 * i,
                   sheet.fixed.data() + 4 * i, screen.sight);
        constexpr std::array<std::uint32_t, 6> corners{0, 1, 2, 0, 2, 3};
        for (std::size_t k = 0; k < 6; ++k) sheet.triangles[6 * i + k] = static_cast<std::uint32_t>(4 * i) + corners[k];
    });
    return sheet;
}

} // namespace isotet::render
