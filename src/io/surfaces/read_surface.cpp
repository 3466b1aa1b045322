// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// read_surface(): the content decides the format, then the name.
#include <isotet/read.hpp>

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "base/rising_progress.hpp"
#include "io/files/file_ending.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/whole_file.hpp"
#include "io/files/zip.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet {
namespace io {
namespace {

constexpr std::array<std::string_view, 7> format_names{"vtp", "ply", "stl", "obj", "vtk", "ts", "3mf"};
constexpr std::size_t head_bytes = 4096;

bool starts_with_word(std::string_view text, std::string_view word) {
    return text.starts_with(word) && (text.size() == word.size() || is_space(text[word.size()]));
}

std::string_view without_leading_space(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    return text;
}

/// OBJ has no magic word: its first line that is no comment must start with one of its keywords.
bool looks_like_obj(std::string_view head) {
    constexpr std::array<std::string_view, 10> keywords{"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl", "l"};
    TextScanner scanner(head, '#');
    const auto word = scanner.word();
    return std::ranges::find(keywords, word) != keywords.end();
}

Result<Surface> parse_as(std::string_view format, std::string_view content, SurfaceFile& file,
                         const Progress& progress) {
    if (format == "stl") return parse_stl(content, progress); // the length of binary ones counts every byte
    content = without_byte_order_mark(content);
    if (format == "vtp") return parse_vtp(content, file.notes, file.field_data, progress);
    if (format == "ply") return parse_ply(content, progress);
    if (format == "obj") return parse_obj(content, progress);
    if (format == "vtk") return parse_legacy_vtk(content, file.field_data, progress);
    if (format == "3mf") return parse_3mf(content, file.notes, progress);
    return parse_ts(content, progress);
}

} // namespace

std::string_view recognize_surface(std::string_view content, std::string_view ending) {
    const auto head = content.substr(0, head_bytes);
    if (is_zip(head)) return "3mf";
    const auto text = without_leading_space(without_byte_order_mark(head));
    if (starts_with_word(text, "ply")) return "ply";
    if (text.starts_with("# vtk DataFile")) return "vtk";
    if (text.starts_with("<") && text.find("<VTKFile") != std::string_view::npos) return "vtp";
    if (starts_with_word(text, "GOCAD")) return "ts";
    if (starts_with_word(text, "solid")) return "stl";
    if (const auto* known = std::ranges::find(format_names, ending); known != format_names.end()) return *known;
    return looks_like_obj(text) ? "obj" : std::string_view();
}

Result<SurfaceFile> parse_surface(std::string_view content, std::string_view ending, std::string_view format,
                                  const Progress& progress) {
    try {
        const auto chosen = format.empty() ? recognize_surface(content, ending) : format;
        if (std::ranges::find(format_names, chosen) == format_names.end()) {
            const auto all = fmt::format("{}", fmt::join(format_names, ", "));
            if (format.empty()) {
                return Error{ErrorCode::file,
                             fmt::format("neither content nor name is that of a surface file ({}): it starts with {}",
                                         all, in_quotes(content.substr(0, 16)))};
            }
            return Error{ErrorCode::invalid_argument,
                         fmt::format("the format {} is none of a surface: {}", in_quotes(format), all)};
        }
        SurfaceFile file;
        file.format = chosen;
        auto surface = parse_as(chosen, content, file, progress);
        if (!surface) return surface.error();
        file.surface = *std::move(surface);
        return file;
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "no memory left to read a surface"};
    } catch (const std::exception& exception) {
        return Error{ErrorCode::internal, exception.what()};
    } catch (...) { // by a callback of the caller
        return Error{ErrorCode::internal, "something was thrown that is no std::exception"};
    }
}

} // namespace io

Result<SurfaceFile> read_surface(const std::string& path, const ReadSurfaceOptions& options, const Run& run) {
    const Progress rises = core::rising(run.progress);
    const auto file = io::WholeFile::read(path, rises);
    if (!file) return file.error();
    auto surface = io::parse_surface(file->text(), io::ending_of(path), options.format, rises);
    if (surface) {
        rises("read", 1.0);
        return surface;
    }
    Error error = std::move(surface).error();
    if (error.code != ErrorCode::cancelled && error.code != ErrorCode::invalid_argument)
        error.message = fmt::format("{}: {}", path, error.message);
    return error;
}

} // namespace isotet
