// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The readers that are always there: what they are called, what their files look like, which files they open.
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/kept_files.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/whole_file.hpp"
#include "io/foam/read_openfoam.hpp"
#include "io/frd/read_frd.hpp"
#include "io/gmsh/read_gmsh.hpp"
#include "io/gocad/read_gocad.hpp"
#include "io/grdecl/read_grdecl.hpp"
#include "io/medit/read_medit.hpp"
#include "io/medit/read_medit_parts.hpp"
#include "io/packed/read_isotet.hpp"
#include "io/reader.hpp"
#include "io/tetgen/read_tetgen.hpp"
#include "io/ucd/read_ucd.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet::io {

namespace {

/// Errors about content say in which file.
template <class Value>
Result<Value> in_file(const std::string& path, Result<Value> result) {
    if (result || result.error().code != ErrorCode::invalid_data) return result;
    return Error{ErrorCode::invalid_data, path + ": " + result.error().message};
}

int by_content_or_name(bool content, bool name) { return content ? 2 : name ? 1 : 0; }

std::string in_case(std::string text, int (*change)(int)) {
    for (char& c : text) c = static_cast<char>(change(static_cast<unsigned char>(c)));
    return text;
}

bool is_there(const std::string& path) {
    struct stat status{};
    return ::stat(path.c_str(), &status) == 0;
}

/// The file of the same name with another extension, in lower case, or else in upper case.
std::string beside(const std::string& path, const char* extension) {
    const std::filesystem::path own(path);
    if (in_case(own.extension().string(), std::tolower) == extension) return path;
    const auto named = [&](const std::string& end) {
        return std::filesystem::path(own).replace_extension(end).string();
    };
    if (const std::string upper = named(in_case(extension, std::toupper));
        !is_there(named(extension)) && is_there(upper))
        return upper;
    return named(extension);
}

/// A file that is read because it has the name of `path`, with another extension: links must not lead it out of the folder.
Result<void> check_companion(const std::string& path, const std::string& companion, const ReadOptions& options) {
    if (options.allow_outside || companion == path) return {};
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path parent = fs::path(path).parent_path();
    const fs::path folder = fs::canonical(parent.empty() ? fs::path(".") : parent, error);
    const fs::path file = fs::canonical(companion, error);
    if (error) return {}; // opening it tells
    if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end()) return {};
    return Error{ErrorCode::invalid_data,
                 fmt::format("{} is a link to {}: only files below the folder of {} are read, unless "
                             "`allow_outside` is given",
                             escaped(companion), escaped(file.string()), escaped(path))};
}

/// Enough for what a file says before its first points.
constexpr std::size_t head_bytes = std::size_t{16} << 20;

template <class Value, class Parse>
Result<Value> with_file(const std::string& path, const Result<WholeFile>& file, const Parse& parse) {
    if (!file) return file.error();
    return in_file<Value>(path, parse(without_byte_order_mark(file->text())));
}

int recognizes_gmsh(std::string_view head, std::string_view extension) {
    const std::string_view first = TextScanner(head).word();
    const bool content =
        first == "$MeshFormat" || first == "$NOD" || head.find("\n$MeshFormat") != std::string_view::npos;
    return by_content_or_name(content, extension == ".msh");
}

Result<FileInfo> inspect_gmsh_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    constexpr std::size_t small_bytes = std::size_t{1} << 20;
    const auto source = ByteSource::open(path);
    if (source && source->size() > small_bytes) {
        const auto heads = heads_of_gmsh(*source, !options.kept, progress);
        if (!heads) return heads.error();
        if (*heads) return in_file<FileInfo>(path, inspect_gmsh(**heads, progress, options.step));
    }
    return with_file<FileInfo>(path, look_into_file(path, options, progress),
                               [&](std::string_view text) { return inspect_gmsh(text, progress, options.step); });
}

/// The files that Gmsh wrote beside this one, each of one partition: name_1.msh, name_2.msh and so on; the first of them.
std::optional<std::string> other_partition(const std::string& path) {
    const std::filesystem::path whole(path);
    const std::string stem = whole.stem().string();
    const std::size_t bar = stem.rfind('_');
    if (bar == std::string::npos || bar + 1 == stem.size() ||
        stem.find_first_not_of("0123456789", bar + 1) != std::string::npos)
        return std::nullopt;
    for (const char* number : {"1", "2"}) {
        const auto other = stem.substr(0, bar + 1) + number + whole.extension().string();
        if (other != whole.filename() && is_there((whole.parent_path() / other).string())) return other;
    }
    return std::nullopt;
}

