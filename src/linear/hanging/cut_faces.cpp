// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/cut_faces.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/buffer.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "linear/hanging/face_shapes.hpp"
#include "linear/hanging/face_walk.hpp"
#include "linear/hanging/place_tree.hpp"

namespace isotet::linear {

namespace {

constexpr double near_face = 0.1; // of a face's extent: one that may lie on it
constexpr std::size_t cells_per_list = 1 << 12;

/// What holds some points, and curved neighbours beside them.
class Box {
public:
    void add(const Point& at) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], at[axis]);
            upper[axis] = std::max(upper[axis], at[axis]);
        }
    }
    void widen() {
        const double more = beside_face * std::sqrt(core::squared_distance(lower, upper));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] -= more;
            upper[axis] += more;
        }
    }

    Point lower{most, most, most}, upper{-most, -most, -most};

private:
    static constexpr double most = std::numeric_limits<double>::max();
};

class CutFaceFinder {
public:
    CutFaceFinder(const core::CellReader& cells, const core::FaceReader& faces, const core::PointReader& points,
                  const CutRule& rule, const Progress& progress)
        : cells_(cells),
          faces_(faces),
          points_(points),
          rule_(rule),
          progress_(progress),
          sums_(slots(cells)),
          cut_(cells.count()) {}

    /// Of the sums of hashes.
    static std::size_t slots(const core::CellReader& cells) { return std::bit_ceil(cells.count() + 1); }

    /// Those that one cell has.
    OpenFaces alone() {
        add_hashes();
        OpenFaces out;
        FaceWalk walk(cells_, faces_);
        for (const FoundFace& face : alone_of(collect())) out.add(face.place, walk.loop(face.place));
        return out;
    }

    /// All faces of cells near the middles of faces of others.
    std::vector<OpenFaces::Place> beside(const OpenFaces& cut, const PlaceTree& middles) const {
        constexpr std::size_t together =
            32; // cells that follow each other are mostly far from all, and near each other
        using Part = std::vector<OpenFaces::Place>;
        return gathered<OpenFaces::Place>([&](FaceWalk& walk, std::size_t first, std::size_t last, Part& part) {
            std::array<Box, together> boxes;
            for (std::size_t begin = first; begin < last; begin += together) {
                const std::size_t count = std::min(together, last - begin);
                Box around;
                for (std::size_t i = 0; i < count; ++i) {
                    boxes[i] = box_of(begin + i);
                    around.add(boxes[i].lower);
                    around.add(boxes[i].upper);
                }
                if (!has_place_in(middles, around, [](std::uint32_t) { return true; })) continue;
                for (std::size_t i = 0; i < count; ++i) {
                    const std::size_t cell = begin + i;
                    if (!has_place_in(middles, boxes[i], [&](std::uint32_t at) { return cut.place(at).cell != cell; }))
                        continue;
                    if (!walk.open(cell)) continue;
                    for (std::size_t face = 0; face < walk.face_count(); ++face)
                        part.push_back({cell, static_cast<std::uint32_t>(face)});
                }
            }
        });
    }

private:
    /// Which faces of the open cell are cut: a bit each, or `listed` where they are asked one by one.
    std::uint8_t cut_faces_of(const FaceWalk& walk) const {
        return walk.whole() ? static_cast<std::uint8_t>(rule_.cut_faces(*walk.whole())) : listed;
    }

    /// Calls use(place, loop) for each face that is cut of the open cell.
    template <class Use>
    void each_cut(FaceWalk& walk, std::size_t cell, const Use& use) const {
        if (cut_[cell] != listed) {
            for (std::uint32_t cut = cut_[cell]; cut != 0; cut &= cut - 1) {
                const OpenFaces::Place place{cell, static_cast<std::uint32_t>(std::countr_zero(cut))};
                use(place, walk.loop(place));
            }
            return;
        }
        for (std::size_t face = 0; face < walk.face_count(); ++face) {
            const OpenFaces::Place place{cell, static_cast<std::uint32_t>(face)};
            if (const auto loop = walk.loop(place); rule_.cuts(loop)) use(place, loop);
        }
    }

