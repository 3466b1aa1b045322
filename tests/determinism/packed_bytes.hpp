// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All bytes of a packed grid that engines read, as one string.
#pragma once

#include <string>

#include <isotet/pack.hpp>

#include "packed/packed.hpp"

namespace isotet::test {

template <class T>
void append_bytes(std::string& out, const core::SharedBuffer<T>& buffer) {
    out += std::to_string(buffer.size()) + ":";
    out.append(reinterpret_cast<const char*>(buffer.data()), buffer.bytes());
}

inline std::string bytes_of(const PackedGrid& grid) {
    const core::Packed& packed = grid.data();
    std::string out;
    append_bytes(out, packed.headers);
    append_bytes(out, packed.cells);
    append_bytes(out, packed.group_ranges);
    append_bytes(out, packed.links);
    append_bytes(out, packed.has_no_data);
    append_bytes(out, packed.point_ids);
    append_bytes(out, packed.wide_point_ids);
    append_bytes(out, packed.cell_ids);
    append_bytes(out, packed.wide_cell_ids);
    append_bytes(out, packed.gradients);
    std::visit(
        [&](const auto& reals) {
            append_bytes(out, reals.positions);
            append_bytes(out, reals.values);
            append_bytes(out, reals.ranges);
        },
        packed.reals);
    out.append(reinterpret_cast<const char*>(packed.origin.data()), sizeof packed.origin);
    out.append(reinterpret_cast<const char*>(&packed.storage.offset), sizeof(double));
    out.append(reinterpret_cast<const char*>(&packed.storage.scale), sizeof(double));
    return out;
}

} // namespace isotet::test
