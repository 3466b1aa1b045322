// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/vtkhdf_amr.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/amr/boxes_as_pieces.hpp"
#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/confined/hdf5/hdf5_rows.hpp"
#include "io/confined/hdf5/vtkhdf_steps.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_xml/columns.hpp"

namespace isotet::io::confined {
namespace {

const char* data_of(Association association) { return association == Association::point ? "PointData" : "CellData"; }

std::string level_name(std::size_t level) { return fmt::format("Level{}", level); }

/// Some tuples of an array, which keep it alive.
Array tuples_of(const Array& values, std::size_t first, std::size_t count) {
    const auto* const bytes = static_cast<const std::byte*>(values.data());
    return Array(values.type(), bytes + first * values.components() * size_of(values.type()), count,
                 values.components(), values.owner().lock());
}

class HdfAmr {
public:
    HdfAmr(const std::string& path, const Hdf5Rows& rows)
        : path_(path), rows_(rows), steps_(steps_of(path, "/VTKHDF")) {}

    Result<void> announce_all(FileInfo& info);
    Result<void> load(const ReadOptions& options, Loaded& loaded) const;

private:
    std::string group(std::size_t level) const { return "/VTKHDF/" + level_name(level); }
    bool has_steps() const { return !steps_.times.empty(); }
    Result<std::uint64_t> number(const std::string& name, std::uint64_t place) const;
    Result<std::uint64_t> place_of_step(std::size_t level, const std::string& name, std::size_t step) const;
    Result<amr::Level> read_level(std::size_t level, std::size_t step) const;
    Result<void> load_fields(std::size_t level, const amr::Level& boxes, Association association,
                             const ReadOptions& options, std::span<Piece> pieces, Loaded& loaded) const;

