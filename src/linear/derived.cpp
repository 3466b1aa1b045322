// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/derived.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include <fmt/core.h>

#include <isotet/linear_cells.hpp>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "linear/curved/node_values.hpp"
#include "linear/place.hpp"

namespace isotet {

namespace {

constexpr std::size_t derived_grain = 1 << 14;

/// Values at refined points, behind those that `to` has.
template <class T>
void add_refined(const RefinedPoints& refined, std::size_t before, std::size_t components, core::Buffer<T>& to,
                 const Progress& progress) {
    if (refined.count() == 0) return;
    const std::span<const T> known(to.data(), before * components);
    const auto parents = refined.parents.as<std::uint32_t>();
    const auto nodes = refined.nodes.as<linear::Node>();
    const Array points = Array::borrow(known, components);
    std::vector<linear::NodeValues> values;
    for (std::size_t c = 0; c < components; ++c) values.emplace_back(points, refined.hidden, c);
    core::parallel_pieces(refined.count(), derived_grain, progress, [&](std::size_t begin, std::size_t end) {
        linear::QuadraticTet tet{};
        for (std::size_t i = begin; i < end; ++i) {
            std::memcpy(tet.data(), &nodes[10 * std::size_t{parents[i]}], sizeof tet);
            const linear::WeightedNodes at(tet, linear::place_at(refined.places, i));
            for (std::size_t c = 0; c < components; ++c)
                to[(before + i) * components + c] = static_cast<T>(at.value(values[c]));
        }
    });
}

/// `inside`   no value is outside those that it is made of
template <class To, class From>
Array extended(const DerivedPoints& derived, const RefinedPoints& refined, std::span<const From> from,
               std::size_t components, bool inside, const Progress& progress) {
    const std::size_t users = from.size() / components, rows = derived.count();
    core::Buffer<To> to((users + rows + refined.count()) * components);
    core::parallel_pieces(from.size(), derived_grain, progress, [&](std::size_t begin, std::size_t end) {
        if constexpr (std::is_same_v<To, From>) std::memcpy(&to[begin], &from[begin], (end - begin) * sizeof(To));
        else
            for (std::size_t i = begin; i < end; ++i) to[i] = static_cast<To>(from[i]);
    });
    if (rows == 0) {
        add_refined(refined, users, components, to, progress);
        return std::move(to).to_array(components);
    }
    const auto first = derived.first.as<std::uint64_t>(), points = derived.points.as<std::uint64_t>();
    const auto weights = derived.weights.as<double>();
    core::parallel_pieces(rows, derived_grain, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (std::size_t c = 0; c < components; ++c) {
                const std::size_t count = first[row + 1] - first[row];
                const auto at = [&](std::size_t i) {
                    return static_cast<double>(from[points[first[row] + i] * components + c]);
                };
                const double equal = 1 / static_cast<double>(count);
                double value = linear::derived_value(
                    weights.empty() ? std::span(&equal, 1) : weights.subspan(first[row], count), count, at);
                if (inside) value = linear::within(value, count, at);
                to[(users + row) * components + c] = static_cast<To>(value);
            }
    });
    add_refined(refined, users + rows, components, to, progress);
    return std::move(to).to_array(components);
}

template <std::size_t size>
void gather(const Array& values, std::span<const std::uint64_t> sources, std::byte* to, const Progress& progress) {
    const auto* const from = static_cast<const std::byte*>(values.data());
    const std::size_t tuple = size * values.components();
    core::parallel_pieces(sources.size(), derived_grain, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) std::memcpy(to + i * tuple, from + sources[i] * tuple, tuple);
    });
}

Result<void> has_tuples(const Array& values, std::uint64_t expected, const char* what) {
    if (values.tuples() == expected && values.components() > 0) return {};
    return invalid_argument(
        fmt::format("the array has {} tuples, but the user's grid has {} {}s", values.tuples(), expected, what));
}

Error cancelled_extension() { return {ErrorCode::cancelled, "extending an array was cancelled"}; }

} // namespace

Result<Array> LinearGrid::extend(const Array& values, const Run& run) const {
    return core::carry_out("extending an array", run, [&](const Progress& progress) -> Result<Array> {
        if (auto fits = has_tuples(values, user_points, "point"); !fits) return fits.error();
        if (derived.count() == 0 && refined.count() == 0) return values;
        Array out = values.visit([&]<class T>(std::span<const T> from) {
            using To = std::conditional_t<std::is_floating_point_v<T>, T, double>;
            return extended<To>(derived, refined, from, values.components(),
                                report.high_degree == 0 && refinement.curved_cells == 0, progress);
        });
        if (progress.cancelled()) return cancelled_extension();
        return out;
    });
}

Result<Array> LinearGrid::extend(const Array& values, const Array& cell_values, const Run& run) const {
    if (values.components() != 1 || cell_values.components() != 1)
        return invalid_argument(
            fmt::format("fields of {} and {} components were given, but one scalar a point and a cell "
                        "is needed",
                        values.components(), cell_values.components()));
    if (report.high_degree > 0 || refined.count() > 0)
        return invalid_argument("points inside curved cells have no values of their own");
    const Result<Array> means = extend(values, run);
    if (!means || derived.count() == 0) return means;
    return core::carry_out("extending an array", run, [&](const Progress& progress) -> Result<Array> {
        if (auto fits = has_tuples(cell_values, user_cells, "cell"); !fits) return fits.error();
        const auto sources = source_cells.as<std::uint64_t>();
        const auto cells = core::CellReader::open(grid);
        if (!cells) return cells.error();
        const auto put_centres = [&]<class T>(std::span<const T> from) -> Array {
            core::Buffer<T> to(from.size());
            core::parallel_pieces(from.size(), derived_grain, progress, [&](std::size_t begin, std::size_t end) {
                std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin),
                          from.begin() + static_cast<std::ptrdiff_t>(end), to.data() + begin);
            });
            // Cells around a centre are of one polyhedron, and stand together: the first one of each writes.
            core::parallel_pieces(cells->count(), derived_grain, progress, [&](std::size_t begin, std::size_t end) {
                for (std::size_t cell = begin; cell < end; ++cell) {
                    if (cell > 0 && sources[cell - 1] == sources[cell]) continue;
                    for (std::uint64_t i = 0; i < cells->corners(cell); ++i)
                        if (const std::uint64_t point = cells->corner(cells->first(cell) + i); point >= user_points)
                            to[point] = static_cast<T>(cell_values.at(sources[cell]));
                }
            });
            return std::move(to).to_array();
        };
        const Array out =
            means->type() == ScalarType::float32 ? put_centres(means->as<float>()) : put_centres(means->as<double>());
        if (progress.cancelled()) return cancelled_extension();
        return out;
    });
}

Result<Array> LinearGrid::of_cells(const Array& values, const Run& run) const {
    return core::carry_out("extending an array", run, [&](const Progress& progress) -> Result<Array> {
        if (auto fits = has_tuples(values, user_cells, "cell"); !fits) return fits.error();
        if (source_cells.empty()) return values;
        const auto sources = source_cells.as<std::uint64_t>();
        Array out = values.visit([&]<class T>(std::span<const T>) {
            core::Buffer<T> to(sources.size() * values.components());
            gather<sizeof(T)>(values, sources, reinterpret_cast<std::byte*>(to.data()), progress);
            return std::move(to).to_array(values.components());
        });
        if (progress.cancelled()) return cancelled_extension();
        return out;
    });
}

} // namespace isotet
