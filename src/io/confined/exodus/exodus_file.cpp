// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include <fmt/core.h>
#include <vtk_exodusII.h>

#include "io/confined/exodus/exodus_file.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

constexpr int max_name = 4096;
constexpr std::uint64_t max_plausible = std::uint64_t(1) << 48; // more than any file can hold

/// What to call with `visit` for the file's floating-point type.
template <class Visit>
auto with_real(int word, Visit visit) {
    return word == 4 ? visit(float{}) : visit(double{});
}

} // namespace

ExodusFile::ExodusFile(ExodusFile&& other) noexcept
    : path_(std::move(other.path_)),
      number_(std::exchange(other.number_, -1)),
      word_(other.word_),
      dimensions_(other.dimensions_),
      points_(other.points_),
      cells_(other.cells_),
      blocks_(std::move(other.blocks_)),
      sets_(std::move(other.sets_)),
      all_blocks_(std::move(other.all_blocks_)),
      point_variables_(std::move(other.point_variables_)),
      cell_variables_(std::move(other.cell_variables_)),
      times_(std::move(other.times_)) {}

ExodusFile::~ExodusFile() {
    if (number_ >= 0) ex_close(number_);
}

ScalarType ExodusFile::type() const noexcept { return word_ == 4 ? ScalarType::float32 : ScalarType::float64; }

Error ExodusFile::failed(std::string_view what) const {
    return {ErrorCode::invalid_data, fmt::format("{}: {} cannot be read from the Exodus file", escaped(path_), what)};
}

Result<ExodusFile> ExodusFile::open(const std::string& path) {
    ex_opts(0); // no messages of its own
    ExodusFile file;
    file.path_ = path;
    float version = 0;
    int wanted_word = 8, stored_word = 0;
    file.number_ = ex_open(path.c_str(), EX_READ, &wanted_word, &stored_word, &version);
    if (file.number_ < 0)
        return Error{ErrorCode::invalid_data, escaped(path) + ": not an Exodus file, or a broken one"};
    if (stored_word == 4) { // numbers come in the type of the file, which must be known when it is opened
        ex_close(file.number_);
        wanted_word = 4;
        file.number_ = ex_open(path.c_str(), EX_READ, &wanted_word, &stored_word, &version);
        if (file.number_ < 0) return Error{ErrorCode::invalid_data, escaped(path) + ": cannot be opened a second time"};
    }
    file.word_ = stored_word == 4 ? 4 : 8;
    ex_set_int64_status(file.number_, EX_ALL_INT64_API);
    if (auto read = file.read_contents(); !read) return read.error();
    return file;
}

Result<void> ExodusFile::read_contents() {
    ex_init_params counts{};
    if (ex_get_init_ext(number_, &counts) < 0) return failed("the list of contents");
    for (const std::int64_t count :
         {counts.num_dim, counts.num_nodes, counts.num_elem, counts.num_elem_blk, counts.num_elem_sets})
        if (count < 0 || static_cast<std::uint64_t>(count) > max_plausible)
            return failed(fmt::format("a count of {}", count));
    if (counts.num_dim < 1 || counts.num_dim > 3) return failed(fmt::format("a grid of {} dimensions", counts.num_dim));
    dimensions_ = static_cast<std::uint64_t>(counts.num_dim);
    points_ = static_cast<std::uint64_t>(counts.num_nodes);
    if (auto read = read_blocks(static_cast<std::size_t>(counts.num_elem_blk)); !read) return read;
    if (auto read = read_sets(static_cast<std::size_t>(counts.num_elem_sets)); !read) return read;

    const std::int64_t steps = ex_inquire_int(number_, EX_INQ_TIME);
    if (steps < 0) return failed("the number of time steps");
    if (steps == 0) return {}; // variables that have never been written
    auto point_variables = variable_names(EX_NODAL);
    if (!point_variables) return point_variables.error();
    auto cell_variables = variable_names(EX_ELEM_BLOCK);
    if (!cell_variables) return cell_variables.error();
    point_variables_ = std::move(*point_variables);
    cell_variables_ = std::move(*cell_variables);
    const bool read = with_real(word_, [&](auto zero) {
        std::vector<decltype(zero)> times(static_cast<std::size_t>(steps));
        const bool worked = ex_get_all_times(number_, times.data()) >= 0;
        times_.assign(times.begin(), times.end());
        return worked;
    });
    if (!read) return failed("the times");
    return {};
}

