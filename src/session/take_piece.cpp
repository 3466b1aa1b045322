// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/pieces.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/guard.hpp"
#include "session/linear_input.hpp"

namespace isotet {

namespace {

/// The field that is contoured, then the others, each name once.
std::vector<Field> framed_fields(const ContourInput& piece) {
    std::vector<Field> fields{{piece.field.name, piece.field.values}};
    for (const Field& field : piece.point_fields)
        if (field.name != piece.field.name && fields.size() < Survey::max_fields) fields.push_back(field);
    return fields;
}

/// A field of integers of which the frame has float64, since points inside polyhedra have its means: likewise, also in
/// pieces where no polyhedron is split.
void convert_as_framed(const Frame& frame, const std::string& name, Array& values) {
    const FieldSurvey* const framed = frame.find(name);
    if (!framed || is_floating(values.type()) || !is_floating(framed->type)) return;
    values = values.visit([&](auto from) {
        std::vector<double> to(from.size());
        std::ranges::transform(from, to.begin(), [](auto value) { return static_cast<double>(value); });
        return Array::own(std::move(to), values.components());
    });
}

/// Above all numbers of points. Polyhedra have one derived point at most, so pieces have different ones.
constexpr std::uint64_t first_derived_end = std::uint64_t{1} << 62;

} // namespace

Result<Survey> survey_piece(const ContourInput& piece, const SurveyPieceOptions& options, const Run& run) {
    const auto linear = session::LinearInput{}.make(piece, run);
    if (!linear) return linear.error();
    return survey_piece(linear->grid, framed_fields(*linear), options, run);
}

Result<FramedPiece> take_piece(const ContourInput& whole, const PieceOf& which, const SurveyPieceOptions& options,
                               const Run& run) {
    const auto survey = survey_piece(whole, options, run);
    if (!survey) return survey.error();
    const auto frame = make_frame({&*survey, 1});
    if (!frame) return frame.error();
    Grid grid = whole.grid;
    grid.point_fields = whole.point_fields;
    grid.point_fields.push_back({whole.field.name, whole.field.values});
    for (Field& field : grid.point_fields) convert_as_framed(*frame, field.name, field.values);
    grid.cell_fields = whole.cell_fields;
    Result<Grid> taken = take_piece(grid, which, run);
    if (!taken) return taken.error();
    FramedPiece out;
    out.frame = *frame;
    out.first_cell = first_cell_of(grid, which);
    out.input.field = whole.field;
    out.input.field.values = taken->point_fields.back().values;
    taken->point_fields.pop_back();
    out.input.point_fields = std::exchange(taken->point_fields, {});
    out.input.cell_fields = std::exchange(taken->cell_fields, {});
    out.input.grid = *std::move(taken);
    return out;
}

Result<Surface> number_as_whole(const Surface& surface, const Array& point_numbers, std::uint64_t first_cell) {
    return core::guarded("numbering the surface", [&]() -> Result<Surface> {
        Surface out = surface;
        if (!surface.source_cells.empty()) {
            std::vector<std::int64_t> cells;
            for (const std::int64_t cell : surface.source_cells.as<std::int64_t>())
                cells.push_back(cell + static_cast<std::int64_t>(first_cell));
            out.source_cells = Array::own(std::move(cells));
        }
        if (surface.edge_ends.empty() || point_numbers.empty()) return out;
        std::vector<std::int64_t> ends;
        for (const std::int64_t end : surface.edge_ends.as<std::int64_t>()) {
            const auto point = static_cast<std::uint64_t>(end);
            if (point >= point_numbers.tuples()) {
                ends.push_back(
                    static_cast<std::int64_t>(first_derived_end + first_cell + point - point_numbers.tuples()));
                continue;
            }
            ends.push_back(point_numbers.visit(
                [&](auto numbers) { return static_cast<std::int64_t>(numbers[static_cast<std::size_t>(end)]); }));
        }
        out.edge_ends = Array::own(std::move(ends), 2);
        return out;
    });
}

} // namespace isotet
