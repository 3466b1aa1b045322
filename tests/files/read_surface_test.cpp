// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// read_surface(): the many ways in which other programs write the same formats.
#include <cmath>

#include <sys/stat.h>

#include <fmt/format.h>

#include <isotet/read.hpp>

#include "files/sample_files.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::test {
namespace {

using Numbers = std::vector<double>;

Result<SurfaceFile> parse(std::string_view content, std::string_view format = {}) {
    return io::parse_surface(content, {}, format, {});
}

Surface parsed(std::string_view content, std::string_view format = {}) {
    auto file = parse(content, format);
    EXPECT_TRUE(file) << file.error().message;
    return file ? std::move(file->surface) : Surface{};
}

std::string message_of(std::string_view content, std::string_view format = {}) {
    const auto file = parse(content, format);
    EXPECT_FALSE(file) << content;
    return file ? std::string() : file.error().message;
}

template <class T>
std::string big_endian(std::initializer_list<T> values) {
    std::string bytes;
    for (const T value : values) {
        const auto* begin = reinterpret_cast<const char*>(&value);
        for (std::size_t i = sizeof value; i-- > 0;) bytes.push_back(begin[i]);
    }
    return bytes;
}

template <class T>
std::string little_endian(std::initializer_list<T> values) {
    return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T)};
}

// A square of two triangles, or of one polygon with four corners.
const Numbers square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const Numbers fan{0, 1, 2, 0, 2, 3};

TEST(ReadSurface, RefusesWhatIsNotAFile) {
    const Folder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    put_content(folder / "empty.ply", "");
    for (const auto& path : {folder.path().string(), folder / "pipe", folder / "missing", folder / "empty.ply",
                             std::string("/dev/null")}) {
        const auto file = read_surface(path);
        ASSERT_FALSE(file) << path;
        EXPECT_EQ(file.error().code, ErrorCode::file) << path;
        EXPECT_NE(file.error().message.find(path), std::string::npos) << file.error().message;
    }
}

TEST(ReadSurface, BelievesTheContentBeforeTheName) {
    const Folder folder;
    put_content(folder / "wrong.obj", "solid a\nendsolid a\n");
    const auto file = read_surface(folder / "wrong.obj");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->format, "stl");
    put_content(folder / "nameless", "# a comment\nv 0 0 0\n");
    const auto nameless = read_surface(folder / "nameless");
    ASSERT_TRUE(nameless) << nameless.error().message;
    EXPECT_EQ(nameless->format, "obj");
}

TEST(ReadSurface, SaysWhatItSawWhenNothingFits) {
    EXPECT_EQ(message_of("PQ\x03\x04 zip"), "neither content nor name is that of a surface file (vtp, ply, stl, obj, "
                                            "vtk, ts, 3mf): it starts with 'PQ\\x03\\x04 zip'");
    EXPECT_NE(message_of("v 0 0 0", "xyz").find("'xyz'"), std::string::npos);
}

