// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/amr/shown_cells.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"

namespace isotet::io::amr {
namespace {

std::optional<CellBox> common_cells(const CellBox& a, const CellBox& b) {
    CellBox out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.first[axis] = std::max(a.first[axis], b.first[axis]);
        out.last[axis] = std::min(a.last[axis], b.last[axis]);
        if (out.first[axis] > out.last[axis]) return std::nullopt;
    }
    return out;
}

/// A level's boxes with their marks, and which of them meet a range along x.
class LevelBoxes {
public:
    LevelBoxes(const std::vector<CellBox>& boxes, std::span<Marks> marks) : boxes_(boxes), marks_(marks) {
        for (std::size_t box = 0; box < boxes.size(); ++box) {
            by_x_.push_back(box);
            longest_ = std::max(longest_, boxes[box].last[0] - boxes[box].first[0]);
        }
        std::ranges::sort(by_x_, {}, [&](std::size_t box) { return boxes_[box].first[0]; });
    }

    std::size_t size() const { return boxes_.size(); }
    const CellBox& box(std::size_t number) const { return boxes_[number]; }
    Marks& marks(std::size_t number) const { return marks_[number]; }

    /// Calls visit(number, common cells) for each box that has cells of this level in common with `other`.
    template <class Visit>
    void each_meeting(const CellBox& other, const Visit& visit) const {
        const auto first_x = [&](std::size_t box) { return boxes_[box].first[0]; };
        auto at = std::ranges::lower_bound(by_x_, other.first[0] - longest_, {}, first_x);
        for (; at != by_x_.end() && first_x(*at) <= other.last[0]; ++at)
            if (const auto common = common_cells(boxes_[*at], other)) visit(*at, *common);
    }

private:
    const std::vector<CellBox>& boxes_;
    std::span<Marks> marks_;
    std::vector<std::size_t> by_x_;
    std::int64_t longest_ = 0;
};

template <class Visit>
void each_cell(const CellBox& box, const Visit& visit) {
    Place cell;
    for (cell[2] = box.first[2]; cell[2] <= box.last[2]; ++cell[2])
        for (cell[1] = box.first[1]; cell[1] <= box.last[1]; ++cell[1])
            for (cell[0] = box.first[0]; cell[0] <= box.last[0]; ++cell[0]) visit(cell);
}

/// Rounded down, also below 0.
std::int64_t divided(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

std::string text_of(const Place& cell) { return fmt::format("({}, {}, {})", cell[0], cell[1], cell[2]); }

class CoverMarker {
public:
    CoverMarker(const Hierarchy& hierarchy, const Lattice& lattice, std::vector<Marks>& marks) : lattice_(lattice) {
        std::size_t first = 0;
        for (const Level& level : hierarchy.levels) {
            levels_.emplace_back(level.boxes, std::span(marks).subspan(first, level.boxes.size()));
            first += level.boxes.size();
        }
    }

    Result<void> mark_all(const Progress& progress) {
        for (std::size_t level = levels_.size(); level-- > 0;) {
            FirstError failed;
            core::parallel_each(levels_[level].size(), 1, [&](std::size_t box) {
                if (progress.cancelled() || failed) return;
                if (auto done = mark_under_finer(level, box); !done) failed.add(box, done.error());
            });
            if (auto done = failed.result(); !done) return done;
            if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
            mark_repeated(levels_[level]);
            if (auto nested = check_nested(level); !nested) return nested;
        }
        return {};
    }

private:
    /// The cells of another level that cells of a box have room for, or lie in.
    CellBox on_level(std::size_t from, const CellBox& box, std::size_t to) const {
        CellBox out;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.first[axis] = divided(box.first[axis] * lattice_.steps(from, axis), lattice_.steps(to, axis));
            out.last[axis] = divided((box.last[axis] + 1) * lattice_.steps(from, axis) - 1, lattice_.steps(to, axis));
        }
        return out;
    }

    Result<void> mark_under_finer(std::size_t level, std::size_t number) const {
        const CellBox& box = levels_[level].box(number);
        Marks& marks = levels_[level].marks(number);
        marks.resize(box.cells());
        const std::uint64_t whole = lattice_.volume(level);
        std::vector<std::uint64_t> covered;
        for (std::size_t finer = level + 1; finer < levels_.size(); ++finer)
            levels_[finer].each_meeting(on_level(level, box, finer), [&](std::size_t other, const CellBox& common) {
                covered.resize(box.cells());
                const CellBox& fine = levels_[finer].box(other);
                const Marks& hidden = levels_[finer].marks(other);
                each_cell(common, [&](const Place& cell) {
                    if (hidden[fine.cell_at(cell)] == 0)
                        covered[box.cell_at(on_level(finer, {cell, cell}, level).first)] += lattice_.volume(finer);
                });
            });
        if (covered.empty()) return {};
        std::optional<Place> in_part;
        each_cell(box, [&](const Place& cell) {
            const std::size_t at = box.cell_at(cell);
            if (covered[at] != 0 && covered[at] != whole && marks[at] == 0 && !in_part) in_part = cell;
            if (covered[at] != 0) marks[at] = 1;
        });
        if (in_part)
            return invalid_data(
                fmt::format("cell {} of level {} is covered by cells of finer levels in part: their boxes "
                            "must end where cells of this level do",
                            text_of(*in_part), level));
        return {};
    }

    static void mark_repeated(const LevelBoxes& level) {
        for (std::size_t number = 0; number < level.size(); ++number)
            level.each_meeting(level.box(number), [&](std::size_t earlier, const CellBox& common) {
                if (earlier >= number) return;
                each_cell(common, [&](const Place& cell) {
                    if (level.marks(earlier)[level.box(earlier).cell_at(cell)] == 0)
                        level.marks(number)[level.box(number).cell_at(cell)] = 1;
                });
            });
    }

    /// Cells that are shown lie in boxes of the next coarser level that has some.
    Result<void> check_nested(std::size_t level) const {
        std::size_t coarser = level;
        while (coarser > 0 && levels_[coarser - 1].size() == 0) --coarser;
        if (coarser-- == 0) return {};
        for (std::size_t number = 0; number < levels_[level].size(); ++number) {
            const CellBox& box = levels_[level].box(number);
            Marks free = levels_[level].marks(number);
            for (std::uint8_t& mark : free) mark = mark == 0;
            levels_[coarser].each_meeting(on_level(level, box, coarser), [&](std::size_t, const CellBox& common) {
                if (const auto inside = common_cells(on_level(coarser, common, level), box))
                    each_cell(*inside, [&](const Place& cell) { free[box.cell_at(cell)] = 0; });
            });
            if (std::ranges::find(free, std::uint8_t{1}) != free.end())
                return invalid_data(
                    fmt::format("box {} of level {}, from cell {} to {}, reaches out of the boxes of level "
                                "{}: boxes must lie within those of the next coarser level",
                                number, level, text_of(box.first), text_of(box.last), coarser));
        }
        return {};
    }

    const Lattice& lattice_;
    std::vector<LevelBoxes> levels_;
};

} // namespace

Result<void> mark_covered(const Hierarchy& hierarchy, const Lattice& lattice, std::vector<Marks>& marks,
                          const Progress& progress) {
    return CoverMarker(hierarchy, lattice, marks).mark_all(progress);
}

} // namespace isotet::io::amr
