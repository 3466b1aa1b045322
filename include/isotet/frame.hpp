// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the pieces of a grid must agree on, so that their surfaces are together the surface of the whole grid, bit for
// bit: how coordinates and values are stored.
//
// Each piece is surveyed; the surveys of all pieces make one frame; each piece is extracted with it. The library moves
// nothing between processes: a survey is plain bytes, to be gathered by MPI, through files, or in memory.
// docs/pieces.md shows it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// The values of a field at the points that cells of a piece use, all components together. Trivially copyable.
struct FieldSurvey {
    std::uint64_t name = 0; ///< a hash of the field's name
    ScalarType type = ScalarType::float32;
    double lower = std::numeric_limits<double>::infinity(); ///< of the finite values; lower > upper: there is none
    double upper = -std::numeric_limits<double>::infinity();
    double smallest = std::numeric_limits<double>::infinity(); ///< magnitude of a finite value other than 0
    double largest = 0;

    friend bool operator==(const FieldSurvey&, const FieldSurvey&) = default;
};

/// What a piece knows of itself. Trivially copyable: it may be sent as bytes between processes of one machine type.
/// A default-made survey is that of no piece.
struct Survey {
    static constexpr std::size_t max_fields = 16;

    std::array<double, 3> lower = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::infinity()}; ///< of the points that cells use
    std::array<double, 3> upper = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity()};
    std::int64_t upright = 0; ///< tetrahedra of positive volume less those of negative volume
    ScalarType points = ScalarType::float32;
    std::uint32_t field_count = 0; ///< 0: of no piece
    std::array<FieldSurvey, max_fields> fields{};

    friend bool operator==(const Survey&, const Survey&) = default;
};

/// How all pieces store coordinates and values: the survey of the whole grid. Made by make_frame().
struct Frame {
    Survey whole;

    /// The field of this name; null: the frame does not know it. Its range is that of the whole grid.
    ISOTET_API const FieldSurvey* find(std::string_view name) const noexcept;

    friend bool operator==(const Frame&, const Frame&) = default;
};

struct SurveyPieceOptions {
    bool split_cells = false; ///< as PackOptions::split_cells
};

/// Surveys a piece. Cells of types that are not contoured do not count; so a piece may have none that does.
///
/// `fields`   the field to contour, and those to carry: names and arrays as they will be given to pack() or
///            extract_direct(), one tuple a point, up to Survey::max_fields; the same names for each piece
/// Guarantees the same bytes for any thread count, any order of points and cells
/// Cost       one pass over cells, points and values; a byte a point
/// Errors     invalid_argument when a field does not fit the piece, when there is none or too many; invalid_data as
///            survey(); out_of_memory; cancelled
ISOTET_API Result<Survey> survey_piece(const Grid& piece, std::span<const Field> fields,
                                       const SurveyPieceOptions& options = {}, const Run& run = {});
ISOTET_API Result<Survey> survey_piece(const Grid& piece, const PointField& field,
                                       const SurveyPieceOptions& options = {}, const Run& run = {});

/// The survey of both pieces together. Commutes and associates.
/// Errors   invalid_argument when points or fields are of other types, or there are other fields
ISOTET_API Result<Survey> merge(const Survey& a, const Survey& b);

/// The frame of a grid from the surveys of all its pieces, in any order.
/// Errors   as merge(); invalid_argument when there is no piece
ISOTET_API Result<Frame> make_frame(std::span<const Survey> pieces);

} // namespace isotet
