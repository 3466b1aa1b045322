// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/vtkhdf_structured.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/vtk_xml/columns.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {
namespace {

constexpr double max_points_along = 1 << 30;

} // namespace

Result<HdfStructured> HdfStructured::open(const std::string& path, const std::string& root) {
    HdfStructured grid(path, root);
    grid.type_ = text_attribute(path, root, "Type");
    if (auto opened = grid.type_ == "ImageData" ? grid.open_image() : grid.open_box(); !opened) return opened.error();
    grid.steps_ = steps_of(path, root);
    return grid;
}

Result<void> HdfStructured::open_image() {
    const auto extent = numbers_attribute(path_, root_, "WholeExtent");
    const auto origin = numbers_attribute(path_, root_, "Origin"), spacing = numbers_attribute(path_, root_, "Spacing");
    auto direction = numbers_attribute(path_, root_, "Direction");
    if (direction.empty()) direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (extent.size() != 6 || origin.size() != 3 || spacing.size() != 3 || direction.size() != 9)
        return broken(path_,
                      fmt::format("an image needs attributes WholeExtent, Origin, Spacing and Direction of 6, 3, "
                                  "3 and 9 numbers, but has {}, {}, {} and {}",
                                  extent.size(), origin.size(), spacing.size(), direction.size()));
    std::array<std::uint64_t, 3> along{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double first = extent[2 * axis], last = extent[2 * axis + 1];
        if (!(std::abs(first) <= max_points_along && std::abs(last) <= max_points_along))
            return broken(path_, fmt::format("the image goes from {} to {}", first, last));
        along[axis] = last < first ? 0 : static_cast<std::uint64_t>(last - first) + 1;
        image_.first[axis] = static_cast<std::int64_t>(first);
        image_.origin[axis] = origin[axis];
        for (std::size_t row = 0; row < 3; ++row)
            image_.matrix[3 * row + axis] = direction[3 * row + axis] * spacing[axis];
    }
    size_ = {along[0], along[1], along[2]};
    return {};
}

Result<void> HdfStructured::open_box() {
    const auto points = numbers_attribute(path_, root_, "Dimensions");
    if (points.size() != 3)
        return broken(path_,
                      fmt::format("a {} needs an attribute Dimensions of 3 numbers, but has {}", type_, points.size()));
    for (const double along : points)
        if (!(along >= 0 && along <= max_points_along))
            return broken(path_, fmt::format("its Dimensions hold {}", along));
    size_ = {static_cast<std::uint64_t>(points[0]), static_cast<std::uint64_t>(points[1]),
             static_cast<std::uint64_t>(points[2])};
    return {};
}

/// What an array of group Steps names for a step; nothing: there is no such array.
std::optional<std::uint64_t> HdfStructured::offset_of(const std::string& array, std::size_t step) const {
    if (steps_.times.empty()) return std::nullopt;
    const auto all = read_hdf5_array(path_, root_ + "/Steps/" + array, {}, Depth::arrays);
    if (!all || step >= all->values.size() || !(all->values.at(step) >= 0)) return std::nullopt;
    return static_cast<std::uint64_t>(all->values.at(step));
}

/// The coordinates along each axis; those of all steps are one behind the other.
Result<std::array<std::vector<double>, 3>> HdfStructured::read_ticks(std::size_t step) const {
    std::array<std::vector<double>, 3> ticks;
    const std::array along{size_.x, size_.y, size_.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name = std::string(1, "XYZ"[axis]) + "Coordinates";
        const Box box{{offset_of(name + "Offsets", step).value_or(0)}, {1}, {along[axis]}};
        const auto read = read_hdf5_array(path_, root_ + "/" + name, box, Depth::arrays);
        if (!read) return read.error();
        for (std::size_t i = 0; i < read->values.size(); ++i) ticks[axis].push_back(read->values.at(i));
    }
    return ticks;
}

/// Points have the axes z, y, x and three coordinates, before them the step where they change.
Result<Array> HdfStructured::read_points(std::size_t step) const {
    if (type_ == "ImageData") return vtk_xml::points_of(size_, image_);
    if (type_ == "RectilinearGrid") {
        const auto ticks = read_ticks(step);
        return ticks ? vtk_xml::points_of(size_, *ticks) : ticks.error();
    }
    const std::string name = root_ + "/Points";
    const auto described = read_hdf5_array(path_, name, {}, Depth::description);
    if (!described) return described.error();
    const std::vector<std::uint64_t>& shape = described->dimensions;
    std::vector<std::uint64_t> expected{size_.z, size_.y, size_.x, 3};
    const bool of_steps = shape.size() == expected.size() + 1;
    const std::uint64_t row = of_steps ? offset_of("PointsOffsets", step).value_or(step) : 0;
    if (of_steps) expected.insert(expected.begin(), shape[0]);
    if (shape != expected || (of_steps && row >= shape[0]))
        return broken(path_,
                      fmt::format("Points are not those of a grid of {} x {} x {} points", size_.x, size_.y, size_.z));
    Box box{std::vector<std::uint64_t>(shape.size(), 0), std::vector<std::uint64_t>(shape.size(), 1), shape};
    if (of_steps) {
        box.start[0] = row;
        box.count[0] = 1;
    }
    auto read = read_hdf5_array(path_, name, box, Depth::arrays);
    if (!read) return read.error();
    const Array& all = read->values;
    return as_coordinates(Array(all.type(), all.data(), all.size() / 3, 3, all.owner().lock()));
}

