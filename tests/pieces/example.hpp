// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/pieces.hpp>

/// What MPI_Allgather(&mine, sizeof mine, MPI_BYTE, all, sizeof mine, MPI_BYTE, comm) does.
using AllGather = std::function<std::vector<isotet::Survey>(const isotet::Survey& mine)>;

/// The surface of the piece of one rank. Every rank calls it; a piece may be empty.
isotet::Result<isotet::Surface> surface_of_piece(isotet::Grid piece, const isotet::PointField& field, double isovalue,
                                                 const AllGather& all_gather) {
    if (piece.point_numbers.empty()) { // better: the numbers of the points in the whole grid
        const auto numbers = isotet::number_points_by_coordinates(piece.points);
        if (!numbers) return numbers.error();
        piece.point_numbers = *numbers;
    }
    const auto mine = isotet::survey_piece(piece, field);
    const auto all = all_gather(mine ? *mine : isotet::Survey{}); // also after an error: the other ranks wait for it
    if (!mine) return mine.error();
    const auto frame = isotet::make_frame(all);
    if (!frame) return frame.error();

    isotet::DirectOptions options; // or PackOptions, ContourOptions
    options.frame = *frame;
    const auto result = isotet::extract_direct(piece, field, std::vector{isovalue}, options);
    if (!result) return result.error();
    return result->surfaces[0].surface;
}
