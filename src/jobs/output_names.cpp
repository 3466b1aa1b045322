// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/output_names.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/write.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

bool holds(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

void replace_all(std::string& text, std::string_view what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
}

bool is_joint(char c) { return c == '-' || c == '_' || c == '.' || c == ' '; }

} // namespace

OutputNames::OutputNames(std::string pattern)
    : pattern_(std::move(pattern)),
      by_value_(holds(pattern_, "{value}")),
      by_time_(holds(pattern_, "{time}")),
      by_number_(holds(pattern_, "{step}")) {}

std::string OutputNames::name(const OutputKey& key) const {
    std::string name = pattern_;
    replace_all(name, "{value}", shortest(key.value));
    if (key.time) replace_all(name, "{time}", shortest(*key.time));
    const std::size_t digits = std::to_string(std::max<std::size_t>(key.steps, 1) - 1).size();
    replace_all(name, "{step}", fmt::format("{:0{}}", key.step, digits));
    return name;
}

std::string OutputNames::collection() const {
    const std::filesystem::path whole(pattern_);
    std::filesystem::path folder;
    for (const auto& part : whole.parent_path()) {
        if (holds(part.string(), "{")) break; // a folder for each file: the index is above them
        folder /= part;
    }
    std::string stem = whole.stem().string();
    for (const std::string_view mark : {"{value}", "{time}", "{step}"}) {
        for (std::size_t at; (at = stem.find(mark)) != std::string::npos;) {
            const bool joint_before = at > 0 && is_joint(stem[at - 1]);
            const bool joint_after = at + mark.size() < stem.size() && is_joint(stem[at + mark.size()]);
            if (joint_before) stem.erase(at - 1, mark.size() + 1);
            else stem.erase(at, mark.size() + (joint_after ? 1 : 0));
        }
    }
    return (folder / (stem.empty() ? "series.pvd" : stem + ".pvd")).string();
}

Result<void> check_placeholders(const std::string& out, const std::vector<std::string>& known) {
    for (std::size_t open = out.find('{'); open != std::string::npos; open = out.find('{', open + 1)) {
        const std::size_t close = out.find('}', open);
        if (close == std::string::npos) break;
        const std::string mark = out.substr(open, close - open + 1);
        if (std::find(known.begin(), known.end(), mark) != known.end()) continue;
        return refusal("OUT, '{}', has {}, but here only {} can stand for something", out, mark,
                       fmt::join(known, " and "));
    }
    return {};
}

std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return ending;
}

Result<Format> format_for_writing(const std::string& path, Writes what, Compression compression) {
    const std::string ending = ending_of(path);
    std::string endings;
    for (const Format& format : formats()) {
        if (!(what == Writes::surface ? format.writes_surface : format.writes_grid)) continue;
        if (std::find(format.extensions.begin(), format.extensions.end(), ending) != format.extensions.end()) {
            if (compression != Compression::none && format.name != "vtp" && format.name != "vtu")
                return refusal("`compress` {} was asked for, but {} has no compression: {} has", name_of(compression),
                               ending, what == Writes::surface ? ".vtp" : ".vtu");
            return format;
        }
        for (const std::string& other : format.extensions) endings += (endings.empty() ? "" : ", ") + other;
    }
    if (path == "-") return refusal("the output '-' would be standard output, but only files can be written");
    return refusal("the name of the output is '{}', but it must end in one of {}", path, endings);
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
            if (!input.empty() && same_file(input, output))
                return refusal("the output '{}' is the input '{}': it would be overwritten", output, input);
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (!outputs[j].empty() && same_file(outputs[j], output))
                return refusal("two outputs are the same file, '{}'", output);
        }
        if (auto writable = check_writable(output); !writable) return writable; // before hours of work
    }
    return {};
}

} // namespace isotet::jobs
