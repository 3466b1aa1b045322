// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces that one cell has, among those that are looked at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "linear/hanging/face_walk.hpp"

namespace isotet::linear {

struct FoundFace {
    std::uint64_t hash;
    OpenFaces::Place place;
};

/// Adds faces of the cells from `begin` to before `end`, in their order. Called in parallel.
using LookAtCells =
    std::function<void(FaceWalk& walk, std::size_t begin, std::size_t end, std::vector<FoundFace>& found)>;

/// Those faces that `look` finds once, in the order of the cells. Faces of one hash are one face.
///
/// Guarantees   the same for any thread count
/// Cost         57 bytes a face that `look` finds
/// Errors       out_of_memory: asked for while faces are found, and before they are compared; cancelled
Result<std::vector<FoundFace>> lone_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                          const LookAtCells& look, const Progress& progress);

/// The same of the cells for which has_cell(cell) is true, and of their faces for which has_face(walk, place, hash) is.
template <class HasCell, class HasFace>
Result<std::vector<FoundFace>> lone_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                          const HasCell& has_cell, const HasFace& has_face, const Progress& progress) {
    const auto look = [&](FaceWalk& walk, std::size_t begin, std::size_t end, std::vector<FoundFace>& found) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (!has_cell(cell)) continue;
            walk.each_hash(cell, [&](std::size_t face, const FaceHash& hash) {
                const OpenFaces::Place place{cell, static_cast<std::uint32_t>(face)};
                if (has_face(walk, place, hash)) found.push_back({hash.hash, place});
            });
        }
    };
    return lone_faces(cells, faces, look, progress);
}

/// With their points.
OpenFaces with_loops(const std::vector<FoundFace>& found, const core::CellReader& cells, const core::FaceReader& faces);

} // namespace isotet::linear
