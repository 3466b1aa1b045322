// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays that are read later than the rest of their file.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <isotet/result.hpp>

#include "io/vtk_xml/stored_array.hpp"

namespace isotet::io::vtk_xml {

/// Opens the file whenever it is asked, unless it is in memory: the pieces of a grid may be more files than a process may
/// have open.
class ArrayInFile {
public:
    /// `document`   how the file is written; its source is taken here, if it is in memory
    ArrayInFile(std::string path, std::shared_ptr<const Document> document, const StoredArray& stored);

    const std::string& path() const noexcept { return path_; }

    /// Errors   file: it was changed meanwhile; as ByteSource::open()
    Result<StoredArray> open() const;

private:
    std::string path_;
    std::shared_ptr<const Document> document_;
    ByteSource held_;  ///< in memory; else empty
    std::size_t size_; ///< of the file
    StoredArray stored_;
};

} // namespace isotet::io::vtk_xml
