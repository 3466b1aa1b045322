// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <optional>

#include <fmt/core.h>

#include "io/own/text_scanner.hpp"
#include "io/own/escape.hpp"
#include "io/own/loaded.hpp"
#include "io/vtk/mapped_file.hpp"
#include "io/vtk/xdmf_document.hpp"

namespace isotet::io::vtk {
namespace {

constexpr int deepest = 16; ///< collections in collections, references to references
constexpr std::size_t max_visited = 1000000;

/// <!ENTITY name "text"> of the DOCTYPE. Their text is taken as it is: an entity in an entity, with which a small file
/// could become a huge one, stays unreplaced.
std::map<std::string, std::string, std::less<>> entities(std::string_view text) {
    std::map<std::string, std::string, std::less<>> result;
    constexpr std::string_view mark = "<!ENTITY";
    for (auto at = text.find(mark); at != std::string_view::npos; at = text.find(mark, at + 1)) {
        TextScanner scanner(text.substr(at + mark.size(), text.find('>', at) - at - mark.size()));
        const std::string name(scanner.word());
        std::string_view value = scanner.rest();
        const auto begin = value.find_first_of("\"'");
        if (name.empty() || name == "%" || begin == std::string_view::npos) continue;
        const auto end = value.find(value[begin], begin + 1);
        if (end != std::string_view::npos && value.substr(0, begin).find("SYSTEM") == std::string_view::npos)
            result.emplace(name, value.substr(begin + 1, end - begin - 1));
    }
    return result;
}

constexpr std::size_t max_growth = 16 << 20; ///< bytes that entities may add

/// Nothing when entities make far more of the text than it is.
std::optional<std::string> without_entities(std::string_view text) {
    const auto root = std::min(text.find("<Xdmf"), text.size());
    const auto known = entities(text.substr(0, root));
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = root; at < text.size();) {
        const auto mark = std::min(text.find('&', at), text.size());
        result += text.substr(at, mark - at);
        if (mark == text.size()) break;
        const auto end = text.find(';', mark);
        const auto entity = end == std::string_view::npos || end - mark > 256
                                ? known.end()
                                : known.find(text.substr(mark + 1, end - mark - 1));
        if (entity != known.end()) {
            result += entity->second;
            if (result.size() > text.size() + max_growth) return std::nullopt;
            at = end + 1;
        } else {
            result += '&';
            at = mark + 1;
        }
    }
    return result;
}

constexpr std::size_t max_queries = 10000;

/// A path as references are written, which goes over the document once at most: //Grid[@Name="a"]/Topology[1].
bool is_simple(std::string_view query) {
    const auto steps = query.find("//");
    if (query.size() > 1000 ||
        (steps != std::string_view::npos && query.find("//", steps + 2) != std::string_view::npos))
        return false;
    bool inside = false;
    for (const char c : query) {
        if (c == '|' || (c == '[' && inside) || (c == '/' && inside)) return false;
        if (c == '[') inside = true;
        if (c == ']') inside = false;
    }
    return true;
}

std::optional<double> time_of(pugi::xml_node grid) {
    double value = 0;
    const pugi::xml_node time = grid.child("Time");
    if (time && parse_number(time.attribute("Value").as_string(), value)) return value;
    return std::nullopt;
}

/// The times that a temporal collection lists for its grids: TimeType List or HyperSlab (start, step, count).
std::vector<double> listed_times(pugi::xml_node collection, std::size_t count) {
    const pugi::xml_node time = collection.child("Time");
    std::vector<double> values;
    TextScanner scanner(time.child("DataItem") ? time.child("DataItem").text().as_string() : time.text().as_string());
    for (double value = 0; scanner.number(value);) values.push_back(value);
    if (same_word(time.attribute("TimeType").as_string(), "HyperSlab") && values.size() == 3) {
        const double start = values[0], step = values[1];
        values.clear();
        for (std::size_t i = 0; i < count; ++i) values.push_back(start + static_cast<double>(i) * step);
    }
    return values;
}

} // namespace

bool same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return (x | 32) == (y | 32); });
}

