// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/array_slot.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace isotet {

SurfaceSink::~SurfaceSink() = default;

namespace core {

namespace {

constexpr std::size_t values_per_task = std::size_t{1} << 16;

Array copied(const Array& array, const ArraySlot& slot) {
    return array.visit([&]<class T>(std::span<const T> values) {
        SharedBuffer<T> out = slot.make<T>(array.tuples(), array.components());
        parallel_ranges(values.size(), values_per_task, [&](std::size_t begin, std::size_t end) {
            std::copy(values.begin() + static_cast<std::ptrdiff_t>(begin),
                      values.begin() + static_cast<std::ptrdiff_t>(end), out.data() + begin);
        });
        return std::move(out).to_array(array.components());
    });
}

} // namespace

std::shared_ptr<void> RememberingSink::take(const Wanted& wanted) {
    Wanted numbered = wanted;
    numbered.surface += first_;
    std::shared_ptr<void> given = sink_->take(numbered);
    given_.push_back(given);
    return given;
}

bool RememberingSink::gave(const Array& array) const {
    const std::weak_ptr<const void> owner = array.owner();
    return std::ranges::any_of(given_, [&](const std::weak_ptr<const void>& given) {
        return !given.expired() && !given.owner_before(owner) && !owner.owner_before(given);
    });
}

void RememberingSink::bring(Surface& surface, std::size_t number) {
    const auto bring_array = [&](Array& array, SurfaceArray which, std::string_view field = {}) {
        if (array.empty() || gave(array)) return;
        array = copied(array, {this, number, which, field});
    };
    bring_array(surface.positions, SurfaceArray::positions);
    bring_array(surface.triangles, SurfaceArray::triangles);
    bring_array(surface.normals, SurfaceArray::normals);
    bring_array(surface.edge_ends, SurfaceArray::edge_ends);
    bring_array(surface.edge_weights, SurfaceArray::edge_weights);
    bring_array(surface.source_cells, SurfaceArray::source_cells);
    for (Field& field : surface.point_fields) bring_array(field.values, SurfaceArray::point_field, field.name);
    for (Field& field : surface.cell_fields) bring_array(field.values, SurfaceArray::cell_field, field.name);
}

} // namespace core

} // namespace isotet
