// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/cut_cells.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <span>

#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"
#include "numbers/storage.hpp"
#include "solid/piece_table.hpp"

namespace isotet::solid {

namespace {

constexpr std::size_t points_at_once = 1 << 15;

/// Bytes that several threads set to 1.
void mark(core::Buffer<std::uint8_t>& marks, std::uint64_t at) {
    std::atomic_ref<std::uint8_t> one(marks[at]);
    if (!one.load(std::memory_order_relaxed)) one.store(1, std::memory_order_relaxed);
}

core::Buffer<std::uint8_t> cleared(std::size_t size) {
    core::Buffer<std::uint8_t> out(size);
    core::parallel_ranges(size, points_at_once, [&](std::size_t begin, std::size_t end) {
        std::fill(out.begin() + begin, out.begin() + end, std::uint8_t{0});
    });
    return out;
}

std::array<std::uint8_t, 8> same_corners(const core::WholeCell& cell) {
    std::array<std::uint8_t, 8> same{};
    for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k)
        same[k] = static_cast<std::uint8_t>(std::ranges::find(cell.corners, cell.corners[k]) - cell.corners.begin());
    return same;
}

/// Of a cell with repeated corners, beside the flags of its points.
constexpr std::uint8_t irregular_flag = 0x20;

constexpr bool is_all_outside(std::uint8_t flags) {
    constexpr std::uint8_t both = point_flag::below | point_flag::above;
    return (flags & point_flag::no_data) || (!(flags & point_flag::inside) && (flags & both) != both);
}

constexpr bool is_all_inside(std::uint8_t flags) {
    constexpr std::uint8_t other = point_flag::below | point_flag::above | point_flag::no_data;
    return !(flags & other);
}

/// Cuts the cells of one block.
class BlockCutter {
public:
    BlockCutter(const CutInput& input, CutCells& out, BlockPieces& pieces)
        : input_(input), cells_(input.cells), points_(input.grid.points), out_(out), pieces_(pieces) {}

    void cut(std::size_t begin, std::size_t end) {
        first_cell_ = begin;
        start_warped(begin);
        const std::size_t count = end - begin;
        std::array<std::uint8_t, clip_block> flags;
        combine_flags(begin, end, flags.data());
        std::array<std::uint16_t, clip_block> looked_at; // all others are outside, or whole without ties
        const std::size_t looks = classify(count, flags.data(), out_.is_whole.data() + begin, looked_at.data());
        reserve(looks);
        for (const std::uint16_t i : std::span(looked_at).first(looks)) {
            const auto of_corners = static_cast<std::uint8_t>(flags[i] & ~irregular_flag);
            if (flags[i] & irregular_flag) add_irregular(begin + i, of_corners);
            else add(begin + i, of_corners);
        }
    }

    bool saw_warped() const { return saw_warped_; }

private:
    using Ids = std::array<std::uint32_t, 192>; ///< places, by code of a vertex

    /// Those of the corners of each cell, and of irregular ones; what is not contoured has no data.
    void combine_flags(std::size_t begin, std::size_t end, std::uint8_t* flags) const {
        const std::uint8_t* const of_points = input_.flags.data();
        cells_.connectivity().visit([&](const auto* connectivity) {
            const auto combined = [&](const auto* numbers, std::size_t corners) {
                std::uint8_t all = 0;
                for (std::size_t k = 0; k < corners; ++k) all |= of_points[core::widened(numbers[k])];
                return all;
            };
            const bool is_uniform =
                !cells_.has_types() && !cells_.has_offsets() && core::is_contoured(cells_.type(begin));
            const std::size_t each = is_uniform ? cells_.corners(begin) : 0;
            const auto* const first = connectivity + cells_.first(begin);
            if (each == 4) // known counts are unrolled
                for (std::size_t i = 0; i < end - begin; ++i) flags[i] = combined(first + 4 * i, 4);
            else if (each == 8)
                for (std::size_t i = 0; i < end - begin; ++i) flags[i] = combined(first + 8 * i, 8);
            else
                for (std::size_t cell = begin; cell < end; ++cell)
                    flags[cell - begin] = core::is_contoured(cells_.type(cell))
                                              ? combined(connectivity + cells_.first(cell), cells_.corners(cell))
                                              : point_flag::no_data;
        });
        const auto& irregular = input_.facts.irregular;
        for (auto next = std::ranges::lower_bound(irregular, begin); next != irregular.end() && *next < end; ++next)
            flags[*next - begin] |= irregular_flag;
    }

