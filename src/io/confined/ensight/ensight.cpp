// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold and 6, ascii and binary: a case file names the files of geometry and variables; parts are pieces. Which files
// those are at a step is found here; VTK's readers read them, one by one.
#include <algorithm>
#include <set>

#include <fmt/core.h>
#include <vtkEnSight6BinaryReader.h>
#include <vtkEnSight6Reader.h>
#include <vtkEnSightGoldBinaryReader.h>
#include <vtkEnSightGoldReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>

#include "io/confined/ensight/ensight_check.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/vtk_grid.hpp"
#include "io/confined/progress.hpp"
#include "io/confined/vtk_log.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {
namespace {

/// One of VTK's four readers, without its reading of the case.
template <class Base>
class EnsightFiles : public Base {
public:
    static EnsightFiles* New() { VTK_STANDARD_NEW_BODY(EnsightFiles); }

    bool read_geometry(const EnsightPlace& place, bool has_steps, vtkMultiBlockDataSet* output) {
        this->UseFileSets = has_steps ? 1 : 0;
        this->NumberOfNewOutputs = 0;
        this->NumberOfGeometryParts = 0;
        return this->ReadGeometryFile(place.name.c_str(), static_cast<int>(place.step), output) != 0;
    }
    bool read_scalars(const EnsightCase::Variable& variable, const std::vector<EnsightPlace>& places,
                      vtkMultiBlockDataSet* output) {
        const int components = static_cast<int>(places.size());
        const char* const name = variable.description.c_str();
        int component = 0;
        for (const EnsightPlace& place : places) {
            const char* const file = place.name.c_str();
            const int step = static_cast<int>(place.step);
            const int done = variable.of_nodes
                                 ? this->ReadScalarsPerNode(file, name, step, output, 0, components, component)
                                 : this->ReadScalarsPerElement(file, name, step, output, components, component);
            if (done == 0) return false;
            ++component;
        }
        return true;
    }
    bool read_others(const EnsightCase::Variable& variable, const std::string& field, const EnsightPlace& place,
                     vtkMultiBlockDataSet* output) {
        const char *const file = place.name.c_str(), *const name = field.c_str();
        const int step = static_cast<int>(place.step);
        const bool nodes = variable.of_nodes;
        int done = 0;
        if (variable.components == 3)
            done = nodes ? this->ReadVectorsPerNode(file, name, step, output)
                         : this->ReadVectorsPerElement(file, name, step, output);
        else if (variable.components == 6)
            done = nodes ? this->ReadTensorsPerNode(file, name, step, output)
                         : this->ReadTensorsPerElement(file, name, step, output);
        else
            done = nodes ? this->ReadAsymmetricTensorsPerNode(file, name, step, output)
                         : this->ReadAsymmetricTensorsPerElement(file, name, step, output);
        return done != 0;
    }
};

/// The fields of a variable: a complex scalar is one of two components, other complex ones are two fields.
std::vector<FieldInfo> fields_of(const EnsightCase::Variable& variable) {
    const Association association = variable.of_nodes ? Association::point : Association::cell;
    const auto field = [&](const std::string& name, std::size_t components) {
        return FieldInfo{name, association, ScalarType::float32, components};
    };
    if (!variable.is_complex) return {field(variable.description, variable.components)};
    if (variable.components == 1) return {field(variable.description, 2)};
    return {field(variable.description + "_r", variable.components),
            field(variable.description + "_i", variable.components)};
}

class EnsightLoad {
public:
    EnsightLoad(const std::string& path, const EnsightCase& found) : path_(path), case_(found) {}

    Result<Loaded> load(const ReadOptions& options, Depth depth);

private:
    Result<void> find(const ReadOptions& options, Depth depth);
    template <class Reader>
    Result<void> read_with(Reader& reader, const ReadOptions& options, Depth depth);
    template <class Reader>
    std::string read_variable(Reader& reader, std::size_t at, vtkMultiBlockDataSet* output) const;
    void leave_out_variable(const EnsightCase::Variable& variable, const std::string& reason) {
        for (const FieldInfo& field : fields_of(variable))
            leave_out(loaded_.info, {variable.of_nodes ? "point field" : "cell field", field.name, reason});
    }

