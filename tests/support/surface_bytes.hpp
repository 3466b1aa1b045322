// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All bytes of a surface as one string, to compare surfaces bit for bit.
#pragma once

#include <string>

#include <isotet/surface.hpp>

namespace isotet::test {

inline void append_bytes(std::string& out, const Array& array) {
    out += std::string(name_of(array.type())) + " " + std::to_string(array.tuples()) + "x" +
           std::to_string(array.components()) + ":";
    out.append(static_cast<const char*>(array.data()), array.bytes());
}

inline std::string bytes_of(const Surface& s) {
    std::string out;
    for (const Array* array : {&s.positions, &s.triangles, &s.normals, &s.edge_ends, &s.edge_weights, &s.source_cells})
        append_bytes(out, *array);
    for (const auto* fields : {&s.point_fields, &s.cell_fields})
        for (const Field& field : *fields) {
            out += field.name;
            append_bytes(out, field.values);
        }
    return out;
}

} // namespace isotet::test
