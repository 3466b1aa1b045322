// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The parts of an EnSight geometry, and the values of one variable in them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>

#include "io/confined/ensight/ensight_case.hpp"
#include "io/confined/ensight/ensight_cells.hpp"
#include "io/confined/ensight/ensight_file.hpp"
#include "io/pieces/number_map.hpp"

namespace isotet::io::confined {

struct EnsightPart {
    /// Consecutive cells.
    struct Run {
        std::uint64_t first = 0, count = 0;
    };
    std::uint64_t number = 0;
    std::string name, file; ///< the geometry that has it
    bool is_structured = false, is_wanted = true;
    std::uint64_t nodes = 0, cells = 0; ///< none of ghosts; nodes of unstructured parts of EnSight 6: the grid has them
    std::array<std::uint64_t, 3> size{}; ///< of a block
    std::map<std::string, std::vector<Run>, std::less<>> elements; ///< of each type, ghosts too, which are no cells
    Array points;
    EnsightCells made;
    std::vector<std::uint8_t> left_out; ///< empty, or nonzero for each cell of a block that is blanked or a ghost
};

/// One for each part that has values, else empty, and one for all unstructured parts of EnSight 6.
using EnsightColumns = std::vector<std::vector<float>>;

class EnsightGrid {
public:
    std::uint64_t nodes = 0; ///< of all unstructured parts of EnSight 6, with their points and numbers
    Array points;
    NumberMap numbers;
    bool is_numbered = false;
    std::vector<EnsightPart> parts;

    /// A part that the geometry begins; throws where it is there already.
    EnsightPart& add(const EnsightFile& file, std::uint64_t number, std::string name);

    /// The place of a part.
    std::size_t find(const EnsightFile& file, std::uint64_t number) const;

private:
    std::map<std::uint64_t, std::size_t> places_;
};

/// The values of one file of a variable go to `column` and following ones of a field that is `width` wide.
struct EnsightField {
    const EnsightCase::Variable& variable;
    std::size_t width = 1, column = 0;
    EnsightColumns columns = {};

    /// `values`   of the cells in `runs`, or of all nodes; may be empty
    void put(std::size_t part, std::uint64_t all, const std::vector<EnsightPart::Run>& runs, std::vector<float> values);
};

/// Follows the values of one part by types of elements: each type once, and at the end all of them.
class EnsightBlocks {
public:
    EnsightBlocks(const EnsightFile& file, const EnsightPart& part) : file_(file), part_(part) {}

    const std::vector<EnsightPart::Run>& take(std::string_view type);
    void expect_all() const;

private:
    const EnsightFile& file_;
    const EnsightPart& part_;
    std::set<std::string, std::less<>> taken_;
};

std::uint64_t count_of(const std::vector<EnsightPart::Run>& runs);

/// True before a part, and at the end of the data.
bool is_at_part(EnsightFile& file);

bool has_word(std::string_view line, std::string_view word);

/// A block behind its first line, `kind`: "block", and words that tell more.
void read_block(EnsightFile& file, EnsightPart& part, const std::string& kind, std::size_t on_line);

/// A whole file, or one step of it, which begins behind BEGIN TIME STEP; values behind the description.
///
/// Errors   thrown: counts beyond what is left of the file, fewer or more values than the grid has nodes or elements
void read_gold_geometry(EnsightFile& file, EnsightGrid& grid, bool in_step);
void read_gold_values(EnsightFile& file, const EnsightGrid& grid, EnsightField& field);
void read_6_geometry(EnsightFile& file, EnsightGrid& grid, bool in_step);
void read_6_values(EnsightFile& file, const EnsightGrid& grid, EnsightField& field);

} // namespace isotet::io::confined
