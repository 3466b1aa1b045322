// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The formats that the reader program reads, and how each is recognized. src/io/confined/loaders.cpp has its side.
#include <algorithm>
#include <array>

#include "io/process/reader_process.hpp"
#include "io/reader.hpp"

namespace isotet::io {
namespace {

using confined::Request;
using confined::Task;

using Head = std::string_view;

bool has(Head head, std::string_view text) { return head.find(text) != Head::npos; }

bool is_hdf5(Head head) { return head.starts_with("\x89HDF\r\n\x1a\n"); }
bool is_netcdf(Head head) {
    return head.size() > 3 && head.starts_with("CDF") && (head[3] == 1 || head[3] == 2 || head[3] == 5);
}

int recognizes_xdmf(Head head, std::string_view) { return has(head, "<Xdmf") ? 2 : 0; }
int recognizes_exodus(Head head, std::string_view extension) {
    if (!is_netcdf(head) && !is_hdf5(head)) return 0;
    if (has(head, "num_nodes") || has(head, "len_string") || has(head, "_nc3_strict") || has(head, "_NCProperties"))
        return 2;
    for (const std::string_view name : {".e", ".ex2", ".exo", ".exii", ".g", ".gen"})
        if (extension == name) return 1;
    return 0;
}
int recognizes_cgns(Head head, std::string_view extension) {
    if (has(head.substr(0, 64), "ADF Database Version")) return 2;
    if (!is_hdf5(head)) return 0;
    return has(head, "CGNSLibraryVersion") || has(head, "hdf5version") ? 2 : extension == ".cgns" ? 1 : 0;
}
int recognizes_med(Head head, std::string_view extension) {
    const bool named = extension == ".med" || extension == ".rmed" || extension == ".mmed";
    if (!is_hdf5(head)) return 0;
    return has(head, "INFOS_GENERALES") || has(head, "ENS_MAA") ? 2 : named ? 1 : 0;
}
int recognizes_vtkhdf(Head head, std::string_view extension) {
    if (!is_hdf5(head)) return 0;
    return has(head, "VTKHDF") ? 2 : extension == ".hdf" || extension == ".vtkhdf" ? 1 : 0;
}
int recognizes_ensight(Head head, std::string_view extension) {
    if (has(head, "FORMAT") && has(head, "type:") && has(head, "ensight")) return 2;
    return extension == ".case" || extension == ".encas" ? 1 : 0;
}
Format grid_format(std::string name, std::string title, std::vector<std::string> extensions) {
    Format format{std::move(name), std::move(title), std::move(extensions)};
    format.reads_grid = true;
    format.reader_process = true;
    return format;
}

template <class T>
Result<T> ask(Task task, std::string format, const std::string& path, const ReadOptions& options,
              const Progress& progress) {
    auto reply = confined::ask_reader_process(Request{task, std::move(format), path, options, {}}, progress);
    if (!reply) return reply.error();
    if (auto* content = std::get_if<T>(&*reply)) return std::move(*content);
    return Error{ErrorCode::internal, path + ": the reader process answered another question"};
}

Result<ReadResult> read_grid(std::string format, const std::string& path, const ReadOptions& options,
                             const Progress& progress) {
    auto reply = ask<confined::GridReply>(Task::read, std::move(format), path, options, progress);
    if (!reply) return reply.error();
    if (options.active_cells && options.active_cells->boundary) {
        StreamedBoundary& boundary = *options.active_cells->boundary;
        StreamedBoundary& found = reply->boundary;
        if (reply->is_same) found.surface = std::move(boundary.surface);
        found.of_steps = boundary.of_steps;
        found.wants_cells = boundary.wants_cells;
        boundary = std::move(found);
    }
    return std::move(reply->read);
}

struct Named {
    std::string_view name;
    int (*recognizes)(Head head, std::string_view extension);
    const char* title;
    std::vector<std::string> extensions;
};

const auto& table() {
    static const std::array<Named, 6> formats = {{
        {"exodus", recognizes_exodus, "Exodus II", {".e", ".ex2", ".exo", ".exii", ".g", ".gen"}},
        {"cgns", recognizes_cgns, "CGNS", {".cgns"}},
        {"med", recognizes_med, "MED (Salome, code_aster)", {".med", ".rmed", ".mmed"}},
        {"vtkhdf", recognizes_vtkhdf, "VTKHDF", {".hdf", ".vtkhdf"}},
        {"xdmf", recognizes_xdmf, "XDMF 2 and 3", {".xdmf", ".xmf"}},
        {"ensight", recognizes_ensight, "EnSight Gold and 6", {".case", ".encas"}},
    }};
    return formats;
}

/// GridReader holds plain functions: one pair for each row of the table.
template <std::size_t row>
GridReader reader() {
    GridReader result;
    const Named& named = table()[row];
    result.format = grid_format(std::string(named.name), named.title, named.extensions);
    result.recognizes = named.recognizes;
    result.inspect = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        return ask<FileInfo>(Task::inspect, std::string(table()[row].name), path, options, progress);
    };
    result.read = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        return read_grid(std::string(table()[row].name), path, options, progress);
    };
    result.survey = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        return ask<SurveyedGrid>(Task::survey, std::string(table()[row].name), path, options, progress);
    };
    return result;
}

template <std::size_t... rows>
std::vector<GridReader> all_readers(std::index_sequence<rows...>) {
    return {reader<rows>()...};
}

} // namespace

std::span<const GridReader> confined_readers() {
    static const std::vector<GridReader> readers =
        all_readers(std::make_index_sequence<std::tuple_size_v<std::decay_t<decltype(table())>>>());
    return readers;
}

} // namespace isotet::io
