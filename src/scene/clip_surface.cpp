// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene/clip_surface.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "numbers/storage.hpp"

namespace isotet::scene {

namespace {

constexpr std::uint64_t no_vertex = std::numeric_limits<std::uint64_t>::max();

/// A vertex of the new surface: between two of the old one, or one of these.
struct Between {
    std::uint64_t a, b;
    double part;
};

class Clipping {
public:
    Clipping(const Surface& surface, const Plane& plane) : surface_(surface), height_(surface.vertex_count()) {
        surface.positions.visit([&](auto scalars) {
            for (std::size_t i = 0; i < height_.size(); ++i) {
                height_[i] = -plane.offset;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    height_[i] += plane.normal[axis] * static_cast<double>(scalars[3 * i + axis]);
            }
        });
        kept_.assign(height_.size(), no_vertex);
        surface.triangles.visit([&](auto corners) {
            for (std::size_t i = 0; i < surface.triangle_count(); ++i)
                add({static_cast<std::uint64_t>(corners[3 * i]), static_cast<std::uint64_t>(corners[3 * i + 1]),
                     static_cast<std::uint64_t>(corners[3 * i + 2])},
                    i);
        });
    }

    Surface take() const {
        Surface out;
        out.positions = mixed(surface_.positions);
        out.triangles = Array::own(triangles_, 3);
        if (are_of_vertices(surface_.normals_kind) && surface_.normals.tuples() == height_.size()) {
            out.normals_kind = surface_.normals_kind;
            out.normals = mixed(surface_.normals);
        }
        for (const Field& field : surface_.point_fields) out.point_fields.push_back({field.name, mixed(field.values)});
        for (const Field& field : surface_.cell_fields) {
            const std::size_t width = field.values.components();
            field.values.visit([&](auto scalars) {
                std::vector<std::remove_cvref_t<decltype(scalars[0])>> values;
                for (const std::uint64_t source : sources_)
                    for (std::size_t i = 0; i < width; ++i) values.push_back(scalars[source * width + i]);
                out.cell_fields.push_back({field.name, Array::own(std::move(values), width)});
            });
        }
        return out;
    }

private:
    std::uint64_t vertex(std::uint64_t a) {
        if (kept_[a] == no_vertex) {
            kept_[a] = vertices_.size();
            vertices_.push_back({a, a, 0});
        }
        return kept_[a];
    }
    std::uint64_t vertex_between(std::uint64_t a, std::uint64_t b) {
        if (a > b) std::swap(a, b);
        const auto [place, is_new] = cuts_.try_emplace({a, b}, vertices_.size());
        if (is_new) vertices_.push_back({a, b, height_[a] / (height_[a] - height_[b])});
        return place->second;
    }
    void add(const std::array<std::uint64_t, 3>& corners, std::uint64_t source) {
        std::array<std::uint64_t, 4> polygon{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t a = corners[i], b = corners[(i + 1) % 3];
            const bool keeps_a = height_[a] <= 0, keeps_b = height_[b] <= 0;
            if (keeps_a) polygon[count++] = vertex(a);
            if (keeps_a != keeps_b && height_[a] != 0 && height_[b] != 0) polygon[count++] = vertex_between(a, b);
        }
        for (std::size_t i = 2; i < count; ++i) {
            triangles_.insert(triangles_.end(), {polygon[0], polygon[i - 1], polygon[i]});
            sources_.push_back(source);
        }
    }

    Array mixed(const Array& values) const {
        const std::size_t width = values.components();
        return values.visit([&]<class Scalar>(std::span<const Scalar> scalars) {
            using Out = std::conditional_t<std::is_same_v<Scalar, float>, float, double>;
            std::vector<Out> out(vertices_.size() * width);
            for (std::size_t i = 0; i < out.size(); ++i) {
                const Between& v = vertices_[i / width];
                const auto a = static_cast<double>(scalars[v.a * width + i % width]),
                           b = static_cast<double>(scalars[v.b * width + i % width]);
                const double value = v.a == v.b ? a : a + (b - a) * v.part;
                if constexpr (std::is_same_v<Out, float>) out[i] = static_cast<float>(core::rounded_to_float(value));
                else out[i] = value;
            }
            return Array::own(std::move(out), width);
        });
    }

    const Surface& surface_;
    std::vector<double> height_;      ///< of each vertex above the plane
    std::vector<std::uint64_t> kept_; ///< the new number of a vertex
    std::map<std::array<std::uint64_t, 2>, std::uint64_t> cuts_;
    std::vector<Between> vertices_;
    std::vector<std::uint64_t> triangles_, sources_;
};

} // namespace

Surface clipped(const Surface& surface, const Plane& plane) { return Clipping(surface, plane).take(); }

DrawnLines edges_of(const Surface& surface) {
    std::vector<std::array<std::uint64_t, 2>> edges;
    surface.triangles.visit([&](auto corners) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto a = static_cast<std::uint64_t>(corners[i]),
                       b = static_cast<std::uint64_t>(corners[i % 3 == 2 ? i - 2 : i + 1]);
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
    });
    std::ranges::sort(edges);
    edges.erase(std::ranges::unique(edges).begin(), edges.end());
    DrawnLines lines;
    surface.positions.visit([&](auto scalars) {
        const auto place = [&](std::uint64_t i) {
            return std::array<double, 3>{static_cast<double>(scalars[3 * i]), static_cast<double>(scalars[3 * i + 1]),
                                         static_cast<double>(scalars[3 * i + 2])};
        };
        for (const auto& [a, b] : edges) lines.lines.push_back({place(a), place(b)});
    });
    return lines;
}

} // namespace isotet::scene
