// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/listed_cells.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "linear/hanging/cell_loops.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t cells_per_part = 1 << 13;

class CellLister {
public:
    CellLister(const core::CellReader& cells, const core::FaceReader& faces, const OpenFaces& open,
               const Covers& covers)
        : cells_(cells), faces_(faces), open_(open), covers_(covers), ends_(cells.points()) {
        std::ranges::fill(ends_, std::uint8_t{0});
        for (std::size_t i = 0; i < covers.edges.size(); ++i) {
            ends_[covers.edges[i].low] |= lower_end;
            ends_[covers.edges[i].high] |= upper_end;
        }
    }

    std::vector<ListedCell> list(const Progress& progress) {
        std::vector<ListedCell> out;
        std::mutex mutex;
        core::parallel_pieces(cells_.count(), cells_per_part, progress, [&](std::size_t begin, std::size_t end) {
            CellLoops loops(cells_, faces_);
            std::vector<ListedCell> part;
            ListedCell listed{};
            FaceEdges edges;
            auto cover = first_cover(begin);
            for (std::size_t cell = begin; cell < end; ++cell) {
                const auto covers = cover;
                while (cover != covers_.whole.end() && open_.place(cover->face).cell == cell) ++cover;
                if (covers == cover && !may_have_split_edge(cell)) continue;
                if (!loops.read(cell) || (covers == cover && !has_split_edge(loops))) continue;
                listed.cell = cell;
                list_faces(loops, covers, listed);
                if (!edges.find_points(listed)) continue;
                part.push_back(listed);
            }
            const std::lock_guard lock(mutex);
            std::ranges::move(part, std::back_inserter(out));
        });
        tbb::parallel_sort(out.begin(), out.end(),
                           [](const ListedCell& a, const ListedCell& b) { return a.cell < b.cell; });
        return out;
    }

private:
    using CoverPlace = std::vector<Cover>::const_iterator;

    CoverPlace first_cover(std::size_t cell) const {
        return std::ranges::lower_bound(covers_.whole, cell, {},
                                        [&](const Cover& cover) { return open_.place(cover.face).cell; });
    }

    /// One of its points has to be the lower end of one, another the upper end.
    bool may_have_split_edge(std::size_t cell) const {
        const std::uint64_t first = cells_.first(cell), end = first + cells_.corners(cell);
        std::uint8_t ends = 0;
        for (std::uint64_t i = first; i < end; ++i)
            if (const std::uint64_t point = cells_.corner(i); point < ends_.size()) ends |= ends_[point];
        return ends == (lower_end | upper_end);
    }

    bool has_split_edge(const CellLoops& loops) const {
        for (std::size_t face = 0; face < loops.count(); ++face) {
            std::uint64_t before = loops.loop(face).back();
            for (const std::uint64_t point : loops.loop(face)) {
                if (covers_.edges.is_split(before, point)) return true;
                before = point;
            }
        }
        return false;
    }

    void add_loop(std::span<const std::uint64_t> loop, ListedCell& out) const {
        const std::size_t at = begin_face(out);
        covers_.edges.expand(loop, out.faces);
        end_face(at, loop, out);
    }

    /// `cover`   the first one of the cell, or of one behind it
    void list_faces(const CellLoops& loops, CoverPlace cover, ListedCell& out) const {
        out.faces.assign(1, 0);
        for (std::size_t face = 0; face < loops.count(); ++face) {
            const OpenFaces::Place place{out.cell, static_cast<std::uint32_t>(face)};
            if (cover == covers_.whole.end() || open_.place(cover->face) != place) {
                add_loop(loops.loop(face), out);
                continue;
            }
            for (const Cover::Part& part : cover->by) add_loop(open_.loop(part.face), out);
            ++cover;
        }
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const OpenFaces& open_;
    const Covers& covers_;

    static constexpr std::uint8_t lower_end = 1, upper_end = 2;
    core::Buffer<std::uint8_t> ends_; ///< by point: of edges with points on them
};

/// Cells one after another, listed ones in place of the grid's.
template <class Index>
class CellWriter {
public:
    CellWriter(const core::CellReader& cells, const core::FaceReader& faces, const std::vector<ListedCell>& listed)
        : cells_(cells),
          faces_(faces),
          listed_(listed),
          offsets_(cells.count() + 1),
          face_offsets_(cells.count() + 1) {}

    Cells write(const Progress& progress) {
        core::Buffer<std::uint8_t> types(cells_.count());
        count(types, progress);
        core::Buffer<Index> connectivity(static_cast<std::size_t>(offsets_[cells_.count()]));
        core::Buffer<Index> stream(static_cast<std::size_t>(face_offsets_[cells_.count()]));
        core::parallel_pieces(cells_.count(), cells_per_part, progress, [&](std::size_t begin, std::size_t end) {
            auto next = first_listed(begin);
            for (std::size_t cell = begin; cell < end; ++cell) {
                Index* corner = connectivity.data() + offsets_[cell];
                Index* face = stream.data() + face_offsets_[cell];
                if (next != listed_.end() && next->cell == cell) {
                    for (const std::uint64_t point : next->points) *corner++ = static_cast<Index>(point);
                    for (const std::uint64_t entry : next->faces) *face++ = static_cast<Index>(entry);
                    ++next;
                    continue;
                }
                const std::uint64_t first = cells_.first(cell), corners = cells_.corners(cell);
                for (std::uint64_t i = 0; i < corners; ++i) *corner++ = static_cast<Index>(cells_.corner(first + i));
                for (std::uint64_t i = faces_.begin(cell); i < faces_.end(cell); ++i)
                    *face++ = static_cast<Index>(faces_.at(i));
            }
        });
        Cells out;
        out.connectivity = std::move(connectivity).to_array();
        out.offsets = std::move(offsets_).to_array();
        out.types = std::move(types).to_array();
        out.faces = std::move(stream).to_array();
        out.face_offsets = std::move(face_offsets_).to_array();
        return out;
    }

private:
    auto first_listed(std::size_t cell) const { return std::ranges::lower_bound(listed_, cell, {}, &ListedCell::cell); }

