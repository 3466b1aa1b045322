// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "io/own/loaded.hpp"

namespace isotet::io {

/// Where the points of each piece go in the joined grid.
struct PointNumbers {
    std::vector<std::vector<std::uint64_t>> numbers; ///< per piece, one a point; empty where no point was joined
    std::vector<std::uint64_t> first;                ///< number of a piece's first point, where `numbers` is empty
    std::uint64_t count = 0;
    std::uint64_t joined = 0; ///< points merged with one of an earlier piece

    struct Joined {
        std::size_t piece, point;
    };
    std::vector<Joined> joined_points; ///< by coordinates only

    std::uint64_t operator()(std::size_t piece, std::uint64_t point) const {
        return numbers.empty() ? first[piece] + point : numbers[piece][point];
    }
};

PointNumbers number_one_after_another(const std::vector<Piece>& pieces);

/// By global number. Nothing when one number stands for points at different places: then it is no global number.
std::optional<PointNumbers> number_by_ids(const std::vector<Piece>& pieces);

/// By exactly equal coordinates (-0 equals +0) of different pieces; points of one piece stay apart.
PointNumbers number_by_coordinates(const std::vector<Piece>& pieces);

} // namespace isotet::io