/// A tuple of the field for each point or cell of a step; for a description empty, with the field's type and components.
Result<Array> HdfStructured::read_field(Association association, const std::string& name, std::size_t step,
                                        Depth depth) const {
    const auto along = [&](std::uint64_t points) {
        return association == Association::cell && points > 1 ? points - 1 : points;
    };
    std::vector<std::uint64_t> expected{along(size_.z), along(size_.y), along(size_.x)};
    const std::string full = group(association) + "/" + name;
    const auto described = read_hdf5_array(path_, full, {}, Depth::description);
    if (!described) return described.error();
    const auto& shape = described->dimensions;
    const auto offset =
        offset_of((association == Association::point ? "PointDataOffsets/" : "CellDataOffsets/") + name, step);
    const std::uint64_t row = offset.value_or(step);
    if (!steps_.times.empty())
        expected.insert(expected.begin(), offset && !shape.empty() && row < shape[0] ? shape[0] : steps_.times.size());
    std::size_t components = 1;
    if (shape.size() == expected.size() + 1 && shape.back() > 0) {
        components = static_cast<std::size_t>(shape.back());
        expected.push_back(shape.back());
    }
    if (shape != expected)
        return Error{ErrorCode::invalid_data, fmt::format("its shape is not that of the grid's {}",
                                                          association == Association::point ? "points" : "cells")};
    if (depth == Depth::description) return Array(described->values.type(), nullptr, 0, components, nullptr);
    if (!is_written(path_, full)) return Error{ErrorCode::invalid_data, "it has values that were never written"};
    Box box{std::vector<std::uint64_t>(shape.size(), 0), std::vector<std::uint64_t>(shape.size(), 1), shape};
    if (!steps_.times.empty()) {
        box.start[0] = row;
        box.count[0] = 1;
    }
    auto read = read_hdf5_array(path_, full, box, Depth::arrays);
    if (!read) return read.error();
    const Array& all = read->values;
    return Array(all.type(), all.data(), all.size() / components, components, all.owner().lock());
}

void HdfStructured::announce(FileInfo& info) const {
    if (steps_.missing) leave_out(info, *steps_.missing);
    if (info.times.empty()) info.times = steps_.times;
    for (const Association association : {Association::point, Association::cell})
        for (const std::string& name : data_sets_of(path_, group(association))) {
            if (vtk_xml::is_ghost_array(name) || (association == Association::cell && cells() == 0)) continue;
            const auto field = read_field(association, name, 0, Depth::description);
            if (field) io::announce(info, {name, association, field->type(), field->components()});
            else leave_out(info, {kind_of_field(association), name, field.error().message});
        }
}

Result<void> HdfStructured::load_fields(Association association, const ReadOptions& options, Loaded& loaded,
                                        Piece& piece) const {
    const bool of_points = association == Association::point;
    auto& fields = of_points ? piece.grid.point_fields : piece.grid.cell_fields;
    for (const std::string& name : data_sets_of(path_, group(association))) {
        const bool is_ghost = vtk_xml::is_ghost_array(name);
        if (!is_ghost && !wanted(options, association, name)) continue;
        auto values = read_field(association, name, loaded.step, Depth::arrays);
        if (!values) leave_out(loaded.info, {kind_of_field(association), name, values.error().message});
        else if (is_ghost && of_points) vtk_xml::mark_around_hidden(*values, name, size_, piece.left_out);
        else if (is_ghost) vtk_xml::mark_left_out(*values, name, piece.left_out);
        else fields.push_back({name, *std::move(values)});
    }
    return {};
}

std::uint64_t HdfStructured::cells() const { return vtk_xml::cells_in_box(size_); }

Result<void> HdfStructured::load(const ReadOptions& options, const std::string& name, Loaded& loaded) const {
    Piece piece;
    piece.name = name;
    auto points = read_points(loaded.step);
    if (!points) return points.error();
    piece.grid.points = *std::move(points);
    auto cells = vtk_xml::cells_of_box(size_, loaded.notes);
    if (!cells) return cells.error();
    piece.grid.cells = *std::move(cells);
    piece.flat = vtk_xml::flatness(size_);
    if (auto done = load_fields(Association::point, options, loaded, piece); !done) return done;
    if (this->cells() > 0)
        if (auto done = load_fields(Association::cell, options, loaded, piece); !done) return done;
    loaded.pieces.push_back(std::move(piece));
    return {};
}

Result<Loaded> load_vtkhdf_structured(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto grid = HdfStructured::open(path, "/VTKHDF");
    if (!grid) return grid.error();
    Loaded loaded;
    grid->announce(loaded.info);
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    if (depth == Depth::description) return loaded;
    if (auto done = grid->load(options, "", loaded); !done) return done.error();
    return loaded;
}

} // namespace isotet::io::confined
