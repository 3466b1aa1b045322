// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/joined_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/common_type.hpp"
#include "io/pieces/join/joined_cells.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t tuples_at_once = std::size_t{1} << 15;

using Fields = std::vector<Field> Grid::*;

struct JoinedColumn {
    std::string name;
    ScalarType type = ScalarType::float64;
    std::size_t components = 1;
    std::size_t pieces = 0;           ///< how many have it
    std::size_t other_components = 0; ///< of a piece where they are not `components`; else 0
    bool has_singles = false;         ///< some piece has it as float32
    bool missing = false;             ///< some piece has values, but not these
};

const Field* find(const std::vector<Field>& fields, const std::string& name) {
    for (const Field& field : fields)
        if (field.name == name) return &field;
    return nullptr;
}

/// Pieces without points or cells have no values: they do not count.
using Filled = std::vector<bool>;

std::vector<JoinedColumn> columns_of(const std::vector<Piece>& pieces, Fields which, const Filled& filled) {
    std::vector<JoinedColumn> result;
    const auto all = static_cast<std::size_t>(std::ranges::count(filled, true));
    std::unordered_map<std::string, std::size_t> places;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        if (all > 0 && !filled[p]) continue;
        for (const Field& field : pieces[p].grid.*which) {
            const ScalarType type = field.values.type();
            const auto [place, is_new] = places.try_emplace(field.name, result.size());
            if (is_new) result.push_back({field.name, type, field.values.components(), 0, 0, false});
            JoinedColumn& column = result[place->second];
            ++column.pieces;
            column.type = common_type(column.type, type);
            if (column.components != field.values.components()) column.other_components = field.values.components();
            column.has_singles = column.has_singles || type == ScalarType::float32;
        }
    }
    for (JoinedColumn& column : result) {
        column.missing = column.pieces < all;
        if (column.missing) column.type = with_missing(column.type);
    }
    return result;
}

/// What was made of fields that not all pieces have alike; one note for all that are in as many pieces.
void tell_columns(const std::vector<JoinedColumn>& columns, std::size_t pieces, std::string_view kind,
                  ReadResult& whole) {
    std::map<std::size_t, std::vector<std::string>> in_some; // by pieces
    for (const JoinedColumn& column : columns) {
        if (column.other_components > 0)
            leave_out(whole.info,
                      {fmt::format("{} field", kind), column.name,
                       fmt::format("it has {} component{} in one piece and {} in another", column.components,
                                   column.components == 1 ? "" : "s", column.other_components)});
        else if (column.missing) in_some[column.pieces].push_back(fmt::format("\"{}\"", escaped(column.name)));
    }
    for (const auto& [count, names] : in_some)
        whole.notes.push_back(fmt::format("{} field{} {} {} in {} of {} pieces only: NaN in the others", kind,
                                          names.size() == 1 ? "" : "s", fmt::join(names, ", "),
                                          names.size() == 1 ? "is" : "are", count, pieces));
}

/// Puts tuples [begin, end) of a piece to their places, as To. `place_of(tuple)` says where; PieceNumbers::none: nowhere.
template <class To, class From, class PlaceOf>
void put(const From* from, To* to, std::size_t components, std::uint64_t begin, std::uint64_t end,
         const PlaceOf& place_of) {
    for (std::uint64_t i = begin; i < end; ++i) {
        const std::uint64_t place = place_of(i);
        if (place == PieceNumbers::none) continue;
        for (std::size_t c = 0; c < components; ++c)
            to[place * components + c] = static_cast<To>(from[i * components + c]);
    }
}

/// The same for points, in runs.
template <class To, class From>
void put(const From* from, To* to, std::size_t components, std::uint64_t begin, std::uint64_t end,
         const PieceNumbers& numbers) {
    numbers.each_run(begin, end, [&](std::uint64_t point, std::uint64_t count, std::uint64_t number) {
        if (number == PieceNumbers::none) return;
        const From* const first = from + point * components;
        std::transform(first, first + count * components, to + number * components,
                       [](From value) { return static_cast<To>(value); });
    });
}