    /// Sets and counts the whole cells that nothing more is to be known of; writes the numbers in the block of all that
    /// need a look. Returns how many these are.
    std::size_t classify(std::size_t count, const std::uint8_t* flags, std::uint8_t* is_whole,
                         std::uint16_t* looked_at) {
        static constexpr std::array<std::uint8_t, 64> needs_look = [] {
            std::array<std::uint8_t, 64> out{};
            for (std::uint8_t all = 0; all < 64; ++all)
                out[all] = (all & irregular_flag) || (!is_all_outside(all) && all != point_flag::inside);
            return out;
        }();
        std::size_t looks = 0, whole = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_plain = flags[i] == point_flag::inside;
            is_whole[i] = is_plain;
            whole += is_plain;
            looked_at[looks] = static_cast<std::uint16_t>(i);
            looks += needs_look[flags[i]];
        }
        pieces_.whole_cells += whole;
        if (!cells_.has_offsets()) pieces_.whole_corners += whole * cells_.corners(first_cell_);
        else
            for (std::size_t i = 0; i < count; ++i)
                if (is_whole[i]) pieces_.whole_corners += cells_.corners(first_cell_ + i);
        return looks;
    }

    /// Room for what most cells that are cut become: one piece, of polyhedra its faces, too.
    void reserve(std::size_t cells) {
        pieces_.cells.reserve(cells);
        pieces_.types.reserve(cells);
        pieces_.sizes.reserve(cells);
        pieces_.face_entries.reserve(cells);
        pieces_.corners.reserve(6 * cells);
    }

    void add(std::size_t cell, std::uint8_t flags) {
        if (is_all_outside(flags)) return;
        if (is_all_inside(flags)) return keep(cell, flags);
        ++pieces_.cut_cells;
        core::WholeCell part = cells_.whole(cell);
        turn_upright(cell, part);
        constexpr std::uint8_t both = point_flag::below | point_flag::above;
        const bool plain = !(flags & point_flag::tied) && (flags & both) != both;
        if (plain && !has_warped_face(cell)) return cut_plain(cell, part, flags & point_flag::above);
        cut_part(cell, part);
    }

    void keep(std::size_t cell, std::uint8_t flags) {
        out_.is_whole[cell] = 1;
        ++pieces_.whole_cells;
        pieces_.whole_corners += cells_.corners(cell);
        if (flags & point_flag::tied)
            for (std::uint64_t k = 0; k < cells_.corners(cell); ++k)
                if (const std::uint64_t point = cells_.corner(cells_.first(cell) + k);
                    input_.flags[point] & point_flag::tied)
                    mark(out_.used, place_of_point(point));
    }

    /// A cell with repeated corners.
    void add_irregular(std::size_t cell, std::uint8_t flags) {
        const core::NativeParts parts = core::native_parts(cells_.whole(cell));
        if (parts.count == 0) return;
        if (is_all_inside(flags)) {
            keep(cell, flags);
            for (std::uint64_t k = 0; k < cells_.corners(cell); ++k)
                mark(out_.used, place_of_point(cells_.corner(cells_.first(cell) + k)));
            return;
        }
        const std::size_t before = pieces_.types.size();
        for (core::WholeCell part : parts) {
            std::uint8_t of_part = 0;
            for (std::size_t k = 0; k < core::corner_count(part.kind); ++k) of_part |= input_.flags[part.corners[k]];
            if (is_all_outside(of_part)) continue;
            turn_upright(cell, part);
            cut_part(cell, part);
        }
        pieces_.cut_cells += pieces_.types.size() > before;
    }

    void turn_upright(std::size_t cell, core::WholeCell& part) const {
        if (core::is_ordered(cells_.type(cell))) return;
        const auto at = [&](std::uint8_t corner) { return points_[part.corners[corner]]; };
        if (core::is_mirrored(part.kind, part.corners, at)) part.corners = core::mirrored(part.kind, part.corners);
    }

