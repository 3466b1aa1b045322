// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What an EnSight Gold case file says of its other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isotet::io::vtk {

/// In names stars stand for the digits of a step.
struct GoldCase {
    struct Variable {
        std::string name; ///< of the file
        std::size_t components = 1;
        bool of_nodes = true;
    };
    bool is_gold = false;
    std::string model;
    std::vector<Variable> variables;
    int time_sets = 0;
    std::uint64_t first_number = 0, increment = 1;
    std::vector<std::uint64_t> numbers; ///< of the files of each step; empty: from `first_number` on
};

GoldCase parse_case(std::string_view text);

/// The name with the number of a step in place of its stars; nothing where the case does not say enough.
std::optional<std::string> name_of_step(const GoldCase& from, std::string name, std::size_t step);

} // namespace isotet::io::vtk
