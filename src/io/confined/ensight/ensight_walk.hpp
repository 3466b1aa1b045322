// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Walks through the files of EnSight that find out whether all is there, and whether VTK's reader takes it as it is meant.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "io/confined/ensight/ensight_case.hpp"
#include "io/confined/ensight/ensight_file.hpp"

namespace isotet::io::confined {

struct EnsightPart {
    std::uint64_t nodes = 0, cells = 0; ///< nodes of unstructured parts of EnSight 6: none, the grid has them
    bool is_structured = false;
    std::size_t order = 0;              ///< among the parts of the geometry, from 0
    std::map<std::string, std::uint64_t, std::less<>> elements; ///< of each type, ghosts too
};

/// What the geometry has, for which variables must have values.
struct EnsightGrid {
    std::uint64_t nodes = 0; ///< of all unstructured parts of EnSight 6
    std::map<std::uint64_t, EnsightPart> parts;

    /// A part that the geometry begins; throws where it is there already.
    EnsightPart& add(const EnsightFile& file, std::uint64_t number);
    const EnsightPart& part(const EnsightFile& file, std::uint64_t number) const;
    bool ends_with_block() const; ///< the part that was added last
};

/// True before a part, and at the end of the data.
bool is_at_part(EnsightFile& file);

/// The number in "part 3", a line of EnSight 6.
std::uint64_t number_in_part_line(const EnsightFile& file, std::string_view line);

/// Nodes of a type of elements, 0 for others.
std::uint64_t nodes_of_element(std::string_view type);

/// The size of a block. `most_nodes`: what is left of the file, or what an implied grid may have.
void set_block_size(const EnsightFile& file, EnsightPart& part, const std::array<std::uint64_t, 3>& size,
                    std::uint64_t most_nodes);

/// Follows the blocks of values in one part of a variable: each type once, and at the end all of them.
class EnsightBlocks {
public:
    EnsightBlocks(const EnsightFile& file, const EnsightPart& part, std::uint64_t number)
        : file_(file), part_(part), number_(number) {}

    /// The number of elements of a type.
    std::uint64_t take(std::string_view type);
    void expect_all() const;

private:
    const EnsightFile& file_;
    const EnsightPart& part_;
    std::uint64_t number_;
    std::set<std::string, std::less<>> taken_;
};

/// Calls `walk` for one of the steps in a file, from 1, and for binary files for those before it, too: VTK's reader goes
/// through them by the counts of the one that is asked for. Returns where each of them begins, behind BEGIN TIME STEP.
///
/// `other_steps`   what else is looked at: all of them where VTK's reader counts them; then the only one of a file may also be
///                 for all times
enum class OtherSteps : std::uint8_t { before, all, all_or_only_one };
std::vector<std::size_t> walk_steps(EnsightFile& file, std::size_t step, OtherSteps other_steps,
                                    const std::function<void(bool asked_for)>& walk);

/// A last line of text that is not ended may have lost digits, unless its numbers fill their columns.
void expect_whole_last_line(const EnsightFile& file, std::size_t integer_width);

/// Cursors are at the beginning, or behind BEGIN TIME STEP with `in_step`.
EnsightGrid walk_gold_geometry(EnsightFile& file, bool in_step);
EnsightGrid walk_6_text_geometry(EnsightFile& file, bool in_step);
EnsightGrid walk_6_binary_geometry(EnsightFile& file, bool in_step);

/// `asked_for`   false for a step before the one that is read
void walk_gold_variable(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid, bool asked_for);
void walk_6_text_variable(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid);
void walk_6_binary_variable(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid,
                            bool asked_for);

/// In a file of EnSight Gold that ends with an index of its steps: VTK's reader jumps to where it says.
void check_gold_index(EnsightFile& file, std::size_t step, const std::vector<std::size_t>& begins);

/// In a binary geometry of EnSight 6, behind END TIME STEP: VTK's reader does not end there.
void expect_no_elements_behind(EnsightFile& file);

} // namespace isotet::io::confined
