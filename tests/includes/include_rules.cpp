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
        {"src/base/", {"base/"}},
        {"src/numbers/", {"numbers/", "base/"}},
        {"src/grid/", {"grid/", "numbers/", "base/"}},
        {"src/packed/", {"packed/", "grid/", "numbers/", "base/"}},
        {"src/check/", {"check/", "grid/", "numbers/", "base/"}},
        {"src/linear/", {"linear/", "grid/", "numbers/", "base/"}},
        {"src/fields/", {"fields/", "grid/", "numbers/", "base/"}},
        {"src/make/", {"make/", "grid/", "base/"}},
        {"src/ops/", {"ops/", "packed/", "grid/", "numbers/", "base/array_slot.hpp"}},
        {"src/reference/", {"reference/", "ops/", "packed/", "grid/", "numbers/"}},
        {"src/cpu/", {"cpu/", "ops/", "packed/", "grid/", "numbers/", "base/"}},
        {"src/vulkan/", {"vulkan/", "ops/", "packed/", "grid/", "numbers/", "base/"}},
        {"src/render/", {"render/", "vulkan/", "packed/", "grid/", "numbers/", "base/"}},
        {"src/paper/search/", {"paper/search/", "ops/", "packed/", "numbers/", "base/"}},
        {"src/paper/", {"paper/", "jobs/", "base/"}},
        {"src/api/", {"api/", "reference/", "cpu/", "ops/", "packed/", "grid/", "numbers/", "base/"}},
        {"src/device/", {"device/", "api/", "vulkan/", "ops/", "packed/", "numbers/", "base/"}},
        {"src/session/", {"session/", "linear/", "packed/", "grid/", "numbers/", "base/"}},
        {"src/solid/", {"solid/", "session/", "linear/", "grid/", "numbers/", "base/"}},
        {"src/scene/", {"scene/", "numbers/", "base/"}},
        {"src/jobs/", {"jobs/", "fields/", "grid/", "base/"}},
        {"src/view/", {"view/", "base/stopwatch.hpp", "base/threads/read_ahead.hpp"}},
        {"src/c/", {"grid/", "base/"}},
        {"src/web/", {"view/", "io/", "vulkan/engine/", "api/", "packed/", "numbers/", "base/"}},
        {"src/io/files/", {"io/files/", "io/reader.hpp", "base/"}},
        {"src/io/pieces/", {"io/pieces/", "io/files/", "io/reader.hpp", "fields/", "grid/", "numbers/", "base/"}},
        {"src/io/write/", {"io/write/", "io/files/", "grid/", "numbers/", "base/"}},
        {"src/io/surfaces/", {"io/", "check/", "grid/", "numbers/", "base/"}},
        {"src/io/process/", {"io/process/", "io/files/", "io/reader.hpp", "base/"}},
        {"src/io/confined/", {"io/", "grid/", "numbers/", "base/"}},
        {"src/io/packed/", {"io/packed/", "io/files/", "io/reader.hpp", "packed/", "grid/", "numbers/", "base/"}},
        {"src/io/", {"io/", "grid/", "numbers/", "base/"}},
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
        {"VTK", {"vtk"}, {"src/io/confined/", "vtk/", "bench/", "tests/"}},
        {"pugixml", {"pugixml"}, {"src/io/", "tests/"}},
        {"HDF5", {"hdf5", "H5"}, {"src/io/confined/", "tests/"}},
        {"oneTBB", {"tbb/", "oneapi/"}, {"src/", "bench/", "tests/"}},
        {"Vulkan", {"vulkan/vulkan"}, {"src/vulkan/", "bench/", "tests/"}},
        {"FreeType", {"ft2build", "freetype"}, {"src/render/"}},
        {"libpng", {"png.h"}, {"src/io/pictures/", "src/view/server/encode.cpp", "tests/"}},
        {"libjpeg-turbo", {"jpeglib.h"}, {"src/view/server/encode.cpp"}},
        {"fmt", {"fmt/"}, {"src/", "apps/", "bench/", "tests/"}},
        {"CLI11", {"CLI/"}, {"apps/", "tests/"}},
        {"nlohmann_json",
         {"nlohmann/"},
         {"apps/", "bench/", "src/io/surfaces/write_glb.cpp", "src/io/vtk_xml/read_series.cpp",
          "src/render/color/color_map_file.cpp", "src/view/", "tests/"}},
        {"Boost", {"boost/"}, {"src/view/server/server.cpp", "tests/view/"}},
        {"libwebp", {"webp/"}, {"src/io/pictures/", "tests/"}},
        {"libdeflate", {"libdeflate.h"}, {"src/io/", "src/view/export/saved_mesh.cpp", "tests/"}},
        {"liblz4", {"lz4"}, {"src/io/vtk_xml/"}},
        {"liblzma", {"lzma"}, {"src/io/vtk_xml/"}},
        {"libseccomp", {"seccomp.h"}, {"src/io/confined/sandbox.cpp"}},
        {"xxHash", {"xxhash"}, {"src/session/fingerprint.cpp", "src/view/grid_view.cpp"}},
        {"GoogleTest", {"gtest/", "gmock/"}, {"tests/"}},
        {"nanobind", {"nanobind/"}, {"python/"}},
    };
    return rules;
}

