// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a packed grid back to arrays with the user's numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"
#include "packed/user_value.hpp"

namespace isotet {
namespace core {
namespace {

/// VTK's numbers, by CellKind.
constexpr std::array<std::uint8_t, cell_kind_count> vtk_types{10, 14, 13, 12};

Error unpacking_cancelled() { return {ErrorCode::cancelled, "unpacking was cancelled"}; }

/// An array by the user's point numbers: f(packed point, out) writes `components` of a used point; points that no cell uses
/// have what unused() gives, once the first cluster is in memory.
/// Errors   as Residency::bring()
template <class To, class Unused, class F>
Result<Array> by_user_point(const Packed& packed, std::size_t components, const Progress& progress,
                            const Unused& unused, const F& f) {
    Buffer<To> out(components * packed.user_points);
    const auto fill = [&](const std::array<To, 3>& with) {
        parallel_pieces(packed.user_points, 1 << 16, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                std::copy_n(with.begin(), components, out.data() + components * i);
        });
    };
    const std::vector<std::uint32_t> clusters = all_clusters(packed);
    if (clusters.empty()) fill({});
    const auto write = [&](std::size_t first, std::size_t last) -> Result<void> {
        if (first == 0 && last > 0) fill(unused());
        parallel_pieces(last - first, 128, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const ClusterHeader& h = packed.headers[first + i];
                for (std::uint64_t p = h.first_point; p < h.first_point + h.own_points; ++p)
                    f(p, out.data() + components * packed.user_point(p));
            }
        });
        if (progress.cancelled()) return unpacking_cancelled();
        return {};
    };
    if (auto done = in_memory(packed, clusters, Parts::values, progress, write); !done) return done.error();
    return std::move(out).to_array(components);
}

/// In the coordinates of the user.
template <class To, class Real>
Result<Array> unpacked_points(const Packed& packed, const Progress& progress) {
    const Real* const positions = packed.as<Real>().positions.data();
    const auto write = [&](std::size_t p, To* to) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            to[axis] = static_cast<To>(static_cast<double>(positions[3 * p + axis]) + packed.origin[axis]);
    };
    const auto first = [&] { // no bounds grow by it
        std::array<To, 3> place{};
        write(packed.headers[0].first_point, place.data());
        return place;
    };
    return by_user_point<To>(packed, 3, progress, first, write);
}

template <class Real>
Result<Array> unpacked_points_of(const Packed& packed, const Progress& progress) {
    return packed.point_type == ScalarType::float32 ? unpacked_points<float, Real>(packed, progress)
                                                    : unpacked_points<double, Real>(packed, progress);
}

template <class To, class Real>
Result<Array> unpacked_values_as(const Packed& packed, const Progress& progress) {
    const Real* const values = packed.as<Real>().values.data();
    const auto no_value = [] {
        std::array<To, 3> unused{};
        if constexpr (std::is_floating_point_v<To>) unused.fill(std::numeric_limits<To>::quiet_NaN());
        return unused;
    };
    return by_user_point<To>(packed, 1, progress, no_value, [&](std::size_t p, To* to) {
        *to = user_value<To>(static_cast<double>(values[p]), packed.storage);
    });
}

template <class Real>
Result<Array> unpacked_values_of(const Packed& packed, const Progress& progress) {
    return packed.field.visit(
        [&]<class T>(std::span<const T>) { return unpacked_values_as<T, Real>(packed, progress); });
}

/// Calls f(kind, local indices) with every cell of a cluster.
template <class F>
void for_cells(const Packed& packed, std::size_t cluster, const F& f) {
    for (const StoredTet& tet : packed.cluster_tets(cluster))
        f(CellKind::tetrahedron, std::span<const std::uint8_t>(tet.corners));
    packed.for_other_cells(cluster, [&](const StoredCell& other) { f(other.kind, other.corners); });
}

/// Where the cells of each cluster begin.
struct UnpackedCounts {
    std::vector<std::uint64_t> first_cell, first_corner; ///< one more than there are clusters
    bool only_tets = true;
};

