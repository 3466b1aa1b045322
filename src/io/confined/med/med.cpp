// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MED, the format of Salome and code_aster: meshes, their groups, and fields at steps.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/confined/hdf5/hdf5_walk.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/med/med_fields.hpp"
#include "io/confined/med/med_file.hpp"
#include "io/confined/med/med_mesh.hpp"
#include "io/confined/progress.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {
namespace {

constexpr const char* family_name = "med:family";

class MedLoader {
public:
    MedLoader(const MedFile& file, const ReadOptions& options)
        : file_(file), options_(options), kind_(cells_to_read(file)), fields_(file, kind_) {}

    Result<Loaded> load(Depth depth);

private:
    /// A mesh with cells at the step that is read.
    struct Placed {
        MedMesh mesh;
        MedMeshPlace place;
        std::vector<std::int64_t> families = {};                      ///< of its cells; empty: it has none
        std::map<std::string, std::vector<std::int64_t>> groups = {}; ///< families in each
    };

    void choose_times();
    Result<void> place_meshes();
    Result<void> find_groups(Placed& placed);
    void announce_blocks();
    Result<std::vector<bool>> chosen();
    void tell_least(const std::vector<bool>& chosen);
    Result<void> read_patches(const Placed& placed, Grid& grid);
    Result<Piece> read_mesh(std::size_t at, const std::vector<bool>& chosen, std::size_t first_group);

    const MedFile& file_;
    const ReadOptions& options_;
    MedCells kind_;
    MedFields fields_;
    std::vector<Placed> meshes_;
    core::PatchList patch_numbers_; ///< of all meshes
    Loaded loaded_;
};

/// Where the only time is 0, the file knows no time: meshio writes such ones.
void MedLoader::choose_times() {
    const std::vector<MedStep>& steps = fields_.steps();
    if (steps.size() == 1 && steps[0].time == 0) return;
    for (const MedStep& step : steps) loaded_.info.times.push_back(step.time);
}

Result<void> MedLoader::place_meshes() {
    std::string first_problem;
    for (const std::string& name : file_.groups("/ENS_MAA")) {
        MedMesh mesh(file_, name, kind_);
        std::string problem = mesh.problem();
        if (problem.empty()) {
            const MedStep step = fields_.step_of_mesh(name, loaded_.step);
            auto place = mesh.place_at(step.number, step.iteration);
            if (!place) return place.error();
            if (place->cells > 0) {
                meshes_.push_back({std::move(mesh), *std::move(place)});
                continue;
            }
            problem = kind_ == MedCells::flat ? "it has no cells" : "it has no cells with a volume";
        }
        if (first_problem.empty()) first_problem = fmt::format("mesh \"{}\": {}", escaped(name), problem);
        leave_out(loaded_.info, {"mesh", name, problem});
    }
    if (!meshes_.empty()) return {};
    return file_.wrong(first_problem.empty() ? "it has no mesh" : first_problem);
}

Result<void> MedLoader::find_groups(Placed& placed) {
    if (!placed.mesh.has_families(placed.place)) return {};
    auto families = placed.mesh.families(placed.place);
    if (!families) return families.error();
    placed.families = *std::move(families);
    std::map<std::int64_t, std::uint64_t> counts;
    for (const std::int64_t family : placed.families) ++counts[family];
    for (const auto& [number, groups] : placed.mesh.groups_of_families()) {
        if (!counts.contains(number)) continue;
        for (const std::string& group : groups) placed.groups[group].push_back(number);
        if (!groups.empty() && meshes_.size() == 1)
            loaded_.info.regions.push_back({family_name, number, fmt::format("{}", fmt::join(groups, ", "))});
    }
    return {};
}

/// Meshes where there are several, then their groups.
void MedLoader::announce_blocks() {
    std::vector<BlockInfo>& blocks = loaded_.info.blocks;
    const auto add = [&](std::string name, const char* kind, std::uint64_t cells) {
        blocks.push_back({static_cast<std::int64_t>(blocks.size() + 1), std::move(name), kind, cells});
    };
    const bool several = meshes_.size() > 1;
    for (const Placed& placed : meshes_)
        if (several) add(placed.mesh.name(), "mesh", placed.place.cells);
    for (const Placed& placed : meshes_)
        for (const auto& [group, families] : placed.groups) {
            const auto cells = std::ranges::count_if(placed.families, [&](std::int64_t family) {
                return std::ranges::find(families, family) != families.end();
            });
            add(several ? placed.mesh.name() + "/" + group : group, "group", static_cast<std::uint64_t>(cells));
        }
}

/// Meshes are grids of their own, often of one thing: without a choice only one is read, which has fields if one has.
Result<std::vector<bool>> MedLoader::chosen() {
    auto chosen = chosen_blocks(loaded_.info.blocks, options_);
    if (!chosen || !options_.blocks.empty() || meshes_.size() < 2) return chosen;
    std::size_t first = 0;
    while (first + 1 < meshes_.size() && !fields_.belong_to(meshes_[first].mesh.name())) ++first;
    if (!fields_.belong_to(meshes_[first].mesh.name())) first = 0;
    std::vector<std::string> others;
    for (std::size_t i = 0; i < meshes_.size(); ++i)
        if (i != first) others.push_back("'" + escaped(meshes_[i].mesh.name()) + "'");
    loaded_.notes.push_back(fmt::format("one of {} meshes is read, '{}': `block` NAME reads {}", meshes_.size(),
                                        escaped(meshes_[first].mesh.name()), fmt::join(others, ", ")));
    std::vector<bool> only(chosen->size(), false);
    only[first] = true;
    return only;
}

/// Those that are broken are left out.
Result<void> MedLoader::read_patches(const Placed& placed, Grid& grid) {
    if (!options_.patches) return {};
    core::PatchList list;
    if (const auto added = placed.mesh.add_patches(placed.place, patch_numbers_, list); added)
        grid.patches = list.finish();
    else if (added.error().code != ErrorCode::invalid_data) return added.error();
    else leave_out(loaded_.info, {"patch", "groups of faces of " + placed.mesh.name(), added.error().message});
    return {};
}

Result<Piece> MedLoader::read_mesh(std::size_t at, const std::vector<bool>& chosen, std::size_t first_group) {
    Placed& placed = meshes_[at];
    Piece piece;
    piece.name = placed.mesh.name();
    auto points = placed.mesh.points(placed.place);
    if (!points) return points.error();
    piece.grid.points = *std::move(points);
    auto cells = placed.mesh.cells(placed.place);
    if (!cells) return cells.error();
    piece.grid.cells = *std::move(cells);
    if (auto done = fields_.read(options_, loaded_.step, placed.mesh, placed.place, piece.grid, loaded_); !done)
        return done.error();
    if (auto read = read_patches(placed, piece.grid); !read) return read.error();
    const bool whole = meshes_.size() > 1 ? chosen[at] : options_.blocks.empty();
    if (!whole) {
        std::vector<std::int64_t> families;
        std::size_t block = first_group;
        for (const auto& [group, own] : placed.groups)
            if (chosen[block++]) families.insert(families.end(), own.begin(), own.end());
        for (const std::int64_t family : placed.families)
            piece.left_out.push_back(std::ranges::find(families, family) == families.end() ? 1 : 0);
    }
    if (!placed.families.empty() && wanted(options_, Association::cell, family_name))
        piece.grid.cell_fields.push_back({family_name, Array::own(std::move(placed.families))});
    if (whole) return piece;
    if (auto dropped = drop_left_out_cells(piece); !dropped) return dropped.error();
    return piece;
}

void MedLoader::tell_least(const std::vector<bool>& chosen) {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes_.size() > 1 && !chosen[i]) continue;
        const MedMeshPlace& place = meshes_[i].place;
        LeastCounts least{place.points, place.cells, 0, ScalarType::float64, true};
        for (const MedCellRun& run : place.runs) least.corners += run.count * run.element->nodes;
        add(loaded_.info.least, least);
    }
}

