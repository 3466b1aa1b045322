// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/exodus/exodus_file.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/time_values.hpp"
#include "io/pieces/common_type.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t max_plausible = std::uint64_t(1) << 48; // more than any file can hold
constexpr std::uint64_t max_blocks = std::uint64_t(1) << 20;

/// Numbers of blocks or sets; from 1 on where the file does not tell them.
std::vector<std::int64_t> ids_of(const NetcdfFile& file, const std::string& variable, std::uint64_t count) {
    auto ids = file.numbers<std::int64_t>(variable);
    if (ids && ids->size() == count) return *std::move(ids);
    std::vector<std::int64_t> from_1(count);
    std::iota(from_1.begin(), from_1.end(), std::int64_t{1});
    return from_1;
}

/// Which blocks or sets have entries: a file marks those that have none with 0, and has no variables for them.
class EntryMarks {
public:
    EntryMarks(const NetcdfFile& file, const std::string& variable)
        : marks_(file.numbers<std::int32_t>(variable).value_or(std::vector<std::int32_t>())) {}
    bool has_entries(std::size_t at) const { return at >= marks_.size() || marks_[at] != 0; }

private:
    std::vector<std::int32_t> marks_;
};

std::string upper_case(std::string text) {
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

} // namespace

namespace {

/// HDF5 has as many rows as were written.
bool has_row(const std::optional<std::vector<std::uint64_t>>& shape, std::size_t step, std::uint64_t size) {
    return !shape || shape->size() < 2 || step < shape->front() || shape->back() != size;
}

} // namespace

ScalarType ExodusFile::type() const noexcept { return is_single_ ? ScalarType::float32 : ScalarType::float64; }

Error ExodusFile::failed(std::string_view what) const {
    return {ErrorCode::invalid_data, fmt::format("{}: {} cannot be read from the Exodus file", escaped(path_), what)};
}

Result<ExodusFile> ExodusFile::open(const std::string& path) {
    auto opened = NetcdfFile::open(path);
    if (!opened) return opened.error();
    if (!(*opened)->dimension("num_dim")) return broken(path, "it is a NetCDF file, but not Exodus II: it has no dimension \"num_dim\"");
    ExodusFile file(path, *std::move(opened));
    if (auto read = file.read_contents(); !read) return read.error();
    return file;
}

Result<void> ExodusFile::read_contents() {
    auto word = file_->number_attribute({}, "floating_point_word_size");
    if (!word) word = file_->number_attribute({}, "floating point word size"); // before version 2
    is_single_ = word == 4.0;
    dimensions_ = file_->dimension("num_dim").value_or(0);
    points_ = file_->dimension("num_nodes").value_or(0);
    if (dimensions_ < 1 || dimensions_ > 3) return failed(fmt::format("a grid of {} dimensions", dimensions_));
    if (points_ > max_plausible) return failed(fmt::format("a count of {}", points_));
    if (auto read = read_blocks(); !read) return read;
    if (auto read = read_sets(); !read) return read;
    const auto steps = file_->shape("time_whole");
    if (!steps || steps->empty() || steps->front() == 0) return {}; // variables that have never been written
    const auto times = file_->rows("time_whole", 0, steps->front());
    if (!times) return {};
    times_ = time_values(*times);
    point_variables_ = file_->texts("name_nod_var");
    cell_variables_ = file_->texts("name_elem_var");
    return {};
}

Result<void> ExodusFile::read_blocks() {
    const std::uint64_t count = file_->dimension("num_el_blk").value_or(0);
    if (count > max_blocks) return failed(fmt::format("a list of {} element blocks", count));
    const auto ids = ids_of(*file_, "eb_prop1", count);
    const auto names = file_->texts("eb_names");
    const EntryMarks marks(*file_, "eb_status");
    for (std::size_t i = 0; i < count; ++i) {
        auto block = read_block(i + 1, marks.has_entries(i));
        if (!block) return block.error();
        block->id = ids[i];
        if (i < names.size()) block->name = names[i];
        cells_ += block->cells;
        blocks_.push_back(*std::move(block));
    }
    return {};
}

