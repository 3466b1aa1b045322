// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/pieces/loaded.hpp"
#include "io/confined/mapped_file.hpp"
#include "io/confined/xdmf/xdmf_document.hpp"
#include "io/confined/xdmf/xdmf_pointer.hpp"

namespace isotet::io::confined {
namespace {

constexpr int deepest = 16; ///< references to references, includes of includes

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
    const auto stated = text.find("<Xdmf");
    const auto root = stated == std::string_view::npos ? 0 : stated; // a file that is included may begin otherwise
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

constexpr std::size_t max_queries = 10000, max_files = 100, max_included = 1000000;

bool is_include(pugi::xml_node node) {
    const std::string_view name = node.name();
    const auto colon = name.rfind(':');
    return node.type() == pugi::node_element &&
           (colon == std::string_view::npos ? name : name.substr(colon + 1)) == "include";
}

/// An include as messages name it.
std::string include_text(pugi::xml_node include) {
    const std::string_view href = include.attribute("href").as_string(),
                           xpointer = include.attribute("xpointer").as_string();
    return fmt::format("an xi:include ({}{}{})", escaped(href.substr(0, 80)),
                       href.empty() || xpointer.empty() ? "" : ", ", escaped(xpointer.substr(0, 120)));
}

} // namespace

bool same_word(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return (x | 32) == (y | 32); });
}

std::string text_of(pugi::xml_node node) {
    std::string text;
    for (const pugi::xml_node part : node.children())
        if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) text += part.value();
    const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
    text.erase(text.begin(), begin);
    while (!text.empty() && is_space(text.back())) text.pop_back();
    return text;
}

Result<XdmfDocument> XdmfDocument::open(const std::string& path, bool allow_outside) {
    XdmfDocument result;
    result.allow_outside_ = allow_outside;
    if (auto opened = result.open_file(path); !opened) return opened.error();
    for (std::size_t i = 0; i < result.files_.size(); ++i)
        if (auto followed = result.follow_includes(*result.files_[i]); !followed) return followed.error();
    if (result.domains().empty()) return broken(path, "there is no Domain in its Xdmf element");
    return result;
}

Result<const XdmfDocument::File*> XdmfDocument::open_file(const std::string& path) {
    auto mapped = MappedFile::open(path);
    if (!mapped) return mapped.error();
    auto file = std::make_unique<File>();
    file->path = path;
    const auto text = without_entities(mapped->text());
    if (!text) return broken(path, fmt::format("its entities add more than {} bytes to it", max_growth));
    const auto parsed = file->xml.load_buffer(text->data(), text->size());
    if (!parsed) return broken(path, fmt::format("broken XML near byte {}: {}", parsed.offset, parsed.description()));
    return files_.emplace_back(std::move(file)).get();
}

Result<void> XdmfDocument::follow_includes(const File& file) {
    Result<void> result;
    file.xml.find_node([&](const pugi::xml_node& node) {
        if (!is_include(node)) return false;
        const auto elements = included(file, node, 0);
        if (!elements) result = elements.error();
        else by_include_.emplace(node.internal_object(), *elements);
        return !result;
    });
    return result;
}

Result<const XdmfDocument::Elements*> XdmfDocument::included(const File& file, pugi::xml_node include, int depth) {
    const auto wrong = [&](std::string_view what) {
        return broken(file.path, fmt::format("{} {}", include_text(include), what));
    };
    if (depth > deepest) return wrong("leads to includes without end");
    const std::string key = fmt::format("{}\n{}\n{}", file.path, include.attribute("href").as_string(),
                                        include.attribute("xpointer").as_string());
    auto known = inclusions_.find(key);
    if (known == inclusions_.end()) {
        if (inclusions_.size() == max_queries)
            return wrong(fmt::format("is one of more than {} different ones", max_queries));
        const auto elements = selected(file, include);
        if (!elements) return elements.error();
        if (elements->empty()) return wrong("names no element");
        Elements flat;
        for (const pugi::xml_node element : *elements) {
            if (!is_include(element)) {
                flat.push_back(element);
                continue;
            }
            const File* const other = file_with(element);
            const auto further = included(*other, element, depth + 1);
            if (!further) return further.error();
            flat.insert(flat.end(), (*further)->begin(), (*further)->end());
            if (flat.size() > max_included) return wrong(fmt::format("includes more than {} elements", max_included));
        }
        known = inclusions_.emplace(key, std::move(flat)).first;
    }
    for (const pugi::xml_node element : known->second)
        for (pugi::xml_node around = include.parent(); around; around = around.parent())
            if (around == element) return wrong("includes the element that it is in");
    return &known->second;
}

