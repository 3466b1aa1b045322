// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How the tets of cells are turned, and sums of their faces, in one pass over cells that may come by in blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <isotet/array.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/face_sums.hpp"
#include "grid/tet_survey.hpp"

namespace isotet::core {

/// Threads   add() is safe from many threads
class CellSums {
public:
    /// `points`        of the whole grid
    /// `turned_alike`  no tet is mirrored when it is stored, or every one: it need not be found out how each is
    CellSums(const Array& points, bool turned_alike);
    ~CellSums();

    /// Cells [begin, end) of a reader of the same points, which were checked.
    void add(const CellReader& cells, std::size_t begin, std::size_t end);

    /// Once all cells were added.
    void finish();

    /// Then: of the tets how many, and how they are turned. Neither what is used, nor bounds.
    const TetSurvey& tets() const { return tets_; }
    /// By point: 1 where faces must be counted one by one. The sums are freed.
    Buffer<std::uint8_t> take_doubted();
    std::uint64_t doubted() const { return count_; } ///< how many these are

private:
    template <class Number>
    class Adder;
    struct Adders; ///< one a thread

    PointReader points_;
    bool turned_alike_;
    bool wide_;
    FaceSums sums_;
    TetSurvey tets_;
    std::uint64_t count_ = 0;
    std::unique_ptr<Adders> adders_;
};

} // namespace isotet::core