TEST(ReadSurface, MayBeginWithAByteOrderMarkAndHaveWindowsLineEnds) {
    const std::string mark = "\xef\xbb\xbf";
    for (const auto& [format, text] : {
             std::pair("stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                              "endloop\nendfacet\nendsolid a\n"),
             {"ts", "GOCAD TSurf 1\nTFACE\nVRTX 1 0 0 0\nVRTX 2 1 0 0\nVRTX 3 0 1 0\nTRGL 1 2 3\nEND\n"},
             {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
             {"ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
                     "3 0 1 2\n"},
             {"vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0\n1 0 0\n0 1 0\n"
                     "POLYGONS 1 4\n3 0 1 2\n"},
         }) {
        std::string windows = mark;
        for (const char* c = text; *c; ++c) windows += *c == '\n' ? "\r\n" : std::string(1, *c);
        const auto file = parse(windows);
        ASSERT_TRUE(file) << format << ": " << file.error().message;
        EXPECT_EQ(file->format, format);
        EXPECT_EQ(doubles_of(file->surface.triangles), (Numbers{0, 1, 2})) << format;
        EXPECT_EQ(doubles_of(file->surface.positions), (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0})) << format;
    }
}

TEST(ReadPly, ReadsAsciiWithPolygonsAndOtherElements) {
    const Surface surface =
        parsed("ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 4\r\nproperty float x\r\nproperty "
               "float y\r\n"
               "property float z\r\nproperty uchar red\r\nelement edge 1\r\nproperty int a\r\nproperty list uchar "
               "float other\r\n"
               "element face 2\r\nproperty list uint8 int32 vertex_index\r\nproperty double quality\r\nend_header\r\n"
               "0 0 0 1\r\n1 0 0 2\r\n1 1 0 3\r\n0 1 0 255\r\n7 2 1.5 2.5\r\n4 0 1 2 3 0.5\r\n3 0 1 2 0.25\r\n");
    EXPECT_EQ(doubles_of(surface.positions), square);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2, 0, 2, 3, 0, 1, 2}));
    ASSERT_EQ(surface.point_fields.size(), 1U);
    EXPECT_EQ(surface.point_fields[0].values.type(), ScalarType::uint8);
    ASSERT_EQ(surface.cell_fields.size(), 1U);
    EXPECT_EQ(doubles_of(surface.cell_fields[0].values), (Numbers{0.5, 0.5, 0.25}));
}

TEST(ReadPly, ReadsBigEndian) {
    const Surface surface = parsed(
        std::string("ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                    "property double z\nelement face 1\nproperty list uchar ushort vertex_indices\nend_header\n") +
        big_endian<double>({0.1, 0, 0, 1, 0, 0, 0, 1, 0}) + '\3' + big_endian<std::uint16_t>({2, 1, 0}));
    EXPECT_EQ(surface.positions.type(), ScalarType::float64);
    EXPECT_EQ(surface.positions.at(0), 0.1);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{2, 1, 0}));
}

TEST(ReadPly, NamesWhatIsWrong) {
    const std::string start = "ply\nformat ascii 1.0\n";
    EXPECT_EQ(message_of("ply\nformat ascii 1.0\nelement vertex 3\n"), "the header has no end_header");
    EXPECT_EQ(message_of(start + "element vertex -3\nend_header\n"), "line 3 ('-3'): not a count of elements");
    EXPECT_EQ(message_of(start + "element vertex 99999999999\nproperty float x\nend_header\n1\n"),
              "99999999999 elements \"vertex\" of at least 1 bytes are announced, but 2 bytes are left");
    EXPECT_EQ(message_of(start + "element face 1\nproperty int a\nend_header\n7\n"),
              "the faces have no list vertex_indices, or several");
    EXPECT_EQ(message_of(start +
                         "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                         "property list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 -7\n"),
              "cell 0 has vertex -7, but the file has 1 vertices");
}

TEST(ReadStl, ReadsAsciiOfSeveralSolids) {
    const std::string facet =
        "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1e0 0 0\n vertex 0 +1 0\n endloop\nendfacet\n";
    const Surface surface =
        parsed("solid first part\n" + facet + "endsolid first part\nSOLID second\n" + facet + facet + "endsolid\n");
    EXPECT_EQ(surface.triangle_count(), 3U);
    EXPECT_EQ(surface.vertex_count(), 9U);
    EXPECT_EQ(surface.normals_kind, Normals::face);
    EXPECT_EQ(surface.positions.at(5, 1), 1);
}

TEST(ReadStl, TellsABinaryFileThatStartsWithSolidByItsLength) {
    std::string content = "solid but binary";
    content.resize(80);
    content += little_endian<std::uint32_t>({1}) + little_endian<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) +
               std::string(2, '\0');
    EXPECT_EQ(parsed(content).triangle_count(), 1U);
    EXPECT_EQ(message_of(std::string(80, 'x') + little_endian<std::uint32_t>({2}) + std::string(50, '\0'), "stl"),
              "2 triangles make 184 bytes of binary STL, but the file has 134");
}

