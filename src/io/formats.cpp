// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/foreign.hpp"
#include "io/formats.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/text.hpp>

#include "base/system/descriptor.hpp"
#include "io/files/text_scanner.hpp"
#include "io/foam/read_openfoam.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet {

namespace io {

namespace {

/// Formats that are written, and surfaces that are read; grids are added by their readers.
std::vector<Format> written_formats() {
    const auto surface = [](const char* name, const char* title) {
        Format format{name, title, {std::string(".") + name}};
        format.reads_surface = format.writes_surface = true;
        return format;
    };
    std::vector<Format> formats{surface("vtp", "VTK XML surface"), surface("ply", "PLY"),        surface("stl", "STL"),
                                surface("obj", "Wavefront OBJ"),   surface("ts", "Gocad TSurf"), surface("3mf", "3MF"),
                                surface("vtk", "legacy VTK")};
    formats.back().writes_grid = true;
    for (const auto& [name, title] : {std::pair{"glb", "glTF, binary"}, {"usda", "USD, text"}}) {
        Format scene{name, title, {std::string(".") + name}};
        scene.writes_surface = true;
        formats.push_back(std::move(scene));
    }
    Format vtu{"vtu", "VTK XML unstructured grid", {".vtu"}};
    vtu.writes_grid = true;
    formats.push_back(vtu);
    return formats;
}

std::vector<const GridReader*> grid_readers() {
    std::vector<const GridReader*> result;
    for (const GridReader& reader : own_readers()) result.push_back(&reader);
#if ISOTET_IO
    for (const GridReader& reader : confined_readers()) result.push_back(&reader);
#endif
    return result;
}

std::vector<std::string> names_of_readers() {
    std::vector<std::string> names;
    for (const GridReader* reader : grid_readers()) names.push_back(reader->format.name);
    return names;
}

#if !ISOTET_IO
/// Formats that a build with isotet-reader reads: how their files begin, and what they are called.
struct NeedsReader {
    std::string_view title, begins, extensions;
};
constexpr NeedsReader need_reader[] = {
    {"an XDMF file", "<Xdmf", ".xdmf .xmf"},
    {"a NetCDF file (Exodus II)", "CDF", ".e .ex2 .exo .g"},
    {"an HDF5 file (VTKHDF, Exodus II, CGNS, MED)", "\x89HDF", ".hdf .vtkhdf .cgns .med .rmed .mmed .h5"},
};

/// What a file is that such a build would read; empty if it is none.
std::string_view title_left_out(std::string_view head, std::string_view extension) {
    for (const NeedsReader& format : need_reader) {
        if (head.starts_with(format.begins)) return format.title;
    }
    for (const NeedsReader& format : need_reader) {
        const std::size_t at = extension.empty() ? std::string_view::npos : format.extensions.find(extension);
        if (at == std::string_view::npos) continue;
        const std::size_t end = at + extension.size();
        if (end == format.extensions.size() || format.extensions[end] == ' ') return format.title;
    }
    return {};
}
#endif

/// The start of a file; of a folder nothing.
struct Head {
    std::string bytes;
    bool folder = false;
};

std::string extension_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : static_cast<char>(c);
    });
    return extension;
}

/// OpenFOAM's files that only mark where a case is; mostly empty.
bool is_marker(std::string_view extension) { return extension == ".foam" || extension == ".openfoam"; }

Result<Head> read_head(const std::string& path) {
    const auto failed = [&](std::string_view what, int number) {
        return Error{ErrorCode::file, fmt::format("{}: {}: {}", path, what, std::generic_category().message(number))};
    };
    // Without O_NONBLOCK opening a pipe would wait for a writer.
    const core::Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    if (!descriptor && path == "-")
        return Error{ErrorCode::file, "'-' would be standard input, but only files can be read"};
    if (!descriptor) return failed("cannot be opened", errno);
    struct stat status{};
    if (::fstat(descriptor.number(), &status) != 0) return failed("cannot be looked at", errno);
    if (S_ISDIR(status.st_mode)) return Head{{}, true};
    if (const auto other = core::what_else_than_a_file(status.st_mode); !other.empty()) {
        return Error{ErrorCode::file, fmt::format("{} is {}, but only files can be read", path, other)};
    }
    constexpr std::size_t of_others = 4096, of_hdf5 = 65536; // HDF5 has the first names behind its own tables
    std::string bytes(of_others, '\0');
    ssize_t count = ::pread(descriptor.number(), bytes.data(), bytes.size(), 0);
    if (count > 0 && bytes.starts_with("\x89HDF")) {
        bytes.resize(of_hdf5);
        count = ::pread(descriptor.number(), bytes.data(), bytes.size(), 0);
    }
    if (count < 0) return failed("cannot be read", errno);
    if (count == 0 && !is_marker(extension_of(path)))
        return Error{ErrorCode::file, fmt::format("{} is empty, so it is no grid", path)};
    bytes.resize(static_cast<std::size_t>(count));
    return Head{std::move(bytes), false};
}

