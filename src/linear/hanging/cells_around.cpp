// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A cover has a face at every corner of what it covers. Around the points at which cut cells end all cells are known, so
// faces there without a neighbour are those of the whole grid. A larger cell that is not cut, but some of whose hanging
// points are on the other side, may have no such point: it is found by the places of cut faces without a neighbour.
#include <isotet/linear_cells.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <mutex>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/fixed_corners.hpp"
#include "linear/hanging/checked_cells.hpp"
#include "linear/hanging/cut_rule.hpp"
#include "linear/hanging/face_shapes.hpp"
#include "linear/hanging/face_walk.hpp"
#include "linear/hanging/near_places.hpp"
#include "linear/hanging/open_faces.hpp"

namespace isotet {

namespace linear {

namespace {

constexpr std::size_t cells_per_list = 1 << 12;

/// Faces that one cell has, of some of the faces of a grid. As find_open_faces(), but with memory by cells.
class LoneFaceFinder {
public:
    LoneFaceFinder(const core::CellReader& cells, const core::FaceReader& faces, const Progress& progress)
        : cells_(cells), faces_(faces), progress_(progress), sums_(slots(cells)) {}

    static std::uint64_t bytes(const core::CellReader& cells) { return 8 * slots(cells); }

    /// `wanted`   a cell and a loop: whether the face counts
    template <class Wanted>
    OpenFaces find(const Wanted& wanted) {
        std::ranges::fill(sums_, std::uint64_t{0});
        core::parallel_pieces(cells_.count(), cells_per_list, progress_, [&](std::size_t begin, std::size_t end) {
            FaceWalk walk(cells_, faces_);
            for (std::size_t cell = begin; cell < end; ++cell)
                each_hash(walk, cell, wanted, [&](std::size_t, const FaceHash& face) {
                    std::atomic_ref(sum_at(face.lowest)).fetch_xor(face.hash, std::memory_order_relaxed);
                });
        });
        OpenFaces out;
        FaceWalk walk(cells_, faces_);
        for (const FoundFace& face : alone_of(collect(wanted))) out.add(face.place, walk.loop(face.place));
        return out;
    }

private:
    static std::size_t slots(const core::CellReader& cells) { return std::bit_ceil(cells.count() + 1); }

    /// Cells that follow each other have points near each other: places of sums do so, too.
    std::uint64_t& sum_at(std::uint64_t lowest) { return sums_[lowest & (sums_.size() - 1)]; }

    template <class Wanted, class Use>
    static void each_hash(FaceWalk& walk, std::size_t cell, const Wanted& wanted, const Use& use) {
        walk.each_hash(cell, [&](std::size_t face, const FaceHash& hash) {
            if (wanted(cell, walk.loop({cell, static_cast<std::uint32_t>(face)}))) use(face, hash);
        });
    }

