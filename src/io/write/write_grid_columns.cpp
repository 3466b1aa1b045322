// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid as columns: offsets and types of uniform cells are made while they are written.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "io/write/write_formats.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
constexpr std::size_t grain = std::size_t{1} << 18U;

std::size_t corners_of_type(CellType type) {
    switch (type) {
    case CellType::tetrahedron: return 4;
    case CellType::pyramid: return 5;
    case CellType::wedge: return 6;
    case CellType::voxel:
    case CellType::hexahedron: break;
    }
    return 8;
}

/// The lowest index for which `bad` is true. Parallel.
template <class Test>
std::size_t first_where(std::size_t count, const Test& bad) {
    std::atomic<std::size_t> first{none};
    core::parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!bad(i)) continue;
            std::size_t known = first.load();
            while (i < known && !first.compare_exchange_weak(known, i)) {}
            return;
        }
    });
    return first;
}

Result<void> check_offsets(const Cells& cells) {
    return cells.offsets.visit([&](auto offsets) -> Result<void> {
        using Scalar = typename decltype(offsets)::value_type;
        if constexpr (std::is_integral_v<Scalar>) {
            const auto falls =
                first_where(offsets.size() - 1, [&](std::size_t i) { return offsets[i + 1] < offsets[i]; });
            if (falls != none) {
                return Error{ErrorCode::invalid_data, fmt::format("offsets[{}] is {} after {}: offsets may not fall",
                                                                  falls + 1, offsets[falls + 1], offsets[falls])};
            }
            const auto first = static_cast<std::uint64_t>(offsets.front()),
                       last = static_cast<std::uint64_t>(offsets.back());
            if (first > last || last > cells.connectivity.size()) { // first > last: it is negative
                return Error{ErrorCode::invalid_data,
                             fmt::format("offsets run from {} to {}, but the connectivity has {} entries",
                                         offsets.front(), offsets.back(), cells.connectivity.size())};
            }
        }
        return {};
    });
}

Result<void> check_cells(const Cells& cells, std::size_t points) {
    const Array &connectivity = cells.connectivity, &offsets = cells.offsets, &types = cells.types;
    const CellType uniform_type = cells.uniform_type;
    if (!connectivity.empty() && (!holds_indices(connectivity.type()) || connectivity.components() != 1)) {
        return invalid_argument(
            fmt::format("the connectivity is {} with {} components, not one of 32- or 64-bit integers",
                        name_of(connectivity.type()), connectivity.components()));
    }
    if (offsets.empty()) {
        if (!types.empty())
            return invalid_argument(fmt::format("the grid has {} cell types but no offsets", types.size()));
        if (connectivity.size() % corners_of_type(uniform_type) != 0) {
            return invalid_argument(fmt::format(
                "the connectivity has {} entries, not a multiple of {}, the corners of a {}", connectivity.size(),
                corners_of_type(uniform_type), name_of_cell_type(static_cast<std::uint8_t>(uniform_type))));
        }
    } else {
        if (!holds_indices(offsets.type()) || offsets.components() != 1) {
            return invalid_argument(
                fmt::format("the offsets are {} with {} components, not one of 32- or 64-bit integers",
                            name_of(offsets.type()), offsets.components()));
        }
        if (auto checked = check_offsets(cells); !checked) return checked;
    }
    if (!types.empty()) {
        if (types.type() != ScalarType::uint8 || types.size() + 1 != offsets.size()) {
            return invalid_argument(fmt::format(
                "the grid has {} cell types of {} for {} offsets: one uint8 a cell is needed, and one more offset",
                types.size(), name_of(types.type()), offsets.size()));
        }
        const auto values = types.as<std::uint8_t>();
        const auto lacks_faces = [&](std::size_t i) { return values[i] == core::polyhedron_type; };
        if (const auto at = cells.faces.empty() ? first_where(values.size(), lacks_faces) : none; at != none)
            return invalid_argument(
                fmt::format("cells[{}] is a polyhedron, whose faces are not known: it cannot be written", at));
    }
    if (const auto bad = first_bad_index(connectivity, points)) {
        return Error{ErrorCode::invalid_data,
                     fmt::format("connectivity[{}] is point {:.0f}, but the grid has {} points", *bad,
                                 connectivity.at(*bad), points)};
    }
    return {};
}

/// Shifted, so that they start at 0.
template <class To>
Column offsets_from(const Array& offsets, std::uint64_t start) {
    Column column{"offsets", scalar_type_of<To>(), offsets.size(), 1, {}};
    column.fill = [offsets, start](std::size_t begin, std::size_t end, std::byte* out) {
        offsets.visit([&](auto values) {
            auto* target = reinterpret_cast<To*>(out);
            for (std::size_t i = begin; i < end; ++i)
                *target++ = static_cast<To>(static_cast<std::uint64_t>(values[i]) - start);
        });
    };
    return column;
}

Column constant_types(std::uint8_t type, std::size_t count) {
    Column column{"types", ScalarType::uint8, count, 1, {}};
    column.fill = [type](std::size_t begin, std::size_t end, std::byte* out) { std::memset(out, type, end - begin); };
    return column;
}

