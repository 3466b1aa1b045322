// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/read_openfoam.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "io/own/block_choice.hpp"
#include "io/own/escape.hpp"
#include "io/own/foam/case_layout.hpp"
#include "io/own/foam/cell_zones.hpp"
#include "io/own/foam/collated_case.hpp"
#include "io/own/foam/fields.hpp"
#include "io/own/foam/scanner.hpp"
#include "io/own/join.hpp"
#include "io/own/loaded.hpp"
#include "io/own/text_scanner.hpp"

namespace isotet::io {

namespace {

namespace fs = std::filesystem;
using foam::CaseFiles;
using foam::CaseLayout;

/// A field file of a time, as its header announces it.
struct AnnouncedField {
    std::string name;
    foam::Header header;
    bool of_points() const { return header.type.starts_with("point"); }
};

bool is_field_class(std::string_view type) {
    return (type.starts_with("vol") || type.starts_with("point")) && foam::components_of(type) > 0;
}

/// The fields in a folder, by the headers of files that were not looked at before.
Result<std::vector<AnnouncedField>> fields_in(const CaseFiles& files, const std::string& folder,
                                              std::set<std::string>& seen) {
    constexpr std::size_t head_bytes = 8192;
    std::vector<AnnouncedField> fields;
    for (const std::string& name : files.list(folder).files) {
        if (!seen.insert(name).second) continue;
        auto text = files.open(folder + name, head_bytes);
        if (!text)
            continue; // an empty file, or one that may not be read: no field; it is an error when it is asked for
        foam::Scanner scanner(std::move(*text));
        if (!scanner.is_foam()) continue;
        auto header = scanner.header();
        if (!header) return header.error();
        if (is_field_class(header->type)) fields.push_back({name, std::move(*header)});
    }
    return fields;
}

std::string field_folder(const CaseLayout& layout, const std::string& region, std::size_t step) {
    return layout.times[step].second + "/" + (region.empty() ? "" : region + "/");
}

void announce_field(FileInfo& info, const AnnouncedField& field) {
    const ScalarType type = field.header.single ? ScalarType::float32 : ScalarType::float64;
    const std::size_t components = foam::components_of(field.header.type);
    announce(info, {field.name, Association::point, type, components});
    if (!field.of_points()) announce(info, {field.name, Association::cell, type, components});
}

Result<void> describe(const CaseFiles& files, const CaseLayout& layout, FileInfo& info) {
    info.format = "openfoam";
    for (const auto& [time, name] : layout.times) info.times.push_back(time);
    for (const std::string& region : layout.regions) {
        std::set<std::string> seen;
        for (std::size_t step = 0; step < layout.times.size(); ++step) {
            auto fields = fields_in(files, layout.prefixes.front() + field_folder(layout, region, step), seen);
            if (!fields) return fields.error();
            for (const AnnouncedField& field : *fields) announce_field(info, field);
        }
    }
    return {};
}

Result<std::vector<foam::MeshPlace>> places_of(const CaseFiles& files, const CaseLayout& layout,
                                               const std::string& region, std::size_t step) {
    std::vector<foam::MeshPlace> places;
    for (const std::string& prefix : layout.prefixes) {
        auto place = foam::mesh_place(files, layout, prefix, region, step);
        if (!place) return place.error();
        places.push_back(std::move(*place));
    }
    return places;
}

/// What is wanted of a region.
struct RegionChoice {
    bool whole = true;
    std::vector<std::string> zones; ///< else

    bool empty() const { return !whole && zones.empty(); }
};

/// What the blocks of the description are: regions where there are several, then the zones of all.
struct CaseBlocks {
    struct Block {
        std::size_t region = 0;
        std::string zone; ///< empty: all of the region
    };
    std::vector<Block> blocks;