UnpackedCounts count_stored(const Packed& packed) {
    UnpackedCounts counts;
    std::uint64_t cells = 0, corners = 0;
    for (const ClusterHeader& h : packed.headers) {
        counts.first_cell.push_back(cells);
        counts.first_corner.push_back(corners);
        for (const CellKind kind : cell_kinds) {
            cells += h.count(kind);
            corners += corner_count(kind) * h.count(kind);
        }
        counts.only_tets &= h.others() == 0;
    }
    counts.first_cell.push_back(cells);
    counts.first_corner.push_back(corners);
    return counts;
}

/// Cells cluster after cluster, as they are stored. Cancelled, they are of no use.
template <class Index>
Cells unpacked_cells(const Packed& packed, const UnpackedCounts& counts, const Progress& progress) {
    const std::size_t cells = counts.first_cell.back();
    Buffer<Index> connectivity(counts.first_corner.back());
    Buffer<std::int64_t> offsets(counts.only_tets ? 0 : cells + 1);
    Buffer<std::uint8_t> types(counts.only_tets ? 0 : cells);
    const auto unpack_cluster = [&](std::size_t c) {
        std::array<std::uint64_t, max_cluster_points> locals;
        local_points(packed, c, locals.data());
        std::uint64_t cell = counts.first_cell[c], corner = counts.first_corner[c];
        const auto add = [&](CellKind kind, std::span<const std::uint8_t> corners) {
            if (!counts.only_tets) {
                offsets[cell] = static_cast<std::int64_t>(corner);
                types[cell] = vtk_types[static_cast<std::size_t>(kind)];
            }
            ++cell;
            for (const std::uint8_t local : corners)
                connectivity[corner++] = static_cast<Index>(packed.user_point(locals[local]));
        };
        for_cells(packed, c, add);
    };
    parallel_pieces(packed.clusters(), 64, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) unpack_cluster(c);
    });
    Cells out;
    out.connectivity = std::move(connectivity).to_array();
    if (counts.only_tets) return out;
    offsets[cells] = static_cast<std::int64_t>(counts.first_corner.back());
    out.offsets = std::move(offsets).to_array();
    out.types = std::move(types).to_array();
    return out;
}

Result<Array> unpacked_places(const Packed& packed, const Progress& progress) {
    return packed.single() ? unpacked_points_of<float>(packed, progress) : unpacked_points_of<double>(packed, progress);
}

Result<Field> unpacked_field(const Packed& packed, const Progress& progress) {
    auto values =
        packed.single() ? unpacked_values_of<float>(packed, progress) : unpacked_values_of<double>(packed, progress);
    if (!values) return values.error();
    return Field{packed.field_report.name, *std::move(values)};
}

/// Points and the field, without cells.
Result<Grid> unpacked_places_and_values(const Packed& packed, const Progress& progress) {
    auto points = unpacked_places(packed, progress);
    if (!points) return points.error();
    auto field = unpacked_field(packed, progress);
    if (!field) return field.error();
    Grid grid;
    grid.points = *std::move(points);
    grid.point_fields.push_back(*std::move(field));
    return grid;
}

/// Runs of clusters that follow each other, spread evenly; all where there are few.
std::vector<std::uint32_t> sampled_clusters(std::size_t clusters) {
    constexpr std::size_t runs = 256, in_run = 8; // a run is mostly of one chunk
    std::vector<std::uint32_t> sample(std::min(clusters, runs * in_run));
    if (sample.size() == clusters) {
        std::iota(sample.begin(), sample.end(), 0U);
        return sample;
    }
    for (std::size_t run = 0; run < runs; ++run) {
        // Regular grids repeat themselves: places between even steps are drawn (Weyl's sequence).
        const double drawn = std::fmod(static_cast<double>(run) * 0.618033988749895, 1.0);
        const std::size_t begin = run * clusters / runs, width = (run + 1) * clusters / runs - begin;
        const auto first = begin + static_cast<std::size_t>(drawn * static_cast<double>(width - in_run + 1));
        for (std::size_t i = 0; i < in_run; ++i) sample[run * in_run + i] = static_cast<std::uint32_t>(first + i);
    }
    return sample;
}

