// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/volume_tile.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "numbers/at_level.hpp"
#include "packed/stored_cells.hpp"
#include "render/cpu/shade.hpp"

namespace isotet::render {

namespace {

/// The direction in which the values of a tet rise or fall, of length 1; 0 where they do not.
std::array<float, 3> gradient_direction(const PlacedPoints& points, const std::array<TetCorner, 4>& corners) {
    const auto edge = [&](std::size_t i) {
        return minus(points.position[corners[i].local], points.position[corners[0].local]);
    };
    const auto rise = [&](std::size_t i) { return corners[i].value - corners[0].value; };
    const Vector a = edge(1), b = edge(2), c = edge(3);
    const Vector sum = plus(plus(plus({}, cross(b, c), rise(1)), cross(c, a), rise(2)), cross(a, b), rise(3));
    const double length = std::sqrt(dot(sum, sum));
    if (!(length > 0)) return {};
    return {static_cast<float>(sum[0] / length), static_cast<float>(sum[1] / length),
            static_cast<float>(sum[2] / length)};
}

std::array<float, 3> in_float(const Vector& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// A place in a transfer table as 1 + its entry; 0 before the first, and one more behind the last.
std::size_t step_of(float place) {
    constexpr float last = Transfer::entries + 1;
    return static_cast<std::size_t>(static_cast<std::int32_t>(std::min(std::max(place + 1, 0.0F), last)));
}

/// Of each step the first from it on that is not transparent.
std::vector<std::uint16_t> opaque_steps(const Transfer& transfer) {
    constexpr std::array<float, 4> nothing{};
    std::vector<std::uint16_t> out(Transfer::entries + 2, Transfer::entries + 2);
    for (std::size_t i = Transfer::entries; i > 0; --i) {
        const Transfer::Row& row = transfer.rows()[i - 1];
        const bool opaque = row.rise != nothing || row.bend != nothing;
        out[i] = opaque ? static_cast<std::uint16_t>(i) : out[i + 1];
    }
    out[0] = out[1];
    return out;
}

std::array<float, 3> direction_to_eye(const Ray& ray) { return in_float(plus({}, ray.along, -1 / ray.stretch)); }

/// A number for each of 4 x 4 pixels.
struct alignas(64) Lane : std::array<float, 16> {};

constexpr Lane no_ends{{INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY,
                        INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY}};
constexpr Lane lane_x{{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}},
    lane_y{{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3}};

void find_nearness(const FacePlane& plane, const Lane& x, const Lane& y, std::array<float, 16>& near,
                   std::array<float, 16>& value) {
    for (std::size_t i = 0; i < 16; ++i)
        near[i] = plane.near + plane.near_per_x * (x[i] - plane.x) + plane.near_per_y * (y[i] - plane.y);
    for (std::size_t i = 0; i < 16; ++i)
        value[i] = plane.value + plane.value_per_x * (x[i] - plane.x) + plane.value_per_y * (y[i] - plane.y);
}

/// Of planes that are equal at a pixel the smaller value counts: rounding may tell them apart.
void take_least(const Lane& near, const Lane& value, std::array<float, 16>& least, std::array<float, 16>& its_value) {
    for (std::size_t i = 0; i < 16; ++i) {
        const float smaller = value[i] < its_value[i] ? value[i] : its_value[i];
        const float kept = near[i] == least[i] ? smaller : its_value[i];
        its_value[i] = near[i] < least[i] ? value[i] : kept;
        least[i] = near[i] < least[i] ? near[i] : least[i];
    }
}

/// From nearness to distances within those of the corners, and from values times nearness to values.
template <bool parallel>
void find_distances(const TetPlanes& p, std::array<float, 16>& near, std::array<float, 16>& value) {
    for (std::size_t i = 0; i < 16; ++i) {
        const float below = near[i] < p.nearest ? near[i] : p.nearest;
        const float within = below > p.farthest ? below : p.farthest;
        near[i] = parallel ? -within : 1 / within;
    }
    for (std::size_t i = 0; i < 16; ++i) {
        const float whole = parallel ? value[i] : value[i] * near[i];
        const float below = whole < p.highest ? whole : p.highest;
        value[i] = below > p.lowest ? below : p.lowest;
    }
}

} // namespace

VolumeScene::VolumeScene(const Scene& scene, const Space& space, const Sight& sight, const Tiling& tiling,
                         const VolumeTuning& how)
    : rays(sight, tiling.width, tiling.height), tuning(how) {
    for (const DrawnVolume& volume : scene.volumes) {
        if (!volume.opacity.is_transparent()) media.emplace_back(volume, space, rays, Seek::medium, how.skips);
        if (!volume.isosurfaces.empty()) surfaces.emplace_back(volume, space, rays, Seek::isosurfaces, how.skips);
    }
}

Result<void> VolumeScene::place(const Tiling& tiling, const Progress& progress) {
    for (std::vector<PlacedVolume>* volumes : {&media, &surfaces})
        for (PlacedVolume& volume : *volumes)
            if (Result<void> placed = volume.find_places(progress); !placed) return placed;
    if (progress.cancelled()) return {};
    if (!media.empty()) media_bins.emplace(media, tiling, progress);
    if (!surfaces.empty()) surface_bins.emplace(surfaces, tiling, progress);
    return {};
}

Result<void> VolumeScene::for_tiles(std::size_t tiles, const Progress& progress,
                                    const std::function<void(std::size_t, std::size_t)>& work) const {
    using Amount = core::Residency::Amount;
    std::size_t count = tiles;
    for (std::size_t first = 0; first < tiles && !progress.cancelled(); first += count, count *= 2) {
        count = std::min(count, tiles - first);
        std::vector<core::Brought> brought;
        for (;; count /= 2) {
            Result<bool> fits =
                bring(first, first + count, progress, count > 1 ? Amount::fitting : Amount::all, brought);
            if (!fits) return fits.error();
            if (*fits || count == 1) break;
        }
        work(first, first + count);
    }
    return {};
}

/// False where what tiles show is more than may be kept in memory.
Result<bool> VolumeScene::bring(std::size_t first, std::size_t last, const Progress& progress,
                                core::Residency::Amount amount, std::vector<core::Brought>& brought) const {
    brought.clear();
    for (const auto& [volumes, bins] : {std::tie(media, media_bins), std::tie(surfaces, surface_bins)})
        for (std::size_t volume = 0; volume < volumes.size(); ++volume) {
            const core::Packed& packed = volumes[volume].packed();
            if (!packed.residency) continue;
            std::vector<std::uint32_t> clusters;
            for (std::size_t tile = first; tile < last; ++tile)
                for (const ClusterEntry& entry : bins->of(tile))
                    if (entry.volume == volume) clusters.push_back(entry.cluster);
            std::ranges::sort(clusters);
            clusters.erase(std::ranges::unique(clusters).begin(), clusters.end());
            Result<core::Brought> some = packed.residency->bring(clusters, core::Parts::all, amount, progress);
            if (!some) return some.error();
            if (some->count < clusters.size()) return false;
            brought.push_back(*std::move(some));
        }
    return true;
}

std::uint64_t VolumeScene::bytes() const {
    std::uint64_t bytes = (media_bins ? media_bins->bytes() : 0) + (surface_bins ? surface_bins->bytes() : 0);
    for (const std::vector<PlacedVolume>* volumes : {&media, &surfaces})
        for (const PlacedVolume& volume : *volumes) bytes += volume.bytes();
    return bytes;
}

VolumeTile::VolumeTile(const VolumeScene& scene, bool follows)
    : scene_(scene), lists_(follows ? scene.tuning.lists : ListRoom{1, 1}), opaque_steps_(scene.media.size()) {
    if (!follows || !scene.tuning.skips) return;
    for (std::size_t i = 0; i < scene.media.size(); ++i) opaque_steps_[i] = opaque_steps(scene.media[i].transfer());
}

void VolumeTile::start(std::size_t number, std::uint32_t column, std::uint32_t row) {
    number_ = number;
    column_ = column;
    row_ = row;
    const Rays& rays = scene_.rays;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::size_t x = pixel % 32, y = pixel / 32, index = index_of(pixel);
        rays_[index] = rays.at(static_cast<double>(column + x) + ray_x, static_cast<double>(row + y) + ray_y);
        const bool inside = column + x < rays.width() && row + y < rays.height();
        ends_[index] = inside ? static_cast<float>(rays.farthest()) : -INFINITY;
        hits_[index] = {};
    }
    stops_.clear();
    first_stops_.assign(1, 0);
}

/// The parts of rays that clipping planes leave of each volume.
void VolumeTile::clip_rays(const std::vector<PlacedVolume>& volumes) {
    parts_.clear();
    if (std::ranges::all_of(volumes, [](const PlacedVolume& one) { return one.clips().empty(); })) return;
    for (const PlacedVolume& volume : volumes)
        for (const Ray& ray : rays_) {
            RayPart& part = parts_.emplace_back(scene_.rays.nearest(), INFINITY);
            for (const Plane& plane : volume.clips()) part.cut(ray, plane);
        }
}

/// No ray goes as far as this.
bool VolumeTile::is_done(float nearest) const {
    float farthest = -INFINITY;
    for (const float end : ends_) farthest = std::max(farthest, end);
    return !(nearest < farthest);
}

void VolumeTile::find_hits() {
    if (!scene_.surface_bins) return;
    seek_ = Seek::isosurfaces;
    clip_rays(scene_.surfaces);
    core::at_level([&] { draw_clusters(scene_.surface_bins->of(number_), scene_.surfaces); });
}

RayHit VolumeTile::hit(std::size_t pixel) const {
    const FoundHit& found = hits_[index_of(pixel)];
    if (!(found.distance < INFINITY)) return {};
    RayHit hit{found.distance, scene_.surfaces[found.volume].isosurfaces()[found.isosurface].color};
    const float light = light_along(index_of(pixel), found.normal);
    for (float& part : hit.color) part *= light;
    return hit;
}

/// How much light a ray gets from what lies across a gradient, lit on both sides.
float VolumeTile::light_along(std::size_t index, std::array<float, 3> normal) const {
    const std::array<float, 3> to_eye = direction_to_eye(rays_[index]);
    const float facing = normal[0] * to_eye[0] + normal[1] * to_eye[1] + normal[2] * to_eye[2];
    if (facing < 0)
        for (float& part : normal) part = -part;
    return light_on(normal, to_eye, scene_.rays.sight());
}

void VolumeTile::add_stops(std::span<const float> stops) {
    stops_.insert(stops_.end(), stops.begin(), stops.end());
    first_stops_.push_back(static_cast<std::uint32_t>(stops_.size()));
}

void VolumeTile::give_rays(Seek seek, RayBatch& batch) {
    const std::vector<PlacedVolume>& volumes = seek == Seek::medium ? scene_.media : scene_.surfaces;
    clip_rays(volumes);
    const bool has_stops = first_stops_.size() > pixels;
    const auto per_scene = static_cast<float>(volumes.front().lengths());
    const std::size_t first = batch.pixel_of(number_, 0);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::size_t index = index_of(pixel);
        const Ray& ray = rays_[index];
        BatchRay& given = batch.rays[first + pixel];
        given = {ends_[index], per_scene * static_cast<float>(ray.stretch), direction_to_eye(ray), 0, 0};
        if (!has_stops) continue;
        given.first_stop = first_stops_[pixel];
        given.stops = first_stops_[pixel + 1] - first_stops_[pixel];
    }
    batch.tile_stops[number_ - batch.first] = stops_;
    if (parts_.empty()) return;
    for (std::size_t volume = 0; volume < volumes.size(); ++volume)
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            const RayPart& part = parts_[volume * pixels + index_of(pixel)];
            batch.windows[volume * batch.pixels() + first + pixel] = {static_cast<float>(part.from),
                                                                      static_cast<float>(part.to)};
        }
}

