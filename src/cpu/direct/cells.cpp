// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/cells.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include <tbb/enumerable_thread_specific.h>

#include "base/workers.hpp"
#include "cpu/direct/side_sums.hpp"

namespace isotet::cpu::direct {

namespace {

constexpr std::size_t chunks_per_report = 1 << 10;

using core::CellReader;

/// 0 for types that are not contoured.
constexpr std::array<std::uint8_t, 256> corners_by_type = [] {
    std::array<std::uint8_t, 256> counts{};
    for (unsigned type = 0; type < counts.size(); ++type)
        counts[type] = static_cast<std::uint8_t>(core::corners_of(static_cast<std::uint8_t>(type)));
    return counts;
}();

bool is_collapsed(const core::Tet& t) {
    return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

/// Whether all numbers of [begin, end) are `first`, `first` + step and so on.
template <class Index>
bool are_regular(const Index* begin, const Index* end, Index step) {
    bool regular = true;
    for (const Index* at = begin; at + 1 < end; ++at) regular &= at[1] - at[0] == step;
    return regular;
}

/// The pass over one chunk of cells.
template <class Point>
class ChunkPass {
public:
    ChunkPass(CutContext& context, Cutter<Point>& cutter)
        : context_(context), cells_(context.input.cells), cutter_(cutter) {}

    /// Cells that are nothing but four numbers, `corners` those of the first.
    template <class Index>
    void pass_tets(const Index* corners, std::size_t count) {
        pass_like_cells<4>(corners, count, [&]<std::size_t>(std::size_t place, unsigned sum) {
            const Index* const v = corners + 4 * place;
            const std::array<Point, 4> tet{static_cast<Point>(v[0]), static_cast<Point>(v[1]), static_cast<Point>(v[2]),
                                           static_cast<Point>(v[3])};
            if (sum >= 16) [[unlikely]]
                look_at({tet[0], tet[1], tet[2], tet[3]});
            if (has_both_sides<4>(sum)) cutter_.add(tet, static_cast<std::uint32_t>(place));
            return true;
        });
    }

    /// Cells of any type, with offsets or not, `corners` those of the whole grid.
    template <class Index>
    void pass_cells(const Index* corners, std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end && !is_broken(); first += cells_at_once) {
            const std::size_t last = std::min(end, first + cells_at_once), count = corners_of_like_cells(first, last);
            const Index* const part = corners + (count ? cells_.first(first) : 0);
            const std::uint8_t type = cells_.type(first);
            const bool whole = !context_.split_cells && count > 4;
            const auto pass = [&]<std::size_t n>(std::size_t place, unsigned sum) {
                const auto in_chunk = static_cast<std::uint32_t>(first + place - begin);
                if (whole && sum < 16 && add_whole<n>(type, part + n * place, in_chunk)) [[likely]]
                    return true;
                return pass_cell(corners, first + place, in_chunk);
            };
            if (count == 8) pass_like_cells<8>(part, last - first, pass);
            else if (count == 6) pass_like_cells<6>(part, last - first, pass);
            else if (count == 5) pass_like_cells<5>(part, last - first, pass);
            else if (count == 4) pass_like_cells<4>(part, last - first, pass);
            else pass_unlike_cells(corners, begin, first, last);
        }
    }

private:
    void broken() { context_.broken.store(true, std::memory_order_relaxed); }
    bool is_broken() const { return context_.broken.load(std::memory_order_relaxed); }

    /// Cells of `n` corners that lie one after another, `corners` those of the first. Calls pass(place, sum) for those
    /// that are worth a look, with the sum of their flags; false from it: the cell is broken.
    template <std::size_t n, class Index, class Pass>
    void pass_like_cells(const Index* corners, std::size_t count, const Pass& pass) {
        std::array<std::uint16_t, cells_at_once> sums;
        std::array<std::uint32_t, cells_at_once> places;
        for (std::size_t begin = 0; begin < count; begin += cells_at_once) {
            const std::size_t size = std::min(cells_at_once, count - begin);
            if (!add_up_sides<n>(context_.sides, corners + n * begin, size, sums.data())) return broken();
            std::fill(sums.begin() + static_cast<std::ptrdiff_t>(size), sums.end(), 0);
            const std::size_t found = find_worth_looking<n>(sums, places.data());
            for (std::size_t i = 0; i < found; ++i)
                if (!pass.template operator()<n>(begin + places[i], sums[places[i]])) return broken();
            if (is_broken()) return;
        }
    }

    /// A cut cell with nothing special about its corners. False when some are repeated: then it was not added.
    template <std::size_t n, class Index>
    bool add_whole(std::uint8_t type, const Index* corners, std::uint32_t place) {
        NativeCell<Point> cell{*core::kind_of(type), {}};
        for (std::size_t k = 0; k < n; ++k) cell.corners[k] = static_cast<Point>(corners[k]);
        if (core::has_repeated_corner(cell.corners, n)) return false;
        core::order_as_kind(type, cell.corners);
        cutter_.add_cell(cell, place);
        return true;
    }

    /// How many corners each of the cells [begin, end) has, if all have as many, lie one after another in the
    /// connectivity, and are contoured; else 0.
    std::size_t corners_of_like_cells(std::size_t begin, std::size_t end) const {
        const std::size_t count = corners_by_type[cells_.type(begin)];
        if (cells_.has_types()) {
            unsigned different = 0;
            for (std::size_t cell = begin; cell < end; ++cell) different |= cells_.type(cell) ^ cells_.type(begin);
            if (different) return 0;
        }
        if (!cells_.has_offsets()) return count;
        return cells_.offsets().visit([&](const auto* offsets) -> std::size_t {
            using Offset = std::remove_cvref_t<decltype(offsets[0])>;
            const bool regular = are_regular(offsets + begin, offsets + end + 1, static_cast<Offset>(count));
            const std::uint64_t first = core::widened(offsets[begin]), last = core::widened(offsets[end]);
            return regular && first < last && last <= cells_.connectivity_size() ? count : 0;
        });
    }

    /// The cells [first, last) of a chunk that starts at `begin`, whatever they are.
    template <class Index>
    void pass_unlike_cells(const Index* corners, std::size_t begin, std::size_t first, std::size_t last) {
        const std::uint64_t mask =
            std::min<std::uint64_t>(context_.sides.mask(), std::numeric_limits<std::make_unsigned_t<Index>>::max());
        const auto pass = [&](std::size_t cell) {
            return pass_cell(corners, cell, static_cast<std::uint32_t>(cell - begin));
        };
        if (!cells_.has_offsets()) {
            for (std::size_t cell = first; cell < last; ++cell)
                if (!pass(cell)) return broken();
            return;
        }
        cells_.offsets().visit([&](const auto* offsets) {
            for (std::size_t cell = first; cell < last; ++cell) {
                const std::uint64_t at = core::widened(offsets[cell]), end = core::widened(offsets[cell + 1]);
                const std::size_t count = corners_by_type[cells_.type(cell)];
                const bool fits = end - at == count && at < end && end <= cells_.connectivity_size();
                const bool dull = fits && (count == 8   ? is_dull<8>(corners + at, mask)
                                           : count == 6 ? is_dull<6>(corners + at, mask)
                                           : count == 5 ? is_dull<5>(corners + at, mask)
                                                        : is_dull<4>(corners + at, mask));
                if (!dull && !pass(cell)) return broken();
            }
        });
    }

    /// Whether all corners are points on the same side, with nothing else to them: nearly all cells. Only pass_cell()
    /// tells what is wrong with others.
    template <std::size_t count, class Index>
    bool is_dull(const Index* corners, std::uint64_t mask) const {
        std::uint64_t numbers = 0;
        unsigned any = 0, all = side::above;
        for (std::size_t k = 0; k < count; ++k) {
            const auto corner = static_cast<std::make_unsigned_t<Index>>(corners[k]);
            const unsigned flags = context_.sides[corner & mask];
            numbers |= corner;
            any |= flags;
            all &= flags;
        }
        return any == all && (numbers & ~mask) == 0;
    }

    /// Some corner is not just above or below.
    void look_at(const core::Tet& tet) {
        for (const std::uint64_t point : tet)
            if (context_.sides[point] & side::unsound) broken();
        if (is_collapsed(tet)) return;
        for (const std::uint64_t point : tet) context_.sides.saw(point);
    }

    /// False when the cell is broken.
    template <class Index>
    bool pass_cell(const Index* corners, std::size_t cell, std::uint32_t place) {
        const std::uint64_t begin = cells_.first(cell), count = cells_.corners(cell);
        if (count > cells_.connectivity_size() || begin > cells_.connectivity_size() - count) return false;
        const std::uint64_t expected = corners_by_type[cells_.type(cell)];
        if (expected == 0) {
            cutter_.leave_out_cell();
            return true;
        }
        if (count != expected) return false;
        unsigned any = 0, all = side::above;
        for (std::uint64_t k = 0; k < count; ++k) {
            const std::uint64_t point = core::widened(corners[begin + k]);
            if (point >= cells_.points()) return false;
            const unsigned flags = context_.sides[point];
            any |= flags;
            all &= flags;
        }
        if (any & side::unsound) return false;
        const bool both_sides = (any & side::above) != all, watched = any & side::watched;
        if (!both_sides && !watched) return true;
        const auto add_tet = [&](const auto& tet) {
            unsigned above = 0;
            for (std::size_t k = 0; k < 4; ++k) above += context_.sides[tet[k]] & side::above;
            if (watched)
                for (std::size_t k = 0; k < 4; ++k) context_.sides.saw(tet[k]);
            if (above % 4 != 0 && core::is_ordered(cells_.type(cell))) cutter_.expect_ordered();
            if (above % 4 != 0)
                cutter_.add_tet({static_cast<Point>(tet[0]), static_cast<Point>(tet[1]), static_cast<Point>(tet[2]),
                                 static_cast<Point>(tet[3])},
                                place);
        };
        if (context_.split_cells || cells_.only_tets()) {
            for (const core::Tet& tet : cells_.tets(cell)) add_tet(tet);
            return true;
        }
        for (const core::WholeCell& part : core::native_parts(cells_.whole(cell))) {
            if (part.kind == core::CellKind::tetrahedron) {
                add_tet(part.corners);
                continue;
            }
            if (watched)
                for (std::size_t k = 0; k < core::corner_count(part.kind); ++k) context_.sides.saw(part.corners[k]);
            if (both_sides) cutter_.add_cell(NativeCell<Point>(part), place);
        }
        return true;
    }

    CutContext& context_;
    const CellReader& cells_;
    Cutter<Point>& cutter_;
};

} // namespace

template <class Point>
CutCells<Point> cut_cells(CutContext& context, const Progress& progress) {
    const CellReader& cells = context.input.cells;
    const std::size_t chunks = (cells.count() + cells_per_chunk - 1) / cells_per_chunk;
    CutCells<Point> out;
    out.chunks.resize(chunks + 1);
    std::atomic<std::size_t> cutters{0};
    tbb::enumerable_thread_specific<std::shared_ptr<Cutter<Point>>> local(
        [&] { return std::make_shared<Cutter<Point>>(context, cutters.fetch_add(1)); });
    const auto pass_chunk = [&](std::size_t chunk) {
        if (progress.cancelled() || context.broken.load(std::memory_order_relaxed)) return;
        Cutter<Point>& cutter = *local.local();
        const std::size_t begin = chunk * cells_per_chunk, end = std::min(cells.count(), begin + cells_per_chunk);
        cutter.begin(out.chunks[chunk], begin);
        ChunkPass<Point> pass(context, cutter);
        cells.connectivity().visit([&](const auto* corners) {
            if (cells.bare_tets()) pass.pass_tets(corners + 4 * begin, end - begin);
            else pass.pass_cells(corners, begin, end);
        });
        if (!context.broken.load(std::memory_order_relaxed)) cutter.end();
    };
    for (std::size_t first = 0; first < chunks; first += chunks_per_report) {
        core::worker_each(std::min(chunks_per_report, chunks - first), 1,
                            [&](std::size_t chunk) { pass_chunk(first + chunk); });
        if (progress.cancelled() || context.broken) break;
        progress("extract", static_cast<double>(first) / static_cast<double>(chunks));
    }
    out.cutters.resize(cutters);
    for (std::shared_ptr<Cutter<Point>>& cutter : local) out.cutters[cutter->number()] = std::move(cutter);
    return out;
}

template CutCells<std::uint32_t> cut_cells<std::uint32_t>(CutContext&, const Progress&);
template CutCells<std::uint64_t> cut_cells<std::uint64_t>(CutContext&, const Progress&);

void see_used_points(const CellReader& cells, bool split_cells, Sides& sides) {
    core::worker_each(cells.count(), cells_per_chunk, [&](std::size_t cell) {
        if (split_cells || cells.only_tets()) {
            for (const core::Tet& tet : cells.tets(cell))
                for (const std::uint64_t point : tet) sides.saw(point);
        } else if (core::is_contoured(cells.type(cell))) {
            for (const core::WholeCell& part : core::native_parts(cells.whole(cell)))
                for (std::size_t k = 0; k < core::corner_count(part.kind); ++k) sides.saw(part.corners[k]);
        }
    });
}

std::uint64_t count_cut_tets(const CellReader& cells, const Sides& sides) {
    std::atomic<std::uint64_t> total{0};
    core::worker_ranges(cells.count(), cells_per_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t cell = begin; cell < end; ++cell)
            for (const core::Tet& tet : cells.tets(cell)) {
                unsigned above = 0;
                for (const std::uint64_t point : tet) above += sides[point] & side::above;
                count += above % 4 != 0;
            }
        total.fetch_add(count, std::memory_order_relaxed);
    });
    return total;
}

} // namespace isotet::cpu::direct
