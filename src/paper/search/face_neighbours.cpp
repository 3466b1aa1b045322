// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/search/face_neighbours.hpp"

#include <algorithm>
#include <atomic>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"

namespace isotet::search {

namespace {

/// A tet's face, among the faces of the same lowest point.
struct Face {
    std::uint32_t second, third, tet;

    bool is_face_of_same_corners(const Face& other) const { return second == other.second && third == other.third; }
    friend bool operator<(const Face& a, const Face& b) {
        return std::tie(a.second, a.third, a.tet) < std::tie(b.second, b.third, b.tet);
    }
};

/// Calls f(lowest point, face) for the four faces of a tet.
template <class F>
void for_faces(const core::TetTable& table, std::uint32_t tet, const F& f) {
    std::array<std::uint32_t, 4> v = table.tets[tet];
    std::sort(v.begin(), v.end());
    f(v[0], Face{v[1], v[2], tet});
    f(v[0], Face{v[1], v[3], tet});
    f(v[0], Face{v[2], v[3], tet});
    f(v[1], Face{v[2], v[3], tet});
}

std::uint64_t count_up(std::uint64_t& counter) {
    return std::atomic_ref<std::uint64_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

/// Which corner of a tet is not on a face.
std::size_t corner_beside(const std::array<std::uint32_t, 4>& tet, std::uint32_t lowest, const Face& face) {
    std::size_t k = 0;
    while (tet[k] == lowest || tet[k] == face.second || tet[k] == face.third) ++k;
    return k;
}

} // namespace

FaceNeighbours::FaceNeighbours(const core::TetTable& table) : neighbours_(table.tets.size()) {
    constexpr std::size_t grain = 1 << 14;
    const std::size_t tets = table.tets.size(), points = table.points.size();
    // Faces by their lowest point: counted, then each put where the next one goes. next[p] is then where those of p
    // end.
    core::Buffer<std::uint64_t> next(points + 1);
    std::fill(next.begin(), next.end(), 0);
    const auto for_all_faces = [&](const auto& f) {
        core::parallel_each(tets, grain, [&](std::size_t tet) {
            const auto number = static_cast<std::uint32_t>(tet);
            if (!table.range(number).is_empty()) for_faces(table, number, f);
        });
    };
    core::parallel_each(tets, grain, [&](std::size_t tet) { neighbours_[tet].fill(none); });
    for_all_faces([&](std::uint32_t lowest, const Face&) { count_up(next[lowest]); });
    std::uint64_t sum = 0;
    for (std::uint64_t& count : next) sum += std::exchange(count, sum);
    core::Buffer<Face> faces(sum);
    for_all_faces([&](std::uint32_t lowest, const Face& face) { faces[count_up(next[lowest])] = face; });

    core::parallel_each(points, 1 << 12, [&](std::size_t p) {
        Face *face = faces.data() + (p ? next[p - 1] : 0), *const end = faces.data() + next[p];
        std::sort(face, end);
        for (; face + 1 < end; ++face) {
            if (!face[0].is_face_of_same_corners(face[1])) continue;
            const auto lowest = static_cast<std::uint32_t>(p);
            neighbours_[face[0].tet][corner_beside(table.tets[face[0].tet], lowest, face[0])] = face[1].tet;
            neighbours_[face[1].tet][corner_beside(table.tets[face[1].tet], lowest, face[1])] = face[0].tet;
            ++face;
        }
    });
}

} // namespace isotet::search
