// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/tet_survey.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/cell/splitter.hpp"
#include "grid/cell_survey.hpp"
#include "grid/orientation.hpp"
#include "numbers/bounds.hpp"
#include "numbers/box_sign.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_per_chunk = 1 << 14;

/// Counts of some cells.
struct Partial {
    std::uint64_t tets = 0, collapsed = 0, mirrored = 0;
    std::array<std::uint64_t, 256> by_type{};
    Orienter::Counts orientation;
};

/// Marks points as used.
class Marker {
public:
    explicit Marker(Buffer<std::uint8_t>& used) : used_(used.data()) {}

    void mark(std::uint64_t point) const {
        std::atomic_ref(used_[point]).store(std::uint8_t{1}, std::memory_order_relaxed);
    }

private:
    std::uint8_t* used_;
};

void add_tets(const CellReader& cells, const PointReader& points, std::size_t begin, std::size_t end,
              const Marker& used, Partial& out) {
    cells.for_cells(begin, end, [&](std::size_t, const CellTets& tets) {
        out.tets += static_cast<std::uint64_t>(tets.count);
        out.collapsed += static_cast<std::uint64_t>(tets.collapsed);
        for (const Tet& tet : tets) {
            for (const std::uint64_t corner : tet) used.mark(corner);
            const int sign = points.orientation(tet);
            out.orientation.add(sign, true, false);
            out.mirrored += sign < 0;
        }
    });
    out.by_type[static_cast<std::uint8_t>(CellType::tetrahedron)] += end - begin;
}

bool has_equal(const Tet& t) {
    return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

/// The tets of a cell by positions of corners, those with repeated corners too.
struct PositionList {
    std::array<std::array<std::uint8_t, 4>, 6> tets;
    std::size_t count = 0;

    void expect(int) {}
    void add(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) { tets[count++] = {a, b, c, d}; }
};

template <class Points, class Marks>
void add_cell(const WholeCell& cell, std::uint8_t type, const Points& points, Marks&& used, Partial& out) {
    PositionList positions;
    Splitter(cell.corners.data(), positions).split(cell.kind);
    const bool repeated = has_repeated_corner(cell);
    std::array<Point, 8> places;
    for (std::size_t k = 0; k < corner_count(cell.kind); ++k) {
        places[k] = points[cell.corners[k]];
        if (!repeated) used.mark(cell.corners[k]);
    }
    if (cell.kind == CellKind::hexahedron) { // where it tells, no two corners are one
        const int sign = sign_of_all_tets(places);
        if (sign != 0) out.tets += positions.count;
        if (sign < 0) out.mirrored += positions.count;
        if (sign != 0) return;
    }
    std::array<int, 6> signs;
    std::size_t count = 0;
    double volumes = 0;
    for (std::size_t i = 0; i < positions.count; ++i) {
        const auto [a, b, c, d] = positions.tets[i];
        if (repeated) {
            const Tet tet{cell.corners[a], cell.corners[b], cell.corners[c], cell.corners[d]};
            if (has_equal(tet)) {
                ++out.collapsed;
                continue;
            }
            for (const std::uint64_t corner : tet) used.mark(corner);
        }
        signs[count++] = orientation_sign(places[a], places[b], places[c], places[d]);
        volumes += six_volumes(places[a], places[b], places[c], places[d]);
    }
    const bool whole = Orienter::is_whole(type), ordered = is_ordered(type);
    const bool mirrored = !whole && !ordered && volumes < 0;
    for (std::size_t i = 0; i < count; ++i) {
        out.orientation.add(signs[i], whole, mirrored);
        out.mirrored += !ordered && signs[i] < 0;
    }
    out.tets += count;
}

void add_cells(const CellReader& cells, const PointReader& points, std::size_t begin, std::size_t end,
               const Marker& used, Partial& out) {
    if (cells.only_tets()) return add_tets(cells, points, begin, end, used, out);
    for (std::size_t cell = begin; cell < end; ++cell) {
        const std::uint8_t type = cells.type(cell);
        ++out.by_type[type];
        if (is_contoured(type)) add_cell(cells.whole(cell), type, points, used, out);
    }
}

/// Corners of MadeCells: points, and places of the cells' own.
class MadeCorners {
public:
    MadeCorners(const PointReader& points, const Marker& used, std::span<const Point> places)
        : points_(points), used_points_(used), places_(places), used_(places.size()) {}

    Point operator[](std::uint64_t corner) const {
        return corner & MadeCells::made_bit ? places_[corner - MadeCells::made_bit] : points_[corner];
    }
    void mark(std::uint64_t corner) {
        if (corner & MadeCells::made_bit) used_[corner - MadeCells::made_bit] = 1;
        else used_points_.mark(corner);
    }

    /// The box around places that are used, and how many are not.
    std::uint64_t unused(Bounds& bounds) const {
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < used_.size(); ++i)
            if (used_[i] != 0) bounds.add(places_[i]);
            else ++count;
        return count;
    }

private:
    const PointReader& points_;
    const Marker& used_points_;
    std::span<const Point> places_;
    std::vector<std::uint8_t> used_;
};

/// Bounds of the used points, and how many are not.
struct UsedPoints {
    Bounds bounds;
    std::uint64_t unused = 0;
};