void VolumeTile::take_hits(const RayBatch& batch) {
    if (batch.hits.empty()) return;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::size_t index = index_of(pixel);
        hits_[index] = batch.hits[batch.pixel_of(number_, pixel)];
        ends_[index] = std::min(ends_[index], std::nextafter(hits_[index].distance, INFINITY));
    }
}

void VolumeTile::take_slabs(const RayBatch& batch) {
    slabs_.assign(stops_.size() + pixels, Slab{});
    if (batch.slabs.empty()) return;
    const std::size_t first = batch.first_slab(batch.pixel_of(number_, 0));
    std::copy_n(batch.slabs.begin() + static_cast<std::ptrdiff_t>(first), slabs_.size(), slabs_.begin());
}

std::span<const float> VolumeTile::stops(std::size_t pixel) const {
    return std::span(stops_).subspan(first_stops_[pixel], first_stops_[pixel + 1] - first_stops_[pixel]);
}

std::span<const Slab> VolumeTile::slabs(std::size_t pixel) const {
    return std::span(slabs_).subspan(first_stops_[pixel] + pixel, first_stops_[pixel + 1] - first_stops_[pixel] + 1);
}

void VolumeTile::compose_media() {
    slabs_.assign(stops_.size() + pixels, Slab{});
    if (!scene_.media_bins) return;
    seek_ = Seek::medium;
    clip_rays(scene_.media);
    const auto per_scene = static_cast<float>(scene_.media.front().lengths());
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::size_t index = index_of(pixel);
        states_[index] = {per_scene * static_cast<float>(rays_[index].stretch), 1, false, stops(pixel),
                          std::span(slabs_).subspan(first_stops_[pixel] + pixel, stops(pixel).size() + 1)};
    }
    core::at_level([&] {
        draw_clusters(scene_.media_bins->of(number_), scene_.media);
        for (std::size_t index = 0; index < pixels; ++index)
            if (lists_.count(index) > 0) compose_pixel(index, INFINITY);
    });
    work_.bytes = std::max(work_.bytes, sizeof(VolumeTile) + lists_.bytes());
    lists_.clear();
}

