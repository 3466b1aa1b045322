// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What counting a cluster at an isovalue leaves behind, so that its tets need not be looked at again: the vertices that
// are its own, those that masks know, and its triangles with local vertex numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/system/block.hpp"
#include "packed/packed.hpp"

namespace isotet::cpu {

/// The two ends of an edge, as local points.
struct EndPair {
    std::uint8_t below, above;
};

/// Of a cluster: those at its points, and those on edges, of which a tet crosses at most four.
constexpr std::size_t max_vertices = 4 * core::max_cluster_tets + core::max_cluster_points;

/// A vertex that a cluster uses and a mask of its owner knows: on a seam edge, or at a tied point.
struct SharedVertex {
    static constexpr std::uint32_t tied = 0x80000000;
    std::uint32_t owner; ///< its place
    std::uint32_t index; ///< among the owner's own seam edges; or `tied` + among its own points
};

/// Lies in an Arena with its arrays behind it: 12 bytes a listed vertex (6 with ends, 10 in double precision), 8 a
/// shared one, 3 a triangle (6 where there are more than 256 vertices).
///
/// Local vertex numbers: listed vertices in their final order, then shared ones. A plain cluster lists all of its own
/// vertices, for it knows them alone; any other lists those on inner edges, which come last among its own.
template <class Real>
struct Record {
    std::uint16_t listed = 0, shared = 0, triangles = 0;
    bool lists_seams : 1 = true; ///< a plain cluster
    bool has_ends : 1 = false;   ///< ends and weights of listed vertices; else it has positions
    bool has_tets : 1 = false;

    static std::size_t bytes(std::size_t listed, std::size_t shared, std::size_t triangles, bool has_ends,
                             bool has_tets) {
        // Positions are written four numbers at a time, corners of triangles eight: room for more than there are.
        return sizeof(Record) +
               (has_ends ? (sizeof(Real) + sizeof(EndPair)) * listed : sizeof(Real) * (3 * listed + 1)) +
               sizeof(SharedVertex) * shared + (has_tets ? sizeof(std::uint16_t) * (triangles + 1) : 0) +
               (is_wide(listed, shared) ? sizeof(std::uint16_t) : 1) * (3 * triangles + 5);
    }
    std::size_t bytes() const { return bytes(listed, shared, triangles, has_ends, has_tets); }

    Real* weights() const { return reinterpret_cast<Real*>(const_cast<Record*>(this) + 1); }
    Real* positions() const { return weights(); } ///< 3 a listed vertex
    SharedVertex* shared_vertices() const {
        return reinterpret_cast<SharedVertex*>(weights() + (has_ends ? listed : 3 * listed + 1));
    }
    EndPair* ends() const { return reinterpret_cast<EndPair*>(shared_vertices() + shared); }
    /// In the cluster, one a triangle.
    std::uint16_t* tets() const { return reinterpret_cast<std::uint16_t*>(ends() + (has_ends ? listed : 0)); }
    /// Three a triangle: 8 bits each, or 16 where local vertex numbers need them.
    void* corners() const { return tets() + (has_tets ? triangles + 1 : 0); }
    bool wide() const { return is_wide(listed, shared); }

private:
    static bool is_wide(std::size_t listed, std::size_t shared) { return listed + shared > 256; }
};
static_assert(sizeof(Record<float>) == 8 && sizeof(Record<double>) == 8);

/// Memory that is handed out piece by piece and given back as a whole; one a thread. At most a quarter more than is
/// used, and a first block, is taken.
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

    static std::size_t max_bytes(std::size_t used, std::size_t threads) {
        return used + used / 4 + threads * first_block;
    }

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