UsedPoints look_at_used(const PointReader& points, const Buffer<std::uint8_t>& used, const Progress& progress) {
    UsedPoints total;
    std::mutex mutex;
    parallel_pieces(used.size(), 1 << 16, progress, [&](std::size_t begin, std::size_t end) {
        UsedPoints part;
        for (std::size_t i = begin; i < end; ++i) {
            part.unused += !used[i];
            if (used[i]) part.bounds.add(points[i]);
        }
        const std::lock_guard lock(mutex);
        total.bounds.combine(part.bounds);
        total.unused += part.unused;
    });
    return total;
}

void add_to(TetSurvey& survey, const Partial& part) {
    survey.tets += part.tets;
    survey.collapsed += part.collapsed;
    survey.mirrored += part.mirrored;
    survey.orientation.combine(part.orientation);
    for (std::size_t type = 0; type < part.by_type.size(); ++type) survey.cells_by_type[type] += part.by_type[type];
}

void clear(Buffer<std::uint8_t>& flags) {
    parallel_ranges(flags.size(), 1 << 18,
                    [&](std::size_t begin, std::size_t end) { std::fill_n(flags.data() + begin, end - begin, 0); });
}

} // namespace

TetSurveyor::TetSurveyor(const Array& points) : points_(points) {
    survey_.used = Buffer<std::uint8_t>(points.tuples());
    clear(survey_.used);
}

void TetSurveyor::add(const CellReader& cells, std::size_t begin, std::size_t end) {
    Partial part;
    add_cells(cells, points_, begin, end, Marker(survey_.used), part);
    const std::lock_guard lock(mutex_);
    add_to(survey_, part);
}

void TetSurveyor::add(const MadeCells& cells) {
    Partial part;
    const Marker used(survey_.used);
    MadeCorners corners(points_, used, cells.places);
    const std::uint64_t* corner = cells.corners.data();
    for (std::size_t i = 0; i < cells.types.size(); ++i) {
        const std::uint8_t type = cells.types[i];
        ++part.by_type[type];
        if (const auto kind = kind_of(type)) {
            WholeCell cell;
            cell.kind = *kind;
            std::copy_n(corner, corner_count(*kind), cell.corners.begin());
            order_as_kind(type, cell.corners);
            add_cell(cell, type, corners, corners, part);
        }
        corner += cells.counts[i];
    }
    Bounds bounds;
    const std::uint64_t unused = corners.unused(bounds);
    const std::lock_guard lock(mutex_);
    add_to(survey_, part);
    survey_.unused += unused;
    made_.combine(bounds);
}

TetSurvey TetSurveyor::finish(const Progress& progress) && {
    for (std::size_t type = 0; type < survey_.cells_by_type.size(); ++type)
        if (!is_contoured(static_cast<std::uint8_t>(type))) survey_.left_out += survey_.cells_by_type[type];
    UsedPoints of_used = look_at_used(points_, survey_.used, progress);
    of_used.bounds.combine(made_);
    survey_.unused += of_used.unused;
    if (survey_.tets) {
        survey_.lower = of_used.bounds.lower;
        survey_.upper = of_used.bounds.upper;
    }
    return std::move(survey_);
}

TetSurvey survey_tets(const Grid& grid, const CellReader& cells, const Progress& progress) {
    TetSurveyor surveyor(grid.points);
    parallel_pieces(cells.count(), cells_per_chunk, progress,
                    [&](std::size_t begin, std::size_t end) { surveyor.add(cells, begin, end); });
    return std::move(surveyor).finish(progress);
}

namespace {

/// `count_range(begin, end, counts, mark)` adds to counts, and calls mark(corner) for the corners of what is stored.
template <class CountRange>
CellCounts count_all(const CellReader& cells, const CountRange& count_range) {
    CellCounts total;
    total.used = Buffer<std::uint8_t>(cells.points());
    clear(total.used);
    std::mutex mutex;
    parallel_ranges(cells.count(), cells_per_chunk, [&](std::size_t begin, std::size_t end) {
        CellCounts part;
        count_range(begin, end, part, [&](std::uint64_t corner) {
            std::atomic_ref<std::uint8_t>(total.used[corner]).store(1, std::memory_order_relaxed);
        });
        const std::lock_guard lock(mutex);
        total.stored += part.stored;
        total.collapsed += part.collapsed;
        total.left_out += part.left_out;
        total.split += part.split;
    });
    return total;
}

} // namespace

CellCounts count_tets(const CellReader& cells) {
    return count_all(cells, [&](std::size_t begin, std::size_t end, CellCounts& counts, const auto& mark) {
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            counts.stored += static_cast<std::uint64_t>(pieces.count);
            counts.collapsed += static_cast<std::uint64_t>(pieces.collapsed);
            counts.left_out += !cells.only_tets() && !is_contoured(cells.type(cell));
            for (const Tet& tet : pieces)
                for (const std::uint64_t corner : tet) mark(corner);
        });
    });
}

CellCounts count_native_cells(const CellReader& cells) {
    return count_all(cells, [&](std::size_t begin, std::size_t end, CellCounts& counts, const auto& mark) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (!is_contoured(cells.type(cell))) {
                ++counts.left_out;
                continue;
            }
            const NativeParts parts = native_parts(cells.whole(cell));
            counts.stored += static_cast<std::uint64_t>(parts.count);
            counts.collapsed += static_cast<std::uint64_t>(parts.collapsed);
            counts.split += parts.is_split;
            for (const WholeCell& part : parts)
                for (std::size_t k = 0; k < corner_count(part.kind); ++k) mark(part.corners[k]);
        }
    });
}

} // namespace isotet::core
