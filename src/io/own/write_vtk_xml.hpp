// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's XML files with raw appended data: a header that names arrays, then their bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/own/write_stream.hpp"

namespace isotet::io {

/// Collects header and arrays, then writes both. Little endian, block sizes are UInt64. Columns must outlive it.
class VtkXmlFile {
public:
    explicit VtkXmlFile(std::string_view dataset);

    /// A line of the header as it is.
    void line(std::string_view text);
    void array(const Column& column);
    /// Without a number of components: the scalars one after another.
    void flat_array(const Column& column);
    void write(WriteStream& stream) const;

    /// Bytes of the whole file, about.
    std::uint64_t bytes() const noexcept { return header_.size() + offset_; }

private:
    void add(const Column& column, std::string_view components);

    std::string dataset_;
    std::string header_;
    std::vector<const Column*> columns_;
    std::uint64_t offset_ = 0;
};

} // namespace isotet::io
