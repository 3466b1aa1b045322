// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// 3MF: the meshes of all objects, where they stand in the file.
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <pugixml.hpp>

#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "io/files/pace.hpp"
#include "io/files/zip.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::io {
namespace {

constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t most_expansion = 1000; // of text, by deflate
constexpr std::uint64_t memory_per_text = 6;   // of the tree that is made of it

/// The name without the part before a colon.
std::string_view local_name(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    return name.substr(name.rfind(':') + 1);
}

/// Appends the meshes below a node, one after another.
class Meshes {
public:
    explicit Meshes(const Progress& progress) : pace_(progress, 0) {}

    Result<void> add_all_below(const pugi::xml_node& node) {
        for (const pugi::xml_node& child : node.children()) {
            if (!pace_.goes_on(0)) return Pace::cancelled();
            const std::string_view name = local_name(child);
            Result<void> done;
            if (name == "mesh") done = add(child);
            else if (name == "resources" || name == "object") done = add_all_below(child);
            else if (name == "components") assembled_ = true;
            else if (name == "build") look_at_items(child);
            if (!done) return done;
        }
        return {};
    }

    bool assembled() const { return assembled_; }

    Surface take() {
        Surface surface;
        surface.positions = Array::own(std::move(positions_), 3);
        surface.triangles = Array::own(std::move(triangles_), 3);
        return surface;
    }

private:
    void look_at_items(const pugi::xml_node& build) {
        for (const pugi::xml_node& item : build.children())
            if (item.attribute("transform")) assembled_ = true;
    }

    Result<void> add(const pugi::xml_node& mesh) {
        const std::uint64_t first = positions_.size() / 3;
        for (const pugi::xml_node& part : mesh.children()) {
            if (local_name(part) == "vertices")
                for (const pugi::xml_node& vertex : part.children()) {
                    if (!pace_.goes_on(0)) return Pace::cancelled();
                    for (const char* axis : {"x", "y", "z"})
                        positions_.push_back(vertex.attribute(axis).as_double(not_given));
                }
        }
        const std::uint64_t vertices = positions_.size() / 3 - first;
        for (const pugi::xml_node& part : mesh.children()) {
            if (local_name(part) != "triangles") continue;
            for (const pugi::xml_node& triangle : part.children()) {
                if (!pace_.goes_on(0)) return Pace::cancelled();
                if (auto ok = add_triangle(triangle, first, vertices); !ok) return ok;
            }
        }
        return {};
    }

    Result<void> add_triangle(const pugi::xml_node& triangle, std::uint64_t first, std::uint64_t vertices) {
        for (const char* corner : {"v1", "v2", "v3"}) {
            const std::uint64_t vertex = triangle.attribute(corner).as_ullong(vertices);
            if (vertex >= vertices)
                return invalid_data(fmt::format("a triangle has {} = \"{}\", but its mesh has {} vertices", corner,
                                                triangle.attribute(corner).value(), vertices));
            triangles_.push_back(first + vertex);
        }
        return {};
    }

    Pace pace_;
    std::vector<double> positions_;
    std::vector<std::uint64_t> triangles_;
    bool assembled_ = false;
};

} // namespace

Result<Surface> parse_3mf(std::string_view content, std::vector<std::string>& notes, const Progress& progress) {
    const std::uint64_t most = most_expansion * content.size();
    Result<std::string> model = read_from_zip(content, ".model", most);
    if (!model) return model.error();
    if (auto enough = core::require_memory("reading 3MF", memory_per_text * model->size()); !enough)
        return enough.error();
    pugi::xml_document document;
    if (const auto parsed = document.load_buffer_inplace(model->data(), model->size()); !parsed)
        return invalid_data(
            fmt::format("the model of the 3MF file is not XML: {} at byte {}", parsed.description(), parsed.offset));
    const pugi::xml_node root = document.document_element();
    if (local_name(root) != "model")
        return invalid_data(fmt::format("the model of the 3MF file is an element \"{}\", not \"model\"", root.name()));
    Meshes meshes(progress);
    if (auto ok = meshes.add_all_below(root); !ok) return ok.error();
    if (meshes.assembled()) notes.push_back("3MF: components and transforms are not followed: each mesh is read once");
    return meshes.take();
}

} // namespace isotet::io