Result<ExodusFile::Block> ExodusFile::read_block(std::size_t number, bool has_entries) const {
    Block block;
    block.number = number;
    if (!has_entries) return block;
    const auto of_block = [&](const char* name) { return file_->dimension(fmt::format("{}{}", name, number)); };
    const auto cells = of_block("num_el_in_blk");
    if (!cells) return failed(fmt::format("the number of elements of element block {}", number));
    for (const char* variable : {"connect", "facconn"})
        if (const auto topology = file_->text_attribute(fmt::format("{}{}", variable, number), "elem_type"))
            block.topology = upper_case(*topology);
    block.cells = *cells;
    block.faces = of_block("num_fac_per_el").value_or(0);
    const bool ragged = block.topology.starts_with("NFACED") || block.topology.starts_with("NSIDED");
    block.corners = ragged ? 0 : of_block("num_nod_per_el").value_or(0);
    if (block.cells > max_plausible || block.corners > 1000 || block.faces > max_plausible)
        return failed(fmt::format("element block {} of {} elements with {} nodes each and {} faces", number,
                                  block.cells, block.corners, block.faces));
    return block;
}

Result<void> ExodusFile::read_sets() {
    const std::uint64_t count = file_->dimension("num_elem_sets").value_or(0);
    if (count > max_blocks) return failed(fmt::format("a list of {} element sets", count));
    const auto ids = ids_of(*file_, "els_prop1", count);
    const auto names = file_->texts("els_names");
    const EntryMarks marks(*file_, "els_status");
    for (std::size_t i = 0; i < count; ++i) {
        const bool filled = marks.has_entries(i);
        const auto cells =
            filled ? file_->dimension(fmt::format("num_ele_els{}", i + 1)) : std::optional<std::uint64_t>(0);
        if (!cells || *cells > max_plausible) return failed(fmt::format("element set {}", ids[i]));
        sets_.push_back(
            {ids[i], i + 1, i < names.size() && !names[i].empty() ? names[i] : fmt::format("set {}", ids[i]), *cells});
    }
    return {};
}

Result<std::vector<std::int64_t>> ExodusFile::cells_of(const Set& set) const {
    if (set.cells == 0) return std::vector<std::int64_t>();
    auto cells = file_->numbers<std::int64_t>(fmt::format("elem_els{}", set.number));
    if (!cells || cells->size() != set.cells) return failed(fmt::format("the elements of set {}", set.id));
    for (std::int64_t& cell : *cells) {
        if (cell < 1 || static_cast<std::uint64_t>(cell) > cells_)
            return Error{ErrorCode::invalid_data,
                         fmt::format("{}: element set {} has element {}, but the elements are 1 to {}", escaped(path_),
                                     set.id, cell, cells_)};
        --cell;
    }
    return *std::move(cells);
}

Result<std::vector<ExodusFile::SideSet>> ExodusFile::side_sets() const {
    const std::uint64_t count = file_->dimension("num_side_sets").value_or(0);
    if (count > max_blocks) return failed(fmt::format("a list of {} side sets", count));
    const auto ids = ids_of(*file_, "ss_prop1", count);
    const auto names = file_->texts("ss_names");
    const EntryMarks marks(*file_, "ss_status");
    std::vector<SideSet> sets;
    for (std::size_t i = 0; i < count; ++i) {
        if (!marks.has_entries(i) || ids[i] < 0) continue;
        auto cells = file_->numbers<std::int64_t>(fmt::format("elem_ss{}", i + 1));
        auto sides = file_->numbers<std::int64_t>(fmt::format("side_ss{}", i + 1));
        if (!cells || !sides || cells->size() != sides->size())
            return failed(fmt::format("the sides of side set {}", ids[i]));
        const bool named = i < names.size() && !names[i].empty();
        sets.push_back({ids[i], i + 1, named ? names[i] : fmt::format("side set {}", ids[i]), *std::move(cells),
                        *std::move(sides)});
    }
    return sets;
}

std::optional<std::uint64_t> ExodusFile::place_of(std::int64_t element) const {
    if (element < 1) return std::nullopt;
    const auto from_0 = static_cast<std::uint64_t>(element) - 1;
    if (all_blocks_.empty()) return from_0 < cells_ ? std::optional(from_0) : std::nullopt;
    std::uint64_t before = 0, chosen_before = 0;
    for (const auto& [cells, chosen] : all_blocks_) {
        if (from_0 < before + cells) return chosen ? chosen_before + from_0 - before : not_read;
        before += cells;
        chosen_before += chosen ? cells : 0;
    }
    return std::nullopt;
}

