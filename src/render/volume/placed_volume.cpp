// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/placed_volume.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.hpp"
#include "numbers/at_level.hpp"
#include "packed/residency.hpp"

namespace isotet::render {

namespace {

/// A plane in other coordinates p' = place(p), which are moved and scaled.
template <class Place>
Plane moved_plane(const Plane& plane, const Place& place) {
    const double square = dot(plane.normal, plane.normal);
    if (square == 0) return plane;
    return {plane.normal, dot(plane.normal, place(plus({}, plane.normal, plane.offset / square)))};
}

/// Where points are beside the picture, or behind the eye: a bit for each side.
struct Sides {
    static constexpr std::uint32_t left = 1, right = 2, above = 4, below = 8, behind = 16;
    std::array<std::uint8_t, core::max_cluster_points> of;
};

/// The places of some points in the picture.
class PlaceBox {
public:
    explicit PlaceBox(const Rays& rays) : rays_(rays) {}

    void add(const PlacedPoints& points, const Sides& sides, std::size_t i) {
        all_ &= sides.of[i];
        any_ |= sides.of[i];
        if (sides.of[i] & Sides::behind) return;
        left_ = std::min(left_, points.x[i]);
        right_ = std::max(right_, points.x[i]);
        top_ = std::min(top_, points.y[i]);
        bottom_ = std::max(bottom_, points.y[i]);
    }

    /// The tiles with a middle of a pixel inside, or all but: tets are placed in other numbers.
    TileBox tiles() const {
        if (all_ != 0) return {};
        const double width = rays_.width(), height = rays_.height();
        double left = 0, right = width - 1, top = 0, bottom = height - 1;
        if (!(any_ & Sides::behind)) {
            left = std::max(left, std::ceil(left_ - 0.5 - doubt));
            right = std::min(right, std::floor(right_ - 0.5 + doubt));
            top = std::max(top, std::ceil(top_ - 0.5 - doubt));
            bottom = std::min(bottom, std::floor(bottom_ - 0.5 + doubt));
        }
        if (!(left <= right && top <= bottom)) return {};
        const auto tile = [](double at) {
            return static_cast<std::uint16_t>(static_cast<std::int32_t>(at) / volume_tile_side);
        };
        return {tile(left), tile(top), tile(right), tile(bottom)};
    }

private:
    static constexpr double doubt = 1e-3; ///< pixels

    const Rays& rays_;
    double left_ = INFINITY, right_ = -INFINITY, top_ = INFINITY, bottom_ = -INFINITY;
    std::uint32_t all_ = 31, any_ = 0;
};

Sides sides_of(const PlacedPoints& points, const Rays& rays) {
    Sides sides;
    const double width = rays.width(), height = rays.height(), nearest = rays.parallel() ? 0 : rays.nearest();
    for (std::size_t i = 0; i < points.count; ++i) {
        const double w = points.w[i];
        sides.of[i] = static_cast<std::uint8_t>(
            (points.across[i] < 0 ? Sides::left : 0) | (points.across[i] > width * w ? Sides::right : 0) |
            (points.down[i] < 0 ? Sides::above : 0) | (points.down[i] > height * w ? Sides::below : 0) |
            (w < nearest ? Sides::behind : 0));
    }
    return sides;
}

} // namespace

PlacedVolume::PlacedVolume(const DrawnVolume& volume, const Space& space, const Rays& rays, Seek seek, bool skips)
    : packed_(&volume.grid->data()),
      rays_(&rays),
      seek_(seek),
      skips_(skips),
      shaded_(volume.shaded),
      lengths_(1 / space.scale()) {
    const FieldReport& field = volume.grid->field();
    const core::Storage& storage = packed_->storage;
    if (seek == Seek::medium) transfer_.emplace(volume, field.lower, field.upper, storage);
    for (const DrawnIsosurface& one : volume.isosurfaces) {
        const double stored = (one.isovalue - storage.offset) * storage.scale;
        if (isosurfaces_.empty()) first_isovalue_ = stored;
        isosurfaces_.push_back({static_cast<float>(stored - first_isovalue_), linear_light(one.color)});
    }
    const Sight& sight = rays.sight();
    rows_ = {row_of(sight.x, space), row_of(sight.y, space), row_of(sight.w, space), row_of(sight.z, space)};
    const auto in_pixels = [&](PictureRow& row, double pixels) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            row.along[axis] = (row.along[axis] + rows_.w.along[axis]) * 0.5 * pixels;
        row.shift = (row.shift + rows_.w.shift) * 0.5 * pixels;
    };
    in_pixels(rows_.across, rays.width());
    in_pixels(rows_.down, rays.height());
    for (const Plane& plane : volume.clips) {
        clips_.push_back(moved_plane(plane, [&](const Vector& p) { return space.place(p); }));
        stored_clips_.push_back(moved_plane(plane, [&](const Vector& p) { return minus(p, packed_->origin); }));
    }
}

/// A row of the scene for stored positions.
PlacedVolume::PictureRow PlacedVolume::row_of(const Row& row, const Space& space) const {
    PictureRow out;
    for (std::size_t axis = 0; axis < 3; ++axis) out.along[axis] = row.along[axis] * space.scale();
    out.shift = row.at(space.place(packed_->origin));
    return out;
}

