// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pieces on their way to one grid: in which order their points are numbered, and which of these are one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>

#include "io/pieces/loaded.hpp"
#include "io/pieces/join/piece_points.hpp"
#include "io/pieces/join/point_numbers.hpp"
#include "io/pieces/join/repeated_cells.hpp"
#include "io/pieces/join/seams.hpp"

namespace isotet::io {

/// Pieces and what is known of their points; where each stands in the file.
struct OrderedPieces {
    std::vector<Piece> pieces;
    std::vector<std::vector<PointUse>> uses; ///< empty: of all points
    std::vector<Box> boxes;
    std::vector<std::size_t> places; ///< in the file

    std::size_t size() const { return pieces.size(); }

    /// `order[i]` is the number of the piece that becomes the i-th.
    void arrange(const std::vector<std::size_t>& order) {
        const auto arranged = [&](auto& items) {
            auto old = std::exchange(items, {});
            for (const std::size_t i : order) items.push_back(std::move(old[i]));
        };
        arranged(pieces);
        arranged(uses);
        arranged(boxes);
        arranged(places);
    }
    /// An order that the file does not decide: by box, counts and content.
    std::vector<std::size_t> order_of_content() const;
    std::vector<std::size_t> order_of_file() const {
        std::vector<std::size_t> order(size());
        for (std::size_t i = 0; i < size(); ++i) order[places[i]] = i;
        return order;
    }
};

/// Below 0, 0, above 0 by bytes, the shorter first.
int compare_bytes(const Array& a, const Array& b);

struct JoinedNumbers {
    Seams seams;
    PointNumbers numbers;
};

/// Finds the points that are one, and numbers all. Arranges the pieces by content where some points are joined, else as
/// in the file. What happened is told in notes.
///
/// Errors   as find_seams()
Result<JoinedNumbers> number_points(OrderedPieces& all, const ReadOptions& options, std::vector<std::string>& notes,
                                    const Progress& progress);

/// Cells of the pieces that are marked as left out, as a note; nothing without such.
void note_left_out(const std::vector<Piece>& pieces, std::vector<std::string>& notes);

void note_repeated(const RepeatedCells& repeated, const std::vector<Piece>& pieces, std::vector<std::string>& notes);

} // namespace isotet::io
