// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_same_cells.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t corners_of_uniform_cells[] = {4, 8, 8, 6, 5}; // tetrahedron, voxel, hexahedron, wedge, pyramid

/// The corners of each cell, ascending.
class SortedCorners {
public:
    explicit SortedCorners(const Cells& cells)
        : cells_(cells), uniform_(corners_of_uniform_cells[static_cast<std::size_t>(cells.uniform_type) - 10]) {}

    /// Nothing where offsets leave the connectivity.
    std::optional<std::vector<std::uint64_t>> of(std::size_t cell) const {
        std::uint64_t begin = cell * uniform_, end = begin + uniform_;
        if (!cells_.offsets.empty()) {
            begin = number(cells_.offsets, cell);
            end = number(cells_.offsets, cell + 1);
        }
        if (begin > end || end > cells_.connectivity.size()) return std::nullopt;
        std::vector<std::uint64_t> corners(end - begin);
        for (std::uint64_t i = begin; i < end; ++i) corners[i - begin] = number(cells_.connectivity, i);
        std::ranges::sort(corners);
        return corners;
    }

private:
    static std::uint64_t number(const Array& values, std::size_t at) {
        return values.visit([&](auto numbers) { return static_cast<std::uint64_t>(numbers[at]); });
    }

    const Cells& cells_;
    std::size_t uniform_;
};

std::uint64_t hash_of(const std::vector<std::uint64_t>& corners) {
    std::uint64_t hash = corners.size();
    for (const std::uint64_t corner : corners) hash = (hash ^ corner) * 0x9e3779b97f4a7c15ULL, hash ^= hash >> 29U;
    return hash;
}

/// For each cell of `part` that of `whole` with the same corners; nothing where one has none.
std::optional<std::vector<std::size_t>> cells_in(const Cells& whole, const Cells& part) {
    if (part.count() > whole.count()) return std::nullopt;
    const SortedCorners of_whole(whole), of_part(part);
    std::unordered_multimap<std::uint64_t, std::size_t> places;
    std::vector<std::size_t> found(part.count());
    bool in_order = true; // often: no table is needed
    for (std::size_t cell = 0; in_order && cell < part.count(); ++cell) {
        const auto corners = of_part.of(cell);
        in_order = corners && corners == of_whole.of(cell);
        found[cell] = cell;
    }
    if (in_order) return found;
    places.reserve(whole.count());
    for (std::size_t cell = 0; cell < whole.count(); ++cell)
        if (const auto corners = of_whole.of(cell)) places.emplace(hash_of(*corners), cell);
    for (std::size_t cell = 0; cell < part.count(); ++cell) {
        const auto corners = of_part.of(cell);
        if (!corners) return std::nullopt;
        auto [at, end] = places.equal_range(hash_of(*corners));
        std::optional<std::size_t> lowest;
        for (; at != end; ++at)
            if (of_whole.of(at->second) == corners && (!lowest || at->second < *lowest)) lowest = at->second;
        if (!lowest) return std::nullopt;
        found[cell] = *lowest;
    }
    return found;
}

/// Values at other places, NaN elsewhere; integers become float64 where some are missing.
Array placed(const Array& values, const std::vector<std::size_t>& places, std::size_t count) {
    const std::size_t components = values.components();
    std::vector<bool> has(count, false);
    for (const std::size_t place : places) has[place] = true;
    const bool all = std::ranges::all_of(has, [](bool there) { return there; });
    return values.visit([&]<class T>(std::span<const T> from) {
        const auto fill = [&]<class To>(To missing) {
            std::vector<To> to(count * components, missing);
            for (std::size_t i = 0; i < places.size(); ++i)
                for (std::size_t c = 0; c < components; ++c)
                    to[places[i] * components + c] = static_cast<To>(from[i * components + c]);
            return Array::own(std::move(to), components);
        };
        if constexpr (std::is_floating_point_v<T>) return fill(std::numeric_limits<T>::quiet_NaN());
        else return all ? fill(T{}) : fill(std::numeric_limits<double>::quiet_NaN());
    });
}

bool has_field(const std::vector<Field>& fields, const std::string& name) {
    return std::ranges::find(fields, name, &Field::name) != fields.end();
}

/// Files that state a mesh again for each function have the same coordinates under other names.
bool have_same_points(const NamedPiece& a, const NamedPiece& b) {
    if (a.points == b.points) return true;
    const Array &left = a.piece.grid.points, &right = b.piece.grid.points;
    return left.type() == right.type() && left.tuples() == right.tuples() && left.components() == right.components() &&
           (left.empty() || std::memcmp(left.data(), right.data(), left.bytes()) == 0);
}

/// Values in the middle of edges belong to all cells, in their order.
bool fit_edges(const NamedPiece& whole, const NamedPiece& part, const std::vector<std::size_t>& places) {
    if (!whole.edges && !part.edges) return true;
    if (whole.piece.grid.cells.count() != places.size()) return false;
    for (std::size_t cell = 0; cell < places.size(); ++cell)
        if (places[cell] != cell) return false;
    return true;
}

/// False where a field of the part is one of the whole already.
bool take_fields(Piece& whole, Piece& part, const std::vector<std::size_t>& places) {
    for (const Field& field : part.grid.cell_fields)
        if (has_field(whole.grid.cell_fields, field.name)) return false;
    for (const Field& field : part.grid.point_fields)
        if (has_field(whole.grid.point_fields, field.name)) return false;
    const std::size_t count = whole.grid.cells.count();
    for (const Field& field : part.grid.cell_fields)
        whole.grid.cell_fields.push_back({field.name, placed(field.values, places, count)});
    for (Field& field : part.grid.point_fields) whole.grid.point_fields.push_back(std::move(field));
    return true;
}

} // namespace

void take_fields_of_same_cells(std::vector<NamedPiece>& pieces, std::vector<std::string>& notes) {
    for (std::size_t p = 1; p < pieces.size();) {
        bool taken = false;
        for (std::size_t w = 0; w < p && !taken; ++w) {
            if (!have_same_points(pieces[w], pieces[p])) continue;
            const auto places = cells_in(pieces[w].piece.grid.cells, pieces[p].piece.grid.cells);
            taken = places && fit_edges(pieces[w], pieces[p], *places) &&
                    take_fields(pieces[w].piece, pieces[p].piece, *places);
            if (!taken) continue;
            if (!pieces[w].edges) pieces[w].edges = pieces[p].edges;
            notes.push_back(fmt::format("the cells of grid \"{}\" are cells of \"{}\": they are one grid",
                                        escaped(pieces[p].name), escaped(pieces[w].name)));
        }
        if (taken) pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(p));
        else ++p;
    }
}

} // namespace isotet::io::confined
