// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/clipped_arrays.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.hpp"

namespace isotet::solid {

namespace {

constexpr std::size_t places_at_once = 1 << 15;

/// Where each block's cells, corners and faces begin in the arrays, and behind the last.
struct BlockStarts {
    std::vector<std::uint64_t> cells{0}, corners{0}, faces{0};
};

BlockStarts starts_of(const CutCells& cut) {
    BlockStarts out;
    for (const BlockPieces& block : cut.blocks) {
        out.cells.push_back(out.cells.back() + block.whole_cells + block.types.size());
        out.corners.push_back(out.corners.back() + block.whole_corners + block.corners.size());
        out.faces.push_back(out.faces.back() + block.faces.size());
    }
    return out;
}

bool fits_in_32_bits(const BlockStarts& starts, std::uint64_t points) {
    constexpr std::uint64_t limit = std::uint64_t{1} << 31;
    return points < limit && starts.corners.back() < limit && starts.faces.back() < limit;
}

/// VTK's type for one of isotet's own.
std::uint8_t vtk_type(std::uint8_t type) {
    if (!core::is_ordered(type)) return type;
    return type == core::ordered_pyramid ? static_cast<std::uint8_t>(CellType::pyramid)
                                         : static_cast<std::uint8_t>(CellType::tetrahedron);
}

/// Fills the arrays of cells, block by block. Index: int32 or int64.
template <class Index>
class CellWriter {
public:
    CellWriter(const CutInput& input, const CutCells& cut, const NewPoints& points, const BlockStarts& starts)
        : cells_(input.cells),
          cut_(cut),
          numbers_(points.numbers),
          starts_(starts),
          corners_(starts.corners.back()),
          offsets_(starts.cells.back() + 1),
          faces_(starts.faces.back()),
          face_offsets_(starts.faces.back() == 0 ? 0 : starts.cells.back() + 1),
          types_(starts.cells.back()),
          origin_(starts.cells.back()) {}

    NewCells write() {
        core::parallel_each(cut_.blocks.size(), 1, [&](std::size_t block) { write_block(block); });
        offsets_[types_.size()] = static_cast<Index>(corners_.size());
        if (!face_offsets_.empty()) face_offsets_[types_.size()] = static_cast<Index>(faces_.size());
        NewCells out;
        out.cells.connectivity = std::move(corners_).to_array();
        out.cells.offsets = std::move(offsets_).to_array();
        out.cells.types = std::move(types_).to_array();
        if (!faces_.empty()) {
            out.cells.faces = std::move(faces_).to_array();
            out.cells.face_offsets = std::move(face_offsets_).to_array();
        }
        out.origin = std::move(origin_);
        return out;
    }

private:
    struct Place {
        std::uint64_t cell, corner, face;
    };

    void begin_cell(Place& at, std::size_t origin, std::uint8_t type) {
        offsets_[at.cell] = static_cast<Index>(at.corner);
        if (!face_offsets_.empty()) face_offsets_[at.cell] = static_cast<Index>(at.face);
        origin_[at.cell] = origin;
        types_[at.cell++] = type;
    }

    void write_block(std::size_t number) {
        const BlockPieces& block = cut_.blocks[number];
        const std::size_t first = number * clip_block, last = std::min(cells_.count(), first + clip_block);
        Place at{starts_.cells[number], starts_.corners[number], starts_.faces[number]};
        std::size_t corner = 0, face = 0, cell = first;
        for (std::size_t piece = 0; piece < block.cells.size(); ++piece) {
            const std::size_t of = first + block.cells[piece];
            if (of > cell) write_whole(cell, of, at);
            cell = of; // which is not whole
            begin_cell(at, of, block.types[piece]);
            for (const std::size_t end = corner + block.sizes[piece]; corner < end; ++corner)
                corners_[at.corner++] = number_of(block.corners[corner]);
            for (const std::size_t end = face + block.face_entries[piece]; face < end;)
                face = write_faces(block, face, at);
        }
        write_whole(cell, last, at);
    }

