// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/until_cancelled.hpp"
#include "check/components.hpp"
#include "check/mesh.hpp"
#include "grid/surface_rows.hpp"

namespace isotet {

namespace checking {
namespace {

/// A component of a field, as it is at a triangle.
struct Column {
    const Array* values;
    std::size_t component;
    bool of_points;

    double at(std::uint64_t triangle, const Corners& corners) const {
        if (!of_points) return values->at(triangle, component);
        double sum = 0;
        for (const std::uint64_t corner : corners) sum += values->at(corner, component);
        return sum / 3;
    }
};

std::vector<Column> columns_of(const Surface& surface, std::vector<std::string>& names) {
    std::vector<Column> out;
    const auto add = [&](const std::vector<Field>& fields, bool of_points) {
        for (const Field& field : fields)
            for (std::size_t k = 0; k < field.values.components(); ++k) {
                names.push_back(field.values.components() == 1 ? field.name : fmt::format("{}:{}", field.name, k));
                out.push_back({&field.values, k, of_points});
            }
    };
    add(surface.point_fields, true);
    add(surface.cell_fields, false);
    return out;
}

/// Sums over some triangles of a part.
struct PartSums {
    double area = 0, six_volumes = 0;
    core::Point moment{};
    core::Point lower{}, upper{};
    std::vector<double> columns;

    void add(const PartSums& other) {
        area += other.area;
        six_volumes += other.six_volumes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            moment[axis] += other.moment[axis];
            lower[axis] = std::min(lower[axis], other.lower[axis]);
            upper[axis] = std::max(upper[axis], other.upper[axis]);
        }
        for (std::size_t i = 0; i < columns.size(); ++i) columns[i] += other.columns[i];
    }
};

PartSums no_sums(std::size_t columns) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    PartSums out;
    out.lower.fill(infinity);
    out.upper.fill(-infinity);
    out.columns.resize(columns);
    return out;
}

core::Point minus(const core::Point& a, const core::Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
core::Point cross_of(const core::Point& a, const core::Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// `base`   a place near the part: volumes are relative to it
void add_triangle(const Mesh& mesh, std::uint64_t triangle, const core::Point& base, std::span<const Column> columns,
                  PartSums& sums) {
    const Corners corners = mesh.corners(triangle);
    const core::Point a = mesh.position(corners[0]), b = mesh.position(corners[1]), c = mesh.position(corners[2]);
    const core::Point normal = cross_of(minus(b, a), minus(c, a));
    const double area = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]) / 2;
    const core::Point from_base = minus(a, base);
    sums.area += area;
    sums.six_volumes += from_base[0] * normal[0] + from_base[1] * normal[1] + from_base[2] * normal[2];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sums.moment[axis] += area * ((a[axis] - base[axis]) + (b[axis] - base[axis]) + (c[axis] - base[axis])) / 3;
        for (const core::Point& p : {a, b, c}) {
            sums.lower[axis] = std::min(sums.lower[axis], p[axis]);
            sums.upper[axis] = std::max(sums.upper[axis], p[axis]);
        }
    }
    for (std::size_t i = 0; i < columns.size(); ++i) sums.columns[i] += area * columns[i].at(triangle, corners);
}

/// Triangles sorted by component, and where each component's begin.
struct ByComponent {
    std::vector<std::uint64_t> triangles, first;
};

ByComponent sort_by_component(std::span<const std::uint32_t> component_of, std::size_t components) {
    ByComponent out;
    out.first.resize(components + 1);
    for (const std::uint32_t component : component_of) ++out.first[component + 1];
    std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
    out.triangles.resize(component_of.size());
    std::vector<std::uint64_t> next(out.first.begin(), out.first.end() - 1);
    for (std::uint64_t i = 0; i < component_of.size(); ++i) out.triangles[next[component_of[i]]++] = i;
    return out;
}