    /// Faces whose sums are not 0, by cells.
    template <class Wanted>
    std::vector<FoundFace> collect(const Wanted& wanted) {
        std::vector<std::vector<FoundFace>> parts((cells_.count() + cells_per_list - 1) / cells_per_list);
        core::parallel_pieces(parts.size(), 1, progress_, [&](std::size_t first, std::size_t last) {
            FaceWalk walk(cells_, faces_);
            for (std::size_t part = first; part < last; ++part) {
                const std::size_t end = std::min((part + 1) * cells_per_list, cells_.count());
                for (std::size_t cell = part * cells_per_list; cell < end; ++cell)
                    each_hash(walk, cell, wanted, [&](std::size_t face, const FaceHash& hash) {
                        if (sum_at(hash.lowest) != 0)
                            parts[part].push_back({hash.hash, {cell, static_cast<std::uint32_t>(face)}});
                    });
            }
        });
        std::vector<FoundFace> out;
        for (const std::vector<FoundFace>& part : parts) out.insert(out.end(), part.begin(), part.end());
        return out;
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const Progress& progress_;
    core::Buffer<std::uint64_t> sums_; ///< of the hashes of faces, by the low bits of their lowest points
};

template <class Wanted>
Result<OpenFaces> lone_faces(const CheckedCells& all, const Wanted& wanted, const Progress& progress) {
    if (auto fits = core::require_memory("looking for hanging points", LoneFaceFinder::bytes(all.cells)); !fits)
        return fits.error();
    OpenFaces found = LoneFaceFinder(all.cells, all.faces, progress).find(wanted);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    return found;
}

/// Whether a face lies on a larger one with which it has a marked point.
bool has_smaller_face(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points,
                      const std::vector<std::uint8_t>& marked) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> at_points;
    for (std::size_t face = 0; face < faces.size(); ++face)
        for (const std::uint64_t point : faces.loop(face))
            if (marked[point] != 0) at_points.emplace_back(point, static_cast<std::uint32_t>(face));
    std::ranges::sort(at_points);
    const FaceShapes shapes(faces, cells, points);
    for (std::size_t begin = 0, end = 0; begin < at_points.size(); begin = end) {
        while (end < at_points.size() && at_points[end].first == at_points[begin].first) ++end;
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t j = begin; j < end; ++j) {
                const std::uint32_t face = at_points[i].second, other = at_points[j].second;
                if (shapes.is_over(face, other) && shapes.distance(face, other) <= beside_face) return true;
            }
    }
    return false;
}

/// Whether a cut one of the faces lies on a larger face of a cell without marked points.
bool lies_on_face_of_others(const OpenFaces& faces, const CheckedCells& all, const core::PointReader& points,
                            const std::vector<std::uint8_t>& cut, const std::vector<std::uint8_t>& marked) {
    OpenFaces both;
    std::vector<Point> middles;
    for (std::size_t face = 0; face < faces.size(); ++face) {
        const auto is_cut = [&](std::uint64_t point) { return cut[point] != 0; };
        if (!std::ranges::all_of(faces.loop(face), is_cut)) continue;
        both.add(faces.place(face), faces.loop(face));
        middles.push_back(middle_of(faces.loop(face), points));
    }
    const std::size_t count = both.size();
    if (count == 0) return false;
    const PlaceTree tree(std::move(middles));
    FaceWalk walk(all.cells, all.faces);
    for (std::size_t cell = 0; cell < all.cells.count(); ++cell) {
        const std::uint64_t first = all.cells.first(cell), end = first + all.cells.corners(cell);
        bool is_other = true;
        for (std::uint64_t i = first; i < end && is_other; ++i) is_other = marked[all.cells.corner(i)] == 0;
        if (!is_other || !walk.open(cell)) continue;
        for (std::size_t face = 0; face < walk.face_count(); ++face) {
            const OpenFaces::Place place{cell, static_cast<std::uint32_t>(face)};
            both.add(place, walk.loop(place));
        }
    }
    const FaceShapes shapes(both, all.cells, points);
    for (std::size_t face = count; face < both.size(); ++face) {
        Box box;
        for (const std::uint64_t point : both.loop(face)) box.add(points[point]);
        box.widen();
        bool found = false;
        tree.each_in(box.lower, box.upper, [&](std::uint32_t other) {
            found = found || (shapes.is_over(face, other) && shapes.distance(face, other) <= beside_face);
        });
        if (found) return true;
    }
    return false;
}

/// By cell.
std::vector<std::uint8_t> cut_cells(const core::CellReader& cells, const CutRule& rule) {
    std::vector<std::uint8_t> is_cut(cells.count());
    core::parallel_ranges(cells.count(), cells_per_list, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> corners;
        for (std::size_t cell = begin; cell < end; ++cell) {
            corners.clear();
            const std::uint64_t first = cells.first(cell), last = first + cells.corners(cell);
            for (std::uint64_t i = first; i < last; ++i) corners.push_back(cells.corner(i));
            is_cut[cell] = rule.cuts(corners);
        }
    });
    return is_cut;
}

/// All points of the loop have the lowest or the highest of all coordinates: nothing is beyond it.
bool is_on(const Box& box, std::span<const std::uint64_t> loop, const core::PointReader& points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = points[loop[0]][axis];
        if (x != box.lower[axis] && x != box.upper[axis]) continue;
        if (std::ranges::all_of(loop, [&](std::uint64_t point) { return points[point][axis] == x; })) return true;
    }
    return false;
}

Box box_of(const core::PointReader& points, std::size_t count) {
    Box all;
    std::mutex mutex;
    core::parallel_ranges(count, 1 << 16, [&](std::size_t begin, std::size_t end) {
        Box part;
        for (std::size_t i = begin; i < end; ++i) part.add(points[i]);
        const std::lock_guard lock(mutex);
        all.add(part.lower);
        all.add(part.upper);
    });
    return all;
}

} // namespace
} // namespace linear

struct CellsAround::Data {
    Array points;
    core::PointReader reader;
    std::vector<std::uint8_t> marked;          ///< by point: 1 for one of a face that one cut cell has
    std::vector<std::uint8_t> cut;             ///< 1 for one of such a face that is cut, and not at the outside
    std::optional<linear::NearPlaces> middles; ///< of these
    bool ends = false;                         ///< some points are marked
    std::mutex mutex;
    std::vector<std::uint8_t> types; ///< of the cells around them, under the mutex
    std::vector<std::int64_t> connectivity, offsets{0};
    std::atomic<bool> out_of_memory{false};

    template <class Index>
    bool is_near(const Index* corners, std::size_t count) const {
        linear::Box box;
        for (std::size_t i = 0; i < count; ++i) box.add(reader[static_cast<std::uint64_t>(corners[i])]);
        box.widen();
        return middles->has_some_in(box);
    }

