// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output_paths.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "io/own/output_file.hpp"

namespace isotet::cli {

Result<Format> format_for_writing(const std::string& path, Writes what) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
    std::string endings;
    for (const Format& format : formats()) {
        if (!(what == Writes::surface ? format.writes_surface : format.writes_grid)) continue;
        if (std::find(format.extensions.begin(), format.extensions.end(), ending) != format.extensions.end())
            return format;
        for (const std::string& other : format.extensions) endings += (endings.empty() ? "" : ", ") + other;
    }
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the name of the output is '{}', but it must end in one of {}", path, endings)};
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error)) return true;
    const auto canonical_a = std::filesystem::weakly_canonical(a, error);
    if (error) return a == b;
    const auto canonical_b = std::filesystem::weakly_canonical(b, error);
    return !error && canonical_a == canonical_b;
}

Result<void> check_output_paths(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const std::string& output = outputs[i];
        if (output.empty() || output == "-") continue;
        for (const std::string& input : inputs) {
            if (!input.empty() && same_file(input, output)) {
                return Error{ErrorCode::invalid_argument,
                             fmt::format("the output '{}' is the input '{}': it would be overwritten", output, input)};
            }
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (!outputs[j].empty() && same_file(outputs[j], output)) {
                return Error{ErrorCode::invalid_argument, fmt::format("two outputs are the same file, '{}'", output)};
            }
        }
        // Opening and dropping an output file tells, before hours of work, whether it can be written there.
        if (const auto file = io::OutputFile::open(output); !file) return file.error();
    }
    return {};
}

} // namespace isotet::cli
