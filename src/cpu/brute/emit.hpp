// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The surface from welded edges and the polygons made of them.
#pragma once

#include <cstdint>

#include "core/arithmetic.hpp"
#include "cpu/brute/weld.hpp"

namespace isotet::cpu {

/// What vertices are made from: values and positions as they are stored.
template <class Real>
class VertexSource {
public:
    VertexSource(const ops::BruteInput& input, const PointSurvey& survey, Real isovalue)
        : input_(&input), points_(input.grid.points), origin_(survey.origin), storage_(survey.field.storage), isovalue_(isovalue) {}

    const ops::BruteInput& input() const { return *input_; }
    Real isovalue() const { return isovalue_; }
    Real value(std::uint64_t point) const {
        const Array& values = input_->field.values;
        const double user = values.type() == ScalarType::float32
                                ? static_cast<double>(values.as<float>()[point])
                                : values.visit([&](auto typed) { return static_cast<double>(typed[point]); });
        return core::store_value<Real>(user, storage_);
    }
    core::Vector<Real> position(std::uint64_t point) const {
        const core::Point user = points_[point];
        core::Vector<Real> stored;
        for (std::size_t axis = 0; axis < 3; ++axis) stored[axis] = core::store_coordinate<Real>(user[axis], origin_[axis]);
        return stored;
    }

private:
    const ops::BruteInput* input_;
    core::PointReader points_;
    std::array<double, 3> origin_;
    core::Storage storage_;
    Real isovalue_;
};

/// What is wanted, and how wide the numbers of vertices are.
struct EmitOptions {
    bool ends = false;
    bool source_cells = false;
    bool wide = false;
};

/// Bytes of what emit() makes, and beside it while it works.
template <class Real, class Point>
std::uint64_t emitting_memory(std::uint64_t vertices, std::uint64_t triangles, std::uint64_t edges, const EmitOptions& options);

/// Positions, triangles, and what else is wanted, but no normals.
/// Errors   cancelled
template <class Real, class Point>
Result<ops::RawSurface> emit(const VertexSource<Real>& source, const CutCells<Point>& cut, Welded<Point> welded, const EmitOptions& options,
                             const Progress& progress);

} // namespace isotet::cpu
