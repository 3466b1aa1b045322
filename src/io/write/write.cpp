// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// write_surface() and write_grid(): choose the format, make the columns, hand over.
#include <isotet/write.hpp>

#include <algorithm>
#include <array>
#include <new>
#include <span>
#include <string_view>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "base/rising_progress.hpp"
#include "io/files/file_ending.hpp"
#include "io/write/write_formats.hpp"
#include "io/write/write_names.hpp"

namespace isotet {
namespace io {
namespace {

struct SurfaceFormat {
    std::string_view name;
    Result<WriteReport> (*write)(const SurfaceToWrite&);
    bool compresses = false;
};
constexpr std::array surface_formats{SurfaceFormat{"vtp", write_vtp, true},
                                     SurfaceFormat{"ply", write_ply},
                                     SurfaceFormat{"stl", write_stl},
                                     SurfaceFormat{"obj", write_obj},
                                     SurfaceFormat{"vtk", write_legacy_surface},
                                     SurfaceFormat{"ts", write_ts},
                                     SurfaceFormat{"glb", write_glb},
                                     SurfaceFormat{"3mf", write_3mf},
                                     SurfaceFormat{"usda", write_usda}};

struct GridFormat {
    std::string_view name;
    Result<WriteReport> (*write)(const GridToWrite&);
    bool compresses = false;
};
constexpr std::array grid_formats{GridFormat{"vtu", write_vtu, true}, GridFormat{"vtk", write_legacy_grid}};

template <class Format>
Result<Format> choose(std::span<const Format> formats, const std::string& path, const WriteOptions& options,
                      std::string_view what) {
    const std::string& format = options.format;
    const std::string wanted = format.empty() ? ending_of(path) : format;
    std::string all;
    for (const auto& candidate : formats) {
        if (candidate.name == wanted && !candidate.compresses && options.compression != Compression::none)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} compression was asked for, but {} has none: {} has",
                                     name_of(options.compression), wanted, formats.front().name)};
        if (candidate.name == wanted) return candidate;
        all += fmt::format("{}{}", all.empty() ? "" : ", ", candidate.name);
    }
    return Error{ErrorCode::invalid_argument,
                 format.empty() ? fmt::format("{} has the ending \"{}\", but a {} can be written as {}", path,
                                              printable_name(wanted), what, all)
                                : fmt::format("the format \"{}\" is not one in which a {} can be written: {}",
                                              printable_name(wanted), what, all)};
}

/// Runs a writer; what it throws, for want of memory, becomes an error.
template <class F>
Result<WriteReport> guarded(const std::string& path, const Run& run, std::vector<std::string>& notes, const F& write) {
    try {
        Result<WriteReport> report = Error{};
        const Progress rises = core::rising(run.progress);
        core::with_threads(run.threads, [&] { report = write(rises); });
        if (report) report->notes = std::move(notes);
        return report;
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, fmt::format("no memory left to write {}", path)};
    } catch (const std::exception& exception) {
        return Error{ErrorCode::internal, fmt::format("{}: {}", path, exception.what())};
    } catch (...) { // by a callback of the caller
        return Error{ErrorCode::internal, path + ": something was thrown that is no std::exception"};
    }
}

} // namespace

void note_left_out(const SurfaceToWrite& input, std::string_view format,
                   const std::vector<const std::vector<Column>*>& lists) {
    std::string names;
    for (const auto* list : lists) {
        for (const auto& column : *list)
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", printable_name(column.name));
    }
    if (!names.empty()) input.notes.push_back(fmt::format("{} has no place for {}: left out", format, names));
}

} // namespace io

std::string_view name_of(Compression compression) noexcept {
    constexpr std::array<std::string_view, 3> names{"none", "zlib", "lz4"};
    return names[static_cast<std::size_t>(compression)];
}

Result<WriteReport> write_surface(const Surface& surface, const std::string& path, const WriteOptions& options,
                                  const Run& run) {
    std::vector<std::string> notes;
    return io::guarded(path, run, notes, [&](const Progress& progress) -> Result<WriteReport> {
        const auto chosen = io::choose<io::SurfaceFormat>(io::surface_formats, path, options, "surface");
        if (!chosen) return chosen.error();
        auto columns = io::columns_of(surface, notes);
        if (!columns) return columns.error();
        for (const Field& field : options.field_data)
            columns->field_data.push_back(io::column_of(field.name, field.values));
        return chosen->write({surface, *columns, path, progress, notes, options.compression});
    });
}

Result<WriteReport> write_grid(const Grid& grid, const std::string& path, const WriteOptions& options, const Run& run) {
    std::vector<std::string> notes;
    return io::guarded(path, run, notes, [&](const Progress& progress) -> Result<WriteReport> {
        const auto chosen = io::choose<io::GridFormat>(io::grid_formats, path, options, "grid");
        if (!chosen) return chosen.error();
        const auto columns = io::columns_of(grid, notes);
        if (!columns) return columns.error();
        return chosen->write({*columns, path, progress, options.compression});
    });
}

} // namespace isotet