/// "little-endian" or "big-endian" where a byte order mark says that text is UTF-16, else empty.
std::string_view utf_16_order(std::string_view bytes) {
    if (bytes.starts_with("\xff\xfe")) return "little-endian";
    if (bytes.starts_with("\xfe\xff")) return "big-endian";
    return {};
}

/// What of a folder could be read: index files before others, by name. A few of many.
std::vector<std::string> grids_in(const std::string& folder) {
    constexpr std::size_t most_looked_at = 10'000;
    const auto is_index = [](const std::string& name) {
        constexpr std::array<std::string_view, 8> endings{".pvd", ".series", ".case", ".xdmf",
                                                          ".xmf", ".foam",   ".pvtu", ".vtm"};
        return std::ranges::find(endings, extension_of(name)) != endings.end();
    };
    std::vector<std::string> names;
    std::error_code failed;
    std::size_t looked_at = 0;
    for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        if (++looked_at > most_looked_at) break;
        const std::string name = entry->path().filename().string(), extension = extension_of(name);
        const auto reads = [&](const GridReader* reader) {
            return std::ranges::find(reader->format.extensions, extension) != reader->format.extensions.end();
        };
        if (!extension.empty() && std::ranges::any_of(grid_readers(), reads)) names.push_back(name);
    }
    std::ranges::sort(names, [&](const std::string& a, const std::string& b) {
        return is_index(a) != is_index(b) ? is_index(a) : comes_before(a, b);
    });
    return names;
}

/// A file or folder of a case of OpenFOAM that is not read alone, as 100/T; nothing for others.
std::optional<Error> part_of_case(const std::string& path) {
    constexpr int deepest = 4; // constant/REGION/polyMesh/faces
    std::error_code failed;
    std::string folder = std::filesystem::weakly_canonical(path, failed).string();
    for (int level = 0; level < deepest && !failed; ++level) {
        const std::string above = std::filesystem::path(folder).parent_path().string();
        if (above.empty() || above == folder) break;
        folder = above;
        if (is_openfoam_case(folder))
            return Error{ErrorCode::file,
                         fmt::format("{} is a part of a case of OpenFOAM, which is read as a whole: {}", path, folder)};
    }
    return std::nullopt;
}

Error not_a_case(const std::string& folder) {
    constexpr std::size_t most_named = 6;
    if (auto part = part_of_case(folder)) return *std::move(part);
    std::vector<std::string> names = grids_in(folder);
    const std::string what = fmt::format("{} is a folder, but no case of OpenFOAM", folder);
    if (names.empty()) return {ErrorCode::file, what + ", and no grid is in it"};
    const std::size_t more = names.size() - std::min(names.size(), most_named);
    names.resize(names.size() - more);
    for (std::string& name : names) name = in_quotes(name);
    return {ErrorCode::file,
            fmt::format("{}; in it {} {}{}", what, names.size() + more == 1 ? "is" : "are", fmt::join(names, ", "),
                        more > 0 ? fmt::format(" and {} more", more) : std::string())};
}

/// What a file is that holds no grid itself: a packed one, or a pointer to one. Empty if none.
std::string_view wrapping_of(std::string_view head) {
    struct Wrapping {
        std::string_view begins, what;
    };
    using namespace std::string_view_literals;
    constexpr std::array wrappings{
        Wrapping{"\x1f\x8b"sv, "is packed by gzip: unpack it first"},
        Wrapping{"BZh"sv, "is packed by bzip2: unpack it first"},
        Wrapping{"\xFD"
                 "7zXZ"sv,
                 "is packed by xz: unpack it first"},
        Wrapping{"\x28\xB5\x2F\xFD"sv, "is packed by zstd: unpack it first"},
        Wrapping{"PK\x03\x04"sv, "is a ZIP archive: unpack it first"},
        Wrapping{"version https://git-lfs"sv, "is a pointer of Git LFS: the data were not fetched (git lfs pull)"}};
    for (const Wrapping& wrapping : wrappings)
        if (head.starts_with(wrapping.begins)) return wrapping.what;
    return {};
}

