// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/unread_cells.hpp"

#include <span>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/pieces/loaded.hpp"
#include "io/vtk_xml/cells_reader.hpp"

namespace isotet::io::vtk_xml {

UnreadCells::UnreadCells(CellsInFile cells, const StoredArray& corners)
    : CellSource(std::move(cells.places), std::move(cells.types)),
      path_(std::move(cells.path)),
      document_(std::move(cells.document)),
      size_(document_->source.size()),
      corners_(corners.in(ByteSource(std::string_view()))) {}

Result<StoredArray> UnreadCells::open() const {
    const auto source = ByteSource::open(path_);
    if (!source) return source.error();
    if (source->size() != size_)
        return Error{ErrorCode::file, fmt::format("{}: it had {} bytes and has {} now, so it was changed meanwhile",
                                                  escaped(path_), size_, source->size())};
    return corners_.in(*source);
}

Result<void> UnreadCells::each_block(const Visit& visit) const {
    const auto corners = open();
    if (!corners) return corners.error();
    const ScalarType index = corners->array().type;
    const auto done = corners->each_block([&](std::uint64_t first, std::span<const std::byte> bytes) {
        visit(first, Array(index, bytes.data(), bytes.size() / size_of(index), 1, nullptr));
    });
    return done ? done : in_file(path_, done.error());
}

Result<Cells> UnreadCells::read() const {
    const auto stored = open();
    if (!stored) return stored.error();
    auto corners = read_corners(*stored);
    if (!corners) return in_file(path_, corners.error());
    return cells_at(places(), types(), *std::move(corners));
}

} // namespace isotet::io::vtk_xml
