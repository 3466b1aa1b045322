// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From what an engine gives to the surface that the caller asked for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/export.hpp>
#include <isotet/extract.hpp>

#include "base/array_slot.hpp"
#include "ops/extraction.hpp"
#include "packed/packed.hpp"

namespace isotet::api {

/// Errors   invalid_argument for an isovalue that is not finite
ISOTET_API Result<void> check_isovalues(std::span<const double> isovalues);

/// How coordinates are stored: relative to an origin, of points of this type.
struct Placement {
    std::array<double, 3> origin{};
    ScalarType point_type = ScalarType::float32;
};

/// Where all arrays of surfaces are made: nothing where the caller gives no memory. Refers to `options`.
core::ArraySlots slots_of(const ExtractOptions& options, SurfaceSink* sink);

/// Those of arrays that finish() takes as an engine made them. Without `storages`, point fields are not among them.
template <class Real>
core::ArraySlots slots_for_engine(core::ArraySlots all, const Placement& placement, const ExtractOptions& options,
                                  std::span<const core::Storage> storages);

/// Geometry, normals and fields in the user's coordinates and units. `storages` are those of the point fields of
/// `options`, in their order; `number` is that of the surface in the call.
template <class Real>
ISOTET_API Surface finish(const Placement& placement, const ExtractOptions& options,
                          std::span<const core::Storage> storages, const ops::RawSurface& raw,
                          const core::ArraySlots& slots = {}, std::size_t number = 0);

/// Bytes at most that finish() adds to each vertex and triangle of the surface of an engine that interpolates point
/// fields itself.
struct MoreBytes {
    std::size_t vertex = 0, triangle = 0;
};
MoreBytes more_bytes(const ExtractOptions& options, const Placement& placement);

/// All arrays of a surface.
ISOTET_API std::uint64_t bytes_of(const Surface& surface);

} // namespace isotet::api
