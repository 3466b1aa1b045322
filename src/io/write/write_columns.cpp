// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/write/write_columns.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/write/write_names.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t index_grain = std::size_t{1} << 18U;

/// An error sentence if an array is not what the surface says it is; empty if it fits.
std::string misfit(std::string_view name, const Array& array, std::size_t tuples, std::size_t components) {
    if (array.tuples() == tuples && array.components() == components) return {};
    return fmt::format("the surface's {} has {} tuples of {}, not {} of {}", name, array.tuples(), array.components(),
                       tuples, components);
}

Result<void> check_shapes(const Surface& surface) {
    const std::size_t vertices = surface.vertex_count(), triangles = surface.triangle_count();
    if (!is_floating(surface.positions.type())) {
        return invalid_argument(
            fmt::format("the surface's positions are {}, not floating", name_of(surface.positions.type())));
    }
    if (triangles && !holds_indices(surface.triangles.type())) {
        return invalid_argument(fmt::format("the surface's triangles are {}, not 32- or 64-bit integers",
                                            name_of(surface.triangles.type())));
    }
    for (const auto* numbers : {&surface.edge_ends, &surface.source_cells}) {
        if (!numbers->empty() && is_floating(numbers->type())) {
            return invalid_argument(
                fmt::format("the surface's edge ends or source cells are {}, not integers", name_of(numbers->type())));
        }
    }
    struct Part {
        std::string_view name;
        const Array* array;
        std::size_t tuples, components;
    };
    std::vector<Part> parts;
    if (vertices) parts.push_back({"positions", &surface.positions, vertices, 3});
    if (triangles) parts.push_back({"triangles", &surface.triangles, triangles, 3});
    if (surface.normals_kind != Normals::none) {
        const bool of_triangles = surface.normals_kind == Normals::face;
        if (!is_floating(surface.normals.type())) return invalid_argument("the surface's normals are not floating");
        if (const std::size_t tuples = of_triangles ? triangles : vertices; tuples) {
            parts.push_back({"normals", &surface.normals, tuples, 3});
        }
    }
    if (!surface.edge_ends.empty()) parts.push_back({"edge ends", &surface.edge_ends, vertices, 2});
    if (!surface.edge_weights.empty()) parts.push_back({"edge weights", &surface.edge_weights, vertices, 1});
    if (!surface.source_cells.empty()) parts.push_back({"source cells", &surface.source_cells, triangles, 1});
    for (const auto& field : surface.point_fields) {
        parts.push_back({field.name, &field.values, vertices, field.values.components()});
    }
    for (const auto& field : surface.cell_fields) {
        parts.push_back({field.name, &field.values, triangles, field.values.components()});
    }
    for (const auto& part : parts) {
        if (auto message = misfit(part.name, *part.array, part.tuples, part.components); !message.empty())
            return invalid_argument(message);
    }
    return {};
}

} // namespace

Column column_of(std::string name, const Array& array) {
    Column column{std::move(name), array.type(), array.tuples(), array.components(), {}};
    column.fill = [array](std::size_t begin, std::size_t end, std::byte* out) {
        const std::size_t tuple = array.components() * size_of(array.type());
        if (end > begin)
            std::memcpy(out, static_cast<const std::byte*>(array.data()) + begin * tuple, (end - begin) * tuple);
    };
    return column;
}

Column counting(std::string name, ScalarType type, std::size_t count, std::uint64_t start, std::uint64_t step) {
    Column column{std::move(name), type, count, 1, {}};
    column.fill = [type, start, step](std::size_t begin, std::size_t end, std::byte* out) {
        const auto fill = [&](auto* target) {
            using Scalar = std::remove_pointer_t<decltype(target)>;
            for (std::size_t i = begin; i < end; ++i) *target++ = static_cast<Scalar>(start + i * step);
        };
        if (type == ScalarType::int32) fill(reinterpret_cast<std::int32_t*>(out));
        else fill(reinterpret_cast<std::int64_t*>(out));
    };
    return column;
}