bool is_named_for(const GridReader& reader, std::string_view extension) {
    const auto& extensions = reader.format.extensions;
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

/// The reader that the name stands for, where the content tells nothing. Null without one.
const GridReader* named_reader(const std::vector<const GridReader*>& readers, const Head& head,
                               std::string_view extension) {
    if (head.folder || !foreign_file(head.bytes, extension).empty()) return nullptr; // AVS UCD and Abaqus share a name
    const auto named =
        std::ranges::find_if(readers, [&](const GridReader* reader) { return is_named_for(*reader, extension); });
    return named == readers.end() ? nullptr : *named;
}

Error nobody_knows(const std::string& path, const Head& head, const std::string& extension) {
    const std::string seen =
        head.folder ? "it is a folder" : "it begins with " + in_quotes(std::string_view(head.bytes).substr(0, 20));
#if !ISOTET_IO
    if (const auto title = title_left_out(head.bytes, extension); !title.empty()) {
        return {
            ErrorCode::file,
            fmt::format("{} is {}, but this isotet was built without isotet-reader (ISOTET_IO=OFF) and reads {} only",
                        path, title, fmt::join(names_of_readers(), ", "))};
    }
#endif
    if (head.bytes.find("FoamFile") != std::string::npos)
        if (auto part = part_of_case(path)) return *std::move(part);
    if (const auto is = foreign_file(head.bytes, extension); !is.empty())
        return {ErrorCode::file, fmt::format("{} {}", path, is)};
    if (const auto type = vtk_xml::type_of(head.bytes); !type.empty())
        return {ErrorCode::file, fmt::format("{} is a VTK file of type {}, which is not read", path, in_quotes(type))};
    return {ErrorCode::file,
            fmt::format("{} has no format that isotet reads: {}, its name {}; formats are {}", path, seen,
                        extension.empty() ? "has no extension" : "ends in " + in_quotes(extension),
                        fmt::join(names_of_readers(), ", "))};
}

} // namespace

Result<const GridReader*> choose_reader(const std::string& path, const ReadOptions& options) {
    const auto readers = grid_readers();
    if (!options.format.empty()) {
        for (const GridReader* reader : readers) {
            if (reader->format.name == options.format) return reader;
        }
        return Error{ErrorCode::invalid_argument,
                     fmt::format("format {} is not one that isotet reads; formats are {}", in_quotes(options.format),
                                 fmt::join(nearest_first(options.format, names_of_readers()), ", "))};
    }
    const auto head = read_head(path);
    if (!head) return head.error();
    const std::string extension = extension_of(path);
    if (const auto order = utf_16_order(head->bytes); !order.empty() && extension != ".pvd") // XML may be UTF-16
        return Error{
            ErrorCode::file,
            fmt::format("{} is text in UTF-16 ({}), as PowerShell's > writes it, but isotet reads UTF-8: write it "
                        "again with Out-File -Encoding utf8, or by iconv -f UTF-16 -t UTF-8",
                        path, order)};
    const std::string_view text = without_byte_order_mark(head->bytes);
    const bool is_case = head->folder && is_openfoam_case(path);
    if (head->folder && !is_case && options.format.empty()) return not_a_case(path);
    const GridReader* best = nullptr;
    int best_score = 0;
    for (const GridReader* reader : readers) {
        if (is_case && reader->format.name == "openfoam") return reader;
        const int recognized = reader->recognizes(text, extension);
        const int score = 2 * recognized + (recognized > 0 && is_named_for(*reader, extension) ? 1 : 0);
        if (score > best_score) {
            best = reader;
            best_score = score;
        }
    }
    constexpr int by_content = 4;
    if (const auto wrapping = wrapping_of(head->bytes); best_score < by_content && !wrapping.empty())
        return Error{ErrorCode::file, fmt::format("{} {}", path, wrapping)};
    if (const auto is = foreign_content(head->bytes, extension); best_score < by_content && !is.empty())
        return Error{ErrorCode::file, fmt::format("{} {}", path, is)}; // many programs share the ending .msh
    if (!best) best = named_reader(readers, *head, extension);
    if (!best) return nobody_knows(path, *head, extension);
    return best;
}

} // namespace io

std::vector<Format> formats() {
    std::vector<Format> result;
    for (const io::GridReader* reader : io::grid_readers()) result.push_back(reader->format);
    for (const Format& written : io::written_formats()) {
        const auto same =
            std::find_if(result.begin(), result.end(), [&](const Format& f) { return f.name == written.name; });
        if (same == result.end()) {
            result.push_back(written);
            continue;
        }
        same->writes_grid = same->writes_grid || written.writes_grid;
        same->reads_surface = same->reads_surface || written.reads_surface;
        same->writes_surface = same->writes_surface || written.writes_surface;
    }
    return result;
}

} // namespace isotet
