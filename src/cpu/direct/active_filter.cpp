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

#include "base/bits.hpp"
#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "cpu/direct/arena.hpp"
#include "cpu/direct/levels.hpp"
#include "grid/fixed_corners.hpp"

namespace isotet::cpu::direct {

namespace {

/// `Point`   holds every point number
/// `Table`   OneLevel or Levels
template <class Point, class Table>
class Filter final : public ActiveFilter {
public:
    Filter(Table table, std::optional<CellType> type, const ops::DirectRequest& request)
        : table_(std::move(table)),
          keeps_numbers_(request.source_cells),
          round_(request.normals ? Round::mark : Round::only),
          marks_(request.normals ? core::words_of_bits(static_cast<std::size_t>(table_.mask()) + 1) : 0),
          mixed_(!type),
          type_(static_cast<std::uint8_t>(type.value_or(CellType::tetrahedron))),
          corners_(core::fixed_corners_of(type_)),
          broken_(!mixed_ && !core::is_contoured(type_)) {
        std::ranges::fill(marks_, std::uint64_t{0});
    }

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

    void start_second_round() override {
        join_fragments();
        round_ = Round::keep_around;
        for (const Kept& kept : kept_) asked_.insert(asked_.end(), kept.asked.begin(), kept.asked.end());
        std::ranges::sort(asked_);
        kept_.clear();
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
        Cells cells;
        cells.connectivity =
            places.back() ? std::move(connectivity).to_array() : Array(scalar_type_of<Index>(), nullptr, 0, 1, nullptr);
        cells.uniform_type = static_cast<CellType>(type_);
        if (mixed_ && !runs.empty()) add_types(runs, cells);
        if (keeps_numbers_) take_numbers(runs);
        kept_.clear();
        return cells;
    }

    Array numbers() const override { return numbers_; }

private:
    enum class Round : std::uint8_t {
        only,
        mark,        ///< points of cells that are cut
        keep_around, ///< cells that have such points
    };

    struct Kept;
    /// Kept cells of up to `cells_at_once`.
    struct Run {
        std::uint64_t first_cell; ///< of those that were looked at
        const Point* corners;
        std::size_t count;
        const Kept* by;
        std::size_t first_type, types; ///< theirs, of those kept; none where all are alike
        std::size_t first_number = 0, numbers = 0; ///< likewise
    };

    void take_numbers(const std::vector<Run>& runs) {
        std::vector<std::uint64_t> numbers;
        for (const Run& run : runs) {
            const auto own = std::span(run.by->numbers).subspan(run.first_number, run.numbers);
            numbers.insert(numbers.end(), own.begin(), own.end());
        }
        numbers_ = Array::own(std::move(numbers));
    }

    static void add_types(const std::vector<Run>& runs, Cells& cells) {
        std::vector<std::int64_t> offsets{0};
        std::vector<std::uint8_t> types;
        for (const Run& run : runs)
            for (const std::uint8_t type : std::span(run.by->types).subspan(run.first_type, run.types)) {
                types.push_back(type);
                offsets.push_back(offsets.back() + static_cast<std::int64_t>(core::fixed_corners_of(type)));
            }
        cells.offsets = Array::own(std::move(offsets));
        cells.types = Array::own(std::move(types));
    }

