// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells and fields of cells that were left in an HDF5 file.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/confined/hdf5/hdf5_rows.hpp"
#include "io/pieces/cell_source.hpp"
#include "io/pieces/field_source.hpp"

namespace isotet::io::confined {

class Hdf5Cells final : public CellSource {
public:
    /// `name`    of the data set of corners, integers of 32 or 64 bits in one column
    /// `first`   row of the first corner
    Hdf5Cells(CellPlaces places, Array types, Hdf5Rows rows, std::string name, std::uint64_t first)
        : CellSource(std::move(places), std::move(types)),
          rows_(std::move(rows)),
          name_(std::move(name)),
          first_(first) {}

    Result<void> each_block(const Visit& visit) const override {
        return rows_.each_block(name_, first_, places().corners(), visit);
    }
    Result<Cells> read() const override {
        auto corners = rows_.read_indices(name_, first_, places().corners());
        if (!corners) return corners.error();
        return cells_at(places(), types(), *std::move(corners));
    }

private:
    Hdf5Rows rows_;
    std::string name_;
    std::uint64_t first_;
};

class Hdf5Values final : public FieldSource {
public:
    /// Rows [first, first + rows) of a data set, which has them.
    Hdf5Values(Hdf5Rows rows, std::string name, std::uint64_t first, std::uint64_t count)
        : rows_(std::move(rows)), name_(std::move(name)), first_(first), count_(count) {}

    Result<Array> read(const std::vector<std::uint64_t>& cells) const override {
        return rows_.read_some(name_, first_, count_, cells);
    }
    Result<Array> read() const override { return rows_.read(name_, first_, count_); }

private:
    Hdf5Rows rows_;
    std::string name_;
    std::uint64_t first_, count_;
};

} // namespace isotet::io::confined
