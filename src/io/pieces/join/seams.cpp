// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points that can be shared lie in the boxes of two pieces. Nearly all are at the very place of their copies and near
// no other place: sorted by cells of space, these are joined at once. The others are grouped by a coarse distance, and
// each group is settled by itself.
#include "io/pieces/join/seams.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "grid/orientation.hpp"
#include "grid/points/close_points.hpp"
#include "io/pieces/join/seam_groups.hpp"

namespace isotet::io {
namespace {

using core::Keyed;
using core::Point;

constexpr std::size_t seam_grain = std::size_t{1} << 14;

Error cancelled() { return {ErrorCode::cancelled, "joining pieces was cancelled"}; }

/// Places are scaled so that the tolerance is 1 along each axis.
struct Scale {
    Point lower{}, tolerance{};
    double coarse = 0;
};

/// A cube of space whose edge is `edge` times the coarse distance, so that few points are near its faces.
class CellOfSpace {
public:
    CellOfSpace(const Scale& scale, const Point& place) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Not at whole numbers, where the places of regular grids are.
            const double along = (place[axis] - scale.lower[axis]) / (edge * scale.coarse) + 1.382;
            const double begin = std::floor(along);
            cell_[axis] = static_cast<std::uint64_t>(begin);
            step_[axis] = along - begin < margin ? -1 : begin + 1 - along < margin ? 1 : 0;
        }
    }

    /// In the order of x, then y, then z.
    std::uint64_t key() const { return key_of(cell_); }

    /// Calls visit(key) for the other cells that have places within the coarse distance, with room for rounding.
    template <class Visit>
    void each_other(const Visit& visit) const {
        if (step_[0] == 0 && step_[1] == 0 && step_[2] == 0) return;
        for (unsigned axes = 1; axes < 8; ++axes) {
            std::array<std::uint64_t, 3> other = cell_;
            bool is_near = true;
            for (unsigned axis = 0; axis < 3; ++axis) {
                if ((axes >> axis & 1) == 0) continue;
                is_near = is_near && step_[axis] != 0;
                other[axis] += static_cast<std::uint64_t>(step_[axis]);
            }
            if (is_near) visit(key_of(other));
        }
    }

private:
    static constexpr double edge = 64, margin = 1.1 / edge;
    static std::uint64_t key_of(const std::array<std::uint64_t, 3>& cell) {
        return cell[0] << 42 | cell[1] << 21 | cell[2]; // at most 15,628 cells along an axis
    }
    std::array<std::uint64_t, 3> cell_;
    std::array<std::int64_t, 3> step_; ///< -1 or 1: the face of the cell at that side is near
};

Scale scale_of(const std::vector<SeamPiece>& pieces) {
    constexpr double share = 1e-12, roundings = 2, coarse_share = 1e-6;
    Box whole;
    bool single = false;
    for (const SeamPiece& piece : pieces) {
        if (piece.box.is_empty()) continue;
        whole.add(piece.box);
        single = single || piece.points.type() == ScalarType::float32;
    }
    Scale scale;
    if (whole.is_empty()) return scale;
    double length = 0, sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) length = std::max(length, whole.upper[axis] - whole.lower[axis]);
    if (!std::isfinite(length)) return scale;
    const double rounding = roundings * (single ? 0x1p-23 : 0x1p-52);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double magnitude = std::max({std::abs(whole.lower[axis]), std::abs(whole.upper[axis]), length});
        scale.tolerance[axis] = std::max({share * length, rounding * magnitude, 1e-300});
        sum += scale.tolerance[axis];
    }
    scale.lower = whole.lower;
    scale.coarse = std::max(coarse_share * length, 2 * sum);
    return scale;
}

class SeamFinder {
public:
    SeamFinder(const std::vector<SeamPiece>& pieces, const Progress& progress)
        : pieces_(pieces), progress_(progress), scale_(scale_of(pieces)) {
        for (const SeamPiece& piece : pieces_) {
            first_.push_back(first_.back() + piece.points.tuples());
            places_.emplace_back(piece.points);
        }
    }