/// Rooms, lowest first, and the public headers whose functions they have. A file of a room below names none of them: its
/// room would call upwards. Headers that are not listed are types that all rooms share, or have functions in several.
struct Room {
    std::string_view folder;
    std::vector<std::string_view> headers;
};

const std::vector<Room>& rooms() {
    static const std::vector<Room> all = {
        {"base/", {"array", "memory", "progress", "result", "text"}},
        {"numbers/", {}},
        {"grid/", {"grid"}},
        {"packed/", {}},
        {"linear/", {"linear_cells"}},
        {"fields/", {"fields", "first_view"}},
        {"make/", {"make"}},
        {"check/", {"check"}},
        {"ops/", {}},
        {"reference/", {}},
        {"cpu/", {}},
        {"api/", {}},
        {"vulkan/", {}},
        {"device/", {}},
        {"render/", {"draw_tets", "picture", "render", "scene"}},
        {"session/", {"contour"}},
        {"solid/", {"solid"}},
        {"io/", {"grid_file", "packed_file", "read", "write"}},
        {"scene/", {"isosurface_scene"}},
        {"jobs/", {"jobs/"}},
        {"paper/", {"paper/"}},
    };
    return all;
}

/// The place of the first room that has what `has` looks for; the number of rooms: none has.
std::size_t room_where(const auto& has) {
    return static_cast<std::size_t>(std::ranges::find_if(rooms(), has) - rooms().begin());
}

std::string objection_to_public(std::string_view path, std::string_view name) {
    if (!path.starts_with("src/") || !name.starts_with("isotet/")) return {};
    path.remove_prefix(4);
    name.remove_prefix(7);
    const std::size_t own = room_where([&](const Room& room) { return path.starts_with(room.folder); });
    const std::size_t of_header = room_where([&](const Room& room) {
        return std::ranges::any_of(room.headers, [&](std::string_view header) {
            return header.ends_with('/') ? name.starts_with(header)
                                         : name.starts_with(header) && name.substr(header.size()) == ".hpp";
        });
    });
    if (own == rooms().size() || of_header == rooms().size() || of_header <= own) return {};
    return fmt::format("the functions of {} stand in src/{}, above src/{}", name, rooms()[of_header].folder,
                       rooms()[own].folder);
}

/// Folders that includes begin with; what begins otherwise is a public header, a library, or a neighbour in a test.
constexpr std::array<std::string_view, 23> folders_of_includes = {
    "base/",      "fields/", "numbers/", "grid/",   "packed/",  "check/", "make/", "ops/",
    "reference/", "cpu/",    "api/",     "device/", "session/", "solid/", "io/",   "jobs/",
    "linear/",    "paper/",  "vulkan/",  "render/", "scene/",   "cli/",   "view/"};

constexpr std::array<std::string_view, 4> below_the_engines = {"src/base/", "src/numbers/", "src/grid/", "src/packed/"};

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
    if (name.starts_with("tbb/") && path.ends_with(".hpp") && begins_with_any(path, below_the_engines)) {
        return "headers below the engines show no thread library";
    }
    if (!begins_with_any(name, folders_of_includes)) return objection_to_public(path, name);
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