    /// A cell without ties that one isovalue crosses.
    void cut_plain(std::size_t cell, const core::WholeCell& part, bool of_upper) {
        unsigned inside = 0;
        for (std::size_t k = 0; k < core::corner_count(part.kind); ++k) {
            const std::uint64_t point = part.corners[k];
            ids_[9 * k] = static_cast<std::uint32_t>(point);
            inside |= unsigned{(input_.flags[point] & point_flag::inside) != 0} << k;
        }
        if (!input_.warped && !saw_warped_) saw_warped_ = crosses_warped(part, inside);
        const PieceCase& of_case = piece_case(part.kind, inside, of_upper);
        for (const auto& [a, b] : of_case.edges) {
            const bool a_is_above = ((inside >> a & 1) != 0) != of_upper;
            ids_[8 * a + b + (of_upper ? upper_cut : 0)] =
                place_on_edge(part.corners[a_is_above ? b : a], part.corners[a_is_above ? a : b], of_upper);
        }
        const CellPieces& pieces = is_flat(part.kind, of_case.flat) ? of_case.flat : of_case.exact;
        for (const CellPiece& piece : pieces.pieces) emit(cell, piece);
    }

    /// Any part of a cell.
    void cut_part(std::size_t cell, const core::WholeCell& part) {
        CellToCut to_cut;
        to_cut.kind = part.kind;
        to_cut.same = same_corners(part);
        const std::size_t corners = core::corner_count(part.kind);
        unsigned inside = 0;
        for (std::size_t k = 0; k < corners; ++k) {
            const std::uint64_t point = part.corners[k];
            to_cut.states[k] = state_of(input_.flags[point]);
            ids_[9 * k] = place_of_point(point);
            inside |= unsigned{(input_.flags[point] & point_flag::inside) != 0} << k;
        }
        if (!input_.warped && !saw_warped_) saw_warped_ = crosses_warped(part, inside);
        for (const auto& [a, b] : core::edges_of(part.kind)) add_edge(part, to_cut, a, b);
        if (has_warped_face(cell)) add_fans(cell, part, to_cut);
        CellPieces found = pieces_of(to_cut, IsosurfaceFaces::flat);
        if (!is_flat(part.kind, found)) found = pieces_of(to_cut, IsosurfaceFaces::triangles);
        pieces_.flat += found.flat;
        for (const CellPiece& piece : found.pieces) emit(cell, piece, true);
    }

    static CornerState state_of(std::uint8_t flags) {
        const bool tied = flags & point_flag::tied;
        if (flags & point_flag::below) return CornerState::below;
        if (flags & point_flag::inside) return tied ? CornerState::at_lower : CornerState::inside;
        return tied ? CornerState::at_upper : CornerState::above;
    }

    void add_edge(const core::WholeCell& part, const CellToCut& cell, std::uint8_t a, std::uint8_t b) {
        const std::size_t low = std::min(cell.same[a], cell.same[b]), high = std::max(cell.same[a], cell.same[b]);
        if (cell.states[a] > cell.states[b]) std::swap(a, b);
        const std::uint64_t below = part.corners[a], above = part.corners[b];
        if (cell.states[a] == CornerState::below && cell.states[b] >= CornerState::inside)
            ids_[8 * low + high] = place_on_edge(below, above, false);
        if (cell.states[a] < CornerState::at_upper && cell.states[b] == CornerState::above)
            ids_[8 * low + high + upper_cut] = place_on_edge(below, above, true);
    }

    /// Every edge that an isovalue crosses has a vertex; a point in its place keeps the cells whole should one lack.
    std::uint32_t place_on_edge(std::uint64_t below, std::uint64_t above, bool of_upper) const {
        const std::uint32_t vertex = (of_upper ? input_.upper : input_.lower).vertices.find(below, above);
        if (vertex == EdgeVertices::none) return place_of_point(above);
        return static_cast<std::uint32_t>(of_upper ? input_.places.first_upper() : input_.places.first_lower()) + vertex;
    }

    /// A point of the grid: the isosurface's vertex where it is tied.
    std::uint32_t place_of_point(std::uint64_t point) const {
        const std::uint8_t flags = input_.flags[point];
        if (flags & point_flag::tied) {
            const bool of_upper = flags & point_flag::above;
            const std::uint32_t vertex = (of_upper ? input_.upper : input_.lower).vertices.find(point, point);
            if (vertex != EdgeVertices::none)
                return static_cast<std::uint32_t>(of_upper ? input_.places.first_upper()
                                                           : input_.places.first_lower()) +
                       vertex;
        }
        return static_cast<std::uint32_t>(point);
    }

    Place3 coordinates_of(std::uint32_t place) const {
        const Places& places = input_.places;
        if (place < places.first_lower()) return points_[place];
        const bool of_upper = place >= places.first_upper();
        const CutLevel& level = of_upper ? input_.upper : input_.lower;
        const std::uint32_t vertex = level.vertices.in_surface(
            place - static_cast<std::uint32_t>(of_upper ? places.first_upper() : places.first_lower()));
        return level.positions[vertex];
    }

