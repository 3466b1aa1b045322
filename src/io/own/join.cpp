// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "core/buffer.hpp"
#include "io/own/common_type.hpp"
#include "io/own/escape.hpp"
#include "io/own/face_streams.hpp"
#include "io/own/join.hpp"
#include "io/own/point_numbers.hpp"

namespace isotet::io {
namespace {

constexpr int corners_of_uniform[] = {4, 8, 8, 6, 5}; // tetrahedron, voxel, hexahedron, wedge, pyramid

/// The corners of the cells of a grid, whatever the types of its arrays.
class CellView {
public:
    explicit CellView(const Cells& cells) : cells_(cells), count_(cells.count()) {
        uniform_corners_ = corners_of_uniform[static_cast<int>(cells.uniform_type) - 10];
    }
    std::size_t count() const { return count_; }
    std::uint8_t type(std::size_t cell) const {
        return cells_.types.empty() ? static_cast<std::uint8_t>(cells_.uniform_type)
                                    : cells_.types.as<std::uint8_t>()[cell];
    }
    std::int64_t begin(std::size_t cell) const {
        if (cells_.offsets.empty()) return static_cast<std::int64_t>(cell) * uniform_corners_;
        return cells_.offsets.visit([&](auto offsets) { return static_cast<std::int64_t>(offsets[cell]); });
    }

private:
    const Cells& cells_;
    std::size_t count_;
    int uniform_corners_;
};

std::optional<std::string> misfit(const Piece& piece) {
    const Cells& cells = piece.grid.cells;
    if (piece.grid.points.components() != 3) return "its points do not have three coordinates";
    if (cells.types.empty() && !cells.offsets.empty()) return "its cells have no types";
    if (!cells.offsets.empty() && cells.offsets.tuples() != cells.types.tuples() + 1)
        return fmt::format("it has {} cell types and {} offsets", cells.types.tuples(), cells.offsets.tuples());
    if (cells.types.size() > 0 && cells.types.type() != ScalarType::uint8) return "its cell types are not bytes";
    const std::size_t points = piece.grid.points.tuples(), count = cells.count();
    for (const Field& field : piece.grid.point_fields)
        if (field.values.tuples() != points)
            return fmt::format("its point field \"{}\" has {} values for {} points", escaped(field.name),
                               field.values.tuples(), points);
    for (const Field& field : piece.grid.cell_fields)
        if (field.values.tuples() != count)
            return fmt::format("its cell field \"{}\" has {} values for {} cells", escaped(field.name),
                               field.values.tuples(), count);
    if (!piece.point_ids.empty() && piece.point_ids.size() != points) return "it does not have one number a point";
    if (!piece.cell_ids.empty() && piece.cell_ids.size() != count) return "it does not have one number a cell";
    if (!piece.left_out.empty() && piece.left_out.size() != count) return "it does not have one ghost mark a cell";
    return std::nullopt;
}

/// For each piece the cells that stay; empty: all of them.
struct KeptCells {
    std::vector<std::vector<std::uint64_t>> cells;
    std::uint64_t ghosts = 0, repeated = 0;
};

KeptCells keep(const std::vector<Piece>& pieces) {
    KeptCells result;
    result.cells.resize(pieces.size());
    const bool has_ids = pieces.size() > 1 && std::all_of(pieces.begin(), pieces.end(), [](const Piece& p) {
                             return !p.cell_ids.empty() || p.grid.cells.count() == 0;
                         });
    std::unordered_map<std::uint64_t, std::size_t> owner; // global number -> the piece that had it first
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const Piece& piece = pieces[p];
        const std::size_t count = piece.grid.cells.count();
        std::vector<std::uint64_t> kept;
        kept.reserve(count);
        const auto ghost = [&](std::size_t cell) { return !piece.left_out.empty() && piece.left_out[cell] != 0; };
        const auto repeated = [&](std::uint64_t id) { return owner.try_emplace(id, p).first->second != p; };
        const auto choose = [&](auto id_of) {
            for (std::size_t cell = 0; cell < count; ++cell) {
                if (ghost(cell)) ++result.ghosts;
                else if (has_ids && repeated(id_of(cell))) ++result.repeated;
                else kept.push_back(cell);
            }
        };
        if (has_ids && count > 0)
            piece.cell_ids.visit(
                [&](auto ids) { choose([&](std::size_t cell) { return static_cast<std::uint64_t>(ids[cell]); }); });
        else if (!piece.left_out.empty()) choose([](std::size_t) { return std::uint64_t(0); });
        if (kept.size() != count && (has_ids || !piece.left_out.empty())) {
            if (kept.empty()) kept.push_back(std::numeric_limits<std::uint64_t>::max()); // none at all
            result.cells[p] = std::move(kept);
        }
    }
    return result;
}

/// The cells of piece p that stay, one after another, through `visit(cell)`.
template <class Visit>
void each_kept(const KeptCells& kept, std::size_t p, std::size_t count, Visit visit) {
    if (kept.cells[p].empty())
        for (std::size_t cell = 0; cell < count; ++cell) visit(cell);
    else
        for (const std::uint64_t cell : kept.cells[p])
            if (cell < count) visit(cell);
}

std::optional<std::string> append_cells(const Piece& piece, std::size_t p, const PointNumbers& numbers,
                                        const KeptCells& kept, std::vector<std::int64_t>& connectivity,
                                        std::vector<std::int64_t>& offsets, std::vector<std::uint8_t>& types,
                                        FaceStreams& faces) {
    const CellView cells(piece.grid.cells);
    if (const auto sound = check_face_streams(piece.grid.cells, piece.grid.points.tuples()); !sound)
        return sound.error().message;
    const auto size = static_cast<std::int64_t>(piece.grid.cells.connectivity.size());
    const std::uint64_t points = piece.grid.points.tuples();
    std::optional<std::string> problem;
    piece.grid.cells.connectivity.visit([&](auto corners) {
        each_kept(kept, p, cells.count(), [&](std::size_t cell) {
            const std::int64_t begin = cells.begin(cell), end = cells.begin(cell + 1);
            if (problem || begin < 0 || end < begin || end > size) {
                if (!problem) problem = fmt::format("cell {} has corners {} to {} of {}", cell, begin, end, size);
                return;
            }
            for (std::int64_t i = begin; i < end; ++i) {
                const auto point = static_cast<std::uint64_t>(corners[static_cast<std::size_t>(i)]);
                if (point >= points) {
                    problem = fmt::format("cell {} has point {}, but there are {} points", cell,
                                          corners[static_cast<std::size_t>(i)], points);
                    return;
                }
                connectivity.push_back(static_cast<std::int64_t>(numbers(p, point)));
            }
            offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
            types.push_back(cells.type(cell));
            faces.add_cell(piece.grid.cells, cell, [&](std::uint64_t point) { return numbers(p, point); });
        });
    });
    return problem;
}

struct Column {
    std::string name;
    ScalarType type = ScalarType::float64;
    std::size_t components = 1;
    std::size_t pieces = 0;           ///< how many have it
    std::size_t other_components = 0; ///< of a piece where they are not `components`; else 0
};

using Fields = std::vector<Field> Grid::*;

const Field* find(const std::vector<Field>& fields, const std::string& name) {
    for (const Field& field : fields)
        if (field.name == name) return &field;
    return nullptr;
}

/// Pieces without points or cells have no values: they do not count.
bool counts(const Piece& piece, Fields which) {
    return which == &Grid::point_fields ? piece.grid.points.tuples() > 0 : piece.grid.cells.count() > 0;
}

std::size_t count_filled(const std::vector<Piece>& pieces, Fields which) {
    return static_cast<std::size_t>(
        std::ranges::count_if(pieces, [&](const Piece& piece) { return counts(piece, which); }));
}

std::vector<Column> columns(const std::vector<Piece>& pieces, Fields which) {
    std::vector<Column> result;
    const std::size_t filled = count_filled(pieces, which);
    std::unordered_map<std::string, std::size_t> places;
    for (const Piece& piece : pieces) {
        if (filled > 0 && !counts(piece, which)) continue;
        for (const Field& field : piece.grid.*which) {
            const auto [place, is_new] = places.try_emplace(field.name, result.size());
            if (is_new) result.push_back({field.name, field.values.type(), field.values.components(), 0, 0});
            Column& column = result[place->second];
            ++column.pieces;
            column.type = common_type(column.type, field.values.type());
            if (column.components != field.values.components()) column.other_components = field.values.components();
        }
    }
    for (Column& column : result)
        if (column.pieces < filled) column.type = with_missing(column.type);
    return result;
}

/// Copies scalars of `size` bytes, tuple by tuple. `tuples_of(visit)` calls visit(tuple in the piece, tuple in the
/// result).
template <std::size_t size, class TuplesOf>
void copy_tuples(const std::byte* from, std::byte* to, std::size_t components, const TuplesOf& tuples_of) {
    tuples_of([&](std::size_t in_piece, std::size_t in_result) {
        for (std::size_t c = 0; c < components; ++c)
            std::memcpy(to + (in_result * components + c) * size, from + (in_piece * components + c) * size, size);
    });
}

/// Puts the tuples of a piece's field to their places in a column, whose type holds them.
template <class TuplesOf>
void place_tuples(const Array& field, const Column& column, void* to, const TuplesOf& tuples_of) {
    const std::size_t components = column.components;
    const bool converts = field.type() != column.type;
    core::Buffer<std::byte> converted(converts ? field.size() * size_of(column.type) : 0);
    if (converts) convert_scalars(field, column.type, converted.data());
    const auto* const bytes = converts ? converted.data() : static_cast<const std::byte*>(field.data());
    auto* const places = static_cast<std::byte*>(to);
    switch (size_of(column.type)) {
    case 1: return copy_tuples<1>(bytes, places, components, tuples_of);
    case 2: return copy_tuples<2>(bytes, places, components, tuples_of);
    case 4: return copy_tuples<4>(bytes, places, components, tuples_of);
    default: return copy_tuples<8>(bytes, places, components, tuples_of);
    }
}

/// `tuples` x `components` scalars: NaN, or 0 of integers, before `fill(data)` writes to them.
Array made_array(ScalarType type, std::size_t tuples, std::size_t components, const std::function<void(void*)>& fill) {
    return Array(type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) {
        T missing{};
        if constexpr (std::is_floating_point_v<T>) missing = std::numeric_limits<T>::quiet_NaN();
        std::vector<T> values(tuples * components, missing);
        fill(static_cast<void*>(values.data()));
        return Array::own(std::move(values), components);
    });
}

