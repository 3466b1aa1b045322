// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "base/system/block.hpp"
#include "base/parallel.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::foam {

namespace {

Result<Scanner> scanner_of(const CaseFiles& files, const std::string& name) {
    auto text = files.open(name);
    if (!text) return text.error();
    Scanner scanner(std::move(*text));
    if (auto header = scanner.header(); !header) return header.error();
    return scanner;
}

/// One after another, so that the text of one is freed before the other's is read.
Result<void> read_points(const CaseFiles& files, const MeshPlace& place, Mesh& mesh) {
    auto scanner = scanner_of(files, place.points + "/points");
    if (!scanner) return scanner.error();
    auto points = scanner->tuples(3, "the points", 0);
    if (!points) return points.error();
    if (points->size() / 3 > std::numeric_limits<std::int32_t>::max())
        return scanner->fail(fmt::format("has {} points, but below 2^31 are read", points->size() / 3));
    mesh.points = std::move(*points);
    mesh.single = scanner->format().single;
    return {};
}

Result<void> read_faces(const CaseFiles& files, const MeshPlace& place, Mesh& mesh) {
    auto scanner = scanner_of(files, place.faces + "/faces");
    if (!scanner) return scanner.error();
    auto faces = scanner->faces();
    if (!faces) return faces.error();
    if (faces->count() > std::numeric_limits<std::int32_t>::max())
        return scanner->fail(fmt::format("has {} faces, but below 2^31 are read", faces->count()));
    const auto count = static_cast<std::int64_t>(mesh.point_count());
    for (std::size_t face = 0; face < faces->count(); ++face)
        for (const std::int32_t point : faces->of(face))
            if (point < 0 || point >= count)
                return broken(scanner->file().path,
                              fmt::format("face {} has point {}, but there are {} points", face, point, count));
    mesh.faces = std::move(*faces);
    return {};
}

/// The highest number, plus one.
std::size_t end_of(const std::vector<std::int32_t>& labels) {
    return labels.empty() ? 0 : static_cast<std::size_t>(1 + std::int64_t{*std::ranges::max_element(labels)});
}

Result<void> read_cells(const CaseFiles& files, const std::string& folder, Mesh& mesh) {
    const std::size_t faces = mesh.faces.count();
    auto of_owner = scanner_of(files, folder + "/owner");
    if (!of_owner) return of_owner.error();
    auto of_neighbour = scanner_of(files, folder + "/neighbour");
    if (!of_neighbour) return of_neighbour.error();
    Result<std::vector<std::int32_t>> owner = std::vector<std::int32_t>(), neighbour = std::vector<std::int32_t>();
    core::parallel_each(2, 1, [&](std::size_t which) {
        if (which == 0) owner = of_owner->labels("the cells of faces", faces);
        else neighbour = of_neighbour->labels("the cells of faces", faces);
    });
    const auto wrong_count = [&](const Scanner& scanner, std::size_t cells) {
        return broken(scanner.file().path, fmt::format("has {} cells for {} faces", cells, faces));
    };
    if (!owner) return owner.error();
    if (owner->size() != faces) return wrong_count(*of_owner, owner->size());
    if (std::ranges::find(*owner, -1) != owner->end()) return broken(of_owner->file().path, "a face has cell -1");
    if (!neighbour) return neighbour.error();
    if (neighbour->size() > faces) return wrong_count(*of_neighbour, neighbour->size());
    mesh.owner = *std::move(owner);
    mesh.neighbour = *std::move(neighbour);
    mesh.cells = std::max(end_of(mesh.owner), end_of(mesh.neighbour));
    // So memory for cells is bounded by the files.
    if (mesh.cells > mesh.owner.size() + mesh.neighbour.size())
        return broken(files.path_of(folder + "/owner"),
                      fmt::format("a face has cell {}, but {} faces cannot have so many cells", mesh.cells - 1, faces));
    mesh.neighbour.resize(faces, -1);
    return {};
}

/// "N(a b c)" or "(a b c)" behind inGroups.
std::vector<std::string> group_names(Scanner& scanner) {
    std::vector<std::string> names;
    while (scanner.peek() != '(' && scanner.peek() != ';' && !scanner.at_end()) static_cast<void>(scanner.token());
    if (!scanner.take('(')) return names;
    while (scanner.peek() != ')' && !scanner.at_end()) names.emplace_back(scanner.token());
    static_cast<void>(scanner.take(')'));
    return names;
}

Result<Patch> read_patch(Scanner& scanner) {
    Patch patch;
    patch.name = scanner.token();
    if (auto begins = scanner.expect('{', "a patch"); !begins) return begins.error();
    bool has_range[2] = {false, false};
    while (!scanner.take('}')) {
        const std::string_view key = scanner.token();
        if (key.empty()) return scanner.fail(fmt::format("the patch {} has no '}}'", in_quotes(patch.name)));
        if (key == "type") patch.type = scanner.token();
        else if (key == "inGroups") patch.groups = group_names(scanner);
        else if (key == "nFaces" || key == "startFace") {
            const auto number = scanner.count(key);
            if (!number) return number.error();
            (key == "nFaces" ? patch.count : patch.first) = static_cast<std::size_t>(*number);
            has_range[key == "nFaces"] = true;
        }
        if (auto skipped = scanner.skip_entry(); !skipped) return skipped.error();
    }
    if (!has_range[0] || !has_range[1])
        return scanner.fail(fmt::format("the patch {} has no nFaces or no startFace", in_quotes(patch.name)));
    return patch;
}

Result<void> read_patches(const CaseFiles& files, const std::string& folder, Mesh& mesh) {
    auto scanner = scanner_of(files, folder + "/boundary");
    if (!scanner) return scanner.error();
    const auto count = scanner->count("the patches");
    if (!count) return count.error();
    if (auto begins = scanner->expect('(', "the patches"); !begins) return begins.error();
    std::size_t covered = 0;
    for (std::uint64_t i = 0; i < *count; ++i) {
        auto patch = read_patch(*scanner);
        if (!patch) return patch.error();
        const std::size_t faces = mesh.faces.count();
        if (patch->first > faces || patch->count > faces - patch->first || (covered += patch->count) > faces)
            return scanner->fail(fmt::format("the patch {} has {} faces from {} on, but there are {} faces",
                                             in_quotes(patch->name), patch->count, patch->first, faces));
        mesh.patches.push_back(std::move(*patch));
    }
    return scanner->expect(')', "the patches");
}

} // namespace

Result<Mesh> read_mesh(const CaseFiles& files, const MeshPlace& place) {
    Mesh mesh;
    if (auto read = read_points(files, place, mesh); !read) return read.error();
    core::drop_kept_blocks(); // of the text
    if (auto read = read_faces(files, place, mesh); !read) return read.error();
    core::drop_kept_blocks();
    if (auto read = read_cells(files, place.faces, mesh); !read) return read.error();
    core::drop_kept_blocks();
    if (auto read = read_patches(files, place.faces, mesh); !read) return read.error();
    return mesh;
}

} // namespace isotet::io::foam
