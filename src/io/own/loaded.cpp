// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "io/own/escape.hpp"
#include "io/own/loaded.hpp"

namespace isotet::io {

void announce(FileInfo& info, FieldInfo field) {
    for (const FieldInfo& known : info.fields)
        if (known.name == field.name && known.association == field.association) return;
    info.fields.push_back(std::move(field));
}

Error broken(const std::string& path, std::string_view what) {
    return {ErrorCode::invalid_data, fmt::format("{}: {}", escaped(path), what)};
}

} // namespace isotet::io
