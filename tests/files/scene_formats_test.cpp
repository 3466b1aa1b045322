// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// GLB, 3MF and USD: what other programs rely on.
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include <isotet/check.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "files/sample_files.hpp"
#include "io/files/zip.hpp"

namespace isotet::test {
namespace {

using Json = nlohmann::json;

/// Two tets that share no vertex, outwards; the second one is part 7.
Surface two_tets() {
    Surface surface;
    surface.positions = Array::own(
        std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 0, 0, 6, 0, 0, 5, 1, 0, 5, 0, 1}, 3);
    surface.triangles = Array::own(
        std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 4, 6, 5, 4, 5, 7, 4, 7, 6, 5, 6, 7}, 3);
    surface.cell_fields = {{"part", Array::own(std::vector<std::int32_t>{0, 0, 0, 0, 7, 7, 7, 7})}};
    return surface;
}

template <class Number>
Number number_at(std::string_view bytes, std::size_t place) {
    Number number{};
    std::memcpy(&number, bytes.data() + place, sizeof number);
    return number;
}

/// The two chunks of a GLB file.
struct Glb {
    Json json;
    std::string binary;

    explicit Glb(const std::string& content) {
        EXPECT_EQ(content.substr(0, 4), "glTF");
        EXPECT_EQ(number_at<std::uint32_t>(content, 4), 2U);
        EXPECT_EQ(number_at<std::uint32_t>(content, 8), content.size());
        const auto length = number_at<std::uint32_t>(content, 12);
        EXPECT_EQ(length % 4, 0U);
        json = Json::parse(content.substr(20, length));
        if (content.size() > 20 + length) binary = content.substr(28 + length);
    }

    const Json& accessor(const Json& index) const { return json.at("accessors").at(index.get<std::size_t>()); }

    template <class Number>
    std::vector<Number> values(const Json& index) const {
        const Json& view = json.at("bufferViews").at(accessor(index).at("bufferView").get<std::size_t>());
        const auto begin = view.at("byteOffset").get<std::size_t>(), size = view.at("byteLength").get<std::size_t>();
        EXPECT_EQ(begin % 4, 0U);
        std::vector<Number> numbers(size / sizeof(Number));
        std::memcpy(numbers.data(), binary.data() + begin, size);
        return numbers;
    }
};

Glb written_glb(const Surface& surface) {
    const Folder folder;
    write(surface, folder / "out.glb");
    return Glb(content_of(folder / "out.glb"));
}

TEST(WriteGlb, HoldsVerticesOnceAndAMeshForEachPart) {
    const Glb glb = written_glb(two_tets());
    const Json& meshes = glb.json.at("meshes");
    ASSERT_EQ(meshes.size(), 2U);
    EXPECT_EQ(meshes[0].at("name"), "part 0");
    EXPECT_EQ(meshes[1].at("name"), "part 7");
    const Json& first = meshes[0].at("primitives")[0];
    const Json& second = meshes[1].at("primitives")[0];
    EXPECT_EQ(first.at("attributes"), second.at("attributes"));
    EXPECT_EQ(glb.values<std::uint32_t>(second.at("indices")),
              (std::vector<std::uint32_t>{4, 6, 5, 4, 5, 7, 4, 7, 6, 5, 6, 7}));
    const Json& positions = first.at("attributes").at("POSITION");
    const Surface surface = two_tets();
    const auto expected = surface.positions.as<float>();
    EXPECT_EQ(glb.values<float>(positions), std::vector<float>(expected.begin(), expected.end()));
    EXPECT_EQ(glb.accessor(positions).at("max"), Json::array({6, 1, 1}));
    EXPECT_EQ(glb.json.at("buffers")[0].at("byteLength"), glb.binary.size());
}

TEST(WriteGlb, HoldsFieldsNormalsAndColors) {
    Surface surface = two_tets();
    surface.normals_kind = Normals::vertex;
    surface.normals = Array::own(std::vector<float>(24), 3); // zero: nothing defines one
    surface.point_fields = {
        {"p (bar)", Array::own(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8})},
        {"gap", Array::own(std::vector<float>{1, 2, 3, std::nanf(""), 5, 6, 7, 8})},
        {"rgb", Array::own(std::vector<std::uint8_t>{255, 0, 128, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                     0, 0, 0},
                           3)}};
    const Folder folder;
    const WriteReport report = write(surface, folder / "out.glb");
    EXPECT_TRUE(has_note(report, "\"gap\" was left out"));
    const Glb glb(content_of(folder / "out.glb"));
    const Json& attributes = glb.json.at("meshes")[0].at("primitives")[0].at("attributes");
    EXPECT_EQ(glb.values<float>(attributes.at("_p_(bar)"))[7], 8);
    EXPECT_EQ(glb.values<float>(attributes.at("NORMAL"))[2], 1) << "of length 1";
    const auto colors = glb.values<std::uint16_t>(attributes.at("COLOR_0"));
    EXPECT_EQ(colors[0], 65535);
    EXPECT_EQ(colors[1], 0);
    EXPECT_EQ(colors[2], 14146) << "sRGB 128 is 0.2159 of the light";
    EXPECT_EQ(colors[3], 65535);
    EXPECT_FALSE(attributes.contains("_gap"));
}

