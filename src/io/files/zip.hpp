// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ZIP archives in memory (APPNOTE 6.3, without ZIP64 and encryption): what 3MF files are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Puts members one after another, deflated; finish() gives the archive. Bytes depend on the members alone.
class ZipWriter {
public:
    /// Errors   invalid_argument: the archive would pass 4 GB; out_of_memory; cancelled
    Result<void> add(std::string_view name, std::string_view content, const Progress& progress = {});
    std::string finish() &&;

private:
    struct Member {
        std::string name;
        std::uint32_t check = 0, packed = 0, size = 0, offset = 0;
    };
    static void put_facts(std::string& out, const Member& member);

    std::string bytes_;
    std::vector<Member> members_;
};

/// Whether it begins as an archive that is not empty does.
bool is_zip(std::string_view content);

/// The content of the first member whose name ends with `ending`.
///
/// `most`   bytes that it may have
/// Errors   invalid_data: no archive, no such member, broken, larger than `most`; out_of_memory
Result<std::string> read_from_zip(std::string_view archive, std::string_view ending, std::uint64_t most);

} // namespace isotet::io
