// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/unread_cells.hpp"

#include <span>
#include <utility>

#include "io/pieces/loaded.hpp"
#include "io/vtk_xml/cells_reader.hpp"

namespace isotet::io::vtk_xml {

Result<void> UnreadCells::each_block(const Visit& visit) const {
    const auto corners = corners_.open();
    if (!corners) return corners.error();
    const ScalarType index = corners->array().type;
    const auto done = corners->each_block([&](std::uint64_t first, std::span<const std::byte> bytes) {
        visit(first, Array(index, bytes.data(), bytes.size() / size_of(index), 1, nullptr));
    });
    return done ? done : in_file(corners_.path(), done.error());
}

Result<Cells> UnreadCells::read() const {
    const auto stored = corners_.open();
    if (!stored) return stored.error();
    auto corners = read_corners(*stored);
    if (!corners) return in_file(corners_.path(), corners.error());
    return cells_at(places(), types(), *std::move(corners));
}

} // namespace isotet::io::vtk_xml
