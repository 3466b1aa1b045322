// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/active_filter.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "cpu/direct/arena.hpp"
#include "cpu/direct/side_sums.hpp"

namespace isotet::cpu::direct {

namespace {

/// `Point` holds every point number.
template <class Point>
class Filter final : public ActiveFilter {
public:
    Filter(std::vector<Sides> sides, CellType type)
        : sides_(std::move(sides)),
          type_(type),
          corners_(static_cast<std::size_t>(core::corners_of(static_cast<std::uint8_t>(type)))) {}

    void add(std::uint64_t first, const Array& corners) override {
        corners.visit([&](auto values) {
            using Index = std::remove_const_t<typename decltype(values)::element_type>;
            if constexpr (std::is_integral_v<Index> && sizeof(Index) >= 4) add_typed(first, values);
            else broken_ = true;
        });
    }

    std::optional<Cells> finish() override {
        join_fragments();
        if (broken_) return std::nullopt;
        std::vector<Run> runs;
        for (const Kept& kept : kept_) runs.insert(runs.end(), kept.runs.begin(), kept.runs.end());
        std::ranges::sort(runs, {}, &Run::first_cell);
        std::vector<std::size_t> places{0};
        for (const Run& run : runs) places.push_back(places.back() + run.count);
        using Index = std::make_signed_t<Point>;
        core::Buffer<Index> connectivity(places.back());
        core::parallel_each(runs.size(), 16, [&](std::size_t i) {
            std::copy_n(runs[i].corners, runs[i].count, connectivity.data() + places[i]);
        });
        kept_.clear();
        Cells cells;
        cells.connectivity =
            places.back() ? std::move(connectivity).to_array() : Array(scalar_type_of<Index>(), nullptr, 0, 1, nullptr);
        cells.uniform_type = type_;
        return cells;
    }

private:
    /// Kept cells of up to `cells_at_once`.
    struct Run {
        std::uint64_t first_cell; ///< of those that were looked at
        const Point* corners;
        std::size_t count;
    };

    /// What a thread has kept, in blocks that stay where they are.
    struct Kept {
        std::vector<core::Buffer<Point>> blocks;
        std::size_t left = 0; ///< at the end of the last block
        std::vector<Run> runs;

        Point* room(std::size_t count) {
            constexpr std::size_t block = arena_block / sizeof(Point);
            if (left < count) {
                blocks.emplace_back(block);
                left = block;
            }
            return blocks.back().end() - left;
        }
    };

    /// Corners of a cell whose other ones are in another piece.
    struct Fragment {
        std::uint64_t first;
        std::vector<std::uint64_t> corners;
    };

    template <class Index>
    void add_typed(std::uint64_t first, std::span<const Index> corners) {
        const std::size_t into_cell = static_cast<std::size_t>(first % corners_);
        const std::size_t head = std::min(corners.size(), into_cell ? corners_ - into_cell : 0);
        const std::size_t cells = (corners.size() - head) / corners_, tail = corners.size() - head - cells * corners_;
        if (head) keep_fragment(first, corners.first(head));
        if (tail) keep_fragment(first + head + cells * corners_, corners.last(tail));
        pass((first + head) / corners_, corners.data() + head, cells);
    }

    template <class Index>
    void keep_fragment(std::uint64_t first, std::span<const Index> corners) {
        Fragment fragment{first, {}};
        for (const Index corner : corners) fragment.corners.push_back(static_cast<std::make_unsigned_t<Index>>(corner));
        const std::lock_guard lock(mutex_);
        fragments_.push_back(std::move(fragment));
    }

    void join_fragments() {
        std::ranges::sort(fragments_, {}, &Fragment::first);
        std::vector<std::uint64_t> cell;
        for (const Fragment& fragment : fragments_) {
            cell.insert(cell.end(), fragment.corners.begin(), fragment.corners.end());
            if (cell.size() < corners_) continue;
            pass(fragment.first / corners_, cell.data(), 1);
            cell.clear();
        }
        fragments_.clear();
    }

    template <class Index>
    void pass(std::uint64_t first_cell, const Index* corners, std::size_t cells) {
        switch (corners_) {
        case 4: return pass_like<4>(first_cell, corners, cells);
        case 5: return pass_like<5>(first_cell, corners, cells);
        case 6: return pass_like<6>(first_cell, corners, cells);
        default: return pass_like<8>(first_cell, corners, cells);
        }
    }

