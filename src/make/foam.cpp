// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "make/foam.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/until_cancelled.hpp"
#include "make/analytic_field.hpp"

namespace isotet::make {

namespace {

using Place = std::array<int, 3>; ///< in quarters of a cube, from the lowest corner

constexpr std::size_t corner_count = 24, face_count = 14;
constexpr std::uint64_t slots_at_once = 1 << 20;         ///< between two looks for a cancel
constexpr std::uint64_t stream_size = 1 + 6 * 5 + 8 * 7; ///< numbers that tell the faces of a cell

/// A truncated octahedron around the origin.
struct Octahedron {
    std::vector<Place> corners;          ///< the permutations of (0, +-1, +-2), ascending
    std::vector<std::vector<int>> faces; ///< corners in order around
};

/// All corners with this product with `normal`, each a neighbour of the one before, counter-clockwise seen from outside.
std::vector<int> face_of(const std::vector<Place>& corners, const Place& normal, int product) {
    std::vector<int> left, face;
    for (int i = 0; i < static_cast<int>(corner_count); ++i)
        if (const Place& at = corners[static_cast<std::size_t>(i)];
            at[0] * normal[0] + at[1] * normal[1] + at[2] * normal[2] == product)
            left.push_back(i);
    const auto adjacent = [&](int a, int b) {
        int sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int along = corners[static_cast<std::size_t>(a)][axis] - corners[static_cast<std::size_t>(b)][axis];
            sum += along * along;
        }
        return sum == 2;
    };
    auto next = left.begin();
    while (next != left.end()) {
        face.push_back(*next);
        left.erase(next);
        next = std::ranges::find_if(left, [&](int corner) { return adjacent(face.back(), corner); });
    }
    const auto edge = [&](std::size_t from, std::size_t axis) {
        return corners[static_cast<std::size_t>(face[from + 1])][axis] -
               corners[static_cast<std::size_t>(face[from])][axis];
    };
    int turn = 0;
    for (std::size_t x = 0; x < 3; ++x) {
        const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
        turn += normal[x] * (edge(0, y) * edge(1, z) - edge(0, z) * edge(1, y));
    }
    if (turn < 0) std::reverse(face.begin(), face.end());
    return face;
}

Octahedron make_octahedron() {
    Octahedron out;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z)
                if (x * x + y * y + z * z == 5 && x * y * z == 0) out.corners.push_back({x, y, z});
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            Place normal{};
            normal[axis] = side;
            out.faces.push_back(face_of(out.corners, normal, 2));
        }
    for (int signs = 0; signs < 8; ++signs)
        out.faces.push_back(face_of(out.corners, {signs & 1 ? 1 : -1, signs & 2 ? 1 : -1, signs & 4 ? 1 : -1}, 3));
    return out;
}

class Foam {
public:
    Foam(const MakeOptions& options, const Progress& progress)
        : options_(options), progress_(progress), side_(options.side), ranks_(12 * boxes() * boxes() * boxes()) {}

    Result<Grid> make() {
        const std::uint64_t fields = options_.fields.size(), points_below = ranks_.size();
        const std::uint64_t bytes =
            points_below * (4 + 12 + 4 * fields) + cells() * (4 * corner_count + 4 * stream_size + 8 + 8 + 1);
        if (auto fits = core::require_memory("making the grid", bytes); !fits) return fits.error();
        number_points();
        Grid grid;
        if (!step(0.2)) return stopped();
        grid.points = points();
        if (!step(0.4)) return stopped();
        fill_cells(grid.cells);
        if (!step(0.8)) return stopped();
        for (const std::string& name : options_.fields) {
            if (progress_.cancelled()) return stopped();
            grid.point_fields.push_back({name, field(name)});
        }
        if (!step(1)) return stopped();
        return grid;
    }

private:
    static Error stopped() { return {ErrorCode::cancelled, "making the grid was cancelled"}; }
    bool step(double done) const {
        progress_("make", done);
        return !progress_.cancelled();
    }

    std::uint64_t boxes() const { return side_ + 1; } ///< of 4 x 4 x 4 places, along an axis
    std::uint64_t cells() const { return 2 * side_ * side_ * side_; }

    Place centre(std::uint64_t cell) const {
        const std::uint64_t cube = cell / 2;
        const int offset = cell % 2 ? 4 : 2;
        return {static_cast<int>(4 * (cube % side_)) + offset, static_cast<int>(4 * (cube / side_ % side_)) + offset,
                static_cast<int>(4 * (cube / (side_ * side_))) + offset};
    }

