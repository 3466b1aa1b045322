// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// GLB: glTF 2.0 in one binary file. A mesh for each isovalue and part; vertices once, for all of them. Time steps are
// shown one after another.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "check/triangle_groups.hpp"
#include "io/files/scalars.hpp"
#include "io/surfaces/float_positions.hpp"
#include "io/surfaces/surface_colors.hpp"
#include "io/write/write_names.hpp"
#include "io/write/write_text.hpp"

namespace isotet::io {
namespace {

using checking::TriangleGroup;
using checking::triangle_groups;

using Json = nlohmann::ordered_json;

constexpr std::uint32_t glb_magic = 0x46546C67, glb_version = 2, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr int type_uint16 = 5123, type_uint32 = 5125, type_float32 = 5126;
constexpr int vertex_buffer = 34962, index_buffer = 34963, no_target = 0;
constexpr std::array<std::string_view, 4> group_fields{animation_field, "isovalue", "part", "boundary"};
constexpr double seconds_each = 0.25; ///< of a time step in an animation
constexpr std::array<const char*, 5> shapes{"", "SCALAR", "VEC2", "VEC3", "VEC4"};

/// A part of the binary chunk, in words of four bytes.
struct Block {
    std::size_t rows = 0, bytes_a_row = 0;
    RowWriter write;
};

/// What the file describes, as it grows.
struct Document {
    Json views = Json::array(), accessors = Json::array();
    std::vector<Block> blocks;
    std::uint64_t bytes = 0;

    /// Returns its number among the accessors.
    std::size_t add(Block block, int component, const char* shape, int target, Json more = Json::object()) {
        const std::uint64_t size = std::uint64_t{block.rows} * block.bytes_a_row;
        views.push_back({{"buffer", 0}, {"byteOffset", bytes}, {"byteLength", size}});
        if (target != no_target) views.back()["target"] = target;
        const std::size_t count = target == index_buffer ? 3 * block.rows : block.rows;
        Json accessor{
            {"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", shape}};
        accessor.update(more);
        accessors.push_back(std::move(accessor));
        blocks.push_back(std::move(block));
        bytes += size;
        return accessors.size() - 1;
    }
};

template <class Number>
void put(Number value, std::string& out) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
}

/// Calls f(row, values) with a column's values as float32.
template <class F>
void for_floats(const Column& column, std::size_t begin, std::size_t end, const F& f) {
    std::vector<std::byte> bytes((end - begin) * column.tuple_bytes());
    column.fill(begin, end, bytes.data());
    std::vector<float> row(column.components);
    with_type(column.type, [&]<class T>(T) {
        const T* values = reinterpret_cast<const T*>(bytes.data());
        for (std::size_t i = begin; i < end; ++i) {
            for (float& value : row) value = to_float(static_cast<double>(*values++));
            f(i, row);
        }
    });
}

bool all_finite(const Column& column) {
    constexpr std::size_t at_once = 1 << 16;
    bool finite = true;
    for (std::size_t begin = 0; begin < column.tuples && finite; begin += at_once)
        for_floats(column, begin, std::min(begin + at_once, column.tuples), [&](std::size_t, const auto& row) {
            for (const float value : row) finite = finite && std::isfinite(value);
        });
    return finite;
}

std::size_t add_positions(Document& document, const Surface& surface, const FloatPositions& positions) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::array<float, 3> lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
    for (std::uint64_t vertex = 0; vertex < surface.vertex_count(); ++vertex) {
        const auto place = positions.at(surface, vertex);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], place[axis]);
            upper[axis] = std::max(upper[axis], place[axis]);
        }
    }
    const auto write = [&surface, positions](std::size_t begin, std::size_t end, std::string& out) {
        for (std::size_t vertex = begin; vertex < end; ++vertex)
            for (const float x : positions.at(surface, vertex)) put(x, out);
    };
    return document.add({surface.vertex_count(), 12, write}, type_float32, "VEC3", vertex_buffer,
                        {{"min", lower}, {"max", upper}});
}

/// Where none is defined, along z: the format has no place for normals of length zero.
std::size_t add_normals(Document& document, const Column& normals) {
    const auto write = [normals](std::size_t begin, std::size_t end, std::string& out) {
        for_floats(normals, begin, end, [&](std::size_t, std::vector<float>& row) {
            if (row[0] == 0 && row[1] == 0 && row[2] == 0) row[2] = 1;
            for (const float x : row) put(x, out);
        });
    };
    return document.add({normals.tuples, 12, write}, type_float32, "VEC3", vertex_buffer);
}

