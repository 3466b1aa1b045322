// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that are read after the points of their piece, so that only those that are needed are kept.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include <isotet/array.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/pieces/cell_places.hpp"

namespace isotet::io {

/// The cells of a piece in its file: of linear types, one after another.
///
/// Threads   safe from many threads
class CellSource {
public:
    /// `types`   which `places` borrows; empty where all are of one
    CellSource(CellPlaces places, Array types) : places_(std::move(places)), types_(std::move(types)) {}
    CellSource(const CellSource&) = delete;
    CellSource& operator=(const CellSource&) = delete;
    virtual ~CellSource() = default;

    std::uint64_t count() const noexcept { return places_.cells(); }
    const CellPlaces& places() const noexcept { return places_; }

    /// Corners of 32 or 64 bits, not checked; `first`: how many corners come before. The array is not kept.
    using Visit = std::function<void(std::uint64_t first, const Array& corners)>;

    /// Calls visit() for blocks of the corners, in any order, from many threads. A block may begin and end in a cell.
    ///
    /// Errors   file: it was changed meanwhile; else as reading the cells
    virtual Result<void> each_block(const Visit& visit) const = 0;

    /// All cells.
    virtual Result<Cells> read() const = 0;

protected:
    const Array& types() const noexcept { return types_; }

private:
    CellPlaces places_;
    Array types_;
};

} // namespace isotet::io
