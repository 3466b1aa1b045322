// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/cut_faces.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "linear/hanging/lone_faces.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t cells_per_list = 1 << 12;
constexpr double stored_rounding = 0x1p-22; // of a value: what may be stored as another

/// What is above an isovalue may be this.
double least_above(double isovalue, double value) {
    if (std::isinf(value)) return isovalue; // there is no data
    return isovalue - stored_rounding * std::max(std::abs(isovalue), std::abs(value));
}

class CutFaceFinder {
public:
    CutFaceFinder(const core::CellReader& cells, const core::FaceReader& faces, const CutRule& rule,
                  const Progress& progress)
        : cells_(cells), faces_(faces), rule_(rule), progress_(progress), sums_(slots(cells)), cut_(cells.count()) {}

    /// Of the sums of hashes.
    static std::size_t slots(const core::CellReader& cells) { return std::bit_ceil(cells.count() + 1); }

    /// Those that one cell has.
    Result<OpenFaces> alone() {
        add_hashes();
        const auto look = [&](FaceWalk& walk, std::size_t begin, std::size_t end, std::vector<FoundFace>& found) {
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (cut_[cell] == 0) continue;
                walk.open(cell);
                each_cut(walk, cell, [&](const OpenFaces::Place& place, std::span<const std::uint64_t> loop) {
                    if (sum_at(std::ranges::min(loop)) != 0) found.push_back({linear::hash_of(loop).hash, place});
                });
            }
        };
        const auto found = lone_faces(cells_, faces_, look, progress_);
        if (!found) return found.error();
        return with_loops(*found, cells_, faces_);
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

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const CutRule& rule_;
    const Progress& progress_;
    static constexpr std::uint8_t listed = 0xff; ///< cells have at most six faces, others list them
    core::Buffer<std::uint64_t> sums_;           ///< of the hashes of faces, by the low bits of their lowest points
    core::Buffer<std::uint8_t> cut_;             ///< cut_faces_of() each cell; 0 where it has no volume
};

} // namespace

CutRule::CutRule(const Array& values, std::span<const double> isovalues)
    : values_(values), isovalues_(isovalues.begin(), isovalues.end()) {
    if (values.type() == ScalarType::float32) {
        singles_ = values.as<float>().data();
        for (double& isovalue : isovalues_) isovalue = static_cast<float>(isovalue);
    }
    if (values.type() == ScalarType::float64) doubles_ = values.as<double>().data();
    std::ranges::sort(isovalues_);
}

bool CutRule::cuts(std::span<const std::uint64_t> loop) const {
    constexpr double most = std::numeric_limits<double>::infinity();
    double lowest = most, highest = -most;
    for (const std::uint64_t point : loop) {
        const double value = this->value(point);
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    const auto next = std::ranges::upper_bound(isovalues_, lowest);
    return next != isovalues_.end() && highest >= least_above(*next, highest);
}

std::uint32_t CutRule::cut_faces(const core::WholeCell& cell) const {
    constexpr double most = std::numeric_limits<double>::infinity();
    const std::size_t corners = core::corner_count(cell.kind);
    std::array<double, 8> values{};
    double lowest = most, highest = -most;
    for (std::size_t i = 0; i < corners; ++i) {
        values[i] = value(cell.corners[i]);
        lowest = std::min(lowest, values[i]);
        highest = std::max(highest, values[i]);
    }
    const auto faces = core::shape_of(cell.kind).faces();
    std::uint32_t cut = 0;
    const auto end = isovalues_.end();
    for (auto at = std::ranges::upper_bound(isovalues_, lowest); at != end && highest >= least_above(*at, highest);
         ++at) {
        std::uint32_t below = 0, above = 0; // those that may be rounded onto the isovalue are both
        for (std::size_t i = 0; i < corners; ++i) {
            below |= static_cast<std::uint32_t>(values[i] < *at) << i;
            above |= static_cast<std::uint32_t>(values[i] >= least_above(*at, values[i])) << i;
        }
        for (std::size_t face = 0; face < faces.size(); ++face) {
            const std::uint32_t bits = faces[face].bits();
            if ((bits & below) != 0 && (bits & above) != 0) cut |= 1U << face;
        }
    }
    return cut;
}

Result<OpenFaces> find_lone_cut_faces(const core::CellReader& cells, const core::FaceReader& faces, const CutRule& rule,
                                      const Progress& progress) {
    if (auto fits = core::require_memory("looking for hanging points", 8 * CutFaceFinder::slots(cells) + cells.count());
        !fits)
        return fits.error();
    return CutFaceFinder(cells, faces, rule, progress).alone();
}

} // namespace isotet::linear
