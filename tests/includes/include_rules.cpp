// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "includes/include_rules.hpp"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

namespace isotet::test {
namespace {

/// A folder and the folders under src/ from which its files may include, besides the public headers. First match
/// counts.
struct FolderRule {
    std::string_view folder;
    std::vector<std::string_view> may_see;
};

const std::vector<FolderRule>& folder_rules() {
    static const std::vector<FolderRule> rules = {
        {"include/", {}},
        {"src/core/", {"core/"}},
        {"src/check/", {"check/", "core/"}},
        {"src/linear/", {"linear/", "core/"}},
        {"src/make/", {"make/", "core/"}},
        {"src/ops/", {"ops/", "core/"}},
        {"src/reference/", {"reference/", "ops/", "core/"}},
        {"src/cpu/", {"cpu/", "ops/", "core/"}},
        {"src/vulkan/", {"vulkan/", "ops/", "core/"}},
        {"src/render/", {"render/", "vulkan/", "core/"}},
        {"src/search/", {"search/", "ops/", "core/"}},
        {"src/api/", {"api/", "reference/", "cpu/", "ops/", "core/"}},
        {"src/device/", {"device/", "api/", "vulkan/", "ops/", "core/"}},
        {"src/session/", {"session/", "core/", "linear/"}},
        {"src/solid/", {"solid/", "session/", "core/"}},
        {"src/scene/", {"scene/", "core/"}},
        {"src/jobs/", {"jobs/", "core/"}},
        {"src/view/", {"view/"}},
        {"src/io/own/", {"io/own/", "io/reader.hpp", "core/"}},
        {"src/io/process/", {"io/own/", "io/process/", "io/reader.hpp", "core/"}},
        {"src/io/vtk/", {"io/", "core/"}},
        {"src/io/", {"io/own/", "io/formats.hpp", "io/reader.hpp", "core/"}},
        {"apps/cli/", {"view/"}}, // its own headers have no folder
        {"examples/", {}},
        {"vtk/", {}},    // its own headers have no folder
        {"python/", {}}, // its own headers have no folder
    };
    return rules;
}

/// A library, how its headers begin, and the folders that may include them.
struct LibraryRule {
    std::string_view library;
    std::vector<std::string_view> beginnings;
    std::vector<std::string_view> folders;
};

const std::vector<LibraryRule>& library_rules() {
    static const std::vector<LibraryRule> rules = {
        {"VTK", {"vtk"}, {"src/io/vtk/", "vtk/", "bench/", "tests/"}},
        {"pugixml", {"pugixml"}, {"src/io/", "tests/"}},
        {"HDF5", {"hdf5", "H5"}, {"src/io/vtk/", "tests/"}},
        {"oneTBB", {"tbb/", "oneapi/"}, {"src/", "bench/", "tests/"}},
        {"Vulkan", {"vulkan/vulkan"}, {"src/vulkan/", "bench/", "tests/"}},
        {"FreeType", {"ft2build", "freetype"}, {"src/render/"}},
        {"libpng", {"png.h"}, {"src/io/own/", "src/view/encode.cpp", "tests/"}},
        {"libjpeg-turbo", {"jpeglib.h"}, {"src/view/encode.cpp"}},
        {"fmt", {"fmt/"}, {"src/", "apps/", "bench/", "tests/"}},
        {"CLI11", {"CLI/"}, {"apps/", "tests/"}},
        {"nlohmann_json", {"nlohmann/"}, {"apps/", "bench/", "src/io/own/read_series.cpp", "src/view/", "tests/"}},
        {"Boost", {"boost/"}, {"src/view/server.cpp", "tests/view/"}},
        {"libwebp", {"webp/"}, {"src/io/own/", "tests/"}},
        {"libdeflate", {"libdeflate.h"}, {"src/io/own/", "tests/"}},
        {"liblz4", {"lz4"}, {"src/io/own/"}},
        {"liblzma", {"lzma"}, {"src/io/own/"}},
        {"GoogleTest", {"gtest/", "gmock/"}, {"tests/"}},
        {"nanobind", {"nanobind/"}, {"python/"}},
    };
    return rules;
}

/// Folders that includes begin with; what begins otherwise is a public header, a library, or a neighbour in a test.
constexpr std::array<std::string_view, 18> folders_of_includes = {
    "core/", "check/", "make/",   "ops/",    "reference/", "cpu/",    "api/",   "device/", "session/",
    "io/",   "jobs/",  "linear/", "search/", "vulkan/",    "render/", "scene/", "cli/",    "view/"};

bool begins_with_any(std::string_view text, std::span<const std::string_view> beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](auto beginning) { return text.starts_with(beginning); });
}

} // namespace

std::string included_name(std::string_view line) {
    const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    skip_blanks();
    if (!line.starts_with('#')) return {};
    line.remove_prefix(1);
    skip_blanks();
    if (!line.starts_with("include")) return {};
    line.remove_prefix(7);
    skip_blanks();
    if (line.empty() || (line.front() != '"' && line.front() != '<')) return {};
    const char closing = line.front() == '"' ? '"' : '>';
    return std::string(line.substr(1, line.find(closing, 1) - 1));
}

std::string objection(std::string_view path, std::string_view name) {
    for (const LibraryRule& rule : library_rules()) {
        if (begins_with_any(name, rule.beginnings) && !begins_with_any(path, rule.folders)) {
            return fmt::format("{} is included only from {}", rule.library, fmt::join(rule.folders, ", "));
        }
    }
    if (name.starts_with("tbb/") && path.ends_with(".hpp") && path.starts_with("src/core/")) {
        return "headers of src/core show no thread library";
    }
    if (!begins_with_any(name, folders_of_includes)) return {};
    for (const FolderRule& rule : folder_rules()) {
        if (!path.starts_with(rule.folder)) continue;
        if (begins_with_any(name, rule.may_see)) return {};
        return fmt::format("{} sees only the public headers{}{}", rule.folder, rule.may_see.empty() ? "" : " and ",
                           fmt::join(rule.may_see, ", "));
    }
    if (path.starts_with("src/")) return "the folder has no rule yet in tests/includes/include_rules.cpp";
    return {};
}

} // namespace isotet::test