/// One field over all pieces. `tuples_of(p, visit)` calls visit(tuple in piece p, tuple in the result).
template <class TuplesOf>
Array joined_field(std::vector<Piece>& pieces, Fields which, const Column& column, std::size_t tuples,
                   const TuplesOf& tuples_of) {
    return made_array(column.type, tuples, column.components, [&](void* to) {
        for (std::size_t p = pieces.size(); p-- > 0;) // where points were joined the first piece's value stays
            if (const Field* field = find(pieces[p].grid.*which, column.name))
                place_tuples(field->values, column, to, [&](const auto& visit) { tuples_of(p, visit); });
    });
}

/// What was made of fields that not all pieces have alike; one note for all that are in as many pieces.
void tell_columns(const std::vector<Column>& columns, std::size_t pieces, std::string_view kind, ReadResult& result) {
    std::map<std::size_t, std::vector<std::string>> in_some; // by pieces
    for (const Column& column : columns) {
        if (column.other_components > 0)
            leave_out(result.info, {fmt::format("{} field", kind), column.name,
                                    fmt::format("it has {} component{} in one piece and {} in another",
                                                column.components, column.components == 1 ? "" : "s",
                                                column.other_components)});
        else if (column.pieces < pieces) in_some[column.pieces].push_back(fmt::format("\"{}\"", escaped(column.name)));
    }
    for (const auto& [count, names] : in_some)
        result.notes.push_back(fmt::format("{} field{} {} {} in {} of {} pieces only: NaN in the others", kind,
                                           names.size() == 1 ? "" : "s", fmt::join(names, ", "),
                                           names.size() == 1 ? "is" : "are", count, pieces));
}