    /// What a thread has kept, in blocks that stay where they are.
    struct Kept {
        std::vector<core::Buffer<Point>> blocks;
        std::size_t left = 0; ///< at the end of the last block
        std::vector<Run> runs;
        std::vector<std::uint8_t> types;    ///< of the cells, where each has its own
        std::vector<std::uint64_t> numbers; ///< of the cells, where they are kept
        std::vector<std::uint64_t> asked;   ///< in the first of two rounds: cells that are kept, but not for being cut

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
    void add_mixed(std::uint64_t first_cell, std::span<const std::uint8_t> types, std::span<const Index> corners) {
        MixedCells<Index> cells;
        while (!types.empty()) {
            const std::size_t count = cells.take(types.first(std::min(cells_at_once, types.size())), corners);
            if (count == 0) broken_ = true;
            if (broken_.load(std::memory_order_relaxed)) return;
            pass_mixed(first_cell, cells);
            first_cell += cells.types.size();
            types = types.subspan(cells.types.size());
            corners = corners.subspan(count);
        }
        if (!corners.empty()) broken_ = true;
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

    using Places = std::array<std::uint64_t, cells_at_once / 64>; ///< a bit for each cell
    static void mark(Places& places, std::size_t place) { places[place / 64] |= std::uint64_t{1} << (place % 64); }

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
            const std::size_t size = std::min(cells_at_once, cells - begin), looked_at = (size + 15) / 16 * 16;
            const Index* const part = corners + n * begin;
            const auto cell_at = [&](std::size_t place) { return std::span(part + n * place, n); };
            Places keep{};
            if (first_cell + begin == 0 && size) mark(keep, 0); // so that there is a cell to contour
            if (round_ == Round::keep_around) {
                keep_around(first_cell + begin, size, keep, {}, cell_at);
                continue;
            }
            if (!table_.template look_at<n>(part, size, sums.data())) broken_ = true;
            std::fill(sums.data() + size, sums.data() + looked_at, std::uint16_t{0});
            const std::size_t found =
                Table::template find_worth_looking<n>(sums, places.data(), static_cast<std::uint32_t>(looked_at));
            for (std::size_t i = 0; i < found; ++i) {
                const std::uint32_t place = places[i];
                look_at(first_cell + begin, place, sums[place], cell_at(place), keep);
            }
            if (round_ == Round::only) keep_cells(first_cell + begin, keep, {}, cell_at);
        }
    }

    /// Up to `cells_at_once` cells with a type each.
    template <class Index>
    struct MixedCells {
        std::span<const std::uint8_t> types;
        const Index* corners;
        std::array<std::uint16_t, cells_at_once + 1> begins; ///< of their corners

        /// Returns how many of the corners are theirs; 0 where a type has no fixed number, or corners are missing.
        std::size_t take(std::span<const std::uint8_t> of_types, std::span<const Index> from) {
            types = of_types;
            corners = from.data();
            std::size_t next = 0;
            bool sound = true;
            for (std::size_t i = 0; i < types.size(); ++i) {
                begins[i] = static_cast<std::uint16_t>(next);
                const std::uint64_t own = core::fixed_corners_of(types[i]);
                sound &= own > 0;
                next += own;
            }
            begins[types.size()] = static_cast<std::uint16_t>(next);
            return sound && next <= from.size() ? next : 0;
        }
        std::span<const Index> cell(std::size_t place) const {
            return {corners + begins[place], corners + begins[place + 1]};
        }
    };

    template <class Index>
    void pass_mixed(std::uint64_t first_cell, const MixedCells<Index>& cells) {
        std::array<std::uint16_t, cells_at_once> sums;
        Places keep{};
        if (first_cell == 0) mark(keep, 0); // so that there is a cell to contour
        keep_flat(cells, keep);
        const auto cell_at = [&](std::size_t place) { return cells.cell(place); };
        if (round_ == Round::keep_around)
            return keep_around(first_cell, cells.types.size(), keep, cells.types, cell_at);
        if (!add_up_mixed(cells, sums.data())) broken_ = true;
        for (std::size_t place = 0; place < cells.types.size(); ++place) {
            if (sums[place] != 0) look_at(first_cell, place, sums[place], cells.cell(place), keep);
        }
        if (round_ == Round::only) keep_cells(first_cell, keep, cells.types, cell_at);
    }

    /// A cell whose corners are not all alike, or need attention: keeps it, or marks its points.
    template <class Index>
    void look_at(std::uint64_t first_cell, std::size_t place, unsigned sum, std::span<const Index> cell, Places& keep) {
        const bool asked_for = Table::asks(sum) && uses_watched(cell);
        const bool cut = Table::is_cut(sum, cell.size());
        if (round_ == Round::only) {
            if (asked_for || cut) mark(keep, place);
            return;
        }
        if (cut) {
            for (const Index corner : cell) mark_point(static_cast<std::make_unsigned_t<Index>>(corner));
        } else if (asked_for) {
            kept_.local().asked.push_back(first_cell + place);
        }
    }