std::string take_field_name(const std::string& name, Names& taken, std::vector<std::string>& notes) {
    auto result = take_name(name, taken);
    if (result != name) {
        notes.push_back(fmt::format("the field \"{}\" is written as \"{}\": {}", printable_name(name),
                                    printable_name(result), name.empty() ? "a name is needed" : "the name is taken"));
    }
    return result;
}

bool fits_int32(std::uint64_t count) noexcept { return count <= std::numeric_limits<std::int32_t>::max(); }

bool holds_indices(ScalarType type) noexcept { return !is_floating(type) && size_of(type) >= 4; }

std::optional<std::size_t> first_bad_index(const Array& indices, std::uint64_t limit) {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::atomic<std::size_t> first{none};
    indices.visit([&](auto values) {
        using Scalar = typename decltype(values)::value_type;
        if constexpr (std::is_integral_v<Scalar>) {
            core::parallel_ranges(values.size(), index_grain, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    // A negative index becomes a huge one.
                    if (static_cast<std::uint64_t>(values[i]) < limit) continue;
                    std::size_t known = first.load();
                    while (i < known && !first.compare_exchange_weak(known, i)) {}
                    return;
                }
            });
        }
    });
    if (first == none) return std::nullopt;
    return first.load();
}

std::uint64_t SurfaceColumns::bytes() const {
    std::uint64_t sum = positions.bytes() + triangles.bytes();
    for (const auto* column : {&point_normals, &cell_normals}) {
        if (*column) sum += (*column)->bytes();
    }
    for (const auto* list : {&edges, &point_fields, &cell_fields, &field_data}) {
        for (const auto& column : *list) sum += column.bytes();
    }
    return sum;
}

std::array<double, 3> position_of(const Surface& surface, std::uint64_t vertex) {
    return surface.positions.visit([&](auto values) {
        std::array<double, 3> position{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            position[axis] = static_cast<double>(values[3 * vertex + axis]);
        }
        return position;
    });
}

Result<SurfaceColumns> columns_of(const Surface& surface, std::vector<std::string>& notes) {
    if (auto shapes = check_shapes(surface); !shapes) return shapes.error();
    if (const auto bad = first_bad_index(surface.triangles, surface.vertex_count())) {
        return Error{ErrorCode::invalid_data,
                     fmt::format("triangles[{}] has vertex {:.0f}, but the surface has {} vertices", *bad / 3,
                                 surface.triangles.at(*bad / 3, *bad % 3), surface.vertex_count())};
    }
    SurfaceColumns columns;
    columns.positions = column_of("Points", surface.positions);
    columns.positions.components = 3;
    columns.triangles = fits_int32(std::max<std::uint64_t>(surface.vertex_count(), 3 * surface.triangle_count()))
                            ? converted<std::int32_t>("connectivity", surface.triangles)
                            : converted<std::int64_t>("connectivity", surface.triangles);
    columns.triangles.components = 3;
    Names point_names, cell_names;
    if (are_of_vertices(surface.normals_kind)) {
        columns.point_normals = column_of(take_name("Normals", point_names), surface.normals);
        columns.point_normals->components = 3;
    }
    if (surface.normals_kind == Normals::face) {
        columns.cell_normals = column_of(take_name("Normals", cell_names), surface.normals);
        columns.cell_normals->components = 3;
    }
    // An empty surface, too, tells that it was extracted with edge ends.
    if (!surface.edge_ends.empty() || surface.edge_ends.components() == 2) {
        columns.edges.push_back(converted<std::int64_t>(take_name("edge_ends", point_names), surface.edge_ends));
    }
    if (!surface.edge_weights.empty()) {
        columns.edges.push_back(column_of(take_name("edge_weights", point_names), surface.edge_weights));
    }
    if (!surface.source_cells.empty()) {
        columns.cell_fields.push_back(
            converted<std::int64_t>(take_name("source_cell", cell_names), surface.source_cells));
    }
    for (const auto& field : surface.point_fields) {
        columns.point_fields.push_back(column_of(take_field_name(field.name, point_names, notes), field.values));
    }
    for (const auto& field : surface.cell_fields) {
        columns.cell_fields.push_back(column_of(take_field_name(field.name, cell_names, notes), field.values));
    }
    return columns;
}

} // namespace isotet::io