/// Makes an array of `tuples` x `components` scalars; `fill(values)` writes to it.
template <class Fill>
Result<Array> filled(const JoinedColumn& column, std::uint64_t tuples, bool missing, const Fill& fill) {
    const std::uint64_t bytes = tuples * column.components * size_of(column.type);
    if (auto enough = core::require_memory("joining the values of pieces", bytes); !enough) return enough.error();
    return Array(column.type, nullptr, 0, 1, nullptr).visit([&]<class To>(std::span<const To>) -> Result<Array> {
        core::Buffer<To> values(tuples * column.components);
        if (missing) {
            To none{};
            if constexpr (std::is_floating_point_v<To>) none = std::numeric_limits<To>::quiet_NaN();
            core::parallel_ranges(values.size(), tuples_at_once, [&](std::size_t begin, std::size_t end) {
                std::fill(values.begin() + begin, values.begin() + end, none);
            });
        }
        fill(values.data());
        return std::move(values).to_array(column.components);
    });
}

/// Calls with the values of an array as To, the type of the column.
template <class To, class Put>
void put_as(const Array& values, const Put& put_from) {
    constexpr ScalarType type = scalar_type_of<To>();
    if (values.type() == type) return put_from(values.as<To>().data());
    core::Buffer<To> converted(values.size());
    convert_scalars(values, type, reinterpret_cast<std::byte*>(converted.data()));
    put_from(converted.data());
}

/// The points of each piece among `joined`, which ascends.
template <class Visit>
void each_joined(const std::vector<Piece>& pieces, std::span<const JoinedPoint> joined, const Visit& visit) {
    std::uint64_t first = 0;
    std::size_t next = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const std::uint64_t end = first + pieces[p].grid.points.tuples();
        for (; next < joined.size() && joined[next].point < end; ++next) visit(p, joined[next].point - first);
        first = end;
    }
}

/// Where the piece whose value was taken has no data, another one's is taken, that of the first piece that has some.
template <class To>
void prefer_data(const std::vector<Piece>& pieces, Fields which, const JoinedColumn& column,
                 const PointNumbers& numbers, std::span<const JoinedPoint> joined, To* to) {
    if constexpr (std::is_floating_point_v<To>) {
        std::vector<const Array*> values;
        for (const Piece& piece : pieces) {
            const Field* const field = find(piece.grid.*which, column.name);
            values.push_back(field ? &field->values : nullptr);
        }
        each_joined(pieces, joined, [&](std::size_t p, std::uint64_t point) {
            To* const place = to + numbers.pieces[p](point) * column.components;
            for (std::size_t c = 0; values[p] && c < column.components; ++c)
                if (std::isnan(place[c])) place[c] = static_cast<To>(values[p]->at(point, c));
        });
    }
}

/// A joined column of points. From the last piece to the first: the first one's value stays where points are joined.
Result<Array> joined_at_points(const std::vector<Piece>& pieces, Fields which, const JoinedColumn& column,
                               const PointNumbers& numbers, std::span<const JoinedPoint> joined) {
    return filled(column, numbers.count, column.missing, [&]<class To>(To* to) {
        for (std::size_t p = pieces.size(); p-- > 0;)
            if (const Field* field = find(pieces[p].grid.*which, column.name))
                put_as<To>(field->values, [&](const auto* from) {
                    core::parallel_ranges(field->values.tuples(), tuples_at_once,
                                          [&](std::size_t begin, std::size_t end) {
                                              put(from, to, column.components, begin, end, numbers.pieces[p]);
                                          });
                });
        prefer_data(pieces, which, column, numbers, joined, to);
    });
}

Result<Array> joined_in_cells(const std::vector<Piece>& pieces, const JoinedColumn& column,
                              std::span<const std::uint64_t> first, std::uint64_t count) {
    return filled(column, count, column.missing, [&]<class To>(To* to) {
        for (std::size_t p = 0; p < pieces.size(); ++p)
            if (const Field* field = find(pieces[p].grid.cell_fields, column.name))
                put_as<To>(field->values, [&](const auto* from) {
                    const std::vector<std::uint8_t>& left_out = pieces[p].left_out;
                    each_kept_block(left_out, field->values.tuples(),
                                    [&](std::uint64_t begin, std::uint64_t end, std::uint64_t before) {
                                        std::uint64_t next = first[p] + before;
                                        put(from, to, column.components, begin, end, [&](std::uint64_t cell) {
                                            const bool kept = left_out.empty() || left_out[cell] == 0;
                                            return kept ? next++ : PieceNumbers::none;
                                        });
                                    });
                });
    });
}

Filled with_points(const std::vector<Piece>& pieces) {
    Filled filled;
    for (const Piece& piece : pieces) filled.push_back(piece.grid.points.tuples() > 0);
    return filled;
}

