// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid of tets as plain arrays in files of one folder, from which every contestant fills its own memory: the same
// arrays for all of them. Sizes of the files tell the counts. C++17.
//
//   points.f32 or points.f64   x y z of each point
//   tets.i32                   four point numbers of each tet
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

struct Arrays {
    Reals points;
    std::vector<std::int32_t> tets;
    Reals field;

    std::size_t point_count() const { return size(field); }
    std::size_t tet_count() const { return tets.size() / 4; }
};

/// Throws std::runtime_error when a file is not there, or its size is not what the others ask for.
Arrays read_arrays(const std::string& folder);

/// Writes `bytes` bytes as FOLDER/NAME; throws std::runtime_error.
void write_array(const std::string& folder, const std::string& name, const void* data, std::size_t bytes);

} // namespace isotet::bench
