// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet bench` measures: pairs of a method and a search index.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/draw_tets.hpp>
#include <isotet/search.hpp>

#include "options.hpp"

namespace isotet::cli {

class Command;

inline constexpr std::array all_bench_methods{BenchMethod::direct,    BenchMethod::clusters,
                                              BenchMethod::clusters_vulkan, BenchMethod::registers,
                                              BenchMethod::registers_instanced, BenchMethod::textures,
                                              BenchMethod::mesh};

const char* name_of(BenchMethod method) noexcept;

/// Methods of DrawMethod draw lists of tets that a search index finds; the others find theirs themselves.
std::optional<DrawMethod> draw_method_of(BenchMethod method) noexcept;
bool needs_device(BenchMethod method) noexcept;

struct BenchPair {
    BenchMethod method = BenchMethod::direct;
    SearchIndex index = SearchIndex::none; ///< of a method that takes lists

    std::string name() const; ///< "textures + interval_tree", "clusters"
};

/// Each method that takes lists with each index, the others once.
std::vector<BenchPair> pairs_of(const std::vector<BenchMethod>& methods, const std::vector<SearchIndex>& indexes);

Command add_bench_command(const Command& program, BenchCommand& bench);

} // namespace isotet::cli
