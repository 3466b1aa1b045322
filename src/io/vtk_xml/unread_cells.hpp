// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that were left in their file.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "io/pieces/cell_source.hpp"
#include "io/vtk_xml/stored_array.hpp"

namespace isotet::io::vtk_xml {

struct CellsInFile {
    std::string path;
    std::shared_ptr<const Document> document; ///< how the file is written; its source is not used
    CellPlaces places;
    Array types; ///< which these borrow; empty: all of one
};

/// Opens the file whenever it is asked: the pieces of a grid may be more files than a process may have open.
class UnreadCells final : public CellSource {
public:
    /// `corners`   of which each_block() can be called
    UnreadCells(CellsInFile cells, const StoredArray& corners);

    Result<void> each_block(const Visit& visit) const override;
    Result<Cells> read() const override;

private:
    Result<StoredArray> open() const;

    std::string path_;
    std::shared_ptr<const Document> document_;
    std::size_t size_; ///< of the file
    StoredArray corners_;
};

} // namespace isotet::io::vtk_xml
