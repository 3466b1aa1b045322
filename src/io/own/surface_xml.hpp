// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// As much XML as VTK's files use: elements, attributes, text, comments. No document types, so no entities to expand.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

namespace isotet::io {

/// A start or end tag. `<a/>` is a start tag that is `closed`.
struct XmlTag {
    std::string_view name;
    bool end = false;    ///< </name>
    bool closed = false; ///< <name/>
    std::vector<std::pair<std::string_view, std::string>> attributes; ///< values with their entities resolved

    /// The value of an attribute, or `otherwise`.
    std::string_view get(std::string_view attribute, std::string_view otherwise = {}) const;
};

/// Goes through a text tag by tag.
class XmlScanner {
public:
    explicit XmlScanner(std::string_view text) : text_(text) {}

    /// The next tag; an empty name at the end of the text.
    ///
    /// Errors   invalid_data: not XML, or more of it than is read here
    Result<XmlTag> next();

    /// The text between the last tag and the next one.
    std::string_view text() const;

    /// The first byte after the last tag.
    std::size_t position() const noexcept { return position_; }

private:
    Result<bool> skip_declaration();
    Result<void> read_attributes(XmlTag& tag, std::string_view inside);
    Error error_at(std::size_t position, std::string_view what) const;

    std::string_view text_;
    std::size_t position_ = 0;
};

} // namespace isotet::io