std::size_t add_colors(Document& document, const Column& colors) {
    const auto write = [colors, light = light_of_bytes()](std::size_t begin, std::size_t end, std::string& out) {
        const auto word = [](double x) { return static_cast<std::uint16_t>(std::lround(65535 * x)); };
        for_floats(colors, begin, end, [&](std::size_t, const std::vector<float>& row) {
            for (std::size_t i = 0; i < 3; ++i) put(word(light[static_cast<std::size_t>(row[i])]), out);
            put(word(row.size() == 4 ? static_cast<double>(row[3]) / 255 : 1), out);
        });
    };
    return document.add({colors.tuples, 8, write}, type_uint16, "VEC4", vertex_buffer, {{"normalized", true}});
}

std::size_t add_field(Document& document, const Column& field) {
    const auto write = [field](std::size_t begin, std::size_t end, std::string& out) {
        for_floats(field, begin, end, [&](std::size_t, const std::vector<float>& row) {
            for (const float x : row) put(x, out);
        });
    };
    return document.add({field.tuples, 4 * field.components, write}, type_float32, shapes[field.components],
                        vertex_buffer);
}

/// The attributes of vertices that all meshes share.
Json attributes_of(Document& document, const SurfaceToWrite& input, const FloatPositions& positions) {
    Json attributes{{"POSITION", add_positions(document, input.surface, positions)}};
    const SurfaceColumns& columns = input.columns;
    if (columns.point_normals) attributes["NORMAL"] = add_normals(document, *columns.point_normals);
    Names taken;
    for (const Column& field : columns.point_fields) {
        if (is_color(field) && !attributes.contains("COLOR_0")) {
            attributes["COLOR_0"] = add_colors(document, field);
        } else if (field.components > 4 || !all_finite(field)) {
            input.notes.push_back(fmt::format("GLB holds finite numbers of at most 4 components: \"{}\" was left out",
                                              printable_name(field.name)));
        } else {
            attributes["_" + take_name(ply_name(field.name), taken)] = add_field(document, field);
        }
    }
    return attributes;
}

Block indices_of(const Surface& surface, const TriangleGroup& group) {
    const auto write = [&surface, &group](std::size_t begin, std::size_t end, std::string& out) {
        surface.triangles.visit([&](auto corners) {
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    put(static_cast<std::uint32_t>(corners[3 * group.triangles[i] + k]), out);
        });
    };
    return {group.triangles.size(), 12, write};
}

Block block_of(std::vector<float> numbers, std::size_t components) {
    const std::size_t rows = numbers.size() / components;
    const auto write = [all = std::move(numbers), components](std::size_t begin, std::size_t end, std::string& out) {
        for (std::size_t i = begin * components; i < end * components; ++i) put(all[i], out);
    };
    return {rows, 4 * components, write};
}

/// Of nodes behind the first one, which have the groups' meshes: those of one time after another have the scale 1, the
/// others 0. Where no animation is played, those of the first time are there.
void add_animation(Document& document, const std::vector<TriangleGroup>& groups, Json& gltf) {
    std::vector<double> times;
    for (const TriangleGroup& group : groups)
        if (times.empty() || times.back() != group.key[0]) times.push_back(group.key[0]); // they ascend
    std::vector<float> begins;
    for (std::size_t i = 0; i <= times.size(); ++i) begins.push_back(static_cast<float>(seconds_each * double(i)));
    const Json range{{"min", Json::array({begins.front()})}, {"max", Json::array({begins.back()})}};
    const std::size_t input = document.add(block_of(begins, 1), type_float32, "SCALAR", no_target, range);
    Json samplers = Json::array(), channels = Json::array();
    for (std::size_t step = 0; step < times.size(); ++step) {
        std::vector<float> scales(3 * begins.size());
        const std::size_t last = step + 1 == times.size() ? step + 1 : step; // the last one stays
        for (std::size_t i = 3 * step; i < 3 * (last + 1); ++i) scales[i] = 1;
        const std::size_t output = document.add(block_of(std::move(scales), 3), type_float32, "VEC3", no_target);
        samplers.push_back({{"input", input}, {"interpolation", "STEP"}, {"output", output}});
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const std::size_t step = static_cast<std::size_t>(std::ranges::find(times, groups[i].key[0]) - times.begin());
        channels.push_back({{"sampler", step}, {"target", {{"node", i + 1}, {"path", "scale"}}}});
        if (step > 0) gltf["nodes"][i + 1]["scale"] = Json::array({0, 0, 0});
    }
    gltf["animations"] = Json::array({Json{{"name", "time"}, {"channels", channels}, {"samplers", samplers}}});
}

