// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/tet_records.hpp"

#include <array>
#include <cstring>

#include "base/parallel.hpp"
#include "render/layout.hpp"

namespace isotet::render {

namespace {

using Corners = std::array<std::array<float, 4>, 4>;

Corners corners_of(const core::TetTable& table, std::uint64_t tet) {
    const auto& points = table.tets[tet];
    return {table.points[points[0]], table.points[points[1]], table.points[points[2]], table.points[points[3]]};
}

/// Calls write(tet, where its record goes) for each tet.
template <class Write>
void for_each_record(std::uint64_t first, std::size_t bytes, std::span<std::byte> out, const Write& write) {
    core::parallel_each(out.size() / bytes, 1024, [&](std::size_t i) { write(first + i, out.data() + i * bytes); });
}

} // namespace

std::uint64_t record_bytes(DrawMethod method) {
    switch (method) {
    case DrawMethod::registers: return 4 * sizeof(layout::TetRegisters);
    case DrawMethod::registers_instanced: return sizeof(Corners);
    case DrawMethod::textures:
    case DrawMethod::mesh: return sizeof(core::TetTable::tets[0]);
    }
    return 0;
}

void write_records(DrawMethod method, const core::TetTable& table, std::uint64_t first, std::span<std::byte> out) {
    const std::size_t bytes = record_bytes(method);
    switch (method) {
    case DrawMethod::registers:
        for_each_record(first, bytes, out, [&](std::uint64_t tet, std::byte* record) {
            const Corners corners = corners_of(table, tet);
            for (std::uint32_t number = 0; number < 4; ++number) {
                std::memcpy(record, &corners, sizeof corners);
                std::memcpy(record + sizeof corners, &number, sizeof number);
                record += sizeof(layout::TetRegisters);
            }
        });
        return;
    case DrawMethod::registers_instanced:
        for_each_record(first, bytes, out, [&](std::uint64_t tet, std::byte* record) {
            const Corners corners = corners_of(table, tet);
            std::memcpy(record, &corners, sizeof corners);
        });
        return;
    case DrawMethod::textures:
    case DrawMethod::mesh: std::memcpy(out.data(), table.tets.data() + first, out.size()); return;
    }
}

} // namespace isotet::render
