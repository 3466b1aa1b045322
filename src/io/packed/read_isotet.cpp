// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/read_isotet.hpp"

#include <algorithm>
#include <utility>

#include <isotet/packed_file.hpp>

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
    std::shared_ptr<const core::Packed> cells;
    const auto load = [&](const FieldEntry& field) { return whole_grid_of_file(**source, field, cells.get(), progress); };
    for (const FieldEntry& field : directory.fields) {
        if (field.step != *step || !wanted(options, Association::point, field.name)) continue;
        const auto packed = load(field);
        if (!packed) return packed.error();
        Result<Field> values = unpack_field(PackedGrid(*packed), run);
        if (!values) return values.error();
        result.grid.point_fields.push_back(*std::move(values));
        cells = *packed;
    }
    if (!cells) { // no field is wanted
        const auto packed = load(directory.fields.front());
        if (!packed) return packed.error();
        cells = *packed;
    }
    Result<Grid> grid = unpack(PackedGrid(cells), run);
    if (!grid) return grid.error();
    grid->point_fields = std::move(result.grid.point_fields);
    result.grid = *std::move(grid);
    return result;
}

} // namespace

GridReader isotet_reader() {
    Format format{"isotet", "packed grid of isotet", {".isotet"}};
    format.reads_grid = true;
    return {std::move(format), recognizes_isotet, inspect_isotet, read_isotet};
}

} // namespace isotet::io