TEST(ReadObj, ReadsEveryWayOfWritingAFace) {
    const Surface surface = parsed(
        "# cube side\nmtllib a.mtl\no side\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        "usemtl red\ns off\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 1/1 2/1 3/1\nf -4//-1 -3//-1 \\\n -2//-1\nf 1 2 3 # end\n");
    EXPECT_EQ(doubles_of(surface.positions), square);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 1, 2, 0, 1, 2}));
    EXPECT_EQ(surface.normals_kind, Normals::none);
}

TEST(ReadObj, NamesWhatIsWrong) {
    EXPECT_EQ(message_of("v 0 0\nf 1 1 1\n", "obj"), "line 1 (its end): three numbers were expected");
    EXPECT_EQ(message_of("v 0 0 0\nf 1 1 2\n", "obj"), "cell 0 has vertex 1, but the file has 1 vertices");
    EXPECT_EQ(message_of("v 0 0 0\nf 1 1 -2\n", "obj"), "cell 0 has vertex -1, but the file has 1 vertices");
    EXPECT_NE(message_of("v 0 0 0\nf 1 1 0\n", "obj").find("'0' is not a corner of a face"), std::string::npos);
    EXPECT_NE(message_of("v 0 0 0\nf 1 1\n", "obj").find("a face with 2 corners"), std::string::npos);
}

TEST(ReadTs, ReadsAtomsPropertiesDepthAndSeveralObjects) {
    const std::string object =
        "GOCAD TSurf 1\nHEADER {\nname:a\n}\nZPOSITIVE Depth\nPROPERTIES \"two words\" v\nESIZES 1 2\n"
        "NO_DATA_VALUES -9 -9\nTFACE\nPVRTX 10 0 0 5 1 2 3\nPVRTX 20 1 0 5 -9 -9 4\nVRTX 30 1 1 5\nPATOM 40 10 7 8 9\n"
        "# remark\nTRGL 10 20 30\nTFACE\nTRGL 40 20 30\nBSTONE 10\nBORDER 3 10 20\nEND\n# end\n";
    const Surface surface = parsed("# begin\n" + object, "ts");
    ASSERT_EQ(surface.vertex_count(), 4U);
    EXPECT_EQ(surface.positions.at(0, 2), -5);
    EXPECT_EQ(surface.positions.at(3, 0), 0);
    EXPECT_EQ(surface.positions.at(3, 2), -5);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2, 3, 1, 2}));
    ASSERT_EQ(surface.point_fields.size(), 2U);
    EXPECT_EQ(surface.point_fields[0].name, "two words");
    EXPECT_EQ(surface.point_fields[0].values.at(0), 1);
    EXPECT_TRUE(std::isnan(surface.point_fields[0].values.at(1)));
    EXPECT_TRUE(std::isnan(surface.point_fields[0].values.at(2)));
    EXPECT_TRUE(std::isnan(surface.point_fields[1].values.at(1, 0)));
    EXPECT_EQ(surface.point_fields[1].values.at(1, 1), 4);

    const Surface two = parsed(object + object);
    EXPECT_EQ(two.vertex_count(), 8U);
    EXPECT_EQ(two.triangles.at(2, 0), 4);
}

TEST(ReadTs, NamesWhatIsWrong) {
    EXPECT_EQ(message_of("GOCAD TSurf 1\nVRTX 1 0 0 0\n"), "the file ends before END");
    EXPECT_EQ(message_of("GOCAD TSurf 1\nVRTX 1 0 0 0\nTRGL 1 1 2\nEND\n"),
              "triangle 0 has vertex 2, which is not there");
    EXPECT_NE(message_of("GOCAD TSolid 1\nEND\n").find("'TSolid' stands where GOCAD TSurf was expected"),
              std::string::npos);
    EXPECT_NE(message_of("GOCAD TSurf 1\nATOM 1 2\nVRTX 2 0 0 0\nEND\n").find("an atom is at vertex 2"),
              std::string::npos);
}

