// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A surface in the device's memory, where it can be drawn from: layout::Output at the head says how much there is and
// where, and holds the arguments of an indexed draw.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/result.hpp>

#include "ops/extraction.hpp"
#include "vulkan/context.hpp"
#include "vulkan/engine/address.hpp"
#include "vulkan/engine/layout.hpp"

namespace isotet::vulkan {

/// Which arrays a surface has besides positions and triangles.
struct SurfaceParts {
    Normals normals = Normals::none;
    bool ends = false; ///< and weights; needed for fields
    bool sources = false;
    std::vector<std::uint32_t> fields; ///< components of each

    friend bool operator==(const SurfaceParts&, const SurfaceParts&) = default;
};

/// Arrays are made for more than is needed, so that the next surface is likely to fit, and only ever grow.
///
/// Threads   one thread at a time
class ISOTET_API SurfaceBuffers {
public:
    Buffer head; ///< layout::Output
    Buffer positions, triangles, normals, lowest, ends, weights, sources;
    std::vector<Buffer> fields; ///< float x components a vertex

    std::uint64_t vertex_count() const noexcept { return result.vertices_low; }
    std::uint64_t triangle_count() const noexcept { return result.triangles_low; }
    std::uint64_t bytes() const; ///< of device memory

    const SurfaceParts& parts() const noexcept { return parts_; }

    /// The head as the device has it at the beginning: room and addresses. As the device left it: `result`.
    layout::Output empty_head() const;
    layout::Output result{};

    /// Takes a head; drops arrays that the parts do not have.
    Result<void> prepare(Context& context, const SurfaceParts& parts);

    /// Makes room for a surface of this size: fewer than 2^32 of each, what was in the arrays is lost.
    enum class Room : std::uint8_t { exact, spare /* a quarter more */ };
    Result<void> grow(Context& context, std::uint64_t vertices, std::uint64_t triangles, Room room);

    /// What there is, on the processor.
    ///
    /// `packed`   numbers points and cells as the user did
    /// `ends`     whether ends and weights are wanted: fields may have needed them on the device only
    Result<ops::RawSurface> download(Context& context, const core::Packed& packed, bool ends) const;

private:
    /// An array: bytes for each vertex and triangle, and whether the parts have it.
    struct Part {
        Buffer& buffer;
        const char* name;
        std::uint64_t vertex_bytes, triangle_bytes;
        bool wanted;
    };
    std::vector<Part> arrays();
    void drop_arrays();

    SurfaceParts parts_;
    std::uint32_t vertex_capacity_ = 0, triangle_capacity_ = 0;
};

} // namespace isotet::vulkan
