// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>

#include "cpu/extract.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

/// The arrays of one surface.
template <class Real>
class SurfaceArrays {
public:
    SurfaceArrays(const ops::Request<Real>& request, const Total& total)
        : total_(total), wide_(total.vertices >= wide_from), positions_(3 * total.vertices),
          triangles_(wide_ ? 0 : 3 * total.triangles), wide_triangles_(wide_ ? 3 * total.triangles : 0),
          normals_(request.normals ? 3 * total.vertices : 0), ends_(request.ends ? 2 * total.vertices : 0),
          weights_(request.ends ? total.vertices : 0), source_cells_(request.source_cells ? total.triangles : 0) {
        for (const ops::CarriedField& field : request.fields)
            fields_.emplace_back(total.vertices * field.values.components());
    }

    static std::uint64_t bytes(const ops::Request<Real>& request, const Total& total) {
        const std::size_t index = total.vertices < wide_from ? 4 : 8;
        std::size_t vertex = 3 * sizeof(Real) + (request.ends ? 16 + sizeof(Real) : 0) + (request.normals ? 12 : 0);
        for (const ops::CarriedField& field : request.fields) vertex += field.values.components() * sizeof(Real);
        return total.vertices * vertex + total.triangles * (3 * index + (request.source_cells ? 8 : 0));
    }

    Target<Real> target(const ops::Request<Real>& request) {
        Target<Real> target;
        target.vertices = total_.vertices;
        target.positions = positions_.data();
        if (wide_) target.wide_triangles = wide_triangles_.data();
        else target.triangles = triangles_.data();
        if (request.normals) target.normals = normals_.data();
        if (request.ends) {
            target.ends = ends_.data();
            target.weights = weights_.data();
        }
        if (request.source_cells) target.source_cells = source_cells_.data();
        for (core::Buffer<Real>& field : fields_) target.fields.push_back(field.data());
        return target;
    }

    ops::RawSurface to_surface(const ops::Request<Real>& request) && {
        ops::RawSurface surface;
        surface.positions = std::move(positions_).to_array(3);
        surface.triangles = wide_ ? std::move(wide_triangles_).to_array(3) : std::move(triangles_).to_array(3);
        if (request.normals) surface.normals = std::move(normals_).to_array(3);
        if (request.ends) {
            surface.ends = std::move(ends_).to_array(2);
            surface.weights = std::move(weights_).to_array();
        }
        if (request.source_cells) surface.source_cells = std::move(source_cells_).to_array();
        for (std::size_t i = 0; i < fields_.size(); ++i)
            surface.fields.push_back(std::move(fields_[i]).to_array(request.fields[i].values.components()));
        surface.selected_clusters = total_.clusters;
        return surface;
    }

private:
    Total total_;
    bool wide_;
    core::Buffer<Real> positions_;
    core::Buffer<std::uint32_t> triangles_;
    core::Buffer<std::uint64_t> wide_triangles_;
    core::Buffer<float> normals_;
    core::Buffer<std::int64_t> ends_;
    core::Buffer<Real> weights_;
    core::Buffer<std::int64_t> source_cells_;
    std::vector<core::Buffer<Real>> fields_;
};

} // namespace isotet::cpu
