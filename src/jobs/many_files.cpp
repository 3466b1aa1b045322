// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/many_files.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>

#include <isotet/jobs/output_names.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

constexpr std::string_view name_mark = "{name}";

/// The path without a slash at its end, which folders may have.
std::filesystem::path last_of(const std::string& path) {
    const std::filesystem::path whole(path);
    return whole.has_filename() ? whole : whole.parent_path();
}

/// The name with "#" for each number in it.
std::string without_numbers(const std::string& path) {
    std::string text;
    for (const char c : last_of(path).filename().string()) {
        if (c < '0' || c > '9') text += c;
        else if (text.empty() || text.back() != '#') text += '#';
    }
    return text;
}

/// "run" of "results/run.vtu" and of the folder "results/run/".
std::string name_of_file(const std::string& path) { return last_of(path).stem().string(); }

} // namespace

bool are_time_steps(const GridOptions& grid) {
    if (grid.file.starts_with("make:")) return true; // which is refused
    const std::string first = without_numbers(grid.file);
    return std::ranges::all_of(grid.more_files,
                               [&](const std::string& file) { return without_numbers(file) == first; });
}

std::vector<GridOptions> each_file(const GridOptions& grid) {
    GridOptions one = grid;
    one.more_files.clear();
    std::vector<GridOptions> all{one};
    for (const std::string& file : grid.more_files) {
        one.file = file;
        all.push_back(one);
    }
    return all;
}

bool names_each_file(const ExtractJob& job) { return job.out.find(name_mark) != std::string::npos; }

Result<std::vector<ExtractJob>> job_for_each_file(const ExtractJob& job) {
    const bool several = !job.grid.more_files.empty();
    if (several && !job.parts_table.empty() && job.parts_table.find(name_mark) == std::string::npos)
        return refusal("`parts` is '{}', which would be the same file for all: it needs {}", job.parts_table,
                       name_mark);
    std::vector<ExtractJob> jobs;
    std::vector<std::string> inputs;
    std::map<std::string, std::string> files; // by name
    for (const GridOptions& grid : each_file(job.grid)) {
        const std::string name = name_of_file(grid.file);
        const auto [other, is_new] = files.try_emplace(name, grid.file);
        if (!is_new)
            return refusal("'{}' and '{}' have the same name, '{}': {} would be the same file for both", other->second,
                           grid.file, name, job.out);
        ExtractJob& one = jobs.emplace_back(job);
        one.grid = grid;
        for (std::string* text : {&one.out, &one.parts_table})
            for (std::size_t at = 0; (at = text->find(name_mark, at)) != std::string::npos; at += name.size())
                text->replace(at, name_mark.size(), name);
        inputs.push_back(grid.file);
    }
    for (const ExtractJob& one : jobs)
        if (auto paths = check_output_paths(inputs, {one.out, one.parts_table}); !paths) return paths.error();
    return jobs;
}

} // namespace isotet::jobs
