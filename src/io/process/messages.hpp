// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What isotet asks of its reader process, and what comes back: a request is plain bytes; a reply is a memory file whose
// arrays stay where they are, so that the grid is never copied on this side.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <isotet/boundary.hpp>
#include <isotet/export.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io::confined {

enum class Task : std::uint8_t { inspect, read, survey };

struct Request {
    Task task = Task::read;
    std::string format; ///< name in formats()
    std::string path;   ///< absolute
    ReadOptions options;
    std::vector<std::string> readable; ///< folders and files that reading may look at, absolute
};

/// A grid, and the boundary that was asked for (ReadActiveCells::boundary).
struct GridReply {
    ReadResult read;
    StreamedBoundary boundary = {};
    bool is_same = false; ///< it is that of the request, whose surface the reply does not have
};

using Reply = std::variant<Error, FileInfo, GridReply, SurveyedGrid>;

std::string encode(const Request& request);

/// Errors   internal when the bytes are not a request of this version
ISOTET_API Result<Request> decode_request(std::string_view bytes);

/// Writes a reply into a memory file. Arrays are written one by one and let go as soon as they are written, so that the
/// peak is the grid and its largest array.
///
/// Errors   out_of_memory when the memory file cannot grow; system when a limit on the size of files forbids it
ISOTET_API Result<void> write_reply(int descriptor, Reply reply);

/// Seals the memory file, maps it read only, and verifies every offset and length in it before it is used. The arrays
/// of the reply are views of the mapping and share it.
///
/// Guarantees   whoever wrote the file cannot change, shrink or make it invalid afterwards
/// Errors       internal when there is no complete reply in the file; system when it cannot be sealed or mapped
Result<Reply> map_reply(int descriptor);

} // namespace isotet::io::confined
