// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The page as one file, with what it shows in it: nothing is loaded from anywhere.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

#include "view/json.hpp"

namespace isotet::view {

/// A module of the page.
struct PageModule {
    std::string_view name; ///< "camera.js"
    std::string_view text;
};

/// Modules as one, in the order in which a browser would run them.
///
/// `modules`      must import names, or `* as NAME`, in one line, and export nothing but declarations; names that
///                they declare outside functions must differ
/// `replacement`  a module's name, and that of the one that is taken in its place
/// Errors         internal: a module is not there, or written otherwise
Result<std::string> bundle(std::span<const PageModule> modules, std::string_view first,
                           const std::pair<std::string_view, std::string_view>& replacement);

/// Bytes that stand in the file, compressed and in base64, as an element of this name.
struct PagePart {
    std::string name;
    std::string base64;
};

/// What answers the page in place of a server.
enum class PageSource : std::uint8_t {
    surfaces, ///< web/link/saved_link.js, out of parts for each
    grid,     ///< web/link/wasm_link.js, with parts "engine" and "grid"; the policy allows WebAssembly and a thread for it
    files     ///< web/link/files_link.js, with a part "engine" that reads files; policy as above
};

/// The page of `isotet view` as an HTML document that says by its policy (Content-Security-Policy) that it runs one
/// script, this one, and loads nothing.
///
/// `title`    any text
/// `saved`    what `source` is told
/// Errors     as bundle()
Result<std::string> page_document(std::string_view title, const Json& saved, const std::vector<PagePart>& parts,
                                  PageSource source = PageSource::surfaces);

/// Text between tags and in attributes.
std::string html_text(std::string_view text);

/// JSON in an element <script>, where no "<" may stand.
std::string json_in_html(const Json& json);

} // namespace isotet::view