/// Composes long lists, as far as nothing of the clusters to come can be before.
void VolumeTile::compose_full(float horizon) {
    const std::uint32_t full = scene_.tuning.lists.compose_from;
    for (std::size_t index = 0; index < pixels; ++index)
        if (lists_.count(index) >= full) compose_pixel(index, horizon);
}

void VolumeTile::compose_pixel(std::size_t index, float horizon) {
    RayState& state = states_[index];
    media_.clear();
    for (std::size_t i = 0; i < scene_.media.size(); ++i) {
        Medium medium{&scene_.media[i].transfer(), static_cast<float>(scene_.rays.nearest()), ends_[index]};
        if (!parts_.empty()) {
            const RayPart& part = parts_[i * pixels + index];
            medium.enter = std::max(medium.enter, static_cast<float>(part.from));
            medium.end = std::min(medium.end, static_cast<float>(part.to));
        }
        media_.push_back(medium);
    }
    lists_.set_count(index, compose(lists_.of(index), horizon, media_, state, scratch_));
    if (state.done) ends_[index] = -INFINITY;
}

void VolumeTile::draw_clusters(std::span<const ClusterEntry> entries, const std::vector<PlacedVolume>& volumes) {
    for (const ClusterEntry& entry : entries) {
        if (seek_ == Seek::medium) compose_full(entry.nearest);
        if (is_done(entry.nearest)) return;
        if (scene_.rays.parallel()) draw_cluster<true>(entry, volumes[entry.volume]);
        else draw_cluster<false>(entry, volumes[entry.volume]);
    }
}