/// Points that were joined though their values differ: a field that jumps from piece to piece.
void note_jumps(const std::vector<Piece>& pieces, const PointNumbers& numbers, const Field& joined,
                std::vector<std::string>& notes) {
    const std::size_t components = joined.values.components();
    std::size_t jumps = 0;
    for (const auto& [piece, point] : numbers.joined_points) {
        const Field* field = find(pieces[piece].grid.point_fields, joined.name);
        bool same = true;
        for (std::size_t c = 0; field && c < components; ++c) {
            const double a = field->values.at(point, c), b = joined.values.at(numbers(piece, point), c);
            same = same && (a == b || (a != a && b != b));
        }
        if (!same) ++jumps;
    }
    if (jumps > 0)
        notes.push_back(
            fmt::format("point field \"{}\" differs in {} points that were joined: the first piece's values "
                        "were taken; --keep-pieces keeps them apart",
                        escaped(joined.name), jumps));
}

template <class TuplesOf, class Look>
std::vector<Field> joined_fields(std::vector<Piece>& pieces, Fields which, std::string_view kind, std::size_t tuples,
                                 const TuplesOf& tuples_of, const Look& look, ReadResult& whole) {
    std::vector<Field> result;
    const std::vector<Column> all = columns(pieces, which);
    tell_columns(all, count_filled(pieces, which), kind, whole);
    for (const Column& column : all) {
        if (column.other_components == 0) {
            result.push_back({column.name, joined_field(pieces, which, column, tuples, tuples_of)});
            look(result.back());
        }
        for (Piece& piece : pieces)
            std::erase_if(piece.grid.*which, [&](const Field& field) { return field.name == column.name; });
    }
    return result;
}

