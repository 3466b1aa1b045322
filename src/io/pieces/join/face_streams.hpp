// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The faces of polyhedra of several pieces as one stream (Cells::faces), with other point numbers.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>

#include "base/errors.hpp"
#include "grid/cell_faces.hpp"

namespace isotet::io {

/// Shapes and entries: faces that fill their parts, of points that are there.
Result<void> check_face_streams(const Cells& cells, std::uint64_t points);

/// Cells one after another; those of checked pieces only.
class FaceStreams {
public:
    /// The cells of a piece but those marked in `left_out`, which may be empty.
    template <class Number>
    void add(const Cells& cells, const std::vector<std::uint8_t>& left_out, const Number& number) {
        const auto faces = core::FaceReader::open(cells);
        for (std::size_t cell = 0; cell < cells.count(); ++cell)
            if (left_out.empty() || left_out[cell] == 0) add_cell(*faces, cell, number);
    }

    /// Nothing where no cell has faces.
    void give_to(Cells& cells) && {
        if (stream_.empty()) return;
        cells.faces = Array::own(std::move(stream_));
        cells.face_offsets = Array::own(std::move(offsets_));
    }

private:
    template <class Number>
    void add_cell(const core::FaceReader& faces, std::size_t cell, const Number& number) {
        std::uint64_t at = faces.begin(cell);
        const std::uint64_t end = faces.end(cell);
        if (at < end) stream_.push_back(static_cast<std::int64_t>(faces.at(at++))); // faces
        while (at < end) {
            const std::uint64_t count = faces.at(at++);
            stream_.push_back(static_cast<std::int64_t>(count));
            for (std::uint64_t i = 0; i < count && at < end; ++i)
                stream_.push_back(static_cast<std::int64_t>(number(faces.at(at++))));
        }
        offsets_.push_back(static_cast<std::int64_t>(stream_.size()));
    }

    std::vector<std::int64_t> stream_, offsets_{0};
};

} // namespace isotet::io
