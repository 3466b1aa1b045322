// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a packed grid back to arrays with the user's numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"

namespace isotet {
namespace core {
namespace {

/// VTK's numbers, by CellKind.
constexpr std::array<std::uint8_t, cell_kind_count> vtk_types{10, 14, 13, 12};

/// Arrays by the user's point numbers: f(packed point, out) writes `components` of a used point; points that no cell uses
/// have `unused`.
template <class To, class F>
Array by_user_point(const Packed& packed, std::size_t components, const std::array<To, 3>& unused, const F& f) {
    Buffer<To> out(components * packed.user_points);
    parallel_ranges(packed.user_points, 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) std::copy_n(unused.begin(), components, out.data() + components * i);
    });
    parallel_ranges(packed.points(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) f(p, out.data() + components * packed.user_point(p));
    });
    return std::move(out).to_array(components);
}

/// In the coordinates of the user.
template <class To, class Real>
Array unpacked_points(const Packed& packed) {
    const Real* const positions = packed.as<Real>().positions.data();
    const auto write = [&](std::size_t p, To* to) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            to[axis] = static_cast<To>(static_cast<double>(positions[3 * p + axis]) + packed.origin[axis]);
    };
    std::array<To, 3> unused{};
    if (packed.points()) write(0, unused.data()); // no bounds grow by it
    return by_user_point<To>(packed, 3, unused, write);
}

template <class Real>
Array unpacked_points_of(const Packed& packed) {
    return packed.point_type == ScalarType::float32 ? unpacked_points<float, Real>(packed)
                                                    : unpacked_points<double, Real>(packed);
}

/// A value in the user's type: integers are rounded, and kept within it.
template <class To>
To as_user_value(double value) {
    if constexpr (std::is_floating_point_v<To>) return static_cast<To>(value);
    else {
        if (is_nan(value)) return To{0};
        const double lower = static_cast<double>(std::numeric_limits<To>::min());
        const double upper = static_cast<double>(std::numeric_limits<To>::max());
        const double rounded = std::nearbyint(value);
        if (rounded <= lower) return std::numeric_limits<To>::min();
        if (rounded >= upper) return std::numeric_limits<To>::max();
        return static_cast<To>(rounded);
    }
}

template <class To, class Real>
Array unpacked_values_as(const Packed& packed) {
    const Real* const values = packed.as<Real>().values.data();
    std::array<To, 3> unused{};
    if constexpr (std::is_floating_point_v<To>) unused.fill(std::numeric_limits<To>::quiet_NaN());
    return by_user_point<To>(packed, 1, unused, [&](std::size_t p, To* to) {
        const auto stored = static_cast<double>(values[p]);
        if (std::abs(stored) >= stored_infinity) *to = as_user_value<To>(std::copysign(HUGE_VAL, stored));
        else *to = as_user_value<To>(restore_value(stored, packed.storage));
    });
}

template <class Real>
Array unpacked_values_of(const Packed& packed) {
    return packed.field.visit([&]<class T>(std::span<const T>) { return unpacked_values_as<T, Real>(packed); });
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

/// Cells cluster after cluster, as they are stored.
template <class Index>
Cells unpacked_cells(const Packed& packed, const UnpackedCounts& counts) {
    const std::size_t cells = counts.first_cell.back();
    Buffer<Index> connectivity(counts.first_corner.back());
    Buffer<std::int64_t> offsets(counts.only_tets ? 0 : cells + 1);
    Buffer<std::uint8_t> types(counts.only_tets ? 0 : cells);
    parallel_each(packed.clusters(), 64, [&](std::size_t c) {
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
        for (const StoredTet& tet : packed.cluster_tets(c)) add(CellKind::tetrahedron, tet.corners);
        packed.for_other_cells(c, [&](const StoredCell& other) { add(other.kind, other.corners); });
    });
    Cells out;
    out.connectivity = std::move(connectivity).to_array();
    if (counts.only_tets) return out;
    offsets[cells] = static_cast<std::int64_t>(counts.first_corner.back());
    out.offsets = std::move(offsets).to_array();
    out.types = std::move(types).to_array();
    return out;
}

Field unpacked_field(const Packed& packed) {
    return {packed.field_report.name,
            packed.single() ? unpacked_values_of<float>(packed) : unpacked_values_of<double>(packed)};
}

Grid unpacked(const Packed& packed) {
    const UnpackedCounts counts = count_stored(packed);
    constexpr std::uint64_t narrow = std::uint64_t{1} << 31;
    Grid grid;
    grid.points = packed.single() ? unpacked_points_of<float>(packed) : unpacked_points_of<double>(packed);
    grid.cells = packed.user_points < narrow ? unpacked_cells<std::int32_t>(packed, counts)
                                             : unpacked_cells<std::int64_t>(packed, counts);
    grid.point_fields.push_back(unpacked_field(packed));
    return grid;
}

} // namespace
} // namespace core

Result<Grid> unpack(const PackedGrid& packed, const Run& run) {
    return core::carry_out("unpacking", run, [&](const Progress& progress) -> Result<Grid> {
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        return core::unpacked(**whole);
    });
}

Result<Field> unpack_field(const PackedGrid& packed, const Run& run) {
    return core::carry_out("unpacking a field", run, [&](const Progress& progress) -> Result<Field> {
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        return core::unpacked_field(**whole);
    });
}

} // namespace isotet