Result<Loaded> MedLoader::load(Depth depth) {
    choose_times();
    fields_.announce_all(loaded_.info, depth == Depth::description ? options_.step : std::nullopt);
    const auto step = choose_step(loaded_.info, options_);
    if (!step) return step.error();
    loaded_.step = *step;
    if (auto done = place_meshes(); !done) return done.error();
    for (Placed& placed : meshes_)
        if (auto done = find_groups(placed); !done) return done.error();
    if (std::ranges::any_of(meshes_, [](const Placed& placed) { return !placed.families.empty(); }))
        announce(loaded_.info, {family_name, Association::cell, ScalarType::int64, 1});
    announce_blocks();
    const auto choice = chosen();
    if (!choice) return choice.error();
    if (depth == Depth::description) {
        tell_least(*choice);
        return std::move(loaded_);
    }
    std::size_t first_group = meshes_.size() > 1 ? meshes_.size() : 0;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        const std::size_t groups = meshes_[i].groups.size();
        const auto of_mesh = choice->begin() + static_cast<std::ptrdiff_t>(first_group);
        const bool any_group = std::find(of_mesh, of_mesh + static_cast<std::ptrdiff_t>(groups), true) !=
                               of_mesh + static_cast<std::ptrdiff_t>(groups);
        if (any_group || (meshes_.size() > 1 ? (*choice)[i] : options_.blocks.empty())) {
            auto piece = read_mesh(i, *choice, first_group);
            if (!piece) return piece.error();
            loaded_.pieces.push_back(*std::move(piece));
        }
        first_group += groups;
        report_progress(static_cast<double>(i + 1) / static_cast<double>(meshes_.size()));
    }
    return std::move(loaded_);
}

} // namespace

Result<Loaded> load_med(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto names = check_hdf5_names(path, options.allow_outside);
    if (!names) return names.error();
    const auto file = MedFile::open(path);
    if (!file) return file.error();
    auto loaded = MedLoader(*file, options).load(depth);
    for (const LeftOut& item : *names)
        if (loaded) leave_out(loaded->info, item);
    return loaded;
}

} // namespace isotet::io::confined
