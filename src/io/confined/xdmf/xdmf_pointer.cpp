// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_pointer.hpp"

#include <charconv>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t longest_path = 1000, most_alternatives = 8;

std::string_view without_spaces(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// Calls look(place, brackets around it) for each character outside of quotation marks, until it returns false.
template <class Look>
void each_outside_quotes(std::string_view text, const Look& look) {
    char quote = '\0';
    int brackets = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote != '\0') {
            if (c == quote) quote = '\0';
            continue;
        }
        if (c == '"' || c == '\'') quote = c;
        if (c == ']') --brackets;
        if (!look(i, brackets)) return;
        if (c == '[') ++brackets;
    }
}

bool goes_over_the_document_once(std::string_view path) {
    int searches = 0;
    bool simple = true;
    each_outside_quotes(path, [&](std::size_t i, int brackets) {
        if (brackets < 0 || (brackets > 0 && (path[i] == '[' || path[i] == '/'))) simple = false;
        if (path[i] == '/' && i + 1 < path.size() && path[i + 1] == '/') ++searches;
        return simple;
    });
    return simple && searches <= 1;
}

std::vector<std::string_view> alternatives(std::string_view path) {
    std::vector<std::string_view> parts;
    std::size_t begin = 0;
    each_outside_quotes(path, [&](std::size_t i, int brackets) {
        if (path[i] == '|' && brackets == 0) {
            parts.push_back(path.substr(begin, i - begin));
            begin = i + 1;
        }
        return true;
    });
    parts.push_back(path.substr(begin));
    return parts;
}

/// id("x")/Topology, which pugixml does not know, as a search for an attribute.
std::string without_id_function(std::string_view path) {
    path = without_spaces(path);
    if (!path.starts_with("id(")) return std::string(path);
    const auto end = path.find(')');
    if (end == std::string_view::npos) return std::string(path);
    const std::string_view id = without_spaces(path.substr(3, end - 3));
    return fmt::format("//*[@id={0} or @xml:id={0}]{1}", id, path.substr(end + 1));
}

pugi::xml_node element_of_id(const pugi::xml_node& document, std::string_view id) {
    return document.find_node([&](const pugi::xml_node& node) {
        return id == node.attribute("xml:id").as_string() || id == node.attribute("id").as_string();
    });
}

/// "/1/2/1" from the document on, or "id/2": the second child of an element.
pugi::xml_node element_of_numbers(const pugi::xml_node& document, std::string_view steps) {
    pugi::xml_node node = document;
    const auto slash = std::min(steps.find('/'), steps.size());
    if (slash > 0) node = element_of_id(document, steps.substr(0, slash));
    for (steps.remove_prefix(slash); !steps.empty() && node;) {
        steps.remove_prefix(1);
        std::size_t number = 0;
        const auto [end, error] = std::from_chars(steps.data(), steps.data() + steps.size(), number);
        if (error != std::errc{} || number == 0) return {};
        steps.remove_prefix(static_cast<std::size_t>(end - steps.data()));
        if (!steps.empty() && steps.front() != '/') return {};
        node = node.first_child();
        for (; node; node = node.next_sibling())
            if (node.type() == pugi::node_element && --number == 0) break;
    }
    return node == document ? pugi::xml_node() : node;
}

/// One "scheme(data)" of an xpointer.
struct PointerPart {
    std::string_view scheme, data;
};

/// Takes the first part off the text; nothing where it is none.
std::optional<PointerPart> take_part(std::string_view& text) {
    text = without_spaces(text);
    const auto open = text.find('(');
    if (open == std::string_view::npos) return std::nullopt;
    int depth = 0;
    std::optional<std::size_t> close;
    each_outside_quotes(text, [&](std::size_t i, int) {
        if (text[i] == '(') ++depth;
        if (text[i] == ')' && --depth == 0) close = i;
        return !close;
    });
    if (!close || *close < open) return std::nullopt;
    const PointerPart part{text.substr(0, open), text.substr(open + 1, *close - open - 1)};
    text.remove_prefix(*close + 1);
    return part;
}

} // namespace

std::vector<pugi::xml_node> elements_on_path(const pugi::xml_node& document, std::string_view path) {
    if (path.size() > longest_path) return {};
    std::string query;
    const auto parts = alternatives(path);
    if (parts.size() > most_alternatives) return {};
    for (const std::string_view part : parts) {
        const std::string one = without_id_function(part);
        if (!goes_over_the_document_once(one)) return {};
        query += (query.empty() ? "" : "|") + one;
    }
    std::vector<pugi::xml_node> found;
    try {
        pugi::xpath_node_set set = document.select_nodes(query.c_str());
        set.sort();
        for (const pugi::xpath_node& node : set)
            if (node.node().type() == pugi::node_element) found.push_back(node.node());
    } catch (const pugi::xpath_exception&) { // not an XPath
        return {};
    }
    return found;
}

std::vector<pugi::xml_node> elements_at(const pugi::xml_node& document, std::string_view xpointer) {
    xpointer = without_spaces(xpointer);
    if (xpointer.find('(') == std::string_view::npos) {
        const pugi::xml_node node = element_of_id(document, xpointer);
        return node && !xpointer.empty() ? std::vector{node} : std::vector<pugi::xml_node>();
    }
    while (const auto part = take_part(xpointer)) {
        std::vector<pugi::xml_node> found;
        if (part->scheme == "xpointer" || part->scheme == "xpath1") found = elements_on_path(document, part->data);
        if (part->scheme == "element")
            if (const pugi::xml_node node = element_of_numbers(document, without_spaces(part->data))) found = {node};
        if (!found.empty()) return found;
    }
    return {};
}

} // namespace isotet::io::confined
