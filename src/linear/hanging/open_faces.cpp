// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/open_faces.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <utility>

#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
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
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (!loops.read(cell)) continue;
                for (std::size_t face = 0; face < loops.count(); ++face) {
                    const FaceHash hash = hash_of(loops.loop(face));
                    std::atomic_ref(sums_[hash.lowest]).fetch_xor(hash.hash, std::memory_order_relaxed);
                }
            }
        });
    }

    void collect() {
        std::mutex mutex;
        core::parallel_pieces(cells_.count(), cells_per_look, progress_, [&](std::size_t begin, std::size_t end) {
            CellLoops loops(cells_, faces_);
            std::vector<HashedFace> part;
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (!loops.read(cell)) continue;
                for (std::size_t face = 0; face < loops.count(); ++face)
                    if (const FaceHash hash = hash_of(loops.loop(face)); sums_[hash.lowest] != 0)
                        part.push_back({hash.hash, cell, static_cast<std::uint32_t>(face)});
            }
            const std::lock_guard lock(mutex);
            found_.insert(found_.end(), part.begin(), part.end());
        });
        tbb::parallel_sort(found_.begin(), found_.end());
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
