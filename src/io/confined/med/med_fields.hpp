// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields of a MED file: at nodes, in cells, at the nodes of each cell, at integration points; of all or by profiles.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/confined/med/med_file.hpp"
#include "io/confined/med/med_mesh.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {

class MedFields {
public:
    MedFields(const MedFile& file, MedCells kind);

    /// Of all fields, ascending; those of fields that hold always aside.
    const std::vector<MedStep>& steps() const { return steps_; }
    /// Whether some field belongs to the mesh.
    bool belong_to(const std::string& mesh) const;

    /// Adds the fields that can be read to the description, of one step or of all, and what is left out.
    void announce_all(FileInfo& info, std::optional<std::size_t> only) const;

    /// The step of a mesh that its fields name at this step of the file.
    MedStep step_of_mesh(const std::string& mesh, std::size_t step) const;

    /// Adds the fields of a mesh. One that is broken is left out.
    ///
    /// Errors   out_of_memory
    Result<void> read(const ReadOptions& options, std::size_t step, const MedMesh& mesh, const MedMeshPlace& place,
                      Grid& grid, Loaded& loaded) const;

private:
    /// Of a field of the file: all components, or those that are one (fields_of_components()).
    struct MedField {
        std::string name, mesh;
        std::string array;                   ///< as the file calls it
        std::size_t components = 0;          ///< those that are read
        std::size_t first = 0, in_array = 0; ///< which of how many
        ScalarType type = ScalarType::float64;
        bool swaps_last = false; ///< of a symmetric tensor that ends in XY XZ YZ: VTK has XY YZ XZ
        std::vector<MedStep> steps;
        bool at_nodes = false, in_cells = false, at_cell_nodes = false, on_others = false; ///< at any step

        /// Of a component of the file in the grid.
        std::size_t place_of(std::size_t component) const {
            return swaps_last && component > 3 ? 9 - component : component;
        }
    };
    /// The values of one kind of cells, or of nodes, that one profile chooses.
    struct MedPart {
        Array values; ///< of the file: for each component, for each entity, for each of its points
        std::uint64_t per_entity = 1;
        std::optional<std::vector<std::uint64_t>> chosen; ///< nothing: all
        std::uint64_t first = 0, count = 0;               ///< entities of this kind in the grid
        const MedCellRun* run = nullptr;

        std::uint64_t entities() const { return chosen ? chosen->size() : count; } ///< that have values
        std::uint64_t entity(std::uint64_t i) const { return chosen ? (*chosen)[i] : i; }
    };

    std::vector<MedField> describe(const std::string& name) const;
    const MedStep* step_of(const MedField& field, std::size_t step) const;
    Result<std::vector<MedPart>> parts_of(const MedField& field, const std::string& group, std::uint64_t first,
                                          std::uint64_t count) const;
    Result<std::vector<std::uint64_t>> read_profile(const std::string& name, std::uint64_t count) const;
    Result<std::vector<MedPart>> parts_in_cells(const MedField& field, const MedStep& step, const MedMeshPlace& place,
                                                const char* kind) const;
    Result<Array> at_nodes(const MedField& field, const MedStep& step, const MedMesh& mesh, const MedMeshPlace& place,
                           std::vector<std::string>& notes) const;
    Result<Array> at_cell_nodes(const MedField& field, const std::vector<MedPart>& parts, const MedMesh& mesh,
                                const MedMeshPlace& place, std::vector<std::string>& notes) const;
    Result<Array> in_cells(const MedField& field, const MedStep& step, const MedMeshPlace& place,
                           std::vector<std::string>& notes) const;
    template <class T>
    static void put(const MedField& field, const MedPart& part, std::vector<T>& values);
    static Array joined(const MedField& field, const std::vector<MedPart>& parts, std::uint64_t count);

    const MedFile& file_;
    MedCells kind_;
    std::vector<MedField> fields_;
    std::vector<MedStep> steps_;
};

} // namespace isotet::io::confined
