// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The tags of a VTK file, without the text between them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io::vtk_xml {

/// XML that is as large as the elements are, however large the data between them is.
struct Outline {
    /// All tags, in their order. Text that follows a start tag is replaced by its place in the file, "BEGIN END "; of an
    /// array all text is, which comments, CDATA and other elements cut into several. Other text, comments and document
    /// types are dropped. After the start tag of AppendedData the elements are closed.
    std::string text;
    std::optional<std::size_t> appended;                   ///< the first byte behind that start tag
    bool ended = false;                                    ///< the end tag </VTKFile> was found, or the appended data
    std::vector<std::pair<std::size_t, std::size_t>> tags; ///< where each tag begins: in `text`, in the file

    /// The position in the file of the tag that stands at a position of `text`.
    std::size_t position_of(std::size_t in_text) const;
};

/// Errors   invalid_data: a tag that never ends, a tag inside a tag, more than 64 MB of tags;
///          as ByteSource::read(); cancelled
/// Cost     one pass over the text before the appended data, as fast as memory
Result<Outline> outline_of(const ByteSource& source, const Progress& progress);

} // namespace isotet::io::vtk_xml
