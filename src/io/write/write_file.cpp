// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/write.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/guard.hpp"
#include "base/system/output_file.hpp"
#include "base/system/unfinished_files.hpp"

namespace isotet {

namespace {

constexpr std::string_view collection_begin =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";

constexpr std::string_view usd_collection_begin = "#usda 1.0\n# a series\n";

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
    const std::filesystem::path relative =
        std::filesystem::path(file).lexically_relative(folder.empty() ? "." : folder);
    return relative.empty() ? file : relative.string();
}

/// Of USD, in which each file is shown from its place in the series to the next one's.
std::string usd_collection(const std::vector<CollectionEntry>& entries, const std::string& path) {
    std::vector<double> times;
    for (const CollectionEntry& entry : entries)
        if (std::ranges::find(times, entry.time) == times.end()) times.push_back(entry.time);
    std::string text = fmt::format("{}(\n    defaultPrim = \"series\"\n    endTimeCode = {}\n    metersPerUnit = 1\n"
                                   "    startTimeCode = 0\n    timeCodesPerSecond = 4\n    upAxis = \"Z\"\n)\n\n"
                                   "def Xform \"series\"\n{{\n",
                                   usd_collection_begin, times.empty() ? 0 : times.size() - 1);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto place = std::ranges::find(times, entries[i].time) - times.begin();
        const std::string before = place > 0 ? "0: \"invisible\", " : "";
        std::string file = relative_to_folder_of(path, entries[i].file);
        if (std::filesystem::path(file).is_relative()) file.insert(0, "./");
        text += fmt::format("    def \"file_{}\" ( # time {}\n        prepend references = @@@{}@@@\n    )\n    {{\n"
                            "        token visibility.timeSamples = {{ {}{}: \"inherited\", {}: \"invisible\" }}\n"
                            "    }}\n",
                            i, entries[i].time, file, before, place, place + 1);
    }
    return text + "}\n";
}

bool begins_with(const std::string& path, std::string_view wanted) {
    std::ifstream file(path, std::ios::binary);
    std::string begin(wanted.size(), '\0');
    return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == wanted;
}

} // namespace

Result<void> write_text(std::string_view text, const std::string& path, const Run& run) {
    return core::guarded("writing a file", [&]() -> Result<void> {
        Result<core::OutputFile> file = core::OutputFile::open(path);
        if (!file) return file.error();
        if (Result<void> written = file->write(text); !written) return written;
        if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "writing a file was cancelled"};
        return file->commit();
    });
}

Result<void> check_writable(const std::string& path) {
    return core::guarded("looking at a file", [&]() -> Result<void> {
        if (const Result<core::OutputFile> file = core::OutputFile::open(path); !file) return file.error();
        return {}; // not committed: the new file is removed
    });
}

Result<void> write_collection(const std::vector<CollectionEntry>& entries, const std::string& path, const Run& run) {
    return core::guarded("writing a collection", [&] {
        if (std::filesystem::path(path).extension() == ".usda")
            return write_text(usd_collection(entries, path), path, run);
        std::string text(collection_begin);
        for (const CollectionEntry& entry : entries)
            text += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" file=\"{}\"/>\n", entry.time,
                                entry.part, in_xml_attribute(relative_to_folder_of(path, entry.file)));
        return write_text(text + "  </Collection>\n</VTKFile>\n", path, run);
    });
}

bool is_written_collection(const std::string& path) {
    return begins_with(path, collection_begin) || begins_with(path, usd_collection_begin);
}

void remove_unfinished_files() noexcept { core::remove_noted_files(); }

} // namespace isotet
