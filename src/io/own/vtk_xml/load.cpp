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
    if (!loaded) return loaded.error().code == ErrorCode::invalid_data ? broken(path, loaded.error().message) : loaded;
    for (Piece& piece : loaded->pieces) piece.name = path;
    return loaded;
}

Result<Loaded> load_parallel(const std::string& path, const ReadOptions& options, Depth depth,
                             const Progress& progress) {
    const auto source = ByteSource::open(path);
    if (!source) return source.error();
    const auto document = open_document(*source, progress);
    if (!document) return broken(path, document.error().message);
    std::vector<std::string> files;
    for (const auto& element : document->primary().children("Piece")) {
        auto file = named_file(path, element.attribute("Source").value(), options.allow_outside);
        if (!file) return file.error();
        files.push_back(std::move(*file));
    }
    if (files.empty()) return broken(path, "the index names no pieces");
    Loaded loaded;
    loaded.info.files = files;
    if (depth == Depth::description) files.resize(1); // pieces have the same fields
    std::vector<Loaded> parts(files.size());
    FirstError failed;
    core::parallel_each(files.size(), 1, [&](std::size_t i) {
        auto part = load_file(files[i], "UnstructuredGrid", options, depth, true, progress);
        if (part) parts[i] = std::move(*part);
        else failed.add(i, part.error());
    });
    if (auto done = failed.result(); !done) return done.error();
    for (Loaded& part : parts) {
        for (FieldInfo& field : part.info.fields) announce(loaded.info, std::move(field));
        for (Piece& piece : part.pieces) loaded.pieces.push_back(std::move(piece));
        loaded.notes.insert(loaded.notes.end(), part.notes.begin(), part.notes.end());
    }
    return loaded;
}

} // namespace isotet::io::vtk_xml
