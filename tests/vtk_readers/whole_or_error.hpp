// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of an EnSight case that are cut anywhere: an error that names the file, or the same grid.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "io/confined/loaders.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {

/// All numbers of a grid.
inline std::string digest(const ReadResult& result) {
    std::string text;
    const auto add = [&](const std::string& name, const Array& values) {
        text += fmt::format("\n{}:", name);
        for (std::size_t i = 0; i < values.tuples(); ++i)
            for (std::size_t c = 0; c < values.components(); ++c) text += fmt::format(" {}", values.at(i, c));
    };
    add("points", result.grid.points);
    add("cells", result.grid.cells.connectivity);
    for (const Field& field : result.grid.point_fields) add(field.name, field.values);
    for (const Field& field : result.grid.cell_fields) add(field.name, field.values);
    return text;
}

/// A field that is left out is an error here: as where it is asked for by name.
inline Result<ReadResult> whole(Result<ReadResult> result) {
    if (!result || result->info.left_out.empty()) return result;
    return Error{ErrorCode::invalid_data, result->info.left_out.front().reason};
}

/// The same in this process, before parts are joined.
inline Result<void> check_case(const std::string& path, std::size_t step) {
    ReadOptions options;
    if (step > 0) options.step = step;
    const auto loaded = io::confined::load_ensight(path, options, io::Depth::arrays);
    if (!loaded) return loaded.error();
    if (loaded->info.left_out.empty()) return {};
    return Error{ErrorCode::invalid_data, loaded->info.left_out.front().reason};
}

using EnsightFolder = std::map<std::string, std::string>; ///< names and contents; the case is "a.case"

inline Result<ReadResult> read_ensight(const TemporaryFolder& folder, const EnsightFolder& files, std::size_t step = 0) {
    for (const auto& [name, content] : files) folder.write(name, content);
    ReadOptions options;
    if (step > 0) options.step = step;
    return whole(read(folder.file("a.case"), options));
}

inline std::string message_of(const Result<ReadResult>& result) { return result ? "read" : result.error().message; }

/// Nothing in a file without time steps tells that another part, or elements of another type, should follow.
inline bool may_end_at(const std::string& content, std::size_t at) {
    if (content.find("END TIME STEP") != std::string::npos) return false;
    for (const std::size_t place : {at, at + 1, at + 4}) // the end of a line; a record mark
        for (const char* begin : {"part", "hexa8", "penta6", "tetra4", "pyramid5"})
            if (content.compare(std::min(place, content.size()), std::string_view(begin).size(), begin) == 0) return true;
    return false;
}

/// Every length of each file but the case is checked, of longer ones an odd stride apart. Of those that pass, every fortieth
/// is read, and must be the whole.
inline void expect_whole_or_error(const EnsightFolder& files, std::size_t step = 0) {
    const TemporaryFolder folder;
    const auto all = read_ensight(folder, files, step);
    ASSERT_TRUE(all) << all.error().message;
    constexpr std::size_t stride = 40;
    const std::string expected = digest(*all);
    std::size_t passed = 0;
    for (const auto& [name, content] : files) {
        if (name == "a.case") continue;
        for (std::size_t length = 1; length < content.size(); length += (1 + content.size() / 700) | 1) {
            folder.write(name, content.substr(0, length));
            const auto checked = check_case(folder.file("a.case"), step);
            if (may_end_at(content, length)) continue;
            if (!checked) {
                EXPECT_NE(checked.error().message.find(name), std::string::npos) << checked.error().message;
                continue;
            }
            if (passed++ % stride != 0) continue;
            const auto result = read_ensight(folder, {}, step);
            ASSERT_TRUE(result) << name << " cut to " << length << " of " << content.size() << ": " << result.error().message;
            ASSERT_EQ(digest(*result), expected) << name << " cut to " << length << " of " << content.size();
        }
        folder.write(name, content);
    }
}

} // namespace isotet::test
