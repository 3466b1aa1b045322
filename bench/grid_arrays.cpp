// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/grid_arrays.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

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
    options.reader_program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../apps/cli/isotet-reader";
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

bool is_tets_of_int32(const Grid& grid) {
    return grid.cells.types.empty() && grid.cells.offsets.empty() && grid.cells.uniform_type == CellType::tetrahedron &&
           grid.cells.connectivity.type() == ScalarType::int32;
}

/// The split tets whose four points all have a value.
std::vector<std::int32_t> valid_tets(const Grid& grid, const Array& field) {
    if (grid.points.tuples() > std::numeric_limits<std::int32_t>::max())
        throw std::runtime_error("the grid has " + std::to_string(grid.points.tuples()) +
                                 " points, but a race is for at most 2^31 - 1");
    const std::vector<std::array<std::uint64_t, 4>> tets = split(grid).value().tets;
    std::vector<std::int32_t> out;
    out.reserve(4 * tets.size());
    for (const auto& tet : tets) {
        const auto has_no_data = [&](std::uint64_t point) { return std::isnan(field.at(point)); };
        if (std::any_of(tet.begin(), tet.end(), has_no_data)) continue;
        for (const std::uint64_t point : tet) out.push_back(static_cast<std::int32_t>(point));
    }
    return out;
}

} // namespace

Reply write_grid_arrays(const std::string& source, const std::string& field, const std::string& folder, int threads) {
    const Grid grid = load(source, field, threads);
    const Array values = as_reals(find_field(grid, field).value().values);
    std::filesystem::create_directories(folder);
    write_reals(folder, "points", grid.points);
    write_reals(folder, "field", values);

    std::size_t tets;
    if (is_tets_of_int32(grid)) {
        const Array& connectivity = grid.cells.connectivity;
        tets = connectivity.size() / 4;
        write_array(folder, "tets.i32", connectivity.data(), connectivity.bytes());
    } else {
        const std::vector<std::int32_t> corners = valid_tets(grid, values);
        tets = corners.size() / 4;
        write_array(folder, "tets.i32", corners.data(), corners.size() * sizeof(corners[0]));
    }

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
        .count("tets", tets)
        .number("lower", lower)
        .number("upper", upper);
}

} // namespace isotet::bench
