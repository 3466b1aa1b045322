// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/vtk_xml/join_cells.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "io/own/face_streams.hpp"
#include "io/own/vtk_xml/uniform_cells.hpp"

namespace isotet::io::vtk_xml {
namespace {

class CellsJoiner {
public:
    explicit CellsJoiner(const std::vector<Cells>& parts) : parts_(parts) {
        for (const Cells& part : parts_) {
            cells_ += part.count();
            corners_ += part.connectivity.size();
            narrow_ = narrow_ && (part.connectivity.empty() || part.connectivity.type() == ScalarType::int32);
        }
    }

    Cells join(const std::vector<std::uint64_t>& points_of_parts) const {
        return narrow_ ? join_as<std::int32_t>(points_of_parts) : join_as<std::int64_t>(points_of_parts);
    }

private:
    template <class Index>
    Cells join_as(const std::vector<std::uint64_t>& points_of_parts) const {
        std::vector<Index> connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        FaceStreams faces;
        connectivity.reserve(corners_);
        offsets.reserve(cells_ + 1);
        types.reserve(cells_);
        std::uint64_t first_point = 0;
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            const Cells& part = parts_[p];
            const std::size_t first_corner = connectivity.size(), count = part.count();
            part.connectivity.visit([&](auto corners) {
                for (const auto corner : corners)
                    connectivity.push_back(static_cast<Index>(static_cast<std::uint64_t>(corner) + first_point));
            });
            if (part.offsets.empty()) {
                const auto uniform = static_cast<std::uint8_t>(part.uniform_type);
                const auto corners = static_cast<std::size_t>(*corners_of_uniform(uniform));
                for (std::size_t i = 0; i < count; ++i)
                    offsets.push_back(static_cast<Index>(first_corner + (i + 1) * corners));
                types.insert(types.end(), count, uniform);
            } else {
                part.offsets.visit([&](auto ends) {
                    for (std::size_t i = 1; i < ends.size(); ++i)
                        offsets.push_back(static_cast<Index>(static_cast<std::uint64_t>(ends[i]) + first_corner));
                });
                const auto own = part.types.as<std::uint8_t>();
                types.insert(types.end(), own.begin(), own.end());
            }
            faces.add(part, [&](std::uint64_t point) { return point + first_point; });
            first_point += points_of_parts[p];
        }
        Cells cells;
        const bool uniform = !parts_.empty() && std::ranges::all_of(parts_, [&](const Cells& part) {
            return part.connectivity.empty() || (part.offsets.empty() && part.uniform_type == first_type());
        });
        cells.connectivity = Array::own(std::move(connectivity));
        cells.uniform_type = uniform ? first_type() : CellType::tetrahedron;
        if (!uniform) {
            cells.offsets = Array::own(std::move(offsets));
            cells.types = Array::own(std::move(types));
        }
        std::move(faces).give_to(cells);
        return cells;
    }

    CellType first_type() const {
        const auto first = std::ranges::find_if(parts_, [](const Cells& part) { return !part.connectivity.empty(); });
        return first == parts_.end() ? CellType::tetrahedron : first->uniform_type;
    }

    const std::vector<Cells>& parts_;
    std::size_t cells_ = 0, corners_ = 0;
    bool narrow_ = true;
};

} // namespace

Result<void> check_corners(const Cells& cells, std::uint64_t points) {
    const bool in_range = all_pieces(cells.connectivity, [&](std::uint64_t, auto corners) {
        return std::ranges::all_of(corners, [&](auto corner) { return static_cast<std::uint64_t>(corner) < points; });
    });
    if (!in_range) return invalid_data(fmt::format("a cell of a piece has a point that is not among its {}", points));
    return check_face_streams(cells, points);
}

Cells join_cells(const std::vector<Cells>& parts, const std::vector<std::uint64_t>& points) {
    return CellsJoiner(parts).join(points);
}

} // namespace isotet::io::vtk_xml
