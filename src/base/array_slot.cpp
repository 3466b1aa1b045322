// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/array_slot.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "base/surface_arrays.hpp"

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
    each_array(surface, [&](Array& array, SurfaceArray which, std::string_view field) {
        if (!array.empty() && !gave(array)) array = copied(array, {this, number, which, field});
    });
}

} // namespace core

} // namespace isotet
