// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/saved_grid.hpp"

#include <fmt/format.h>

#include "view/export/page_file.hpp"
#include "view/export/saved_mesh.hpp"
#include "view/export/web_module.hpp"

namespace isotet::view {

Result<void> check_grid_pages() {
    if (web_module().empty())
        return Error{ErrorCode::invalid_argument,
                     "the page has isotet in it as WebAssembly, which this isotet was built without: "
                     "scripts/web.sh makes it, and docs/export.md tells how; --as surfaces needs none"};
    return {};
}

Result<std::string> grid_page(std::string_view packed, const SavedGridOptions& options) {
    if (Result<void> checked = check_grid_pages(); !checked) return checked.error();
    const Result<std::string> engine = deflated(web_module()), grid = deflated(packed);
    if (!engine) return engine.error();
    if (!grid) return grid.error();
    Json saved = {{"file", options.file},
                  {"version", options.version},
                  {"state", to_json(options.state)},
                  {"notes", options.notes}};
    return page_document(fmt::format("{} – isotet", options.file), saved,
                         {{"engine", base64_of(*engine)}, {"grid", base64_of(*grid)}}, PageSource::grid);
}

Result<std::string> unfilled_page() {
    if (Result<void> checked = check_grid_pages(); !checked) return checked.error();
    const Result<std::string> engine = deflated(web_module());
    if (!engine) return engine.error();
    return page_document("isotet", Json::object(), {{"engine", base64_of(*engine)}}, PageSource::grid);
}

Result<std::string> empty_page(const std::string& version) {
    if (web_reader_module().empty())
        return Error{ErrorCode::invalid_argument,
                     "the page has isotet's readers in it as WebAssembly, which this isotet was built without: "
                     "scripts/web.sh makes them, and docs/export.md tells how"};
    const Result<std::string> engine = deflated(web_reader_module());
    if (!engine) return engine.error();
    return page_document("isotet", {{"version", version}}, {{"engine", base64_of(*engine)}}, PageSource::files);
}

} // namespace isotet::view
