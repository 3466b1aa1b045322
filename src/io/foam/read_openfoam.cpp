// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/read_openfoam.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "grid/patches.hpp"
#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/foam/case_layout.hpp"
#include "io/foam/cell_zones.hpp"
#include "io/foam/collated_case.hpp"
#include "io/foam/fields.hpp"
#include "io/foam/scanner.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/pieces/join/join.hpp"
#include "io/pieces/loaded.hpp"

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

/// Of one file beside others that are sound.
bool may_be_left_out(const Error& error) {
    return error.code == ErrorCode::invalid_data || error.code == ErrorCode::file;
}

/// Why a file without a header may be meant as a field; empty where it is something else.
std::string fault_without_header(const foam::CaseText& text, const std::string& name) {
    if (text.text.empty()) return fmt::format("{} is empty", escaped(name));
    for (const char* word : {"FoamFile", "internalField", "OpenFOAM"}) // the last stands in the banner
        if (text.text.find(word) != std::string_view::npos)
            return fmt::format("{} does not begin with FoamFile {{ }}", escaped(name));
    return {};
}

/// The fields in a folder, by the headers of files that were not looked at before.
Result<std::vector<AnnouncedField>> fields_in(const CaseFiles& files, const std::string& folder,
                                              std::set<std::string>& seen, FileInfo& info) {
    constexpr std::size_t head_bytes = 8192;
    std::vector<AnnouncedField> fields;
    for (const std::string& name : files.list(folder).files) {
        if (!seen.insert(name).second || name.starts_with(".")) continue;
        auto text = files.open(folder + name, head_bytes);
        if (!text) {
            seen.erase(name); // may be sound at another time
            leave_out(info, {"field", name, text.error().message});
            continue;
        }
        const std::string fault = fault_without_header(*text, folder + name);
        foam::Scanner scanner(std::move(*text));
        if (!scanner.is_foam()) {
            if (fault.empty()) continue;
            seen.erase(name);
            leave_out(info, {"field", name, fault});
            continue;
        }
        auto header = scanner.header();
        if (!header) {
            if (!may_be_left_out(header.error())) return header.error();
            seen.erase(name);
            leave_out(info, {"field", name, header.error().message});
            continue;
        }
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

/// What is wanted of a region.
struct RegionChoice {
    bool whole = true;
    std::vector<std::string> zones; ///< else

    bool empty() const { return !whole && zones.empty(); }
};

/// `only`   the step whose fields are told; nothing: those of all steps
Result<void> announce_chosen_fields(const CaseFiles& files, const CaseLayout& layout,
                                    const std::vector<RegionChoice>& choices, std::optional<std::size_t> only,
                                    FileInfo& info) {
    for (std::size_t region = 0; region < choices.size(); ++region) {
        if (choices[region].empty()) continue;
        std::set<std::string> seen;
        for (std::size_t step = 0; step < layout.times.size(); ++step) {
            if (only && *only != step) continue;
            auto fields = fields_in(files, layout.prefixes.front() + field_folder(layout, layout.regions[region], step),
                                    seen, info);
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

/// What the blocks of the description are: regions where there are several, then the zones of all. Zones without cells can
/// be chosen, too, and are not in the description.
struct CaseBlocks {
    struct Block {
        std::size_t region = 0;
        std::string zone; ///< empty: all of the region
    };
    std::vector<Block> blocks;
    std::vector<BlockInfo> infos; ///< one each
    std::vector<Error> faults;    ///< of files of zones, the rest of which was not read

    void add(Block block, const std::string& name, const char* kind, std::uint64_t cells) {
        blocks.push_back(std::move(block));
        infos.push_back({static_cast<std::int64_t>(blocks.size()), name, kind, cells});
    }

    /// One a region. The name of a region means that region alone, whatever zones are called so.
    Result<std::vector<RegionChoice>> chosen(const CaseLayout& layout, const ReadOptions& options) const {
        std::vector<RegionChoice> choices(layout.regions.size());
        if (layout.has_base_mesh()) choices.front().whole = false;
        if (options.blocks.empty()) return choices;
        for (RegionChoice& choice : choices) choice.whole = false;
        ReadOptions others;
        for (const std::string& asked : options.blocks) {
            std::size_t region = 0;
            while (region < choices.size() && !(layout.has_several_regions() && layout.name_of(region) == asked))
                ++region;
            if (region < choices.size()) choices[region].whole = true;
            else others.blocks.push_back(asked);
        }
        if (others.blocks.empty()) return choices;
        const auto flags = chosen_blocks(infos, others);
        if (!flags) return faults.empty() ? flags.error() : faults.front();
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (!(*flags)[i]) continue;
            RegionChoice& choice = choices[blocks[i].region];
            if (blocks[i].zone.empty()) choice.whole = true;
            else choice.zones.push_back(blocks[i].zone);
        }
        return choices;
    }
};

/// The zones of a region, of all parts together.
Result<std::vector<foam::CellZone>> zones_of(const CaseFiles& files, const CaseLayout& layout,
                                             const std::string& region, std::size_t step, std::vector<Error>& faults) {
    const auto places = places_of(files, layout, region, step);
    if (!places) return places.error();
    std::vector<foam::CellZone> zones;
    for (const foam::MeshPlace& place : *places) {
        const auto of_part = foam::read_cell_zones(files, place.faces, {});
        if (of_part.fault) {
            if (!may_be_left_out(*of_part.fault)) return *of_part.fault;
            faults.push_back(*of_part.fault);
        }
        for (const foam::CellZone& zone : of_part.zones) {
            const auto known = std::ranges::find(zones, zone.name, &foam::CellZone::name);
            if (known == zones.end()) zones.push_back(zone);
            else known->count += zone.count;
        }
    }
    return zones;
}

Result<CaseBlocks> find_blocks(const CaseFiles& files, const CaseLayout& layout, std::size_t step, FileInfo& info) {
    CaseBlocks found, empty;
    const bool several = layout.has_several_regions();
    for (std::size_t region = 0; region < layout.regions.size() && several; ++region)
        found.add({region, {}}, layout.name_of(region), "region", 0);
    for (std::size_t region = 0; region < layout.regions.size(); ++region) {
        const auto zones = zones_of(files, layout, layout.regions[region], step, found.faults);
        if (!zones) return zones.error();
        for (const foam::CellZone& zone : *zones)
            (zone.count ? found : empty)
                .add({region, zone.name}, (several ? layout.name_of(region) + "/" : "") + zone.name, "zone",
                     zone.count);
    }
    for (const Error& fault : found.faults) leave_out(info, {"rest of the file", "cellZones", fault.message});
    info.blocks = found.infos;
    for (std::size_t i = 0; i < empty.blocks.size(); ++i) found.add(empty.blocks[i], empty.infos[i].name, "zone", 0);
    return found;
}

Result<void> read_fields(const CaseFiles& files, const CaseLayout& layout, const std::string& region, std::size_t step,
                         const ReadOptions& options, const foam::WholeMesh& whole, Piece& piece, Loaded& loaded) {
    if (layout.times.empty()) return {};
    const std::string folder = field_folder(layout, region, step);
    std::set<std::string> seen;
    std::map<std::string, std::vector<std::string>> fields_including; // by the file that was not read
    auto fields = fields_in(files, layout.prefixes.front() + folder, seen, loaded.info);
    if (!fields) return fields.error();
    for (const AnnouncedField& field : *fields) {
        const bool points = wanted(options, Association::point, field.name);
        const bool cells = !field.of_points() && wanted(options, Association::cell, field.name);
        if (!points && !cells) continue;
        auto read = foam::read_case_field(files, whole, piece.grid.cells,
                                          {folder, field.name, cells, points, options.allow_outside});
        if (!read) {
            const bool asked = (points && options.point_fields) || (cells && options.cell_fields);
            if (asked || !may_be_left_out(read.error())) return read.error();
            leave_out(loaded.info, {"field", field.name, read.error().message});
            continue;
        }
        if (points) piece.grid.point_fields.push_back({field.name, std::move(read->points)});
        if (cells) piece.grid.cell_fields.push_back({field.name, std::move(read->cells)});
        if (!read->lacking.empty())
            loaded.notes.push_back(fmt::format("{} {} no {} at this time: there is no data",
                                               fmt::join(read->lacking, ", "),
                                               read->lacking.size() > 1 ? "have" : "has", escaped(field.name)));
        if (!read->misfits.empty())
            loaded.notes.push_back(
                *read->misfits.begin() +
                (read->misfits.size() > 1
                     ? fmt::format(": it and {} more of {} are not used", read->misfits.size() - 1, escaped(field.name))
                     : ": it is not used"));
        for (const std::string& file : read->unread) fields_including[file].push_back(escaped(field.name));
    }
    for (const auto& [file, names] : fields_including)
        loaded.notes.push_back(
            fmt::format("{} of an OpenFOAM installation, which {} {}, was not read: a point on a patch "
                        "without values has the mean of the cells around it",
                        in_quotes(file), fmt::join(names, ", "), names.size() > 1 ? "include" : "includes"));
    return {};
}

Array point_array(foam::Mesh& mesh) {
    if (!mesh.single) return Array::own(std::move(mesh.points), 3);
    std::vector<float> narrow(mesh.points.size());
    std::ranges::transform(mesh.points, narrow.begin(), [](double value) { return static_cast<float>(value); });
    mesh.points = std::vector<double>();
    return Array::own(std::move(narrow), 3);
}

/// Patches with faces, but those between processors. Those of regions have their names in front.
void add_patches(const foam::WholeMesh& whole, const std::string& prefix, core::PatchList& numbers, Grid& grid) {
    core::PatchList list;
    for (const foam::Part& part : whole.parts)
        for (const foam::Patch& patch : part.patches) {
            if (patch.type.starts_with("processor")) continue;
            const std::string name = prefix + patch.name;
            const std::int64_t number = numbers.number_of(name);
            list.name(number, name);
            const foam::Faces& faces = whole.mesh.faces;
            for (std::size_t face = patch.first; face < patch.first + patch.count; ++face) {
                for (const std::int32_t point : faces.of(face)) list.point(point);
                list.end_face(number);
            }
        }
    grid.patches = list.finish();
}

Result<Piece> read_region(const CaseFiles& files, const CaseLayout& layout, const std::string& region, std::size_t step,
                          const RegionChoice& choice, const ReadOptions& options, core::PatchList& patch_numbers,
                          Loaded& loaded) {
    std::vector<std::string>& notes = loaded.notes;
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
    if (auto read = read_fields(files, layout, region, step, options, *whole, piece, loaded); !read)
        return read.error();
    if (options.patches)
        add_patches(*whole, layout.has_several_regions() && !region.empty() ? region + "/" : "", patch_numbers,
                    piece.grid);
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
    return join(std::move(*loaded), options, progress);
}

} // namespace

Result<Loaded> load_openfoam_case(const CaseFiles& case_files, const ReadOptions& options, Depth depth) {
    const auto collated = foam::CollatedCase::over(case_files);
    if (!collated) return collated.error();
    const CaseFiles& files = *collated ? **collated : case_files;
    auto layout = foam::layout_of(files);
    if (!layout) return layout.error();
    Loaded loaded;
    loaded.info.format = "openfoam";
    for (const auto& [time, name] : layout->times) loaded.info.times.push_back(time);
    const auto step = choose_step(loaded.info, options);
    if (!step && depth == Depth::arrays) return step.error();
    loaded.step = step ? *step : 0;
    const auto blocks = find_blocks(files, *layout, loaded.step, loaded.info);
    if (!blocks) return blocks.error();
    auto chosen = blocks->chosen(*layout, options);
    if (!chosen && depth == Depth::description) chosen = blocks->chosen(*layout, {});
    if (!chosen) return chosen.error();
    if (layout->has_base_mesh() && options.blocks.empty())
        leave_out(loaded.info, {"mesh", "constant/polyMesh",
                                fmt::format("{} of the case {} in its place; --block polyMesh (or 1) reads it",
                                            layout->regions.size() == 2 ? "a region" : "regions",
                                            layout->regions.size() == 2 ? "is read" : "are read")});
    FileInfo all_steps; // of which one is read: faults of others are not told
    const bool described = depth == Depth::description;
    if (auto announced = announce_chosen_fields(files, *layout, *chosen, described ? options.step : std::nullopt,
                                                described ? loaded.info : all_steps);
        !announced)
        return announced.error();
    if (described) return loaded;
    loaded.info.fields = std::move(all_steps.fields);
    loaded.notes = layout->notes;
    core::PatchList patch_numbers;
    for (std::size_t i = 0; i < chosen->size(); ++i) {
        if ((*chosen)[i].empty()) continue;
        auto piece =
            read_region(files, *layout, layout->regions[i], loaded.step, (*chosen)[i], options, patch_numbers, loaded);
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