    /// Those of the cells [first, last) that are whole.
    void write_whole(std::size_t first, std::size_t last, Place& at) {
        std::array<std::uint16_t, clip_block> whole;
        std::size_t count = 0;
        for (std::size_t cell = first; cell < last; ++cell) {
            whole[count] = static_cast<std::uint16_t>(cell - first);
            count += cut_.is_whole[cell];
        }
        if (count == 0) return;
        const auto cells = std::span<const std::uint16_t>(whole).first(count);
        for (std::size_t i = 0; i < count; ++i) origin_[at.cell + i] = first + cells[i];
        if (!face_offsets_.empty())
            std::fill_n(face_offsets_.begin() + at.cell, count, static_cast<Index>(at.face));
        cells_.connectivity().visit([&](const auto* connectivity) {
            if (cells_.has_types() || cells_.has_offsets()) return write_any(connectivity, first, cells, at);
            std::fill_n(types_.begin() + at.cell, count, vtk_type(cells_.type(first)));
            const std::size_t corners = cells_.corners(first);
            for (std::size_t i = 0; i < count; ++i)
                offsets_[at.cell + i] = static_cast<Index>(at.corner + i * corners);
            const auto* const from = connectivity + cells_.first(first);
            if (corners == 4) write_corners<4>(from, cells, at); // known counts are unrolled
            else if (corners == 8) write_corners<8>(from, cells, at);
            else write_any_corners(from, corners, cells, at);
            at.cell += count;
        });
    }

    template <std::size_t corners, class From>
    void write_corners(const From* from, std::span<const std::uint16_t> cells, Place& at) {
        const std::uint32_t* const numbers = numbers_.data();
        Index* to = corners_.data() + at.corner;
        for (const std::uint16_t cell : cells)
            for (std::size_t k = 0; k < corners; ++k)
                *to++ = static_cast<Index>(numbers[static_cast<std::uint32_t>(from[corners * cell + k])]);
        at.corner += corners * cells.size();
    }

    template <class From>
    void write_any_corners(const From* from, std::size_t corners, std::span<const std::uint16_t> cells, Place& at) {
        for (const std::uint16_t cell : cells)
            for (std::size_t k = 0; k < corners; ++k)
                corners_[at.corner++] = number_of(static_cast<std::uint32_t>(from[corners * cell + k]));
    }

    /// Cells of several types, or of which each says where it begins.
    template <class From>
    void write_any(const From* connectivity, std::size_t first, std::span<const std::uint16_t> cells, Place& at) {
        constexpr std::array<std::uint16_t, 1> the_first{};
        for (const std::uint16_t i : cells) {
            const std::size_t cell = first + i;
            types_[at.cell] = vtk_type(cells_.type(cell));
            offsets_[at.cell++] = static_cast<Index>(at.corner);
            write_any_corners(connectivity + cells_.first(cell), cells_.corners(cell), the_first, at);
        }
    }

    /// All faces of a piece from an entry on. Returns the entry behind them.
    std::size_t write_faces(const BlockPieces& block, std::size_t entry, Place& at) {
        const std::uint32_t faces = block.faces[entry++];
        faces_[at.face++] = static_cast<Index>(faces);
        for (std::uint32_t f = 0; f < faces; ++f) {
            const std::uint32_t count = block.faces[entry++];
            faces_[at.face++] = static_cast<Index>(count);
            for (std::uint32_t k = 0; k < count; ++k) faces_[at.face++] = number_of(block.faces[entry++]);
        }
        return entry;
    }

    Index number_of(std::uint32_t place) const { return static_cast<Index>(numbers_[place]); }

    const core::CellReader& cells_;
    const CutCells& cut_;
    const core::Buffer<std::uint32_t>& numbers_;
    const BlockStarts& starts_;
    core::Buffer<Index> corners_, offsets_, faces_, face_offsets_;
    core::Buffer<std::uint8_t> types_;
    core::Buffer<std::uint64_t> origin_;
};

/// Calls f(new point, what it is) with the place among the values of its source: point(), vertex() or apex().
template <class Each>
void for_new_points(const CutInput& input, const NewPoints& points, const Each& each) {
    const Places& places = input.places;
    std::size_t begin = 0; // new points ascend with their places
    const auto for_places = [&](std::uint64_t first, std::uint64_t last, const auto& f) {
        const auto end = static_cast<std::size_t>(std::lower_bound(points.places.begin(), points.places.end(), last) -
                                                  points.places.begin());
        core::parallel_each(end - begin, places_at_once, [&f, &points, begin, first](std::size_t i) {
            f(begin + i, points.places[begin + i] - static_cast<std::uint32_t>(first));
        });
        begin = end;
    };
    for_places(0, places.first_lower(), [&](std::size_t i, std::uint32_t point) { each.point(i, point); });
    for_places(places.first_lower(), places.first_upper(), [&](std::size_t i, std::uint32_t vertex) {
        each.vertex(i, false, input.lower.vertices.in_surface(vertex));
    });
    for_places(places.first_upper(), places.first_apex(), [&](std::size_t i, std::uint32_t vertex) {
        each.vertex(i, true, input.upper.vertices.in_surface(vertex));
    });
    for_places(places.first_apex(), places.count(), [&](std::size_t i, std::uint32_t apex) { each.apex(i, apex); });
}

/// Values at places of any kind, as To.
template <class To>
class ValueReader {
public:
    ValueReader(const PointSource& source, const CutInput& input)
        : input_(input),
          components_(source.grid.components()),
          grid_(source.grid),
          levels_{source.lower, source.upper} {}

