// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/assemble.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/solid.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::solid {

namespace {

constexpr std::size_t at_once = 1 << 14;

/// Arrays one after another, then `extra` tuples of which `tuple(i, k)` is component k.
template <class To, class Tuple>
Array joined(std::span<const Array> heads, std::size_t components, std::size_t extra, const Tuple& tuple) {
    std::size_t tuples = extra;
    for (const Array& head : heads) tuples += head.tuples();
    core::Buffer<To> out(tuples * components);
    To* to = out.data();
    for (const Array& head : heads) {
        head.visit([&](auto values) {
            core::parallel_each(values.size(), at_once, [&](std::size_t i) { to[i] = static_cast<To>(values[i]); });
        });
        to += head.size();
    }
    core::parallel_each(extra, at_once, [&](std::size_t i) {
        for (std::size_t k = 0; k < components; ++k) to[i * components + k] = static_cast<To>(tuple(i, k));
    });
    return std::move(out).to_array(components);
}

/// The same with tuples of `source`, those with the numbers `rows`.
template <class To>
Array joined_rows(std::span<const Array> heads, const Array& source, const std::vector<std::uint64_t>& rows) {
    const std::size_t components = source.components();
    return source.visit([&](auto values) {
        return joined<To>(heads, components, rows.size(),
                          [&](std::size_t i, std::size_t k) { return values[rows[i] * components + k]; });
    });
}

/// As surfaces carry an array of points: float32 where it and the precision are.
Array joined_of_points(std::span<const Array> heads, const Array& source, const std::vector<std::uint64_t>& rows,
                       Precision precision) {
    if (source.type() == ScalarType::float32 && precision == Precision::float32)
        return joined_rows<float>(heads, source, rows);
    return joined_rows<double>(heads, source, rows);
}

/// An array of cells in its own type.
Array joined_of_cells(std::span<const Array> heads, const Array& source, const std::vector<std::uint64_t>& rows) {
    return source.visit([&](auto values) {
        using Value = std::remove_cvref_t<decltype(values[0])>;
        return joined_rows<Value>(heads, source, rows);
    });
}

/// Values at apexes behind those at the other vertices.
Array with_apexes(Array values, const Cap& cap, const Array& source) {
    if (cap.apexes.empty()) return values;
    const std::size_t components = values.components();
    return values.visit([&](auto typed) {
        using Value = std::remove_cvref_t<decltype(typed[0])>;
        return joined<Value>(
            std::span<const Array>(&values, 1), components, cap.apexes.size(), [&](std::size_t i, std::size_t k) {
                return cap.apexes[i].value(
                    [&](std::uint32_t vertex) { return static_cast<double>(typed[vertex * components + k]); },
                    [&](std::uint64_t point) { return source.at(point, k); });
            });
    });
}

Array with_positions(Array values, const Cap& cap) {
    if (cap.apexes.empty()) return values;
    return values.visit([&](auto typed) {
        using Value = std::remove_cvref_t<decltype(typed[0])>;
        return joined<Value>(std::span<const Array>(&values, 1), 3, cap.apexes.size(),
                             [&](std::size_t i, std::size_t k) { return cap.apexes[i].position[k]; });
    });
}

/// What `member` says of each shell that has vertices.
template <class Member>
std::vector<Array> arrays_of(std::span<const Shell> shells, const Member& member) {
    std::vector<Array> out;
    for (const Shell& shell : shells)
        if (shell.surface.vertex_count() > 0) out.push_back(member(shell.surface));
    return out;
}

const Array& values_of(const std::vector<Field>& fields, std::string_view name) {
    return std::ranges::find(fields, name, &Field::name)->values;
}

Array triangles_of(std::span<const Shell> shells, const Cap& cap) {
    std::size_t count = cap.triangles.size();
    for (const Shell& shell : shells) count += shell.surface.triangle_count();
    core::Buffer<std::uint32_t> out(3 * count);
    std::uint32_t* to = out.data();
    std::uint32_t first_vertex = 0;
    for (const Shell& shell : shells) {
        const std::size_t triangles = shell.surface.triangle_count();
        if (triangles > 0) {
            const auto from = shell.surface.triangles.as<std::uint32_t>();
            core::parallel_each(triangles, at_once, [&](std::size_t i) {
                const std::uint32_t* in = &from[3 * i];
                const bool mirrored = shell.mirrored;
                to[3 * i] = first_vertex + in[0];
                to[3 * i + 1] = first_vertex + in[mirrored ? 2 : 1];
                to[3 * i + 2] = first_vertex + in[mirrored ? 1 : 2];
            });
        }
        to += 3 * triangles;
        first_vertex += static_cast<std::uint32_t>(shell.surface.vertex_count());
    }
    for (const auto& triangle : cap.triangles) to = std::copy(triangle.begin(), triangle.end(), to);
    return std::move(out).to_array(3);
}

Array part_numbers(std::size_t isosurface, std::size_t boundary) {
    std::vector<std::uint8_t> parts(isosurface + boundary, static_cast<std::uint8_t>(SolidPart::isosurface));
    std::fill(parts.begin() + static_cast<std::ptrdiff_t>(isosurface), parts.end(),
              static_cast<std::uint8_t>(SolidPart::boundary));
    return Array::own(std::move(parts));
}

bool is_whole_number(const Field& field) {
    const ScalarType type = field.values.type();
    return field.values.components() == 1 && type != ScalarType::float32 && type != ScalarType::float64;
}

/// Of the cap's triangles: the numbers of their patches, those of the 2D cells on them, and what these cells have of fields
/// of whole numbers.
void add_marks(const Cap& cap, std::size_t isosurface, const std::vector<Field>& fields, Surface& out) {
    const auto add = [&](std::string name, const auto& value) {
        std::vector<std::int64_t> values(isosurface + cap.marks.size(), -1);
        for (std::size_t i = 0; i < cap.marks.size(); ++i) values[isosurface + i] = value(cap.marks[i]);
        std::erase_if(out.cell_fields, [&](const Field& field) { return field.name == name; });
        out.cell_fields.push_back({std::move(name), Array::own(std::move(values))});
    };
    if (std::ranges::any_of(cap.marks, [](const FaceMark& mark) { return mark.patch >= 0; }))
        add("patch", [](const FaceMark& mark) { return mark.patch; });
    if (std::ranges::none_of(cap.marks, [](const FaceMark& mark) { return mark.cell >= 0; })) return;
    add("patch_cell", [](const FaceMark& mark) { return mark.cell; });
    for (const Field& field : fields)
        if (is_whole_number(field))
            field.values.visit([&](auto numbers) {
                add("patch_" + field.name, [&](const FaceMark& mark) {
                    return mark.cell < 0 ? std::int64_t{-1}
                                         : static_cast<std::int64_t>(numbers[static_cast<std::size_t>(mark.cell)]);
                });
            });
}

using Vector = std::array<double, 3>;

/// Calls use(i, range, f(a, b, c)) for the triangles i of [first, last) with their corners, ranges beside each other.
template <class F, class Use>
void for_triangles(const Surface& surface, std::size_t first, std::size_t last, const F& f, const Use& use) {
    if (first >= last) return;
    const auto triangles = surface.triangles.as<std::uint32_t>();
    surface.positions.visit([&](auto positions) {
        const auto at = [&](std::uint32_t vertex) -> Vector {
            return {static_cast<double>(positions[3 * vertex]), static_cast<double>(positions[3 * vertex + 1]),
                    static_cast<double>(positions[3 * vertex + 2])};
        };
        core::parallel_each((last - first + at_once - 1) / at_once, 1, [&](std::size_t range) {
            const std::size_t begin = first + range * at_once, end = std::min(last, begin + at_once);
            for (std::size_t i = begin; i < end; ++i)
                use(i, range, f(at(triangles[3 * i]), at(triangles[3 * i + 1]), at(triangles[3 * i + 2])));
        });
    });
}

/// In a fixed order.
template <class F>
double sum_over(const Surface& surface, std::size_t first, std::size_t last, const F& f) {
    std::vector<double> sums((last - first + at_once - 1) / at_once);
    for_triangles(surface, first, last, f, [&](std::size_t, std::size_t range, double value) { sums[range] += value; });
    double sum = 0;
    for (const double some : sums) sum += some;
    return sum;
}

Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross_product(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot_product(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double twice_the_area(const Vector& a, const Vector& b, const Vector& c) {
    const Vector normal = cross_product(difference(b, a), difference(c, a));
    return std::sqrt(dot_product(normal, normal));
}

} // namespace

Surface assemble(std::span<const Shell> shells, const Cap& cap, const ContourInput& input,
                 const std::vector<Field>& user_cell_fields, const ContourOptions& options) {
    Surface out;
    const auto positions = arrays_of(shells, [](const Surface& s) { return s.positions; });
    out.positions = with_positions(joined_of_points(positions, input.grid.points, cap.points, options.precision), cap);
    out.triangles = triangles_of(shells, cap);
    for (const Field& field : input.point_fields) {
        const auto heads = arrays_of(shells, [&](const Surface& s) { return values_of(s.point_fields, field.name); });
        out.point_fields.push_back(
            {field.name,
             with_apexes(joined_of_points(heads, field.values, cap.points, options.precision), cap, field.values)});
    }
    for (const Field& field : input.cell_fields) {
        const auto heads = arrays_of(shells, [&](const Surface& s) { return values_of(s.cell_fields, field.name); });
        out.cell_fields.push_back({field.name, joined_of_cells(heads, field.values, cap.cells)});
    }
    const std::size_t isosurface = out.triangles.tuples() - cap.triangles.size();
    if (!cap.marks.empty()) add_marks(cap, isosurface, user_cell_fields, out);
    out.cell_fields.push_back({"boundary", part_numbers(isosurface, cap.triangles.size())});
    if (options.edge_ends) {
        const auto ends = arrays_of(shells, [](const Surface& s) { return s.edge_ends; });
        const std::size_t more = cap.points.size() + cap.apexes.size();
        out.edge_ends = joined<std::int64_t>(ends, 2, more, [&](std::size_t i, std::size_t) {
            return i < cap.points.size() ? static_cast<std::int64_t>(cap.points[i]) : -1;
        });
        const auto weights = arrays_of(shells, [](const Surface& s) { return s.edge_weights; });
        const auto zero = [](std::size_t, std::size_t) { return 0; };
        out.edge_weights = options.precision == Precision::float32 ? joined<float>(weights, 1, more, zero)
                                                                   : joined<double>(weights, 1, more, zero);
    }
    if (options.source_cells) {
        const auto cells = arrays_of(shells, [](const Surface& s) { return s.source_cells; });
        out.source_cells =
            joined<std::int64_t>(cells, 1, cap.cells.size(), [&](std::size_t i, std::size_t) { return cap.cells[i]; });
    }
    return out;
}

double enclosed_volume(const Surface& surface) {
    if (surface.triangle_count() == 0) return 0;
    Vector middle; // a vertex near all others
    for (std::size_t axis = 0; axis < 3; ++axis)
        middle[axis] = surface.positions.at(surface.triangles.as<std::uint32_t>()[0], axis);
    return enclosed_volume(surface, middle);
}

double enclosed_volume(const Surface& surface, const std::array<double, 3>& middle) {
    return sum_over(surface, 0, surface.triangle_count(),
                    [&](const Vector& a, const Vector& b, const Vector& c) {
                        return dot_product(difference(a, middle),
                                           cross_product(difference(b, middle), difference(c, middle)));
                    }) /
           6;
}

double area_of(const Surface& surface, std::size_t first, std::size_t last) {
    return sum_over(surface, first, last, twice_the_area) / 2;
}

std::vector<double> areas_of(const Surface& surface, std::size_t first, std::size_t last) {
    std::vector<double> areas(last - first);
    for_triangles(surface, first, last, twice_the_area,
                  [&](std::size_t i, std::size_t, double value) { areas[i - first] = value / 2; });
    return areas;
}

} // namespace isotet::solid