    void mark_point(std::uint64_t point) {
        point &= table_.mask();
        const std::atomic_ref word(marks_[point / 64]);
        const std::uint64_t bit = std::uint64_t{1} << point % 64;
        if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
    }

    /// Keeps cells that have marked points, and those that the first round asked for.
    template <class CellAt>
    void keep_around(std::uint64_t first_cell, std::size_t cells, Places& keep, std::span<const std::uint8_t> types,
                     const CellAt& cell_at) {
        const std::uint64_t mask = table_.mask();
        std::uint64_t all = 0; // of the corners: a file may change between the rounds
        for (std::size_t place = 0; place < cells; ++place) {
            std::uint64_t marked = 0;
            for (const auto corner : cell_at(place)) {
                const auto point = static_cast<std::make_unsigned_t<decltype(corner + 0)>>(corner);
                all |= point;
                marked |= marks_[(point & mask) / 64] >> point % 64;
            }
            if ((marked & 1) != 0) mark(keep, place);
        }
        if ((all & ~mask) != 0) broken_ = true;
        for (auto asked = std::ranges::lower_bound(asked_, first_cell);
             asked != asked_.end() && *asked < first_cell + cells; ++asked)
            mark(keep, *asked - first_cell);
        keep_cells(first_cell, keep, types, cell_at);
    }

    /// Cells that are not contoured are counted later.
    template <class Index>
    void keep_flat(const MixedCells<Index>& cells, Places& keep) {
        for (std::size_t place = 0; place < cells.types.size(); ++place) {
            if (core::is_contoured(cells.types[place])) continue;
            mark(keep, place);
            for (const Index corner : cells.cell(place))
                if (static_cast<std::make_unsigned_t<Index>>(corner) >= table_.points()) broken_ = true;
        }
    }

    /// 0 for cells that are not contoured. False as add_up_sides().
    template <class Index>
    bool add_up_mixed(const MixedCells<Index>& cells, std::uint16_t* sums) const {
        const std::span<const std::uint8_t> types = cells.types;
        bool sound = true;
        for (std::size_t begin = 0, end = 0; begin < types.size(); begin = end) {
            while (end < types.size() && types[end] == types[begin]) ++end;
            const Index* const corners = cells.corners + cells.begins[begin];
            switch (core::corners_of(types[begin])) {
            case 4: sound &= table_.template look_at<4>(corners, end - begin, sums + begin); break;
            case 5: sound &= table_.template look_at<5>(corners, end - begin, sums + begin); break;
            case 6: sound &= table_.template look_at<6>(corners, end - begin, sums + begin); break;
            case 8: sound &= table_.template look_at<8>(corners, end - begin, sums + begin); break;
            default: std::fill(sums + begin, sums + end, std::uint16_t{0});
            }
        }
        return sound;
    }

    /// Of a cell that has a corner which needs attention: whether the cell must be kept for it.
    template <class Index>
    bool uses_watched(std::span<const Index> cell) {
        unsigned any = 0;
        bool repeated = false; // such a cell may collapse, and use nothing
        for (std::size_t k = 0; k < cell.size(); ++k) {
            const auto point =
                static_cast<std::size_t>(static_cast<std::make_unsigned_t<Index>>(cell[k])) & table_.mask();
            any |= table_.flags(point);
            repeated |= std::ranges::find(cell.first(k), cell[k]) != cell.begin() + static_cast<std::ptrdiff_t>(k);
        }
        if (any & side::unsound) broken_ = true;
        if (!(any & side::watched) || broken_) return false;
        if (!repeated)
            for (const Index corner : cell) table_.saw(static_cast<std::size_t>(corner));
        return true;
    }

