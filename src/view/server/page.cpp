// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/server/page.hpp"

#include "page_bytes.hpp"

namespace isotet::view {

std::vector<ServedFile> page_files() {
    std::vector<ServedFile> files;
    for (const PageFile& file : page_file_list) {
        std::string_view type = "text/html; charset=utf-8";
        if (file.name.ends_with(".js")) type = "text/javascript; charset=utf-8";
        if (file.name.ends_with(".css")) type = "text/css; charset=utf-8";
        files.push_back({file.name, type, {reinterpret_cast<const char*>(file.bytes), file.size}});
    }
    return files;
}

} // namespace isotet::view
