// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io::confined {

/// An open netCDF file: classic, with 64-bit offsets or data, or in HDF5. Dimensions and variables are found by name.
///
/// The classic formats are read here and not by netCDF's library, which gives zeros beyond the end of a file and brings curl
/// and libxml2 into a process that is to open nothing but its file.
///
/// Threads   one call at a time; rows() is safe from many threads
class NetcdfFile {
public:
    /// Errors   invalid_data: no such file, a header that is broken, a file that ends before its first whole record
    static Result<std::unique_ptr<NetcdfFile>> open(const std::string& path);
    NetcdfFile() = default;
    NetcdfFile(const NetcdfFile&) = delete;
    NetcdfFile& operator=(const NetcdfFile&) = delete;
    virtual ~NetcdfFile() = default;

    /// Nothing where there is no such dimension.
    virtual std::optional<std::uint64_t> dimension(const std::string& name) const = 0;
    /// Of a variable of numbers; nothing where there is none.
    virtual std::optional<std::vector<std::uint64_t>> shape(const std::string& variable) const = 0;
    /// All values at some places of the first dimension, in the type of the file, one component.
    ///
    /// Errors   invalid_data: no such variable, places that it does not have, values that cannot be read; out_of_memory
    virtual Result<Array> rows(const std::string& variable, std::uint64_t first, std::uint64_t count) const = 0;
    /// Of a variable of letters the rows, up to the first zero, without spaces at their ends; none where there is none.
    virtual std::vector<std::string> texts(const std::string& variable) const = 0;
    /// Of a variable, or of the file where it is empty. Nothing where there is none of that kind.
    virtual std::optional<std::string> text_attribute(const std::string& variable, const char* name) const = 0;
    virtual std::optional<double> number_attribute(const std::string& variable, const char* name) const = 0;

    /// The last ones of the unlimited dimension, which the file ends before: dimensions and variables lack them.
    virtual std::uint64_t records_cut_off() const { return 0; }

    bool has(const std::string& variable) const { return shape(variable).has_value(); }
    /// All values of a variable, as int32, int64, float or double; nothing where they cannot be read.
    template <class T>
    std::optional<std::vector<T>> numbers(const std::string& variable) const;
};

/// Letters in rows of so many.
std::vector<std::string> rows_of_letters(const char* all, std::uint64_t rows, std::uint64_t letters);

Result<std::unique_ptr<NetcdfFile>> open_netcdf_classic(const std::string& path, ByteSource file);
Result<std::unique_ptr<NetcdfFile>> open_netcdf_hdf5(const std::string& path);

} // namespace isotet::io::confined