Result<XdmfDocument::Elements> XdmfDocument::selected(const File& file, pugi::xml_node include) {
    const std::string_view href = include.attribute("href").as_string(),
                           xpointer = include.attribute("xpointer").as_string();
    if (same_word(include.attribute("parse").as_string("xml"), "text"))
        return broken(file.path, fmt::format("{} includes text, which is not read: XML is", include_text(include)));
    const auto mark = std::min(href.find('#'), href.size());
    const auto from = file_named(file, href.substr(0, mark));
    if (!from) return from.error();
    if (!xpointer.empty()) return elements_at((*from)->xml, xpointer);
    if (mark < href.size()) return elements_at((*from)->xml, href.substr(mark + 1));
    const pugi::xml_node root = (*from)->xml.document_element();
    if (std::string_view(root.name()) != "Xdmf") return Elements{root};
    Elements grids; // a whole file stands for what is in it
    for (const pugi::xml_node domain : root.children("Domain"))
        for (const pugi::xml_node element : domain.children())
            if (element.type() == pugi::node_element) grids.push_back(element);
    return grids;
}

Result<const XdmfDocument::File*> XdmfDocument::file_named(const File& file, std::string_view name) {
    if (name.empty()) return &file;
    std::error_code error;
    const auto beside = std::filesystem::path(file.path).parent_path() / std::filesystem::path(name);
    for (const auto& known : files_)
        if (std::filesystem::equivalent(beside, known->path, error)) return known.get();
    const auto path = named_file(file.path, name, allow_outside_);
    if (!path) return path.error();
    if (files_.size() == max_files) return broken(file.path, fmt::format("it includes more than {} files", max_files));
    return open_file(*path);
}

const XdmfDocument::File* XdmfDocument::file_with(pugi::xml_node node) const {
    const pugi::xml_node root = node.root();
    for (const auto& file : files_)
        if (file->xml == root) return file.get();
    return files_.front().get();
}

const std::string& XdmfDocument::file_of(pugi::xml_node node) const { return file_with(node)->path; }

std::vector<pugi::xml_node> XdmfDocument::domains() const {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node root : children(files_.front()->xml, "Xdmf"))
        for (const pugi::xml_node domain : children(root, "Domain")) found.push_back(domain);
    return found;
}

std::vector<pugi::xml_node> XdmfDocument::children(pugi::xml_node parent, std::string_view name) const {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node child : parent.children()) {
        if (name == child.name()) found.push_back(child);
        const auto elements = is_include(child) ? by_include_.find(child.internal_object()) : by_include_.end();
        if (elements == by_include_.end()) continue;
        for (const pugi::xml_node element : *elements->second)
            if (name == element.name()) found.push_back(element);
    }
    return found;
}

pugi::xml_node XdmfDocument::child(pugi::xml_node parent, std::string_view name) const {
    for (const pugi::xml_node child : parent.children()) {
        if (name == child.name()) return child;
        const auto elements = is_include(child) ? by_include_.find(child.internal_object()) : by_include_.end();
        if (elements == by_include_.end()) continue;
        for (const pugi::xml_node element : *elements->second)
            if (name == element.name()) return element;
    }
    return {};
}

pugi::xml_node XdmfDocument::resolve(pugi::xml_node node) const {
    for (int depth = 0; depth < deepest && node; ++depth) {
        const std::string_view reference = node.attribute("Reference").as_string();
        if (reference.empty()) return node;
        const std::string path = same_word(reference, "XML") ? text_of(node) : std::string(reference);
        const File* const file = file_with(node);
        const std::string key = file == files_.front().get() ? path : fmt::format("{}\n{}", file->path, path);
        const auto known = found_.find(key);
        if (known != found_.end()) {
            node = known->second;
            continue;
        }
        if (found_.size() == max_queries) return {};
        const auto elements = elements_on_path(file->xml, path);
        node = elements.empty() ? pugi::xml_node() : elements.front();
        found_.emplace(key, node);
    }
    return {};
}

} // namespace isotet::io::confined
