// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pages of one file: how meshes are coded, how the page is put together, what fits.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>

#include "view/export/page_file.hpp"
#include "view/export/saved_mesh.hpp"
#include "view/export/saved_surfaces.hpp"
#include "view/export/sha256.hpp"

namespace isotet::test {
namespace {

using namespace view;

/// Takes columns apart as web/link/unpack.js does.
class ColumnReader {
public:
    explicit ColumnReader(std::string bytes) : bytes_(std::move(bytes)) {}

    std::vector<std::uint64_t> read(std::size_t count, std::size_t width) {
        std::vector<std::uint64_t> codes;
        for (std::size_t i = 0; i < count; ++i) {
            std::uint64_t code = 0;
            for (std::size_t plane = width; plane-- > 0;)
                code = 256 * code + static_cast<unsigned char>(bytes_.at(at_ + plane * count + i));
            codes.push_back(code);
        }
        at_ += count * width;
        return codes;
    }
    std::vector<std::uint64_t> read_differences(std::size_t count, std::size_t width) {
        const std::uint64_t most = std::uint64_t{1} << (8 * width);
        std::vector<std::uint64_t> values = read(count, width);
        std::uint64_t last = 0;
        for (std::uint64_t& value : values)
            value = last = (last + (value % 2 ? most - (value + 1) / 2 : value / 2)) % most;
        return values;
    }
    /// Numbers of vertices, which come as they are used first.
    std::vector<std::uint64_t> read_corners(std::size_t count, std::size_t width) {
        std::vector<std::uint64_t> corners = read(count, width);
        std::uint64_t next = 0;
        for (std::uint64_t& corner : corners) {
            const bool is_new = corner == 0;
            corner = next - corner;
            next += is_new ? 1 : 0;
        }
        return corners;
    }
    bool at_end() const { return at_ == bytes_.size(); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

Mesh random_mesh(std::mt19937& random, std::size_t vertices, bool colored, bool flat) {
    Mesh mesh;
    mesh.flat = flat;
    const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
    for (std::size_t i = 0; i < vertices; ++i) {
        MeshVertex vertex;
        for (auto& place : vertex.place) place = static_cast<std::uint16_t>(below(65'536));
        for (auto& side : vertex.normal) side = static_cast<std::int8_t>(static_cast<int>(below(255)) - 127);
        mesh.vertices.push_back(vertex);
        if (colored) mesh.colors.push_back(static_cast<std::uint16_t>(below(65'536)));
    }
    for (std::size_t i = 0; i < vertices / 3 * 3; ++i)
        mesh.corners.push_back(static_cast<std::uint32_t>(flat ? i : below(vertices)));
    return mesh;
}

using Numbers = std::vector<std::uint64_t>; ///< of a vertex: its places, those of its normal, its colour

/// The numbers of each corner's vertex; of a flat mesh of each vertex.
std::vector<Numbers> corners_held(const Mesh& mesh) {
    ColumnReader columns(columns_of(mesh));
    const std::size_t count = mesh.vertices.size();
    std::vector<Numbers> vertices(count);
    const auto add = [&](std::size_t width) {
        const Numbers column = columns.read_differences(count, width);
        for (std::size_t i = 0; i < count; ++i) vertices[i].push_back(column[i]);
    };
    for (const std::size_t width : {2, 2, 2, 1, 1}) add(width);
    if (!mesh.colors.empty()) add(2);
    std::vector<Numbers> held;
    if (mesh.flat) held = vertices;
    else
        for (const std::uint64_t corner : columns.read_corners(mesh.corners.size(), count > 65'535 ? 4 : 2))
            held.push_back(vertices.at(corner));
    EXPECT_TRUE(columns.at_end());
    return held;
}

std::vector<Numbers> corners_there(const Mesh& mesh) {
    std::vector<Numbers> there;
    for (std::size_t i = 0; i < (mesh.flat ? mesh.vertices.size() : mesh.corners.size()); ++i) {
        const std::size_t vertex = mesh.flat ? i : mesh.corners[i];
        const MeshVertex& one = mesh.vertices[vertex];
        Numbers numbers(one.place.begin(), one.place.end());
        for (const std::int8_t side : one.normal) numbers.push_back(static_cast<std::uint8_t>(side));
        if (!mesh.colors.empty()) numbers.push_back(mesh.colors[vertex]);
        there.push_back(std::move(numbers));
    }
    return there;
}

TEST(ColumnsOf, HoldEveryNumberOfAMesh) {
    std::mt19937 random(7);
    for (const std::size_t vertices : {0, 1, 3, 1000})
        for (const bool colored : {false, true})
            for (const bool flat : {false, true}) {
                const Mesh mesh = random_mesh(random, vertices, colored, flat);
                EXPECT_EQ(corners_held(mesh), corners_there(mesh)) << vertices << colored << flat;
            }
    for (const std::size_t vertices : {65'535, 65'536}) { // corners of 16 bits and of 32
        const Mesh mesh = random_mesh(random, vertices, false, false);
        EXPECT_EQ(corners_held(mesh), corners_there(mesh)) << vertices;
    }
}

std::string hexadecimal(std::string_view bytes) {
    std::string out;
    for (const char byte : bytes)
        for (const int half : {static_cast<unsigned char>(byte) >> 4, byte & 15}) out += "0123456789abcdef"[half];
    return out;
}

TEST(Sha256, GivesThePublishedValues) { // FIPS 180-4, examples
    EXPECT_EQ(hexadecimal(sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(hexadecimal(sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(hexadecimal(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(hexadecimal(sha256(std::string(1'000'000, 'a'))),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Base64Of, GivesThePublishedValues) { // RFC 4648, section 10
    EXPECT_EQ(base64_of(""), "");
    EXPECT_EQ(base64_of("f"), "Zg==");
    EXPECT_EQ(base64_of("fo"), "Zm8=");
    EXPECT_EQ(base64_of("foo"), "Zm9v");
    EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

TEST(Bundle, RunsModulesInTheOrderOfABrowser) {
    const std::vector<PageModule> modules{
        {"main.js", "import {a} from './some/a.js';\nimport * as tools from './tools.js';\nrun(a);\n"},
        {"a.js", "import {b} from './b.js';\nimport * as tools from '../tools.js';\nimport {link} from "
                 "'./link.js';\nexport const a = b();\n"},
        {"b.js", "import {a} from './a.js';\nexport async function b() { return () => a; }\n"},
        {"link.js", "socket();\n"},
        {"saved.js", "export class Link {}\n"},
        {"tools.js", "export const one = 1;\nexport function two() {}\n"},
    };
    EXPECT_EQ(bundle(modules, "main.js", {"link.js", "saved.js"}).value(),
              "async function b() { return () => a; }\nconst one = 1;\nfunction two() {}\nconst tools = {one, two};\n"
              "class Link {}\nconst a = b();\nrun(a);\n");
    const std::vector<PageModule> broken{{"main.js", "import {a} from './gone.js';\n"}};
    EXPECT_FALSE(bundle(broken, "main.js", {"link.js", "saved.js"}));
}

std::size_t times_in(std::string_view text, std::string_view word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

TEST(PageDocument, LetsNoNameOutOfItsElement) {
    const std::string hostile = "</script><script>alert(1)</script><!--\"'&\xff";
    Json saved;
    saved["grid"] = {{"name", hostile}};
    const std::string plain = page_document("plain", Json::object(), {{"part", "AAAA"}}).value();
    const std::string html = page_document(hostile, saved, {{"part", "AAAA"}}).value();
    EXPECT_EQ(times_in(html, "<script"), times_in(plain, "<script"));
    EXPECT_EQ(times_in(html, "</script"), times_in(plain, "</script"));
    EXPECT_EQ(times_in(html, "<!--"), times_in(plain, "<!--"));
    EXPECT_NE(html.find("<title>&lt;/script&gt;&lt;script&gt;alert(1)"), std::string::npos);
}

/// Of what ends elements, attributes, texts of JSON and of scripts, and of letters that change how others are shown.
std::string hostile_name(std::mt19937& random) {
    constexpr std::array<std::string_view, 22> pieces{
        "</script>",        "</SCRIPT ", "<script>", "<!--",    "-->",          "]]>",
        "</title>",         "\"",        "'",        "&",       "&lt;",         "\\",
        "\\u003c",          "`${x}`",    "\n",       {"\0", 1}, "\xe2\x80\xae", "\xe2\x80\xa8",
        "\xf0\x9f\x98\x80", "\xd7\x90",  "<",        "a"};
    std::string name;
    for (std::size_t i = 0; i < 6; ++i)
        name += pieces.at(std::uniform_int_distribution<std::size_t>(0, pieces.size() - 1)(random));
    return name;
}

std::string read_html_text(std::string text) {
    for (const auto& [entity, letter] : {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&quot;", "\""},
                                         std::pair{"&#39;", "'"}, std::pair{"&amp;", "&"}})
        for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at)
            text.replace(at, std::string_view(entity).size(), letter);
    return text;
}

TEST(PageDocument, KeepsHostileNamesAsTheyAre) {
    std::mt19937 random(11);
    for (int i = 0; i < 500; ++i) {
        const std::string name = hostile_name(random);
        const Json saved = {{"file", name}, {name, {name}}};
        const std::string json = json_in_html(saved), text = html_text(name);
        EXPECT_EQ(json.find('<'), std::string::npos) << json;
        EXPECT_EQ(parse_json(json).value(), saved) << json;
        EXPECT_EQ(text.find_first_of("<>\"'"), std::string::npos) << text;
        EXPECT_EQ(read_html_text(text), name);
    }
    const std::string plain = page_document("plain", Json::object(), {{"part", "AAAA"}}).value();
    for (int i = 0; i < 8; ++i) {
        const std::string name = hostile_name(random);
        const std::string html = page_document(name, {{"file", name}}, {{"part", "AAAA"}}).value();
        for (const std::string_view mark : {"<script", "</script", "<!--", "</title", "Content-Security-Policy"})
            EXPECT_EQ(times_in(html, mark), times_in(plain, mark)) << mark << ": " << name;
    }
}

TEST(PageDocument, LoadsNothing) {
    const std::string html = page_document("plain", Json::object(), {}).value();
    EXPECT_NE(html.find("Security-Policy\" content=\"default-src 'none'; script-src 'sha256-"), std::string::npos);
    EXPECT_EQ(html.find(" src=\""), std::string::npos);
    EXPECT_EQ(html.find("href=\"style"), std::string::npos);
    EXPECT_EQ(html.find("WebSocket("), std::string::npos);
    EXPECT_EQ(html.find("\nimport "), std::string::npos);
}

ViewerInput sphere_input(std::uint64_t side) {
    MakeOptions options;
    options.shape = "kuhn";
    options.side = side;
    options.fields = {"sphere", "gyroid"};
    ViewerInput input;
    input.grid = make_grid(options).value();
    input.state.field = "sphere";
    return input;
}

SavedSurfacesOptions some_options() {
    SavedSurfacesOptions options;
    options.file = "ball.vtu";
    options.version = "1";
    options.count = 7;
    options.steps = {0};
    return options;
}

TEST(SaveSurfaces, HaveTheTrianglesThatAreExtracted) {
    const ViewerInput input = sphere_input(12);
    const PointField field = find_field(input.grid, "sphere").value();
    const SavedSurfaces saved = save_surfaces(input, {}, some_options()).value();
    ASSERT_EQ(saved.isovalues.size(), 7U);
    EXPECT_EQ(saved.left_out, 0U);
    EXPECT_TRUE(saved.boundary);
    std::uint64_t triangles = 0;
    for (const auto& one : extract_direct(input.grid, field, saved.isovalues).value().surfaces)
        triangles += one.surface.triangle_count();
    EXPECT_EQ(saved.triangles, triangles);
    EXPECT_EQ(saved.html, save_surfaces(input, {}, some_options(), {3, {}}).value().html);
}

TEST(SaveSurfaces, LeavesSurfacesOutEvenlyUntilTheFileFits) {
    const ViewerInput input = sphere_input(12);
    SavedSurfacesOptions options = some_options();
    const SavedSurfaces all = save_surfaces(input, {}, options).value();
    options.max_bytes = all.html.size() - all.data_bytes / 3;
    const SavedSurfaces some = save_surfaces(input, {}, options).value();
    EXPECT_LE(some.html.size(), options.max_bytes);
    EXPECT_EQ(some.isovalues, (std::vector<double>{all.isovalues[1], all.isovalues[3], all.isovalues[5]}));
    EXPECT_EQ(some.left_out, 4U);
    ASSERT_FALSE(some.notes.empty());
    EXPECT_NE(some.notes.front().find("3 of 7 isovalues"), std::string::npos);

    options.max_bytes = 1000;
    const auto none = save_surfaces(input, {}, options);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::invalid_argument);
}

/// What the page is told.
Json saved_in(const SavedSurfaces& saved) {
    const std::string begin = R"(id="saved">)";
    const std::size_t at = saved.html.find(begin) + begin.size();
    return parse_json(saved.html.substr(at, saved.html.find("</script>", at) - at)).value();
}

TEST(SaveSurfaces, BeginWithTheColouredBoundaryWhereItIsSeenFirst) {
    ViewerInput input = sphere_input(12);
    const std::uint64_t isosurfaces_first = save_surfaces(input, {}, some_options()).value().triangles;
    input.state.isosurfaces = false;
    input.state.boundary = 1;
    input.state.color_by = input.state.field;
    input.state.colored_boundary = true;
    const SavedSurfaces saved = save_surfaces(input, {}, some_options()).value();
    EXPECT_EQ(saved.triangles, isosurfaces_first);
    Json told = saved_in(saved);
    EXPECT_EQ(told["grid"]["state"]["isosurfaces"], false);
    EXPECT_EQ(told["boundaries"].size(), 1U);
    EXPECT_TRUE(told["boundaries"][0].contains("scale"));
    EXPECT_FALSE(told["surfaces"][0].contains("scale")) << "the colour of one value says nothing";

    SavedSurfacesOptions options = some_options();
    options.max_bytes = 1;
    while (options.max_bytes < saved.html.size() && !save_surfaces(input, {}, options))
        options.max_bytes = options.max_bytes * 11 / 10 + 1;
    const SavedSurfaces least = save_surfaces(input, {}, options).value();
    told = saved_in(least);
    EXPECT_EQ(told["grid"]["state"]["isosurfaces"], !least.boundary);
}

TEST(SaveSurfaces, KeepsIsovaluesThatWereNamed) {
    const ViewerInput input = sphere_input(8);
    SavedSurfacesOptions options = some_options();
    options.isovalues = {0.7, 0.3, 0.7};
    const SavedSurfaces saved = save_surfaces(input, {}, options).value();
    EXPECT_EQ(saved.isovalues, (std::vector<double>{0.3, 0.7}));
    options.max_bytes = saved.html.size() - 1;
    const auto refused = save_surfaces(input, {}, options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("`max_size`"), std::string::npos);
}

TEST(SaveSurfaces, RefuseAFieldWithoutARange) {
    ViewerInput input = sphere_input(2);
    std::vector<float> ones(input.grid.points.tuples(), 1.0F);
    input.grid.point_fields.push_back({"one", Array::own(std::move(ones))});
    input.state.field = "one";
    const auto refused = save_surfaces(input, {}, some_options());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
}

} // namespace
} // namespace isotet::test
