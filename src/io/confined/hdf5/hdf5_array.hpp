// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

/// A box in a data set, one entry a dimension; all empty: the whole data set.
struct Box {
    std::vector<std::uint64_t> start, stride, count;
};

struct ShapedValues {
    std::vector<std::uint64_t> dimensions;
    Array values; ///< in the type of the file, one component; for a description of the type only, empty

    std::uint64_t count() const;
};

/// How values come into memory.
enum class HdfNumbers : std::uint8_t {
    as_stored,
    indices, ///< integers of 64 bits as int32, where all fit
};

/// Reads a data set of numbers, or only its type and shape. Other files are never opened, whatever links say.
///
/// Errors   invalid_data: no such file or data set, not numbers, the box does not fit; the file is shorter than it says
/// Cost     of a whole one with up to two dimensions that of Hdf5Rows::read(); else HDF5 reads
Result<ShapedValues> read_hdf5_array(const std::string& file, const std::string& name, const Box& box, Depth depth,
                                     HdfNumbers numbers = HdfNumbers::as_stored);

/// Names of the data sets in a group; none where there is no such group.
std::vector<std::string> data_sets_of(const std::string& file, const std::string& group);

/// False where a data set has values that were never written and that nothing stands for.
bool is_written(const std::string& file, const std::string& name);

/// Names of the groups in a group.
std::vector<std::string> groups_of(const std::string& file, const std::string& group);

/// An integer attribute of a group; nothing where there is none.
std::optional<std::int64_t> integer_attribute(const std::string& file, const std::string& group, const char* name);

/// The numbers of an attribute of a group; none where there is no such attribute.
std::vector<double> numbers_attribute(const std::string& file, const std::string& group, const char* name);

/// A text attribute of a group; empty where there is none.
std::string text_attribute(const std::string& file, const std::string& group, const char* name);

} // namespace isotet::io::confined