void ExodusFile::choose(const std::vector<bool>& chosen) {
    std::vector<Block> kept;
    cells_ = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        all_blocks_.emplace_back(blocks_[i].cells, chosen[i]);
        if (!chosen[i]) continue;
        cells_ += blocks_[i].cells;
        kept.push_back(std::move(blocks_[i]));
    }
    blocks_ = std::move(kept);
}

std::optional<Array> ExodusFile::as_own_type(Result<Array> found, std::uint64_t size) const {
    if (!found || found->size() != size) return std::nullopt;
    if (found->type() == type()) return *std::move(found);
    return Array(type(), nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> std::optional<Array> {
        std::vector<T> converted(size);
        convert_scalars(*found, type(), reinterpret_cast<std::byte*>(converted.data()));
        return Array::own(std::move(converted));
    });
}

std::optional<Array> ExodusFile::rows(const std::string& variable, std::uint64_t first, std::uint64_t size) const {
    const auto shape = file_->shape(variable);
    const bool is_flat = shape && shape->size() == 1; // one place is one value
    return as_own_type(file_->rows(variable, is_flat ? 0 : first, is_flat ? size : 1), size);
}

double ExodusFile::fill_value_of(const std::string& variable) const {
    constexpr double of_netcdf = 9.9692099683868690e+36; // float32, too
    return file_->number_attribute(variable, "_FillValue").value_or(of_netcdf);
}

std::optional<Array> ExodusFile::rows_of_step(const std::string& variable, std::size_t step, std::uint64_t size) const {
    if (has_row(file_->shape(variable), step, size)) return rows(variable, step, size);
    const double fill = fill_value_of(variable);
    if (is_single_) return Array::own(std::vector<float>(size, static_cast<float>(fill)));
    return Array::own(std::vector<double>(size, fill));
}

template <class T>
Result<Array> ExodusFile::read_coordinates() const {
    std::vector<T> places(3 * points_, T(0));
    const bool together = file_->has("coord"); // in files of before version 2.02
    for (std::uint64_t axis = 0; axis < dimensions_ && points_ > 0; ++axis) {
        const auto along = rows(together ? "coord" : std::string("coord") + "xyz"[axis], axis, points_);
        if (!along) return failed("coordinates");
        for (std::uint64_t i = 0; i < points_; ++i) places[3 * i + axis] = along->as<T>()[i];
    }
    return Array::own(std::move(places), 3);
}

Result<Array> ExodusFile::coordinates() { return is_single_ ? read_coordinates<float>() : read_coordinates<double>(); }

Result<std::vector<std::int64_t>> ExodusFile::connectivity(const Block& block) {
    if (block.cells == 0 || block.corners == 0) return std::vector<std::int64_t>();
    const auto all = nodes(block, 0, block.cells);
    if (!all) return all.error();
    std::vector<std::int64_t> numbers(all->size());
    convert_scalars(*all, ScalarType::int64, reinterpret_cast<std::byte*>(numbers.data()));
    return numbers;
}

Result<Array> ExodusFile::nodes(const Block& block, std::uint64_t first, std::uint64_t count) const {
    auto nodes = file_->rows(fmt::format("connect{}", block.number), first, count);
    if (!nodes || nodes->size() != count * block.corners)
        return failed(fmt::format("the nodes of element block {}", block.id));
    return nodes;
}

template <class T>
Result<Array> ExodusFile::read_point_variable(std::size_t variable, std::size_t step, Gaps& gaps) const {
    std::string own = fmt::format("vals_nod_var{}", variable + 1);
    const bool alone = file_->has(own);
    if (!alone) own = "vals_nod_var"; // of all variables, as "coord"
    auto all = alone ? rows_of_step(own, step, points_) : rows(own, step, points_ * point_variables_.size());
    if (!all) return failed(fmt::format("nodal variable \"{}\"", escaped(point_variables_[variable])));
    const std::span<const T> values = all->as<T>().subspan(alone ? 0 : variable * points_, points_);
    const T fill = static_cast<T>(fill_value_of(own));
    const auto unwritten = static_cast<std::uint64_t>(std::ranges::count(values, fill));
    if (unwritten == 0) return Array(type(), values.data(), points_, 1, all->owner().lock());
    gaps.values += unwritten;
    std::vector<T> known(values.begin(), values.end());
    std::ranges::replace(known, fill, std::numeric_limits<T>::quiet_NaN());
    return Array::own(std::move(known));
}

