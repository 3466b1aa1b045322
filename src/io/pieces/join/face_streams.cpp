// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/face_streams.hpp"

#include <fmt/core.h>

namespace isotet::io {

Result<void> check_face_streams(const Cells& cells, std::uint64_t points) {
    const auto faces = core::FaceReader::open(cells);
    if (!faces) return faces.error();
    if (!faces->has_faces()) return {};
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (const std::string fault = core::fault_of_faces(*faces, cell, points); !fault.empty())
            return invalid_data(fmt::format("cell {} of a piece {}", cell, fault));
    return {};
}

} // namespace isotet::io
