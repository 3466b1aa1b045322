// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/solid_input.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <isotet/linear_cells.hpp>

#include "base/errors.hpp"
#include "grid/cell/linear_names.hpp"
#include "session/curved_input.hpp"
#include "session/linear_input.hpp"

namespace isotet::solid {

namespace {

Result<void> check_options(const ContourInput& input, const ContourOptions& options, bool is_piece) {
    if (options.frame && !is_piece)
        return invalid_argument("solids are made of whole grids, but the grid is a piece with a frame");
    if (!options.frame && is_piece) return invalid_argument("solids of a piece need the frame of the whole grid");
    if (options.exact_vertices)
        return invalid_argument("solids have vertices on the edges of linear cells: not exact ones");
    if (options.ties == Ties::keep) return invalid_argument("solids merge ties, but `ties` keeps them");
    if (options.normals == Normals::gradient)
        return invalid_argument("solids have normals of faces or vertices, but those of the gradient were asked for");
    if (options.split_cells && !input.grid.point_numbers.empty())
        return invalid_argument("solids of split cells need a grid without point numbers");
    return {};
}

Result<std::shared_ptr<const LinearGrid>> linear_of(const ContourInput& input, const ContourOptions& options,
                                                    const Run& run) {
    if (!has_cells_to_linearize(input.grid.cells)) return std::shared_ptr<const LinearGrid>();
    Result<LinearGrid> made = LinearGrid{};
    if (options.refine && has_curved_cells(input.grid.cells)) {
        RefineOptions all = *options.refine;
        all.isovalues = {};
        all.carried = input.point_fields;
        made = refine(input.grid, input.field, all, run);
    } else {
        made = linearize(input.grid, {}, run);
    }
    if (!made) return made.error();
    return std::make_shared<const LinearGrid>(*std::move(made));
}

} // namespace

Result<SolidInput> take_input(ContourInput given, const ContourOptions& options, const Run& run, bool is_piece) {
    Result<ContourInput> all = session::with_all_cells(std::move(given), run);
    if (!all) return all.error();
    given = *std::move(all);
    if (auto ok = check_options(given, options, is_piece); !ok) return ok.error();
    if (auto ok = session::check_cell_numbers(given); !ok) return ok.error();
    given.grid.cells = core::with_linear_names(std::move(given.grid.cells));
    SolidInput out;
    if (given.part) out.cell_numbers = given.part->cell_numbers;
    given.part.reset();
    out.user_grid = given.grid;
    out.user_grid.point_fields = {};
    out.user_grid.cell_fields = given.cell_fields;
    auto linear = linear_of(given, options, run);
    if (!linear) return linear.error();
    out.linear = *std::move(linear);
    out.input = std::move(given);
    if (!out.linear) return out;
    Result<ContourInput> made = session::on_linear_grid(std::move(out.input), *out.linear, run);
    if (!made) return made.error();
    out.input = *std::move(made);
    out.notes = out.linear->report.notes();
    std::ranges::move(session::notes_on(out.linear->refinement), std::back_inserter(out.notes));
    return out;
}

Result<Contour> contour_of(ContourInput input, const ContourOptions& options, const Run& run) {
    ContourOptions linear_options = options;
    linear_options.edge_ends = true;
    linear_options.normals = Normals::none;
    linear_options.refine = {};
    linear_options.expected_isovalues = {};
    return Contour::create(std::move(input), linear_options, run);
}

Result<void> check_range(const SolidRange& range) {
    if (std::isnan(range.lower) || std::isnan(range.upper) || !(range.lower < range.upper))
        return invalid_argument(
            fmt::format("the range of the solid is {} to {}, but must ascend", range.lower, range.upper));
    if (!std::isfinite(range.lower) && !std::isfinite(range.upper))
        return invalid_argument("the range of the solid has no finite end");
    return {};
}

std::vector<double> ends_of_range(const SolidRange& range) {
    std::vector<double> ends;
    for (const double end : {range.lower, range.upper})
        if (std::isfinite(end)) ends.push_back(end);
    return ends;
}

} // namespace isotet::solid
