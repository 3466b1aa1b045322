// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces that one cell has: of the boundary, or of cells beside smaller or larger ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"

namespace isotet::linear {

/// Faces by cell and the place among its loops (CellLoops), ascending.
class OpenFaces {
public:
    struct Place {
        std::uint64_t cell;
        std::uint32_t face;
        friend auto operator<=>(const Place&, const Place&) = default;
    };

    std::size_t size() const { return places_.size(); }
    const Place& place(std::size_t i) const { return places_[i]; }
    std::span<const std::uint64_t> loop(std::size_t i) const {
        return {points_.data() + first_[i], first_[i + 1] - first_[i]};
    }

    void reserve(std::size_t faces, std::size_t points) {
        places_.reserve(faces);
        first_.reserve(faces + 1);
        points_.reserve(points);
    }
    void add(const Place& place, std::span<const std::uint64_t> loop) {
        places_.push_back(place);
        points_.insert(points_.end(), loop.begin(), loop.end());
        first_.push_back(points_.size());
    }

private:
    std::vector<Place> places_;
    std::vector<std::uint64_t> points_;
    std::vector<std::size_t> first_{0};
};

/// Those faces whose points an odd number of faces has, once each, and of these those that share a point with a face of
/// another cell that is one of them. Hashes of faces are added by exclusive or at their lowest point: where the sum is
/// 0, all faces have a neighbour.
///
/// Guarantees   the same for any thread count
/// Cost         two passes over the cells, 8 bytes a point; 57 bytes for each face at a point whose sum is not 0
/// Errors       out_of_memory; cancelled
Result<OpenFaces> find_open_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                  const Progress& progress);

} // namespace isotet::linear
