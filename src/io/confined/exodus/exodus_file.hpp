// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An Exodus II file: dimensions and variables of a netCDF file, under names that the format lays down. Source: L. Schoof and
// V. Yarberry, "EXODUS II: A Finite Element Data Model", SAND92-2137, and what its library has written since.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "io/confined/netcdf/netcdf_file.hpp"

namespace isotet::io::confined {

class ExodusFile {
public:
    struct Block {
        std::int64_t id = 0;
        std::size_t number = 0; ///< in the names of its variables: 1 for the first block of the file
        std::string name;       ///< empty: it has none
        std::string topology;   ///< upper case
        std::uint64_t cells = 0;
        std::uint64_t corners = 0; ///< of each cell; 0 where cells differ (polyhedra, polygons)
        std::uint64_t faces = 0;   ///< of polyhedra: of all cells together

        bool has_faces() const { return topology.starts_with("NFACED"); }
    };

    /// Elements of any blocks.
    struct Set {
        std::int64_t id = 0;
        std::size_t number = 0; ///< as that of blocks
        std::string name;       ///< "set 3" where it has none
        std::uint64_t cells = 0;
    };

    /// Sides of elements of any blocks.
    struct SideSet {
        std::int64_t id = 0;
        std::size_t number = 0;                      ///< as that of blocks
        std::string name;                            ///< "side set 3" where it has none
        std::vector<std::int64_t> cells, sides = {}; ///< from 1, cells through all blocks of the file
    };

    static Result<ExodusFile> open(const std::string& path);

    std::uint64_t points() const noexcept { return points_; }
    std::uint64_t cells() const noexcept { return cells_; }
    const std::vector<Block>& blocks() const noexcept { return blocks_; }
    const std::vector<Set>& sets() const noexcept { return sets_; }
    const std::vector<std::string>& point_variables() const noexcept { return point_variables_; }
    const std::vector<std::string>& cell_variables() const noexcept { return cell_variables_; }
    const std::vector<double>& times() const noexcept { return times_; }
    /// Time steps behind these, which the file ends before.
    std::uint64_t steps_cut_off() const { return file_->records_cut_off(); }
    /// Leaves out blocks for all that follows: of the file's blocks those stay that `chosen` marks.
    void choose(const std::vector<bool>& chosen);

    ScalarType type() const noexcept; ///< of coordinates and variables

    Result<Array> coordinates();
    /// Node numbers from 1, of all cells of a block; empty where `corners` is 0. Safe from many threads.
    Result<std::vector<std::int64_t>> connectivity(const Block& block);
    /// Of some cells, in the type of the file, not checked. Safe from many threads.
    Result<Array> nodes(const Block& block, std::uint64_t first, std::uint64_t count) const;
    /// Numbers from 1, and how many belong to each face or cell.
    struct Ragged {
        std::vector<std::int64_t> numbers;
        std::vector<int> counts;
    };
    /// The nodes of the faces of all face blocks, one after another.
    Result<Ragged> faces();
    /// The faces of the polyhedra of a block.
    ///
    /// Errors   invalid_data: variables that are missing or of another size; counts whose sum is not that of the numbers
    Result<Ragged> faces_of(const Block& block);
    /// The elements of a set, counted from 0 through all blocks of the file.
    Result<std::vector<std::int64_t>> cells_of(const Set& set) const;
    static constexpr std::uint64_t not_read = ~std::uint64_t{0};
    /// Which cell of the chosen blocks an element of the file is, from 1 through all blocks; nothing: there is no such element.
    std::optional<std::uint64_t> place_of(std::int64_t element) const;
    /// Errors   invalid_data: sides that are not one for each element
    Result<std::vector<SideSet>> side_sets() const;
    /// Where a variable is NaN.
    struct Gaps {
        std::size_t blocks = 0;   ///< that do not have it
        std::uint64_t values = 0; ///< that were never written: netCDF's fill value
    };
    Result<Array> point_variable(std::size_t variable, std::size_t step, Gaps& gaps);
    /// One value a cell of all blocks.
    Result<Array> cell_variable(std::size_t variable, std::size_t step, Gaps& gaps);
    /// Where the values of each block with cells are.
    struct CellVariable {
        struct Part {
            std::string name; ///< of the variable of the block; empty: the block does not have it
            std::uint64_t cells = 0;
            bool is_flat = false;    ///< one place is one value
            bool is_written = false; ///< else all are the fill value
            double fill = 0;
        };
        std::string name;
        std::size_t step = 0;
        std::vector<Part> parts;
    };
    CellVariable find_cell_variable(std::size_t variable, std::size_t step) const;
    /// Its gaps, or why it cannot be read.
    Result<Gaps> gaps_of(const CellVariable& variable) const;
    /// Of some cells, which ascend. Takes the values of one block at a time. Safe from many threads.
    Result<Array> values_of(const CellVariable& variable, const std::vector<std::uint64_t>& cells) const;
    /// Of all. Safe from many threads.
    Result<Array> values_of(const CellVariable& variable) const;
    Result<Array> point_ids();
    Result<Array> cell_ids();

private:
    ExodusFile(std::string path, std::unique_ptr<NetcdfFile> file) : path_(std::move(path)), file_(std::move(file)) {}
    Error failed(std::string_view what) const;
    Result<void> read_contents();
    Result<void> read_blocks();
    Result<Block> read_block(std::size_t number, bool has_entries) const;
    Result<void> read_sets();
    Result<Ragged> read_ragged(const std::string& numbers, const std::string& counts, std::uint64_t count,
                               std::uint64_t size, const std::string& owner) const;
    /// So many values in the type of the file's coordinates and variables.
    std::optional<Array> as_own_type(Result<Array> found, std::uint64_t size) const;
    /// Some rows of a variable in that type, if it has so many values.
    std::optional<Array> rows(const std::string& variable, std::uint64_t first, std::uint64_t size) const;
    /// The fill value in rows that a file in HDF5 lacks.
    std::optional<Array> rows_of_step(const std::string& variable, std::size_t step, std::uint64_t size) const;
    double fill_value_of(const std::string& variable) const;
    template <class T>
    Result<Array> read_coordinates() const;
    template <class T>
    Result<Array> read_point_variable(std::size_t variable, std::size_t step, Gaps& gaps) const;
    /// Calls visit(first cell, part, values) for each part that has some, in the type of the file, not looked at.
    template <class Visit>
    Result<void> each_part(const CellVariable& variable, const Visit& visit) const;
    Result<Array> id_map(const std::string& map, std::uint64_t count) const;

    std::string path_;
    std::unique_ptr<NetcdfFile> file_;
    bool is_single_ = false;
    std::uint64_t dimensions_ = 3, points_ = 0, cells_ = 0; ///< cells of the chosen blocks
    std::vector<Block> blocks_;
    std::vector<Set> sets_;
    std::vector<std::pair<std::uint64_t, bool>> all_blocks_; ///< cells, and whether chosen; empty: all are
    std::vector<std::string> point_variables_, cell_variables_;
    std::vector<double> times_;
};

/// What is read of an element.
struct ExodusElement {
    std::uint8_t type = 0;   ///< VTK's; 0: not known
    std::uint64_t nodes = 0; ///< the first ones are read; fewer than the element has where VTK has no such type
};

/// An element with so many nodes.
ExodusElement exodus_element(std::string_view topology, std::uint64_t nodes);

} // namespace isotet::io::confined