TEST(WriteGlb, ShowsTimesOneAfterAnother) {
    Surface surface = two_tets();
    surface.cell_fields.push_back(
        {std::string(animation_field), Array::own(std::vector<double>{2.5, 2.5, 2.5, 2.5, 10, 10, 10, 10})});
    const Glb glb = written_glb(surface);
    ASSERT_EQ(glb.json.at("animations").size(), 1U);
    const Json& animation = glb.json.at("animations")[0];
    const Json& nodes = glb.json.at("nodes");
    ASSERT_EQ(animation.at("channels").size(), 2U);
    EXPECT_EQ(nodes[1].at("name"), "time 2.5, part 0");
    EXPECT_FALSE(nodes[1].contains("scale"));
    EXPECT_EQ(nodes[2].at("scale"), Json::array({0, 0, 0}));
    for (std::size_t step = 0; step < 2; ++step) {
        const Json& channel = animation.at("channels")[step];
        EXPECT_EQ(channel.at("target"), (Json{{"node", step + 1}, {"path", "scale"}}));
        const Json& sampler = animation.at("samplers")[channel.at("sampler").get<std::size_t>()];
        EXPECT_EQ(sampler.at("interpolation"), "STEP");
        EXPECT_EQ(glb.values<float>(sampler.at("input")), (std::vector<float>{0, 0.25F, 0.5F}));
        EXPECT_EQ(glb.values<float>(sampler.at("output")), (step == 0 ? std::vector<float>{1, 1, 1, 0, 0, 0, 0, 0, 0}
                                                                      : std::vector<float>{0, 0, 0, 1, 1, 1, 1, 1, 1}));
        EXPECT_EQ(glb.accessor(sampler.at("output")).at("count"), 3);
        EXPECT_FALSE(glb.json.at("bufferViews")[glb.accessor(sampler.at("input")).at("bufferView").get<std::size_t>()]
                         .contains("target"));
    }
    EXPECT_FALSE(written_glb(two_tets()).json.contains("animations"));
}

TEST(WriteGlb, CountsFromTheMiddleFarFromZero) {
    const Surface far = moved(two_tets(), {5e9, 0, 0});
    const Folder folder;
    EXPECT_TRUE(has_note(write(far, folder / "out.glb"), "coordinates are relative to"));
    const Glb glb(content_of(folder / "out.glb"));
    EXPECT_EQ(glb.json.at("nodes")[0].at("extras").at("origin")[0], 5e9);
}

TEST(WriteGlb, OfAnEmptySurfaceIsAnEmptyScene) {
    const Glb glb = written_glb(empty_surface());
    EXPECT_FALSE(glb.json.contains("meshes"));
    EXPECT_TRUE(glb.binary.empty());
}

std::string model_of(const std::string& content) {
    const auto model = io::read_from_zip(content, "3dmodel.model", 1 << 20);
    EXPECT_TRUE(model) << model.error().message;
    return model ? *model : std::string();
}

TEST(Write3mf, ComesBackClosed) {
    const Folder folder;
    const WriteReport report = write(moved(two_tets(), {1000000, 0.1, 0}), folder / "out.3mf");
    EXPECT_TRUE(has_note(report, "millimetre"));
    const auto back = read_surface(folder / "out.3mf");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(doubles_of(back->surface.positions), doubles_of(moved(two_tets(), {1000000, 0.1, 0}).positions));
    const auto checked = check(back->surface, {.closed = true});
    ASSERT_TRUE(checked) << checked.error().message;
    EXPECT_EQ(checked->boundary_edges, 0U);
    EXPECT_NE(model_of(content_of(folder / "out.3mf")).find("type=\"model\""), std::string::npos);
}

TEST(Write3mf, OfASurfaceThatIsOpenIsNoSolid) {
    const Folder folder;
    write(rich_surface(), folder / "out.3mf");
    EXPECT_NE(model_of(content_of(folder / "out.3mf")).find("type=\"surface\""), std::string::npos);
}

TEST(Zip, GivesBackWhatWasPut) {
    io::ZipWriter writer;
    const std::string much(100000, 'x');
    ASSERT_TRUE(writer.add("a/empty.txt", ""));
    ASSERT_TRUE(writer.add("a/much.txt", much));
    const std::string archive = std::move(writer).finish();
    EXPECT_LT(archive.size(), 1000U);
    EXPECT_EQ(io::read_from_zip(archive, "much.txt", much.size()).value(), much);
    EXPECT_EQ(io::read_from_zip(archive, "empty.txt", 0).value(), "");
    EXPECT_FALSE(io::read_from_zip(archive, "much.txt", much.size() - 1)) << "more than is read";
    EXPECT_FALSE(io::read_from_zip(archive, "none.txt", much.size()));
}

TEST(WriteUsd, IsOneMeshWithASubsetForEachPart) {
    Surface surface = two_tets();
    surface.point_fields = {{"p", Array::own(std::vector<float>{1, 2.5F, 3, 4, 5, 6, 7, 8})}};
    const Folder folder;
    write(surface, folder / "out.usda");
    EXPECT_EQ(content_of(folder / "out.usda"), R"(#usda 1.0
(
    defaultPrim = "surface"
    metersPerUnit = 1
    upAxis = "Z"
)

def Mesh "surface"
{
    uniform token subdivisionScheme = "none"
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (5, 0, 0), (6, 0, 0), (5, 1, 0), (5, 0, 1)]
    int[] faceVertexCounts = [3, 3, 3, 3, 3, 3, 3, 3]
    int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 4, 6, 5, 4, 5, 7, 4, 7, 6, 5, 6, 7]
    float[] primvars:p = [1, 2.5, 3, 4, 5, 6, 7, 8] (
        interpolation = "vertex"
    )

    def GeomSubset "part_0"
    {
        uniform token elementType = "face"
        uniform token familyName = "partition"
        int[] indices = [0, 1, 2, 3]
    }

    def GeomSubset "part_7"
    {
        uniform token elementType = "face"
        uniform token familyName = "partition"
        int[] indices = [4, 5, 6, 7]
    }
}
)");
}

} // namespace
} // namespace isotet::test
