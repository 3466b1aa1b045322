// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "text_file.hpp"

#include "io/own/output_file.hpp"

namespace isotet::cli {

Result<void> write_text_file(const std::string& path, std::string_view text, const Progress& progress) {
    Result<io::OutputFile> file = io::OutputFile::open(path);
    if (!file) return file.error();
    if (Result<void> written = file->write(text); !written) return written;
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
    return file->commit();
}

} // namespace isotet::cli
