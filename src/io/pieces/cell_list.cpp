// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/cell_list.hpp"

#include <limits>
#include <utility>

#include "grid/cells.hpp"

namespace isotet::io {

bool CellList::one_contoured_type() const {
    if (runs_.empty()) return true;
    return runs_.size() == 1 && core::is_contoured(runs_.front().type) &&
           static_cast<std::uint32_t>(core::corners_of(runs_.front().type)) == runs_.front().corners;
}

template <class Offset>
Array CellList::offsets() const {
    std::vector<Offset> result;
    result.reserve(cells_ + 1);
    Offset next = 0;
    result.push_back(next);
    for (const Run& run : runs_) {
        for (std::uint64_t i = 0; i < run.cells; ++i) result.push_back(next += static_cast<Offset>(run.corners));
    }
    return Array::own(std::move(result));
}

Cells CellList::finish() {
    Cells cells;
    const std::uint64_t corners = wide_ ? wide_corners_.size() : corners_.size();
    if (one_contoured_type()) {
        if (!runs_.empty()) cells.uniform_type = static_cast<CellType>(runs_.front().type);
    } else {
        const bool narrow = corners <= static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
        cells.offsets = narrow ? offsets<std::int32_t>() : offsets<std::int64_t>();
        std::vector<std::uint8_t> types;
        types.reserve(cells_);
        for (const Run& run : runs_) types.insert(types.end(), run.cells, run.type);
        cells.types = Array::own(std::move(types));
    }
    cells.connectivity = wide_ ? Array::own(std::move(wide_corners_)) : Array::own(std::move(corners_));
    runs_.clear();
    cells_ = 0;
    return cells;
}

} // namespace isotet::io
