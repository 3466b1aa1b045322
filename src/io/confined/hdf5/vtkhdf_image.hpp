// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/confined/hdf5/vtkhdf_steps.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {

/// An image in a group of a file, as hexahedra.
class HdfImage {
public:
    /// `root`   the group: "/VTKHDF"
    /// Errors   as load_vtkhdf_image()
    static Result<HdfImage> open(const std::string& path, const std::string& root);

    /// Adds fields, and the times where there are none yet.
    void announce(FileInfo& info) const;
    std::uint64_t cells() const;
    /// Adds a piece of this name at Loaded::step. A field that cannot be read is left out.
    Result<void> load(const ReadOptions& options, const std::string& name, Loaded& loaded) const;

private:
    HdfImage(std::string path, std::string root) : path_(std::move(path)), root_(std::move(root)) {}

    std::string group(Association association) const {
        return root_ + (association == Association::point ? "/PointData" : "/CellData");
    }
    Result<Array> read_field(Association association, const std::string& name, std::size_t step, Depth depth) const;
    Result<void> load_fields(Association association, const ReadOptions& options, Loaded& loaded, Piece& piece) const;

    std::string path_, root_;
    vtk_xml::GridSize size_;
    vtk_xml::ImagePoints points_;
    HdfSteps steps_;
};

/// A VTKHDF file of type ImageData, as hexahedra. Data sets of fields have the axes z, y, x, before them the step where there
/// are several, behind them the components.
///
/// Errors   invalid_data: no box, no origin, spacing or direction of three, three and nine numbers
Result<Loaded> load_vtkhdf_image(const std::string& path, const ReadOptions& options, Depth depth);

} // namespace isotet::io::confined
