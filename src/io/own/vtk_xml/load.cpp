// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/vtk_xml/load.hpp"

#include <fmt/core.h>

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "io/own/first_error.hpp"
#include "io/own/index_file.hpp"
#include "io/own/pace.hpp"
#include "io/own/text_scanner.hpp"
#include "io/reader.hpp"

namespace isotet::io::vtk_xml {
namespace {

/// Announces, and lets `load_piece(wanted)` read the grid of the step that is wanted.
template <class LoadPiece>
Result<Loaded> announced(Document& document, const ReadOptions& options, Depth depth, bool ids,
                         const Progress& progress, const LoadPiece& load_piece) {
    Loaded loaded;
    if (auto told = announce_fields(document, progress, loaded.info); !told) return told.error();
    const auto cells = document.type == "UnstructuredGrid" ? count_unstructured(document) : count_structured(document);
    if (!cells) return cells.error();
    loaded.cells = *cells;
    if (depth == Depth::description) return loaded;
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    auto piece = load_piece(Wanted{options, *step, ids}, loaded);
    if (!piece) return piece.error();
    if (piece->grid.points.empty()) piece->grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    loaded.pieces.push_back(std::move(*piece));
    return loaded;
}

} // namespace

std::string_view type_of(std::string_view head) {
    const auto root = head.find("<VTKFile");
    if (root == std::string_view::npos) return {};
    std::string_view element = head.substr(root, head.find('>', root) - root);
    const auto type = element.find(" type=");
    if (type == std::string_view::npos || element.size() < type + 8) return {};
    const char quote = element[type + 6];
    element.remove_prefix(type + 7);
    return element.substr(0, element.find(quote));
}

Result<Loaded> load(const ByteSource& source, std::string_view type, const ReadOptions& options, Depth depth, bool ids,
                    const Progress& progress) {
    auto document = open_document(source, progress);
    if (!document) return document.error();
    if (document->type != type)
        return invalid_data(
            fmt::format("this is a VTK file of type {}, not {}", in_quotes(document->type), in_quotes(type)));
    if (!document->primary()) return invalid_data(fmt::format("there is no element {}", type));
    return announced(*document, options, depth, ids, progress, [&](const Wanted& wanted, Loaded& loaded) {
        if (type == "UnstructuredGrid") return load_unstructured(*document, wanted, progress);
        return load_structured(*document, wanted, progress, loaded.notes);
    });
}

Result<Loaded> load_file(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                         bool ids, const Progress& progress) {
    const auto source = ByteSource::open(path);
    if (!source) return source.error();
    auto loaded = load(*source, type, options, depth, ids, progress);
    if (!loaded) return in_file(path, loaded.error());
    for (Piece& piece : loaded->pieces) piece.name = path;
    return loaded;
}

Result<std::vector<Loaded>> load_files(std::span<const File> files, const ReadOptions& options,
                                       const Progress& progress) {
    std::vector<Loaded> parts(files.size());
    FirstError failed;
    core::parallel_each(files.size(), 1, [&](std::size_t i) {
        auto part = load_file(files[i].path, files[i].type, options, files[i].depth, true, progress);
        if (part) parts[i] = std::move(*part);
        else failed.add(i, part.error());
    });
    if (auto done = failed.result(); !done) return done.error();
    return parts;
}

Loaded put_together(std::vector<Loaded> parts) {
    std::uint64_t structured = 0, hexahedra = 0;
    for (const Loaded& part : parts) {
        if (part.notes.empty()) continue;
        ++structured;
        hexahedra += part.cells;
    }
    Loaded whole;
    for (Loaded& part : parts) append(whole, std::move(part));
    if (structured > 1)
        whole.notes = {fmt::format("{} structured grids were read as {} hexahedra", structured, hexahedra)};
    return whole;
}

Result<std::vector<std::string>> files_of_pieces(const std::string& path, std::string_view type, bool allow_outside,
                                                 const Progress& progress) {
    const auto source = ByteSource::open(path);
    if (!source) return source.error();
    const auto document = open_document(*source, progress);
    if (!document) return broken(path, document.error().message);
    if (document->type != type)
        return broken(path,
                      fmt::format("this is a VTK file of type {}, not {}", in_quotes(document->type), in_quotes(type)));
    std::vector<std::string> files;
    for (const auto& element : document->primary().children("Piece")) {
        auto file = named_file(path, element.attribute("Source").value(), allow_outside);
        if (!file) return file.error();
        files.push_back(std::move(*file));
    }
    if (files.empty()) return broken(path, "the index names no pieces");
    return files;
}

Result<Loaded> load_pieces(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                           const Progress& progress) {
    auto files = files_of_pieces(path, type, options.allow_outside, progress);
    if (!files) return files.error();
    std::vector<File> pieces;
    for (const std::string& file : *files) pieces.push_back({file, type_of_pieces(type), depth});
    if (depth == Depth::description) pieces.resize(1); // they have the same fields
    auto parts = load_files(pieces, options, progress);
    if (!parts) return parts.error();
    if (auto left_out = leave_out_overlaps(*parts); !left_out) return in_file(path, left_out.error());
    Loaded loaded = put_together(std::move(*parts));
    loaded.info.files = std::move(*files);
    return loaded;
}

} // namespace isotet::io::vtk_xml
