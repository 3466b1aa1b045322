// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surface files cut short or changed: an error or a valid surface, never anything else.
#include <random>

#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "files/sample_files.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::test {
namespace {

std::string written(const Surface& surface, const std::string& format) {
    const Folder folder;
    const auto report = write_surface(surface, folder / "out", {format});
    EXPECT_TRUE(report) << report.error().message;
    return content_of(folder / "out");
}

/// An ascii twin of some formats, as other programs write them.
std::string ascii_sample(const std::string& format) {
    if (format == "ply") {
        return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
               "z\nproperty int s\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n4 0 1 2 3\n";
    }
    if (format == "stl") {
        return "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
               "0\nendloop\nendfacet\nendsolid a\n";
    }
    if (format == "vtk") {
        return "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 "
               "0\nPOLYGONS 1 5\n4 0 1 2 3\n"
               "POINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4\nFIELD f 1\nw 2 4 int\n1 2 3 4 5 6 7 8\n";
    }
    return "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray "
           "type=\"Float32\" "
           "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0</DataArray></Points><Polys><DataArray "
           "type=\"Int32\" Name=\"connectivity\" "
           "format=\"binary\">DAAAAAAAAAABAAAAAgAAAA==</DataArray><DataArray type=\"Int32\" "
           "Name=\"offsets\">3</DataArray></Polys></Piece>"
           "</PolyData></VTKFile>";
}

bool fits(const std::vector<Field>& fields, std::size_t tuples) {
    for (const auto& field : fields) {
        if (field.values.tuples() != tuples) return false;
    }
    return true;
}

/// What everybody may rely on who gets a surface.
bool is_valid(const Surface& surface) {
    const std::size_t vertices = surface.vertex_count(), triangles = surface.triangle_count();
    bool valid = fits(surface.point_fields, vertices) && fits(surface.cell_fields, triangles);
    if (surface.normals_kind != Normals::none) {
        valid = valid && surface.normals.tuples() == (surface.normals_kind == Normals::face ? triangles : vertices);
    }
    surface.triangles.visit([&](auto corners) {
        for (const auto corner : corners) valid = valid && static_cast<double>(corner) < static_cast<double>(vertices);
    });
    return valid;
}

/// Parses, and fails the test on anything but an error with a sentence or a valid surface. True for a surface.
bool survives(std::string_view content, const std::string& format, const std::string& what) {
    const auto file = io::parse_surface(content, format, {}, {});
    if (!file) {
        EXPECT_FALSE(file.error().message.empty()) << what;
        EXPECT_NE(file.error().code, ErrorCode::internal) << what << ": " << file.error().message;
        return false;
    }
    EXPECT_TRUE(is_valid(file->surface)) << what;
    return true;
}

struct Sample {
    std::string format;
    bool ascii;
};

std::string name_of_sample(const testing::TestParamInfo<Sample>& sample) {
    return sample.param.format + (sample.param.ascii ? "_ascii" : "");
}

class BrokenSurface : public testing::TestWithParam<Sample> {
protected:
    std::string sample() const {
        return GetParam().ascii ? ascii_sample(GetParam().format) : written(rich_surface(), GetParam().format);
    }
};
INSTANTIATE_TEST_SUITE_P(Formats, BrokenSurface,
                         testing::Values(Sample{"vtp", false}, Sample{"vtp", true}, Sample{"ply", false},
                                         Sample{"ply", true}, Sample{"stl", false}, Sample{"stl", true},
                                         Sample{"obj", false}, Sample{"vtk", false}, Sample{"vtk", true},
                                         Sample{"ts", false}, Sample{"3mf", false}),
                         name_of_sample);

TEST_P(BrokenSurface, IsAnErrorOrASurfaceWhereverItIsCut) {
    const std::string whole = sample();
    const std::string format = GetParam().format;
    ASSERT_TRUE(survives(whole, format, "whole"));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        // A copy of its own, so that a sanitizer sees a read behind the end.
        const std::vector<char> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
        survives({cut.data(), cut.size()}, format, format + " cut at " + std::to_string(length));
    }
}

/// Of the formats that say how much there is, or where the end is: all but OBJ.
class SurfaceCutInHalf : public BrokenSurface {};
INSTANTIATE_TEST_SUITE_P(Formats, SurfaceCutInHalf,
                         testing::Values(Sample{"vtp", false}, Sample{"vtp", true}, Sample{"ply", false},
                                         Sample{"ply", true}, Sample{"stl", false}, Sample{"stl", true},
                                         Sample{"vtk", false}, Sample{"vtk", true}, Sample{"ts", false},
                                         Sample{"3mf", false}),
                         name_of_sample);

TEST_P(SurfaceCutInHalf, IsAnError) {
    const std::string whole = sample();
    EXPECT_FALSE(survives(std::string_view(whole).substr(0, whole.size() / 2), GetParam().format, "half"));
}

TEST_P(BrokenSurface, IsAnErrorOrASurfaceWhateverIsChanged) {
    const std::string whole = sample();
    const std::string format = GetParam().format;
    std::mt19937 random(20240607);
    const std::string digits = "0123456789-+.eE<>\"/ \n";
    for (int round = 0; round < 4000; ++round) {
        std::string changed = whole;
        const std::size_t changes = 1 + random() % 4;
        for (std::size_t i = 0; i < changes; ++i) {
            const std::size_t at = random() % changed.size();
            switch (random() % 4) {
            case 0: changed[at] = static_cast<char>(random() & 0xFFU); break;
            case 1: changed[at] = digits[random() % digits.size()]; break;
            case 2: changed.erase(at, 1 + random() % 8); break;
            default: changed.insert(at, changed.substr(random() % changed.size(), random() % 8)); break;
            }
            if (changed.empty()) changed.push_back('x');
        }
        survives(changed, format, format + " round " + std::to_string(round));
    }
}

} // namespace
} // namespace isotet::test
