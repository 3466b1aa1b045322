// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The groups, attributes and data sets of a MED file, which is HDF5.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "io/confined/hdf5/hdf5_file.hpp"
#include "io/confined/hdf5/hdf5_rows.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

/// An open file. Links are followed: check_hdf5_names() first.
/// Threads   one call at a time: HDF5 is not safe from several
class MedFile {
public:
    /// Errors   invalid_data: not an HDF5 file, or not MED of version 3.0 or later
    static Result<MedFile> open(const std::string& path);

    const std::string& path() const { return path_; }
    Error wrong(std::string_view what) const { return broken(path_, what); }

    /// By name; empty where there is no such group.
    std::vector<std::string> groups(const std::string& group) const;
    bool has(const std::string& data_set) const { return rows_.shape(data_set).has_value(); }

    /// Attributes; nothing or empty where there is none of this kind.
    std::optional<std::int64_t> integer(const std::string& group, const char* name) const;
    std::optional<double> real(const std::string& group, const char* name) const;
    std::string text(const std::string& group, const char* name) const;

    /// A data set of texts of 80 letters, without what fills them.
    std::vector<std::string> texts(const std::string& data_set) const;

    /// A data set of numbers with one dimension.
    ///
    /// Errors   invalid_data: not there, no numbers, or not `count` of them; out_of_memory
    Result<Array> numbers(const std::string& data_set, std::uint64_t count) const {
        return numbers(data_set, count, 0, count);
    }
    /// Some of them.
    Result<Array> numbers(const std::string& data_set, std::uint64_t count, std::uint64_t first,
                          std::uint64_t some) const;
    /// The same, which are not kept (Hdf5Rows::each_block()).
    Result<void> each_block(const std::string& data_set, std::uint64_t count, const Hdf5Rows::Visit& visit) const;

    /// Nothing where there is no data set of this kind.
    std::optional<RowsShape> shape(const std::string& data_set) const { return rows_.shape(data_set); }

private:
    Result<void> check(const std::string& data_set, std::uint64_t count) const;
    MedFile(std::string path, std::shared_ptr<const Hdf5File> file, Hdf5Rows rows)
        : path_(std::move(path)), file_(std::move(file)), rows_(std::move(rows)) {}

    std::string path_;
    std::shared_ptr<const Hdf5File> file_;
    Hdf5Rows rows_;
};

/// When something of a file holds: a step, its iteration, and its time.
struct MedStep {
    std::int64_t number = -1, iteration = -1; ///< -1: at all times
    double time = 0;
    std::string group;

    bool always() const { return number < 0 && iteration < 0; }
    auto key() const { return std::tuple(number, iteration, time); }
};

/// The steps in a group, ascending.
std::vector<MedStep> med_steps(const MedFile& file, const std::string& group);

} // namespace isotet::io::confined