TEST(ReadTs, TakesNoMemoryForValuesThatAreNotThere) {
    std::string content = "GOCAD TSurf 1\nPROPERTIES a\nESIZES 65536\n";
    for (int i = 0; i < 1000; ++i) content += fmt::format("PVRTX {} 0 0 0\n", i);
    EXPECT_NE(message_of(content + "END\n").find("too many vertices have no values"), std::string::npos);
}

const std::string legacy_start =
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n";

TEST(ReadLegacy, ReadsAsciiWithEveryKindOfCellAndAttribute) {
    const Surface surface = parsed(
        legacy_start + "VERTICES 1 2\n1 0\nLINES 1 3\n2 0 1\nPOLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\n"
                       "CELL_DATA 4\nSCALARS c int 1\nLOOKUP_TABLE default\n10 11 12 13\n"
                       "POINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE t\n1 2 3 nan\nLOOKUP_TABLE t 1\n0 0 0 1\n"
                       "VECTORS v double\n1 2 3 4 5 6 7 8 9 10 11 12\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1\n"
                       "FIELD f 2\nwith%20space 1 4 vtkIdType\n1 2 3 4\nMETADATA\nINFORMATION 0\n\n"
                       "words 1 4 string\na\nb\nc\nd\n");
    EXPECT_EQ(doubles_of(surface.positions), square);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2, 0, 2, 3, 0, 1, 3, 3, 1, 2}));
    ASSERT_EQ(surface.cell_fields.size(), 1U);
    EXPECT_EQ(doubles_of(surface.cell_fields[0].values), (Numbers{12, 12, 13, 13}));
    ASSERT_EQ(surface.point_fields.size(), 3U);
    EXPECT_EQ(surface.point_fields[2].name, "with space");
    EXPECT_EQ(surface.normals_kind, Normals::gradient);
}

TEST(ReadLegacy, ReadsOldBinary) {
    const Surface surface =
        parsed(std::string("# vtk DataFile Version 2.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 3 double\n") +
               big_endian<double>({0, 0, 0, 1, 0, 0, 0, 1, 0.1}) + "\nPOLYGONS 1 4\n" +
               big_endian<std::int32_t>({3, 0, 1, 2}) +
               "\nPOINT_DATA 3\nSCALARS a unsigned_char\nLOOKUP_TABLE default\n\x01\n\x03");
    EXPECT_EQ(surface.positions.at(2, 2), 0.1);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2}));
    ASSERT_EQ(surface.point_fields.size(), 1U);
    EXPECT_EQ(doubles_of(surface.point_fields[0].values), (Numbers{1, 10, 3}));
}

TEST(ReadLegacy, NamesWhatIsWrong) {
    EXPECT_EQ(message_of("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"),
              "this is a dataset of kind 'unstructured_grid', not a surface (POLYDATA)");
    EXPECT_EQ(message_of(legacy_start + "POLYGONS 2 4\n3 0 1 2\n"),
              "polygons: cell 1 of 2 does not fit into the 4 numbers");
    EXPECT_EQ(message_of(legacy_start + "POLYGONS 1 4\n3 0 1 4\n"), "cell 0 has vertex 4, but the file has 4 vertices");
    EXPECT_EQ(message_of("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 999999999999 float\n0 0 0\n"),
              "POINTS: 999999999999 x 3 numbers were announced, but only 7 bytes are left");
    EXPECT_EQ(message_of(legacy_start + "CELL_DATA 3\nSCALARS c int\nLOOKUP_TABLE default\n1 2 3\n"),
              "cell field 'c' cannot be read: it has 3 values, but the grid has 0 cells");
}

