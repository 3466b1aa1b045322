// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A volume placed in the picture: where its clusters and groups of tets may be seen, and the points of a cluster.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>

#include "base/buffer.hpp"
#include "packed/packed.hpp"
#include "render/color/linear_light.hpp"
#include "render/space.hpp"
#include "render/volume/rays.hpp"
#include "render/volume/transfer.hpp"

namespace isotet::render {

/// Tiles are squares of so many pixels.
inline constexpr std::int32_t volume_tile_side = 32;

/// Tiles of the picture, both ends included; empty where first > last.
struct TileBox {
    std::uint16_t first_column = 1, first_row = 1, last_column = 0, last_row = 0;

    bool empty() const { return first_column > last_column || first_row > last_row; }
    bool holds(std::uint32_t column, std::uint32_t row) const {
        return first_column <= column && column <= last_column && first_row <= row && row <= last_row;
    }
};

/// The local points of a cluster, in pixels from the corner of a tile.
struct PlacedPoints {
    using Numbers = std::array<double, core::max_cluster_points>;
    Numbers across, down, w; ///< place in the picture times w, and w; 1 in parallel pictures
    Numbers x, y;            ///< place in the picture, of points before the eye
    Numbers near;            ///< 1 / w; in parallel pictures minus the depth
    std::array<float, core::max_cluster_points> value; ///< place in the transfer table, or height above an isovalue
    std::array<std::array<double, 3>, core::max_cluster_points> position; ///< as stored
    std::array<std::uint64_t, core::max_cluster_points> points;           ///< packed
    std::size_t count = 0;
};

/// What of a volume the rays seek: its medium, or its isosurfaces.
enum class Seek : std::uint8_t { medium, isosurfaces };

struct PlacedIsosurface {
    float height; ///< above the first isovalue, as stored values are
    Light color;
};

class PlacedVolume {
public:
    /// `skips`   false, in tests: what is transparent is placed, too
    PlacedVolume(const DrawnVolume& volume, const Space& space, const Rays& rays, Seek seek, bool skips);

    /// Finds what is seen of clusters and groups. Of a grid that lies in a file those are read that are not transparent.
    /// Errors   as Residency::bring()
    Result<void> find_places(const Progress& progress);

    const core::Packed& packed() const { return *packed_; }
    Seek seeks() const { return seek_; }
    const Transfer& transfer() const { return *transfer_; }
    double lengths() const { return lengths_; } ///< of the user, for 1 in the scene
    const std::vector<Plane>& clips() const { return clips_; } ///< in the scene
    const std::vector<PlacedIsosurface>& isosurfaces() const { return isosurfaces_; }
    bool shaded() const { return shaded_; }

    /// The place of clusters; `nearest` is the distance before which none of its points is.
    struct ClusterPlace {
        float nearest = 0;
        TileBox tiles;
    };
    const ClusterPlace& cluster(std::size_t which) const { return clusters_[which]; }
    const TileBox& group(std::size_t which) const { return groups_[which]; }
    std::uint64_t bytes() const { return clusters_.bytes() + groups_.bytes(); }

    /// Places, times w but for `depth`, of stored positions in the picture, in pixels; the depth of parallel pictures.
    struct PictureRow {
        std::array<double, 3> along{};
        double shift = 0;
        double at(const std::array<double, 3>& p) const {
            return along[0] * p[0] + along[1] * p[1] + along[2] * p[2] + shift;
        }
    };
    struct PictureRows {
        PictureRow across, down, w, depth;
    };
    const PictureRows& rows() const { return rows_; }

    /// Positions and values alone.
    void take_points(std::size_t cluster, PlacedPoints& out) const;

    /// `x`, `y`   the corner of the tile, pixels
    void place(std::size_t cluster, double x, double y, PlacedPoints& out) const;

    /// Nothing is seen of tets whose values lie from `lower` to `upper`.
    bool hides(float lower, float upper) const {
        if (seek_ == Seek::medium) return skips_ && transfer_->is_transparent(lower, upper);
        for (const PlacedIsosurface& one : isosurfaces_)
            if (lower < one.height && one.height <= upper) return false;
        return true;
    }

private:
    PictureRow row_of(const Row& row, const Space& space) const;
    template <class Real>
    void take_points_as(std::size_t cluster, PlacedPoints& out) const;
    void find_cluster(std::size_t cluster, PlacedPoints& points);
    bool is_clipped(const PlacedPoints& points) const;
    template <class Real>
    bool may_be_seen(std::size_t cluster) const;
    float value_of(double stored) const;

    const core::Packed* packed_;
    const Rays* rays_;
    Seek seek_;
    bool skips_, shaded_;
    std::optional<Transfer> transfer_;
    std::vector<PlacedIsosurface> isosurfaces_;
    double first_isovalue_ = 0; ///< stored
    PictureRows rows_;
    std::vector<Plane> clips_, stored_clips_; ///< in the scene; among stored positions
    double lengths_ = 1;
    core::Buffer<ClusterPlace> clusters_;
    core::Buffer<TileBox> groups_;
};

/// Calls f(group, kind, corners, count) for each group of 32 words of a cluster: its number, the local indices of its
/// first cell, and how many cells.
template <class F>
void for_groups(const core::Packed& packed, std::size_t cluster, const F& f) {
    const core::ClusterHeader& header = packed.headers[cluster];
    const auto* corners = reinterpret_cast<const std::uint8_t*>(packed.cells.data() + header.first_word);
    std::size_t group = header.first_group;
    for (const core::CellKind kind : core::cell_kinds) {
        const std::size_t at_once = core::cells_per_group(kind), bytes = 4 * core::words_of(kind);
        for (std::size_t done = 0; done < header.count(kind); done += at_once, ++group) {
            const std::size_t count = std::min(at_once, header.count(kind) - done);
            f(group, kind, corners, count);
            corners += count * bytes;
        }
    }
}

} // namespace isotet::render
