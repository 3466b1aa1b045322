// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/kernels/pipelines.hpp"

#include <map>

#include "all_shaders.hpp"
#include "render/kernels/scene.h"

namespace isotet::bench {

namespace {

namespace shaders = vulkan::all_shaders;
namespace layout = render::layout;
using vulkan::ShaderCode;

void add_compute(std::vector<Pipeline>& all, const ShaderCode& code, std::string variant = {},
                 std::vector<std::uint32_t> constants = {}) {
    all.push_back({code.name, std::move(variant), {{&code, VK_SHADER_STAGE_COMPUTE_BIT}}, std::move(constants), true});
}

void append(std::string& text, bool condition, const char* what) {
    if (condition) text += text.empty() ? what : std::string(", ") + what;
}

void add_engine(std::vector<Pipeline>& all) {
    add_compute(all, shaders::select);
    for (const std::uint32_t others : {0u, 1u})
        add_compute(all, shaders::count, others ? "native cells" : "tets", {others});
    add_compute(all, shaders::scan);
    for (const std::uint32_t many : {0u, 1u})
        for (std::uint32_t bits = 0; bits < 16; ++bits) {
            const std::uint32_t others = bits >> 3, ends = bits & 1, normals = bits >> 1 & 1, sources = bits >> 2 & 1;
            std::string variant = others ? "native cells" : "tets";
            append(variant, ends, "ends");
            append(variant, normals, "normals");
            append(variant, sources, "sources");
            append(variant, many, "many edges");
            add_compute(all, shaders::emit, std::move(variant), {many, ends, normals, sources, others});
        }
    for (const ShaderCode* code : {&shaders::ranges, &shaders::face_normals, &shaders::lowest_triangles,
                                   &shaders::missing_normals, &shaders::fields, &shaders::self_test})
        add_compute(all, *code);
}

void add_draw(std::vector<Pipeline>& all, Stage first, const ShaderCode& fragment, bool opaque, std::string variant,
              std::vector<std::uint32_t> constants) {
    all.push_back({first.code->name,
                   std::move(variant),
                   {first, {&fragment, VK_SHADER_STAGE_FRAGMENT_BIT}},
                   std::move(constants),
                   opaque});
}

void add_meshes(std::vector<Pipeline>& all) {
    static constexpr const char* colored[] = {"one colour", "by vertex", "by grid point", "by triangle", "by grid tet"};
    for (const bool opaque : {true, false})
        for (std::uint32_t coloring = 0; coloring <= layout::by_grid_tet; ++coloring)
            for (const std::uint32_t normals : {0u, 1u}) {
                std::string variant = colored[coloring];
                append(variant, normals, "normals");
                append(variant, !opaque, "translucent");
                add_draw(all, {&shaders::mesh_corners, VK_SHADER_STAGE_VERTEX_BIT},
                         opaque ? shaders::mesh_opaque : shaders::mesh_translucent, opaque, std::move(variant),
                         {coloring, normals});
            }
}

void add_tets(std::vector<Pipeline>& all) {
    static constexpr const char* methods[] = {"registers", "registers_instanced", "textures"};
    for (std::uint32_t bits = 0; bits < 4; ++bits)
        for (std::uint32_t method = 0; method <= layout::textures_method; ++method) {
            const std::uint32_t listed = bits & 1, shading = bits >> 1;
            std::string variant = methods[method];
            append(variant, listed, "list");
            append(variant, shading, "gradients");
            const std::vector<std::uint32_t> constants{layout::one_color, shading, method, listed, shading};
            add_compute(all, shaders::tet_twin, variant, constants);
            for (const bool opaque : {true, false}) {
                const ShaderCode& fragment = opaque ? shaders::mesh_opaque : shaders::mesh_translucent;
                std::string drawn = variant;
                append(drawn, !opaque, "translucent");
                add_draw(all, {&shaders::tet_corners, VK_SHADER_STAGE_VERTEX_BIT}, fragment, opaque, drawn, constants);
                if (method != layout::textures_method) continue;
                add_draw(all, {&shaders::tet_groups, VK_SHADER_STAGE_MESH_BIT_EXT}, fragment, opaque, drawn, constants);
            }
        }
}

void add_volumes(std::vector<Pipeline>& all) {
    for (const std::uint32_t parallel : {0u, 1u})
        for (const std::uint32_t isosurfaces : {0u, 1u}) {
            std::string variant = isosurfaces ? "isosurfaces" : "media";
            append(variant, parallel, "parallel");
            for (const ShaderCode* code : {&shaders::volume_rays, &shaders::volume_rays_without_doubles})
                add_compute(all, *code, variant, {parallel, isosurfaces});
        }
}

} // namespace

std::vector<Pipeline> all_pipelines() {
    std::vector<Pipeline> all;
    add_engine(all);
    add_compute(all, shaders::resolve);
    add_draw(all, {&shaders::line_corners, VK_SHADER_STAGE_VERTEX_BIT}, shaders::line, true, {}, {});
    add_meshes(all);
    add_tets(all);
    add_volumes(all);
    return all;
}

std::vector<std::uint32_t> specialized(const vulkan::ShaderCode& code, const std::vector<std::uint32_t>& constants) {
    // Numbers of the SPIR-V specification.
    constexpr std::uint32_t op_decorate = 71, spec_id = 1, op_spec_true = 48, op_spec_false = 49, op_spec = 50;
    constexpr std::uint32_t op_true = 41, op_false = 42, op_constant = 43;
    constexpr std::size_t header_words = 5;
    std::vector<std::uint32_t> words(code.words.begin(), code.words.begin() + header_words);
    std::map<std::uint32_t, std::uint32_t> places; // by the number of the result
    for (std::size_t i = header_words; i < code.words.size() && code.words[i] >> 16 != 0; i += code.words[i] >> 16) {
        const std::uint32_t* const from = &code.words[i];
        const std::uint32_t opcode = from[0] & 0xffff, length = from[0] >> 16;
        if (opcode == op_decorate && from[2] == spec_id) {
            places[from[1]] = from[3];
            continue;
        }
        const std::size_t at = words.size();
        words.insert(words.end(), from, from + length);
        if (opcode != op_spec_true && opcode != op_spec_false && opcode != op_spec) continue;
        const auto place = places.find(from[2]);
        const bool given = place != places.end() && place->second < constants.size();
        if (opcode == op_spec) {
            words[at] = length << 16 | op_constant;
            if (given) words[at + 3] = constants[place->second];
        } else {
            const bool value = given ? constants[place->second] != 0 : opcode == op_spec_true;
            words[at] = length << 16 | (value ? op_true : op_false);
        }
    }
    return words;
}

} // namespace isotet::bench
