// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/netcdf/netcdf_file.hpp"

#include <algorithm>

#include "io/pieces/common_type.hpp"

namespace isotet::io::confined {

std::vector<std::string> rows_of_letters(const char* all, std::uint64_t rows, std::uint64_t letters) {
    std::vector<std::string> texts;
    for (std::uint64_t row = 0; row < rows; ++row) {
        std::string& text = texts.emplace_back(all + row * letters, letters);
        text.resize(std::min(text.find('\0'), text.size()));
        text.resize(text.find_last_not_of(' ') + 1);
    }
    return texts;
}

Result<std::unique_ptr<NetcdfFile>> NetcdfFile::open(const std::string& path) {
    auto file = ByteSource::open(path);
    if (!file) return file.error();
    Scratch scratch;
    const auto head = file->view(0, std::min<std::size_t>(file->size(), 3), scratch);
    if (!head) return head.error();
    return *head == "CDF" ? open_netcdf_classic(path, *std::move(file)) : open_netcdf_hdf5(path);
}

template <class T>
std::optional<std::vector<T>> NetcdfFile::numbers(const std::string& variable) const {
    const auto dimensions = shape(variable);
    if (!dimensions || dimensions->empty()) return std::nullopt;
    const auto all = rows(variable, 0, dimensions->front());
    if (!all) return std::nullopt;
    std::vector<T> values(all->size());
    convert_scalars(*all, isotet::scalar_type_of<T>(), reinterpret_cast<std::byte*>(values.data()));
    return values;
}

template std::optional<std::vector<std::int32_t>> NetcdfFile::numbers(const std::string&) const;
template std::optional<std::vector<std::int64_t>> NetcdfFile::numbers(const std::string&) const;
template std::optional<std::vector<float>> NetcdfFile::numbers(const std::string&) const;
template std::optional<std::vector<double>> NetcdfFile::numbers(const std::string&) const;

} // namespace isotet::io::confined