SurfacePart measured_part(const Mesh& mesh, std::span<const std::uint64_t> triangles, std::span<const Column> columns,
                          const Progress& progress) {
    constexpr std::size_t at_once = 1 << 14;
    const core::Point base = mesh.position(mesh.corners(triangles[0])[0]);
    std::vector<PartSums> sums((triangles.size() + at_once - 1) / at_once, no_sums(columns.size()));
    core::each_until_cancelled(sums.size(), 1, progress, [&](std::size_t i) {
        const std::size_t end = std::min(triangles.size(), (i + 1) * at_once);
        for (std::size_t k = i * at_once; k < end; ++k) add_triangle(mesh, triangles[k], base, columns, sums[i]);
    });
    for (std::size_t i = 1; i < sums.size(); ++i) sums[0].add(sums[i]);
    SurfacePart part;
    part.triangles = triangles.size();
    part.area = sums[0].area;
    part.volume = sums[0].six_volumes / 6;
    part.lower = sums[0].lower;
    part.upper = sums[0].upper;
    const double weight = part.area > 0 ? 1 / part.area : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) part.centre[axis] = base[axis] + sums[0].moment[axis] * weight;
    for (const double sum : sums[0].columns) part.means.push_back(sum * weight);
    return part;
}

/// 1 for each component with an edge that is not used equally often in both directions.
std::vector<std::uint8_t> open_components(const Mesh& mesh, std::span<const std::uint32_t> component_of,
                                          std::size_t components, const Progress& progress) {
    struct Edge {
        std::uint64_t low, high;
        std::int32_t uses;
        std::uint32_t component;
    };
    std::vector<Edge> edges(3 * component_of.size());
    core::each_until_cancelled(component_of.size(), 1 << 14, progress, [&](std::size_t i) {
        const Corners c = mesh.corners(i);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t from = c[k], to = c[(k + 1) % 3];
            edges[3 * i + k] = {std::min(from, to), std::max(from, to), from < to ? 1 : -1, component_of[i]};
        }
    });
    const auto before = [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; };
    core::sort_until_cancelled(progress, before,
                               [&](const auto& compare) { tbb::parallel_sort(edges.begin(), edges.end(), compare); });
    std::vector<std::uint8_t> out(components);
    for (std::size_t begin = 0, end = 0; begin < edges.size() && !progress.cancelled(); begin = end) {
        std::int32_t uses = 0;
        for (end = begin; end < edges.size() && !before(edges[begin], edges[end]); ++end) uses += edges[end].uses;
        if (uses != 0) out[edges[begin].component] = 1;
    }
    return out;
}

/// Components by their area, largest first: the place of each.
std::vector<std::uint32_t> ranks_by_area(const std::vector<SurfacePart>& parts) {
    std::vector<std::uint32_t> order(parts.size()), rank(parts.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return parts[a].area > parts[b].area; });
    for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
    return rank;
}

Result<SurfaceParts> parts_of(const Surface& surface, const Progress& progress) {
    const Result<Mesh> opened = Mesh::open(surface);
    if (!opened) return opened.error();
    const Mesh& mesh = *opened;
    const Error stopped{ErrorCode::cancelled, "finding the parts of a surface was cancelled"};
    const Components<std::uint64_t> components(mesh, Collapsed::some_part, progress);
    if (progress.cancelled()) return stopped;
    if (components.count() > std::numeric_limits<std::uint32_t>::max())
        return invalid_data(fmt::format("the surface has {} parts, but must have fewer than 2^32", components.count()));
    std::vector<std::uint32_t> component_of(mesh.triangles());
    core::each_until_cancelled(component_of.size(), 1 << 14, progress, [&](std::size_t i) {
        component_of[i] = static_cast<std::uint32_t>(components.of(mesh.corners(i)[0]));
    });
    if (progress.cancelled()) return stopped;
    const auto count = static_cast<std::size_t>(components.count());
    const ByComponent sorted = sort_by_component(component_of, count);
    SurfaceParts out;
    const std::vector<Column> columns = columns_of(surface, out.fields);
    std::vector<SurfacePart> parts(count);
    core::each_until_cancelled(count, 64, progress, [&](std::size_t i) {
        const auto triangles =
            std::span(sorted.triangles).subspan(sorted.first[i], sorted.first[i + 1] - sorted.first[i]);
        parts[i] = measured_part(mesh, triangles, columns, progress);
    });
    const std::vector<std::uint8_t> open = open_components(mesh, component_of, count, progress);
    for (std::size_t i = 0; i < count; ++i) parts[i].closed = !open[i];
    std::vector<std::uint8_t> used(mesh.vertex_count());
    for (std::uint64_t i = 0; i < mesh.triangles(); ++i) {
        if (i % (1 << 16) == 0 && progress.cancelled()) return stopped;
        for (const std::uint64_t vertex : mesh.corners(i))
            if (!std::exchange(used[vertex], std::uint8_t{1})) ++parts[component_of[i]].vertices;
    }
    const std::vector<std::uint32_t> rank = ranks_by_area(parts);
    out.parts.resize(count);
    for (std::size_t i = 0; i < count; ++i) out.parts[rank[i]] = std::move(parts[i]);
    core::each_until_cancelled(component_of.size(), 1 << 14, progress,
                               [&](std::size_t i) { component_of[i] = rank[component_of[i]]; });
    if (progress.cancelled()) return stopped;
    out.numbers = Array::own(std::move(component_of));
    return out;
}

