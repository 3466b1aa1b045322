// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A surface that ends or goes on at a larger cell's face cuts one of the smaller faces on it, which one active cell has: all
// cells with a cut face are active. So only larger faces at these are looked for, among all cells.
#include <isotet/active_cells.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/fresh_memory.hpp"
#include "grid/cell_faces.hpp"
#include "grid/fixed_corners.hpp"
#include "linear/checked_cells.hpp"
#include "linear/hanging/cut_faces.hpp"
#include "linear/hanging/face_shapes.hpp"
#include "linear/hanging/face_walk.hpp"
#include "linear/hanging/near_places.hpp"
#include "linear/hanging/outer_planes.hpp"

namespace isotet {

namespace linear {

namespace {

constexpr std::size_t cells_together = 16; // those that follow each other are mostly near each other, and far from all
/// Of a cell's diagonal: what a face that lies on it may be beside it with a corner.
constexpr double corners_beside = 2 * beside_face;

/// The faces of a cell of a contoured type; points that repeat the one before are dropped, and loops of fewer than three.
class LoopsOfCell {
public:
    explicit LoopsOfCell(const core::WholeCell& cell) {
        for (const core::CellFace& face : core::shape_of(cell.kind).faces()) {
            std::array<std::uint64_t, 4>& loop = loops_[count_];
            std::uint8_t& size = sizes_[count_];
            size = 0;
            for (std::size_t i = 0; i < face.count; ++i)
                if (const std::uint64_t point = cell.corners[face.corners[i]]; size == 0 || loop[size - 1] != point)
                    loop[size++] = point;
            while (size > 1 && loop[size - 1] == loop[0]) --size;
            count_ += size >= 3;
        }
    }

    std::size_t count() const { return count_; }
    std::span<const std::uint64_t> operator[](std::size_t face) const { return {loops_[face].data(), sizes_[face]}; }

private:
    std::array<std::array<std::uint64_t, 4>, 7> loops_;
    std::array<std::uint8_t, 7> sizes_;
    std::size_t count_ = 0;
};

/// The box of some points. Point 0 stands for those that are not there.
template <class Real, class Index>
Box box_of(const Real* places, std::size_t points, std::span<const Index> corners) {
    constexpr Real most = std::numeric_limits<Real>::max();
    std::array<std::array<Real, 3>, 2> lower{{{most, most, most}, {most, most, most}}}, upper = lower; // in turn
    for (auto& part : upper)
        for (Real& x : part) x = -most;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint64_t point = core::widened(corners[i]);
        const Real* const at = places + 3 * (point < points ? point : 0);
        std::array<Real, 3>& low = lower[i % 2];
        std::array<Real, 3>& high = upper[i % 2];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
            high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
        }
    }
    Box out;
    for (const auto& part : lower) out.add({part[0], part[1], part[2]});
    for (const auto& part : upper) out.add({part[0], part[1], part[2]});
    return out;
}

/// The faces of cells near places, to be counted.
struct SeenFace {
    std::uint64_t face, cell; ///< hashes
};

} // namespace
} // namespace linear

struct CellsAround::Data {
    Array points;
    core::PointReader reader;
    linear::OpenFaces faces; ///< cut ones that one active cell has
    std::optional<linear::FaceShapes> shapes;
    std::vector<linear::Box> boxes;
    std::vector<std::uint64_t> hashes;
    std::optional<linear::NearPlaces> middles; ///< of the faces; nothing where no larger one can be

    std::atomic<bool> out_of_memory{false};
    std::mutex mutex;
    std::vector<linear::SeenFace> seen; ///< under the mutex
    std::vector<std::uint64_t> larger;  ///< hashes of faces on which others lie, under the mutex

    /// What one call finds.
    struct Found {
        std::vector<linear::SeenFace> seen;
        std::vector<std::uint64_t> larger;
        std::vector<std::uint32_t> near; ///< those of the last cell
    };

    void look_at(const core::WholeCell& cell, const linear::Box& box, Found& found) const;

    template <class Real, class Index>
    void look_at_all(std::span<const std::uint8_t> types, const Real* places, std::span<const Index> corners,
                     Found& found) const;
};

/// A cell near faces: which of its faces are larger ones that these lie on.
void CellsAround::Data::look_at(const core::WholeCell& cell, const linear::Box& box, Found& found) const {
    found.near.clear();
    const linear::Box with_corners = box.wider(linear::corners_beside);
    middles->each_in(box.wider(linear::beside_face), [&](std::uint32_t face) {
        if (with_corners.holds(boxes[face])) found.near.push_back(face);
    });
    if (found.near.empty()) return;
    const linear::LoopsOfCell loops(cell);
    const std::size_t count = core::corner_count(cell.kind);
    core::Point inside{};
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const core::Point at = reader[cell.corners[i]];
        for (std::size_t axis = 0; axis < 3; ++axis) inside[axis] += at[axis] / static_cast<double>(count);
        hash += linear::scattered(cell.corners[i]);
    }
    const std::size_t first = found.seen.size();
    for (std::size_t i = 0; i < loops.count(); ++i)
        found.seen.push_back({linear::hash_of(loops[i]).hash, linear::scattered(hash)});
    const auto has = [&](std::uint64_t face) {
        return std::ranges::any_of(found.seen.begin() + static_cast<std::ptrdiff_t>(first), found.seen.end(),
                                   [&](const linear::SeenFace& own) { return own.face == face; });
    };
    std::erase_if(found.near, [&](std::uint32_t face) { return has(hashes[face]); });
    for (std::size_t i = 0; i < loops.count() && !found.near.empty(); ++i) {
        const auto loop = loops[i];
        const linear::FaceShape shape = linear::shape_of(loop, inside, reader);
        linear::Box around;
        for (const std::uint64_t point : loop) around.add(reader[point]);
        around = around.wider(linear::corners_beside);
        // So the cell on the other side of the larger face, if there is one, is near the smaller one, too.
        const bool lies = std::ranges::any_of(found.near, [&](std::uint32_t face) {
            const linear::FaceShape& small = (*shapes)[face];
            return linear::is_over(shape, loop, small, reader) && around.holds(boxes[face]) &&
                   linear::distance(shape, loop, small, reader) <= linear::beside_face;
        });
        if (lies) found.larger.push_back(found.seen[first + i].face);
    }
}