std::string vtp(std::string_view attributes, std::string_view piece, std::string_view after = {}) {
    return fmt::format("<?xml version=\"1.0\"?>\n<!-- made by <hand> -->\n<VTKFile type=\"PolyData\" version=\"0.1\" "
                       "{}>\n<PolyData>\n{}"
                       "</PolyData>\n{}</VTKFile>\n",
                       attributes, piece, after);
}

const std::string ascii_piece =
    "<Piece NumberOfPoints=\"4\" NumberOfVerts=\"1\" NumberOfPolys=\"1\" NumberOfStrips=\"1\">\n"
    "<PointData Scalars=\"s\" Normals=\"n\"><DataArray type=\"Float32\" Name=\"a &lt;&#x20AC;&amp;&gt;\" "
    "format=\"ascii\">1 2 3 4</DataArray>\n"
    "<DataArray type=\"Float64\" Name=\"n\" NumberOfComponents=\"3\">0 0 1 0 0 1 0 0 1 0 0 1</DataArray>"
    "<DataArray type=\"String\" Name=\"text\">97 0</DataArray></PointData>\n"
    "<CellData><DataArray type=\"Int8\" Name='c'>7 8 -9<InformationKey name=\"X\" "
    "location=\"Y\"/></DataArray></CellData>\n"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>\n"
    "<Verts><DataArray type=\"Int32\" Name=\"connectivity\">0</DataArray><DataArray type=\"Int32\" "
    "Name=\"offsets\">1</DataArray></Verts>\n"
    "<Polys><DataArray type=\"Int64\" Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int32\" "
    "Name=\"offsets\">4</DataArray></Polys>\n"
    "<Strips><DataArray type=\"Int64\" Name=\"connectivity\">0 1 3 2</DataArray><DataArray type=\"Int32\" "
    "Name=\"offsets\">4</DataArray></Strips>\n"
    "</Piece>\n";

TEST(ReadVtp, ReadsAsciiWithEveryKindOfCell) {
    const Surface surface = parsed(vtp("", ascii_piece));
    EXPECT_EQ(doubles_of(surface.positions), square);
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2, 0, 2, 3, 0, 1, 3, 3, 1, 2}));
    ASSERT_EQ(surface.point_fields.size(), 1U);
    EXPECT_EQ(surface.point_fields[0].name, "a <\xE2\x82\xAC&>");
    ASSERT_EQ(surface.cell_fields.size(), 1U);
    EXPECT_EQ(doubles_of(surface.cell_fields[0].values), (Numbers{8, 8, -9, -9}));
    EXPECT_EQ(surface.normals_kind, Normals::gradient);
}

TEST(ReadVtp, JoinsPieces) {
    const Surface surface = parsed(vtp("", ascii_piece + ascii_piece));
    EXPECT_EQ(surface.vertex_count(), 8U);
    EXPECT_EQ(surface.triangle_count(), 8U);
    EXPECT_EQ(surface.triangles.at(4, 1), 5);
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = (group << 8U) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[(group >> (18 - 6 * k)) & 63U] : '=';
    }
    return text;
}

std::string triangle_piece(const std::string& points, const std::string& connectivity, const std::string& offsets) {
    const auto array = [](std::string_view type, std::string_view name, std::string_view rest) {
        if (rest.starts_with("format="))
            return fmt::format("<DataArray type=\"{}\" Name=\"{}\" {}/>", type, name, rest);
        return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"binary\">\n{}\n</DataArray>", type, name, rest);
    };
    return fmt::format(
        "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>{}</Points><Polys>{}{}</Polys></Piece>\n",
        array("Float64", "Points\" NumberOfComponents=\"3", points), array("Int32", "connectivity", connectivity),
        array("Int32", "offsets", offsets));
}

