// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Rows of data sets in an HDF5 file. HDF5 tells where they lie; they are read and inflated here, on all threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

namespace isotet::io::confined {

struct RowsShape {
    std::uint64_t rows = 0;
    std::size_t columns = 1;
    ScalarType type = ScalarType::float32;
    bool is_single = false; ///< one value without dimensions, which is one row
};

/// An open file. Copies share it. Links and outside storage are followed: check_hdf5_names() first.
/// Threads   safe from many threads, while nothing else calls HDF5
class Hdf5Rows {
public:
    /// Errors   invalid_data: not an HDF5 file; as ByteSource::open()
    static Result<Hdf5Rows> open(const std::string& path);

    /// Nothing where there is no data set of this name with up to two dimensions of numbers.
    std::optional<RowsShape> shape(const std::string& name) const;

    /// Errors   invalid_data: no such data set, rows that it does not have
    Result<void> check(const std::string& name, std::uint64_t first, std::uint64_t rows) const;

    /// Some rows of a data set, in the type of the file, one tuple a row.
    ///
    /// Errors   invalid_data: no such data set, rows that it does not have or that were never written, what cannot be
    ///          inflated; out_of_memory
    /// Cost     chunks that are stored as they are, deflated or shuffled are read side by side; others by HDF5, one after
    ///          another
    Result<Array> read(const std::string& name, std::uint64_t first, std::uint64_t rows) const;

    /// Of rows [first, first + rows) those with some numbers, counted from `first`, ascending. Of chunks without any nothing
    /// is read.
    ///
    /// Errors   as read()
    Result<Array> read_some(const std::string& name, std::uint64_t first, std::uint64_t rows,
                            const std::vector<std::uint64_t>& numbers) const;

    /// The same, of integers of 64 bits as int32 where all fit.
    ///
    /// Errors   as read()
    /// Cost     as read(), and no more memory than the int32 and a few MB a thread
    Result<Array> read_indices(const std::string& name, std::uint64_t first, std::uint64_t rows) const;

    /// Some values of a data set as they are in the file, which are not kept: visit(first, values) for blocks of whole
    /// rows, in any order, from many threads. `first`: how many of the values come before.
    ///
    /// Errors   as read()
    /// Cost     as read(), and a few MB a thread
    using Visit = std::function<void(std::uint64_t first, const Array& values)>;
    Result<void> each_block(const std::string& name, std::uint64_t first, std::uint64_t rows, const Visit& visit) const;

    /// The whole data set.
    Result<Array> read(const std::string& name) const;

private:
    struct File;
    explicit Hdf5Rows(std::shared_ptr<const File> file);
    std::shared_ptr<const File> file_;
};

} // namespace isotet::io::confined
