// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Shapes of open faces: which may cover a larger one, by their places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "linear/hanging/open_faces.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

constexpr double beside_face = 0.25;    // of a face's extent: one that curved shapes put beside its place
constexpr double largest_share = 0.999; // of a face's area: one that covers it with others

/// Twice a face's area along its normal, by its loop (Newell).
Point normal_of(std::span<const std::uint64_t> loop, const core::PointReader& points);

/// The mean of its points.
Point middle_of(std::span<const std::uint64_t> loop, const core::PointReader& points);

/// What tells whether one face may cover another, by their places.
struct FaceShape {
    Point middle{}, normal{}; ///< the normal outward, of twice the area
    double twice_area = 0, extent = 0;
    bool is_turned = false, is_flat = false; ///< turned: a loop that is clockwise seen from outside; flat: in one plane
};

/// `inside`   the mean of the corners of the face's cell
FaceShape shape_of(std::span<const std::uint64_t> loop, const Point& inside, const core::PointReader& points);

/// Whether a smaller face faces the other way, with its middle over a face. `loop` is that of the larger.
bool is_over(const FaceShape& face, std::span<const std::uint64_t> loop, const FaceShape& small,
             const core::PointReader& points);

/// Of the middle of a face from one that it is over, in extents of that.
double distance(const FaceShape& face, std::span<const std::uint64_t> loop, const FaceShape& small,
                const core::PointReader& points);

class FaceShapes {
public:
    /// All borrowed.
    FaceShapes(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points);

    const FaceShape& operator[](std::size_t face) const { return shapes_[face]; }
    const Point& middle(std::size_t face) const { return shapes_[face].middle; }
    /// The diagonal of its box.
    double extent(std::size_t face) const { return shapes_[face].extent; }
    /// A loop that is clockwise seen from outside of its cell.
    bool is_turned(std::size_t face) const { return shapes_[face].is_turned; }

    /// A smaller face of another cell that faces the other way, with its middle over a face.
    bool is_over(std::size_t face, std::size_t other) const {
        return twice_areas_[other] < largest_share * twice_areas_[face] &&
               faces_.place(face).cell != faces_.place(other).cell &&
               linear::is_over(shapes_[face], faces_.loop(face), shapes_[other], points_);
    }

    /// Of the middle of a face from one that it is over, in extents of that.
    double distance(std::size_t face, std::size_t other) const {
        return linear::distance(shapes_[face], faces_.loop(face), shapes_[other], points_);
    }

private:
    const OpenFaces& faces_;
    const core::PointReader& points_;
    std::vector<FaceShape> shapes_;
    std::vector<double> twice_areas_; ///< looked at more than all else
};

} // namespace isotet::linear