    std::size_t components() const { return components_; }
    To of_point(std::uint64_t point, std::size_t k) const { return static_cast<To>(grid_.at(point, k)); }
    To of_vertex(bool of_upper, std::uint32_t vertex, std::size_t k) const {
        return levels_[of_upper]->as<To>()[vertex * components_ + k];
    }
    double of_apex(std::uint64_t apex, std::size_t k) const {
        return input_.cap.apexes[apex].value(
            [&](std::uint32_t vertex) { return static_cast<double>(of_solid(vertex, k)); },
            [&](std::uint64_t point) { return grid_.at(point, k); });
    }

private:
    /// Of a vertex of the solid: those of the lower isosurface, of the upper one, then points of the cap.
    To of_solid(std::uint64_t vertex, std::size_t k) const {
        const Places& places = input_.places;
        if (vertex < places.lower) return of_vertex(false, static_cast<std::uint32_t>(vertex), k);
        vertex -= places.lower;
        if (vertex < places.upper) return of_vertex(true, static_cast<std::uint32_t>(vertex), k);
        return of_point(input_.cap.points[vertex - places.upper], k);
    }

    const CutInput& input_;
    std::size_t components_;
    const Array& grid_;
    std::array<const Array*, 2> levels_;
};

/// Fills the values of new points. From: the type of the grid's array.
template <class To, class From>
struct ValueFiller {
    const ValueReader<To>& reader;
    const From* grid;
    const Cap* places_of_apexes; ///< null: values, not positions
    To* out;

    void point(std::size_t i, std::uint64_t point) const {
        const std::size_t n = reader.components();
        for (std::size_t k = 0; k < n; ++k) out[i * n + k] = static_cast<To>(grid[point * n + k]);
    }
    void vertex(std::size_t i, bool of_upper, std::uint32_t vertex) const {
        const std::size_t n = reader.components();
        for (std::size_t k = 0; k < n; ++k) out[i * n + k] = reader.of_vertex(of_upper, vertex, k);
    }
    void apex(std::size_t i, std::uint64_t apex) const {
        const std::size_t n = reader.components();
        for (std::size_t k = 0; k < n; ++k)
            out[i * n + k] = static_cast<To>(places_of_apexes ? places_of_apexes->apexes[apex].position[k]
                                                              : reader.of_apex(apex, k));
    }
};

template <class To>
Array filled(const PointSource& source, const CutInput& input, const NewPoints& points, const Cap* apexes) {
    core::Buffer<To> out(points.places.size() * source.grid.components());
    const ValueReader<To> reader(source, input);
    source.grid.visit([&](auto typed) {
        using From = std::remove_cvref_t<decltype(typed[0])>;
        for_new_points(input, points, ValueFiller<To, From>{reader, typed.data(), apexes, out.data()});
    });
    return std::move(out).to_array(source.grid.components());
}

Array filled(const PointSource& source, const CutInput& input, const NewPoints& points, Precision precision,
             const Cap* apexes) {
    if (source.grid.type() == ScalarType::float32 && precision == Precision::float32)
        return filled<float>(source, input, points, apexes);
    return filled<double>(source, input, points, apexes);
}

/// Fills the edges of new points. Real: the type of weights.
template <class Real>
struct EdgeFiller {
    std::array<const Surface*, 2> levels;
    std::int64_t* ends;
    Real* weights;