    /// Each box has twelve places that are corners of the endless foam: 0, 2 and an odd number along the axes.
    std::uint64_t slot(const Place& at) const {
        std::uint64_t two = 0, odd = 0, box = 0;
        int odd_part = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
            const int part = at[axis] & 3;
            if (part == 2) two = axis;
            if (part & 1) {
                odd = axis;
                odd_part = part >> 1;
            }
            box = box * boxes() + static_cast<std::uint64_t>(at[axis] >> 2);
        }
        const std::uint64_t order = 2 * odd + (two > odd ? two - 1 : two); // 0 to 5
        return 12 * box + 2 * order + static_cast<std::uint64_t>(odd_part);
    }
    Place place(std::uint64_t slot) const {
        const std::uint64_t box = slot / 12, order = slot % 12 / 2, odd = order / 2;
        const std::uint64_t two = order % 2 + (order % 2 >= odd ? 1 : 0);
        Place at{static_cast<int>(4 * (box % boxes())), static_cast<int>(4 * (box / boxes() % boxes())),
                 static_cast<int>(4 * (box / (boxes() * boxes())))};
        at[two] += 2;
        at[odd] += 1 + 2 * static_cast<int>(slot & 1);
        return at;
    }

    static Place corner(const Place& centre, const Place& from) {
        return {centre[0] + from[0], centre[1] + from[1], centre[2] + from[2]};
    }

    /// Numbers the corners of cells in the order of their slots.
    void number_points() {
        std::ranges::fill(ranks_, 0U);
        // Cells of two rows may set one slot to the same.
        core::each_until_cancelled(side_ * side_, 1, progress_, [&](std::size_t row) {
            for (std::uint64_t i = 2 * row * side_; i < 2 * (row + 1) * side_; ++i)
                for (const Place& from : octahedron_.corners)
                    std::atomic_ref(ranks_[slot(corner(centre(i), from))]).store(1U, std::memory_order_relaxed);
        });
        std::uint32_t next = 0;
        for (std::uint64_t i = 0; i < ranks_.size(); ++i) {
            if (i % slots_at_once == 0 && progress_.cancelled()) return;
            const bool used = ranks_[i] != 0;
            if (used) slots_.push_back(static_cast<std::uint32_t>(i));
            ranks_[i] = next;
            next += used;
        }
    }

    Position position(std::uint64_t point) const {
        const Place at = place(slots_[point]);
        Position out;
        for (std::size_t axis = 0; axis < 3; ++axis)
            out[axis] = static_cast<float>(at[axis] / (2.0 * static_cast<double>(side_) + 1) - 1);
        return out;
    }

    Array points() {
        core::Buffer<float> out(3 * slots_.size());
        core::each_until_cancelled(slots_.size(), 1 << 13, progress_, [&](std::size_t point) {
            const Position at = position(point);
            std::ranges::copy(at, out.data() + 3 * point);
        });
        return std::move(out).to_array(3);
    }

    void fill_cells(Cells& out) {
        core::Buffer<std::int32_t> connectivity(cells() * corner_count), faces(cells() * stream_size);
        core::Buffer<std::int64_t> offsets(cells() + 1), face_offsets(cells() + 1);
        core::Buffer<std::uint8_t> types(cells());
        constexpr std::uint8_t polyhedron = 42;
        core::each_until_cancelled(cells(), 1 << 10, progress_, [&](std::size_t cell) {
            std::int32_t* numbers = connectivity.data() + cell * corner_count;
            for (std::size_t i = 0; i < corner_count; ++i)
                numbers[i] = static_cast<std::int32_t>(ranks_[slot(corner(centre(cell), octahedron_.corners[i]))]);
            std::int32_t* stream = faces.data() + cell * stream_size;
            *stream++ = face_count;
            for (const std::vector<int>& face : octahedron_.faces) {
                *stream++ = static_cast<std::int32_t>(face.size());
                for (const int i : face) *stream++ = numbers[i];
            }
            offsets[cell] = static_cast<std::int64_t>(cell * corner_count);
            face_offsets[cell] = static_cast<std::int64_t>(cell * stream_size);
            types[cell] = polyhedron;
        });
        offsets[cells()] = static_cast<std::int64_t>(cells() * corner_count);
        face_offsets[cells()] = static_cast<std::int64_t>(cells() * stream_size);
        out.connectivity = std::move(connectivity).to_array();
        out.offsets = std::move(offsets).to_array();
        out.types = std::move(types).to_array();
        out.faces = std::move(faces).to_array();
        out.face_offsets = std::move(face_offsets).to_array();
    }

    Array field(std::string_view name) const {
        const auto at = std::ranges::find(analytic_fields, name, &AnalyticField::name)->at;
        if (at) return values<float>([&](std::uint64_t point) { return at(position(point)); });
        return values<std::int32_t>([&](std::uint64_t point) { return small_integer(options_.seed, point); });
    }

    template <class Value, class At>
    Array values(const At& at) const {
        core::Buffer<Value> all(slots_.size());
        core::each_until_cancelled(slots_.size(), 1 << 13, progress_,
                                   [&](std::size_t point) { all[point] = at(point); });
        return std::move(all).to_array();
    }

    const MakeOptions& options_;
    const Progress& progress_;
    std::uint64_t side_;
    const Octahedron octahedron_ = make_octahedron();
    core::Buffer<std::uint32_t> ranks_; ///< of slots: the number of the point
    std::vector<std::uint32_t> slots_;  ///< of points
};

} // namespace

Result<Grid> make_foam(const MakeOptions& options, const Progress& progress) { return Foam(options, progress).make(); }

} // namespace isotet::make
