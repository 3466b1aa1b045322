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
    std::string out(reinterpret_cast<const char*>(s.origin.data()), sizeof s.origin);
    for (const Array* array : {&s.positions, &s.triangles, &s.normals, &s.edge_ends, &s.edge_weights, &s.source_cells})
        append_bytes(out, *array);
    for (const auto* fields : {&s.point_fields, &s.cell_fields})
        for (const SurfaceField& field : *fields) {
            out += field.name + " " + std::to_string(field.offset) + " " + std::to_string(field.scale);
            append_bytes(out, field.values);
        }
    return out;
}

} // namespace isotet::test
