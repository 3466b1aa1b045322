// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any boxes on any levels, with any marks, as one grid.
#include <cstring>

#include "fuzz/read_input.hpp"
#include "io/amr/boxes_as_pieces.hpp"
#include "io/pieces/join/join.hpp"

namespace {

/// Numbers from the bytes; 0 behind their end.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    int next() { return at_ < size_ ? data_[at_++] : 0; }

private:
    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

isotet::io::amr::CellBox box_of(Bytes& bytes) {
    isotet::io::amr::CellBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.first[axis] = bytes.next() - 128;
        box.last[axis] = box.first[axis] + bytes.next() % 9 - 1;
    }
    return box;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    Bytes bytes(data, size);
    io::amr::Hierarchy all;
    io::Loaded loaded;
    const int levels = bytes.next() % 4;
    double spacing = 1;
    for (int i = 0; i < levels; ++i) {
        io::amr::Level& level = all.levels.emplace_back();
        level.spacing = {spacing, spacing, spacing};
        spacing /= bytes.next() % 4;
        for (int count = bytes.next() % 4; count > 0; --count) {
            const io::amr::CellBox box = level.boxes.emplace_back(box_of(bytes));
            io::Piece& piece = loaded.pieces.emplace_back();
            if (box.last[0] < box.first[0] || box.last[1] < box.first[1] || box.last[2] < box.first[2]) continue;
            std::vector<float> values(box.cells());
            for (float& value : values) value = static_cast<float>(bytes.next());
            if (bytes.next() % 2 == 0)
                for (const float value : values) piece.left_out.push_back(value < 64);
            piece.grid.cell_fields.push_back({"s", Array::own(std::move(values))});
        }
    }
    if (const auto done = io::amr::boxes_as_pieces(all, {}, loaded, {}); !done) {
        if (done.error().message.empty() || done.error().code != ErrorCode::invalid_data) std::abort();
        return 0;
    }
    const auto result = io::join(std::move(loaded), {});
    if (!result) std::abort();
    const auto cells = core::CellReader::open(result->grid);
    if (!cells || !core::check_cells(result->grid, *cells, {})) std::abort();
    return 0;
}
