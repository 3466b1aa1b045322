// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey_piece(): what pieces must agree on, from the points that cells use.
#include <isotet/frame.hpp>

#include <atomic>
#include <vector>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "grid/tet_survey.hpp"
#include "numbers/value_summary.hpp"
#include "packed/build/point_order.hpp"
#include "packed/frame.hpp"

namespace isotet {

namespace core {

namespace {

constexpr std::size_t piece_grain = 1 << 15;

ValueSummary summary_of_used(const Array& values, const Buffer<std::uint8_t>& used) {
    const std::size_t components = values.components();
    return values.visit([&](auto typed) {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, used.size(), piece_grain), ValueSummary{},
            [&](const tbb::blocked_range<std::size_t>& range, ValueSummary summary) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    for (std::size_t k = 0; used[i] && k < components; ++k)
                        summary.add(static_cast<double>(typed[i * components + k]), 0);
                return summary;
            },
            [](ValueSummary a, const ValueSummary& b) {
                a.combine(b);
                return a;
            });
    });
}

/// Tetrahedra of positive volume less those of negative volume.
std::int64_t count_upright(const Grid& grid, const CellReader& cells) {
    const PointReader points(grid.points);
    std::atomic<std::int64_t> total{0};
    parallel_ranges(cells.count(), piece_grain, [&](std::size_t begin, std::size_t end) {
        std::int64_t balance = 0;
        for (std::size_t cell = begin; cell < end; ++cell)
            if (Orienter::is_whole(cells.type(cell)))
                for (const Tet& tet : cells.tets(cell)) balance += points.orientation(tet);
        total += balance;
    });
    return total;
}

FieldSurvey survey_field(const Field& field, const Buffer<std::uint8_t>& used) {
    const ValueSummary summary = summary_of_used(field.values, used);
    return {name_in_survey(field.name), field.values.type(), summary.statistics.lower,
            summary.statistics.upper,   summary.smallest,    summary.largest};
}

Result<Survey> survey_piece(const Grid& piece, std::span<const Field> fields, const SurveyPieceOptions& options,
                            const Progress& progress) {
    auto cells = CellReader::open(piece);
    if (!cells) return cells.error();
    if (fields.empty() || fields.size() > Survey::max_fields)
        return invalid_argument(
            fmt::format("{} fields were given, but a survey has 1 to {}", fields.size(), Survey::max_fields));
    for (const Field& field : fields)
        if (field.values.tuples() != piece.points.tuples())
            return invalid_argument(fmt::format("field '{}' has {} tuples, but the piece has {} points", field.name,
                                                field.values.tuples(), piece.points.tuples()));
    if (auto ok = check_cells(piece, *cells, progress); !ok) return ok.error();
    const bool native = !cells->only_tets() && !options.split_cells;
    const CellCounts counts = native ? count_native_cells(*cells) : count_tets(*cells);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "surveying the piece was cancelled"};
    Survey out;
    const Bounds bounds = bounds_of_used(PointReader(piece.points), counts.used);
    out.lower = bounds.lower;
    out.upper = bounds.upper;
    out.upright = count_upright(piece, *cells);
    out.points = piece.points.type();
    out.field_count = static_cast<std::uint32_t>(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) out.fields[i] = survey_field(fields[i], counts.used);
    progress("survey", 1);
    return out;
}

} // namespace
} // namespace core

Result<Survey> survey_piece(const Grid& piece, std::span<const Field> fields, const SurveyPieceOptions& options,
                            const Run& run) {
    return core::carry_out("surveying the piece", run, [&](const Progress& progress) {
        return core::survey_piece(piece, fields, options, progress);
    });
}

Result<Survey> survey_piece(const Grid& piece, const PointField& field, const SurveyPieceOptions& options,
                            const Run& run) {
    const Field alone{field.name, field.values};
    return survey_piece(piece, std::span(&alone, 1), options, run);
}

} // namespace isotet