    /// Around a cell and its curved neighbours.
    Box box_of(std::size_t cell) const {
        Box box;
        const std::uint64_t first = cells_.first(cell), end = first + cells_.corners(cell);
        for (std::uint64_t i = first; i < end; ++i) box.add(points_[cells_.corner(i)]);
        box.widen();
        return box;
    }

    template <class Counts>
    static bool has_place_in(const PlaceTree& middles, const Box& box, const Counts& counts) {
        bool found = false;
        middles.each_in(box.lower, box.upper, [&](std::uint32_t at) { found = found || counts(at); });
        return found;
    }

    /// Cells that follow each other have points near each other: places of sums do so, too.
    std::uint64_t& sum_at(std::uint64_t lowest) { return sums_[lowest & (sums_.size() - 1)]; }
    const std::uint64_t& sum_at(std::uint64_t lowest) const { return sums_[lowest & (sums_.size() - 1)]; }

    void add_hashes() {
        std::ranges::fill(sums_, std::uint64_t{0});
        core::parallel_pieces(cells_.count(), cells_per_list, progress_, [&](std::size_t begin, std::size_t end) {
            FaceWalk walk(cells_, faces_);
            for (std::size_t cell = begin; cell < end; ++cell) {
                cut_[cell] = walk.open(cell) ? cut_faces_of(walk) : 0;
                each_cut(walk, cell, [&](const OpenFaces::Place&, std::span<const std::uint64_t> loop) {
                    const FaceHash face = linear::hash_of(loop);
                    std::atomic_ref(sum_at(face.lowest)).fetch_xor(face.hash, std::memory_order_relaxed);
                });
            }
        });
    }

    /// Faces whose sums are not 0.
    std::vector<FoundFace> collect() const {
        using Found = std::vector<FoundFace>;
        return gathered<FoundFace>([&](FaceWalk& walk, std::size_t first, std::size_t last, Found& part) {
            for (std::size_t cell = first; cell < last; ++cell) {
                if (cut_[cell] == 0) continue;
                walk.open(cell);
                each_cut(walk, cell, [&](const OpenFaces::Place& place, std::span<const std::uint64_t> loop) {
                    if (sum_at(std::ranges::min(loop)) != 0) part.push_back({linear::hash_of(loop).hash, place});
                });
            }
        });
    }

    /// What look(walk, first, last, part) adds for ranges of cells, in the order of the cells.
    template <class Item, class Look>
    std::vector<Item> gathered(const Look& look) const {
        std::vector<std::vector<Item>> parts((cells_.count() + cells_per_list - 1) / cells_per_list);
        core::parallel_pieces(parts.size(), 1, progress_, [&](std::size_t first, std::size_t last) {
            FaceWalk walk(cells_, faces_);
            for (std::size_t part = first; part < last; ++part) {
                const std::size_t end = std::min((part + 1) * cells_per_list, cells_.count());
                look(walk, part * cells_per_list, end, parts[part]);
            }
        });
        std::vector<Item> out;
        for (const std::vector<Item>& part : parts) out.insert(out.end(), part.begin(), part.end());
        return out;
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const core::PointReader& points_;
    const CutRule& rule_;
    const Progress& progress_;
    static constexpr std::uint8_t listed = 0xff; ///< cells have at most six faces, others list them
    core::Buffer<std::uint64_t> sums_;           ///< of the hashes of faces, by the low bits of their lowest points
    core::Buffer<std::uint8_t> cut_;             ///< cut_faces_of() each cell; 0 where it has no volume
};

/// Whether one of the places of `middles` is over a face from number `first` on.
bool is_some_over(const OpenFaces& faces, std::size_t first, const PlaceTree& middles, const core::CellReader& cells,
                  const core::PointReader& points) {
    const FaceShapes shapes(faces, cells, points);
    std::atomic<bool> found{false};
    const auto look_at = [&](std::size_t face) {
        Box box;
        for (const std::uint64_t point : faces.loop(face)) box.add(points[point]);
        box.widen();
        middles.each_in(box.lower, box.upper, [&](std::uint32_t other) {
            if (shapes.is_over(face, other) && shapes.distance(face, other) <= near_face)
                found.store(true, std::memory_order_relaxed);
        });
    };
    core::parallel_ranges(faces.size() - first, 1 << 9, [&](std::size_t begin, std::size_t end) {
        for (std::size_t face = begin; face < end && !found.load(std::memory_order_relaxed); ++face)
            look_at(first + face);
    });
    return found;
}

} // namespace

