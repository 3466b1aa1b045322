// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear.hpp"

#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

using State =
    std::tuple<std::uint64_t, std::uint64_t, ArrayIn, ArrayIn, ArrayIn, ArrayIn, std::uint64_t, std::uint64_t>;

nb::tuple state_of(const LinearGrid& linear) {
    const DerivedPoints& derived = linear.derived;
    return nb::make_tuple(linear.user_points, linear.user_cells, array_out(derived.first), array_out(derived.points),
                          array_out(derived.weights), array_out(linear.source_cells), linear.report.high_degree,
                          linear.refinement.curved_cells);
}

LinearGrid linear_of(const State& state) {
    LinearGrid linear;
    linear.user_points = std::get<0>(state);
    linear.user_cells = std::get<1>(state);
    linear.derived = {array_in(std::get<2>(state)), array_in(std::get<3>(state)), array_in(std::get<4>(state))};
    linear.source_cells = array_in(std::get<5>(state));
    linear.report.high_degree = std::get<6>(state);
    linear.refinement.curved_cells = std::get<7>(state);
    return linear;
}

Result<std::vector<Field>> changed(std::vector<Field> fields, const auto& change) {
    for (Field& field : fields) {
        Result<Array> values = change(field.values);
        if (!values) return values.error();
        field.values = *std::move(values);
    }
    return fields;
}

} // namespace

Result<PackedCells> pack_linear(const Grid& grid, const PointField& field, const PackOptions& options, const Run& run) {
    PackedCells out;
    if (!has_cells_to_linearize(grid.cells)) {
        Result<PackedGrid> packed = pack(grid, field, options, run);
        if (!packed) return packed.error();
        out.packed = *std::move(packed);
        return out;
    }
    Result<LinearGrid> linear = linearize(grid, {}, run);
    if (!linear) return linear.error();
    PointField longer = field;
    Result<Array> values = field.cell_values.empty() ? linear->extend(field.values, run)
                                                     : linear->extend(field.values, field.cell_values, run);
    if (!values) return values.error();
    longer.values = *std::move(values);
    longer.cell_values = {};
    Result<PackedGrid> packed = pack(linear->grid, longer, options, run);
    if (!packed) return packed.error();
    out.packed = *std::move(packed);
    linear->grid = {};
    out.linear = *std::move(linear);
    return out;
}

Result<Array> of_points(const LinearGrid* linear, const Array& values, const Run& run) {
    return linear ? linear->extend(values, run) : Result<Array>(values);
}

Result<std::vector<Field>> of_points(const LinearGrid* linear, const std::vector<Field>& fields, const Run& run) {
    if (!linear) return fields;
    return changed(fields, [&](const Array& values) { return linear->extend(values, run); });
}

Result<std::vector<Field>> of_cells(const LinearGrid* linear, const std::vector<Field>& fields, const Run& run) {
    if (!linear) return fields;
    return changed(fields, [&](const Array& values) { return linear->of_cells(values, run); });
}

void number_by_user(const LinearGrid* linear, std::vector<Extraction>& surfaces) {
    if (!linear || linear->source_cells.empty()) return;
    const auto sources = linear->source_cells.as<std::uint64_t>();
    for (Extraction& extraction : surfaces) {
        Array& cells = extraction.surface.source_cells;
        if (cells.empty()) continue;
        std::vector<std::int64_t> numbers;
        numbers.reserve(cells.tuples());
        for (const std::int64_t cell : cells.as<std::int64_t>())
            numbers.push_back(static_cast<std::int64_t>(sources[static_cast<std::size_t>(cell)]));
        cells = Array::own(std::move(numbers));
    }
}

void add_linear(nb::module_& module) {
    module.def("has_cells_to_linearize", &has_cells_to_linearize, "cells"_a);
    nb::class_<LinearGrid>(module, "LinearGrid")
        .def_ro("user_cells", &LinearGrid::user_cells)
        .def("__getstate__", &state_of)
        .def("__setstate__", [](LinearGrid& self, const State& state) { new (&self) LinearGrid(linear_of(state)); });
}

} // namespace isotet::python