Result<Array> ExodusFile::point_variable(std::size_t variable, std::size_t step, Gaps& gaps) {
    return is_single_ ? read_point_variable<float>(variable, step, gaps)
                      : read_point_variable<double>(variable, step, gaps);
}

ExodusFile::CellVariable ExodusFile::find_cell_variable(std::size_t variable, std::size_t step) const {
    CellVariable found{cell_variables_[variable], step, {}};
    const auto table = file_->numbers<std::int32_t>("elem_var_tab");
    for (const Block& block : blocks_) {
        if (block.cells == 0) continue;
        CellVariable::Part& part = found.parts.emplace_back();
        part.cells = block.cells;
        const std::string name = fmt::format("vals_elem_var{}eb{}", variable + 1, block.number);
        const std::size_t at = (block.number - 1) * cell_variables_.size() + variable;
        if (table && at < table->size() ? (*table)[at] == 0 : !file_->has(name)) continue;
        part.name = name;
        const auto shape = file_->shape(name);
        part.is_flat = shape && shape->size() == 1;
        part.is_written = has_row(shape, step, block.cells);
        part.fill = fill_value_of(name);
    }
    return found;
}

template <class Visit>
Result<void> ExodusFile::each_part(const CellVariable& variable, const Visit& visit) const {
    std::uint64_t first = 0;
    for (const CellVariable::Part& part : variable.parts) {
        if (!part.name.empty() && part.is_written) {
            auto values = file_->rows(part.name, part.is_flat ? 0 : variable.step, part.is_flat ? part.cells : 1);
            const auto own = as_own_type(std::move(values), part.cells);
            if (!own) return failed(fmt::format("element variable \"{}\"", escaped(variable.name)));
            visit(first, part, *own);
        }
        first += part.cells;
    }
    return {};
}

Result<ExodusFile::Gaps> ExodusFile::gaps_of(const CellVariable& variable) const {
    Gaps gaps;
    for (const CellVariable::Part& part : variable.parts) {
        if (part.name.empty()) ++gaps.blocks;
        else if (!part.is_written) gaps.values += part.cells;
    }
    const auto done = each_part(variable, [&](std::uint64_t, const CellVariable::Part& part, const Array& values) {
        values.visit([&]<class T>(std::span<const T> all) {
            gaps.values += static_cast<std::uint64_t>(std::ranges::count(all, static_cast<T>(part.fill)));
        });
    });
    return done ? Result<Gaps>(gaps) : done.error();
}

Result<Array> ExodusFile::values_of(const CellVariable& variable, const std::vector<std::uint64_t>& cells) const {
    const auto some = [&]<class T>(T nan) -> Result<Array> {
        std::vector<T> taken(cells.size(), nan);
        const auto done =
            each_part(variable, [&](std::uint64_t first, const CellVariable::Part& part, const Array& values) {
                const auto all = values.as<T>();
                const T fill = static_cast<T>(part.fill);
                for (auto cell = std::ranges::lower_bound(cells, first);
                     cell != cells.end() && *cell < first + part.cells; ++cell)
                    if (const T value = all[*cell - first]; value != fill)
                        taken[static_cast<std::size_t>(cell - cells.begin())] = value;
            });
        if (!done) return done.error();
        return Array::own(std::move(taken));
    };
    return is_single_ ? some(std::numeric_limits<float>::quiet_NaN()) : some(std::numeric_limits<double>::quiet_NaN());
}

Result<Array> ExodusFile::values_of(const CellVariable& variable) const {
    const auto all = [&]<class T>(T nan) -> Result<Array> {
        std::vector<T> taken(cells_, nan);
        const auto done =
            each_part(variable, [&](std::uint64_t first, const CellVariable::Part& part, const Array& values) {
                std::ranges::replace_copy(values.as<T>(), taken.begin() + static_cast<std::ptrdiff_t>(first),
                                          static_cast<T>(part.fill), nan);
            });
        if (!done) return done.error();
        return Array::own(std::move(taken));
    };
    return is_single_ ? all(std::numeric_limits<float>::quiet_NaN()) : all(std::numeric_limits<double>::quiet_NaN());
}

