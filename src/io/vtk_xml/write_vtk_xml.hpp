// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's XML files with raw appended data: a header that names arrays, then their bytes, packed or not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/write/write_stream.hpp"

namespace isotet::io {

/// Collects header and arrays, then writes both. Little endian, block sizes are UInt64. Columns must outlive it.
class VtkXmlFile {
public:
    VtkXmlFile(std::string_view dataset, Compression compression);

    /// A line of the header as it is.
    void line(std::string_view text);
    void array(const Column& column);
    /// Without a number of components: the scalars one after another.
    void flat_array(const Column& column);
    /// Of FieldData: with its number of tuples, which nothing else tells.
    void array_of_file(const Column& column);
    void write(WriteStream& stream) const;

    /// Bytes of the whole file without compression, about.
    std::uint64_t bytes() const noexcept { return bytes_; }

private:
    /// An array, and the lines before it.
    struct Entry {
        std::string lines, attributes;
        const Column* column;
    };

    void add(const Column& column, std::string_view components);
    std::string header(const std::vector<std::uint64_t>& bytes_of_columns) const;

    std::string dataset_;
    Compression compression_;
    std::vector<Entry> entries_;
    std::string lines_; ///< behind the last array
    std::uint64_t bytes_ = 0;
};

} // namespace isotet::io