    const std::string& path_;
    const EnsightCase& case_;
    EnsightFound found_;
    std::vector<bool> wanted_;
    Loaded loaded_;
};

/// Which step and variables, and their files.
Result<void> EnsightLoad::find(const ReadOptions& options, Depth depth) {
    loaded_.info.times = times_of(case_);
    const auto step = choose_step(loaded_.info, options);
    if (!step) return step.error();
    loaded_.step = *step;
    std::set<std::pair<Association, std::string>> known;
    for (const EnsightCase::Variable& variable : case_.variables) {
        const std::vector<FieldInfo> fields = fields_of(variable);
        const bool first = known.emplace(fields[0].association, fields[0].name).second;
        if (!first) leave_out(loaded_.info, {"variable", fields[0].name, "the case names another one like this before"});
        wanted_.push_back(first && (depth == Depth::description || std::ranges::any_of(fields, [&](const FieldInfo& field) {
                                        return wanted(options, field.association, field.name);
                                    })));
    }
    auto found = check_ensight(path_, case_, *step, wanted_);
    if (!found) return found.error();
    found_ = *std::move(found);
    for (std::size_t i = 0; i < case_.variables.size(); ++i) {
        if (!found_.variables[i].problem.empty()) {
            leave_out_variable(case_.variables[i], found_.variables[i].problem);
            wanted_[i] = false;
            continue;
        }
        for (const FieldInfo& field : fields_of(case_.variables[i])) announce(loaded_.info, field);
    }
    return {};
}

/// Why it cannot be read; empty: it could.
template <class Reader>
std::string EnsightLoad::read_variable(Reader& reader, std::size_t at, vtkMultiBlockDataSet* output) const {
    const EnsightCase::Variable& variable = case_.variables[at];
    const std::vector<EnsightPlace>& places = found_.variables[at].places;
    if (places.size() != variable.files.size()) return {}; // no values at this time
    bool good = true;
    const std::vector<FieldInfo> fields = fields_of(variable);
    if (variable.components == 1) good = reader.read_scalars(variable, places, output);
    else
        for (std::size_t i = 0; i < places.size(); ++i)
            good = reader.read_others(variable, fields[i].name, places[i], output) && good;
    if (auto error = take_vtk_error()) return "VTK's reader says: " + *error;
    return good ? "" : "VTK's reader failed without a reason";
}

template <class Reader>
Result<void> EnsightLoad::read_with(Reader& reader, const ReadOptions& options, Depth depth) {
    vtkNew<vtkMultiBlockDataSet> output;
    const bool good = reader.read_geometry(found_.model, case_.has_file_sets, output);
    if (auto error = take_vtk_error()) return broken(found_.model.name, "VTK's reader says: " + *error);
    if (!good) return broken(found_.model.name, "VTK's reader failed without a reason");
    announce_blocks(output, loaded_.info, "part");
    const auto chosen = chosen_blocks(loaded_.info.blocks, options);
    if (!chosen) return chosen.error();
    if (depth == Depth::description) return {};
    std::vector<std::string> failed;
    for (std::size_t i = 0; i < case_.variables.size(); ++i) {
        if (!wanted_[i]) continue;
        report_progress(static_cast<double>(i + 1) / static_cast<double>(case_.variables.size() + 1));
        const std::string problem = read_variable(reader, i, output);
        if (problem.empty()) continue;
        leave_out_variable(case_.variables[i], problem);
        for (const FieldInfo& field : fields_of(case_.variables[i])) failed.push_back(field.name);
    }
    auto pieces = pieces_of(output, options, loaded_.notes);
    if (!pieces) return broken(path_, pieces.error().message);
    if (pieces->empty()) return broken(path_, "VTK's reader found no grid in it");
    for (std::size_t i = 0; i < pieces->size(); ++i) {
        if (i < chosen->size() && !(*chosen)[i]) continue;
        Piece& piece = loaded_.pieces.emplace_back(std::move((*pieces)[i]));
        for (auto* fields : {&piece.grid.point_fields, &piece.grid.cell_fields})
            std::erase_if(*fields, [&](const Field& field) {
                return std::ranges::find(failed, field.name) != failed.end();
            });
    }
    return {};
}

Result<Loaded> EnsightLoad::load(const ReadOptions& options, Depth depth) {
    if (auto done = find(options, depth); !done) return done.error();
    const bool binary = found_.form != EnsightForm::ascii;
    Result<void> done;
    if (case_.is_gold && binary) {
        done = read_with(*vtkNew<EnsightFiles<vtkEnSightGoldBinaryReader>>(), options, depth);
    } else if (case_.is_gold) {
        done = read_with(*vtkNew<EnsightFiles<vtkEnSightGoldReader>>(), options, depth);
    } else if (binary) {
        vtkNew<EnsightFiles<vtkEnSight6BinaryReader>> reader;
        reader->SetByteOrder(found_.is_big_endian ? vtkGenericEnSightReader::FILE_BIG_ENDIAN
                                                  : vtkGenericEnSightReader::FILE_LITTLE_ENDIAN);
        done = read_with(*reader, options, depth);
    } else {
        done = read_with(*vtkNew<EnsightFiles<vtkEnSight6Reader>>(), options, depth);
    }
    if (!done) return done.error();
    return std::move(loaded_);
}

Result<void> check_names(const std::string& path, const EnsightCase& found, bool allow_outside) {
    if (auto allowed = check_name(path, found.model.name, allow_outside); !allowed) return allowed;
    for (const EnsightCase::Variable& variable : found.variables)
        for (const EnsightCase::File& file : variable.files)
            if (auto allowed = check_name(path, file.name, allow_outside); !allowed) return allowed;
    return {};
}

} // namespace

Result<Loaded> load_ensight(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto found = read_case(path);
    if (!found) return found.error();
    if (auto allowed = check_names(path, *found, options.allow_outside); !allowed) return allowed.error();
    return EnsightLoad(path, *found).load(options, depth);
}

} // namespace isotet::io::confined
