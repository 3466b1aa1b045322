// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/confined/hdf5/vtkhdf_steps.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {

/// The kinds of grids that it reads.
inline bool is_structured_kind(std::string_view type) {
    return type == "ImageData" || type == "RectilinearGrid" || type == "StructuredGrid";
}

/// An image, a rectilinear or a structured grid in a group of a file, as hexahedra.
class HdfStructured {
public:
    /// `root`   the group: "/VTKHDF"
    /// Errors   as load_vtkhdf_structured()
    static Result<HdfStructured> open(const std::string& path, const std::string& root);

    /// Adds fields, and the times where there are none yet.
    void announce(FileInfo& info) const;
    std::uint64_t cells() const;
    /// Adds a piece of this name at Loaded::step. A field that cannot be read is left out.
    Result<void> load(const ReadOptions& options, const std::string& name, Loaded& loaded) const;

private:
    HdfStructured(std::string path, std::string root) : path_(std::move(path)), root_(std::move(root)) {}

    std::string group(Association association) const {
        return root_ + (association == Association::point ? "/PointData" : "/CellData");
    }
    Result<void> open_image();
    Result<void> open_box();
    std::optional<std::uint64_t> offset_of(const std::string& array, std::size_t step) const;
    Result<std::array<std::vector<double>, 3>> read_ticks(std::size_t step) const;
    Result<Array> read_points(std::size_t step) const;
    Result<Array> read_field(Association association, const std::string& name, std::size_t step, Depth depth) const;
    Result<void> load_fields(Association association, const ReadOptions& options, Loaded& loaded, Piece& piece) const;

    std::string path_, root_, type_;
    vtk_xml::GridSize size_;
    vtk_xml::ImagePoints image_;
    HdfSteps steps_;
};

/// A VTKHDF file of such a type. Data sets of fields have the axes z, y, x, before them the step where there are several, or
/// the place that Steps names for it, behind them the components.
///
/// Errors   invalid_data: no box, no origin, spacing or direction of three, three and nine numbers, points that are missing or
///          of another shape
Result<Loaded> load_vtkhdf_structured(const std::string& path, const ReadOptions& options, Depth depth);

} // namespace isotet::io::confined