Result<void> check_same_surface(const Surface& surface, const SurfaceParts& parts) {
    if (parts.numbers.tuples() == surface.triangle_count()) return {};
    return invalid_argument(fmt::format("the parts are of a surface of {} triangles, but this one has {}",
                                        parts.numbers.tuples(), surface.triangle_count()));
}

} // namespace
} // namespace checking

Result<SurfaceParts> find_parts(const Surface& surface, const Run& run) {
    return core::carry_out("finding the parts of a surface", run,
                           [&](const Progress& progress) { return checking::parts_of(surface, progress); });
}

Result<std::vector<std::uint64_t>> parts_touching(const Surface& surface, const SurfaceParts& parts,
                                                  const Region& region) {
    if (auto same = checking::check_same_surface(surface, parts); !same) return same.error();
    if (!(region.lower <= region.upper))
        return invalid_argument(fmt::format("the region has values of '{}' from {} to {}, but these must not descend",
                                            region.field, region.lower, region.upper));
    const auto field = std::ranges::find(surface.cell_fields, region.field, &Field::name);
    if (field == surface.cell_fields.end())
        return invalid_argument(fmt::format("the surface has no cell field '{}'", region.field));
    const auto numbers = parts.numbers.as<std::uint32_t>();
    std::vector<std::uint8_t> touches(parts.parts.size());
    field->values.visit([&](auto typed) {
        const std::size_t components = field->values.components();
        for (std::size_t i = 0; i < typed.size(); ++i) {
            const auto value = static_cast<double>(typed[i]);
            if (value >= region.lower && value <= region.upper) touches[numbers[i / components]] = 1;
        }
    });
    std::vector<std::uint64_t> out;
    for (std::uint64_t part = 0; part < touches.size(); ++part)
        if (touches[part]) out.push_back(part);
    return out;
}

Result<Surface> keep_parts(const Surface& surface, const SurfaceParts& parts, const std::vector<std::uint64_t>& kept,
                           const Run& run) {
    return core::carry_out("keeping parts of a surface", run, [&](const Progress&) -> Result<Surface> {
        if (auto same = checking::check_same_surface(surface, parts); !same) return same.error();
        std::vector<std::uint8_t> keep(parts.parts.size());
        for (const std::uint64_t part : kept) {
            if (part >= keep.size())
                return invalid_argument(fmt::format("part {} is asked for, but there are {}", part, keep.size()));
            keep[part] = 1;
        }
        Surface numbered = surface;
        std::erase_if(numbered.cell_fields, [](const Field& field) { return field.name == "part"; });
        numbered.cell_fields.push_back({"part", parts.numbers});
        if (surface.triangle_count() == 0) return numbered;
        if (const auto mesh = checking::Mesh::open(surface); !mesh) return mesh.error();
        const auto numbers = parts.numbers.as<std::uint32_t>();
        std::vector<std::uint64_t> triangles;
        for (std::uint64_t i = 0; i < numbers.size(); ++i)
            if (keep[numbers[i]]) triangles.push_back(i);
        if (triangles.size() == numbers.size()) return numbered;
        return core::with_triangles(numbered, triangles);
    });
}

} // namespace isotet
