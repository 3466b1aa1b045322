// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PVD: an index of files by time step; the parts and groups of one time are pieces of one grid.
#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <pugixml.hpp>

#include "io/files/text_scanner.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/files/whole_file.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"
#include "io/vtk_xml/load.hpp"
#include "io/reader.hpp"

namespace isotet::io {
namespace {

struct Entry {
    double time = 0;
    std::string group, part, name, file;
    bool has_part = false, has_time = false;
};

std::vector<pugi::xml_node> data_sets(const pugi::xml_document& document) {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node file : document.children("VTKFile"))
        for (const pugi::xml_node collection : file.children("Collection"))
            for (const pugi::xml_node data_set : collection.children("DataSet")) found.push_back(data_set);
    return found;
}

Result<std::vector<Entry>> entries(const std::string& path) {
    const auto file = WholeFile::read(path, {});
    if (!file) return file.error();
    pugi::xml_document document;
    const auto parsed = document.load_buffer(file->text().data(), file->text().size());
    if (!parsed) return broken(path, fmt::format("broken XML at byte {}: {}", parsed.offset, parsed.description()));
    std::vector<Entry> entries;
    for (const pugi::xml_node node : data_sets(document)) {
        const std::string_view time = without_blanks(node.attribute("timestep").value());
        const pugi::xml_attribute part = node.attribute("part");
        Entry entry{0,
                    node.attribute("group").as_string(),
                    part.as_string(),
                    node.attribute("name").as_string(),
                    node.attribute("file").as_string(),
                    part && *part.value(),
                    !time.empty()};
        if (entry.has_time && (!parse_number(time, entry.time) || entry.time != entry.time))
            return broken(path, fmt::format("a data set has timestep \"{}\", which is no number", escaped(time)));
        entries.push_back(std::move(entry));
    }
    if (entries.empty()) return broken(path, "the collection has no data sets");
    return entries;
}

std::string plain(const std::string& file) { return std::filesystem::path(file).lexically_normal().string(); }

/// Which entries stand for the same part of the same time. Where no part is stated, other files of a time are further
/// parts, unless times go back: then a run was restarted.
std::map<double, std::vector<const Entry*>> last_ones(const std::vector<Entry>& entries) {
    const bool goes_back = !std::ranges::is_sorted(entries, {}, &Entry::time);
    std::map<double, std::vector<const Entry*>> result;
    std::map<std::tuple<double, std::string, std::string, std::string, std::string>, std::size_t> places;
    for (const Entry& entry : entries) {
        auto& of_time = result[entry.time];
        const bool by_file = !entry.has_part && !goes_back;
        const auto [place, is_new] = places.try_emplace(
            {entry.time, entry.group, entry.part, entry.name, by_file ? plain(entry.file) : std::string()},
            of_time.size());
        if (is_new) of_time.push_back(&entry);
        else of_time[place->second] = &entry;
    }
    return result;
}

std::string note_of_replaced(const std::vector<Entry>& entries, std::size_t kept) {
    const std::size_t replaced = entries.size() - kept;
    return fmt::format(
        "{} of {} data sets of the collection {} replaced by a later one of the same time, group and part", replaced,
        entries.size(), replaced == 1 ? "is" : "are");
}

/// Empty where all have a time, or none has.
std::string note_of_timeless(const std::vector<Entry>& entries) {
    const auto timeless = static_cast<std::size_t>(std::ranges::count(entries, false, &Entry::has_time));
    if (timeless == 0 || timeless == entries.size()) return {};
    return fmt::format("{} of {} data sets of the collection {} no timestep, the first is {}: time 0 was taken",
                       timeless, entries.size(), timeless == 1 ? "has" : "have",
                       in_quotes(std::ranges::find(entries, false, &Entry::has_time)->file));
}

} // namespace

Result<TimeIndex> index_of_collection(const std::string& path) {
    const auto all = entries(path);
    if (!all) return all.error();
    TimeIndex index;
    std::size_t kept = 0;
    for (const auto& [time, of_time] : last_ones(*all))
        for (const Entry* entry : of_time) {
            index.names[time].push_back(entry->file);
            ++kept;
        }
    if (kept < all->size()) index.notes.push_back(note_of_replaced(*all, kept));
    if (std::string note = note_of_timeless(*all); !note.empty()) index.notes.push_back(std::move(note));
    return index;
}

} // namespace isotet::io