Result<Array> ExodusFile::cell_variable(std::size_t variable, std::size_t step, Gaps& gaps) {
    const CellVariable found = find_cell_variable(variable, step);
    auto counted = gaps_of(found);
    if (!counted) return counted.error();
    gaps = *counted;
    return values_of(found);
}

/// A node or element has its place as its number where the file has no map.
Result<Array> ExodusFile::id_map(const std::string& map, std::uint64_t count) const {
    auto ids = ids_of(*file_, map, count);
    return Array::own(std::move(ids));
}

Result<Array> ExodusFile::point_ids() { return id_map("node_num_map", points_); }

Result<Array> ExodusFile::cell_ids() {
    if (all_blocks_.empty()) return id_map("elem_num_map", cells_);
    std::uint64_t count = 0;
    for (const auto& [cells, chosen] : all_blocks_) count += cells;
    const auto all = id_map("elem_num_map", count);
    if (!all) return all;
    std::vector<std::int64_t> ids;
    const auto numbers = all->as<std::int64_t>();
    std::size_t first = 0;
    for (const auto& [cells, chosen] : all_blocks_) {
        if (chosen) ids.insert(ids.end(), numbers.begin() + first, numbers.begin() + first + cells);
        first += cells;
    }
    return Array::own(std::move(ids));
}

ExodusElement exodus_element(std::string_view topology, std::uint64_t nodes) {
    struct Known {
        std::string_view begins;
        std::uint64_t nodes;
        std::uint8_t type;
    };
    static constexpr Known known[] = {
        {"TET", 4, 10},  {"TET", 10, 24}, {"HEX", 8, 12},   {"HEX", 20, 25},  {"HEX", 27, 29},  {"WED", 6, 13},
        {"WED", 15, 26}, {"WED", 18, 32}, {"PYR", 5, 14},   {"PYR", 13, 27},  {"PYR", 14, 74},  {"TRI", 3, 5},
        {"TRI", 6, 22},  {"TRI", 0, 22},  {"QUA", 4, 9},    {"QUA", 8, 23},   {"QUA", 9, 28},   {"QUA", 0, 23},
        {"SHELL", 3, 5}, {"SHELL", 4, 9}, {"SHELL", 6, 22}, {"SHELL", 8, 23}, {"SHELL", 9, 28}, {"SHELL", 0, 23},
        {"BAR", 2, 3},   {"BAR", 0, 21},  {"BEAM", 2, 3},   {"BEAM", 0, 21},  {"TRUSS", 2, 3},  {"TRUSS", 0, 21},
        {"EDGE", 2, 3},  {"EDGE", 0, 21}, {"SPHERE", 0, 1}, {"CIRCLE", 0, 1}, {"NSIDED", 0, 7}, {"NFACED", 0, 42},
    };
    for (const Known& element : known)
        if (topology.starts_with(element.begins) && (element.nodes == nodes || element.nodes == 0))
            return {element.type, nodes};
    // Nodes in faces and in the middle stand behind those of a smaller element. WEDGE also as PRISM.
    struct Longer {
        std::string_view begins;
        std::uint64_t nodes;
        ExodusElement element;
    };
    static constexpr Longer longer[] = {
        {"TET", 8, {10, 4}},     {"TET", 11, {24, 10}},   {"TET", 14, {24, 10}},   {"TET", 15, {24, 10}},
        {"HEX", 9, {12, 8}},     {"HEX", 21, {25, 20}},   {"WED", 16, {26, 15}},   {"WED", 20, {26, 15}},
        {"WED", 21, {26, 15}},   {"PRISM", 6, {13, 6}},   {"PRISM", 15, {26, 15}}, {"PRISM", 16, {26, 15}},
        {"PRISM", 18, {32, 18}}, {"PRISM", 20, {26, 15}}, {"PRISM", 21, {26, 15}}, {"PYR", 18, {27, 13}},
        {"PYR", 19, {27, 13}},
    };
    for (const Longer& one : longer)
        if (topology.starts_with(one.begins) && one.nodes == nodes) return one.element;
    return {}; // an empty cell, left out
}

} // namespace isotet::io::confined
