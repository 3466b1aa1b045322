// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/polyhedra/shell.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

/// Puts a loop into canonical form.
void make_canonical(std::span<std::uint64_t> loop) {
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    if (loop.back() < loop[1]) std::reverse(loop.begin() + 1, loop.end());
}

} // namespace

/// `point_at`   gives point 0, 1, ... `count` - 1 of a face
void Shell::add_loop(std::uint64_t count, const auto& point_at) {
    const std::size_t begin = unsorted_.size();
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t point = point_at(i);
        if (unsorted_.size() == begin || unsorted_.back() != point) unsorted_.push_back(point);
    }
    while (unsorted_.size() > begin + 1 && unsorted_.back() == unsorted_[begin]) unsorted_.pop_back();
    if (unsorted_.size() < begin + 3) return unsorted_.resize(begin);
    make_canonical({unsorted_.data() + begin, unsorted_.size() - begin});
    unsorted_ends_.push_back(unsorted_.size());
}

void Shell::read_listed(const core::FaceReader& faces, std::size_t cell) {
    std::uint64_t at = faces.begin(cell);
    const std::uint64_t count = at < faces.end(cell) ? faces.at(at++) : 0;
    for (std::uint64_t face = 0; face < count; ++face) {
        const std::uint64_t points = faces.at(at++);
        add_loop(points, [&](std::uint64_t i) { return faces.at(at + i); });
        at += points;
    }
}

void Shell::read_prism(const core::CellReader& cells, std::size_t cell, std::uint64_t sides) {
    const std::uint64_t bottom = cells.first(cell), top = bottom + sides;
    for (const std::uint64_t end : {bottom, top})
        add_loop(sides, [&](std::uint64_t i) { return cells.corner(end + i); });
    for (std::uint64_t side = 0; side < sides; ++side) {
        const std::uint64_t next = (side + 1) % sides;
        const std::array<std::uint64_t, 4> corners{bottom + side, bottom + next, top + next, top + side};
        add_loop(4, [&](std::uint64_t i) { return cells.corner(corners[i]); });
    }
}

void Shell::sort_loops() {
    const auto loop_of = [&](std::uint32_t face) {
        const std::size_t begin = face ? unsorted_ends_[face - 1] : 0;
        return std::span<const std::uint64_t>(unsorted_).subspan(begin, unsorted_ends_[face] - begin);
    };
    order_.resize(unsorted_ends_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::ranges::sort(order_, [&](std::uint32_t a, std::uint32_t b) {
        const auto first = loop_of(a), second = loop_of(b);
        return std::ranges::lexicographical_compare(first, second);
    });
    loops_.clear();
    ends_.clear();
    for (const std::uint32_t face : order_) {
        const auto loop = loop_of(face);
        loops_.insert(loops_.end(), loop.begin(), loop.end());
        ends_.push_back(loops_.size());
    }
    points_ = loops_;
    std::ranges::sort(points_);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
}

/// False unless each edge is in two faces.
bool Shell::find_edges() {
    edges_.clear();
    for (std::uint32_t face = 0; face < face_count(); ++face) {
        const auto points = loop(face);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::uint64_t a = points[i], b = points[(i + 1) % points.size()];
            edges_.push_back({std::min(a, b), std::max(a, b), face, a < b});
        }
    }
    std::ranges::sort(edges_, [](const Edge& a, const Edge& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    if (edges_.size() % 2) return false;
    for (std::size_t i = 0; i < edges_.size(); i += 2) {
        const Edge &a = edges_[i], &b = edges_[i + 1];
        if (a.low != b.low || a.high != b.high || a.face == b.face) return false;
        if (i && edges_[i - 1].low == a.low && edges_[i - 1].high == a.high) return false;
    }
    return true;
}

/// Turns all faces as the first one by flooding over edges. False when they are not connected or contradict each other.
bool Shell::wind() {
    neighbours_.clear();
    for (std::size_t i = 0; i < edges_.size(); i += 2) {
        const Edge &a = edges_[i], &b = edges_[i + 1];
        neighbours_.push_back({a.face, b.face, a.forward == b.forward});
        neighbours_.push_back({b.face, a.face, a.forward == b.forward});
    }
    std::ranges::sort(neighbours_, {}, &Neighbour::face);
    first_neighbour_.assign(face_count() + 1, 0);
    for (const Neighbour& neighbour : neighbours_) ++first_neighbour_[neighbour.face + 1];
    std::partial_sum(first_neighbour_.begin(), first_neighbour_.end(), first_neighbour_.begin());
    inward_.assign(face_count(), 0);
    wound_.assign(face_count(), 0);
    queue_.assign(1, 0);
    wound_[0] = 1;
    for (std::size_t next = 0; next < queue_.size(); ++next) {
        const std::uint32_t face = queue_[next];
        for (std::uint32_t i = first_neighbour_[face]; i < first_neighbour_[face + 1]; ++i) {
            const Neighbour& neighbour = neighbours_[i];
            const std::uint8_t inward = inward_[face] ^ std::uint8_t{neighbour.same_direction};
            if (!wound_[neighbour.other]) {
                wound_[neighbour.other] = 1;
                inward_[neighbour.other] = inward;
                queue_.push_back(neighbour.other);
            } else if (inward_[neighbour.other] != inward) {
                return false;
            }
        }
    }
    return queue_.size() == face_count();
}

/// Of the fans of all faces, over the lowest point.
double Shell::six_volumes(const core::PointReader& points) const {
    const Point origin = points[points_[0]];
    double sum = 0;
    for (std::size_t face = 0; face < face_count(); ++face) {
        const auto corners = loop(face);
        const Point first = minus(points[corners[0]], origin);
        double part = 0;
        for (std::size_t i = 1; i + 1 < corners.size(); ++i)
            part += dot(first, cross(minus(points[corners[i]], origin), minus(points[corners[i + 1]], origin)));
        sum += inward_[face] ? -part : part;
    }
    return sum;
}

bool Shell::read(const core::CellReader& cells, const core::FaceReader& faces, std::size_t cell,
                 const core::PointReader& points) {
    unsorted_.clear();
    unsorted_ends_.clear();
    if (const std::uint64_t sides = core::prism_sides(cells.type(cell))) read_prism(cells, cell, sides);
    else read_listed(faces, cell);
    if (unsorted_ends_.size() < 4) return false;
    sort_loops();
    if (!find_edges() || !wind()) return false;
    if (six_volumes(points) < 0)
        for (std::uint8_t& inward : inward_) inward ^= 1;
    return true;
}

} // namespace isotet::linear