Result<XdmfDocument> XdmfDocument::open(const std::string& path) {
    auto file = MappedFile::open(path);
    if (!file) return file.error();
    XdmfDocument result;
    result.path_ = path;
    const auto text = without_entities(file->text());
    if (!text) return broken(path, fmt::format("its entities add more than {} bytes to it", max_growth));
    const auto parsed = result.document_.load_buffer(text->data(), text->size());
    if (!parsed) return broken(path, fmt::format("broken XML near byte {}: {}", parsed.offset, parsed.description()));
    if (result.document_.select_node("//*[local-name()='include']"))
        return broken(path, "it includes other XML files, which is not read: only HDF5 and binary files are");
    const pugi::xml_node domain = result.document_.child("Xdmf").child("Domain");
    if (!domain) return broken(path, "there is no Domain in its Xdmf element");
    if (auto gathered = result.gather(domain, 0); !gathered) return gathered.error();
    if (result.steps_.empty()) return broken(path, "its Domain has no grid");
    return result;
}

pugi::xml_node XdmfDocument::resolve(pugi::xml_node node) const {
    for (int depth = 0; depth < deepest && node; ++depth) {
        const std::string_view reference = node.attribute("Reference").as_string();
        if (reference.empty()) return node;
        std::string_view query = same_word(reference, "XML") ? std::string_view(node.text().as_string()) : reference;
        while (!query.empty() && is_space(query.front())) query.remove_prefix(1);
        while (!query.empty() && is_space(query.back())) query.remove_suffix(1);
        if (!is_simple(query)) return {};
        const auto known = found_.find(query);
        if (known != found_.end()) {
            node = known->second;
            continue;
        }
        if (found_.size() == max_queries) return {};
        try {
            node = document_.select_node(std::string(query).c_str()).node();
        } catch (const pugi::xpath_exception&) { // not an XPath
            return {};
        }
        found_.emplace(query, node);
    }
    return {};
}

Result<void> XdmfDocument::gather(pugi::xml_node parent, int depth) {
    if (depth > deepest) return broken(path_, fmt::format("grids are nested more than {} deep", deepest));
    if (++visited_ > max_visited) return broken(path_, "its grids refer to each other without end");
    for (const pugi::xml_node stated : parent.children("Grid")) {
        const pugi::xml_node grid = resolve(stated);
        if (!grid)
            return broken(path_,
                          fmt::format("grid \"{}\" refers to nothing", escaped(stated.attribute("Name").as_string())));
        const std::string_view type = grid.attribute("GridType").as_string("Uniform");
        const std::string_view collection = grid.attribute("CollectionType").as_string("Spatial");
        if (same_word(type, "Collection") && same_word(collection, "Temporal")) {
            if (auto gathered = gather_temporal(grid, depth + 1); !gathered) return gathered;
        } else if (same_word(type, "Collection") || same_word(type, "Tree")) {
            if (auto gathered = gather(grid, depth + 1); !gathered) return gathered;
        } else if (same_word(type, "Uniform")) {
            if (steps_.empty()) steps_.emplace_back();
            if (const auto time = time_of(grid); time && !steps_.back().has_time) {
                steps_.back().time = *time;
                steps_.back().has_time = true;
            }
            steps_.back().grids.push_back(grid);
        } else {
            return broken(path_,
                          fmt::format("grid type \"{}\" is not one of Uniform, Collection, Tree", escaped(type)));
        }
    }
    return {};
}

/// Each child is a step of its own.
Result<void> XdmfDocument::gather_temporal(pugi::xml_node collection, int depth) {
    const auto children = collection.children("Grid");
    const auto times =
        listed_times(collection, static_cast<std::size_t>(std::distance(children.begin(), children.end())));
    std::size_t index = 0;
    for (const pugi::xml_node stated : children) {
        const pugi::xml_node grid = resolve(stated);
        if (!grid)
            return broken(path_,
                          fmt::format("grid \"{}\" refers to nothing", escaped(stated.attribute("Name").as_string())));
        XdmfStep& step = steps_.emplace_back();
        const auto own = time_of(grid);
        step.has_time = true;
        step.time = own ? *own : index < times.size() ? times[index] : static_cast<double>(index);
        ++index;
        if (same_word(grid.attribute("GridType").as_string("Uniform"), "Uniform")) {
            step.grids.push_back(grid);
            continue;
        }
        if (auto gathered = gather(grid, depth + 1); !gathered) return gathered;
    }
    return {};
}

} // namespace isotet::io::vtk
