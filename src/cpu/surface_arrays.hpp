// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "base/array_slot.hpp"
#include "cpu/extract.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

/// The arrays of one surface.
template <class Real>
class SurfaceArrays {
public:
    /// `number`   of the isovalue in the request
    SurfaceArrays(const ops::Request<Real>& request, std::size_t number, const Total& total)
        : total_(total), wide_(total.vertices >= wide_from) {
        const std::size_t vertices = total.vertices, triangles = total.triangles;
        const auto make = [&]<class T>(core::SharedBuffer<T>& to, SurfaceArray array, std::size_t tuples,
                                       std::size_t components, std::size_t field = 0) {
            to = core::slot_of(request.slots, number, array, field).template make<T>(tuples, components);
        };
        make(positions_, SurfaceArray::positions, vertices, 3);
        if (wide_) make(wide_triangles_, SurfaceArray::triangles, triangles, 3);
        else make(triangles_, SurfaceArray::triangles, triangles, 3);
        if (request.normals) make(normals_, SurfaceArray::normals, vertices, 3);
        if (request.ends) {
            make(ends_, SurfaceArray::edge_ends, vertices, 2);
            make(weights_, SurfaceArray::edge_weights, vertices, 1);
        }
        if (request.source_cells) make(source_cells_, SurfaceArray::source_cells, triangles, 1);
        fields_.resize(request.fields.size());
        for (std::size_t i = 0; i < fields_.size(); ++i)
            make(fields_[i], SurfaceArray::point_field, vertices, request.fields[i].values.components(), i);
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
        for (core::SharedBuffer<Real>& field : fields_) target.fields.push_back(field.data());
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
    core::SharedBuffer<Real> positions_;
    core::SharedBuffer<std::uint32_t> triangles_;
    core::SharedBuffer<std::uint64_t> wide_triangles_;
    core::SharedBuffer<float> normals_;
    core::SharedBuffer<std::int64_t> ends_;
    core::SharedBuffer<Real> weights_;
    core::SharedBuffer<std::int64_t> source_cells_;
    std::vector<core::SharedBuffer<Real>> fields_;
};

} // namespace isotet::cpu