Result<void> ExodusFile::read_blocks(std::size_t count) {
    if (count == 0) return {};
    const std::int64_t longest = ex_inquire_int(number_, EX_INQ_DB_MAX_ALLOWED_NAME_LENGTH);
    ex_set_max_name_length(number_, static_cast<int>(std::clamp<std::int64_t>(longest, MAX_STR_LENGTH, max_name)));
    std::vector<std::int64_t> ids(count);
    if (ex_get_ids(number_, EX_ELEM_BLOCK, ids.data()) < 0) return failed("the numbers of the element blocks");
    for (const std::int64_t id : ids) {
        ex_block block{};
        block.id = id;
        block.type = EX_ELEM_BLOCK;
        if (ex_get_block_param(number_, &block) < 0) return failed(fmt::format("element block {}", id));
        if (block.num_entry < 0 || block.num_nodes_per_entry < 0 ||
            static_cast<std::uint64_t>(block.num_entry) > max_plausible ||
            static_cast<std::uint64_t>(block.num_nodes_per_entry) > max_plausible)
            return failed(fmt::format("element block {} of {} elements with {} nodes", id, block.num_entry,
                                      block.num_nodes_per_entry));
        Block result;
        result.id = id;
        block.topology[MAX_STR_LENGTH] = '\0';
        result.topology = block.topology;
        std::transform(result.topology.begin(), result.topology.end(), result.topology.begin(),
                       [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
        result.cells = static_cast<std::uint64_t>(block.num_entry);
        const bool ragged = result.topology.starts_with("NFACED") || result.topology.starts_with("NSIDED");
        result.corners = ragged ? 0 : static_cast<std::uint64_t>(block.num_nodes_per_entry);
        if (block.num_faces_per_entry < 0 || static_cast<std::uint64_t>(block.num_faces_per_entry) > max_plausible)
            return failed(fmt::format("element block {} with {} faces", id, block.num_faces_per_entry));
        result.faces = static_cast<std::uint64_t>(block.num_faces_per_entry);
        if (result.corners > 1000)
            return failed(fmt::format("element block {} with {} nodes an element", id, result.corners));
        result.name = name_of(EX_ELEM_BLOCK, id);
        cells_ += result.cells;
        blocks_.push_back(std::move(result));
    }
    return {};
}

/// Empty: it has none.
std::string ExodusFile::name_of(int entity, std::int64_t id) const {
    char name[max_name + 1] = {};
    return ex_get_name(number_, static_cast<ex_entity_type>(entity), id, name) >= 0 ? name : "";
}

Result<void> ExodusFile::read_sets(std::size_t count) {
    std::vector<std::int64_t> ids(count);
    if (count > 0 && ex_get_ids(number_, EX_ELEM_SET, ids.data()) < 0) return failed("the numbers of the element sets");
    for (const std::int64_t id : ids) {
        std::int64_t cells = 0, factors = 0;
        if (ex_get_set_param(number_, EX_ELEM_SET, id, &cells, &factors) < 0)
            return failed(fmt::format("element set {}", id));
        if (cells < 0 || static_cast<std::uint64_t>(cells) > max_plausible)
            return failed(fmt::format("element set {} of {} elements", id, cells));
        std::string name = name_of(EX_ELEM_SET, id);
        sets_.push_back(
            {id, name.empty() ? fmt::format("set {}", id) : std::move(name), static_cast<std::uint64_t>(cells)});
    }
    return {};
}

Result<std::vector<std::int64_t>> ExodusFile::cells_of(const Set& set) const {
    std::vector<std::int64_t> cells(set.cells);
    if (set.cells > 0 && ex_get_set(number_, EX_ELEM_SET, set.id, cells.data(), nullptr) < 0)
        return failed(fmt::format("the elements of set {}", set.id));
    for (std::int64_t& cell : cells) {
        if (cell < 1 || static_cast<std::uint64_t>(cell) > cells_)
            return Error{ErrorCode::invalid_data,
                         fmt::format("{}: element set {} has element {}, but the elements are 1 to {}", escaped(path_),
                                     set.id, cell, cells_)};
        --cell;
    }
    return cells;
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

Result<std::vector<std::string>> ExodusFile::variable_names(int entity) {
    const auto type = static_cast<ex_entity_type>(entity);
    int count = 0;
    if (ex_get_variable_param(number_, type, &count) < 0 || count < 0) return failed("the number of variables");
    const std::int64_t longest = ex_inquire_int(number_, EX_INQ_DB_MAX_ALLOWED_NAME_LENGTH);
    const int length = static_cast<int>(std::clamp<std::int64_t>(longest, MAX_STR_LENGTH, max_name));
    ex_set_max_name_length(number_, length);
    std::vector<std::string> names;
    for (int i = 1; i <= count; ++i) {
        std::vector<char> name(static_cast<std::size_t>(length) + 1, '\0');
        if (ex_get_variable_name(number_, type, i, name.data()) < 0)
            return failed(fmt::format("the name of variable {}", i));
        name.back() = '\0';
        names.emplace_back(name.data());
        while (names.back().ends_with(' ')) names.back().pop_back();
    }
    return names;
}

template <class T>
Result<Array> ExodusFile::read_coordinates() {
    std::vector<T> places(3 * points_, T(0));
    std::vector<T> axis_values(points_);
    for (std::uint64_t axis = 0; axis < dimensions_ && points_ > 0; ++axis) {
        void* axes[3] = {nullptr, nullptr, nullptr};
        axes[axis] = axis_values.data();
        if (ex_get_coord(number_, axes[0], axes[1], axes[2]) < 0) return failed("coordinates");
        for (std::uint64_t i = 0; i < points_; ++i) places[3 * i + axis] = axis_values[i];
    }
    return Array::own(std::move(places), 3);
}

Result<Array> ExodusFile::coordinates() { return word_ == 4 ? read_coordinates<float>() : read_coordinates<double>(); }

Result<std::vector<std::int64_t>> ExodusFile::connectivity(const Block& block) {
    std::vector<std::int64_t> nodes(block.cells * block.corners);
    if (nodes.empty()) return nodes;
    if (ex_get_conn(number_, EX_ELEM_BLOCK, block.id, nodes.data(), nullptr, nullptr) < 0)
        return failed(fmt::format("the nodes of element block {}", block.id));
    return nodes;
}

Result<Array> ExodusFile::point_variable(std::size_t variable, std::size_t step) {
    return with_real(word_, [&](auto zero) -> Result<Array> {
        std::vector<decltype(zero)> values(points_);
        const int status = ex_get_var(number_, static_cast<int>(step) + 1, EX_NODAL, static_cast<int>(variable) + 1, 1,
                                      static_cast<std::int64_t>(points_), values.data());
        if (status != EX_NOERR)
            return failed(fmt::format("nodal variable \"{}\"", escaped(point_variables_[variable])));
        return Array::own(std::move(values));
    });
}

template <class T>
Result<Array> ExodusFile::read_cell_variable(std::size_t variable, std::size_t step, std::size_t& blocks_without) {
    std::vector<T> values(cells_, std::numeric_limits<T>::quiet_NaN());
    std::vector<int> defined(cell_variables_.size());
    std::uint64_t first = 0;
    for (const Block& block : blocks_) {
        if (block.cells == 0) continue;
        if (ex_get_object_truth_vector(number_, EX_ELEM_BLOCK, block.id, static_cast<int>(defined.size()),
                                       defined.data()) < 0)
            return failed("the table of element variables");
        if (defined[variable] == 0) ++blocks_without;
        else if (ex_get_var(number_, static_cast<int>(step) + 1, EX_ELEM_BLOCK, static_cast<int>(variable) + 1,
                            block.id, static_cast<std::int64_t>(block.cells), values.data() + first) != EX_NOERR)
            return failed(fmt::format("element variable \"{}\"", escaped(cell_variables_[variable])));
        first += block.cells;
    }
    return Array::own(std::move(values));
}

Result<Array> ExodusFile::cell_variable(std::size_t variable, std::size_t step, std::size_t& blocks_without) {
    return word_ == 4 ? read_cell_variable<float>(variable, step, blocks_without)
                      : read_cell_variable<double>(variable, step, blocks_without);
}

Result<Array> ExodusFile::id_map(int map, std::uint64_t count) {
    std::vector<std::int64_t> ids(count);
    if (count > 0 && ex_get_id_map(number_, static_cast<ex_entity_type>(map), ids.data()) < 0)
        return failed("a map of global numbers");
    return Array::own(std::move(ids));
}

Result<Array> ExodusFile::point_ids() { return id_map(EX_NODE_MAP, points_); }

Result<Array> ExodusFile::cell_ids() {
    if (all_blocks_.empty()) return id_map(EX_ELEM_MAP, cells_);
    std::uint64_t count = 0;
    for (const auto& [cells, chosen] : all_blocks_) count += cells;
    const auto all = id_map(EX_ELEM_MAP, count);
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
        {"TET", 8, {10, 4}},    {"TET", 11, {24, 10}},  {"TET", 14, {24, 10}},  {"TET", 15, {24, 10}},
        {"HEX", 9, {12, 8}},    {"HEX", 21, {25, 20}},  {"WED", 16, {26, 15}},  {"WED", 20, {26, 15}},
        {"WED", 21, {26, 15}},  {"PRISM", 6, {13, 6}},  {"PRISM", 15, {26, 15}}, {"PRISM", 16, {26, 15}},
        {"PRISM", 18, {32, 18}}, {"PRISM", 20, {26, 15}}, {"PRISM", 21, {26, 15}}, {"PYR", 18, {27, 13}},
        {"PYR", 19, {27, 13}},
    };
    for (const Longer& one : longer)
        if (topology.starts_with(one.begins) && one.nodes == nodes) return one.element;
    return {}; // an empty cell, left out
}

} // namespace isotet::io::confined