    /// One a region.
    Result<std::vector<RegionChoice>> chosen(const std::vector<BlockInfo>& listed, const ReadOptions& options,
                                             std::size_t regions) const {
        std::vector<RegionChoice> choices(regions);
        if (options.blocks.empty()) return choices;
        const auto flags = chosen_blocks(listed, options);
        if (!flags) return flags.error();
        for (RegionChoice& choice : choices) choice.whole = false;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (!(*flags)[i]) continue;
            RegionChoice& choice = choices[blocks[i].region];
            if (blocks[i].zone.empty()) choice.whole = true;
            else choice.zones.push_back(blocks[i].zone);
        }
        return choices;
    }
};

Result<CaseBlocks> announce_blocks(const CaseFiles& files, const CaseLayout& layout, std::size_t step, FileInfo& info) {
    CaseBlocks found;
    const auto add = [&](CaseBlocks::Block block, const std::string& name, const char* kind, std::uint64_t cells) {
        found.blocks.push_back(std::move(block));
        info.blocks.push_back({static_cast<std::int64_t>(found.blocks.size()), name, kind, cells});
    };
    const bool several = layout.regions.size() > 1;
    for (std::size_t region = 0; region < layout.regions.size() && several; ++region)
        add({region, {}}, layout.regions[region], "region", 0);
    for (std::size_t region = 0; region < layout.regions.size(); ++region) {
        const auto places = places_of(files, layout, layout.regions[region], step);
        if (!places) return places.error();
        std::vector<foam::CellZone> zones; // of all parts
        for (const foam::MeshPlace& place : *places) {
            const auto of_part = foam::read_cell_zones(files, place.faces, {});
            if (!of_part) return of_part.error();
            for (const foam::CellZone& zone : *of_part) {
                const auto known = std::ranges::find(zones, zone.name, &foam::CellZone::name);
                if (known == zones.end()) zones.push_back(zone);
                else known->count += zone.count;
            }
        }
        for (const foam::CellZone& zone : zones)
            add({region, zone.name}, (several ? layout.regions[region] + "/" : "") + zone.name, "zone", zone.count);
    }
    return found;
}

Result<void> read_fields(const CaseFiles& files, const CaseLayout& layout, const std::string& region, std::size_t step,
                         const ReadOptions& options, const foam::WholeMesh& whole, Piece& piece,
                         std::vector<std::string>& notes) {
    if (layout.times.empty()) return {};
    const std::string folder = field_folder(layout, region, step);
    std::set<std::string> seen;
    std::map<std::string, std::vector<std::string>> fields_including; // by the file that was not read
    auto fields = fields_in(files, layout.prefixes.front() + folder, seen);
    if (!fields) return fields.error();
    for (const AnnouncedField& field : *fields) {
        const bool points = wanted(options, Association::point, field.name);
        const bool cells = !field.of_points() && wanted(options, Association::cell, field.name);
        if (!points && !cells) continue;
        auto read = foam::read_case_field(files, whole, piece.grid.cells,
                                          {folder, field.name, cells, points, options.allow_outside});
        if (!read) return read.error();
        if (points) piece.grid.point_fields.push_back({field.name, std::move(read->points)});
        if (cells) piece.grid.cell_fields.push_back({field.name, std::move(read->cells)});
        for (const std::string& file : read->unread) fields_including[file].push_back(escaped(field.name));
    }
    for (const auto& [file, names] : fields_including)
        notes.push_back(fmt::format("{} of an OpenFOAM installation, which {} {}, was not read: a point on a patch "
                                    "without values has the mean of the cells around it",
                                    in_quotes(file), fmt::join(names, ", "),
                                    names.size() > 1 ? "include" : "includes"));
    return {};
}

Array point_array(foam::Mesh& mesh) {
    if (!mesh.single) return Array::own(std::move(mesh.points), 3);
    std::vector<float> narrow(mesh.points.size());
    std::ranges::transform(mesh.points, narrow.begin(), [](double value) { return static_cast<float>(value); });
    mesh.points = {};
    return Array::own(std::move(narrow), 3);
}

Result<Piece> read_region(const CaseFiles& files, const CaseLayout& layout, const std::string& region, std::size_t step,
                          const RegionChoice& choice, const ReadOptions& options, std::vector<std::string>& notes) {
    const auto places = places_of(files, layout, region, step);
    if (!places) return places.error();
    std::vector<foam::Mesh> meshes;
    for (const foam::MeshPlace& place : *places) {
        auto mesh = foam::read_mesh(files, place);
        if (!mesh) return mesh.error();
        meshes.push_back(std::move(*mesh));
    }
    auto whole =
        foam::join_meshes(files, std::move(meshes), *places, layout.prefixes, options.merge_pieces_by_coordinates);
    if (!whole) return whole.error();
    notes.insert(notes.end(), whole->notes.begin(), whole->notes.end());
    Piece piece;
    piece.name = region;
    piece.grid.cells = foam::cells_of(whole->mesh);
    if (auto read = read_fields(files, layout, region, step, options, *whole, piece, notes); !read) return read.error();
    piece.grid.points = point_array(whole->mesh);
    if (choice.whole) return piece;
    auto outside = foam::cells_outside(choice.zones, files, *places, *whole);
    if (!outside) return outside.error();
    notes.push_back(fmt::format("{} of {} cells{} are in the chosen zones", std::ranges::count(*outside, 0),
                                outside->size(), region.empty() ? "" : " of the region " + in_quotes(region)));
    piece.left_out = *std::move(outside);
    if (auto dropped = drop_left_out_cells(piece); !dropped) return dropped.error();
    return piece;
}

/// The folder of the case that FILE means.
std::string case_folder(const std::string& path) {
    std::error_code ignored;
    const fs::path file(path);
    if (fs::is_directory(file, ignored)) return path;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (file.filename() != "controlDict") return folder.string();
    return fs::weakly_canonical(folder / "..", ignored).string();
}

int recognizes_openfoam(std::string_view head, std::string_view extension) {
    if (head.find("FoamFile") != std::string_view::npos && head.find("controlDict") != std::string_view::npos) return 2;
    return extension == ".foam" || extension == ".openfoam" ? 1 : 0;
}

void add_opened(const std::string& path, const foam::DiskCase& files, FileInfo& info) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored)) info.files.push_back(path);
    for (const std::string& file : files.opened()) info.files.push_back(file);
}

