// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/cell_places.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/fixed_corners.hpp"
#include "grid/patches.hpp"
#include "io/pieces/uniform_cells.hpp"

namespace isotet::io {
namespace {

constexpr std::uint64_t stride = std::uint64_t{1} << 10;

/// Scalars [begin, end) of an array.
Array stretch_of(const Array& array, std::uint64_t begin, std::uint64_t end) {
    return {array.type(), static_cast<const std::byte*>(array.data()) + begin * size_of(array.type()), end - begin, 1,
            nullptr};
}

} // namespace

std::optional<CellPlaces> CellPlaces::make(std::span<const std::uint8_t> types) {
    CellPlaces places(types);
    places.before_.assign(types.size() / stride + 1, 0);
    std::atomic<bool> known = true, uniform = !types.empty() && vtk_xml::corners_of_uniform(types.front());
    core::parallel_each(places.before_.size(), 64, [&](std::size_t i) {
        const std::uint64_t end = std::min<std::uint64_t>(types.size(), (i + 1) * stride);
        std::uint64_t corners = 0;
        bool all_known = true, all_same = true;
        for (std::uint64_t cell = i * stride; cell < end; ++cell) {
            const std::uint64_t own = core::fixed_corners_of(types[cell]);
            all_known &= own != 0;
            all_same &= types[cell] == types.front();
            corners += own;
        }
        places.before_[i] = corners;
        if (!all_known) known.store(false, std::memory_order_relaxed);
        if (!all_same) uniform.store(false, std::memory_order_relaxed);
    });
    if (!known) return std::nullopt;
    if (uniform) return CellPlaces(static_cast<CellType>(types.front()), types.size());
    std::uint64_t next = 0;
    for (std::uint64_t& before : places.before_) before = std::exchange(next, next + before);
    return places;
}

CellPlaces::CellPlaces(CellType type, std::uint64_t cells)
    : cells_(cells),
      type_(static_cast<std::uint8_t>(type)),
      uniform_corners_(core::fixed_corners_of(static_cast<std::uint8_t>(type))) {}

bool CellPlaces::all_have_volumes() const {
    return are_uniform() ? core::has_a_volume(type_) : std::ranges::all_of(types_, core::has_a_volume);
}

std::uint64_t CellPlaces::begin(std::uint64_t cell) const {
    if (are_uniform()) return cell * uniform_corners_;
    std::uint64_t corners = before_[cell / stride];
    for (std::uint64_t i = cell / stride * stride; i < cell; ++i) corners += core::fixed_corners_of(types_[i]);
    return corners;
}

std::uint64_t CellPlaces::cell_at(std::uint64_t corner) const {
    if (are_uniform()) return corner / uniform_corners_;
    const auto after = std::ranges::upper_bound(before_, corner);
    std::uint64_t cell = static_cast<std::uint64_t>(after - before_.begin() - 1) * stride;
    for (std::uint64_t next = *std::prev(after); (next += core::fixed_corners_of(types_[cell])) <= corner;) ++cell;
    return cell;
}

namespace {

template <class Offset>
Array offsets_at(const CellPlaces& places) {
    core::Buffer<Offset> offsets(places.cells() + 1);
    core::parallel_ranges(offsets.size(), stride, [&](std::size_t begin, std::size_t end) {
        std::uint64_t next = places.begin(begin);
        for (std::size_t cell = begin; cell < end; ++cell) {
            offsets[cell] = static_cast<Offset>(next);
            if (cell < places.cells()) next += core::fixed_corners_of(places.type(cell));
        }
    });
    return std::move(offsets).to_array();
}

} // namespace

Cells cells_at(const CellPlaces& places, const Array& types, Array corners) {
    Cells cells;
    cells.connectivity = std::move(corners);
    if (places.are_uniform()) {
        cells.uniform_type = static_cast<CellType>(places.type(0));
        return cells;
    }
    cells.types = types;
    constexpr auto max_narrow = static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
    cells.offsets =
        places.corners() <= max_narrow ? offsets_at<std::int32_t>(places) : offsets_at<std::int64_t>(places);
    return cells;
}

void WholeCells::add(std::uint64_t first, const Array& corners) {
    const std::uint64_t end = first + corners.size();
    if (first >= end) return;
    const std::uint64_t in_cell = places_.cell_at(first);
    const std::uint64_t begin_cell = in_cell + (places_.begin(in_cell) < first ? 1 : 0);
    const std::uint64_t end_cell = end < places_.corners() ? places_.cell_at(end) : places_.cells();
    const std::uint64_t head = std::min(end, places_.begin(begin_cell));
    const std::uint64_t tail = std::max(head, places_.begin(end_cell));
    if (head > first) keep_fragment(first, stretch_of(corners, 0, head - first));
    if (end > tail) keep_fragment(tail, stretch_of(corners, tail - first, end - first));
    if (end_cell > begin_cell)
        visit_(begin_cell, end_cell - begin_cell, stretch_of(corners, head - first, tail - first));
}

void WholeCells::keep_fragment(std::uint64_t first, const Array& corners) {
    Fragment fragment{first, {}};
    corners.visit([&](auto values) {
        for (const auto corner : values)
            if constexpr (std::is_integral_v<decltype(corner)>) fragment.corners.push_back(core::widened(corner));
    });
    const std::lock_guard lock(mutex_);
    fragments_.push_back(std::move(fragment));
}

void WholeCells::finish() {
    std::ranges::sort(fragments_, {}, &Fragment::first);
    std::vector<std::uint64_t> corners;
    for (const Fragment& fragment : fragments_) {
        corners.insert(corners.end(), fragment.corners.begin(), fragment.corners.end());
        const std::uint64_t cell = places_.cell_at(fragment.first);
        if (fragment.first + fragment.corners.size() < places_.begin(cell + 1)) continue;
        visit_(cell, 1, Array::borrow(corners));
        corners.clear();
    }
    fragments_.clear();
}

} // namespace isotet::io
