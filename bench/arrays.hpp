// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid as plain arrays in files of one folder, from which every contestant fills its own memory: the same arrays for
// all of them. Sizes of the files tell the counts. C++17.
//
//   points.f32 or points.f64   x y z of each point
//   corners.i32                point numbers of each cell, in VTK's order
//   types.u8                   VTK's type of each cell; one byte where all cells are of one type
//   offsets.i64                where the corners of each cell begin, and their end; not there where all cells are of one
//                              type
//   field.f32 or field.f64     one value of each point
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace isotet::bench {

using Reals = std::variant<std::vector<float>, std::vector<double>>;

inline std::size_t size(const Reals& reals) {
    return std::visit([](const auto& values) { return values.size(); }, reals);
}
inline std::size_t bytes(const Reals& reals) {
    return std::visit([](const auto& values) { return values.size() * sizeof(values[0]); }, reals);
}

/// Of a tet, voxel, hexahedron, wedge or pyramid, by VTK's number.
std::size_t corners_of_type(std::uint8_t type);

struct Arrays {
    Reals points;
    std::vector<std::int32_t> corners;
    std::vector<std::int64_t> offsets;
    std::vector<std::uint8_t> types;
    Reals field;

    bool uniform() const { return offsets.empty(); }
    std::size_t cell_count() const {
        return uniform() ? corners.size() / corners_of_type(types[0]) : offsets.size() - 1;
    }
};

/// Throws std::runtime_error when a file is not there, or its size is not what the others ask for.
Arrays read_arrays(const std::string& folder);

/// Writes `bytes` bytes as FOLDER/NAME; throws std::runtime_error.
void write_array(const std::string& folder, const std::string& name, const void* data, std::size_t bytes);

} // namespace isotet::bench