Result<ReadResult> read_gmsh_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    auto result = with_file<ReadResult>(path, take_file(path, options, progress),
                                        [&](std::string_view text) { return parse_gmsh(text, options, progress); });
    if (!result ||
        std::ranges::find(result->info.fields, "gmsh:partition", &FieldInfo::name) == result->info.fields.end())
        return result;
    if (const auto other = other_partition(path))
        result->notes.push_back(
            fmt::format("the mesh was saved in a file for each partition: {} and others of the name "
                        "are not read",
                        escaped(*other)));
    return result;
}

int recognizes_medit(std::string_view head, std::string_view extension) {
    const bool named = (extension == ".mesh" || extension == ".meshb") && !head.starts_with("MFEM "); // MFEM's own
    return by_content_or_name(medit::looks_like_medit(head), named);
}

/// The .sol or .solb beside a mesh, the kind that fits the mesh first.
std::optional<std::string> solution_beside(const std::string& path) {
    const bool binary = std::filesystem::path(path).extension() == ".meshb";
    for (const char* extension : {binary ? ".solb" : ".sol", binary ? ".sol" : ".solb"}) {
        if (std::string solution = beside(path, extension); is_there(solution)) return solution;
    }
    return std::nullopt;
}

void add_file(FileInfo& info, const std::string& file) { info.files.push_back(file); }
void add_file(ReadResult& result, const std::string& file) { result.info.files.push_back(file); }

/// How a file is opened: looked into, or taken whole.
using OpenFile = Result<WholeFile> (*)(const std::string& path, const ReadOptions& options, const Progress& progress);

Result<WholeFile> look_into_beginning(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return look_into_file(path, options, progress, head_bytes);
}

Result<WholeFile> look_into_whole(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return look_into_file(path, options, progress);
}

template <class Value, class Parse>
Result<Value> with_mesh_and_solution(const std::string& path, const ReadOptions& options, const Progress& progress,
                                     OpenFile open_mesh, OpenFile open_solution, const Parse& parse) {
    const auto solution_path = solution_beside(path);
    if (!solution_path)
        return with_file<Value>(path, open_mesh(path, options, progress),
                                [&](std::string_view mesh) { return parse(mesh, std::nullopt); });
    if (auto allowed = check_companion(path, *solution_path, options); !allowed) return allowed.error();
    const auto solution = open_solution(*solution_path, options, progress);
    if (!solution) return solution.error();
    auto result = with_file<Value>(path, open_mesh(path, options, progress), [&](std::string_view mesh) {
        return parse(mesh, std::optional(without_byte_order_mark(solution->text())));
    });
    if (result) add_file(*result, *solution_path);
    return result;
}

using OptionalText = std::optional<std::string_view>;

Result<FileInfo> inspect_medit_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_mesh_and_solution<FileInfo>(
        path, options, progress, look_into_beginning, look_into_whole,
        [&](std::string_view mesh, OptionalText solution) { return inspect_medit(mesh, solution, progress); });
}

Result<ReadResult> read_medit_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_mesh_and_solution<ReadResult>(
        path, options, progress, take_file, take_file,
        [&](std::string_view mesh, OptionalText solution) { return parse_medit(mesh, solution, options, progress); });
}

/// TetGen's files are bare numbers: only the name tells.
int recognizes_tetgen(std::string_view, std::string_view extension) {
    return by_content_or_name(false, extension == ".node" || extension == ".ele");
}

template <class Value, class Parse>
Result<Value> with_nodes_and_elements(const std::string& path, const ReadOptions& options, const Progress& progress,
                                      OpenFile open, const Parse& parse) {
    for (const char* extension : {".node", ".ele"}) {
        const std::string file = beside(path, extension);
        if (auto allowed = check_companion(path, file, options); !allowed) return allowed.error();
        if (file != path && !is_there(file))
            return Error{ErrorCode::file,
                         fmt::format("{}: its other file {} is not there: TetGen has points in a .node "
                                     "file, tets in an .ele file of the same name",
                                     escaped(path), escaped(file))};
    }
    const auto nodes = open(beside(path, ".node"), options, progress);
    if (!nodes) return nodes.error();
    const auto elements = open(beside(path, ".ele"), options, progress);
    if (!elements) return elements.error();
    auto result =
        in_file<Value>(path, parse(without_byte_order_mark(nodes->text()), without_byte_order_mark(elements->text())));
    for (const char* extension : {".node", ".ele"})
        if (result) add_file(*result, beside(path, extension));
    return result;
}