template <bool parallel>
void VolumeTile::draw_cluster(const ClusterEntry& entry, const PlacedVolume& volume) {
    const core::Packed& packed = volume.packed();
    bool placed = false;
    for_groups(packed, entry.cluster,
               [&](std::size_t group, core::CellKind kind, const std::uint8_t* corners, std::size_t count) {
                   if (!volume.group(group).holds(column_ / 32, row_ / 32)) return;
                   if (!placed) volume.place(entry.cluster, column_, row_, points_);
                   placed = true;
                   for (std::size_t i = 0; i < count; ++i, corners += 4 * core::words_of(kind)) {
                       if (kind == core::CellKind::tetrahedron) {
                           draw_tet<parallel>(volume, entry.volume, {corners[0], corners[1], corners[2], corners[3]});
                           continue;
                       }
                       const core::StoredCell cell{kind, {corners, core::corner_count(kind)}, 0};
                       for (const auto& tet :
                            core::split_locally(core::ranked_cell(packed, points_.points.data(), cell)))
                           draw_tet<parallel>(volume, entry.volume,
                                              {corners[tet[0]], corners[tet[1]], corners[tet[2]], corners[tet[3]]});
                   }
               });
}

template <bool parallel>
void VolumeTile::draw_tet(const PlacedVolume& volume, std::uint32_t number, const std::array<std::uint8_t, 4>& locals) {
    const auto value = [&](std::size_t k) { return points_.value[locals[k]]; };
    const auto [lower, upper] = std::minmax({value(0), value(1), value(2), value(3)});
    if (core::is_nan(value(0)) || core::is_nan(value(1)) || core::is_nan(value(2)) || core::is_nan(value(3))) return;
    if (volume.hides(lower, upper)) return;
    std::array<TetCorner, 4> corners;
    bool cut = false;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t i = locals[k];
        corners[k] = {points_.x[i],      points_.y[i],    points_.near[i], double{points_.value[i]},
                      points_.across[i], points_.down[i], points_.w[i],    locals[k]};
        cut = cut || points_.w[i] < scene_.rays.nearest();
    }
    sort_corners(corners);
    if (!parallel && cut) {
        if (planes_of_cut(corners, scene_.rays.nearest(), planes_))
            draw_blocks<false, TetPlanes::most>(volume, number, corners);
    } else if (planes_of<parallel>(corners, planes_)) {
        draw_blocks<parallel, 3>(volume, number, corners);
    }
}

