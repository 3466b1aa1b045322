// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/read_isotet.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <isotet/packed_file.hpp>

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "io/packed/file_grid.hpp"

namespace isotet::io {

namespace {

int recognizes_isotet(std::string_view head, std::string_view extension) {
    return head.starts_with(packed_magic) ? 2 : extension == ".isotet" ? 1 : 0;
}

FileInfo file_info_of(const PackedDirectory& directory, std::size_t step) {
    FileInfo info;
    info.format = "isotet";
    const std::size_t steps = directory.fields.back().step + std::size_t{1};
    for (const FieldEntry& field : directory.fields) {
        if (field.step == info.times.size()) info.times.push_back(field.time == field.time ? field.time : field.step);
        if (field.step == step) info.fields.push_back({field.name, Association::point, field.type, 1});
    }
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
    const Run run{core::threads_here(), progress};
    const auto load = loader(*source, options.some_cells > 0, progress);
    if (!load) return load.error();
    std::shared_ptr<const core::Packed> cells;
    std::vector<Field> fields;
    for (const FieldEntry& field : directory.fields) {
        if (field.step != *step || !wanted(options, Association::point, field.name)) continue;
        const auto packed = (*load)(field);
        if (!packed) return packed.error();
        Result<Field> values = unpack_field(PackedGrid(*packed), run);
        if (!values) return values.error();
        fields.push_back(*std::move(values));
        cells = *packed;
    }
    if (!cells) { // no field is wanted
        const auto packed = (*load)(directory.fields.front());
        if (!packed) return packed.error();
        cells = *packed;
    }
    if (options.some_cells > 0) {
        Result<UnpackedSample> sample = unpack_sample(PackedGrid(cells), options.some_cells, run);
        if (!sample) return sample.error();
        result.grid = std::move(sample->grid);
        result.cells_in_file = sample->cells;
    } else {
        Result<Grid> grid = unpack(PackedGrid(cells), run);
        if (!grid) return grid.error();
        result.grid = *std::move(grid);
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
