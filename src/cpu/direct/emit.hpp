// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The surface from welded edges and the polygons made of them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/array_slot.hpp"
#include "cpu/direct/weld.hpp"
#include "numbers/arithmetic.hpp"

namespace isotet::cpu::direct {

/// What vertices are made from: values and positions as they are stored.
template <class Real>
class VertexSource {
public:
    VertexSource(const ops::DirectInput& input, const PointSurvey& survey, const core::StoredIsovalue<Real>& isovalue)
        : input_(&input),
          origin_(survey.origin),
          storage_(survey.field.storage),
          isovalue_(isovalue),
          value_bytes_(size_of(input.field.values.type())),
          point_bytes_(3 * size_of(input.grid.points.type())) {}

    const ops::DirectInput& input() const { return *input_; }
    const core::StoredIsovalue<Real>& isovalue() const { return isovalue_; }
    Real value(std::uint64_t point) const {
        const Array& values = input_->field.values;
        const double user = values.type() == ScalarType::float32
                                ? static_cast<double>(values.as<float>()[point])
                                : values.visit([&](auto typed) { return static_cast<double>(typed[point]); });
        return core::store_value<Real>(user, storage_);
    }
    core::Vector<Real> position(std::uint64_t point) const {
        core::Vector<Real> stored;
        if (input_->grid.points.type() == ScalarType::float32) { // these have no origin
            const float* const user = input_->grid.points.as<float>().data() + 3 * point;
            for (std::size_t axis = 0; axis < 3; ++axis) stored[axis] = core::store_coordinate<Real>(user[axis], 0);
        } else {
            const double* const user = input_->grid.points.as<double>().data() + 3 * point;
            for (std::size_t axis = 0; axis < 3; ++axis)
                stored[axis] = core::store_coordinate<Real>(user[axis], origin_[axis]);
        }
        return stored;
    }

    /// Asks for what value() and position() will read: in grids without order waiting for memory is what costs most.
    void prefetch(std::uint64_t point) const {
        __builtin_prefetch(static_cast<const std::byte*>(input_->field.values.data()) + point * value_bytes_);
        __builtin_prefetch(static_cast<const std::byte*>(input_->grid.points.data()) + point * point_bytes_);
    }

private:
    const ops::DirectInput* input_;
    std::array<double, 3> origin_;
    core::Storage storage_;
    core::StoredIsovalue<Real> isovalue_;
    std::size_t value_bytes_, point_bytes_;
};

/// What is wanted, and how wide the numbers of vertices are.
struct EmitOptions {
    bool ends = false;
    bool source_cells = false;
    bool wide = false;
    const core::ArraySlots* slots = nullptr; ///< not null: those of the request
    std::size_t surface = 0;                 ///< its number there

    core::ArraySlot slot(SurfaceArray array) const {
        return slots ? core::slot_of(*slots, surface, array) : core::ArraySlot();
    }
};

/// Bytes of what emit() makes, and beside it while it works.
template <class Real, class Point>
std::uint64_t emitting_memory(std::uint64_t vertices, std::uint64_t triangles, std::uint64_t edges,
                              const EmitOptions& options);

/// Positions, triangles, and what else is wanted, but no normals.
/// Errors   cancelled
template <class Real, class Point>
Result<ops::RawSurface> emit(const VertexSource<Real>& source, const CutCells<Point>& cut, Welded<Point> welded,
                             const EmitOptions& options, const Progress& progress);

} // namespace isotet::cpu::direct