template <bool parallel, std::size_t faces>
void VolumeTile::draw_blocks(const PlacedVolume& volume, std::uint32_t number,
                             const std::array<TetCorner, 4>& corners) {
    ++work_.tets;
    Lanes lanes;
    // A tet that fits into 4 x 4 pixels takes one square of them wherever it begins, others those that are together in
    // memory.
    const bool small = planes_.right - planes_.left < 4 && planes_.bottom - planes_.top < 4 &&
                       ((planes_.left ^ planes_.right) | (planes_.top ^ planes_.bottom)) > 3;
    const std::int32_t last = volume_tile_side - 4;
    const std::int32_t left = small ? std::min(planes_.left, last) : planes_.left & ~3,
                       top = small ? std::min(planes_.top, last) : planes_.top & ~3;
    for (std::int32_t y = top; y <= planes_.bottom; y += 4)
        for (std::int32_t x = left; x <= planes_.right; x += 4) {
            find_lanes<parallel, faces>(x, y, lanes);
            std::uint32_t mask = 0;
            for (std::uint32_t i = 0; i < 16; ++i) mask |= static_cast<std::uint32_t>(lanes.inside[i]) << i;
            if (mask == 0) continue;
            const auto corner = static_cast<std::size_t>(32 * y + x);
            if (small) mask = before_ends(lanes, mask, corner);
            if (seek_ == Seek::medium) add_segments(lanes, mask, corner, volume, number, corners);
            else add_hits(lanes, mask, corner, volume, number, corners);
        }
}

/// Of a square of pixels those whose rays have not ended.
std::uint32_t VolumeTile::before_ends(const Lanes& lanes, std::uint32_t mask, std::size_t corner) const {
    std::uint32_t out = 0;
    for (; mask; mask &= mask - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(mask));
        out |= static_cast<std::uint32_t>(lanes.enter[i] < ends_[index_in(corner, i)]) << i;
    }
    return out;
}

/// Where the rays of 4 x 4 pixels enter the tet and leave it, and its values there. Short loops without branches.
template <bool parallel, std::size_t faces>
void VolumeTile::find_lanes(std::int32_t x, std::int32_t y, Lanes& out) const {
    const TetPlanes& p = planes_;
    Lane at_x, at_y;
    for (std::size_t i = 0; i < 16; ++i) {
        at_x[i] = static_cast<float>(x) + lane_x[i];
        at_y[i] = static_cast<float>(y) + lane_y[i];
    }
    find_nearness(p.front[0], at_x, at_y, out.enter, out.from);
    find_nearness(p.back[0], at_x, at_y, out.leave, out.to);
    for (std::size_t k = 1; k < faces; ++k) {
        Lane near, value;
        find_nearness(p.front[k], at_x, at_y, near, value);
        take_least(near, value, out.enter, out.from);
        find_nearness(p.back[k], at_x, at_y, near, value);
        for (std::size_t i = 0; i < 16; ++i) near[i] = -near[i];
        for (std::size_t i = 0; i < 16; ++i) out.leave[i] = -out.leave[i];
        take_least(near, value, out.leave, out.to);
        for (std::size_t i = 0; i < 16; ++i) out.leave[i] = -out.leave[i];
    }
    find_distances<parallel>(p, out.enter, out.from);
    find_distances<parallel>(p, out.leave, out.to);
    // Of squares that begin elsewhere before_ends() looks at the ends.
    const bool aligned = ((x | y) & 3) == 0;
    const float* const ends =
        aligned ? ends_.data() + static_cast<std::size_t>(y / 4 * 8 + x / 4) * 16 : no_ends.data();
    const auto left = static_cast<float>(p.left), right = static_cast<float>(p.right), top = static_cast<float>(p.top),
               bottom = static_cast<float>(p.bottom);
    for (std::size_t i = 0; i < 16; ++i)
        out.inside[i] = static_cast<std::int32_t>(out.enter[i] < out.leave[i]) &
                        static_cast<std::int32_t>(out.enter[i] < ends[i]) & static_cast<std::int32_t>(at_x[i] >= left) &
                        static_cast<std::int32_t>(at_x[i] <= right) & static_cast<std::int32_t>(at_y[i] >= top) &
                        static_cast<std::int32_t>(at_y[i] <= bottom);
}

