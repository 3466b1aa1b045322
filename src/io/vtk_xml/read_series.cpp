// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A file series of ParaView, as OpenFOAM writes them: JSON that names a file of each time.
#include <algorithm>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/whole_file.hpp"
#include "io/pieces/join/join.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet::io {
namespace {

using Json = nlohmann::json;

constexpr const char* version_key = "file-series-version";

/// A number, or, as scripts write it, a text that is one.
std::optional<double> time_of(const Json& file) {
    const auto time = file.find("time");
    if (time == file.end()) return std::nullopt;
    if (time->is_number()) return time->get<double>();
    double value = 0;
    if (!time->is_string() || !parse_number(without_blanks(time->get_ref<const std::string&>()), value)) return {};
    return value;
}

bool has_no_times(const Json& files) {
    return std::ranges::none_of(files, [](const Json& file) { return file.is_object() && file.contains("time"); });
}

/// Of several files of one time the last counts, as where a run was restarted. Without times their numbers are these.
Result<TimeIndex> entries(const std::string& path, std::string_view text) {
    Json series;
    try {
        series = Json::parse(text);
    } catch (const Json::parse_error& error) {
        return broken(path, fmt::format("this is not JSON, from byte {} on", error.byte));
    }
    const auto files = series.is_object() ? series.find("files") : series.end();
    if (!series.is_object() || files == series.end() || !files->is_array() || files->empty())
        return broken(path, "there is no list \"files\" with entries");
    TimeIndex index;
    auto& names = index.names;
    const bool numbered = has_no_times(*files);
    if (numbered) index.notes.emplace_back("the series has no times: the numbers of its files were taken, from 0");
    for (const Json& file : *files) {
        if (!file.is_object() || !file.contains("name") || !file["name"].is_string())
            return broken(path, "an entry of \"files\" has no \"name\"");
        const auto& name = file["name"].get_ref<const std::string&>();
        const auto time = numbered ? static_cast<double>(names.size()) : time_of(file);
        if (!time) return broken(path, fmt::format("the entry \"{}\" has no number as its \"time\"", escaped(name)));
        names[*time] = {name};
    }
    if (const std::size_t replaced = files->size() - names.size(); replaced > 0)
        index.notes.push_back(fmt::format("{} of {} files of the series {} replaced by a later one of the same time",
                                          replaced, files->size(), replaced == 1 ? "is" : "are"));
    return index;
}

Result<TimeIndex> index_of(const std::string& path, const Progress& progress) {
    const auto file = WholeFile::read(path, progress);
    if (!file) return file.error();
    return entries(path, file->text());
}

Result<Loaded> load(const std::string& path, const ReadOptions& options, Depth depth, const Progress& progress) {
    auto loaded = load_times(path, index_of(path, progress), options, depth, progress);
    if (!loaded) return loaded;
    loaded->info.format = "series";
    return loaded;
}

} // namespace

GridReader series_reader() {
    GridReader reader;
    reader.format = Format{"series", "ParaView file series", {".series"}};
    reader.format.reads_grid = true;
    reader.recognizes = [](std::string_view head, std::string_view extension) {
        if (head.find(version_key) != std::string_view::npos) return 2;
        return extension == ".series" ? 1 : 0;
    };
    reader.inspect = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        auto loaded = load(path, options, Depth::description, progress);
        return loaded ? Result<FileInfo>(std::move(loaded->info)) : loaded.error();
    };
    reader.read = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        return load_and_join([&] { return load(path, options, Depth::arrays, progress); }, options, progress);
    };
    reader.file_of_time = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        return file_of_time(path, index_of(path, progress), options);
    };
    return reader;
}

} // namespace isotet::io
