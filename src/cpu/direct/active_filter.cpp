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
#include "grid/fixed_corners.hpp"

namespace isotet::cpu::direct {

namespace {

/// `Point` holds every point number.
template <class Point>
class Filter final : public ActiveFilter {
public:
    Filter(std::vector<Sides> sides, std::optional<CellType> type)
        : sides_(std::move(sides)),
          mixed_(!type),
          type_(static_cast<std::uint8_t>(type.value_or(CellType::tetrahedron))),
          corners_(core::fixed_corners_of(type_)) {}

    void add(std::uint64_t first, const Array& corners) override {
        corners.visit([&](auto values) {
            using Index = std::remove_const_t<typename decltype(values)::element_type>;
            if constexpr (std::is_integral_v<Index> && sizeof(Index) >= 4) {
                if (!mixed_) return add_typed(first, values);
            }
            broken_ = true;
        });
    }

    void add_cells(std::uint64_t first_cell, std::span<const std::uint8_t> types, const Array& corners) override {
        corners.visit([&](auto values) {
            using Index = std::remove_const_t<typename decltype(values)::element_type>;
            if constexpr (std::is_integral_v<Index> && sizeof(Index) >= 4) {
                if (mixed_) return add_mixed(first_cell, types, values);
            }
            broken_ = true;
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
        cells.uniform_type = static_cast<CellType>(type_);
        if (mixed_ && !runs.empty()) add_types(runs, cells);
        return cells;
    }

private:
    /// Kept cells of up to `cells_at_once`.
    struct Run {
        std::uint64_t first_cell; ///< of those that were looked at
        const Point* corners;
        std::size_t count;
        std::uint8_t type;
    };

    static void add_types(const std::vector<Run>& runs, Cells& cells) {
        std::vector<std::int64_t> offsets{0};
        std::vector<std::uint8_t> types;
        for (const Run& run : runs) {
            const std::size_t corners = core::fixed_corners_of(run.type);
            for (std::size_t i = 0; i < run.count; i += corners) {
                offsets.push_back(offsets.back() + static_cast<std::int64_t>(corners));
                types.push_back(run.type);
            }
        }
        cells.offsets = Array::own(std::move(offsets));
        cells.types = Array::own(std::move(types));
    }

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
        pass(type_, (first + head) / corners_, corners.data() + head, cells);
    }

    template <class Index>
    void add_mixed(std::uint64_t first_cell, std::span<const std::uint8_t> types, std::span<const Index> corners) {
        std::size_t next = 0;
        for (std::size_t begin = 0, end = 0; begin < types.size(); begin = end) {
            while (end < types.size() && types[end] == types[begin]) ++end;
            const std::size_t count = (end - begin) * core::fixed_corners_of(types[begin]);
            if (count == 0 || count > corners.size() - next) broken_ = true;
            if (broken_.load(std::memory_order_relaxed)) return;
            pass(types[begin], first_cell + begin, corners.data() + next, end - begin);
            next += count;
        }
        if (next != corners.size()) broken_ = true;
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
            pass(type_, fragment.first / corners_, cell.data(), 1);
            cell.clear();
        }
        fragments_.clear();
    }

    template <class Index>
    void pass(std::uint8_t type, std::uint64_t first_cell, const Index* corners, std::size_t cells) {
        if (!core::is_contoured(type)) return keep_all(type, first_cell, corners, cells);
        switch (core::corners_of(type)) {
        case 4: return pass_like<4>(type, first_cell, corners, cells);
        case 5: return pass_like<5>(type, first_cell, corners, cells);
        case 6: return pass_like<6>(type, first_cell, corners, cells);
        default: return pass_like<8>(type, first_cell, corners, cells);
        }
    }

    /// Cells that are not contoured are counted later.
    template <class Index>
    void keep_all(std::uint8_t type, std::uint64_t first_cell, const Index* corners, std::size_t cells) {
        Kept& kept = kept_.local();
        const std::size_t n = core::fixed_corners_of(type);
        for (std::size_t begin = 0; begin < cells; begin += cells_at_once) {
            const std::size_t count = n * std::min(cells_at_once, cells - begin);
            Point* const room = kept.room(count);
            for (std::size_t i = 0; i < count; ++i) {
                const auto corner = static_cast<std::make_unsigned_t<Index>>(corners[n * begin + i]);
                if (corner >= sides_.front().points()) broken_ = true;
                room[i] = static_cast<Point>(corner);
            }
            kept.left -= count;
            kept.runs.push_back({first_cell + begin, room, count, type});
        }
    }

    template <std::size_t n, class Index>
    void pass_like(std::uint8_t type, std::uint64_t first_cell, const Index* corners, std::size_t cells) {
        std::array<std::uint16_t, cells_at_once> sums;
        std::array<std::uint32_t, cells_at_once> places;
        for (std::size_t begin = 0; begin < cells && !broken_.load(std::memory_order_relaxed); begin += cells_at_once) {
            const std::size_t size = std::min(cells_at_once, cells - begin), looked_at = (size + 15) / 16 * 16;
            const Index* const part = corners + n * begin;
            std::array<std::uint64_t, cells_at_once / 64> keep{};
            if (first_cell + begin == 0 && size) keep[0] = 1; // so that there is a cell to contour
            for (Sides& sides : sides_) {
                if (!add_up_sides<n>(sides, part, size, sums.data())) broken_ = true;
                std::fill(sums.data() + size, sums.data() + looked_at, std::uint16_t{0});
                const std::size_t found =
                    find_worth_looking<n>(sums, places.data(), static_cast<std::uint32_t>(looked_at));
                for (std::size_t i = 0; i < found; ++i) {
                    const std::uint32_t place = places[i];
                    const bool asked_for = sums[place] >= 16 && uses_watched<n>(sides, part + n * place);
                    if (asked_for || has_both_sides<n>(sums[place]))
                        keep[place / 64] |= std::uint64_t{1} << (place % 64);
                }
            }
            take<n>(type, first_cell + begin, part, keep);
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
    void take(std::uint8_t type, std::uint64_t first_cell, const Index* corners,
              const std::array<std::uint64_t, cells_at_once / 64>& keep) {
        if (std::ranges::all_of(keep, [](std::uint64_t word) { return word == 0; })) return;
        std::size_t count = 0;
        for (const std::uint64_t word : keep) count += static_cast<std::size_t>(std::popcount(word));
        if (broken_) return;
        Kept& kept = kept_.local();
        Point* const room = kept.room(n * count);
        Point* next = room;
        for (std::size_t i = 0; i < keep.size(); ++i)
            for (std::uint64_t word = keep[i]; word; word &= word - 1) {
                const std::size_t place = 64 * i + static_cast<std::size_t>(std::countr_zero(word));
                for (std::size_t k = 0; k < n; ++k) *next++ = static_cast<Point>(corners[n * place + k]);
            }
        kept.left -= n * count;
        kept.runs.push_back({first_cell, room, n * count, type});
    }

    std::vector<Sides> sides_; ///< one an isovalue
    bool mixed_; ///< each cell has its own type
    std::uint8_t type_;
    std::size_t corners_; ///< of a cell of the type
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
                                                 std::optional<CellType> type) {
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
                                                                 std::optional<CellType>);
template std::unique_ptr<ActiveFilter> make_active_filter<double>(const ops::DirectInput&, const ops::DirectRequest&,
                                                                  std::optional<CellType>);

} // namespace isotet::cpu