    void count(core::Buffer<std::uint8_t>& types, const Progress& progress) {
        core::parallel_pieces(cells_.count(), cells_per_part, progress, [&](std::size_t begin, std::size_t end) {
            auto next = first_listed(begin);
            for (std::size_t cell = begin; cell < end; ++cell) {
                const bool listed = next != listed_.end() && next->cell == cell;
                types[cell] = listed ? core::polyhedron_type : cells_.type(cell);
                offsets_[cell + 1] = static_cast<Index>(listed ? next->points.size() : cells_.corners(cell));
                face_offsets_[cell + 1] =
                    static_cast<Index>(listed ? next->faces.size() : faces_.end(cell) - faces_.begin(cell));
                next += listed;
            }
        });
        offsets_[0] = face_offsets_[0] = 0;
        for (std::size_t cell = 0; cell < cells_.count(); ++cell) {
            offsets_[cell + 1] += offsets_[cell];
            face_offsets_[cell + 1] += face_offsets_[cell];
        }
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const std::vector<ListedCell>& listed_;
    core::Buffer<Index> offsets_, face_offsets_;
};

} // namespace

std::size_t begin_face(ListedCell& cell) {
    cell.faces.push_back(0);
    return cell.faces.size() - 1;
}

void end_face(std::size_t at, std::span<const std::uint64_t> loop, ListedCell& cell) {
    const std::size_t count = cell.faces[at] = cell.faces.size() - at - 1;
    ++cell.faces[0];
    if (loop.size() != 3 || count != 4) return;
    const std::array<std::uint64_t, 4> all{cell.faces[at + 1], cell.faces[at + 2], cell.faces[at + 3],
                                           cell.faces[at + 4]};
    const auto is_corner = [&](std::uint64_t point) { return std::ranges::find(loop, point) != loop.end(); };
    const auto between = static_cast<std::size_t>(std::ranges::find_if_not(all, is_corner) - all.begin());
    const auto around = [&](std::size_t i) { return all[(between + i) % 4]; };
    cell.faces.resize(at);
    cell.faces.insert(cell.faces.end(), {3, around(0), around(1), around(2), 3, around(0), around(2), around(3)});
    ++cell.faces[0];
}

bool FaceEdges::find_points(ListedCell& cell) {
    const std::vector<std::uint64_t>& faces = cell.faces;
    edges_.clear();
    for (std::size_t at = 1; at < faces.size(); at += faces[at] + 1) {
        std::uint64_t before = faces[at + faces[at]];
        for (std::size_t i = 1; i <= faces[at]; ++i) {
            const std::uint64_t point = faces[at + i];
            edges_.push_back({std::min(before, point), std::max(before, point)});
            before = point;
        }
    }
    std::ranges::sort(edges_);
    for (std::size_t i = 0; i < edges_.size(); i += 2)
        if (i + 1 == edges_.size() || edges_[i] != edges_[i + 1] ||
            (i + 2 < edges_.size() && edges_[i] == edges_[i + 2]))
            return false;
    std::vector<std::uint64_t>& points = cell.points;
    points.clear();
    for (std::size_t i = 0; i < edges_.size(); i += 2) {
        if (i == 0 || edges_[i].low != edges_[i - 2].low) points.push_back(edges_[i].low);
        points.push_back(edges_[i].high);
    }
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return true;
}

std::vector<ListedCell> list_cells(const core::CellReader& cells, const core::FaceReader& faces, const OpenFaces& open,
                                   const Covers& covers, const Progress& progress) {
    return CellLister(cells, faces, open, covers).list(progress);
}

Result<Cells> with_listed_cells(const core::CellReader& cells, const core::FaceReader& faces,
                                const std::vector<ListedCell>& listed, const Progress& progress) {
    std::uint64_t more = 0;
    for (const ListedCell& cell : listed) more += 2 * cell.faces.size();
    const std::uint64_t entries = cells.connectivity_size() + faces.size() + more;
    constexpr std::uint64_t narrow = std::numeric_limits<std::int32_t>::max();
    const bool wide = entries > narrow || cells.points() > narrow;
    const std::uint64_t bytes = (wide ? 8 : 4) * (entries + 2 * cells.count()) + cells.count();
    if (auto fits = core::require_memory("listing hanging points", bytes); !fits) return fits.error();
    Cells out = wide ? CellWriter<std::int64_t>(cells, faces, listed).write(progress)
                     : CellWriter<std::int32_t>(cells, faces, listed).write(progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    return out;
}

} // namespace isotet::linear