    /// Whether the isosurface's quadrilaterals lie in planes, as in all tets.
    bool is_flat(core::CellKind kind, const CellPieces& pieces) const {
        if (kind == core::CellKind::tetrahedron) return true;
        return std::ranges::all_of(pieces.quadrilaterals, [&](const std::array<PieceVertex, 4>& quadrilateral) {
            std::array<Place3, 4> corners;
            for (std::size_t k = 0; k < 4; ++k) corners[k] = coordinates_of(ids_[quadrilateral[k]]);
            return !is_warped(corners, input_.flat_within > 0
                                           ? input_.flat_within
                                           : rounding_of(input_.grid.points.type()) * largest_coordinate(corners));
        });
    }

    /// Whether some face that an isovalue crosses is not flat.
    bool crosses_warped(const core::WholeCell& part, unsigned inside) const {
        for (const core::CellFace& face : core::shape_of(part.kind).faces()) {
            if (face.count < 4) continue;
            unsigned corners = 0;
            std::array<Place3, 4> at;
            for (std::size_t k = 0; k < 4; ++k) {
                corners |= 1u << face.corners[k];
                at[k] = points_[part.corners[face.corners[k]]];
            }
            const bool through = (inside & corners) == 0; // between both isovalues, or outside
            if ((inside & corners) == corners || lies_in_a_plane_of_axes(at)) continue;
            if ((!through || corner_sides_differ(part, face)) &&
                is_warped(at, rounding_of(input_.grid.points.type()) * largest_coordinate(at)))
                return true;
        }
        return false;
    }

    bool corner_sides_differ(const core::WholeCell& part, const core::CellFace& face) const {
        std::uint8_t flags = 0;
        for (const std::uint8_t corner : face.all()) flags |= input_.flags[part.corners[corner]];
        return (flags & point_flag::below) && (flags & point_flag::above);
    }

    static bool lies_in_a_plane_of_axes(const std::array<Place3, 4>& at) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (at[0][axis] == at[1][axis] && at[0][axis] == at[2][axis] && at[0][axis] == at[3][axis]) return true;
        return false;
    }

    void start_warped(std::size_t begin) {
        if (!input_.warped) return;
        const auto& faces = input_.warped->boundary.faces;
        next_warped_ = static_cast<std::size_t>(
            std::ranges::lower_bound(faces, begin, {}, &BoundaryFace::cell) - faces.begin());
    }

    bool has_warped_face(std::size_t cell) {
        if (!input_.warped) return false;
        const auto& faces = input_.warped->boundary.faces;
        while (next_warped_ < faces.size() && faces[next_warped_].cell < cell) ++next_warped_;
        return next_warped_ < faces.size() && faces[next_warped_].cell == cell;
    }

    /// Parts of warped faces of the boundary become fans, as the solid has them. has_warped_face() has found the cell.
    void add_fans(std::size_t cell, const core::WholeCell& part, CellToCut& to_cut) {
        const auto& boundary = input_.warped->boundary;
        for (std::size_t i = next_warped_; i < boundary.faces.size() && boundary.faces[i].cell == cell; ++i) {
            const BoundaryFace& warped = boundary.faces[i];
            const std::uint32_t apexes = input_.first_apex[i + 1] - input_.first_apex[i];
            if (apexes == 0) continue; // it is not cut
            const auto faces = core::shape_of(part.kind).faces();
            for (std::size_t f = 0; f < faces.size(); ++f) {
                const auto start = start_on(faces[f], part, warped);
                if (!start || to_cut.has_fans[f]) continue;
                to_cut.has_fans[f] = true;
                to_cut.start[f] = static_cast<std::uint8_t>(*start);
                for (std::uint32_t k = 0; k < apexes; ++k)
                    ids_[inside_face + 8 * f + k] =
                        static_cast<std::uint32_t>(input_.places.first_apex()) + input_.first_apex[i] + k;
                break;
            }
        }
    }

    /// Where the first corner of a face of the boundary is in a face of the part; nothing where that is another one.
    std::optional<std::size_t> start_on(const core::CellFace& face, const core::WholeCell& part,
                                        const BoundaryFace& warped) const {
        const auto& numbers = input_.warped->boundary.points;
        if (face.count != warped.count) return std::nullopt;
        for (std::size_t start = 0; start < face.count; ++start) {
            bool same = true;
            for (std::size_t k = 0; k < face.count; ++k)
                same &= part.corners[face.corners[(start + k) % face.count]] == numbers[warped.places[k]];
            if (same) return start;
        }
        return std::nullopt;
    }

    /// `marked`   its vertices may be used by nothing else that is known
    void emit(std::size_t cell, const CellPiece& piece, bool marked = false) {
        pieces_.cells.push_back(static_cast<std::uint16_t>(cell - first_cell_));
        pieces_.types.push_back(piece.type);
        pieces_.sizes.push_back(static_cast<std::uint8_t>(piece.vertices.size()));
        for (const PieceVertex vertex : piece.vertices) {
            pieces_.corners.push_back(ids_[vertex]);
            if (marked) mark(out_.used, ids_[vertex]);
        }
        const std::size_t before = pieces_.faces.size();
        if (piece.type == 42) {
            ++pieces_.polyhedra;
            pieces_.faces.push_back(static_cast<std::uint32_t>(piece.faces.size()));
            for (const PieceFace& face : piece.faces) {
                pieces_.faces.push_back(face.count);
                for (const PieceVertex vertex : face.all()) pieces_.faces.push_back(ids_[vertex]);
            }
        }
        pieces_.face_entries.push_back(static_cast<std::uint16_t>(pieces_.faces.size() - before));
    }

    const CutInput& input_;
    const core::CellReader& cells_;
    core::PointReader points_;
    CutCells& out_;
    BlockPieces& pieces_;
    std::size_t first_cell_ = 0, next_warped_ = 0;
    bool saw_warped_ = false;
    Ids ids_{};
};