bool has_times(const Surface& surface) {
    return std::ranges::find(surface.cell_fields, animation_field, &Field::name) != surface.cell_fields.end();
}

/// Z is up in isotet and Y in glTF: a node above all turns.
Json scene_of(Document& document, const SurfaceToWrite& input, const std::vector<TriangleGroup>& groups,
              const FloatPositions& positions) {
    Json gltf{{"asset", {{"version", "2.0"}, {"generator", "isotet"}}}, {"scene", 0}};
    if (groups.empty()) {
        gltf["scenes"] = Json::array({Json::object()});
        return gltf;
    }
    const Json attributes = attributes_of(document, input, positions);
    Json nodes = Json::array(), meshes = Json::array(), children = Json::array();
    const Json turn = Json::array({-std::sqrt(0.5), 0, 0, std::sqrt(0.5)});
    nodes.push_back({{"name", "isotet"}, {"rotation", turn}});
    for (const TriangleGroup& group : groups) {
        const std::size_t indices = document.add(indices_of(input.surface, group), type_uint32, "SCALAR", index_buffer);
        std::string name = printable_name(group.name);
        if (name.starts_with(animation_field)) name.replace(0, animation_field.size(), "time");
        const Json primitive{{"attributes", attributes}, {"indices", indices}, {"material", 0}};
        meshes.push_back({{"name", name}, {"primitives", Json::array({primitive})}});
        children.push_back(nodes.size());
        nodes.push_back({{"name", name}, {"mesh", meshes.size() - 1}});
    }
    nodes[0]["children"] = children;
    if (positions.origin != std::array<double, 3>{}) nodes[0]["extras"] = {{"origin", positions.origin}};
    const double grey = attributes.contains("COLOR_0") ? 1 : 0.8;
    const Json color = Json::array({grey, grey, grey, 1});
    gltf["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
    gltf["nodes"] = std::move(nodes);
    gltf["meshes"] = std::move(meshes);
    const Json look{{"baseColorFactor", color}, {"metallicFactor", 0}, {"roughnessFactor", 0.6}};
    gltf["materials"] = Json::array({Json{{"name", "surface"}, {"pbrMetallicRoughness", look}, {"doubleSided", true}}});
    if (groups.size() > 1 && has_times(input.surface) && !groups[0].key.empty()) add_animation(document, groups, gltf);
    gltf["accessors"] = document.accessors;
    gltf["bufferViews"] = document.views;
    gltf["buffers"] = Json::array({Json{{"byteLength", document.bytes}}});
    return gltf;
}

} // namespace

Result<WriteReport> write_glb(const SurfaceToWrite& input) {
    const FloatPositions positions = float_positions(input, "GLB");
    std::vector<Column> cell_fields = input.columns.cell_fields;
    std::erase_if(cell_fields, [](const Column& field) {
        return std::ranges::find(group_fields, field.name) != group_fields.end();
    });
    note_left_out(input, "GLB", {&input.columns.edges, &cell_fields});
    const std::vector<TriangleGroup> groups = triangle_groups(input.surface, group_fields);
    Document document;
    std::string json = scene_of(document, input, groups, positions).dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::uint64_t head = 12 + 8 + json.size(), binary = document.bytes > 0 ? 8 + document.bytes : 0;
    if (head + binary > std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::invalid_argument,
                     fmt::format("GLB holds at most 4 GB, and this surface needs {} bytes", head + binary)};
    return write_file(input.path, input.progress, head + binary, [&](WriteStream& stream) {
        const auto number = [&](std::uint64_t value) {
            stream.number(static_cast<std::uint32_t>(value), std::endian::little);
        };
        number(glb_magic);
        number(glb_version);
        number(head + binary);
        number(json.size());
        number(json_chunk);
        stream.text(json);
        if (binary == 0) return;
        number(document.bytes);
        number(binary_chunk);
        for (const Block& block : document.blocks) stream.rows(block.rows, block.write);
    });
}

} // namespace isotet::io
