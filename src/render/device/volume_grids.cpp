// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/volume_grids.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "packed/residency.hpp"
#include "packed/stored_cells.hpp"
#include "render/device/send.hpp"

namespace isotet::render {

namespace {

/// Clusters, one behind the other.
struct Clusters {
    std::vector<layout::VolumeCluster> clusters;
    std::vector<double> positions;
    std::vector<float> values;
    std::vector<std::uint32_t> tets;

    void add(const PlacedVolume& volume, std::uint32_t cluster, PlacedPoints& points);
    void add(const Clusters& more);
};

void Clusters::add(const PlacedVolume& volume, std::uint32_t cluster, PlacedPoints& points) {
    volume.take_points(cluster, points);
    layout::VolumeCluster added{static_cast<std::uint32_t>(values.size()), static_cast<std::uint32_t>(points.count),
                                static_cast<std::uint32_t>(tets.size()), 0};
    for (std::size_t i = 0; i < points.count; ++i)
        positions.insert(positions.end(), points.position[i].begin(), points.position[i].end());
    values.insert(values.end(), points.value.begin(), points.value.begin() + static_cast<std::ptrdiff_t>(points.count));
    core::for_tets(volume.packed(), cluster, [&](const auto& corners, std::size_t) {
        float lower = INFINITY, upper = -INFINITY;
        std::uint32_t numbers = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const float value = points.value[corners[k]];
            if (core::is_nan(value)) return;
            lower = std::min(lower, value);
            upper = std::max(upper, value);
            numbers |= std::uint32_t{corners[k]} << 8 * k;
        }
        if (volume.hides(lower, upper)) return;
        tets.push_back(numbers);
        ++added.tets;
    });
    clusters.push_back(added);
}

void Clusters::add(const Clusters& more) {
    const auto points = static_cast<std::uint32_t>(values.size()), cells = static_cast<std::uint32_t>(tets.size());
    for (const layout::VolumeCluster& one : more.clusters)
        clusters.push_back({one.first_point + points, one.points, one.first_tet + cells, one.tets});
    positions.insert(positions.end(), more.positions.begin(), more.positions.end());
    values.insert(values.end(), more.values.begin(), more.values.end());
    tets.insert(tets.end(), more.tets.begin(), more.tets.end());
}

Result<Clusters> gather(const PlacedVolume& volume, std::span<const std::uint32_t> seen, const Progress& progress) {
    constexpr std::size_t at_once = 64, most = UINT32_MAX;
    Clusters all;
    Result<void> gathered = core::in_memory(
        volume.packed(), seen, core::Parts::all, progress, [&](std::size_t first, std::size_t last) -> Result<void> {
            std::vector<Clusters> pieces((last - first + at_once - 1) / at_once);
            core::parallel_each(pieces.size(), 1, [&](std::size_t piece) {
                PlacedPoints points;
                const std::size_t begin = first + piece * at_once, end = std::min(last, begin + at_once);
                for (std::size_t i = begin; i < end; ++i) pieces[piece].add(volume, seen[i], points);
            });
            for (Clusters& piece : pieces) {
                if (all.tets.size() + piece.tets.size() > most || all.values.size() + piece.values.size() > most)
                    return invalid_data("a volume with 2^32 points or tets on a device");
                all.add(piece);
                piece = {};
            }
            return {};
        });
    if (!gathered) return gathered.error();
    return all;
}

template <class T>
Result<void> put(vulkan::Context& context, const std::vector<T>& values, std::string_view name, vulkan::Buffer& to) {
    Result<vulkan::Buffer> sent = send(context, std::as_bytes(std::span(values)), name);
    if (!sent) return sent.error();
    to = *std::move(sent);
    return {};
}

void set_row(const PlacedVolume::PictureRow& row, double (&to)[4]) {
    for (std::size_t axis = 0; axis < 3; ++axis) to[axis] = row.along[axis];
    to[3] = row.shift;
}

} // namespace

Result<VolumeOnDevice> VolumeOnDevice::upload(vulkan::Context& context, const PlacedVolume& volume,
                                              const Progress& progress) {
    VolumeOnDevice out;
    std::vector<std::uint32_t> seen;
    out.numbers_.resize(volume.packed().clusters());
    for (std::size_t cluster = 0; cluster < out.numbers_.size(); ++cluster) {
        if (volume.cluster(cluster).tiles.empty()) continue;
        out.numbers_[cluster] = static_cast<std::uint32_t>(seen.size());
        seen.push_back(static_cast<std::uint32_t>(cluster));
    }
    const Result<Clusters> all = gather(volume, seen, progress);
    if (!all) return all.error();
    std::vector<float> heights;
    for (const PlacedIsosurface& one : volume.isosurfaces()) heights.push_back(one.height);
    const bool medium = volume.seeks() == Seek::medium;
    const std::span<const Transfer::Row> rows = medium ? volume.transfer().rows() : std::span<const Transfer::Row>();
    for (const Result<void>& sent :
         {put(context, all->positions, "positions of a volume", out.positions_),
          put(context, all->values, "values of a volume", out.values_),
          put(context, all->clusters, "clusters of a volume", out.clusters_),
          put(context, all->tets, "tets of a volume", out.tets_),
          put(context, std::vector(rows.begin(), rows.end()), "opacity of a volume", out.table_),
          put(context, heights, "isovalues of a volume", out.heights_)})
        if (!sent) return sent.error();
    set_row(volume.rows().across, out.place_.across);
    set_row(volume.rows().down, out.place_.down);
    set_row(volume.rows().w, out.place_.w);
    set_row(volume.rows().depth, out.place_.depth);
    out.place_.positions = vulkan::address_of(out.positions_);
    out.place_.values = vulkan::address_of(out.values_);
    out.place_.clusters = vulkan::address_of(out.clusters_);
    out.place_.tets = vulkan::address_of(out.tets_);
    out.place_.table = vulkan::address_of(out.table_);
    out.place_.heights = vulkan::address_of(out.heights_);
    out.place_.isosurfaces = medium ? 0 : static_cast<std::uint32_t>(heights.size());
    out.place_.shaded = volume.shaded() ? 1 : 0;
    return out;
}

layout::VolumePlace VolumeOnDevice::place() const { return place_; }

void VolumeOnDevice::add_uses(std::vector<vulkan::Use>& uses) const {
    for (const vulkan::Buffer* buffer : {&positions_, &values_, &clusters_, &tets_, &table_, &heights_})
        uses.push_back(vulkan::reads(*buffer));
}

std::uint64_t VolumeOnDevice::bytes() const {
    return positions_.size() + values_.size() + clusters_.size() + tets_.size() + table_.size() + heights_.size();
}

} // namespace isotet::render