/// What is used for sure: points inside, but for tied ones, and vertices on edges.
core::Buffer<std::uint8_t> used_for_sure(const CutInput& input) {
    const Places& places = input.places;
    core::Buffer<std::uint8_t> used(places.count());
    core::parallel_each(places.points, points_at_once, [&](std::size_t point) {
        constexpr std::uint8_t looked_at = point_flag::inside | point_flag::tied;
        used[point] = (input.flags[point] & looked_at) == point_flag::inside && input.facts.in_cell[point];
    });
    core::parallel_each(places.lower + places.upper, points_at_once,
                        [&](std::size_t i) { used[places.points + i] = 1; });
    for (const std::uint32_t vertex : input.lower.vertices.tied()) used[places.first_lower() + vertex] = 0;
    for (const std::uint32_t vertex : input.upper.vertices.tied()) used[places.first_upper() + vertex] = 0;
    std::fill(used.begin() + places.first_apex(), used.end(), std::uint8_t{0});
    return used;
}

} // namespace

CellFacts facts_of(const core::CellReader& cells, const Array& values, const Progress& progress) {
    CellFacts out;
    out.in_cell = cleared(cells.points());
    std::mutex mutex;
    values.visit([&](auto typed) {
        core::parallel_pieces(cells.count(), clip_block, progress, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint64_t> irregular;
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (!core::is_contoured(cells.type(cell))) continue;
                const core::WholeCell whole = cells.whole(cell);
                if (core::has_repeated_corner(whole)) {
                    irregular.push_back(cell);
                    continue;
                }
                const auto corners = std::span(whole.corners).first(core::corner_count(whole.kind));
                const bool has_data = std::ranges::none_of(corners, [&](std::uint64_t point) {
                    return core::is_nan(static_cast<double>(typed[point]));
                });
                if (!has_data) continue;
                for (const std::uint64_t point : corners) mark(out.in_cell, point);
            }
            if (irregular.empty()) return;
            const std::lock_guard lock(mutex);
            out.irregular.insert(out.irregular.end(), irregular.begin(), irregular.end());
        });
    });
    std::ranges::sort(out.irregular);
    return out;
}

CutCells cut_cells(const CutInput& input, const Progress& progress) {
    const std::size_t cells = input.cells.count();
    CutCells out;
    out.blocks.resize((cells + clip_block - 1) / clip_block);
    out.is_whole = core::Buffer<std::uint8_t>(cells);
    out.used = used_for_sure(input);
    std::atomic<bool> saw_warped{false};
    core::parallel_pieces(out.blocks.size(), 1, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            BlockCutter cutter(input, out, out.blocks[block]);
            cutter.cut(block * clip_block, std::min(cells, (block + 1) * clip_block));
            if (cutter.saw_warped()) saw_warped.store(true, std::memory_order_relaxed);
        }
    });
    out.needs_warped = saw_warped;
    return out;
}

} // namespace isotet::solid
