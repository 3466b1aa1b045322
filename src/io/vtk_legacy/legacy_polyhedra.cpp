// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_legacy/legacy_polyhedra.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "grid/cell_faces.hpp"
#include "io/vtk_legacy/legacy_values.hpp"

namespace isotet::io {
namespace {

/// Adds the points of the faces, in their order; false where the numbers are no faces.
template <class Index>
bool add_points_of_faces(std::span<const Index> faces, std::vector<Index>& points) {
    if (faces.empty()) return false;
    auto left = static_cast<std::uint64_t>(faces[0]);
    std::size_t at = 1;
    for (; left > 0 && at < faces.size(); --left) {
        const auto corners = static_cast<std::uint64_t>(faces[at++]);
        if (corners > faces.size() - at) return false;
        points.insert(points.end(), faces.begin() + static_cast<std::ptrdiff_t>(at),
                      faces.begin() + static_cast<std::ptrdiff_t>(at + corners));
        at += static_cast<std::size_t>(corners);
    }
    return left == 0 && at == faces.size();
}

template <class Index>
class PolyhedraOfLegacy {
public:
    Result<void> take(std::span<const Index> corners, std::span<const std::size_t> offsets,
                      std::span<const std::uint8_t> types, Cells& cells) {
        connectivity_.reserve(corners.size());
        offsets_.reserve(offsets.size());
        face_offsets_.reserve(offsets.size());
        for (std::size_t cell = 0; cell < types.size(); ++cell) {
            const std::size_t begin = offsets[cell], size = offsets[cell + 1] - begin;
            if (!add(corners.subspan(begin, size), types[cell]))
                return invalid_data(
                    fmt::format("cell {} is a polyhedron, but its {} numbers are not the number of its faces and, for "
                                "each face, its number of points and these points",
                                cell, size));
        }
        cells.connectivity = Array::own(std::move(connectivity_));
        cells.offsets = Array::own(std::move(offsets_));
        cells.faces = Array::own(std::move(faces_));
        cells.face_offsets = Array::own(std::move(face_offsets_));
        return {};
    }

private:
    bool add(std::span<const Index> numbers, std::uint8_t type) {
        if (type == core::polyhedron_type) {
            points_.clear();
            if (!add_points_of_faces(numbers, points_)) return false;
            std::ranges::sort(points_);
            points_.erase(std::ranges::unique(points_).begin(), points_.end());
            connectivity_.insert(connectivity_.end(), points_.begin(), points_.end());
            faces_.insert(faces_.end(), numbers.begin(), numbers.end());
        } else {
            connectivity_.insert(connectivity_.end(), numbers.begin(), numbers.end());
        }
        offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
        face_offsets_.push_back(static_cast<std::int64_t>(faces_.size()));
        return true;
    }

    std::vector<Index> connectivity_, faces_, points_;
    std::vector<std::int64_t> offsets_{0}, face_offsets_{0};
};

template <class To>
Array converted(const Array& from) {
    return mapped<To>(from, [](auto value) { return static_cast<To>(value); });
}

} // namespace

Result<void> take_legacy_polyhedra(Cells& cells) {
    const Array stored_types = cells.types;
    const auto types = stored_types.as<std::uint8_t>();
    if (std::ranges::find(types, core::polyhedron_type) == types.end()) return {};
    const Array offsets = converted<std::size_t>(cells.offsets);
    const bool narrow = cells.connectivity.type() == ScalarType::int32;
    const Array corners = narrow ? cells.connectivity : converted<std::int64_t>(cells.connectivity);
    const auto begins = offsets.as<std::size_t>();
    return narrow ? PolyhedraOfLegacy<std::int32_t>().take(corners.as<std::int32_t>(), begins, types, cells)
                  : PolyhedraOfLegacy<std::int64_t>().take(corners.as<std::int64_t>(), begins, types, cells);
}

} // namespace isotet::io
