// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/arrays.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace isotet::bench {

namespace {

namespace fs = std::filesystem;

template <class T>
std::vector<T> read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + " cannot be opened");
    std::vector<T> values(fs::file_size(path) / sizeof(T));
    file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
    if (!file) throw std::runtime_error(path + " cannot be read to its end");
    return values;
}

Reals read_reals(const std::string& path) {
    if (fs::exists(path + ".f64")) return read_file<double>(path + ".f64");
    return read_file<float>(path + ".f32");
}

} // namespace

std::size_t corners_of_type(std::uint8_t type) {
    switch (type) {
    case 10: return 4;
    case 11:
    case 12: return 8;
    case 13: return 6;
    case 14: return 5;
    }
    throw std::runtime_error("cells of VTK's type " + std::to_string(type) + " are not raced");
}

Arrays read_arrays(const std::string& folder) {
    Arrays arrays;
    arrays.points = read_reals(folder + "/points");
    arrays.corners = read_file<std::int32_t>(folder + "/corners.i32");
    if (fs::exists(folder + "/offsets.i64")) arrays.offsets = read_file<std::int64_t>(folder + "/offsets.i64");
    arrays.types = read_file<std::uint8_t>(folder + "/types.u8");
    arrays.field = read_reals(folder + "/field");
    const bool whole = arrays.uniform() ? arrays.types.size() == 1 : arrays.types.size() == arrays.offsets.size() - 1;
    if (size(arrays.points) != 3 * size(arrays.field) || !whole)
        throw std::runtime_error(folder + " has " + std::to_string(size(arrays.points)) + " coordinates, " +
                                 std::to_string(size(arrays.field)) + " values, " +
                                 std::to_string(arrays.types.size()) + " types and " +
                                 std::to_string(arrays.offsets.size()) + " offsets, which is no grid");
    return arrays;
}

void write_array(const std::string& folder, const std::string& name, const void* data, std::size_t bytes) {
    const std::string path = folder + "/" + name;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    file.close();
    if (!file) throw std::runtime_error(path + " cannot be written");
}

} // namespace isotet::bench
