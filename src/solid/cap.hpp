// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The boundary's part of a solid: triangles on vertices of isosurfaces and on points of the grid.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/array.hpp>

#include "numbers/storage.hpp"
#include "solid/boundary_faces.hpp"
#include "solid/rim.hpp"

namespace isotet::solid {

/// An isovalue and its surface.
template <class Real>
struct Cut {
    core::StoredIsovalue<Real> isovalue;
    Rim rim;
    Array positions;                ///< of the surface's vertices
    std::uint32_t first_vertex = 0; ///< of its surface in the solid
};

/// What lies between two isovalues; one that is not there cuts nothing off.
template <class Real>
struct Cuts {
    core::Storage storage; ///< of values
    std::optional<Cut<Real>> lower, upper;
    std::uint32_t vertices = 0; ///< of both surfaces
};

/// A vertex inside a part of a face that is not flat (warped_face.hpp).
struct Apex {
    std::array<double, 3> position{};
    std::vector<std::uint32_t> around;      ///< vertices of the part, those at ties twice
    std::array<std::uint64_t, 4> corners{}; ///< points of the grid: the whole face
    std::array<double, 4> shift{}; ///< the position is the mean of those around and the sum of these times the corners
    std::uint32_t face = 0;        ///< of the boundary; the parts of one follow each other, as for_parts() has them

    /// What it carries: linear fields stay linear. The mean alone where a corner has no value.
    /// `of_vertex(v)`, `of_point(p)`   values, as double
    template <class OfVertex, class OfPoint>
    double value(const OfVertex& of_vertex, const OfPoint& of_point) const {
        double sum = 0, more = 0;
        for (const std::uint32_t vertex : around) sum += of_vertex(vertex);
        for (std::size_t k = 0; k < corners.size(); ++k) more += shift[k] * of_point(corners[k]);
        return sum / static_cast<double>(around.size()) + (std::isfinite(more) ? more : 0);
    }
};

struct Cap {
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< vertices of the solid; outwards
    std::vector<std::uint64_t> cells;                    ///< of the grid, one a triangle
    std::vector<FaceMark> marks;                         ///< of the faces, one a triangle; empty: no face has one
    std::vector<std::uint64_t> points; ///< of the grid: vertices behind those of the isosurfaces, ascending
    std::vector<std::uint8_t> tied;    ///< of each of these points: whether it is
    std::vector<Apex> apexes;          ///< vertices behind these
    std::uint64_t seam_edges = 0;      ///< where isosurfaces end in doubled walls
    std::uint64_t unfit_edges = 0;     ///< where they end in unfit ones
};

/// `points`   of the grid
/// `values`   of the grid, one scalar a point
template <class Real>
Cap make_cap(const BoundaryFaces& boundary, const Array& points, const Array& values, const Cuts<Real>& cuts);

/// Edges of the cap that it and the isosurfaces together do not use equally often in both directions.
///
/// `isosurfaces`   triangles of the solid, three vertices each, of `vertices` in all
std::uint64_t count_open_edges(const Cap& cap, std::span<const std::uint32_t> isosurfaces, std::uint32_t vertices);

} // namespace isotet::solid