/// Whether a segment from one place in the transfer table to another adds exactly nothing.
bool VolumeTile::is_empty(std::uint32_t volume, float from, float to) const {
    constexpr float more = 0.5F; // than Transfer moves ends apart
    return opaque_steps_[volume][step_of(std::min(from, to) - more)] > step_of(std::max(from, to) + more);
}

void VolumeTile::add_segments(const Lanes& lanes, std::uint32_t mask, std::size_t corner, const PlacedVolume& volume,
                              std::uint32_t number, const std::array<TetCorner, 4>& corners) {
    work_.segments += static_cast<std::uint64_t>(std::popcount(mask));
    std::array<float, 3> normal{};
    if (volume.shaded()) normal = gradient_direction(points_, corners);
    const bool skips = !opaque_steps_[number].empty();
    const bool lit = normal != std::array<float, 3>{}; // a constant field has no side
    const auto add = [&](std::size_t i, std::size_t index) {
        if (skips && is_empty(number, lanes.from[i], lanes.to[i])) return;
        std::uint16_t light = Segment::full_light;
        if (lit)
            light = static_cast<std::uint16_t>(std::min(light_along(index, normal), 1.0F) * Segment::full_light + 0.5F);
        lists_.add(index, {lanes.enter[i], lanes.leave[i], lanes.from[i], lanes.to[i], light,
                           static_cast<std::uint16_t>(number)});
    };
    const auto lane = [&] { return static_cast<std::size_t>(std::countr_zero(mask)); };
    if ((corner & 0x63) == 0) // together in memory
        for (const std::size_t first = index_of(corner); mask; mask &= mask - 1) add(lane(), first + lane());
    else
        for (; mask; mask &= mask - 1) add(lane(), index_in(corner, lane()));
}

/// A value that equals an isovalue counts as above it, as in extraction.
void VolumeTile::add_hits(const Lanes& lanes, std::uint32_t mask, std::size_t corner, const PlacedVolume& volume,
                          std::uint32_t number, const std::array<TetCorner, 4>& corners) {
    work_.segments += static_cast<std::uint64_t>(std::popcount(mask));
    std::array<float, 3> normal{};
    bool has_normal = false;
    for (; mask; mask &= mask - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(mask));
        const std::size_t index = index_in(corner, i);
        for (std::uint32_t which = 0; which < volume.isosurfaces().size(); ++which) {
            const float height = volume.isosurfaces()[which].height, from = lanes.from[i], to = lanes.to[i];
            if ((from < height) == (to < height)) continue;
            const float distance = lanes.enter[i] + (height - from) / (to - from) * (lanes.leave[i] - lanes.enter[i]);
            if (distance > ends_[index] || distance < static_cast<float>(scene_.rays.nearest())) continue;
            if (!parts_.empty()) {
                const RayPart& part = parts_[number * pixels + index];
                if (distance < static_cast<float>(part.from) || distance > static_cast<float>(part.to)) continue;
            }
            if (!has_normal) normal = gradient_direction(points_, corners);
            has_normal = true;
            const FoundHit hit{distance, normal, number, which};
            if (hit.key() < hits_[index].key()) hits_[index] = hit;
            // What is equally far may still come.
            ends_[index] = std::min(ends_[index], std::nextafter(hits_[index].distance, INFINITY));
        }
    }
}

} // namespace isotet::render
