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
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "linear/hanging/cell_loops.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t cells_per_part = 1 << 13;

/// The points of a polyhedron, ascending, each once.
std::vector<std::uint64_t> points_of(const std::vector<std::uint64_t>& faces) {
    std::vector<std::uint64_t> out;
    for (std::size_t at = 1; at < faces.size(); at += faces[at] + 1)
        out.insert(out.end(), faces.begin() + static_cast<std::ptrdiff_t>(at + 1),
                   faces.begin() + static_cast<std::ptrdiff_t>(at + 1 + faces[at]));
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

class CellLister {
public:
    CellLister(const core::CellReader& cells, const core::FaceReader& faces, const OpenFaces& open,
               const Covers& covers)
        : cells_(cells), faces_(faces), open_(open), covers_(covers), marked_(cells.points()) {
        std::ranges::fill(marked_, std::uint8_t{0});
        for (const Cover& cover : covers.whole)
            for (const std::uint64_t point : open.loop(cover.face)) marked_[point] = 1;
        for (const PointOnEdge& at : covers.edges.all()) marked_[at.low] = marked_[at.high] = 1;
    }

    std::vector<ListedCell> list(const Progress& progress) {
        std::vector<ListedCell> out;
        std::mutex mutex;
        core::parallel_pieces(cells_.count(), cells_per_part, progress, [&](std::size_t begin, std::size_t end) {
            CellLoops loops(cells_, faces_);
            std::vector<ListedCell> part;
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (!has_marked_edge(cell)) continue;
                ListedCell listed{cell, {}, {}};
                if (!loops.read(cell) || !list_faces(loops, listed) || !closes(listed.faces)) continue;
                listed.points = points_of(listed.faces);
                part.push_back(std::move(listed));
            }
            const std::lock_guard lock(mutex);
            std::ranges::move(part, std::back_inserter(out));
        });
        tbb::parallel_sort(out.begin(), out.end(),
                           [](const ListedCell& a, const ListedCell& b) { return a.cell < b.cell; });
        return out;
    }

private:
    /// Two of its points have to be ends of one.
    bool has_marked_edge(std::size_t cell) const {
        const std::uint64_t first = cells_.first(cell), corners = cells_.corners(cell);
        int count = 0;
        for (std::uint64_t i = 0; i < corners && count < 2; ++i)
            if (const std::uint64_t point = cells_.corner(first + i); point < marked_.size()) count += marked_[point];
        return count >= 2;
    }

    const Cover* cover_of(std::size_t cell, std::size_t face) const {
        const OpenFaces::Place place{cell, static_cast<std::uint32_t>(face)};
        const auto at = std::ranges::lower_bound(covers_.whole, place, {},
                                                 [&](const Cover& cover) { return open_.place(cover.face); });
        return at != covers_.whole.end() && open_.place(at->face) == place ? &*at : nullptr;
    }

    /// A triangle with one point on an edge becomes two triangles: as a quadrilateral it would have three corners on a
    /// line.
    void add_loop(std::span<const std::uint64_t> loop, ListedCell& out) const {
        const std::size_t at = out.faces.size();
        out.faces.push_back(0);
        covers_.edges.expand(loop, out.faces);
        const std::size_t count = out.faces[at] = out.faces.size() - at - 1;
        ++out.faces[0];
        if (loop.size() != 3 || count != 4) return;
        const std::array<std::uint64_t, 4> all{out.faces[at + 1], out.faces[at + 2], out.faces[at + 3],
                                               out.faces[at + 4]};
        const auto is_corner = [&](std::uint64_t point) { return std::ranges::find(loop, point) != loop.end(); };
        const auto between = static_cast<std::size_t>(std::ranges::find_if_not(all, is_corner) - all.begin());
        const auto around = [&](std::size_t i) { return all[(between + i) % 4]; };
        out.faces.resize(at);
        out.faces.insert(out.faces.end(), {3, around(0), around(1), around(2), 3, around(0), around(2), around(3)});
        ++out.faces[0];
    }

    /// False when the cell has no hanging points.
    bool list_faces(const CellLoops& loops, ListedCell& out) const {
        out.faces.assign(1, 0);
        for (std::size_t face = 0; face < loops.count(); ++face) {
            if (const Cover* cover = cover_of(out.cell, face))
                for (const std::uint32_t other : cover->by) add_loop(open_.loop(other), out);
            else add_loop(loops.loop(face), out);
        }
        return out.faces.size() > 1 + loops.count() + loops.all().size();
    }

    /// Whether each edge is in two faces.
    static bool closes(const std::vector<std::uint64_t>& faces) {
        std::vector<std::pair<std::uint64_t, std::uint64_t>> edges;
        for (std::size_t at = 1; at < faces.size(); at += faces[at] + 1)
            for (std::size_t i = 0; i < faces[at]; ++i) {
                const auto [low, high] = std::minmax(faces[at + 1 + i], faces[at + 1 + (i + 1) % faces[at]]);
                edges.emplace_back(low, high);
            }
        std::ranges::sort(edges);
        for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
            end = begin;
            while (end < edges.size() && edges[end] == edges[begin]) ++end;
            if (end - begin != 2) return false;
        }
        return true;
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const OpenFaces& open_;
    const Covers& covers_;
    core::Buffer<std::uint8_t> marked_; ///< corners of covered faces, ends of edges with points on them
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
                offsets_[cell + 1] =
                    static_cast<Index>(listed ? next->points.size() : cells_.corners(cell));
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

std::vector<ListedCell> list_cells(const core::CellReader& cells, const core::FaceReader& faces,
                                   const OpenFaces& open, const Covers& covers, const Progress& progress) {
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