void drop(std::vector<Piece>& pieces, Fields which, const std::string& name) {
    for (Piece& piece : pieces)
        std::erase_if(piece.grid.*which, [&](const Field& field) { return field.name == name; });
}

/// Points that were joined though their values differ by more than rounding: a field that jumps from piece to piece.
std::uint64_t count_jumps(const std::vector<Piece>& pieces, const PointNumbers& numbers,
                          std::span<const JoinedPoint> joined, const JoinedColumn& column, const Array& whole) {
    constexpr double roundings = 16;
    const std::size_t components = column.components;
    std::vector<const Array*> values;
    for (const Piece& piece : pieces) {
        const Field* field = find(piece.grid.point_fields, column.name);
        values.push_back(field ? &field->values : nullptr);
    }
    double largest = 0;
    each_joined(pieces, joined, [&](std::size_t p, std::uint64_t point) {
        for (std::size_t c = 0; values[p] && c < components; ++c) {
            const double value = std::abs(values[p]->at(point, c));
            if (std::isfinite(value)) largest = std::max(largest, value);
        }
    });
    const double rounding =
        is_floating(column.type) ? roundings * largest * (column.has_singles ? 0x1p-23 : 0x1p-52) : 0;
    std::uint64_t jumps = 0;
    each_joined(pieces, joined, [&](std::size_t p, std::uint64_t point) {
        bool same = true;
        for (std::size_t c = 0; values[p] && c < components; ++c) {
            const double a = values[p]->at(point, c), b = whole.at(numbers.pieces[p](point), c);
            same = same && (a == b || a != a || std::abs(a - b) <= rounding); // no data is no other value
        }
        jumps += !same;
    });
    return jumps;
}

} // namespace

Result<std::vector<Field>> join_point_fields(std::vector<Piece>& pieces, const PointNumbers& numbers,
                                             std::span<const JoinedPoint> joined, ReadResult& whole,
                                             const Progress& progress) {
    std::vector<Field> result;
    const Filled filled = with_points(pieces);
    const std::vector<JoinedColumn> columns = columns_of(pieces, &Grid::point_fields, filled);
    tell_columns(columns, static_cast<std::size_t>(std::ranges::count(filled, true)), "point", whole);
    for (const JoinedColumn& column : columns) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "joining pieces was cancelled"};
        if (column.other_components == 0) {
            auto values = joined_at_points(pieces, &Grid::point_fields, column, numbers, joined);
            if (!values) return values.error();
            if (const std::uint64_t jumps = count_jumps(pieces, numbers, joined, column, *values); jumps > 0)
                whole.notes.push_back(
                    fmt::format("point field \"{}\" differs in {} points that were joined: the value of one "
                                "piece was taken; --keep-pieces keeps them apart",
                                escaped(column.name), jumps));
            result.push_back({column.name, *std::move(values)});
        }
        drop(pieces, &Grid::point_fields, column.name);
    }
    return result;
}

Result<std::vector<Field>> join_cell_fields(std::vector<Piece>& pieces, std::span<const std::uint64_t> first,
                                            std::span<const std::uint64_t> kept, std::uint64_t count, ReadResult& whole,
                                            const Progress& progress) {
    std::vector<Field> result;
    Filled filled;
    for (const std::uint64_t cells : kept) filled.push_back(cells > 0);
    const std::vector<JoinedColumn> columns = columns_of(pieces, &Grid::cell_fields, filled);
    tell_columns(columns, static_cast<std::size_t>(std::ranges::count(filled, true)), "cell", whole);
    for (const JoinedColumn& column : columns) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "joining pieces was cancelled"};
        if (column.other_components == 0) {
            auto values = joined_in_cells(pieces, column, first, count);
            if (!values) return values.error();
            result.push_back({column.name, *std::move(values)});
        }
        drop(pieces, &Grid::cell_fields, column.name);
    }
    return result;
}

Result<Array> join_points(std::vector<Piece>& pieces, const PointNumbers& numbers) {
    const Filled filled = with_points(pieces);
    for (Piece& piece : pieces) piece.grid.point_fields = {{"points", std::exchange(piece.grid.points, Array())}};
    const JoinedColumn column = columns_of(pieces, &Grid::point_fields, filled).front();
    return joined_at_points(pieces, &Grid::point_fields, column, numbers, {});
}

} // namespace isotet::io
