// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/linear_input.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"

namespace isotet::session {

namespace {

std::array<const Array*, 6> arrays_of(const Grid& grid) {
    const Cells& cells = grid.cells;
    return {&cells.connectivity, &cells.offsets, &cells.types, &cells.faces, &cells.face_offsets, &grid.point_numbers};
}

} // namespace

bool LinearInput::knows(const Grid& grid) const {
    if (!linear_) return false;
    const auto arrays = arrays_of(grid);
    bool same = true;
    for (std::size_t i = 0; i < arrays.size(); ++i)
        same = same && (arrays[i]->empty() ? arrays_[i].is_empty() : arrays_[i].is(*arrays[i]));
    return same || (cells_print_ == fingerprint(grid.cells) && numbers_print_ == fingerprint(grid.point_numbers));
}

Result<ContourInput> LinearInput::make(ContourInput input, const Run& run) {
    is_new_ = false;
    if (!has_cells_to_linearize(input.grid.cells)) {
        linear_.reset();
        return input;
    }
    LinearInput next = *this;
    next.points_.emplace(input.grid.points);
    bool known = false;
    core::with_threads(run.threads, [&] { known = knows(input.grid); });
    if (!known || linear_->user_points != input.grid.points.tuples()) {
        auto made = linearize(input.grid, {}, run);
        if (!made) return made.error();
        next.linear_ = std::make_shared<const LinearGrid>(*std::move(made));
        next.arrays_.clear();
        for (const Array* array : arrays_of(input.grid)) next.arrays_.emplace_back(*array);
        core::with_threads(run.threads, [&] {
            next.cells_print_ = fingerprint(input.grid.cells);
            next.numbers_print_ = fingerprint(input.grid.point_numbers);
        });
        next.is_new_ = true;
    } else if (!points_->is(input.grid.points)) {
        auto moved = linear_->extend(input.grid.points, run);
        if (!moved) return moved.error();
        LinearGrid copy = *linear_;
        copy.grid.points = *std::move(moved);
        next.linear_ = std::make_shared<const LinearGrid>(std::move(copy));
    }
    auto made = on_linear_grid(std::move(input), *next.linear_, run);
    if (!made) return made;
    *this = std::move(next);
    return made;
}

Result<ContourInput> on_linear_grid(ContourInput input, const LinearGrid& linear, const Run& run) {
    input.grid = linear.grid;
    const auto replace = [&](Array& array, bool of_cells) -> Result<void> {
        auto longer = of_cells ? linear.of_cells(array, run) : linear.extend(array, run);
        if (!longer) return longer.error();
        array = *std::move(longer);
        return {};
    };
    if (input.field.cell_values.empty()) {
        if (auto done = replace(input.field.values, false); !done) return done.error();
    } else {
        auto longer = linear.extend(input.field.values, input.field.cell_values, run);
        if (!longer) return longer.error();
        input.field.values = *std::move(longer);
        input.field.cell_values = {};
    }
    for (Field& field : input.point_fields)
        if (auto done = replace(field.values, false); !done) return done.error();
    for (Field& field : input.cell_fields)
        if (auto done = replace(field.values, true); !done) return done.error();
    return input;
}

Result<void> check_cell_numbers(const ContourInput& input) {
    if (!input.part || input.part->cell_numbers.empty()) return {};
    const Array& numbers = input.part->cell_numbers;
    if (numbers.type() == ScalarType::uint64 && numbers.size() == input.grid.cells.count()) return {};
    return invalid_argument(fmt::format("there are {} cell numbers of {}, but {} cells, and numbers are of uint64",
                                        numbers.size(), name_of(numbers.type()), input.grid.cells.count()));
}

Result<ContourInput> with_all_cells(ContourInput input, const Run& run) {
    if (!input.lacks_cells()) return input;
    Result<ContourInput> all = input.part->whole(run);
    if (!all) return all;
    input.grid = std::move(all->grid);
    if (!all->cell_fields.empty()) input.cell_fields = std::move(all->cell_fields);
    input.part = std::move(all->part);
    return input;
}

void map_edge_ends(std::uint64_t user_points, const Array& numbers, std::vector<Extraction>& surfaces) {
    if (numbers.empty()) return;
    const auto number_of = numbers.as<std::uint64_t>();
    for (Extraction& extraction : surfaces) {
        Array& ends = extraction.surface.edge_ends;
        if (ends.empty()) continue;
        core::Buffer<std::int64_t> mapped(ends.size());
        const auto before = ends.as<std::int64_t>();
        core::parallel_each(mapped.size(), 1 << 16, [&](std::size_t i) {
            const auto point = static_cast<std::uint64_t>(before[i]);
            mapped[i] = point < user_points ? before[i] : static_cast<std::int64_t>(number_of[point - user_points]);
        });
        ends = std::move(mapped).to_array(2);
    }
}

} // namespace isotet::session