    Result<Seams> find() {
        if (auto done = judge_ids(); !done) return done.error();
        if (scale_.coarse > 0) find_candidates();
        if (candidates_.size() < 2) return std::move(seams_);
        if (auto enough = core::require_memory("joining pieces", 150 * candidates_.size()); !enough)
            return enough.error();
        if (progress_.cancelled()) return cancelled();
        progress_("join pieces", 0.3);
        join_equal_places();
        if (progress_.cancelled()) return cancelled();
        if (candidates_.empty()) return std::move(seams_);
        const auto joined = static_cast<std::ptrdiff_t>(seams_.joined.size());
        const std::vector<Keyed> grouped = group();
        if (progress_.cancelled()) return cancelled();
        settle(grouped);
        if (progress_.cancelled()) return cancelled();
        const auto middle = seams_.joined.begin() + joined;
        std::sort(middle, seams_.joined.end(), by_point);
        std::inplace_merge(seams_.joined.begin(), middle, seams_.joined.end(), by_point);
        return std::move(seams_);
    }

private:
    static bool by_point(const JoinedPoint& a, const JoinedPoint& b) { return a.point < b.point; }

    std::uint32_t piece_of(std::uint64_t point) const {
        return static_cast<std::uint32_t>(std::ranges::upper_bound(first_, point) - first_.begin() - 1);
    }
    Point place_of(std::uint64_t point) const {
        const std::uint32_t piece = piece_of(point);
        return places_[piece][point - first_[piece]];
    }
    std::uint64_t id_of(std::uint64_t point) const {
        const std::uint32_t piece = piece_of(point);
        return pieces_[piece].ids.visit(
            [&](auto ids) { return static_cast<std::uint64_t>(ids[point - first_[piece]]); });
    }

