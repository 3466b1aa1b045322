// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/load.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/system/block.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/files/index_file.hpp"
#include "io/files/kept_files.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/reader.hpp"

namespace isotet::io::vtk_xml {
namespace {

/// Arrays whose stated length is not that of their data, but whose data is as long as it has to be.
void note_odd_lengths(const Document& document, std::vector<std::string>& notes) {
    if (document.odd_lengths.empty()) return;
    std::vector<std::string> names;
    for (const std::string& name : document.odd_lengths) names.push_back(in_quotes(name));
    notes.push_back(fmt::format("the stated length of {} is wrong, but as many values are there as must be: they were "
                                "read",
                                fmt::join(names, ", ")));
}

/// Such arrays have perhaps lost their number of components, so that what is read of them is not what is meant.
void note_longer(const Document& document, std::vector<std::string>& notes) {
    if (document.longer.empty()) return;
    notes.push_back(fmt::format("there are more values of {} than are announced: the first ones were read",
                                fmt::join(document.longer, ", ")));
}

Array no_points() { return {ScalarType::float32, nullptr, 0, 3, nullptr}; }

/// What a process without cells writes that leaves out the Piece, too.
Loaded without_pieces(Depth depth) {
    Loaded loaded;
    if (depth == Depth::arrays) loaded.pieces.emplace_back().grid.points = no_points();
    return loaded;
}

/// Describes the document, and reads the grid of the step that is wanted.
Result<Loaded> load_document(const std::shared_ptr<Document>& shared, const std::string& path,
                             const ReadOptions& options, Depth depth, bool ids, const Progress& progress) {
    Document& document = *shared;
    const bool unstructured = document.type == "UnstructuredGrid";
    if (unstructured && !document.primary().child("Piece")) return without_pieces(depth);
    const auto layouts = unstructured ? layouts_of_unstructured(document) : layouts_of_structured(document);
    if (!layouts) return layouts.error();
    const auto cells = unstructured ? Result<std::uint64_t>(layouts->cells.total) : count_structured(document);
    if (!cells) return cells.error();
    Loaded loaded;
    if (auto told = announce_fields(document, *layouts, options, progress, loaded); !told) return told.error();
    loaded.info.cells = *cells;
    if (depth == Depth::description) {
        if (unstructured) loaded.info.least = least_of_unstructured(document, *layouts, loaded.step);
        return loaded;
    }
    const Wanted wanted{options, loaded.step, ids, path};
    if (unstructured) {
        auto pieces = load_unstructured(shared, *layouts, wanted, progress, loaded);
        if (!pieces) return pieces.error();
        loaded.pieces = *std::move(pieces);
    } else {
        auto piece = load_structured(document, wanted, progress, loaded);
        if (!piece) return piece.error();
        loaded.pieces.push_back(std::move(*piece));
    }
    for (Piece& piece : loaded.pieces)
        if (piece.grid.points.empty()) piece.grid.points = no_points();
    note_odd_lengths(document, loaded.notes);
    note_longer(document, loaded.notes);
    return loaded;
}

/// The first place of an attribute in a tag, with its quoted value behind it.
std::string_view attribute_of(std::string_view tag, std::string_view name) {
    for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
        std::size_t next = tag.find_first_not_of(" \t\r\n", at + name.size());
        if (at == 0 || !is_space(tag[at - 1]) || next == std::string_view::npos || tag[next] != '=') continue;
        next = tag.find_first_not_of(" \t\r\n", next + 1);
        if (next == std::string_view::npos || (tag[next] != '"' && tag[next] != '\'')) return {};
        const std::size_t end = tag.find(tag[next], next + 1);
        return end == std::string_view::npos ? std::string_view() : tag.substr(next + 1, end - next - 1);
    }
    return {};
}

/// Tags that stand between arrays are looked for in all of the file.
bool has_inline_data(std::string_view head) { return head.find("appended") == std::string_view::npos; }

/// The time of all files that have one, if it is the same.
std::vector<double> common_time(std::span<const Loaded> parts) {
    std::vector<double> common;
    for (const Loaded& part : parts) {
        const std::vector<double>& times = part.info.times;
        if (times.empty()) continue;
        if (times.size() > 1 || (!common.empty() && common != times)) return {};
        common = times;
    }
    return common;
}

} // namespace

std::string_view type_of(std::string_view head) {
    const auto root = head.find("<VTKFile");
    if (root == std::string_view::npos) return {};
    return attribute_of(head.substr(root, head.find('>', root) - root), "type");
}

Result<Loaded> load(const ByteSource& source, std::string_view type, const ReadOptions& options, Depth depth, bool ids,
                    const Progress& progress, const std::string& path) {
    auto opened = open_document(source, progress);
    if (!opened) return opened.error();
    const auto document = std::make_shared<Document>(*std::move(opened));
    if (document->type != type)
        return invalid_data(
            fmt::format("this is a VTK file of type {}, not {}", in_quotes(document->type), in_quotes(type)));
    if (!document->primary()) return invalid_data(fmt::format("there is no element {}", type));
    auto loaded = load_document(document, path, options, depth, ids, progress);
    document->source = ByteSource(std::string_view()); // cells that are read later hold it, or open the file again
    return loaded;
}

Result<Loaded> load_file(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                         bool ids, const Progress& progress) {
    const auto source = open_source(path, options, progress, has_inline_data);
    if (!source) return source.error();
    auto loaded = load(*source, type, options, depth, ids, progress, path);
    if (!loaded) return in_file(path, loaded.error());
    for (Piece& piece : loaded->pieces)
        piece.name = piece.name.empty() ? path : fmt::format("{}, {}", path, piece.name);
    return loaded;
}

Result<std::vector<Loaded>> load_files(std::span<const File> files, const ReadOptions& options,
                                       const Progress& progress) {
    constexpr std::size_t many = 8, prepared = std::size_t{64} << 20;
    if (files.size() >= many && files.front().depth == Depth::arrays) core::prepare_blocks(prepared);
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
    constexpr std::string_view of_one = "a structured grid of ";
    std::uint64_t structured = 0, hexahedra = 0;
    for (const Loaded& part : parts) {
        if (std::ranges::none_of(part.notes, [&](const std::string& note) { return note.starts_with(of_one); }))
            continue;
        ++structured;
        hexahedra += part.info.cells;
    }
    Loaded whole;
    whole.info.times = common_time(parts);
    for (Loaded& part : parts) append(whole, std::move(part));
    if (structured < 2) return whole;
    std::erase_if(whole.notes, [&](const std::string& note) { return note.starts_with(of_one); });
    whole.notes.push_back(fmt::format("{} structured grids were read as {} hexahedra", structured, hexahedra));
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
    auto parts = load_files(pieces, options, progress);
    if (!parts) return parts.error();
    if (auto left_out = leave_out_overlaps(*parts); !left_out) return in_file(path, left_out.error());
    Loaded loaded = put_together(std::move(*parts));
    loaded.info.files = std::move(*files);
    return loaded;
}

} // namespace isotet::io::vtk_xml