    template <std::size_t n, class Index>
    void pass_like(std::uint64_t first_cell, const Index* corners, std::size_t cells) {
        std::array<std::uint16_t, cells_at_once> sums;
        std::array<std::uint32_t, cells_at_once> places;
        for (std::size_t begin = 0; begin < cells && !broken_.load(std::memory_order_relaxed); begin += cells_at_once) {
            const std::size_t size = std::min(cells_at_once, cells - begin);
            const Index* const part = corners + n * begin;
            std::array<std::uint64_t, cells_at_once / 64> keep{};
            if (first_cell + begin == 0 && size) keep[0] = 1; // so that there is a cell to contour
            for (Sides& sides : sides_) {
                if (!add_up_sides<n>(sides, part, size, sums.data())) broken_ = true;
                std::fill(sums.begin() + static_cast<std::ptrdiff_t>(size), sums.end(), 0);
                const std::size_t found = find_worth_looking<n>(sums, places.data());
                for (std::size_t i = 0; i < found; ++i) {
                    const std::uint32_t place = places[i];
                    const bool asked_for = sums[place] >= 16 && uses_watched<n>(sides, part + n * place);
                    if (asked_for || has_both_sides<n>(sums[place]))
                        keep[place / 64] |= std::uint64_t{1} << (place % 64);
                }
            }
            take<n>(first_cell + begin, part, keep);
        }
    }

    /// Of a cell that has a corner which needs attention: whether the cell must be kept for it.
    template <std::size_t n, class Index>
    bool uses_watched(Sides& sides, const Index* cell) {
        unsigned any = 0;
        bool repeated = false; // such a cell may collapse, and use nothing
        for (std::size_t k = 0; k < n; ++k) {
            const auto point =
                static_cast<std::size_t>(static_cast<std::make_unsigned_t<Index>>(cell[k])) & sides.mask();
            any |= sides[point];
            repeated |= std::find(cell, cell + k, cell[k]) != cell + k;
        }
        if (any & side::unsound) broken_ = true;
        if (!(any & side::watched) || broken_) return false;
        for (std::size_t k = 0; k < n && !repeated; ++k) sides.saw(static_cast<std::size_t>(cell[k]));
        return true;
    }

    template <std::size_t n, class Index>
    void take(std::uint64_t first_cell, const Index* corners,
              const std::array<std::uint64_t, cells_at_once / 64>& keep) {
        std::size_t count = 0;
        for (const std::uint64_t word : keep) count += static_cast<std::size_t>(std::popcount(word));
        if (count == 0 || broken_) return;
        Kept& kept = kept_.local();
        Point* const room = kept.room(n * count);
        Point* next = room;
        for (std::size_t i = 0; i < keep.size(); ++i)
            for (std::uint64_t word = keep[i]; word; word &= word - 1) {
                const std::size_t place = 64 * i + static_cast<std::size_t>(std::countr_zero(word));
                for (std::size_t k = 0; k < n; ++k) *next++ = static_cast<Point>(corners[n * place + k]);
            }
        kept.left -= n * count;
        kept.runs.push_back({first_cell, room, n * count});
    }

    std::vector<Sides> sides_; ///< one an isovalue
    CellType type_;
    std::size_t corners_; ///< of a cell
    std::atomic<bool> broken_{false};
    tbb::enumerable_thread_specific<Kept> kept_;
    std::mutex mutex_;
    std::vector<Fragment> fragments_; ///< under the mutex
};

} // namespace
} // namespace isotet::cpu::direct

namespace isotet::cpu {

template <class Real>
std::unique_ptr<ActiveFilter> make_active_filter(const ops::DirectInput& input, const ops::DirectRequest& request,
                                                 CellType type) {
    using namespace direct;
    const std::size_t points = input.grid.points.tuples();
    const PointSurvey survey = survey_points<Real>(input, nullptr);
    std::vector<Sides> sides;
    for (const double isovalue : request.isovalues) {
        const auto stored = core::store_isovalue<Real>(isovalue, survey.field.storage);
        const Watch watch = sides.empty() ? Watch::deciding : Watch::nothing;
        find_sides(input, survey, isovalue, stored, request.ties, watch, sides.emplace_back(points));
    }
    if (points > std::uint64_t{1} << 31) return std::make_unique<Filter<std::uint64_t>>(std::move(sides), type);
    return std::make_unique<Filter<std::uint32_t>>(std::move(sides), type);
}

template std::unique_ptr<ActiveFilter> make_active_filter<float>(const ops::DirectInput&, const ops::DirectRequest&,
                                                                 CellType);
template std::unique_ptr<ActiveFilter> make_active_filter<double>(const ops::DirectInput&, const ops::DirectRequest&,
                                                                  CellType);

} // namespace isotet::cpu