float PlacedVolume::value_of(double stored) const {
    // What is infinite is stored as a large number.
    if (!(std::abs(stored) < 0.5 * core::stored_infinity)) return core::canonical_nan<float>();
    return seek_ == Seek::medium ? transfer_->place_of(stored) : static_cast<float>(stored - first_isovalue_);
}

template <class Real>
void PlacedVolume::take_points_as(std::size_t cluster, PlacedPoints& out) const {
    const core::Values<Real>& reals = packed_->as<Real>();
    out.count = core::local_points(*packed_, cluster, out.points.data());
    const std::size_t count = out.count;
    for (std::size_t i = 0; i < count; ++i) {
        const Real* const position = reals.positions.data() + 3 * out.points[i];
        for (std::size_t axis = 0; axis < 3; ++axis) out.position[i][axis] = static_cast<double>(position[axis]);
    }
    for (std::size_t i = 0; i < count; ++i) out.value[i] = value_of(static_cast<double>(reals.values[out.points[i]]));
}

void PlacedVolume::take_points(std::size_t cluster, PlacedPoints& out) const {
    if (packed_->single()) take_points_as<float>(cluster, out);
    else take_points_as<double>(cluster, out);
}

void PlacedVolume::place(std::size_t cluster, double x, double y, PlacedPoints& out) const {
    take_points(cluster, out);
    const std::size_t count = out.count;
    for (std::size_t i = 0; i < count; ++i) {
        const std::array<double, 3>& p = out.position[i];
        const double w = rows_.w.at(p), across = rows_.across.at(p) - x * w, down = rows_.down.at(p) - y * w,
                     part = 1 / w;
        out.w[i] = w;
        out.across[i] = across;
        out.down[i] = down;
        out.x[i] = across * part;
        out.y[i] = down * part;
        out.near[i] = part;
    }
    if (!rays_->parallel()) return;
    for (std::size_t i = 0; i < count; ++i) out.near[i] = -rows_.depth.at(out.position[i]);
}

/// Whether the values of a cluster leave anything to be seen.
template <class Real>
bool PlacedVolume::may_be_seen(std::size_t cluster) const {
    const core::Range<Real> range = packed_->as<Real>().ranges[cluster];
    if (!(range.lower <= range.upper)) return false;
    if (seek_ == Seek::medium && !skips_) return true;
    // An infinite value has no place of its own.
    const auto place = [&](double stored, float otherwise) {
        const float value = value_of(stored);
        return core::is_nan(value) ? otherwise : value;
    };
    return !hides(place(static_cast<double>(range.lower), -INFINITY),
                  place(static_cast<double>(range.upper), INFINITY));
}

bool PlacedVolume::is_clipped(const PlacedPoints& points) const {
    for (const Plane& plane : stored_clips_) {
        bool all = true;
        for (std::size_t i = 0; i < points.count && all; ++i)
            all = dot(plane.normal, points.position[i]) > plane.offset;
        if (all) return true;
    }
    return false;
}

void PlacedVolume::find_cluster(std::size_t cluster, PlacedPoints& points) {
    place(cluster, 0, 0, points);
    if (is_clipped(points)) return;
    const Sides sides = sides_of(points, *rays_);
    PlaceBox whole(*rays_);
    double nearest = -INFINITY;
    for (std::size_t i = 0; i < points.count; ++i) {
        whole.add(points, sides, i);
        nearest = std::max(nearest, sides.of[i] & Sides::behind ? 1 / rays_->nearest() : points.near[i]);
    }
    const TileBox tiles = whole.tiles();
    if (tiles.empty()) return;
    const auto near = static_cast<float>(nearest);
    clusters_[cluster] = {rays_->parallel() ? -near : 1 / near, tiles};
    for_groups(*packed_, cluster,
               [&](std::size_t group, core::CellKind kind, const std::uint8_t* corners, std::size_t count) {
                   PlaceBox box(*rays_);
                   float lower = INFINITY, upper = -INFINITY;
                   for (std::size_t i = 0; i < count * 4 * core::words_of(kind);
                        ++i) { // behind the last corner copies of the first
                       const std::uint8_t corner = corners[i];
                       box.add(points, sides, corner);
                       lower = std::min(lower, points.value[corner]);
                       upper = std::max(upper, points.value[corner]);
                   }
                   if (lower <= upper && !hides(lower, upper)) groups_[group] = box.tiles();
               });
}

Result<void> PlacedVolume::find_places(const Progress& progress) {
    clusters_ = core::Buffer<ClusterPlace>(packed_->clusters());
    groups_ = core::Buffer<TileBox>(packed_->groups());
    std::ranges::fill(std::span(clusters_.data(), clusters_.size()), ClusterPlace{});
    std::ranges::fill(std::span(groups_.data(), groups_.size()), TileBox{});
    std::vector<std::uint32_t> seen;
    for (std::size_t cluster = 0; cluster < packed_->clusters(); ++cluster)
        if (packed_->single() ? may_be_seen<float>(cluster) : may_be_seen<double>(cluster))
            seen.push_back(static_cast<std::uint32_t>(cluster));
    return core::in_memory(
        *packed_, seen, core::Parts::all, progress, [&](std::size_t first, std::size_t last) -> Result<void> {
            core::parallel_pieces(last - first, 64, progress, [&](std::size_t begin, std::size_t end) {
                core::at_level([&] {
                    PlacedPoints points;
                    for (std::size_t i = first + begin; i < first + end; ++i) find_cluster(seen[i], points);
                });
            });
            return {};
        });
}

} // namespace isotet::render