Result<FileInfo> inspect_tetgen_files(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_nodes_and_elements<FileInfo>(
        path, options, progress, look_into_beginning,
        [&](std::string_view nodes, std::string_view elements) { return inspect_tetgen(nodes, elements, progress); });
}

Result<ReadResult> read_tetgen_files(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_nodes_and_elements<ReadResult>(path, options, progress, take_file,
                                               [&](std::string_view nodes, std::string_view elements) {
                                                   return parse_tetgen(nodes, elements, options, progress);
                                               });
}

int recognizes_gocad(std::string_view head, std::string_view extension) {
    TextScanner scanner(head, '#');
    const bool content = scanner.word() == "GOCAD" && scanner.word_of_line() == "TSolid";
    return by_content_or_name(content, extension == ".so");
}

Result<FileInfo> inspect_gocad_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_file<FileInfo>(path, look_into_beginning(path, options, progress),
                               [&](std::string_view text) { return inspect_gocad(text, progress); });
}

Result<ReadResult> read_gocad_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_file<ReadResult>(path, take_file(path, options, progress),
                                 [&](std::string_view text) { return parse_gocad(text, options, progress); });
}

int recognizes_frd(std::string_view head, std::string_view extension) {
    return by_content_or_name(looks_like_frd(head), extension == ".frd");
}

Result<FileInfo> inspect_frd_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_file<FileInfo>(path, look_into_file(path, options, progress),
                               [&](std::string_view text) { return inspect_frd(text, progress); });
}

Result<ReadResult> read_frd_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_file<ReadResult>(path, take_file(path, options, progress),
                                 [&](std::string_view text) { return parse_frd(text, options, progress); });
}

/// Abaqus uses the first ending, too.
int recognizes_ucd(std::string_view head, std::string_view extension) {
    return (extension == ".inp" || extension == ".avs" || extension == ".ucd") && looks_like_ucd(head) ? 2 : 0;
}

Result<FileInfo> inspect_ucd_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_file<FileInfo>(path, look_into_file(path, options, progress),
                               [&](std::string_view text) { return inspect_ucd(text, progress); });
}

Result<ReadResult> read_ucd_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    return with_file<ReadResult>(path, take_file(path, options, progress),
                                 [&](std::string_view text) { return parse_ucd(text, options, progress); });
}

Format grid_format(const char* name, const char* title, std::vector<std::string> extensions) {
    Format format{name, title, std::move(extensions)};
    format.reads_grid = true;
    return format;
}

} // namespace

std::span<const GridReader> own_readers() {
    static const std::vector<GridReader> readers = [] {
        std::vector<GridReader> all = vtk_xml_readers();
        all.push_back(series_reader());
        all.push_back(legacy_vtk_reader());
        all.push_back(openfoam_reader());
        all.push_back(grdecl_reader());
        all.push_back(isotet_reader());
        all.insert(all.end(), {
                                  GridReader{grid_format("gmsh", "Gmsh MSH 1.0 to 4.1", {".msh"}), recognizes_gmsh,
                                             inspect_gmsh_file, read_gmsh_file},
                                  GridReader{grid_format("medit", "Medit mesh with its .sol", {".mesh", ".meshb"}),
                                             recognizes_medit, inspect_medit_file, read_medit_file},
                                  GridReader{grid_format("tetgen", "TetGen .node and .ele", {".node", ".ele"}),
                                             recognizes_tetgen, inspect_tetgen_files, read_tetgen_files},
                                  GridReader{grid_format("gocad", "Gocad TSolid", {".so"}), recognizes_gocad,
                                             inspect_gocad_file, read_gocad_file},
                                  GridReader{grid_format("frd", "CalculiX results", {".frd"}), recognizes_frd,
                                             inspect_frd_file, read_frd_file},
                                  GridReader{grid_format("ucd", "AVS UCD", {".inp", ".avs", ".ucd"}), recognizes_ucd,
                                             inspect_ucd_file, read_ucd_file},
                              });
        return all;
    }();
    return readers;
}

} // namespace isotet::io
