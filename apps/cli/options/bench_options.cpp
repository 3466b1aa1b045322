// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

constexpr const char* bench_details = R"(
Each method gets every isovalue in every round; without -i three are taken. With a device each isovalue ends as a
picture; without one (--device none) surfaces are extracted. Prepare is what happens once: packing, building the search
index, uploading. Search is the index's; extract is making triangles, and sending them or the list of tets to the
device; draw is the rest of the way to the picture. Medians; the best round in JSON.

Methods: direct and clusters (CPU), clusters_vulkan (device); and those that draw tets without making a surface:
registers, registers_instanced and textures of Buatois, Caumon and Levy (2006), and mesh, where the device has mesh
shaders. Indexes for these four: none, interval_tree, octree, seed_set, span_space, cluster_ranges.

--paper measures tets a second against the size of the grid, and what the interval tree gains. --device-memory shows, at
sizes that one can run, what happens to grids that do not fit.

Examples:
  isotet bench grid.vtu -f pressure -i 0.5
  isotet bench grid.vtu -f pressure --methods clusters,textures --indexes none,interval_tree
  isotet bench --paper --device software --max-tets 1000000 --json figure4.json
  isotet bench --paper --device-memory 256MB --json figure4.json
)";

/// Words separated by commas, each one of `all` by its name.
template <class Value, class All>
void add_list(const Command& command, const std::string& option, std::vector<Value>& target, const All& all,
              const std::string& description) {
    command.add_words(
        option,
        [&target, &all, option](const std::vector<std::string>& words) {
            for (const std::string& word : words) {
                const auto found =
                    std::ranges::find_if(all, [&](Value value) { return std::string_view(name_of(value)) == word; });
                std::string names;
                for (const Value value : all) names += fmt::format("{}{}", names.empty() ? "" : ", ", name_of(value));
                if (found == all.end()) refuse_value(option, word, "one or more of " + names);
                if (std::ranges::find(target, *found) == target.end()) target.push_back(*found);
            }
        },
        "A[,B...]", description);
}

} // namespace

Command add_bench_command(const Command& program, BenchCommand& bench) {
    const Command command =
        program.add_command("bench", "Measure methods and search indexes on a grid, and tell the fastest");
    const Option file =
        command.add_file("FILE", bench.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]");
    const Option paper = command.add_flag(
        "--paper", bench.paper, "Measure Figure 4 of Buatois, Caumon and Levy (2006) on made grids, without FILE");
    paper.excludes(file);
    command
        .add_count(
            "--max-tets", {1000, 1'000'000'000}, [&](std::uint64_t n) { bench.max_tets = n; }, "N",
            "Largest grid of --paper; default: 5000000")
        .needs(paper);
    add_field(command, bench.field,
              "The field to contour, or an expression such as mag(U); default: the one that info says is shown first")
        .excludes(paper);
    add_isovalues(command, bench.isovalues, bench.shares).excludes(paper);
    add_list(command, "--methods", bench.methods, all_bench_methods,
             "Methods, separated by commas; default: all that run on this machine");
    add_list(command, "--indexes", bench.indexes, all_search_indexes,
             "Search indexes, separated by commas; default: none and interval_tree");
    command.add_count(
        "--rounds", {1, 1000}, [&](std::uint64_t n) { bench.rounds = n; }, "N",
        "How often everything is measured; default: 5");
    command.set_details(bench_details);
    return command;
}

} // namespace isotet::cli
