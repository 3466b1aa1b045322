// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_grid.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {
namespace {

using Size = std::array<std::uint64_t, 3>;

Array or_throw(Result<Array> made) {
    if (!made) throw EnsightError(made.error());
    return *std::move(made);
}

/// Of a flat axis one, as the file counts the values of cells.
std::uint64_t cells_along(std::uint64_t points) { return std::max<std::uint64_t>(points - 1, 1); }

void set_block_size(EnsightFile& file, EnsightPart& part, bool is_implied, bool has_range) {
    constexpr std::uint64_t most_implied = std::uint64_t{1} << 48;
    const auto sizes = file.counts(3, 3, "the size of a block");
    std::ranges::copy(sizes, part.size.begin());
    if (has_range) {
        const auto range = file.counts(6, 6, "the range of a block");
        for (std::size_t axis = 0; axis < 3; ++axis)
            part.size[axis] = static_cast<std::uint64_t>(
                std::max(std::int64_t{range[2 * axis + 1]} - range[2 * axis] + 1, std::int64_t{0}));
    }
    const std::uint64_t most = is_implied ? most_implied : file.left();
    part.is_structured = true;
    part.nodes = part.cells = 1;
    for (const std::uint64_t along : part.size) {
        if (along == 0 || part.nodes > most / along)
            file.wrong(fmt::format("a block has {} x {} x {} nodes", part.size[0], part.size[1], part.size[2]));
        part.nodes *= along;
        part.cells *= cells_along(along);
    }
}

void read_uniform_points(EnsightFile& file, EnsightPart& part, const vtk_xml::GridSize& size) {
    const auto origin = file.floats(3, 1, "the origin of a block"), step = file.floats(3, 1, "the spacing of a block");
    if (step.empty()) return;
    vtk_xml::ImagePoints image;
    std::ranges::copy(origin, image.origin.begin());
    for (std::size_t axis = 0; axis < 3; ++axis) image.matrix[4 * axis] = step[axis];
    part.points = or_throw(vtk_xml::points_of(size, image));
}

void read_block_points(EnsightFile& file, EnsightPart& part, const std::string& kind, std::size_t on_line) {
    constexpr const char* what = "the coordinates of a block";
    const vtk_xml::GridSize size{part.size[0], part.size[1], part.size[2]};
    if (has_word(kind, "uniform")) return read_uniform_points(file, part, size);
    if (!has_word(kind, "rectilinear")) {
        part.points = Array::own(file.columns(part.nodes, 3, on_line, what), 3);
        return;
    }
    std::array<std::vector<double>, 3> ticks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto along = file.floats(part.size[axis], on_line, what);
        ticks[axis].assign(along.begin(), along.end());
    }
    if (!ticks[0].empty()) part.points = or_throw(vtk_xml::points_of(size, ticks));
}

/// Leaves out the cells that have a blanked node, which is marked 0.
void blank(EnsightPart& part, const std::vector<std::int32_t>& marks) {
    std::vector<std::uint8_t> blanked(marks.size());
    std::ranges::transform(marks, blanked.begin(), [](std::int32_t mark) { return mark == 0; });
    const auto& [x, y, z] = part.size;
    vtk_xml::leave_out_around({x, y, z}, blanked, part.left_out);
}

} // namespace

EnsightPart& EnsightGrid::add(const EnsightFile& file, std::uint64_t number, std::string name) {
    if (!places_.try_emplace(number, parts.size()).second) file.wrong(fmt::format("part {} is there twice", number));
    EnsightPart& part = parts.emplace_back();
    part.number = number;
    part.name = std::move(name);
    part.file = file.path();
    return part;
}

std::size_t EnsightGrid::find(const EnsightFile& file, std::uint64_t number) const {
    const auto found = places_.find(number);
    if (found == places_.end()) file.wrong(fmt::format("the geometry has no part {}", number));
    return found->second;
}

void EnsightField::put(std::size_t part, std::uint64_t all, const std::vector<EnsightPart::Run>& runs,
                       std::vector<float> values) {
    if (values.empty()) return;
    const std::size_t count = variable.components;
    std::vector<float>& to = columns[part];
    if (width == count && count != 6 && values.size() == all * width) {
        to = std::move(values);
        return;
    }
    to.resize(all * width, std::numeric_limits<float>::quiet_NaN());
    const float* from = values.data();
    for (const auto& [first, cells] : runs)
        for (std::uint64_t i = first; i < first + cells; ++i)
            for (std::size_t c = 0; c < count; ++c) { // VTK has the last two of XX YY ZZ XY XZ YZ the other way
                const std::size_t place = count == 6 && c > 3 ? 9 - c : c;
                to[i * width + column + place] = *from++;
            }
}

const std::vector<EnsightPart::Run>& EnsightBlocks::take(std::string_view type) {
    const auto found = part_.elements.find(type);
    if (found == part_.elements.end())
        file_.wrong(fmt::format("part {} has no elements {}", part_.number, in_quotes(type)));
    if (!taken_.emplace(type).second)
        file_.wrong(fmt::format("the values of \"{}\" of part {} are there twice", type, part_.number));
    return found->second;
}

void EnsightBlocks::expect_all() const {
    for (const auto& [type, runs] : part_.elements)
        if (count_of(runs) > 0 && !type.starts_with("g_") && !taken_.contains(type))
            file_.wrong(fmt::format("part {} has {} elements \"{}\", but there are no values of them", part_.number,
                                    count_of(runs), type));
}

std::uint64_t count_of(const std::vector<EnsightPart::Run>& runs) {
    std::uint64_t count = 0;
    for (const auto& run : runs) count += run.count;
    return count;
}

bool is_at_part(EnsightFile& file) { return !file.has_more() || file.is_at("part"); }

bool has_word(std::string_view line, std::string_view word) {
    const auto words = words_of(line);
    return std::ranges::find(words, word) != words.end();
}

void read_block(EnsightFile& file, EnsightPart& part, const std::string& kind, std::size_t on_line) {
    set_block_size(file, part, has_word(kind, "uniform") || has_word(kind, "rectilinear"), has_word(kind, "range"));
    read_block_points(file, part, kind, on_line);
    if (has_word(kind, "iblanked")) blank(part, file.integers(part.nodes, on_line, "the blanking of a block"));
    if (has_word(kind, "with_ghost")) {
        if (file.is_at("ghost_flags")) file.line("ghost_flags");
        const auto flags = file.integers(part.cells, on_line, "the ghost flags of a block");
        part.left_out.resize(flags.size());
        for (std::size_t i = 0; i < flags.size(); ++i)
            if (flags[i] != 0) part.left_out[i] = 1;
    }
    for (const auto& [name, count] : {std::pair("node_ids", part.nodes), std::pair("element_ids", part.cells)}) {
        if (!file.is_at(name)) continue;
        file.line(name);
        file.integers(count, on_line, name);
    }
}

} // namespace isotet::io::confined