/// About `wanted` cells of the grid, by corners in the user's numbers.
class CellSampler {
public:
    CellSampler(const Packed& packed, std::uint64_t wanted)
        : packed_(packed), clusters_(sampled_clusters(packed.clusters())) {
        std::uint64_t cells = 0;
        for (const std::uint32_t c : clusters_) cells += cells_of(c);
        each_ = std::max<std::uint64_t>(1, (cells + wanted - 1) / std::max<std::uint64_t>(1, wanted));
    }

    Result<Cells> take(const Progress& progress) {
        const auto add = [&](std::size_t first, std::size_t last) -> Result<void> {
            for (std::size_t i = first; i < last; ++i) add_cluster(clusters_[i]);
            return {};
        };
        if (auto done = in_memory(packed_, clusters_, Parts::all, progress, add); !done) return done.error();
        Cells cells;
        cells.connectivity = Array::own(std::move(connectivity_));
        cells.offsets = Array::own(std::move(offsets_));
        cells.types = Array::own(std::move(types_));
        return cells;
    }

private:
    std::uint64_t cells_of(std::uint32_t c) const { return packed_.headers[c].tets() + packed_.headers[c].others(); }

    void add_cluster(std::uint32_t c) {
        std::array<std::uint64_t, max_cluster_points> locals;
        local_points(packed_, c, locals.data());
        const auto add = [&](CellKind kind, std::span<const std::uint8_t> corners) {
            if (met_++ % each_ != 0) return;
            for (const std::uint8_t local : corners)
                connectivity_.push_back(static_cast<std::int64_t>(packed_.user_point(locals[local])));
            offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
            types_.push_back(vtk_types[static_cast<std::size_t>(kind)]);
        };
        for_cells(packed_, c, add);
    }

    const Packed& packed_;
    std::vector<std::uint32_t> clusters_; ///< that are looked at
    std::uint64_t each_ = 1, met_ = 0;    ///< every so many of their cells is taken
    std::vector<std::int64_t> connectivity_, offsets_{0};
    std::vector<std::uint8_t> types_;
};

Result<Grid> unpacked(const Packed& packed, const Progress& progress) {
    auto grid = unpacked_places_and_values(packed, progress);
    if (!grid) return grid;
    const UnpackedCounts counts = count_stored(packed);
    constexpr std::uint64_t narrow = std::uint64_t{1} << 31;
    grid->cells = packed.user_points < narrow ? unpacked_cells<std::int32_t>(packed, counts, progress)
                                              : unpacked_cells<std::int64_t>(packed, counts, progress);
    if (progress.cancelled()) return unpacking_cancelled();
    return grid;
}

Result<UnpackedSample> unpacked_sample(const Packed& packed, std::uint64_t cells, const Progress& progress) {
    auto grid = unpacked_places_and_values(packed, progress);
    if (!grid) return grid.error();
    auto some = CellSampler(packed, cells).take(progress);
    if (!some) return some.error();
    grid->cells = *std::move(some);
    UnpackedSample sample{*std::move(grid), 0};
    for (const ClusterHeader& h : packed.headers) sample.cells += h.tets() + h.others();
    return sample;
}

} // namespace
} // namespace core

Result<Grid> unpack(const PackedGrid& packed, const Run& run) {
    return core::carry_out("unpacking", run, [&](const Progress& progress) -> Result<Grid> {
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        return core::unpacked(**whole, progress);
    });
}

Result<UnpackedSample> unpack_sample(const PackedGrid& packed, std::uint64_t cells, const Run& run) {
    return core::carry_out("unpacking", run, [&](const Progress& progress) -> Result<UnpackedSample> {
        return core::unpacked_sample(*packed.shared_data(), cells, progress);
    });
}

Result<Field> unpack_field(const PackedGrid& packed, const Run& run) {
    return core::carry_out("unpacking a field", run, [&](const Progress& progress) -> Result<Field> {
        return core::unpacked_field(*packed.shared_data(), progress);
    });
}

} // namespace isotet
