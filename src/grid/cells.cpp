// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell/curved_types.hpp"
#include "grid/cell_survey.hpp"

namespace isotet {

std::size_t Cells::count() const noexcept {
    if (!types.empty()) return types.tuples();
    if (!offsets.empty()) return offsets.tuples() - 1;
    const auto corners = static_cast<std::size_t>(core::corners_of(static_cast<std::uint8_t>(uniform_type)));
    return corners ? connectivity.tuples() / corners : 0;
}

namespace core {

namespace {

constexpr auto tetrahedron = static_cast<std::uint8_t>(CellType::tetrahedron);

} // namespace

WholeCell CellReader::whole(std::size_t cell) const {
    WholeCell out{*kind_of(type(cell)), {}};
    connectivity_.visit([&](const auto* corners) {
        corners += first(cell);
        for (std::size_t i = 0; i < corner_count(out.kind); ++i) out.corners[i] = widened(corners[i]);
    });
    order_as_kind(type(cell), out.corners);
    return out;
}

void CellReader::split(std::size_t cell, CellTets& out) const {
    if (is_contoured(type(cell))) out = split_cell(whole(cell));
}

Result<CellReader> CellReader::open(const Grid& grid) {
    const auto is_index = [](const Array& array) {
        return array.type() == ScalarType::int32 || array.type() == ScalarType::uint32 ||
               array.type() == ScalarType::int64 || array.type() == ScalarType::uint64;
    };
    const Cells& cells = grid.cells;
    if (!is_floating(grid.points.type()) || grid.points.components() != 3)
        return invalid_data(fmt::format("points are {} with {} components, but must be float32 or float64 with 3",
                                        name_of(grid.points.type()), grid.points.components()));
    if (!cells.connectivity.empty() && (!is_index(cells.connectivity) || cells.connectivity.components() != 1))
        return invalid_data(
            fmt::format("the connectivity is {} with {} components, but must be 32- or 64-bit integers with 1",
                        name_of(cells.connectivity.type()), cells.connectivity.components()));
    CellReader reader;
    reader.points_ = grid.points.tuples();
    reader.connectivity_ = IndexColumn(cells.connectivity);
    reader.connectivity_size_ = cells.connectivity.tuples();
    reader.uniform_type_ = static_cast<std::uint8_t>(cells.uniform_type);
    reader.uniform_corners_ = static_cast<std::uint64_t>(corners_of(reader.uniform_type_));
    if (!cells.types.empty()) {
        if (cells.types.type() != ScalarType::uint8 || cells.types.components() != 1)
            return invalid_data(
                fmt::format("the cell types are {}, but must be uint8 with 1 component", name_of(cells.types.type())));
        if (cells.offsets.empty())
            return invalid_data("there are cell types but no offsets, and cells of several types need offsets");
        reader.types_ = cells.types.as<std::uint8_t>().data();
    } else if (reader.uniform_corners_ == 0) {
        return invalid_data(fmt::format("all cells are of type {}, which cannot be contoured", reader.uniform_type_));
    }
    if (!cells.offsets.empty()) {
        if (!is_index(cells.offsets) || cells.offsets.components() != 1)
            return invalid_data(fmt::format("the offsets are {}, but must be 32- or 64-bit integers with 1 component",
                                            name_of(cells.offsets.type())));
        if (reader.types_ && cells.offsets.tuples() != cells.types.tuples() + 1)
            return invalid_data(fmt::format("there are {} offsets for {} cells, but there must be one more than cells",
                                            cells.offsets.tuples(), cells.types.tuples()));
        reader.offsets_ = IndexColumn(cells.offsets);
        reader.has_offsets_ = true;
    } else if (reader.connectivity_size_ % reader.uniform_corners_ != 0) {
        return invalid_data(fmt::format("the connectivity has {} entries, but must be a multiple of {} for {} cells",
                                        reader.connectivity_size_, reader.uniform_corners_,
                                        name_of_cell_type(reader.uniform_type_)));
    }
    reader.count_ = cells.count();
    reader.only_tets_ = !reader.types_ && reader.uniform_type_ == tetrahedron;
    const auto check_fields = [&](const std::vector<Field>& fields, std::size_t expected,
                                  const char* what) -> Result<void> {
        for (const Field& field : fields)
            if (field.values.tuples() != expected)
                return Error{ErrorCode::invalid_data,
                             fmt::format("{} field '{}' has {} tuples, but the grid has {} {}s", what, field.name,
                                         field.values.tuples(), expected, what)};
        return {};
    };
    if (auto ok = check_fields(grid.point_fields, reader.points_, "point"); !ok) return ok.error();
    if (auto ok = check_fields(grid.cell_fields, reader.count_, "cell"); !ok) return ok.error();
    return reader;
}

namespace {

enum class Fault { none, offset_falls, offset_end, corner_count, point_range, coordinate };

/// Whether a point that cells use may be contoured.
template <class T>
bool is_sound(const T* point) {
    constexpr auto limit = static_cast<T>(0x1p91);
    return std::abs(point[0]) < limit && std::abs(point[1]) < limit && std::abs(point[2]) < limit; // false for NaN
}

bool is_sound(const Grid& grid, std::uint64_t point) {
    return grid.points.type() == ScalarType::float32 ? is_sound(grid.points.as<float>().data() + 3 * point)
                                                     : is_sound(grid.points.as<double>().data() + 3 * point);
}

} // namespace

bool all_points_are_sound(const Grid& grid) {
    std::atomic<bool> sound{true};
    parallel_ranges(grid.points.tuples(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        bool all = true;
        for (std::size_t point = begin; point < end; ++point) all &= is_sound(grid, point);
        if (!all) sound.store(false, std::memory_order_relaxed);
    });
    return sound;
}

namespace {

/// 0: any number.
constexpr std::uint64_t expected_corners(std::uint8_t type) {
    const std::uint64_t sides = prism_sides(type);
    return sides ? 2 * sides : static_cast<std::uint64_t>(corners_of(type));
}

/// By type.
constexpr auto expected_corners_of_types = [] {
    std::array<std::uint8_t, 256> all{};
    for (std::size_t type = 0; type < all.size(); ++type)
        all[type] = static_cast<std::uint8_t>(expected_corners(static_cast<std::uint8_t>(type)));
    return all;
}();

/// Whether the cells [begin, end) lie inside the connectivity, each with as many corners as its type has.
bool all_have_their_corners(const CellReader& cells, std::size_t begin, std::size_t end) {
    if (!cells.has_offsets() || begin == end) return true; // open() has looked at the whole
    return cells.offsets().visit([&](const auto* offsets) {
        bool sound =
            widened(offsets[begin]) <= widened(offsets[end]) && widened(offsets[end]) <= cells.connectivity_size();
        for (std::size_t cell = begin; cell < end; ++cell) {
            const std::uint64_t expected = expected_corners_of_types[cells.type(cell)];
            const std::uint64_t first = widened(offsets[cell]), last = widened(offsets[cell + 1]);
            sound &= first <= last && (expected == 0 || last - first == expected);
        }
        return sound;
    });
}

/// Whether the cells [begin, end), one after another in the connectivity, use only points that are there.
bool all_corners_are_points(const CellReader& cells, std::size_t begin, std::size_t end) {
    if (begin == end) return true;
    return cells.connectivity().visit([&](const auto* corners) {
        using Number = std::make_unsigned_t<std::remove_cvref_t<decltype(*corners)>>;
        constexpr Number highest_bit = Number{1} << (std::numeric_limits<Number>::digits - 1);
        if (cells.points() == 0 || cells.points() > highest_bit) return false; // then each cell is looked at
        const auto last = static_cast<Number>(cells.points() - 1);
        Number bits = 0; // a number that is too large, or the difference to one, has the highest bit
        const std::uint64_t last_corner = cells.first(end - 1) + cells.corners(end - 1);
        for (std::uint64_t i = cells.first(begin); i < last_corner; ++i) {
            const auto corner = static_cast<Number>(corners[i]);
            bits |= corner | (last - corner);
        }
        return (bits & highest_bit) == 0;
    });
}

Fault fault_of(const Grid& grid, const CellReader& cells, std::size_t cell) {
    const std::uint64_t begin = cells.first(cell);
    const std::uint64_t corners = cells.corners(cell);
    if (corners > cells.connectivity_size() || begin > cells.connectivity_size() - corners)
        return begin + corners < begin ? Fault::offset_falls : Fault::offset_end;
    const std::uint64_t expected = expected_corners(cells.type(cell));
    if (expected == 0) return Fault::none;
    if (corners != expected) return Fault::corner_count;
    for (std::uint64_t k = 0; k < corners; ++k) {
        const std::uint64_t point = cells.corner(begin + k);
        if (point >= cells.points()) return Fault::point_range;
        if (!is_sound(grid, point)) return Fault::coordinate;
    }
    return Fault::none;
}

/// What a cell with so many corners may have been meant to be, since some programs write curved cells as linear ones.
std::string hint_at_curved(std::uint8_t type, std::uint64_t corners) {
    if (type == static_cast<std::uint8_t>(CellType::voxel)) return ""; // there is no curved one
    for (const CurvedType& curved : curved_types)
        if (curved.kind == kind_of(type) && curved.nodes == corners)
            return fmt::format("; a {} has {}: its cell type is {}, not {}", name_of_cell_type(curved.type), corners,
                               curved.type, type);
    return "";
}

std::string describe(Fault fault, const Grid& grid, const CellReader& cells, std::size_t cell) {
    const std::uint64_t begin = cells.first(cell), corners = cells.corners(cell);
    const std::string who = cells.only_tets()
                                ? fmt::format("tets[{}]", cell)
                                : fmt::format("cells[{}] ({})", cell, name_of_cell_type(cells.type(cell)));
    if (fault == Fault::offset_falls)
        return fmt::format("{} starts at {} and ends at {}, but offsets must not fall", who,
                           static_cast<std::int64_t>(begin), static_cast<std::int64_t>(begin + corners));
    if (fault == Fault::offset_end)
        return fmt::format("{} has corners {} to {}, but the connectivity has {} entries", who,
                           static_cast<std::int64_t>(begin), static_cast<std::int64_t>(begin + corners),
                           cells.connectivity_size());
    if (fault == Fault::corner_count)
        return fmt::format("{} has {} corners, but must have {}{}", who, corners, expected_corners(cells.type(cell)),
                           hint_at_curved(cells.type(cell), corners));
    for (std::uint64_t k = 0; k < corners; ++k) {
        const std::uint64_t point = cells.corner(begin + k);
        if (point >= cells.points()) {
            if (fault != Fault::point_range) continue;
            return fmt::format("{} has point {}, but the grid has {} points", who, static_cast<std::int64_t>(point),
                               cells.points());
        }
        for (std::size_t axis = 0; axis < 3 && fault == Fault::coordinate; ++axis)
            if (const double x = grid.points.at(point, axis); !(std::abs(x) < 0x1p91))
                return fmt::format(
                    "points[{}] has {} coordinate {}, but cells use the point, and coordinates must be finite and "
                    "below 2^91",
                    point, "xyz"[axis], x);
    }
    return who + " is broken";
}

} // namespace

bool all_are_sound(const Grid& grid, const CellReader& cells, std::size_t begin, std::size_t end,
                   bool points_are_sound) {
    if (points_are_sound && all_have_their_corners(cells, begin, end) && all_corners_are_points(cells, begin, end))
        return true;
    for (std::size_t cell = begin; cell < end; ++cell)
        if (fault_of(grid, cells, cell) != Fault::none) return false;
    return true;
}

Result<void> check_cells(const Grid& grid, const CellReader& cells, const Progress& progress) {
    if (grid.cells.offsets.tuples() > 0 && IndexColumn(grid.cells.offsets)[0] > cells.connectivity_size())
        return Error{ErrorCode::invalid_data,
                     fmt::format("the first offset is {}, but the connectivity has {} entries",
                                 IndexColumn(grid.cells.offsets)[0], cells.connectivity_size())};
    const bool points_are_sound = all_points_are_sound(grid);
    // The lowest broken cell is the one reported, whatever the threads do.
    std::atomic<std::size_t> lowest{std::numeric_limits<std::size_t>::max()};
    parallel_pieces(cells.count(), 1 << 14, progress, [&](std::size_t begin, std::size_t end) {
        if (begin > lowest.load(std::memory_order_relaxed)) return;
        if (points_are_sound && all_have_their_corners(cells, begin, end) && all_corners_are_points(cells, begin, end))
            return;
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (fault_of(grid, cells, cell) == Fault::none) continue;
            std::size_t seen = lowest.load(std::memory_order_relaxed);
            while (cell < seen && !lowest.compare_exchange_weak(seen, cell, std::memory_order_relaxed)) {}
            return;
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking the grid was cancelled"};
    if (const std::size_t cell = lowest.load(); cell < cells.count())
        return Error{ErrorCode::invalid_data, describe(fault_of(grid, cells, cell), grid, cells, cell)};
    return {};
}

Error nothing_to_contour(const Grid& grid, const CellReader& cells) {
    std::array<std::size_t, 256> counts{};
    for (std::size_t cell = 0; cell < cells.count(); ++cell) ++counts[cells.type(cell)];
    std::string list;
    for (std::size_t type = 0; type < counts.size(); ++type)
        if (counts[type])
            list += fmt::format("{}{} x {}", list.empty() ? "" : ", ", counts[type],
                                name_of_cell_type(static_cast<std::uint8_t>(type)));
    return {ErrorCode::invalid_data,
            fmt::format(
                "the grid with {} points has no cell that can be contoured ({}); tetrahedra, hexahedra, voxels, wedges "
                "and pyramids can{}",
                grid.points.tuples(), list.empty() ? "no cells at all" : list,
                counts[15] || counts[16] || (counts[42] && !grid.cells.faces.empty())
                    ? ", and polyhedra after linearize()"
                    : "")};
}

} // namespace core
} // namespace isotet
