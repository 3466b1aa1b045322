// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/open_faces.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <mutex>
#include <utility>

#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"
#include "linear/hanging/cell_loops.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t cells_per_look = 1 << 13;

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014).
constexpr std::uint64_t scattered(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// A face's lowest point, and a hash of all, whatever their order.
struct FaceHash {
    std::uint64_t lowest, hash;
};

FaceHash hash_of(std::span<const std::uint64_t> loop) {
    FaceHash out{std::numeric_limits<std::uint64_t>::max(), 0};
    for (const std::uint64_t point : loop) {
        out.lowest = std::min(out.lowest, point);
        out.hash += scattered(point);
    }
    out.hash = scattered(out.hash);
    return out;
}

FaceHash hash_of(const core::WholeCell& cell, const core::CellFace& face,
                 const std::array<std::uint64_t, 8>& of_corners) {
    FaceHash out{std::numeric_limits<std::uint64_t>::max(), 0};
    for (const std::uint8_t corner : face.all()) {
        out.lowest = std::min(out.lowest, cell.corners[corner]);
        out.hash += of_corners[corner];
    }
    out.hash = scattered(out.hash);
    return out;
}

struct HashedFace {
    std::uint64_t hash, cell;
    std::uint32_t face;
    friend auto operator<=>(const HashedFace&, const HashedFace&) = default;
};

class OpenFaceFinder {
public:
    OpenFaceFinder(const core::CellReader& cells, const core::FaceReader& faces, const Progress& progress)
        : cells_(cells), faces_(faces), progress_(progress), sums_(cells.points()) {}

    Result<OpenFaces> find() {
        add_hashes();
        collect();
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
        sums_.release();
        keep_odd();
        return shared_ones();
    }

private:
    void add_hashes() {
        std::ranges::fill(sums_, std::uint64_t{0});
        core::parallel_pieces(cells_.count(), cells_per_look, progress_, [&](std::size_t begin, std::size_t end) {
            CellLoops loops(cells_, faces_);
            for (std::size_t cell = begin; cell < end; ++cell)
                each_face(cell, loops, [&](std::size_t, const FaceHash& hash) {
                    std::atomic_ref(sums_[hash.lowest]).fetch_xor(hash.hash, std::memory_order_relaxed);
                });
        });
    }

    void collect() {
        std::mutex mutex;
        core::parallel_pieces(cells_.count(), cells_per_look, progress_, [&](std::size_t begin, std::size_t end) {
            CellLoops loops(cells_, faces_);
            std::vector<HashedFace> part;
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (core::is_contoured(cells_.type(cell)) && !has_odd_corner(cell)) continue;
                each_face(cell, loops, [&](std::size_t face, const FaceHash& hash) {
                    if (sums_[hash.lowest] != 0) part.push_back({hash.hash, cell, static_cast<std::uint32_t>(face)});
                });
            }
            const std::lock_guard lock(mutex);
            found_.insert(found_.end(), part.begin(), part.end());
        });
        tbb::parallel_sort(found_.begin(), found_.end());
    }

    /// Calls use(number, hash) for each face of a cell. Those of a cell with eight corners or fewer need no list.
    template <class Use>
    void each_face(std::size_t cell, CellLoops& loops, const Use& use) const {
        if (core::is_contoured(cells_.type(cell))) {
            const core::WholeCell whole = cells_.whole(cell);
            if (!core::has_repeated_corner(whole)) return each_whole_face(whole, use);
        }
        if (!loops.read(cell)) return;
        for (std::size_t face = 0; face < loops.count(); ++face) use(face, hash_of(loops.loop(face)));
    }

    template <class Use>
    static void each_whole_face(const core::WholeCell& cell, const Use& use) {
        std::array<std::uint64_t, 8> hashes{};
        for (std::size_t i = 0; i < core::corner_count(cell.kind); ++i) hashes[i] = scattered(cell.corners[i]);
        std::size_t number = 0;
        for (const core::CellFace& face : core::shape_of(cell.kind).faces()) use(number++, hash_of(cell, face, hashes));
    }

    /// Some face of it may have no neighbour.
    bool has_odd_corner(std::size_t cell) const {
        const std::uint64_t first = cells_.first(cell), end = first + cells_.corners(cell);
        for (std::uint64_t i = first; i < end; ++i)
            if (sums_[cells_.corner(i)] != 0) return true;
        return false;
    }

    /// Faces of one hash are one face: a single one stays.
    void keep_odd() {
        std::size_t kept = 0;
        for (std::size_t begin = 0, end = 0; begin < found_.size(); begin = end) {
            end = begin + 1;
            while (end < found_.size() && found_[end].hash == found_[begin].hash) ++end;
            if (end == begin + 1) found_[kept++] = found_[begin];
        }
        found_.resize(kept);
        tbb::parallel_sort(found_.begin(), found_.end(), [](const HashedFace& a, const HashedFace& b) {
            return std::pair(a.cell, a.face) < std::pair(b.cell, b.face);
        });
    }

    /// A face that shares no point with those of other cells meets none. So grids where each cell has points of its own
    /// cost no more than to tell.
    OpenFaces shared_ones() {
        OpenFaces all;
        CellLoops loops(cells_, faces_);
        std::vector<std::pair<std::uint64_t, std::uint64_t>> users; // points and cells
        for (std::size_t i = 0; i < found_.size(); ++i) {
            if (i == 0 || found_[i].cell != found_[i - 1].cell) loops.read(found_[i].cell);
            const auto loop = loops.loop(found_[i].face);
            all.add({found_[i].cell, found_[i].face}, loop);
            for (const std::uint64_t point : loop) users.emplace_back(point, found_[i].cell);
        }
        found_ = {};
        tbb::parallel_sort(users.begin(), users.end());
        std::vector<std::uint64_t> shared;
        for (std::size_t i = 1; i < users.size(); ++i)
            if (users[i].first == users[i - 1].first && users[i].second != users[i - 1].second &&
                (shared.empty() || shared.back() != users[i].first))
                shared.push_back(users[i].first);
        const auto is_shared = [&](std::uint64_t point) { return std::ranges::binary_search(shared, point); };
        OpenFaces out;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (std::ranges::any_of(all.loop(i), is_shared)) out.add(all.place(i), all.loop(i));
        return out;
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const Progress& progress_;
    core::Buffer<std::uint64_t> sums_; ///< by lowest point
    std::vector<HashedFace> found_;
};

} // namespace

Result<OpenFaces> find_open_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                  const Progress& progress) {
    if (auto fits = core::require_memory("looking for hanging points", 8 * cells.points()); !fits) return fits.error();
    return OpenFaceFinder(cells, faces, progress).find();
}

} // namespace isotet::linear
