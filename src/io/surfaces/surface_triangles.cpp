// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_triangles.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace isotet::io {

void TriangleList::remember_cells() {
    if (!one_to_one_) return;
    one_to_one_ = false;
    cell_of_triangle_.resize(triangles());
    std::iota(cell_of_triangle_.begin(), cell_of_triangle_.end(), std::uint64_t{0});
}

void TriangleList::add_triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    if (wide_.empty() && std::max({a, b, c}) > std::numeric_limits<std::uint32_t>::max()) {
        wide_.assign(narrow_.begin(), narrow_.end());
        narrow_ = {};
    }
    if (wide_.empty() && std::max({a, b, c}) <= std::numeric_limits<std::uint32_t>::max()) {
        for (const auto corner : {a, b, c}) narrow_.push_back(static_cast<std::uint32_t>(corner));
    } else {
        wide_.insert(wide_.end(), {a, b, c});
    }
    if (!one_to_one_) cell_of_triangle_.push_back(cells_);
}

void TriangleList::add_polygon(std::span<const std::uint64_t> corners) {
    if (corners.size() != 3) remember_cells();
    for (std::size_t i = 2; i < corners.size(); ++i) add_triangle(corners[0], corners[i - 1], corners[i]);
    ++cells_;
}

void TriangleList::add_strip(std::span<const std::uint64_t> corners) {
    if (corners.size() != 3) remember_cells();
    for (std::size_t i = 2; i < corners.size(); ++i) {
        if (i % 2 == 0) add_triangle(corners[i - 2], corners[i - 1], corners[i]);
        else add_triangle(corners[i - 1], corners[i - 2], corners[i]);
    }
    ++cells_;
}

void TriangleList::skip_cells(std::uint64_t count) {
    if (count == 0) return;
    remember_cells();
    cells_ += count;
}

Array TriangleList::spread(const Array& of_cells) const {
    if (one_to_one_) return of_cells;
    return of_cells.visit([&](auto values) {
        using Scalar = std::remove_const_t<typename decltype(values)::element_type>;
        const std::size_t components = of_cells.components();
        std::vector<Scalar> result;
        result.reserve(cell_of_triangle_.size() * components);
        for (const auto cell : cell_of_triangle_) {
            for (std::size_t i = 0; i < components; ++i) result.push_back(values[cell * components + i]);
        }
        return Array::own(std::move(result), components);
    });
}

Result<Array> TriangleList::take(std::uint64_t vertices) {
    const auto find_bad = [&](const auto& corners) {
        const auto bad = std::ranges::find_if(corners, [&](auto corner) { return corner >= vertices; });
        return static_cast<std::size_t>(bad - corners.begin());
    };
    const std::size_t bad = wide_.empty() ? find_bad(narrow_) : find_bad(wide_);
    if (bad < 3 * triangles()) {
        const std::uint64_t corner = wide_.empty() ? narrow_[bad] : wide_[bad];
        return Error{ErrorCode::invalid_data,
                     fmt::format("cell {} has vertex {}, but the file has {} vertices", cell_of(bad / 3),
                                 static_cast<std::int64_t>(corner), vertices)};
    }
    if (vertices <= std::numeric_limits<std::uint32_t>::max()) {
        // All corners are below `vertices`, so none was wide.
        return Array::own(std::exchange(narrow_, {}), 3);
    }
    if (wide_.empty()) wide_.assign(narrow_.begin(), narrow_.end());
    return Array::own(std::exchange(wide_, {}), 3);
}

} // namespace isotet::io
