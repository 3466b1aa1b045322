// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Trees of blocks, and what all of VTK's readers are asked in the same way.
#include <algorithm>

#include <fmt/core.h>
#include <vtkAlgorithm.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "io/confined/vtk_grid.hpp"
#include "io/confined/vtk_log.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {
namespace {

void announce_attributes(vtkDataSetAttributes* attributes, Association association, FileInfo& info) {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
        vtkDataArray* values = attributes->GetArray(i);
        if (!values || !values->GetName() || is_ghost_array(values->GetName())) continue;
        if (const auto type = scalar_type(values->GetDataType()))
            announce(info, {values->GetName(), association, *type,
                            static_cast<std::size_t>(std::max(1, values->GetNumberOfComponents()))});
    }
}

/// Calls visit(data set, name of its block).
template <class Visit>
void each_data_set(vtkDataObject* data, Visit visit) {
    if (auto* set = vtkDataSet::SafeDownCast(data)) return visit(set, std::string());
    auto* tree = vtkCompositeDataSet::SafeDownCast(data);
    if (!tree) return;
    const auto blocks = vtkSmartPointer<vtkCompositeDataIterator>::Take(tree->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem()) {
        vtkInformation* about = blocks->HasCurrentMetaData() ? blocks->GetCurrentMetaData() : nullptr;
        const char* name = about ? about->Get(vtkCompositeDataSet::NAME()) : nullptr;
        if (auto* set = vtkDataSet::SafeDownCast(blocks->GetCurrentDataObject()))
            visit(set, name ? std::string(name) : fmt::format("block {}", blocks->GetCurrentFlatIndex()));
    }
}

/// The names of a tree's data sets with those of the blocks they are in, in the order of each_data_set().
void append_paths(vtkDataObject* data, const std::string& path, std::vector<std::string>& paths) {
    auto* const tree = vtkMultiBlockDataSet::SafeDownCast(data);
    if (!tree) {
        if (vtkDataSet::SafeDownCast(data)) paths.push_back(path);
        else each_data_set(data, [&](vtkDataSet*, const std::string& name) { paths.push_back(name); });
        return;
    }
    for (unsigned int i = 0; i < tree->GetNumberOfBlocks(); ++i) {
        const char* const name =
            tree->HasMetaData(i) ? tree->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()) : nullptr;
        const std::string own = name ? name : fmt::format("block {}", i + 1);
        append_paths(tree->GetBlock(i), path.empty() ? own : path + "/" + own, paths);
    }
}

Result<void> verdict(const std::string& path, bool worked) {
    if (auto error = take_vtk_error()) return broken(path, "VTK's reader says: " + *error);
    if (!worked) return broken(path, "VTK's reader failed without a reason");
    return {};
}

} // namespace

Result<std::vector<Piece>> pieces_of(vtkDataObject* data, const ReadOptions& options, std::vector<std::string>& notes) {
    std::vector<Piece> pieces;
    std::optional<Error> error;
    each_data_set(data, [&](vtkDataSet* set, std::string name) {
        if (error) return;
        auto piece = piece_of(set, options, std::move(name), notes);
        if (piece) pieces.push_back(std::move(*piece));
        else error = piece.error();
    });
    if (error) return *error;
    return pieces;
}

void announce_fields(vtkDataObject* data, FileInfo& info) {
    each_data_set(data, [&](vtkDataSet* set, const std::string&) {
        announce_attributes(set->GetPointData(), Association::point, info);
        announce_attributes(set->GetCellData(), Association::cell, info);
    });
}

void announce_blocks(vtkDataObject* data, FileInfo& info, const char* kind) {
    if (!vtkCompositeDataSet::SafeDownCast(data)) return;
    std::vector<std::string> paths;
    append_paths(data, {}, paths);
    std::size_t next = 0;
    each_data_set(data, [&](vtkDataSet* set, const std::string& name) {
        BlockInfo& block = info.blocks.emplace_back();
        block.number = static_cast<std::int64_t>(next + 1);
        block.name = next < paths.size() ? paths[next] : name;
        block.name.erase(block.name.find_last_not_of(" \t\n") + 1); // binary EnSight pads with spaces
        block.kind = kind;
        block.cells = static_cast<std::uint64_t>(set->GetNumberOfCells());
        ++next;
    });
}

void choose_arrays(vtkDataArraySelection* selection, const ReadOptions& options, Association association) {
    for (int i = 0; i < selection->GetNumberOfArrays(); ++i) {
        const std::string name = selection->GetArrayName(i);
        const bool ids = name.starts_with("Global") || name.starts_with("GLOBAL_IDS"); // to join pieces by
        if (ids || is_ghost_array(name) || wanted(options, association, name)) selection->EnableArray(name.c_str());
        else selection->DisableArray(name.c_str());
    }
}

std::vector<double> announced_times(vtkAlgorithm& reader) {
    vtkInformation* output = reader.GetOutputInformation(0);
    const auto key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
    if (!output || !output->Has(key)) return {};
    const double* times = output->Get(key);
    return {times, times + output->Length(key)};
}

Result<void> update_information(vtkAlgorithm& reader, const std::string& path) {
    reader.UpdateInformation();
    return verdict(path, true);
}

Result<void> update(vtkAlgorithm& reader, const std::string& path, const std::vector<double>& times, std::size_t step) {
    follow_progress(&reader);
    const bool worked = step < times.size() ? reader.UpdateTimeStep(times[step]) != 0 : (reader.Update(), true);
    return verdict(path, worked && reader.GetErrorCode() == 0);
}

} // namespace isotet::io::confined