    /// Makes a box smaller on one side, so that it holds no place of the other one.
    void cut_off(Box& inner, const Box& other) const {
        double least = std::numeric_limits<double>::infinity();
        Box cut = inner;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double above = other.upper[axis] + scale_.coarse, below = other.lower[axis] - scale_.coarse;
            if (const double off = above - inner.lower[axis]; off < least) {
                least = off;
                cut = inner;
                cut.lower[axis] = std::nextafter(above, std::numeric_limits<double>::infinity());
            }
            if (const double off = inner.upper[axis] - below; off < least) {
                least = off;
                cut = inner;
                cut.upper[axis] = std::nextafter(below, -std::numeric_limits<double>::infinity());
            }
        }
        if (least >= 0) inner = cut; // else it holds none
    }

    /// The points in the boxes of other pieces.
    void find_candidates() {
        struct Chunk {
            std::size_t piece, begin, end;
            std::vector<std::uint64_t> found = {};
        };
        std::vector<Chunk> chunks;
        std::vector<std::vector<Box>> others(pieces_.size());
        std::vector<Box> inner(pieces_.size());
        core::parallel_each(pieces_.size(), 1, [&](std::size_t p) {
            for (std::size_t q = 0; q < pieces_.size(); ++q)
                if (p != q && pieces_[p].box.meets(pieces_[q].box, scale_.coarse)) others[p].push_back(pieces_[q].box);
            inner[p] = pieces_[p].box;
            for (const Box& other : others[p]) cut_off(inner[p], other);
        });
        for (std::size_t p = 0; p < pieces_.size(); ++p)
            for (std::size_t i = 0; !others[p].empty() && i < pieces_[p].points.tuples(); i += seam_grain)
                chunks.push_back({p, i, std::min(i + seam_grain, pieces_[p].points.tuples())});
        core::parallel_each(chunks.size(), 1, [&](std::size_t c) {
            if (progress_.cancelled()) return;
            Chunk& chunk = chunks[c];
            const SeamPiece& piece = pieces_[chunk.piece];
            const core::PointReader places(piece.points);
            for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
                if (!piece.use.empty() && piece.use[i] != PointUse::kept) continue;
                const Point place = places[i];
                if (inner[chunk.piece].holds(place, 0)) continue;
                if (std::ranges::any_of(others[chunk.piece],
                                        [&](const Box& box) { return box.holds(place, scale_.coarse); }))
                    chunk.found.push_back(first_[chunk.piece] + i);
            }
        });
        for (const Chunk& chunk : chunks) candidates_.insert(candidates_.end(), chunk.found.begin(), chunk.found.end());
    }

    static constexpr std::uint32_t no_point = ~std::uint32_t{0};
    static constexpr std::uint64_t no_id = ~std::uint64_t{0};

    std::pair<std::uint64_t, std::uint64_t> range_of_ids() const {
        std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges(pieces_.size(), {no_id, 0});
        core::parallel_each(pieces_.size(), 1, [&](std::size_t p) {
            pieces_[p].ids.visit([&](auto ids) {
                for (const auto id : ids) {
                    ranges[p].first = std::min(ranges[p].first, static_cast<std::uint64_t>(id));
                    ranges[p].second = std::max(ranges[p].second, static_cast<std::uint64_t>(id));
                }
            });
        });
        std::pair<std::uint64_t, std::uint64_t> all{no_id, 0};
        for (const auto& [lowest, highest] : ranges) all = {std::min(all.first, lowest), std::max(all.second, highest)};
        return all;
    }

    /// With a table of the last point of each number, in place of sorting all.
    Result<void> judge_dense_ids(std::uint64_t lowest, std::uint64_t highest) {
        const std::uint64_t numbers = highest - lowest + 1;
        if (auto enough = core::require_memory("comparing global point numbers", sizeof no_point * numbers); !enough)
            return enough.error();
        core::Buffer<std::uint32_t> last(numbers);
        core::parallel_each(numbers, seam_grain, [&](std::size_t i) { last[i] = no_point; });
        bool shared = false, wrong = false;
        for (std::size_t p = 0; p < pieces_.size() && !wrong; ++p) {
            if (progress_.cancelled()) return cancelled();
            pieces_[p].ids.visit([&](auto ids) {
                for (std::size_t i = 0; i < ids.size() && !wrong; ++i) {
                    if (!pieces_[p].use.empty() && pieces_[p].use[i] != PointUse::kept) continue;
                    std::uint32_t& known = last[static_cast<std::uint64_t>(ids[i]) - lowest];
                    const std::uint64_t here = first_[p] + i;
                    if (known != no_point) {
                        wrong = !are_near(place_of(here), place_of(known));
                        shared = shared || piece_of(known) != p;
                    }
                    known = static_cast<std::uint32_t>(here);
                }
            });
        }
        seams_.ids = wrong ? IdUse::wrong : shared ? IdUse::trusted : IdUse::unshared;
        return {};
    }

    /// Whether global numbers can be trusted: of all points that are used, not of candidates only, since numbers that
    /// each piece counts for itself may agree by chance at some.
    Result<void> judge_ids() {
        for (const SeamPiece& piece : pieces_)
            if (piece.ids.size() != piece.points.tuples() || is_floating(piece.ids.type())) return {};
        const std::uint64_t count = first_.back();
        if (const auto [lowest, highest] = range_of_ids(); highest - lowest < 4 * count && count < no_point)
            return judge_dense_ids(lowest, highest);
        if (auto enough = core::require_memory("comparing global point numbers", 2 * sizeof(Keyed) * count); !enough)
            return enough.error();
        core::Buffer<Keyed> numbered(count), scratch(count);
        core::parallel_each(pieces_.size(), 1, [&](std::size_t p) {
            pieces_[p].ids.visit([&](auto ids) {
                core::parallel_each(ids.size(), seam_grain, [&](std::size_t i) {
                    numbered[first_[p] + i] = {static_cast<std::uint64_t>(ids[i]), first_[p] + i};
                });
            });
        });
        core::radix_sort({numbered.data(), numbered.size()}, {scratch.data(), scratch.size()});
        scratch.release();
        std::atomic<bool> shared = false, wrong = false;
        core::parallel_ranges(count, seam_grain, [&](std::size_t begin, std::size_t end) {
            if (wrong || progress_.cancelled()) return;
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint64_t here = numbered[i].number;
                if (i == 0 || numbered[i - 1].key != numbered[i].key || !is_used(here)) continue;
                std::size_t j = i; // the last one before with this number that is used
                while (j > 0 && numbered[j - 1].key == numbered[i].key && !is_used(numbered[j - 1].number)) --j;
                if (j == 0 || numbered[j - 1].key != numbered[i].key) continue;
                const std::uint64_t other = numbered[j - 1].number;
                if (!are_near(place_of(here), place_of(other))) wrong = true;
                else if (piece_of(here) != piece_of(other)) shared = true;
            }
        });
        seams_.ids = wrong ? IdUse::wrong : shared ? IdUse::trusted : IdUse::unshared;
        return {};
    }
    bool is_used(std::uint64_t point) const {
        const std::uint32_t piece = piece_of(point);
        return pieces_[piece].use.empty() || pieces_[piece].use[point - first_[piece]] == PointUse::kept;
    }
    bool are_near(const Point& a, const Point& b) const {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= scale_.coarse;
    }

    /// The candidates by cell of space, each also in other cells that it is near to; `number`: which, and whether it is
    /// in the cell.
    core::Buffer<Keyed> placed_candidates() const {
        const std::size_t count = candidates_.size(), chunks = (count + seam_grain - 1) / seam_grain;
        std::vector<std::vector<Keyed>> near(chunks); // in other cells
        core::Buffer<Keyed> placed(count + count / 4);
        core::parallel_each(chunks, 1, [&](std::size_t chunk) {
            const std::size_t begin = chunk * seam_grain, end = std::min(begin + seam_grain, count);
            for (std::size_t i = begin; i < end; ++i) {
                const CellOfSpace cell(scale_, place_of(candidates_[i]));
                placed[i] = {cell.key(), 2 * i + 1};
                cell.each_other([&](std::uint64_t key) { near[chunk].push_back({key, 2 * i}); });
            }
        });
        std::size_t all = count;
        for (const auto& found : near) all += found.size();
        if (all > placed.size()) {
            core::Buffer<Keyed> larger(all);
            std::copy_n(placed.begin(), count, larger.begin());
            placed = std::move(larger);
        }
        Keyed* next = placed.begin() + count;
        for (const auto& found : near) next = std::copy(found.begin(), found.end(), next);
        placed.shrink(all);
        core::Buffer<Keyed> scratch(all);
        core::radix_sort({placed.data(), all}, {scratch.data(), all});
        return placed;
    }

    /// Calls visit(entries) for each cell, in parallel.
    template <class Visit>
    void each_cell(const core::Buffer<Keyed>& placed, const Visit& visit) const {
        core::parallel_ranges(placed.size(), seam_grain, [&](std::size_t begin, std::size_t end) {
            if (progress_.cancelled()) return;
            for (std::size_t i = begin, last = begin; i < end; i = last) {
                last = i + 1;
                while (last < placed.size() && placed[last].key == placed[i].key) ++last;
                if (i == 0 || placed[i - 1].key != placed[i].key)
                    visit(std::span(placed.begin() + i, placed.begin() + last));
            }
        });
    }

    /// Whether candidates of one place can be joined without looking closer: they are of different pieces, and the ids
    /// agree where these decide.
    bool are_copies(std::span<const Keyed> entries) const {
        const bool by_id = seams_.ids == IdUse::trusted;
        for (std::size_t i = 1; i < entries.size(); ++i) {
            const std::uint64_t one = candidates_[entries[i - 1].number / 2], next = candidates_[entries[i].number / 2];
            if (piece_of(one) == piece_of(next) || (by_id && id_of(one) != id_of(next))) return false;
        }
        return true;
    }

    /// Joins candidates at equal places, near no other place, and leaves those that must be looked at closer.
    void join_equal_places() {
        const std::size_t count = candidates_.size();
        const core::Buffer<Keyed> placed = placed_candidates();
        // The first candidate at the place of each; itself where it is alone; `close`: it must be looked at closer. Two
        // that are near each other at different places are in one cell of both's, and both are marked there.
        constexpr std::uint64_t close = ~std::uint64_t{0};
        core::Buffer<std::uint64_t> first(count);
        core::parallel_each(count, seam_grain, [&](std::size_t i) { first[i] = i; });
        const auto mark = [&](std::span<const Keyed> entries) {
            for (const Keyed& entry : entries)
                std::atomic_ref(first[entry.number / 2]).store(close, std::memory_order_relaxed);
        };
        const auto place = [&](const Keyed& entry) { return place_of(candidates_[entry.number / 2]); };
        each_cell(placed, [&](std::span<const Keyed> entries) {
            if (entries.size() == 1) return;
            const Point here = place(entries[0]);
            const bool are_equal =
                std::ranges::all_of(entries.subspan(1), [&](const Keyed& other) { return place(other) == here; });
            if (!are_equal || (entries[0].number % 2 == 1 && !are_copies(entries))) mark(entries);
        });
        each_cell(placed, [&](std::span<const Keyed> entries) {
            if (entries.size() == 1 || entries[0].number % 2 == 0 || first[entries[0].number / 2] == close) return;
            for (const Keyed& entry : entries) first[entry.number / 2] = entries[0].number / 2;
        });
        if (progress_.cancelled()) return;
        std::vector<std::uint64_t> left;
        for (std::size_t i = 0; i < count; ++i)
            if (first[i] == close) left.push_back(candidates_[i]);
            else if (first[i] != i) seams_.joined.push_back({candidates_[i], candidates_[first[i]]});
        candidates_ = std::move(left);
    }

    /// Candidates that are near others, by group; the key is the lowest of the group.
    std::vector<Keyed> group() {
        std::vector<double> places(3 * candidates_.size());
        core::parallel_each(candidates_.size(), seam_grain, [&](std::size_t i) {
            const Point place = place_of(candidates_[i]);
            std::ranges::copy(place, places.begin() + static_cast<std::ptrdiff_t>(3 * i));
        });
        const std::vector<std::uint64_t> lowest = core::lowest_of_chain(
            Array::borrow(places, 3), std::vector<std::uint8_t>(candidates_.size(), 1), scale_.lower, scale_.coarse);
        std::vector<std::uint8_t> has_others(candidates_.size());
        for (std::size_t i = 0; i < lowest.size(); ++i)
            if (lowest[i] != i) has_others[lowest[i]] = 1;
        std::vector<Keyed> grouped;
        for (std::size_t i = 0; i < lowest.size(); ++i)
            if (has_others[lowest[i]]) grouped.push_back({lowest[i], i});
        std::vector<Keyed> scratch(grouped.size());
        core::radix_sort(grouped, scratch);
        return grouped;
    }

    void settle(const std::vector<Keyed>& grouped) {
        std::mutex mutex;
        core::parallel_ranges(grouped.size(), seam_grain, [&](std::size_t begin, std::size_t end) {
            if (progress_.cancelled()) return;
            SeamGroup group;
            Seams found;
            for (std::size_t i = begin; i < end; ++i) {
                if (i > 0 && grouped[i].key == grouped[i - 1].key) continue;
                group.points.clear();
                for (std::size_t j = i; j < grouped.size() && grouped[j].key == grouped[i].key; ++j)
                    group.points.push_back(seam_point(candidates_[grouped[j].number]));
                settle_group(group, seams_.ids == IdUse::trusted ? DecideBy::ids : DecideBy::places, found);
            }
            const std::lock_guard lock(mutex);
            seams_.joined.insert(seams_.joined.end(), found.joined.begin(), found.joined.end());
            seams_.apart += found.apart;
            seams_.near += found.near;
            seams_.gap = std::max(seams_.gap, found.gap);
        });
    }
    SeamPoint seam_point(std::uint64_t point) const {
        SeamPoint result{point, piece_of(point), 0, place_of(point), {}};
        if (seams_.ids == IdUse::trusted) result.id = id_of(point);
        for (std::size_t axis = 0; axis < 3; ++axis)
            result.scaled[axis] = (result.place[axis] - scale_.lower[axis]) / scale_.tolerance[axis];
        return result;
    }

    const std::vector<SeamPiece>& pieces_;
    const Progress& progress_;
    Scale scale_;
    std::vector<std::uint64_t> first_{0};   ///< number of each piece's first point, and of all
    std::vector<core::PointReader> places_; ///< by piece
    std::vector<std::uint64_t> candidates_;
    Seams seams_;
};

} // namespace

Result<Seams> find_seams(const std::vector<SeamPiece>& pieces, const Progress& progress) {
    return SeamFinder(pieces, progress).find();
}

} // namespace isotet::io
