// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/curved_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/curved/quadratic.hpp"
#include "session/linear_input.hpp"

namespace isotet::session {

namespace {

/// The linear type with the same corners; the type itself where it is none of ours.
std::uint8_t type_of_corners(std::uint8_t type, std::uint64_t nodes) {
    const auto layout = linear::layout_of(type, nodes);
    const auto high = linear::high_degree_of(type, nodes);
    if (!layout && !high) return type;
    switch (layout ? layout->kind : high->kind) {
    case core::CellKind::tetrahedron: return static_cast<std::uint8_t>(CellType::tetrahedron);
    case core::CellKind::pyramid: return static_cast<std::uint8_t>(CellType::pyramid);
    case core::CellKind::wedge: return static_cast<std::uint8_t>(CellType::wedge);
    case core::CellKind::hexahedron: break;
    }
    return static_cast<std::uint8_t>(CellType::hexahedron);
}

} // namespace

std::vector<std::string> notes_on(const RefinementReport& report) {
    std::vector<std::string> out;
    if (report.curved_cells > 0 && report.refined)
        out.push_back(fmt::format(
            "{} curved cells were refined to {} tets: the field is within {:.3g} of the cells' own{}, the "
            "tets within {:.3g} of their shape{}",
            report.curved_cells, report.tets, report.field_bound,
            report.tolerance > 0 ? fmt::format(" (asked for {:.3g})", report.tolerance) : "", report.geometry_bound,
            report.distance > 0
                ? fmt::format("; in 99 of 100 of them the surface is within {:.3g} of the quadratic field's, by "
                              "estimate (asked for {:.3g})",
                              report.distance, report.wanted_distance)
                : ""));
    else if (report.curved_cells > 0)
        out.push_back(fmt::format("{} curved cells were split at their nodes into {} tets, without a tolerance for the "
                                  "field",
                                  report.curved_cells, report.tets));
    if (report.carried_left_out)
        out.emplace_back(
            "memory does not suffice to refine cells for the carried fields, too: these are linear between the "
            "points that the contoured field needs");
    if (report.too_fine)
        out.push_back("some edges could not be bisected any further: the bound is larger than the tolerance");
    if (report.too_bent)
        out.push_back(
            "some cells fold: the determinant of their map has both signs, and their edges bend more than bisecting "
            "can follow");
    if (report.not_finite > 0)
        out.push_back(fmt::format("{} of {} quadratic tets were left out: a node has no finite value",
                                  report.not_finite, report.quadratic_tets));
    if (report.unknown_cells > 0)
        out.push_back(
            fmt::format("{} curved cells were left out: Bezier pyramids and cells above degree 10 are not handled",
                        report.unknown_cells));
    return out;
}

Result<void> CurvedInput::take(ContourInput input, const ContourOptions& options) {
    if (options.frame)
        return invalid_argument(
            "the grid has curved cells and is a piece (it has a frame), but curved cells are refined "
            "in whole grids only");
    if (!input.field.cell_values.empty())
        return invalid_argument("values of cells are for the centres of polyhedra, but the grid has curved cells, too");
    const auto cells = core::CellReader::open(input.grid);
    if (!cells) return cells.error();
    if (input.field.values.components() != 1 || input.field.values.tuples() != cells->points())
        return invalid_argument(fmt::format(
            "field '{}' has {} values of {} components, but the grid has {} points and the "
            "contoured field must have 1 component",
            input.field.name, input.field.values.tuples(), input.field.values.components(), cells->points()));
    std::vector<std::uint8_t> types(cells->count());
    own_pyramids_ = 0;
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
        constexpr std::uint8_t of_13_nodes = 27, of_19_nodes = 37;
        if (cells->type(cell) == of_13_nodes || cells->type(cell) == of_19_nodes) ++own_pyramids_;
        types[cell] = type_of_corners(cells->type(cell), cells->corners(cell));
    }
    corners_ = input;
    corners_.grid.cells.types = Array::own(std::move(types));
    options_ = *options.refine;
    refined_.reset();
    user_ = std::move(input);
    return {};
}

bool CurvedInput::is_good_for(std::span<const double> isovalues) const {
    if (!refined_) return false;
    const std::vector<double>& known = refined_->refinement.isovalues;
    return known.empty() ||
           std::ranges::all_of(isovalues, [&](double isovalue) { return std::ranges::binary_search(known, isovalue); });
}

Result<ContourInput> CurvedInput::refine(std::span<const double> isovalues, const Run& run) {
    refined_.reset(); // the old one goes before the new one comes
    RefineOptions options = options_;
    const auto is_known = [&](double isovalue) {
        return std::ranges::find(options.isovalues, isovalue) != options.isovalues.end();
    };
    if (!std::ranges::all_of(isovalues, is_known) || options.isovalues.empty())
        options.isovalues.assign(isovalues.begin(), isovalues.end());
    auto made = isotet::refine(user_->grid, user_->field, options, run);
    if (!made) return made.error();
    auto input = on_linear_grid(*user_, *made, run);
    if (input) refined_ = std::make_shared<const LinearGrid>(*std::move(made));
    return input;
}

std::vector<std::string> CurvedInput::notes() const {
    std::vector<std::string> notes = notes_on(refined_->refinement);
    if (own_pyramids_ > 0)
        notes.push_back(fmt::format("{} pyramids of 13 or 19 nodes have functions of isotet's own inside: the bound is "
                                    "against these, not VTK's (docs/cells.md)",
                                    own_pyramids_));
    return notes;
}

FieldReport CurvedInput::field() const {
    FieldReport report;
    report.name = user_->field.name;
    report.lower = std::numeric_limits<double>::infinity();
    report.upper = -report.lower;
    const auto cells = core::CellReader::open(user_->grid).value();
    const Array& values = user_->field.values;
    std::vector<bool> seen(cells.points());
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        const auto layout = linear::layout_of(cells.type(cell), cells.corners(cell));
        const bool high = linear::high_degree_of(cells.type(cell), cells.corners(cell)).has_value();
        const std::uint64_t nodes = high     ? cells.corners(cell)
                                    : layout ? layout->nodes
                                             : static_cast<std::uint64_t>(core::corners_of(cells.type(cell)));
        for (std::uint64_t i = 0; i < nodes; ++i) {
            const std::uint64_t at = cells.first(cell) + i;
            if (at >= cells.connectivity_size()) break;
            const std::uint64_t point = cells.corner(at);
            if (point >= seen.size() || seen[point]) continue;
            seen[point] = true;
            const double value = values.at(point);
            report.no_data += std::isnan(value);
            report.infinite += std::isinf(value);
            if (!std::isfinite(value)) continue;
            report.lower = std::min(report.lower, value);
            report.upper = std::max(report.upper, value);
        }
    }
    return report;
}

} // namespace isotet::session
