// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/write_file.hpp>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/guard.hpp"
#include "io/files/output_file.hpp"

namespace isotet {

namespace {

constexpr std::string_view collection_begin =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";

std::string in_xml_attribute(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '&': out += "&amp;"; break;
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '"': out += "&quot;"; break;
        default: out += c;
        }
    }
    return out;
}

std::string relative_to_folder_of(const std::string& index, const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(index).parent_path();
    const std::filesystem::path relative = std::filesystem::path(file).lexically_relative(folder.empty() ? "." : folder);
    return relative.empty() ? file : relative.string();
}

} // namespace

Result<void> write_text(std::string_view text, const std::string& path, const Run& run) {
    return core::guarded("writing a file", [&]() -> Result<void> {
        Result<io::OutputFile> file = io::OutputFile::open(path);
        if (!file) return file.error();
        if (Result<void> written = file->write(text); !written) return written;
        if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "writing a file was cancelled"};
        return file->commit();
    });
}

Result<void> check_writable(const std::string& path) {
    return core::guarded("looking at a file", [&]() -> Result<void> {
        if (const Result<io::OutputFile> file = io::OutputFile::open(path); !file) return file.error();
        return {}; // not committed: the new file is removed
    });
}

Result<void> write_collection(const std::vector<CollectionEntry>& entries, const std::string& path,
                              const Run& run) {
    return core::guarded("writing a collection", [&] {
        std::string text(collection_begin);
        for (const CollectionEntry& entry : entries)
            text += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" file=\"{}\"/>\n", entry.time,
                                entry.part, in_xml_attribute(relative_to_folder_of(path, entry.file)));
        return write_text(text + "  </Collection>\n</VTKFile>\n", path, run);
    });
}

bool is_written_collection(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string begin(collection_begin.size(), '\0');
    return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == collection_begin;
}

} // namespace isotet
