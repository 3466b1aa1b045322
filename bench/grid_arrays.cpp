// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/grid_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>

#include "bench/arrays.hpp"

namespace isotet::bench {

namespace {

constexpr std::string_view make_prefix = "make:";

Grid load(const std::string& source, const std::string& field, int threads) {
    if (source.starts_with(make_prefix)) {
        MakeOptions options = parse_make(source.substr(make_prefix.size())).value();
        options.fields = {field};
        return make_grid(options, {.threads = threads}).value();
    }
    ReadOptions options;
    options.reader_program =
        std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../apps/cli/isotet-reader";
    return read(source, options).value().grid;
}

/// The array itself where it is float32 or float64, else its values as float64.
Array as_reals(const Array& array) {
    if (is_floating(array.type())) return array;
    return array.visit(
        [&](auto values) { return Array::own(std::vector<double>(values.begin(), values.end()), array.components()); });
}

void write_reals(const std::string& folder, const std::string& name, const Array& array) {
    const std::string ending = array.type() == ScalarType::float64 ? ".f64" : ".f32";
    write_array(folder, name + ending, array.data(), array.bytes());
}

/// The array with each value changed, as To.
template <class To, class Change>
Array changed(const Array& array, const Change& change) {
    std::vector<To> out(array.size());
    array.visit([&](auto values) {
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = static_cast<To>(change(static_cast<double>(values[i]), i));
    });
    return Array::own(std::move(out), array.components());
}

/// Changes points and values as `variant` says.
void vary(const std::string& variant, Array& points, Array& values) {
    if (variant.empty()) return;
    if (variant == "double") {
        const auto finer = [](double value, std::size_t) { return value * (1 + 1e-10); };
        points = changed<double>(points, finer);
        values = changed<double>(values, finer);
    } else if (variant == "rounded") {
        values = changed<float>(values, [](double value, std::size_t) { return std::round(value * 16) / 16; });
    } else if (variant == "no_data") {
        values = changed<float>(values, [](double value, std::size_t i) { return i % 97 == 0 ? NAN : value; });
    } else {
        throw std::invalid_argument("no such variant: '" + variant + "'");
    }
}

/// The cells that are contoured; unless all are asked for, those whose corners all have a value.
Arrays contoured_cells(const Grid& grid, const Array& field, bool all) {
    if (grid.points.tuples() > std::numeric_limits<std::int32_t>::max())
        throw std::runtime_error("the grid has " + std::to_string(grid.points.tuples()) +
                                 " points, but a race is for at most 2^31 - 1");
    const std::vector<std::int64_t> corners = grid.cells.connectivity.visit(
        [](auto values) { return std::vector<std::int64_t>(values.begin(), values.end()); });
    Arrays out;
    out.corners.reserve(corners.size());
    out.offsets.push_back(0);
    for (std::size_t cell = 0, begin = 0; cell < grid.cells.count(); ++cell) {
        const bool uniform = grid.cells.types.empty();
        const CellType type =
            uniform ? grid.cells.uniform_type : static_cast<CellType>(grid.cells.types.as<std::uint8_t>()[cell]);
        const std::size_t end = uniform ? begin + corners_of_type(static_cast<std::uint8_t>(type))
                                        : static_cast<std::size_t>(grid.cells.offsets.at(cell + 1));
        const std::span<const std::int64_t> of_cell(corners.data() + begin, end - begin);
        begin = end;
        const bool has_values = all || std::ranges::none_of(of_cell, [&](std::int64_t point) {
                                    return std::isnan(field.at(static_cast<std::size_t>(point)));
                                });
        if (type < CellType::tetrahedron || type > CellType::pyramid || !has_values) continue;
        for (const std::int64_t point : of_cell) out.corners.push_back(static_cast<std::int32_t>(point));
        out.offsets.push_back(static_cast<std::int64_t>(out.corners.size()));
        out.types.push_back(static_cast<std::uint8_t>(type));
    }
    const bool one_type = std::ranges::adjacent_find(out.types, std::not_equal_to<>()) == out.types.end();
    if (one_type && !out.types.empty()) {
        out.offsets.clear();
        out.types.resize(1);
    }
    return out;
}

template <class T>
void write_values(const std::string& folder, const std::string& name, const std::vector<T>& values) {
    write_array(folder, name, values.data(), values.size() * sizeof(T));
}

} // namespace

Reply write_grid_arrays(const std::string& source, const std::string& field, const std::string& variant,
                        const std::string& folder, int threads) {
    Grid grid = load(source, field, threads);
    Array values = as_reals(find_field(grid, field).value().values);
    vary(variant, grid.points, values);
    std::filesystem::create_directories(folder);
    write_reals(folder, "points", grid.points);
    write_reals(folder, "field", values);

    const Arrays cells = contoured_cells(grid, values, variant == "no_data");
    write_values(folder, "corners.i32", cells.corners);
    write_values(folder, "types.u8", cells.types);
    if (!cells.uniform()) write_values(folder, "offsets.i64", cells.offsets);

    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    values.visit([&](auto span) {
        for (const double value : span) {
            if (!std::isfinite(value)) continue;
            lower = std::min(lower, value);
            upper = std::max(upper, value);
        }
    });
    return Reply()
        .count("points", grid.points.tuples())
        .count("cells", cells.cell_count())
        .number("lower", lower)
        .number("upper", upper);
}

} // namespace isotet::bench
