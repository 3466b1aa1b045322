// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that were left in their file.
#pragma once

#include <utility>

#include "io/pieces/cell_source.hpp"
#include "io/vtk_xml/array_in_file.hpp"

namespace isotet::io::vtk_xml {

class UnreadCells final : public CellSource {
public:
    /// `types`     which `places` borrow; empty: all of one
    /// `corners`   of which each_block() can be called
    UnreadCells(CellPlaces places, Array types, ArrayInFile corners)
        : CellSource(std::move(places), std::move(types)), corners_(std::move(corners)) {}

    Result<void> each_block(const Visit& visit) const override;
    Result<Cells> read() const override;

private:
    ArrayInFile corners_;
};

} // namespace isotet::io::vtk_xml
