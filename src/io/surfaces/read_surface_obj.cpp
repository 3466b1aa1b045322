// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ: vertices, faces, and normals where they belong to vertices or faces one to one.
#include <cstdint>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::io {
namespace {

class ObjReader {
public:
    ObjReader(std::string_view content, const Progress& progress)
        : scanner_(content, '#'), pace_(progress, content.size()) {}

    Result<Surface> read() {
        while (!scanner_.at_end()) {
            const auto keyword = scanner_.word_of_line();
            Result<void> line;
            if (keyword == "v") line = read_vector(positions_);
            else if (keyword == "vn") line = read_vector(normals_);
            else if (keyword == "f") line = read_face();
            else if (keyword == "call" || keyword == "csh")
                line = invalid_data(fmt::format("{}: other files and commands are not followed", in_quotes(keyword)));
            if (!line) return line.error();
            // What stands behind the numbers (a weight, colours) and all other keywords say nothing of the surface.
            skip_line();
            if (!pace_.goes_on(scanner_.position())) return Pace::cancelled();
        }
        return finish();
    }

private:
    /// A backslash at the end continues a line.
    void skip_line() {
        for (;;) {
            const auto rest = scanner_.rest();
            const auto end = rest.find('\n');
            const auto line = rest.substr(0, end);
            scanner_.next_line();
            if (end == std::string_view::npos || !(line.ends_with('\\') || line.ends_with("\\\r"))) return;
        }
    }

    Result<void> read_vector(std::vector<double>& vectors) {
        for (int i = 0; i < 3; ++i) {
            double value = 0;
            if (!scanner_.number_of_line(value))
                return invalid_data(fmt::format("{}: three numbers were expected", scanner_.where()));
            vectors.push_back(value);
        }
        return {};
    }

    /// The zero-based index; indices below zero count from the end.
    static std::uint64_t resolve(std::int64_t index, std::size_t count) {
        if (index > 0) return static_cast<std::uint64_t>(index) - 1;
        return static_cast<std::uint64_t>(count) + static_cast<std::uint64_t>(index);
    }

    Result<void> read_face() {
        corners_.clear();
        bool normals_of_corners = true, one_normal = true;
        std::uint64_t face_normal = 0;
        for (;;) {
            auto word = scanner_.word_of_line();
            if (word.empty()) break;
            if (word == "\\") {
                scanner_.next_line();
                continue;
            }
            const auto first_slash = word.find('/');
            const auto second_slash =
                first_slash == std::string_view::npos ? first_slash : word.find('/', first_slash + 1);
            std::int64_t vertex = 0, normal = 0;
            if (!parse_number(word.substr(0, first_slash), vertex) || vertex == 0) {
                return invalid_data(
                    fmt::format("before {}: {} is not a corner of a face", scanner_.where(), in_quotes(word)));
            }
            corners_.push_back(resolve(vertex, positions_.size() / 3));
            if (second_slash == std::string_view::npos) {
                normals_of_corners = one_normal = false;
                continue;
            }
            if (!parse_number(word.substr(second_slash + 1), normal) || normal == 0) {
                return invalid_data(
                    fmt::format("before {}: {} is not a corner of a face", scanner_.where(), in_quotes(word)));
            }
            const auto index = resolve(normal, normals_.size() / 3);
            normals_of_corners = normals_of_corners && index == corners_.back();
            if (corners_.size() == 1) face_normal = index;
            one_normal = one_normal && index == face_normal;
        }
        if (corners_.size() < 3)
            return invalid_data(fmt::format("before {}: a face with {} corners", scanner_.where(), corners_.size()));
        normals_of_vertices_ = normals_of_vertices_ && normals_of_corners;
        normals_of_faces_ = normals_of_faces_ && one_normal && face_normal == parts_.cells.cells();
        parts_.cells.add_polygon(corners_);
        return {};
    }

    Result<Surface> finish() {
        const bool of_vertices = normals_of_vertices_ && normals_.size() == positions_.size();
        const bool of_faces = normals_of_faces_ && normals_.size() == 3 * parts_.cells.cells();
        if (!normals_.empty() && (of_vertices || of_faces)) {
            auto& data = of_vertices ? parts_.point_data : parts_.cell_data;
            data.push_back({"Normals", Array::own(std::move(normals_), 3), true});
        }
        parts_.positions = Array::own(std::move(positions_), 3);
        return assemble(std::move(parts_));
    }

    TextScanner scanner_;
    Pace pace_;
    std::vector<double> positions_, normals_;
    std::vector<std::uint64_t> corners_;
    bool normals_of_vertices_ = true, normals_of_faces_ = true; ///< as far as the faces read until now
    SurfaceParts parts_;
};

} // namespace

Result<Surface> parse_obj(std::string_view content, const Progress& progress) {
    return ObjReader(content, progress).read();
}

} // namespace isotet::io
