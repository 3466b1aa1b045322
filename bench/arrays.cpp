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

Arrays read_arrays(const std::string& folder) {
    Arrays arrays{read_reals(folder + "/points"), read_file<std::int32_t>(folder + "/tets.i32"),
                  read_reals(folder + "/field")};
    if (size(arrays.points) != 3 * size(arrays.field) || arrays.tets.size() % 4 != 0)
        throw std::runtime_error(folder + " has " + std::to_string(size(arrays.points)) + " coordinates, " +
                                 std::to_string(size(arrays.field)) + " values and " +
                                 std::to_string(arrays.tets.size()) + " corners, which is no grid of tets");
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