    void set(std::size_t i, std::int64_t below, std::int64_t above, Real weight) const {
        ends[2 * i] = below;
        ends[2 * i + 1] = above;
        weights[i] = weight;
    }
    void point(std::size_t i, std::uint64_t point) const {
        set(i, static_cast<std::int64_t>(point), static_cast<std::int64_t>(point), 0);
    }
    void vertex(std::size_t i, bool of_upper, std::uint32_t vertex) const {
        const auto from = levels[of_upper]->edge_ends.as<std::int64_t>();
        set(i, from[2 * vertex], from[2 * vertex + 1], levels[of_upper]->edge_weights.as<Real>()[vertex]);
    }
    void apex(std::size_t i, std::uint64_t) const { set(i, -1, -1, 0); }
};

template <class Real>
EdgesOfPoints filled_edges(const Surface& lower, const Surface& upper, const CutInput& input,
                           const NewPoints& points) {
    core::Buffer<std::int64_t> ends(2 * points.places.size());
    core::Buffer<Real> weights(points.places.size());
    for_new_points(input, points, EdgeFiller<Real>{{&lower, &upper}, ends.data(), weights.data()});
    return {std::move(ends).to_array(2), std::move(weights).to_array()};
}

} // namespace

NewPoints number_points(const CutInput& input, const core::Buffer<std::uint8_t>& used) {
    NewPoints out;
    const std::size_t ranges = (used.size() + places_at_once - 1) / places_at_once;
    const auto end_of = [&](std::size_t range) { return std::min(used.size(), (range + 1) * places_at_once); };
    std::vector<std::uint64_t> first(ranges + 1);
    core::parallel_each(ranges, 1, [&](std::size_t range) {
        std::uint64_t count = 0;
        for (std::size_t i = range * places_at_once; i < end_of(range); ++i) count += used[i];
        first[range + 1] = count;
    });
    for (std::size_t range = 0; range < ranges; ++range) first[range + 1] += first[range];
    out.numbers = core::Buffer<std::uint32_t>(used.size());
    out.places = core::Buffer<std::uint32_t>(first[ranges]);
    core::parallel_each(ranges, 1, [&](std::size_t range) {
        auto next = static_cast<std::uint32_t>(first[range]);
        for (std::size_t i = range * places_at_once; i < end_of(range); ++i) {
            out.numbers[i] = next;
            if (!used[i]) continue;
            out.places[next++] = static_cast<std::uint32_t>(i);
        }
    });
    for (const std::uint32_t vertex : input.lower.vertices.tied())
        out.numbers[input.lower.vertices.high(vertex)] = out.numbers[input.places.first_lower() + vertex];
    for (const std::uint32_t vertex : input.upper.vertices.tied())
        out.numbers[input.upper.vertices.high(vertex)] = out.numbers[input.places.first_upper() + vertex];
    return out;
}

std::uint64_t bytes_of_cells(const CutCells& cut) {
    const BlockStarts starts = starts_of(cut);
    const std::uint64_t index = fits_in_32_bits(starts, cut.used.size()) ? 4 : 8;
    const std::uint64_t cells = starts.cells.back();
    return index * (starts.corners.back() + starts.faces.back() + (starts.faces.back() ? 2 : 1) * cells) + 9 * cells;
}

NewCells make_cells(const CutInput& input, const CutCells& cut, const NewPoints& points) {
    const BlockStarts starts = starts_of(cut);
    if (fits_in_32_bits(starts, points.places.size()))
        return CellWriter<std::int32_t>(input, cut, points, starts).write();
    return CellWriter<std::int64_t>(input, cut, points, starts).write();
}

Array new_values(const PointSource& source, const CutInput& input, const NewPoints& points, Precision precision) {
    return filled(source, input, points, precision, nullptr);
}

Array new_positions(const PointSource& source, const CutInput& input, const NewPoints& points, Precision precision) {
    return filled(source, input, points, precision, &input.cap);
}

EdgesOfPoints new_edges(const Surface& lower, const Surface& upper, const CutInput& input, const NewPoints& points,
                        Precision precision) {
    return precision == Precision::float32 ? filled_edges<float>(lower, upper, input, points)
                                           : filled_edges<double>(lower, upper, input, points);
}

Array new_cell_values(const Array& values, const core::Buffer<std::uint64_t>& origin) {
    const std::size_t n = values.components();
    return values.visit([&](auto typed) {
        using Value = std::remove_cvref_t<decltype(typed[0])>;
        core::Buffer<Value> out(origin.size() * n);
        core::parallel_each(origin.size(), places_at_once, [&](std::size_t i) {
            for (std::size_t k = 0; k < n; ++k) out[i * n + k] = typed[origin[i] * n + k];
        });
        return std::move(out).to_array(n);
    });
}

} // namespace isotet::solid
