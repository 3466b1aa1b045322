// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What counting a cluster at an isovalue leaves behind, so that its tets need not be looked at again: the edges of vertices
// that are its own, the vertices that masks know, and its triangles with local vertex numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/block.hpp"

namespace isotet::cpu {

/// The two ends of an edge, as local points.
struct EndPair {
    std::uint8_t below, above;
};

/// A vertex that a cluster uses and a mask of its owner knows: on a seam edge, or at a tied point.
struct SharedVertex {
    static constexpr std::uint32_t tied = 0x80000000;
    std::uint32_t owner; ///< its place
    std::uint32_t index; ///< among the owner's own seam edges; or `tied` + among its own points
};

/// Lies in an Arena with its arrays behind it: about 6 bytes a listed vertex, 8 a shared one, 6 a triangle.
///
/// Local vertex numbers: listed vertices in their final order, then shared ones. A plain cluster lists all of its own
/// vertices, for it knows them alone; any other lists those on inner edges, which come last among its own.
template <class Real>
struct Record {
    std::uint16_t listed = 0, shared = 0, triangles = 0;
    bool lists_seams = true; ///< a plain cluster
    bool has_tets = false;

    static std::size_t bytes(std::size_t listed, std::size_t shared, std::size_t triangles, bool has_tets) {
        // Triangles are written two at a time: room for one too many.
        return sizeof(Record) + (sizeof(Real) + sizeof(EndPair)) * listed + sizeof(SharedVertex) * shared +
               sizeof(std::uint16_t) * (has_tets ? 4 : 3) * (triangles + 1);
    }

    std::size_t bytes() const { return bytes(listed, shared, triangles, has_tets); }
    Real* weights() const { return reinterpret_cast<Real*>(const_cast<Record*>(this) + 1); }
    SharedVertex* shared_vertices() const { return reinterpret_cast<SharedVertex*>(weights() + listed); }
    EndPair* ends() const { return reinterpret_cast<EndPair*>(shared_vertices() + shared); }
    std::uint16_t* corners() const { return reinterpret_cast<std::uint16_t*>(ends() + listed); }
    std::uint16_t* tets() const { return corners() + 3 * (triangles + std::size_t{1}); } ///< in the cluster, one a triangle
};
static_assert(sizeof(Record<float>) == 8 && sizeof(Record<double>) == 8);

/// Memory that is handed out piece by piece and given back as a whole; one a thread. At most a quarter more than is used,
/// and a first block, is taken.
class Arena {
public:
    Arena() = default;
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;
    ~Arena() {
        for (const core::Block& block : blocks_) core::give_back(block);
    }

    std::byte* take(std::size_t bytes) {
        bytes = (bytes + 7) / 8 * 8;
        if (bytes > left_) add_block(bytes);
        std::byte* const piece = next_;
        next_ += bytes;
        left_ -= bytes;
        return piece;
    }
    /// Takes back all that was handed out; keeps the first block.
    void clear() {
        while (blocks_.size() > 1) {
            core::give_back(blocks_.back());
            blocks_.pop_back();
        }
        if (blocks_.empty()) return;
        next_ = static_cast<std::byte*>(blocks_[0].data);
        left_ = total_ = blocks_[0].bytes;
    }
    std::size_t bytes() const { return total_; }

    static std::size_t most_bytes(std::size_t used, std::size_t threads) { return used + used / 4 + threads * first_block; }

private:
    static constexpr std::size_t first_block = std::size_t{256} << 10, largest_block = std::size_t{4} << 20;

    void add_block(std::size_t bytes) {
        blocks_.reserve(blocks_.size() + 1);
        const core::Block block = core::take_block(std::max(bytes, std::clamp(total_ / 4, first_block, largest_block)));
        blocks_.push_back(block);
        next_ = static_cast<std::byte*>(block.data);
        left_ = block.bytes;
        total_ += block.bytes;
    }

    std::vector<core::Block> blocks_;
    std::byte* next_ = nullptr;
    std::size_t left_ = 0, total_ = 0;
};

} // namespace isotet::cpu
