// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What counting a plain cluster leaves behind, so that emitting it is a copy: its own vertices in their final order, the
// vertices of other clusters that it uses, and its triangles with local vertex numbers (own ones first).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace isotet::cpu {

/// A vertex on a seam edge that another cluster owns.
struct ForeignVertex {
    std::uint32_t owner; ///< its place in the selection
    std::uint32_t seam;  ///< among the owner's own seam edges
};

/// The two ends of the edge of an own vertex, as local points.
struct EndPair {
    std::uint8_t below, above;
};

/// Lies in an Arena with its arrays behind it. About 12 bytes a vertex and 6 a triangle; 6 more a vertex with ends.
struct Record {
    std::uint32_t own, foreign, triangles;
    std::uint32_t weights_at, ends_at, tets_at; ///< bytes from the start; 0 where not kept

    std::byte* at(std::size_t offset) const { return const_cast<std::byte*>(reinterpret_cast<const std::byte*>(this)) + offset; }
    float* positions() const { return reinterpret_cast<float*>(at(sizeof(Record))); }
    ForeignVertex* foreign_vertices() const { return reinterpret_cast<ForeignVertex*>(positions() + 3 * std::size_t{own}); }
    std::uint16_t* corners() const { return reinterpret_cast<std::uint16_t*>(foreign_vertices() + foreign); }
    float* weights() const { return reinterpret_cast<float*>(at(weights_at)); }
    EndPair* ends() const { return reinterpret_cast<EndPair*>(at(ends_at)); }
    std::uint16_t* tets() const { return reinterpret_cast<std::uint16_t*>(at(tets_at)); } ///< in the cluster, one a triangle
};

/// Memory that is handed out piece by piece and given back as a whole; one a thread.
class Arena {
public:
    std::byte* take(std::size_t bytes) {
        bytes = (bytes + 7) / 8 * 8;
        if (bytes > left_) {
            const std::size_t size = bytes > block_bytes ? bytes : block_bytes;
            blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(size));
            next_ = blocks_.back().get();
            left_ = size;
            total_ += size;
        }
        std::byte* const piece = next_;
        next_ += bytes;
        left_ -= bytes;
        return piece;
    }
    std::size_t bytes() const { return total_; }

private:
    static constexpr std::size_t block_bytes = 512 * 1024;
    std::vector<std::unique_ptr<std::byte[]>> blocks_;
    std::byte* next_ = nullptr;
    std::size_t left_ = 0, total_ = 0;
};

} // namespace isotet::cpu
