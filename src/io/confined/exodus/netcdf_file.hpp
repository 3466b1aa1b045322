// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::io::confined {

/// An open netCDF file of any kind: classic, with 64-bit offsets or data, or in HDF5. Variables and dimensions are looked up by
/// name.
/// Threads   one call at a time
class NetcdfFile {
public:
    /// Nothing: it is no such file.
    static std::optional<NetcdfFile> open(const std::string& path);
    NetcdfFile(NetcdfFile&& other) noexcept;
    NetcdfFile& operator=(NetcdfFile&&) = delete;
    ~NetcdfFile();

    /// Nothing where there is no such dimension.
    std::optional<std::uint64_t> dimension(const std::string& name) const;
    bool has(const std::string& variable) const { return shape(variable).has_value(); }
    /// Nothing where there is no such variable; of a single value empty.
    std::optional<std::vector<std::uint64_t>> shape(const std::string& variable) const;
    /// True where a variable is there, with these dimensions.
    bool has_shape(const std::string& variable, std::span<const std::uint64_t> dimensions) const {
        const auto found = shape(variable);
        return found && std::vector(dimensions.begin(), dimensions.end()) == *found;
    }

    /// A part of a variable, one place and count a dimension, as int32, int64, float or double, whatever the file has. False
    /// where it is not there, or has numbers that the type cannot hold.
    template <class T>
    bool read(const std::string& variable, std::span<const std::uint64_t> start, std::span<const std::uint64_t> count,
              T* values) const;
    /// All of it; nothing where it cannot be read.
    template <class T>
    std::optional<std::vector<T>> read(const std::string& variable) const;
    /// Rows of letters, up to the first zero, without spaces at their ends.
    std::vector<std::string> texts(const std::string& variable) const;

    /// Of a variable, or of the file where it is empty. Nothing where there is none of that kind.
    std::optional<std::string> text_attribute(const std::string& variable, const char* name) const;
    std::optional<double> number_attribute(const std::string& variable, const char* name) const;

private:
    explicit NetcdfFile(int number) : number_(number) {}
    /// Below 0: there is none.
    int variable(const std::string& name) const;

    int number_ = -1;
};

} // namespace isotet::io::confined
