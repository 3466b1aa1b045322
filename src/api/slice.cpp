// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/slice.hpp>

#include <fmt/core.h>

#include "grid/points/slice_function.hpp"
#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"

namespace isotet {

namespace {

template <class Function>
Result<PointField> field_of_function(const Array& points, const Function& function, const Progress& progress) {
    if (auto ok = function.check(); !ok) return ok.error();
    if (points.components() != 3 || !is_floating(points.type()))
        return invalid_data(fmt::format("points are {} with {} components, but must be float32 or float64 with 3",
                                        name_of(points.type()), points.components()));
    if (auto fits = core::require_memory("slicing", points.tuples() * sizeof(double)); !fits) return fits.error();
    core::Buffer<double> values(points.tuples());
    points.visit([&](auto scalars) {
        core::parallel_pieces(values.size(), std::size_t{1} << 16, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                values[i] =
                    function(core::Vector3{static_cast<double>(scalars[3 * i]), static_cast<double>(scalars[3 * i + 1]),
                                           static_cast<double>(scalars[3 * i + 2])});
        });
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "slicing was cancelled"};
    return PointField{function.name(), std::move(values).to_array(), false, {}};
}

} // namespace

Result<PointField> slice_field(const Array& points, const SliceShape& shape, const Run& run) {
    return core::carry_out("slicing", run, [&](const Progress& progress) {
        return std::visit([&](const auto& one) { return field_of_function(points, core::function_of(one), progress); },
                          shape);
    });
}

double slice_isovalue(const SliceShape& shape) noexcept {
    struct Isovalue {
        double operator()(const Plane& plane) const { return plane.offset; }
        double operator()(const Sphere& sphere) const { return sphere.radius; }
        double operator()(const Cylinder& cylinder) const { return cylinder.radius; }
    };
    return std::visit(Isovalue(), shape);
}

} // namespace isotet
