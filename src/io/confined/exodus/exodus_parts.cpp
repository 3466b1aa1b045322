// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "io/confined/exodus/exodus_parts.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

std::optional<unsigned> whole_number(std::string_view text) {
    unsigned value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || text.size() > 6 || result.ec != std::errc() || result.ptr != text.data() + text.size())
        return std::nullopt;
    return value;
}

} // namespace

Result<ExodusParts> exodus_parts(const std::string& path) {
    const ExodusParts alone{{path}, {}};
    const auto last = path.rfind('.');
    if (last == std::string::npos || last == 0) return alone;
    const auto before = path.rfind('.', last - 1);
    if (before == std::string::npos) return alone;
    const auto count = whole_number(std::string_view(path).substr(before + 1, last - before - 1));
    const auto part = whole_number(std::string_view(path).substr(last + 1));
    if (!count || !part || *count < 2 || *part >= *count) return alone;

    const std::size_t width = path.size() - last - 1;
    std::vector<std::string> parts, missing;
    for (unsigned i = 0; i < *count; ++i) {
        std::string name = fmt::format("{}{:0{}}", path.substr(0, last + 1), i, width);
        std::error_code no_error;
        (std::filesystem::is_regular_file(name, no_error) ? parts : missing).push_back(std::move(name));
    }
    if (missing.empty() || parts.size() == 1) return ExodusParts{std::move(parts), std::move(missing)};
    return Error{ErrorCode::file, fmt::format("{}: it is one of {} parts, of which {} are missing, \"{}\" first",
                                              escaped(path), *count, missing.size(), escaped(missing.front()))};
}

} // namespace isotet::io::confined
