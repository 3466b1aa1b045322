// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Memory of the caller for the arrays of surfaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet {

/// The arrays of a Surface (surface.hpp).
enum class SurfaceArray : std::uint8_t {
    positions,
    triangles,
    normals,
    edge_ends,
    edge_weights,
    source_cells,
    point_field,
    cell_field
};

/// Gives the memory in which surfaces are made: a shared segment, a mapped file, memory that a device sees.
///
///     struct Segment : SurfaceSink {
///         std::shared_ptr<void> take(const Wanted& wanted) override { return reserve(wanted.bytes()); }
///     };
///     options.sink = std::make_shared<Segment>();
class ISOTET_API SurfaceSink {
public:
    struct Wanted {
        std::size_t surface = 0; ///< which of the call's isovalues
        SurfaceArray array = SurfaceArray::positions;
        std::string_view field; ///< its name; empty unless `array` is a field
        ScalarType type = ScalarType::float32;
        std::size_t tuples = 0, components = 1;

        std::size_t bytes() const noexcept { return tuples * components * size_of(type); }
    };

    virtual ~SurfaceSink();

    /// At least `wanted.bytes()`, aligned for the type, and their owner: by it the memory is known again. Null: there is none,
    /// and the call ends with out_of_memory.
    /// What is given is written and read by many threads during the call, and never written after it. It is given back
    /// when the last copy of the Array is gone, or during the call where that begins anew: of several requests for one
    /// array the last counts. Nothing is asked for an array without tuples.
    ///
    /// Threads   called by one thread of a call at a time
    /// Errors    what it throws ends the call as other exceptions do
    virtual std::shared_ptr<void> take(const Wanted& wanted) = 0;
};

} // namespace isotet