template <class Real, class Index>
void CellsAround::Data::look_at_all(std::span<const std::uint8_t> types, const Real* places,
                                    std::span<const Index> corners, Found& found) const {
    const std::size_t points_there = points.tuples();
    const auto may_be_near = [&](std::span<const Index> of, linear::Box& box) {
        box = linear::box_of(places, points_there, of);
        return middles->may_have_some_in(box.wider(linear::beside_face));
    };
    while (!types.empty()) {
        const auto together = types.first(std::min(linear::cells_together, types.size()));
        types = types.subspan(together.size());
        std::size_t count = 0;
        for (const std::uint8_t type : together) count += core::fixed_corners_of(type);
        if (count > corners.size()) return;
        std::span<const Index> theirs = corners.first(count);
        corners = corners.subspan(count);
        linear::Box box;
        if (!may_be_near(theirs, box)) continue;
        for (const std::uint8_t type : together) {
            const std::span<const Index> own = theirs.first(core::fixed_corners_of(type));
            theirs = theirs.subspan(own.size());
            if (!core::is_contoured(type) || !may_be_near(own, box)) continue;
            core::WholeCell cell{*core::kind_of(type), {}};
            std::ranges::transform(own, cell.corners.begin(), [](Index corner) { return core::widened(corner); });
            if (std::ranges::any_of(std::span(cell.corners).first(own.size()),
                                    [&](std::uint64_t point) { return point >= points_there; }))
                continue;
            core::order_as_kind(type, cell.corners);
            look_at(cell, box, found);
        }
    }
}

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
        auto faces =
            linear::find_lone_cut_faces(all->cells, all->faces, linear::CutRule(field.values, isovalues), progress);
        if (!faces) return faces.error();
        auto data = std::make_unique<Data>();
        if (faces->size() == 0) return CellsAround(std::move(data));
        data->points = active.points;
        data->reader = core::PointReader(data->points);
        data->faces = *std::move(faces);
        data->shapes.emplace(data->faces, all->cells, data->reader);
        if (linear::are_outermost(data->faces, *data->shapes, data->points)) return CellsAround(std::move(data));
        std::vector<core::Point> middles;
        for (std::size_t face = 0; face < data->faces.size(); ++face) {
            const auto loop = data->faces.loop(face);
            linear::Box& box = data->boxes.emplace_back();
            for (const std::uint64_t point : loop) box.add(data->reader[point]);
            data->hashes.push_back(linear::hash_of(loop).hash);
            middles.push_back(data->shapes->middle(face));
        }
        data->middles.emplace(middles);
        return CellsAround(std::move(data));
    });
}

bool CellsAround::are_needed() const { return data_ && data_->middles; }

void CellsAround::add(std::span<const std::uint8_t> types, const Array& corners) {
    if (!are_needed()) return;
    try {
        Data::Found found;
        corners.visit([&]<class Index>(std::span<const Index> all) {
            if constexpr (std::is_integral_v<Index> && sizeof(Index) >= 4) {
                if (data_->points.type() == ScalarType::float32)
                    data_->look_at_all(types, data_->points.as<float>().data(), all, found);
                else data_->look_at_all(types, data_->points.as<double>().data(), all, found);
            }
        });
        if (found.seen.empty()) return;
        const std::lock_guard lock(data_->mutex);
        data_->seen.insert(data_->seen.end(), found.seen.begin(), found.seen.end());
        data_->larger.insert(data_->larger.end(), found.larger.begin(), found.larger.end());
    } catch (const std::bad_alloc&) {
        data_->out_of_memory = true;
    }
}

Result<bool> CellsAround::may_have_hanging_points(const Run& run) {
    return core::carry_out("looking for hanging points", run, [&](const Progress& progress) -> Result<bool> {
        if (!data_) return moved_from("the cells around active ones");
        if (data_->out_of_memory) return core::ran_out_of_memory("looking for hanging points");
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
        // A larger face that two cells have is none that smaller ones cover: flat cells at bent boundaries have such.
        if (data_->larger.empty()) return false;
        std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> cells_of;
        for (const std::uint64_t face : data_->larger) cells_of.try_emplace(face);
        for (const linear::SeenFace& seen : data_->seen)
            if (const auto at = cells_of.find(seen.face); at != cells_of.end()) {
                auto& cells = at->second; // pieces may have the same cell
                if (std::ranges::find(cells, seen.cell) == cells.end()) cells.push_back(seen.cell);
            }
        return std::ranges::any_of(cells_of, [](const auto& face) { return face.second.size() % 2 == 1; });
    });
}

} // namespace isotet
