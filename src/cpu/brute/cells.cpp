// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/brute/cells.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#include <tbb/enumerable_thread_specific.h>

#include "core/parallel.hpp"

namespace isotet::cpu {

namespace {

constexpr std::size_t chunks_a_report = 1 << 10;

using core::CellReader;

bool is_collapsed(const core::Tet& t) {
    return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

/// Calls f with a pointer to the numbers in their own type.
template <class F>
void visit_corners(const Array& connectivity, const F& f) {
    switch (connectivity.type()) {
    case ScalarType::int32: return f(connectivity.as<std::int32_t>().data());
    case ScalarType::uint32: return f(connectivity.as<std::uint32_t>().data());
    case ScalarType::int64: return f(connectivity.as<std::int64_t>().data());
    default: return f(connectivity.as<std::uint64_t>().data());
    }
}

/// The pass over one chunk of cells.
template <class Point>
class ChunkPass {
public:
    ChunkPass(CutContext& context, Cutter<Point>& cutter) : context_(context), cells_(context.input.cells), cutter_(cutter) {}

    /// Cells that are nothing but four numbers, `corners` those of the first.
    template <class Index>
    void pass_tets(const Index* corners, std::size_t count) {
        constexpr std::size_t at_once = 1 << 10; // so that corners are still near when cut tets are fetched
        std::array<std::uint32_t, at_once> cut;
        for (std::size_t begin = 0; begin < count; begin += at_once) {
            const Index* const part = corners + 4 * begin;
            const std::size_t n = find_cut(part, std::min(at_once, count - begin), cut.data());
            if (context_.broken.load(std::memory_order_relaxed)) return;
            for (std::size_t i = 0; i < n; ++i) {
                const Index* const v = part + 4 * std::size_t{cut[i]};
                cutter_.add({static_cast<Point>(v[0]), static_cast<Point>(v[1]), static_cast<Point>(v[2]), static_cast<Point>(v[3])},
                            static_cast<std::uint32_t>(begin + cut[i]));
            }
        }
    }

    /// Cells of any type, with offsets or not.
    void pass_cells(std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            if (!pass_cell(cell, static_cast<std::uint32_t>(cell - begin))) {
                broken();
                return;
            }
    }

private:
    /// Writes the places of tets with corners on both sides; returns how many.
    template <class Index>
    std::size_t find_cut(const Index* corners, std::size_t count, std::uint32_t* cut) {
        using Unsigned = std::make_unsigned_t<Index>; // a negative number becomes a huge one
        if (cells_.points() == 0) return broken();
        const auto last = static_cast<Unsigned>(std::min<std::uint64_t>(cells_.points() - 1, std::numeric_limits<Index>::max()));
        const Sides& sides = context_.sides;
        std::size_t n = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto a = static_cast<Unsigned>(corners[4 * i]), b = static_cast<Unsigned>(corners[4 * i + 1]),
                       c = static_cast<Unsigned>(corners[4 * i + 2]), d = static_cast<Unsigned>(corners[4 * i + 3]);
            if (std::max(std::max(a, b), std::max(c, d)) > last) [[unlikely]] return broken();
            const unsigned flags = sides[a] | sides[b] << 1 | sides[c] << 2 | sides[d] << 3;
            cut[n] = static_cast<std::uint32_t>(i);
            n += (flags & 15) - 1 < 14; // neither all below nor all above
            if (flags > 15) [[unlikely]] look_at({a, b, c, d});
        }
        return n;
    }

    std::size_t broken() {
        context_.broken.store(true, std::memory_order_relaxed);
        return 0;
    }

    /// Some corner is not just above or below.
    void look_at(const core::Tet& tet) {
        for (const std::uint64_t point : tet)
            if (context_.sides[point] & side::unsound) broken();
        if (is_collapsed(tet)) return;
        for (const std::uint64_t point : tet) context_.sides.saw(point);
    }

    bool pass_cell(std::size_t cell, std::uint32_t place) {
        const std::uint64_t begin = cells_.first(cell), corners = cells_.corners(cell);
        if (corners > cells_.connectivity_size() || begin > cells_.connectivity_size() - corners) return false;
        const auto expected = static_cast<std::uint64_t>(core::corners_of(cells_.type(cell)));
        if (expected == 0) {
            cutter_.leave_out_cell();
            return true;
        }
        if (corners != expected) return false;
        unsigned any = 0, all = side::above;
        for (std::uint64_t k = 0; k < corners; ++k) {
            const std::uint64_t point = cells_.corner(begin + k);
            if (point >= cells_.points()) return false;
            const unsigned flags = context_.sides[point];
            any |= flags;
            all &= flags;
        }
        if (any & side::unsound) return false;
        const bool both_sides = (any & side::above) != all, watched = any & side::watched;
        if (!both_sides && !watched) return true;
        for (const core::Tet& tet : cells_.tets(cell)) {
            const unsigned above = [&] {
                unsigned sum = 0;
                for (const std::uint64_t point : tet) sum += context_.sides[point] & side::above;
                return sum;
            }();
            if (watched)
                for (const std::uint64_t point : tet) context_.sides.saw(point);
            if (above % 4 != 0)
                cutter_.add({static_cast<Point>(tet[0]), static_cast<Point>(tet[1]), static_cast<Point>(tet[2]), static_cast<Point>(tet[3])},
                            place);
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
    const Cells& grid_cells = context.input.grid.cells;
    const bool bare_tets = cells.only_tets() && grid_cells.offsets.empty();
    const std::size_t chunks = (cells.count() + cells_a_chunk - 1) / cells_a_chunk;
    CutCells<Point> out;
    out.chunks.resize(chunks + 1);
    std::atomic<std::size_t> cutters{0};
    tbb::enumerable_thread_specific<std::shared_ptr<Cutter<Point>>> local(
        [&] { return std::make_shared<Cutter<Point>>(context, cutters.fetch_add(1)); });
    const auto pass_chunk = [&](std::size_t chunk) {
        if (progress.cancelled() || context.broken.load(std::memory_order_relaxed)) return;
        Cutter<Point>& cutter = *local.local();
        const std::size_t begin = chunk * cells_a_chunk, end = std::min(cells.count(), begin + cells_a_chunk);
        cutter.begin(out.chunks[chunk], begin);
        ChunkPass<Point> pass(context, cutter);
        if (bare_tets) visit_corners(grid_cells.connectivity, [&](const auto* corners) { pass.pass_tets(corners + 4 * begin, end - begin); });
        else pass.pass_cells(begin, end);
        if (!context.broken.load(std::memory_order_relaxed)) cutter.end();
    };
    for (std::size_t first = 0; first < chunks; first += chunks_a_report) {
        core::parallel_each(std::min(chunks_a_report, chunks - first), 1, [&](std::size_t chunk) { pass_chunk(first + chunk); });
        if (progress.cancelled() || context.broken) break;
        progress("extract", static_cast<double>(first) / static_cast<double>(chunks));
    }
    out.cutters.resize(cutters);
    for (std::shared_ptr<Cutter<Point>>& cutter : local) out.cutters[cutter->number()] = std::move(cutter);
    return out;
}

template CutCells<std::uint32_t> cut_cells<std::uint32_t>(CutContext&, const Progress&);
template CutCells<std::uint64_t> cut_cells<std::uint64_t>(CutContext&, const Progress&);

void see_used_points(const CellReader& cells, Sides& sides) {
    core::parallel_each(cells.count(), cells_a_chunk, [&](std::size_t cell) {
        for (const core::Tet& tet : cells.tets(cell))
            for (const std::uint64_t point : tet) sides.saw(point);
    });
}

std::uint64_t count_cut_tets(const CellReader& cells, const Sides& sides) {
    std::atomic<std::uint64_t> total{0};
    core::parallel_ranges(cells.count(), cells_a_chunk, [&](std::size_t begin, std::size_t end) {
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

} // namespace isotet::cpu