PointNumbers number_points(const std::vector<Piece>& pieces, bool by_coordinates, std::vector<std::string>& notes) {
    if (pieces.size() == 1) return number_one_after_another(pieces);
    const bool have_ids = std::all_of(pieces.begin(), pieces.end(), [](const Piece& piece) {
        return piece.point_ids.size() == piece.grid.points.tuples();
    });
    if (have_ids) {
        if (auto numbers = number_by_ids(pieces)) {
            notes.push_back(fmt::format("{} pieces joined by global point numbers: {} points were merged",
                                        pieces.size(), numbers->joined));
            return std::move(*numbers);
        }
        notes.push_back("the global point numbers of the pieces mean different places and were not used");
    }
    if (by_coordinates) {
        auto numbers = number_by_coordinates(pieces);
        notes.push_back(fmt::format("{} pieces joined by equal coordinates: {} points were merged; --keep-pieces keeps "
                                    "them apart",
                                    pieces.size(), numbers.joined));
        return numbers;
    }
    notes.push_back(
        fmt::format("{} pieces without global point numbers lie side by side: surfaces have seams between them "
                    "since points with equal coordinates were to be kept apart (--keep-pieces)",
                    pieces.size()));
    return number_one_after_another(pieces);
}

/// Narrow indices where they fit; no types and offsets where all cells are tetrahedra.
Cells compact(std::vector<std::int64_t> connectivity, std::vector<std::int64_t> offsets,
              std::vector<std::uint8_t> types) {
    Cells cells;
    if (std::all_of(types.begin(), types.end(), [](std::uint8_t type) { return type == 10; }) &&
        connectivity.size() == 4 * types.size()) {
        bool uniform = true;
        for (std::size_t i = 0; i < offsets.size(); ++i)
            uniform = uniform && offsets[i] == static_cast<std::int64_t>(4 * i);
        if (uniform) {
            cells.connectivity = Array::own(std::move(connectivity));
            return cells;
        }
    }
    cells.connectivity = Array::own(std::move(connectivity));
    cells.offsets = Array::own(std::move(offsets));
    cells.types = Array::own(std::move(types));
    return cells;
}

} // namespace