Result<FileInfo> inspect_openfoam(const std::string& path, const ReadOptions& options, const Progress& progress) {
    const foam::DiskCase files(case_folder(path), options.allow_outside, progress);
    auto loaded = load_openfoam_case(files, options, Depth::description);
    if (!loaded) return loaded.error();
    add_opened(path, files, loaded->info);
    return std::move(loaded->info);
}

Result<ReadResult> read_openfoam(const std::string& path, const ReadOptions& options, const Progress& progress) {
    const foam::DiskCase files(case_folder(path), options.allow_outside, progress);
    auto loaded = load_openfoam_case(files, options, Depth::arrays);
    if (!loaded) return loaded.error();
    add_opened(path, files, loaded->info);
    return join(std::move(*loaded), options.merge_pieces_by_coordinates);
}

} // namespace

Result<Loaded> load_openfoam_case(const CaseFiles& case_files, const ReadOptions& options, Depth depth) {
    const auto collated = foam::CollatedCase::over(case_files);
    if (!collated) return collated.error();
    const CaseFiles& files = *collated ? **collated : case_files;
    auto layout = foam::layout_of(files);
    if (!layout) return layout.error();
    Loaded loaded;
    if (auto described = describe(files, *layout, loaded.info); !described) return described.error();
    const auto step = choose_step(loaded.info, options);
    if (!step && depth == Depth::arrays) return step.error();
    loaded.step = step ? *step : 0;
    const auto blocks = announce_blocks(files, *layout, loaded.step, loaded.info);
    if (!blocks) return blocks.error();
    if (depth == Depth::description) return loaded;
    loaded.notes = layout->notes;
    const auto chosen = blocks->chosen(loaded.info.blocks, options, layout->regions.size());
    if (!chosen) return chosen.error();
    for (std::size_t i = 0; i < chosen->size(); ++i) {
        if ((*chosen)[i].empty()) continue;
        auto piece = read_region(files, *layout, layout->regions[i], loaded.step, (*chosen)[i], options, loaded.notes);
        if (!piece) return piece.error();
        if (chosen->size() > 1 && (*chosen)[i].whole) loaded.info.blocks[i].cells = piece->grid.cells.count();
        loaded.pieces.push_back(std::move(*piece));
    }
    return loaded;
}

bool is_openfoam_case(const std::string& folder) {
    const Progress none;
    const foam::DiskCase files(folder, true, none);
    if (files.has("system/controlDict") || files.has("constant/polyMesh/faces")) return true;
    for (const std::string& name : files.list("").folders)
        if (name.starts_with("processor") && files.has(name + "/constant/polyMesh/faces")) return true;
    for (const std::string& name : files.list("constant").folders)
        if (files.has("constant/" + name + "/polyMesh/faces")) return true;
    return false;
}

GridReader openfoam_reader() {
    GridReader reader;
    reader.format.name = "openfoam";
    reader.format.title = "OpenFOAM case";
    reader.format.extensions = {".foam", ".openfoam"};
    reader.format.reads_grid = true;
    reader.recognizes = recognizes_openfoam;
    reader.inspect = inspect_openfoam;
    reader.read = read_openfoam;
    return reader;
}

} // namespace isotet::io
