// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// "kuhn:64:gyroid,sphere" as MakeOptions. Names are judged by make_grid().
#include <charconv>

#include <fmt/core.h>

#include <isotet/make.hpp>

namespace isotet {

namespace {

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

} // namespace

Result<MakeOptions> parse_make(std::string_view text) {
    const auto parts = parts_of(text, ':');
    if (parts.size() < 2 || parts.size() > 3)
        return Error{
            ErrorCode::invalid_argument,
            fmt::format("the grid to make is '{}', but must look like kuhn:64 or kuhn:64:sphere,gyroid", text)};
    MakeOptions options;
    options.shape = parts[0];
    const char* end = parts[1].data() + parts[1].size();
    const auto [stopped, fault] = std::from_chars(parts[1].data(), end, options.side);
    if (fault != std::errc{} || stopped != end)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the side in '{}' is '{}', but must be a whole number", text, parts[1])};
    if (parts.size() == 3) {
        options.fields.clear();
        for (const std::string_view name : parts_of(parts[2], ',')) options.fields.emplace_back(name);
    }
    return options;
}

} // namespace isotet
