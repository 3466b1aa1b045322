// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// OpenFOAM's cases are folders, which pages are not given: a reader that recognizes none.
#include "io/foam/read_openfoam.hpp"

namespace isotet::io {

namespace {

Error refused(const std::string& path) {
    return {ErrorCode::file, path + ": cases of OpenFOAM are read by the program isotet, not by its page"};
}

} // namespace

GridReader openfoam_reader() {
    GridReader reader;
    reader.format = {"openfoam", "OpenFOAM case", {".foam"}};
    reader.recognizes = [](std::string_view, std::string_view extension) { return extension == ".foam" ? 1 : 0; };
    reader.inspect = [](const std::string& path, const ReadOptions&, const Progress&) -> Result<FileInfo> {
        return refused(path);
    };
    reader.read = [](const std::string& path, const ReadOptions&, const Progress&) -> Result<ReadResult> {
        return refused(path);
    };
    return reader;
}

bool is_openfoam_case(const std::string&) { return false; }

} // namespace isotet::io