    template <class Index>
    void add(std::span<const std::uint8_t> all, const Index* corners, std::size_t count) {
        std::vector<std::uint8_t> found;
        std::vector<std::int64_t> of_found;
        for (const std::uint8_t type : all) {
            const std::size_t own = core::fixed_corners_of(type);
            if (own > count) return;
            unsigned any = 0;
            bool sound = true;
            for (std::size_t i = 0; i < own; ++i) {
                const auto point = static_cast<std::uint64_t>(corners[i]);
                sound &= point < marked.size();
                any |= point < marked.size() ? marked[point] : 0U;
            }
            if (sound && core::is_contoured(type) && (any != 0 || (middles && is_near(corners, own)))) {
                found.push_back(type);
                for (std::size_t i = 0; i < own; ++i) of_found.push_back(static_cast<std::int64_t>(corners[i]));
            }
            corners += own;
            count -= own;
        }
        const std::lock_guard lock(mutex);
        types.insert(types.end(), found.begin(), found.end());
        connectivity.insert(connectivity.end(), of_found.begin(), of_found.end());
        for (const std::uint8_t type : found)
            offsets.push_back(offsets.back() + static_cast<std::int64_t>(core::fixed_corners_of(type)));
    }
};

CellsAround::CellsAround(std::unique_ptr<Data> data) : data_(std::move(data)) {}
CellsAround::CellsAround(CellsAround&&) noexcept = default;
CellsAround& CellsAround::operator=(CellsAround&&) noexcept = default;
CellsAround::~CellsAround() = default;

Result<CellsAround> CellsAround::of(const Grid& active, const PointField& field, std::span<const double> isovalues,
                                    const Run& run) {
    return core::carry_out("looking for hanging points", run, [&](const Progress& progress) -> Result<CellsAround> {
        const std::size_t points = active.points.tuples();
        if (field.values.tuples() != points || field.values.components() != 1)
            return invalid_argument(fmt::format("the field has {} values of {} components, but the grid has {} points",
                                                field.values.tuples(), field.values.components(), points));
        const auto all = linear::checked_cells(active, progress);
        if (!all) return all.error();
        const linear::CutRule rule(field.values, isovalues);
        const std::vector<std::uint8_t> is_cut = linear::cut_cells(all->cells, rule);
        const auto faces = linear::lone_faces(
            *all, [&](std::size_t cell, std::span<const std::uint64_t>) { return is_cut[cell] != 0; }, progress);
        if (!faces) return faces.error();
        if (auto fits = core::require_memory("looking for hanging points", 2 * points); !fits) return fits.error();
        auto data = std::make_unique<Data>();
        data->points = active.points;
        data->reader = core::PointReader(data->points);
        data->marked.assign(points, 0);
        data->cut.assign(points, 0);
        data->ends = faces->size() > 0;
        std::optional<linear::Box> box;
        std::vector<core::Point> middles;
        for (std::size_t i = 0; i < faces->size(); ++i) {
            const auto loop = faces->loop(i);
            for (const std::uint64_t point : loop) data->marked[point] = 1;
            if (!rule.cuts(loop)) continue;
            if (!box) box = linear::box_of(data->reader, points);
            if (linear::is_on(*box, loop, data->reader)) continue;
            for (const std::uint64_t point : loop) data->cut[point] = 1;
            middles.push_back(linear::middle_of(loop, data->reader));
        }
        if (!middles.empty()) data->middles.emplace(middles);
        return CellsAround(std::move(data));
    });
}

bool CellsAround::are_needed() const { return data_ && data_->ends; }

void CellsAround::add(std::span<const std::uint8_t> types, const Array& corners) {
    if (!data_) return;
    try {
        corners.visit([&]<class Index>(std::span<const Index> all) {
            if constexpr (std::is_integral_v<Index>) data_->add(types, all.data(), all.size());
        });
    } catch (const std::bad_alloc&) {
        data_->out_of_memory = true;
    }
}

Result<bool> CellsAround::may_have_hanging_points(const Run& run) {
    return core::carry_out("looking for hanging points", run, [&](const Progress& progress) -> Result<bool> {
        if (!data_) return moved_from("the cells around active ones");
        if (data_->out_of_memory)
            return Error{ErrorCode::out_of_memory, "looking for hanging points ran out of memory"};
        if (data_->types.empty()) return false;
        Grid around;
        around.points = data_->points;
        around.cells.types = Array::own(std::exchange(data_->types, {}));
        around.cells.offsets = Array::own(std::exchange(data_->offsets, {0}));
        around.cells.connectivity = Array::own(std::exchange(data_->connectivity, {}));
        const auto all = linear::checked_cells(around, progress);
        if (!all) return all.error();
        const auto is_marked = [&](std::uint64_t point) { return data_->marked[point] != 0; };
        const auto faces = linear::lone_faces(
            *all,
            [&](std::size_t, std::span<const std::uint64_t> loop) { return std::ranges::any_of(loop, is_marked); },
            progress);
        if (!faces) return faces.error();
        return linear::has_smaller_face(*faces, all->cells, data_->reader, data_->marked) ||
               (data_->middles &&
                linear::lies_on_face_of_others(*faces, *all, data_->reader, data_->cut, data_->marked));
    });
}

} // namespace isotet
