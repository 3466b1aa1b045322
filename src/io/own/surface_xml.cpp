// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/surface_xml.hpp"

#include <charconv>
#include <cstdint>
#include <optional>

#include <fmt/core.h>

#include "io/own/text_scanner.hpp"

namespace isotet::io {
namespace {

std::string_view trimmed_front(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    return text;
}

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) return put(code);
    if (code < 0x800) put(0xC0U | (code >> 6U));
    else if (code < 0x10000) {
        put(0xE0U | (code >> 12U));
        put(0x80U | ((code >> 6U) & 0x3FU));
    } else {
        put(0xF0U | (code >> 18U));
        put(0x80U | ((code >> 12U) & 0x3FU));
        put(0x80U | ((code >> 6U) & 0x3FU));
    }
    put(0x80U | (code & 0x3FU));
}

/// The character for what stands between & and ; of an entity.
bool append_entity(std::string& out, std::string_view entity) {
    if (entity == "amp") out += '&';
    else if (entity == "lt") out += '<';
    else if (entity == "gt") out += '>';
    else if (entity == "quot") out += '"';
    else if (entity == "apos") out += '\'';
    else if (entity.starts_with('#')) {
        const bool hexadecimal = entity.starts_with("#x");
        const auto digits = entity.substr(hexadecimal ? 2 : 1);
        std::uint32_t code = 0;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), code, hexadecimal ? 16 : 10);
        if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || code == 0 ||
            code > 0x10FFFF)
            return false;
        append_utf8(out, code);
    } else {
        return false;
    }
    return true;
}

std::optional<std::string> resolved(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto ampersand = text.find('&');
        result += text.substr(0, ampersand);
        if (ampersand == std::string_view::npos) break;
        const auto semicolon = text.find(';', ampersand);
        if (semicolon == std::string_view::npos) return std::nullopt;
        if (!append_entity(result, text.substr(ampersand + 1, semicolon - ampersand - 1))) return std::nullopt;
        text.remove_prefix(semicolon + 1);
    }
    return result;
}

} // namespace

std::string_view XmlTag::get(std::string_view attribute, std::string_view otherwise) const {
    for (const auto& [name_of_attribute, value] : attributes) {
        if (name_of_attribute == attribute) return value;
    }
    return otherwise;
}

Error XmlScanner::error_at(std::size_t position, std::string_view what) const {
    TextScanner scanner(text_);
    scanner.seek(position);
    return {ErrorCode::invalid_data, fmt::format("{}: {}", scanner.where(), what)};
}

std::string_view XmlScanner::text() const {
    const auto rest = text_.substr(position_);
    return rest.substr(0, rest.find('<'));
}

/// True if it skipped a comment or a processing instruction at the cursor.
Result<bool> XmlScanner::skip_declaration() {
    const auto rest = text_.substr(position_);
    const bool comment = rest.starts_with("<!--");
    if (!comment && !rest.starts_with("<?")) {
        if (rest.starts_with("<!")) return error_at(position_, "document types and CDATA are not read");
        return false;
    }
    const std::string_view closing = comment ? "-->" : "?>";
    const auto end = rest.find(closing, comment ? 4 : 2);
    if (end == std::string_view::npos) return error_at(position_, "this never ends");
    position_ += end + closing.size();
    return true;
}

Result<XmlTag> XmlScanner::next() {
    for (;;) {
        const auto open = text_.find('<', position_);
        if (open == std::string_view::npos) {
            position_ = text_.size();
            return XmlTag{};
        }
        position_ = open;
        const auto skipped = skip_declaration();
        if (!skipped) return skipped.error();
        if (!*skipped) break;
    }
    // The closing > is the first one outside quotes.
    const std::size_t open = position_;
    char quote = '\0';
    std::size_t close = open + 1;
    for (; close < text_.size(); ++close) {
        const char c = text_[close];
        if (quote) quote = c == quote ? '\0' : quote;
        else if (c == '"' || c == '\'') quote = c;
        else if (c == '>') break;
        else if (c == '<') return error_at(open, "a tag inside a tag");
    }
    if (close == text_.size()) return error_at(open, "this tag never ends");
    position_ = close + 1;

    auto inside = text_.substr(open + 1, close - open - 1);
    XmlTag tag;
    if (inside.starts_with('/')) {
        tag.end = true;
        inside.remove_prefix(1);
    } else if (inside.ends_with('/')) {
        tag.closed = true;
        inside.remove_suffix(1);
    }
    std::size_t length = 0;
    while (length < inside.size() && !is_space(inside[length])) ++length;
    if (length == 0) return error_at(open, "a tag without a name");
    tag.name = inside.substr(0, length);
    if (auto read = read_attributes(tag, inside.substr(length)); !read) return read.error();
    return tag;
}

Result<void> XmlScanner::read_attributes(XmlTag& tag, std::string_view inside) {
    const auto here = [&] { return static_cast<std::size_t>(inside.data() - text_.data()); };
    for (inside = trimmed_front(inside); !inside.empty(); inside = trimmed_front(inside)) {
        const auto equals = inside.find('=');
        if (equals == std::string_view::npos) return error_at(here(), "an attribute without a value");
        auto name = inside.substr(0, equals);
        while (!name.empty() && is_space(name.back())) name.remove_suffix(1);
        inside = trimmed_front(inside.substr(equals + 1));
        if (inside.empty() || (inside[0] != '"' && inside[0] != '\''))
            return error_at(here(), "an attribute's value without quotes");
        const auto end = inside.find(inside[0], 1);
        if (end == std::string_view::npos) return error_at(here(), "an attribute's value without an end");
        auto value = resolved(inside.substr(1, end - 1));
        if (!value) return error_at(here(), "an entity that is not known");
        tag.attributes.emplace_back(name, std::move(*value));
        inside.remove_prefix(end + 1);
    }
    return {};
}

} // namespace isotet::io