    /// `types`     of the cells, where each has its own
    /// `cell_at`   a place: its corners
    template <class CellAt>
    void keep_cells(std::uint64_t first_cell, const Places& keep, std::span<const std::uint8_t> types,
                    const CellAt& cell_at) {
        std::size_t cells = 0, count = 0;
        for (const std::uint64_t word : keep) cells += static_cast<std::size_t>(std::popcount(word));
        if (cells == 0 || broken_) return;
        const auto each = [&](const auto& use) {
            for (std::size_t i = 0; i < keep.size(); ++i)
                for (std::uint64_t word = keep[i]; word; word &= word - 1)
                    use(64 * i + static_cast<std::size_t>(std::countr_zero(word)));
        };
        each([&](std::size_t place) { count += cell_at(place).size(); });
        Kept& kept = kept_.local();
        Point* const room = kept.room(count);
        Point* next = room;
        each([&](std::size_t place) {
            for (const auto corner : cell_at(place)) *next++ = static_cast<Point>(corner);
        });
        kept.left -= count;
        const std::size_t first_type = kept.types.size();
        if (!types.empty()) each([&](std::size_t place) { kept.types.push_back(types[place]); });
        const std::size_t first_number = kept.numbers.size();
        if (keeps_numbers_) each([&](std::size_t place) { kept.numbers.push_back(first_cell + place); });
        kept.runs.push_back({first_cell, room, count, &kept, first_type, kept.types.size() - first_type, first_number,
                             kept.numbers.size() - first_number});
    }

    Table table_;
    bool keeps_numbers_;
    Array numbers_; ///< when it is finished
    Round round_;
    core::Buffer<std::uint64_t> marks_; ///< a bit for each point of cells that are cut, where there are two rounds
    std::vector<std::uint64_t> asked_;  ///< ascending, in the second of two rounds
    bool mixed_;    ///< each cell has its own type
    std::uint8_t type_;
    std::size_t corners_; ///< of a cell of the type
    std::atomic<bool> broken_;
    tbb::enumerable_thread_specific<Kept> kept_;
    std::mutex mutex_;
    std::vector<Fragment> fragments_; ///< under the mutex
};

} // namespace
} // namespace isotet::cpu::direct

namespace isotet::cpu {

namespace direct {
namespace {

template <class Table>
std::unique_ptr<ActiveFilter> filter_with(Table table, std::optional<CellType> type,
                                          const ops::DirectRequest& request) {
    if (table.points() > std::uint64_t{1} << 31)
        return std::make_unique<Filter<std::uint64_t, Table>>(std::move(table), type, request);
    return std::make_unique<Filter<std::uint32_t, Table>>(std::move(table), type, request);
}

} // namespace
} // namespace direct

template <class Real>
std::unique_ptr<ActiveFilter> make_active_filter(const ops::DirectInput& input, const ops::DirectRequest& request,
                                                 std::optional<CellType> type) {
    using namespace direct;
    const std::size_t points = input.grid.points.tuples();
    const PointSurvey survey = survey_points<Real>(input, nullptr);
    Sides sides(points);
    std::optional<Levels> levels;
    if (request.isovalues.size() > 1) levels.emplace(points);
    Watch watch = Watch::deciding;
    for (const double isovalue : request.isovalues) {
        const auto stored = core::store_isovalue<Real>(isovalue, survey.field.storage);
        find_sides(input, survey, isovalue, stored, request.ties, std::exchange(watch, Watch::nothing), sides);
        if (levels) levels->add(sides);
    }
    if (!levels) return filter_with(OneLevel(std::move(sides)), type, request);
    sides = {};
    return filter_with(*std::move(levels), type, request);
}

template std::unique_ptr<ActiveFilter> make_active_filter<float>(const ops::DirectInput&, const ops::DirectRequest&,
                                                                 std::optional<CellType>);
template std::unique_ptr<ActiveFilter> make_active_filter<double>(const ops::DirectInput&, const ops::DirectRequest&,
                                                                  std::optional<CellType>);

} // namespace isotet::cpu
