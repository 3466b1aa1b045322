// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/vtkhdf_image.hpp"

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
Result<HdfImage> HdfImage::open(const std::string& path, const std::string& root) {
    HdfImage image(path, root);
    const auto extent = numbers_attribute(path, root, "WholeExtent");
    const auto origin = numbers_attribute(path, root, "Origin"), spacing = numbers_attribute(path, root, "Spacing");
    auto direction = numbers_attribute(path, root, "Direction");
    if (direction.empty()) direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (extent.size() != 6 || origin.size() != 3 || spacing.size() != 3 || direction.size() != 9)
        return broken(path, fmt::format("an image needs attributes WholeExtent, Origin, Spacing and Direction of 6, 3, "
                                        "3 and 9 numbers, but has {}, {}, {} and {}",
                                        extent.size(), origin.size(), spacing.size(), direction.size()));
    std::array<std::uint64_t, 3> along{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        constexpr double most = 1 << 30;
        const double first = extent[2 * axis], last = extent[2 * axis + 1];
        if (!(std::abs(first) <= most && std::abs(last) <= most))
            return broken(path, fmt::format("the image goes from {} to {}", first, last));
        along[axis] = last < first ? 0 : static_cast<std::uint64_t>(last - first) + 1;
        image.points_.first[axis] = static_cast<std::int64_t>(first);
        image.points_.origin[axis] = origin[axis];
        for (std::size_t row = 0; row < 3; ++row)
            image.points_.matrix[3 * row + axis] = direction[3 * row + axis] * spacing[axis];
    }
    image.size_ = {along[0], along[1], along[2]};
    image.steps_ = steps_of(path, root);
    return image;
}

/// A tuple of the field for each point or cell of a step; for a description empty, with the field's type and components.
Result<Array> HdfImage::read_field(Association association, const std::string& name, std::size_t step,
                                   Depth depth) const {
    const auto along = [&](std::uint64_t points) {
        return association == Association::cell && points > 1 ? points - 1 : points;
    };
    std::vector<std::uint64_t> expected{along(size_.z), along(size_.y), along(size_.x)};
    if (!steps_.times.empty()) expected.insert(expected.begin(), steps_.times.size());
    const std::string full = group(association) + "/" + name;
    const auto described = read_hdf5_array(path_, full, {}, Depth::description);
    if (!described) return described.error();
    const auto& shape = described->dimensions;
    std::size_t components = 1;
    if (shape.size() == expected.size() + 1 && shape.back() > 0) {
        components = static_cast<std::size_t>(shape.back());
        expected.push_back(shape.back());
    }
    if (shape != expected)
        return Error{ErrorCode::invalid_data, fmt::format("its shape is not that of the image's {}",
                                                          association == Association::point ? "points" : "cells")};
    if (depth == Depth::description) return Array(described->values.type(), nullptr, 0, components, nullptr);
    if (!is_written(path_, full)) return Error{ErrorCode::invalid_data, "it has values that were never written"};
    Box box{std::vector<std::uint64_t>(shape.size(), 0), std::vector<std::uint64_t>(shape.size(), 1), shape};
    if (!steps_.times.empty()) {
        box.start[0] = step;
        box.count[0] = 1;
    }
    auto read = read_hdf5_array(path_, full, box, Depth::arrays);
    if (!read) return read.error();
    const Array& all = read->values;
    return Array(all.type(), all.data(), all.size() / components, components, all.owner().lock());
}

void HdfImage::announce(FileInfo& info) const {
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

Result<void> HdfImage::load_fields(Association association, const ReadOptions& options, Loaded& loaded,
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

std::uint64_t HdfImage::cells() const { return vtk_xml::cells_in_box(size_); }

Result<void> HdfImage::load(const ReadOptions& options, const std::string& name, Loaded& loaded) const {
    Piece piece;
    piece.name = name;
    auto points = vtk_xml::points_of(size_, points_);
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

Result<Loaded> load_vtkhdf_image(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto image = HdfImage::open(path, "/VTKHDF");
    if (!image) return image.error();
    Loaded loaded;
    image->announce(loaded.info);
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    if (depth == Depth::description) return loaded;
    if (auto done = image->load(options, "", loaded); !done) return done.error();
    return loaded;
}

} // namespace isotet::io::confined