Result<std::vector<Column>> field_columns(const std::vector<Field>& fields, std::string_view what, std::size_t tuples,
                                          std::vector<std::string>& notes) {
    std::vector<Column> columns;
    Names names;
    for (const auto& field : fields) {
        if (field.values.tuples() != tuples) {
            return invalid_argument(fmt::format("the {} field \"{}\" has {} tuples, not {}", what, field.name,
                                                field.values.tuples(), tuples));
        }
        columns.push_back(column_of(take_field_name(field.name, names, notes), field.values));
    }
    return columns;
}

/// Ends of the parts of `faces`: -1 where a cell has none, as VTK has it.
Column face_ends(const Array& offsets) {
    Column column{"faceoffsets", ScalarType::int64, offsets.size() - 1, 1, {}};
    column.fill = [offsets](std::size_t begin, std::size_t end, std::byte* out) {
        offsets.visit([&](auto values) {
            auto* target = reinterpret_cast<std::int64_t*>(out);
            for (std::size_t i = begin; i < end; ++i)
                *target++ = values[i] == values[i + 1]
                                ? -1
                                : static_cast<std::int64_t>(values[i + 1]) - static_cast<std::int64_t>(values[0]);
        });
    };
    return column;
}

std::uint64_t index_at(const Array& array, std::size_t i) {
    return array.visit([&](auto values) { return static_cast<std::uint64_t>(values[i]); });
}

} // namespace

std::uint64_t GridColumns::bytes() const {
    std::uint64_t sum = points.bytes() + connectivity.bytes() + offsets.bytes() + types.bytes();
    if (faces) sum += faces->bytes() + face_ends.bytes();
    for (const auto* list : {&point_fields, &cell_fields}) {
        for (const auto& column : *list) sum += column.bytes();
    }
    return sum;
}

Result<GridColumns> columns_of(const Grid& grid, std::vector<std::string>& notes) {
    const auto& cells = grid.cells;
    if (!is_floating(grid.points.type()) || (!grid.points.empty() && grid.points.components() != 3)) {
        return invalid_argument(fmt::format("the points are {} with {} components, not 3 floating ones",
                                            name_of(grid.points.type()), grid.points.components()));
    }
    const std::size_t points = grid.points.tuples();
    if (auto checked = check_cells(cells, points); !checked) return checked.error();
    if (!cells.faces.empty()) {
        const auto reader = core::CellReader::open(grid);
        if (!reader) return reader.error();
        if (auto checked = core::check_faces(grid, *reader, {}); !checked) return checked.error();
    }

    const bool uniform = cells.offsets.empty();
    const std::size_t corners = corners_of_type(cells.uniform_type);
    const std::uint64_t start = uniform ? 0 : index_at(cells.offsets, 0);
    const std::uint64_t used =
        uniform ? cells.connectivity.size() : index_at(cells.offsets, cells.offsets.size() - 1) - start;
    const bool narrow = fits_int32(std::max<std::uint64_t>(points, used));

    GridColumns columns;
    columns.cells = uniform ? static_cast<std::size_t>(used) / corners : cells.offsets.size() - 1;
    columns.points = column_of("Points", grid.points);
    columns.points.components = 3;
    const std::size_t size = size_of(cells.connectivity.type());
    const Array connectivity(cells.connectivity.type(),
                             static_cast<const std::byte*>(cells.connectivity.data()) + start * size,
                             static_cast<std::size_t>(used), 1, nullptr); // `grid` keeps it alive
    columns.connectivity = narrow ? converted<std::int32_t>("connectivity", connectivity)
                                  : converted<std::int64_t>("connectivity", connectivity);
    if (uniform) {
        columns.offsets =
            counting("offsets", narrow ? ScalarType::int32 : ScalarType::int64, columns.cells + 1, 0, corners);
    } else {
        columns.offsets = narrow ? offsets_from<std::int32_t>(cells.offsets, start)
                                 : offsets_from<std::int64_t>(cells.offsets, start);
    }
    columns.types = cells.types.empty() ? constant_types(static_cast<std::uint8_t>(cells.uniform_type), columns.cells)
                                        : column_of("types", cells.types);
    if (!cells.faces.empty()) {
        const std::uint64_t first = index_at(cells.face_offsets, 0), last = index_at(cells.face_offsets, columns.cells);
        const Array used_faces(cells.faces.type(),
                               static_cast<const std::byte*>(cells.faces.data()) + first * size_of(cells.faces.type()),
                               static_cast<std::size_t>(last - first), 1, nullptr);
        columns.faces =
            narrow ? converted<std::int32_t>("faces", used_faces) : converted<std::int64_t>("faces", used_faces);
        columns.face_ends = face_ends(cells.face_offsets);
    }
    auto point_fields = field_columns(grid.point_fields, "point", points, notes);
    if (!point_fields) return point_fields.error();
    auto cell_fields = field_columns(grid.cell_fields, "cell", columns.cells, notes);
    if (!cell_fields) return cell_fields.error();
    columns.point_fields = std::move(*point_fields);
    columns.cell_fields = std::move(*cell_fields);
    return columns;
}

} // namespace isotet::io