TEST(ReadVtp, ReadsInlineBase64WithAndWithoutAStreamOfItsOwnForTheHeader) {
    const auto points = big_endian<double>({0, 0, 0, 1, 0, 0, 0, 1, 0.1});
    const auto corners = big_endian<std::int32_t>({0, 1, 2}), ends = big_endian<std::int32_t>({3});
    const auto header = [](std::size_t size) { return big_endian<std::uint32_t>({static_cast<std::uint32_t>(size)}); };
    const auto together = [&](const std::string& bytes) { return base64(header(bytes.size()) + bytes); };
    const auto apart = [&](const std::string& bytes) { return base64(header(bytes.size())) + base64(bytes); };
    for (const auto& content :
         {vtp("byte_order=\"BigEndian\"", triangle_piece(together(points), together(corners), together(ends))),
          vtp("byte_order=\"BigEndian\"", triangle_piece(apart(points), apart(corners), apart(ends)))}) {
        const Surface surface = parsed(content);
        EXPECT_EQ(doubles_of(surface.positions), (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0.1}));
        EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2}));
    }
}

TEST(ReadVtp, ReadsAppendedBase64) {
    const auto block = [](const std::string& bytes) {
        return base64(little_endian<std::uint64_t>({bytes.size()}) + bytes);
    };
    const auto points = block(little_endian<double>({0, 0, 0, 1, 0, 0, 0, 1, 0.1})),
               corners = block(little_endian<std::int32_t>({0, 1, 2})), ends = block(little_endian<std::int32_t>({3}));
    const auto at = [](std::size_t offset) { return fmt::format("format=\"appended\" offset=\"{}\"", offset); };
    const Surface surface = parsed(
        vtp("header_type=\"UInt64\"", triangle_piece(at(0), at(points.size()), at(points.size() + corners.size())),
            "<AppendedData encoding=\"base64\">\n  _" + points + corners + ends + "\n</AppendedData>\n"));
    EXPECT_EQ(doubles_of(surface.positions), (Numbers{0, 0, 0, 1, 0, 0, 0, 1, 0.1}));
    EXPECT_EQ(doubles_of(surface.triangles), (Numbers{0, 1, 2}));
}

TEST(ReadVtp, RefusesArraysThatShareAPartOfTheirData) {
    const auto at = [](std::size_t offset) { return fmt::format("format=\"appended\" offset=\"{}\"", offset); };
    std::string piece = triangle_piece(at(0), at(4), at(4));
    piece.replace(piece.find("NumberOfPolys=\"1\""), 17, "NumberOfPolys=\"2\"");
    const auto message =
        message_of(vtp("", piece,
                       std::string("<AppendedData encoding=\"raw\">_") + little_endian<std::uint32_t>({72, 8}) +
                           std::string(68, '\0') + "</AppendedData>\n"));
    EXPECT_NE(message.find("shares a part of its appended data"), std::string::npos) << message;
}

TEST(ReadVtp, NamesWhatIsWrong) {
    EXPECT_EQ(message_of("<VTKFile type=\"UnstructuredGrid\"></VTKFile>"),
              "this is a VTK file of type 'UnstructuredGrid', not a surface (PolyData)");
    EXPECT_EQ(message_of("<VTKFile type=\"PolyData\"><PolyData>"), "the file ends before </VTKFile>");
    EXPECT_EQ(message_of("<VTKFile type=\"PolyData\"><PolyData a=b>"),
              "broken XML near byte 25: Error parsing element attribute");
    EXPECT_EQ(message_of("<!DOCTYPE x [<!ENTITY a \"b\">]><VTKFile type=\"PolyData\">"),
              "the file ends before </VTKFile>");
    EXPECT_EQ(message_of(vtp("", "<Piece NumberOfPoints=\"-4\"/>")), "NumberOfPoints is '-4', not a count");
    EXPECT_EQ(
        message_of(vtp(
            "",
            "<Piece NumberOfPoints=\"99999999999\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0"
            "</DataArray></Points></Piece>")),
        "the array '' should have 299999999997 numbers, but there are only 5 characters");
}

} // namespace
} // namespace isotet::test
