// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/read_isotet.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <utility>

#include <fmt/core.h>

#include <isotet/fields.hpp>
#include <isotet/packed_file.hpp>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/packed/cell_fields.hpp"
#include "io/packed/file_grid.hpp"
#include "packed/source_cells.hpp"

namespace isotet::io {

namespace {

int recognizes_isotet(std::string_view head, std::string_view extension) {
    return head.starts_with(packed_magic) ? 2 : extension == ".isotet" ? 1 : 0;
}

/// A field of a step as grids have it: of a vector three entries.
struct UserField {
    std::string name;
    std::vector<const FieldEntry*> parts;
};

std::vector<UserField> user_fields(const PackedDirectory& directory, std::size_t step) {
    std::map<std::string, const FieldEntry*> entries;
    std::vector<std::string> names;
    for (const FieldEntry& field : directory.fields) {
        if (field.step != step) continue;
        entries[field.name] = &field;
        names.push_back(field.name);
    }
    std::vector<UserField> fields;
    for (const ComponentGroup& group : joined_fields(names)) {
        UserField& field = fields.emplace_back();
        field.name = group.name;
        for (const std::string& part : group.parts) field.parts.push_back(entries[part]);
    }
    return fields;
}

FileInfo file_info_of(const PackedDirectory& directory, std::size_t step) {
    FileInfo info;
    info.format = "isotet";
    const std::size_t steps = directory.fields.back().step + std::size_t{1};
    for (const FieldEntry& field : directory.fields) {
        if (field.step == info.times.size()) info.times.push_back(field.time == field.time ? field.time : field.step);
    }
    for (const UserField& field : user_fields(directory, step))
        info.fields.push_back({field.name, Association::point, field.parts.front()->type, field.parts.size()});
    for (const CellFieldEntry* const field : cell_fields_at(directory, step))
        info.fields.push_back({field->name, Association::cell, field->type, field->components});
    if (steps == 1 && directory.fields.front().time != directory.fields.front().time) info.times.clear();
    return info;
}

Result<FileInfo> inspect_isotet(const std::string& path, const ReadOptions& options, const Progress&) {
    const auto source = PackedSource::open(path);
    if (!source) return source.error();
    FileInfo info = file_info_of((*source)->directory, options.step.value_or(0));
    if (const auto step = choose_step(info, options); !step) return step.error();
    return info;
}

/// What a step with the fields that are asked for takes as a grid: the arrays beside the packed ones that they are made of.
std::uint64_t unpacked_bytes(const PackedDirectory& d, std::size_t step, const ReadOptions& options) {
    const PackReport& report = d.report;
    const std::uint64_t cells = report.tets + report.pyramids + report.wedges + report.hexahedra;
    std::uint64_t bytes = bytes_of_whole(d, d.fields.front()) + bytes_of_unpacked(d);
    for (const UserField& field : user_fields(d, step))
        if (wanted(options, Association::point, field.name))
            bytes += d.user_points * field.parts.size() * size_of(field.parts.front()->type);
    for (const CellFieldEntry* const field : cell_fields_at(d, step))
        if (wanted(options, Association::cell, field->name)) bytes += field->bytes(cells);
    return bytes;
}

/// Tuples of an array.
Array gathered(const Array& values, std::span<const std::uint64_t> numbers) {
    const std::size_t components = values.components();
    return values.visit([&]<class T>(std::span<const T> scalars) {
        core::Buffer<T> out(numbers.size() * components);
        core::parallel_each(numbers.size(), 1 << 14, [&](std::size_t i) {
            std::copy_n(scalars.data() + numbers[i] * components, components, out.data() + i * components);
        });
        return std::move(out).to_array(components);
    });
}

/// One field of its parts.
Result<Field> joined(const std::string& name, std::vector<Field> parts) {
    if (parts.size() == 1) return std::move(parts.front());
    std::vector<std::string> names;
    for (const Field& part : parts) names.push_back(part.name);
    return gather_components(parts, name, names);
}

/// Of the unpacked cells.
Result<void> take_cell_fields(const PackedSource& source, std::size_t step, const core::Packed& packed,
                              const ReadOptions& options, Grid& grid, const Progress& progress) {
    Array cells;
    for (const CellFieldEntry* const field : cell_fields_at(source.directory, step)) {
        if (!wanted(options, Association::cell, field->name)) continue;
        const Result<Array> values = read_cell_field(source, *field, progress);
        if (!values) return values.error();
        if (cells.empty()) cells = core::source_cells_of(packed);
        grid.cell_fields.push_back({field->name, gathered(*values, cells.as<std::uint64_t>())});
    }
    return {};
}

using LoadField = std::function<Result<std::shared_ptr<const core::Packed>>(const FieldEntry&)>;

/// How the fields of a file become packed grids: whole ones that share their cells, or such as are read in parts.
Result<LoadField> loader(const std::shared_ptr<const PackedSource>& source, bool in_parts, const Progress& progress) {
    if (!in_parts)
        return LoadField([&source = *source, &progress, cells = std::shared_ptr<const core::Packed>()](
                             const FieldEntry& field) mutable -> Result<std::shared_ptr<const core::Packed>> {
            auto packed = whole_grid_of_file(source, field, cells.get(), progress);
            if (packed) cells = *packed;
            return packed;
        });
    auto store = PackedStore::open(source, core::free_memory() / 2, progress);
    if (!store) return store.error();
    return LoadField(
        [store = *store, &progress](const FieldEntry& field) { return grid_of_file(store, field, progress); });
}

Result<ReadResult> read_isotet(const std::string& path, const ReadOptions& options, const Progress& progress) {
    const auto source = PackedSource::open(path);
    if (!source) return source.error();
    const PackedDirectory& directory = (*source)->directory;
    ReadResult result;
    result.info = file_info_of(directory, options.step.value_or(0));
    const auto step = choose_step(result.info, options);
    if (!step) return step.error();
    result.step = *step;
    const Run run{.progress = progress};
    // Cell fields are by the user's cells, which a sample does not tell.
    const bool some = options.some_cells > 0 && (!options.cell_fields || options.cell_fields->empty());
    if (!some)
        if (auto fits = core::require_memory(fmt::format("all of {}, unpacked,", path),
                                             unpacked_bytes(directory, *step, options));
            !fits)
            return fits.error();
    const auto load = loader(*source, some, progress);
    if (!load) return load.error();
    std::shared_ptr<const core::Packed> cells;
    std::vector<Field> fields;
    for (const UserField& field : user_fields(directory, *step)) {
        if (!wanted(options, Association::point, field.name)) continue;
        std::vector<Field> parts;
        for (const FieldEntry* const part : field.parts) {
            const auto packed = (*load)(*part);
            if (!packed) return packed.error();
            Result<Field> values = unpack_field(PackedGrid(*packed), run);
            if (!values) return values.error();
            parts.push_back(*std::move(values));
            cells = *packed;
        }
        Result<Field> whole = joined(field.name, std::move(parts));
        if (!whole) return whole.error();
        fields.push_back(*std::move(whole));
    }
    if (!cells) { // no field is wanted
        const auto here = std::ranges::find(directory.fields, *step, &FieldEntry::step);
        const auto packed = (*load)(here == directory.fields.end() ? directory.fields.front() : *here);
        if (!packed) return packed.error();
        cells = *packed;
    }
    if (some) {
        Result<UnpackedSample> sample = unpack_sample(PackedGrid(cells), options.some_cells, run);
        if (!sample) return sample.error();
        result.grid = std::move(sample->grid);
        result.cells_in_file = sample->cells;
    } else {
        Result<Grid> grid = unpack(PackedGrid(cells), run);
        if (!grid) return grid.error();
        result.grid = *std::move(grid);
        if (directory.cell_ids) result.cell_numbers = core::source_cells_of(*cells);
        if (auto taken = take_cell_fields(**source, *step, *cells, options, result.grid, progress); !taken)
            return taken.error();
    }
    result.grid.point_fields = std::move(fields);
    return result;
}

} // namespace

GridReader isotet_reader() {
    Format format{"isotet", "packed grid of isotet", {".isotet"}};
    format.reads_grid = true;
    return {std::move(format), recognizes_isotet, inspect_isotet, read_isotet};
}

} // namespace isotet::io