    const std::string& path_;
    const Hdf5Rows& rows_;
    HdfSteps steps_;
    std::size_t levels_ = 0;
};

Result<void> HdfAmr::announce_all(FileInfo& info) {
    const std::string axes = text_attribute(path_, "/VTKHDF", "GridDescription");
    if (!axes.empty() && axes != "XYZ")
        return broken(path_, fmt::format("its boxes are {}, but must be of three dimensions: GridDescription XYZ",
                                         in_quotes(axes)));
    while (rows_.shape(group(levels_) + "/AMRBox")) ++levels_;
    if (levels_ == 0) return broken(path_, "\"Level0/AMRBox\" is not there, or holds no numbers");
    for (std::size_t level = 0; level < levels_; ++level)
        for (const auto association : {Association::point, Association::cell})
            for (const std::string& name : data_sets_of(path_, group(level) + "/" + data_of(association))) {
                const auto shape = rows_.shape(group(level) + "/" + data_of(association) + "/" + name);
                if (vtk_xml::is_ghost_array(name)) continue;
                if (shape && !shape->is_single) announce(info, {name, association, shape->type, shape->columns});
                else leave_out(info, {kind_of_field(association), name, no_table_of_numbers});
            }
    amr::announce_point_values(info);
    if (steps_.missing) leave_out(info, *steps_.missing);
    info.times = steps_.times;
    return {};
}

Result<std::uint64_t> HdfAmr::number(const std::string& name, std::uint64_t place) const {
    const auto values = rows_.read(name, place, 1);
    if (!values) return values.error();
    const double value = values->at(0);
    if (is_floating(values->type()) || value < 0 || value > 0x1p52)
        return broken(path_, fmt::format("\"{}\" has {} at place {}, which is no count", name, value, place));
    return static_cast<std::uint64_t>(value);
}

/// Where the rows of a step begin.
Result<std::uint64_t> HdfAmr::place_of_step(std::size_t level, const std::string& name, std::size_t step) const {
    const std::string full = fmt::format("/VTKHDF/Steps/{}/{}", level_name(level), name);
    if (!has_steps() || !rows_.shape(full)) return std::uint64_t{0};
    return number(full, step);
}

Result<amr::Level> HdfAmr::read_level(std::size_t level, std::size_t step) const {
    amr::Level out;
    const auto spacing = numbers_attribute(path_, group(level), "Spacing");
    if (spacing.size() != 3)
        return broken(path_, fmt::format("\"{}\" has an attribute Spacing of {} numbers, not 3", level_name(level),
                                         spacing.size()));
    std::copy_n(spacing.begin(), 3, out.spacing.begin());
    const std::string name = group(level) + "/AMRBox";
    const auto shape = rows_.shape(name);
    if (!shape || shape->columns != 6 || is_floating(shape->type))
        return broken(path_, fmt::format("\"{}/AMRBox\" does not hold rows of 6 integers", level_name(level)));
    const auto first = place_of_step(level, "AMRBoxOffsets", step);
    if (!first) return first.error();
    std::uint64_t count = shape->rows;
    if (has_steps()) {
        const auto of_step = number(fmt::format("/VTKHDF/Steps/{}/NumberOfAMRBoxes", level_name(level)), step);
        if (!of_step) return of_step.error();
        count = *of_step;
    }
    const auto boxes = rows_.read(name, *first, count);
    if (!boxes) return boxes.error();
    for (std::size_t box = 0; box < count; ++box) {
        amr::CellBox& to = out.boxes.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            to.first[axis] = static_cast<std::int64_t>(boxes->at(box, 2 * axis));
            to.last[axis] = static_cast<std::int64_t>(boxes->at(box, 2 * axis + 1));
        }
    }
    return out;
}

Result<void> HdfAmr::load_fields(std::size_t level, const amr::Level& boxes, Association association,
                                 const ReadOptions& options, std::span<Piece> pieces, Loaded& loaded) const {
    const bool of_points = association == Association::point;
    const auto tuples = [&](const amr::CellBox& box) { return of_points ? box.points() : box.cells(); };
    std::uint64_t rows = 0;
    for (const amr::CellBox& box : boxes.boxes) rows += tuples(box); // the lattice bounds them
    for (const std::string& name : data_sets_of(path_, group(level) + "/" + data_of(association))) {
        const bool ghost = vtk_xml::is_ghost_array(name);
        if (!ghost && !wanted(options, association, name)) continue;
        const std::string full = fmt::format("{}/{}/{}", group(level), data_of(association), name);
        if (const auto shape = rows_.shape(full); !shape || shape->is_single) continue;
        const auto first = place_of_step(level, fmt::format("{}Offsets/{}", data_of(association), name), loaded.step);
        if (!first) return first.error();
        auto values = rows_.read(full, *first, rows);
        if (!values && (ghost || values.error().code != ErrorCode::invalid_data)) return values.error();
        if (!values) {
            leave_out(loaded.info, {kind_of_field(association), name, values.error().message});
            continue;
        }
        std::uint64_t place = 0;
        for (std::size_t box = 0; box < pieces.size(); ++box) {
            const amr::CellBox& cells = boxes.boxes[box];
            const Array part = tuples_of(*values, place, tuples(cells));
            place += part.tuples();
            if (ghost && of_points)
                vtk_xml::mark_around_hidden(part, name, {cells.cells(0) + 1, cells.cells(1) + 1, cells.cells(2) + 1},
                                            pieces[box].left_out);
            else if (ghost) vtk_xml::mark_left_out(part, name, pieces[box].left_out);
            else (of_points ? pieces[box].grid.point_fields : pieces[box].grid.cell_fields).push_back({name, part});
        }
    }
    return {};
}

Result<void> HdfAmr::load(const ReadOptions& options, Loaded& loaded) const {
    amr::Hierarchy hierarchy;
    const auto origin = numbers_attribute(path_, "/VTKHDF", "Origin");
    if (origin.size() != 3)
        return broken(path_, fmt::format("it has an attribute Origin of {} numbers, not 3", origin.size()));
    std::copy_n(origin.begin(), 3, hierarchy.origin.begin());
    for (std::size_t level = 0; level < levels_; ++level) {
        auto boxes = read_level(level, loaded.step);
        if (!boxes) return boxes.error();
        for (std::size_t box = 0; box < boxes->boxes.size(); ++box)
            loaded.pieces.emplace_back().name = fmt::format("level {}, box {}", level, box);
        hierarchy.levels.push_back(*std::move(boxes));
    }
    if (const auto sound = amr::Lattice::make(hierarchy); !sound) return in_file(path_, sound.error());
    std::size_t first = 0;
    for (std::size_t level = 0; level < levels_; ++level) {
        const auto pieces = std::span(loaded.pieces).subspan(first, hierarchy.levels[level].boxes.size());
        first += pieces.size();
        if (pieces.empty()) continue;
        for (const auto association : {Association::point, Association::cell})
            if (auto done = load_fields(level, hierarchy.levels[level], association, amr::options_of_boxes(options),
                                        pieces, loaded);
                !done)
                return done;
    }
    if (auto done = amr::boxes_as_pieces(hierarchy, options, loaded, {}); !done) return in_file(path_, done.error());
    return {};
}

} // namespace

Result<Loaded> load_vtkhdf_amr(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    HdfAmr file(path, *rows);
    Loaded loaded;
    if (auto done = file.announce_all(loaded.info); !done) return done.error();
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    if (depth == Depth::description) return loaded;
    if (auto done = file.load(options, loaded); !done) return done.error();
    return loaded;
}

} // namespace isotet::io::confined