Result<ReadResult> join(Loaded loaded, bool by_coordinates) {
    ReadResult result;
    result.info = std::move(loaded.info);
    result.step = loaded.step;
    result.notes = std::move(loaded.notes);
    std::vector<Piece>& pieces = loaded.pieces;
    if (std::ranges::all_of(pieces, [](const Piece& piece) { return piece.grid.cells.count() == 0; }))
        for (const Piece& piece : pieces)
            if (!piece.flat.empty()) return broken(piece.name, piece.flat + " has no cells with a volume");
    for (Piece& piece : pieces) {
        if (piece.grid.cells.count() == 0) piece.grid.cells = {}; // offsets of no cells need no types
        if (auto problem = misfit(piece))
            return Error{ErrorCode::invalid_data, fmt::format("piece \"{}\": {}", escaped(piece.name), *problem)};
    }
    if (pieces.size() > 1) std::erase_if(pieces, [](const Piece& piece) { return piece.grid.points.tuples() == 0; });

    const KeptCells kept = keep(pieces);
    const bool all_kept =
        std::all_of(kept.cells.begin(), kept.cells.end(), [](const auto& cells) { return cells.empty(); });
    if (kept.ghosts > 0) result.notes.push_back(fmt::format("{} ghost or blanked cells were left out", kept.ghosts));
    if (kept.repeated > 0)
        result.notes.push_back(fmt::format("{} cells that an earlier piece has, too, were left out", kept.repeated));
    if (pieces.empty()) { // none has a point
        result.grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
        return result;
    }
    if (pieces.size() == 1 && all_kept) {
        result.grid = std::move(pieces.front().grid);
        result.cells_in_file = pieces.front().cells_in_file;
        return result;
    }

    const PointNumbers numbers = number_points(pieces, by_coordinates, result.notes);
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    FaceStreams faces;
    std::vector<std::size_t> first_cell;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        first_cell.push_back(types.size());
        if (auto problem = append_cells(pieces[p], p, numbers, kept, connectivity, offsets, types, faces))
            return Error{ErrorCode::invalid_data, fmt::format("piece \"{}\": {}", escaped(pieces[p].name), *problem)};
    }
    const std::size_t cell_count = types.size();
    const auto points_of = [&](std::size_t p, auto visit) {
        const std::size_t points = pieces[p].grid.points.tuples();
        for (std::size_t i = 0; i < points; ++i) visit(i, numbers(p, i));
    };
    const auto cells_of = [&](std::size_t p, auto visit) {
        std::size_t next = first_cell[p];
        each_kept(kept, p, pieces[p].grid.cells.count(), [&](std::size_t cell) { visit(cell, next++); });
    };
    result.grid.cell_fields =
        joined_fields(pieces, &Grid::cell_fields, "cell", cell_count, cells_of, [](const Field&) {}, result);
    result.grid.cells = compact(std::move(connectivity), std::move(offsets), std::move(types));
    std::move(faces).give_to(result.grid.cells);
    for (Piece& piece : pieces) piece.grid.cells = Cells();
    result.grid.point_fields = joined_fields(
        pieces, &Grid::point_fields, "point", numbers.count, points_of,
        [&](const Field& field) { note_jumps(pieces, numbers, field, result.notes); }, result);
    // The coordinates, as one more field.
    for (Piece& piece : pieces) piece.grid.point_fields.push_back({"points", piece.grid.points});
    const Column coordinates = columns(pieces, &Grid::point_fields).front();
    result.grid.points = joined_field(pieces, &Grid::point_fields, coordinates, numbers.count, points_of);
    return result;
}

} // namespace isotet::io