CutRule::CutRule(const Array& values, std::span<const double> isovalues)
    : values_(values), isovalues_(isovalues.begin(), isovalues.end()) {
    if (values.type() == ScalarType::float32) singles_ = values.as<float>().data();
    if (values.type() == ScalarType::float64) doubles_ = values.as<double>().data();
    std::ranges::sort(isovalues_);
}

bool CutRule::cuts(std::span<const std::uint64_t> loop) const {
    constexpr double most = std::numeric_limits<double>::infinity();
    double lowest = most, highest = -most;
    for (const std::uint64_t point : loop) {
        const double value = this->value(point);
        if (std::isnan(value)) return false;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    const auto next = std::ranges::lower_bound(isovalues_, lowest);
    return next != isovalues_.end() && *next <= highest;
}

std::uint32_t CutRule::cut_faces(const core::WholeCell& cell) const {
    constexpr double most = std::numeric_limits<double>::infinity();
    const std::size_t corners = core::corner_count(cell.kind);
    std::array<double, 8> values{};
    double lowest = most, highest = -most;
    std::uint32_t missing = 0;
    for (std::size_t i = 0; i < corners; ++i) {
        values[i] = value(cell.corners[i]);
        if (std::isnan(values[i])) missing |= 1U << i;
        lowest = std::min(lowest, values[i]);
        highest = std::max(highest, values[i]);
    }
    const auto faces = core::shape_of(cell.kind).faces();
    std::uint32_t cut = 0;
    for (auto at = std::ranges::lower_bound(isovalues_, lowest); at != isovalues_.end() && *at <= highest; ++at) {
        std::uint32_t below = 0, above = 0; // those on the isovalue are both
        for (std::size_t i = 0; i < corners; ++i) {
            below |= static_cast<std::uint32_t>(values[i] <= *at) << i;
            above |= static_cast<std::uint32_t>(values[i] >= *at) << i;
        }
        for (std::size_t face = 0; face < faces.size(); ++face) {
            const std::uint32_t bits = faces[face].bits();
            if ((bits & below) != 0 && (bits & above) != 0 && (bits & missing) == 0) cut |= 1U << face;
        }
    }
    return cut;
}

Result<bool> has_smaller_cut_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                   const core::PointReader& points, const CutRule& rule, const Progress& progress) {
    if (auto fits = core::require_memory("looking for hanging points", 8 * CutFaceFinder::slots(cells) + cells.count());
        !fits)
        return fits.error();
    CutFaceFinder finder(cells, faces, points, rule, progress);
    OpenFaces all = finder.alone();
    const std::size_t cut = all.size();
    std::vector<Point> middles(cut);
    for (std::size_t i = 0; i < cut; ++i) middles[i] = middle_of(all.loop(i), points);
    const PlaceTree tree(std::move(middles));
    FaceWalk walk(cells, faces);
    for (const OpenFaces::Place& place : finder.beside(all, tree)) all.add(place, walk.loop(place));
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    return is_some_over(all, cut, tree, cells, points);
}

} // namespace isotet::linear
