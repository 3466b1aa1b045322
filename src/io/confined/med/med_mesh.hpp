// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A mesh of a MED file: points, cells, families and groups.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "grid/patches.hpp"
#include "io/confined/med/med_elements.hpp"
#include "io/confined/med/med_file.hpp"

namespace isotet::io::confined {

/// Cells of one type, one after another in the grid.
struct MedCellRun {
    const MedElement* element = nullptr;
    std::string group; ///< where they are in the file
    std::uint64_t first = 0, count = 0;
};

/// Where the parts of a mesh are at one of its steps.
struct MedMeshPlace {
    std::string coordinates; ///< a data set
    std::string elements;    ///< a group
    std::uint64_t points = 0;
    std::vector<MedCellRun> runs;
    std::uint64_t cells = 0;
};

/// Those with a volume, unless no mesh of the file has any.
MedCells cells_to_read(const MedFile& file);

class MedMesh {
public:
    /// Looks at the groups of a mesh, not at its numbers.
    MedMesh(const MedFile& file, const std::string& name, MedCells kind);

    const std::string& name() const { return name_; }
    /// Why it cannot be read; empty where it can.
    const std::string& problem() const { return problem_; }
    const std::vector<MedStep>& steps() const { return steps_; }

    /// What holds at a step of the mesh; where it states no coordinates or cells, those of the step before it.
    ///
    /// Errors   invalid_data: counts that do not fit together
    Result<MedMeshPlace> place_at(std::int64_t number, std::int64_t iteration) const;

    /// Coordinates as float64.
    Result<Array> points(const MedMeshPlace& place) const;

    /// Nodes in VTK's order.
    ///
    /// Errors   invalid_data: nodes that are not there; as write_out_faces()
    Result<Cells> cells(const MedMeshPlace& place) const;

    /// Nodes of a run in MED's order, from 0, those of a cell one after another.
    ///
    /// Errors   invalid_data: nodes that are not there
    Result<std::vector<std::int64_t>> nodes_of(const MedCellRun& run, std::uint64_t points) const;

    /// Faces that are in groups, each by the first one. Their numbers are those of `groups`.
    ///
    /// Errors   invalid_data: nodes that are not there
    Result<void> add_patches(const MedMeshPlace& place, core::PatchList& numbers, core::PatchList& list) const;

    bool has_families(const MedMeshPlace& place) const;
    /// A number for each cell; 0 in runs without any.
    Result<std::vector<std::int64_t>> families(const MedMeshPlace& place) const;

    /// Families of cells by number, and the groups that each is in.
    std::map<std::int64_t, std::vector<std::string>> groups_of_families() const;

private:
    Result<MedCellRun> run_of(const MedElement& element, const std::string& group) const;
    /// Of cells of a type that has a number of nodes, from 0 and in VTK's order.
    template <class Index>
    Result<void> read_corners(const MedCellRun& run, std::uint64_t points, Index* to) const;
    template <class Index>
    Result<Array> connectivity(const MedMeshPlace& place) const;
    Result<void> add_faces(const std::string& group, std::uint32_t nodes, std::uint64_t points,
                           const std::map<std::int64_t, std::vector<std::string>>& groups, core::PatchList& numbers,
                           core::PatchList& list) const;
    Result<void> add_polyhedra(const MedMeshPlace& place, Cells& cells) const;
    Result<std::vector<std::int64_t>> polygon_nodes(const MedCellRun& run, std::uint64_t points) const;
    Result<void> add_polygon_offsets(const MedCellRun& run, std::vector<std::int64_t>& offsets) const;

    const MedFile& file_;
    std::string name_, problem_;
    MedCells kind_;
    std::uint64_t axes_ = 3;
    std::vector<MedStep> steps_;
};

} // namespace isotet::io::confined
