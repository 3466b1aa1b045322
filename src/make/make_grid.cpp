// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// make_grid(): points, cells and fields are computed in place, each from its number alone.
#include <isotet/fields.hpp>
#include <isotet/make.hpp>

#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/system/memory.hpp"
#include "base/until_cancelled.hpp"
#include "grid/cells.hpp"
#include "make/analytic_field.hpp"
#include "make/foam.hpp"
#include "make/lattice.hpp"
#include "make/octree.hpp"
#include "make/permutation.hpp"
#include "make/shape.hpp"

namespace isotet {

namespace {

using namespace make;

constexpr std::uint64_t largest_side = 4096;
constexpr std::string_view foam = "kelvin";

/// Even permutations of the corners of a tet: they keep its orientation.
constexpr std::array<std::array<std::uint8_t, 4>, 12> even_orders{{{0, 1, 2, 3},
                                                                   {0, 2, 3, 1},
                                                                   {0, 3, 1, 2},
                                                                   {1, 0, 3, 2},
                                                                   {1, 2, 0, 3},
                                                                   {1, 3, 2, 0},
                                                                   {2, 0, 1, 3},
                                                                   {2, 1, 3, 0},
                                                                   {2, 3, 0, 1},
                                                                   {3, 0, 2, 1},
                                                                   {3, 1, 0, 2},
                                                                   {3, 2, 1, 0}}};

/// Cells and corners of the cubes in the layers below one layer, for each cube of a layer.
struct Sizes {
    std::uint64_t cells = 0, corners = 0;
};

class Maker {
public:
    Maker(const Shape& shape, const MakeOptions& options, const Progress& progress)
        : shape_(shape),
          options_(options),
          progress_(progress),
          lattice_(shape, (shape.quadratic ? 2 : 1) * options.side, options.seed),
          shuffled_(shape.variant == Variant::shuffled),
          point_order_(lattice_.points(), options.seed, Stream::point_order) {
        layers_.resize(options.side + 1);
        for (std::uint64_t k = 0; k < options.side; ++k) {
            const CubeCells& cube = shape.layers[k % shape.layers.size()];
            const std::size_t corners = shape.quadratic ? cube.types.size() * nodes_per_cell() : cube.corners.size();
            layers_[k + 1] = {layers_[k].cells + cube.types.size(), layers_[k].corners + corners};
        }
        const std::uint64_t cubes = options.side * options.side;
        for (Sizes& sizes : layers_) sizes = {sizes.cells * cubes, sizes.corners * cubes};
        work_ =
            (shuffled_ ? layers_.back().cells : cubes * options.side) + lattice_.points() * (1 + options.fields.size());
    }

    Result<Grid> make() {
        const bool narrow = lattice_.points() <= std::uint64_t{1} << 31;
        const Sizes total = layers_.back();
        const std::uint64_t cell_bytes =
            shape_.uniform && !shape_.quadratic ? 0 : 1 + (total.corners < std::uint64_t{1} << 31 ? 4u : 8u);
        const std::uint64_t bytes = lattice_.points() * (12 + 4 * options_.fields.size()) +
                                    total.corners * (narrow ? 4u : 8u) + total.cells * cell_bytes;
        if (auto fits = core::require_memory("making the grid", bytes); !fits) return fits.error();

        Grid grid;
        grid.points = points();
        if (narrow) cells<std::int32_t>(grid.cells);
        else cells<std::int64_t>(grid.cells);
        for (const std::string& name : options_.fields) grid.point_fields.push_back({name, field(name)});
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "making the grid was cancelled"};
        return grid;
    }

private:
    /// Calls body(index) for all indices, in parallel pieces, between which it reports and looks for a cancel.
    template <class Body>
    void for_all(std::uint64_t count, const Body& body) {
        constexpr std::uint64_t piece = 1 << 22;
        for (std::uint64_t begin = 0; begin < count && !progress_.cancelled(); begin += piece) {
            const std::uint64_t size = std::min(piece, count - begin);
            core::each_until_cancelled(size, 1 << 13, progress_, [&](std::size_t i) { body(begin + i); });
            done_ += size;
            progress_("make", static_cast<double>(done_) / static_cast<double>(work_));
        }
    }

    /// The lattice's number of the grid's point.
    std::uint64_t lattice_point(std::uint64_t point) const { return shuffled_ ? point_order_.inverse(point) : point; }

    Array points() {
        core::Buffer<float> positions(3 * lattice_.points());
        for_all(lattice_.points(), [&](std::uint64_t point) {
            const Position position = lattice_.position(lattice_point(point));
            std::copy(position.begin(), position.end(), positions.data() + 3 * point);
        });
        return std::move(positions).to_array(3);
    }

    Array field(std::string_view name) {
        const auto at = std::ranges::find(analytic_fields, name, &AnalyticField::name)->at;
        if (at) return values<float>([&](std::uint64_t point) { return at(lattice_.position(point)); });
        return values<std::int32_t>([&](std::uint64_t point) { return small_integer(options_.seed, point); });
    }

    /// One value for each point, from its number in the lattice.
    template <class Value, class At>
    Array values(const At& at) {
        core::Buffer<Value> all(lattice_.points());
        for_all(lattice_.points(), [&](std::uint64_t point) { all[point] = at(lattice_point(point)); });
        return std::move(all).to_array();
    }

    template <class Index>
    void cells(Cells& out) {
        core::Buffer<Index> connectivity(layers_.back().corners);
        out.uniform_type = shape_.layers[0].types[0];
        if (shape_.quadratic) {
            if (connectivity.size() < std::uint64_t{1} << 31) quadratic_cells<std::int32_t>(connectivity.data(), out);
            else quadratic_cells<std::int64_t>(connectivity.data(), out);
        } else if (shuffled_) shuffled_tets(connectivity.data());
        else if (shape_.uniform)
            for_cubes([&](const CubeCells& cube, const auto& corners, Sizes first) {
                write_corners(cube, corners, connectivity.data() + first.corners);
            });
        else if (connectivity.size() < std::uint64_t{1} << 31) mixed_cells<std::int32_t>(connectivity.data(), out);
        else mixed_cells<std::int64_t>(connectivity.data(), out);
        out.connectivity = std::move(connectivity).to_array();
    }

    /// Cells of several types: with offsets and types beside the connectivity.
    template <class Offset, class Index>
    void mixed_cells(Index* connectivity, Cells& out) {
        const Sizes total = layers_.back();
        core::Buffer<Offset> offsets(total.cells + 1);
        core::Buffer<std::uint8_t> types(total.cells);
        offsets[total.cells] = static_cast<Offset>(total.corners);
        for_cubes([&](const CubeCells& cube, const auto& corners, Sizes first) {
            write_corners(cube, corners, connectivity + first.corners);
            std::uint64_t offset = first.corners;
            for (std::size_t cell = 0; cell < cube.types.size(); ++cell) {
                const auto type = static_cast<std::uint8_t>(cube.types[cell]);
                offsets[first.cells + cell] = static_cast<Offset>(offset);
                types[first.cells + cell] = type;
                offset += static_cast<std::uint64_t>(core::corners_of(type));
            }
        });
        out.offsets = std::move(offsets).to_array();
        out.types = std::move(types).to_array();
    }

    bool of_tets() const { return shape_.layers[0].types[0] == CellType::tetrahedron; }
    std::size_t nodes_per_cell() const { return of_tets() ? 10 : 27; }

    /// Quadratic cells on a lattice twice as fine: their nodes are lattice points.
    template <class Offset, class Index>
    void quadratic_cells(Index* connectivity, Cells& out) {
        constexpr std::uint8_t quadratic_tetrahedron = 24, triquadratic_hexahedron = 29;
        const std::size_t nodes = nodes_per_cell();
        const std::uint64_t cells = layers_.back().cells, row = lattice_.side() + 1;
        core::Buffer<Offset> offsets(cells + 1);
        core::Buffer<std::uint8_t> types(cells);
        for_all(cells + 1, [&](std::uint64_t cell) {
            offsets[cell] = static_cast<Offset>(nodes * cell);
            if (cell < cells) types[cell] = of_tets() ? quadratic_tetrahedron : triquadratic_hexahedron;
        });
        const std::uint64_t side = options_.side;
        for_all(side * side * side, [&](std::uint64_t cube) {
            const std::uint64_t i = cube % side, j = cube / side % side, k = cube / (side * side);
            const std::uint64_t first = 2 * (i + row * (j + row * k));
            Index* node = connectivity + cube * nodes * shape_.layers[0].types.size();
            const auto add = [&](std::uint64_t x, std::uint64_t y, std::uint64_t z) {
                *node++ = static_cast<Index>(first + x + row * (y + row * z));
            };
            if (!of_tets()) {
                for (const auto& at : tables::triquadratic) add(at[0], at[1], at[2]);
                return;
            }
            for (std::size_t tet = 0; tet < 6; ++tet)
                for (const auto& [a, b] : tables::quadratic_tet) {
                    const unsigned p = tables::kuhn[4 * tet + a], q = tables::kuhn[4 * tet + b];
                    add((p & 1) + (q & 1), (p >> 1 & 1) + (q >> 1 & 1), (p >> 2) + (q >> 2));
                }
        });
        out.offsets = std::move(offsets).to_array();
        out.types = std::move(types).to_array();
    }

    template <class Index>
    static void write_corners(const CubeCells& cube, const std::array<std::uint64_t, 9>& corners, Index* out) {
        for (const std::uint8_t corner : cube.corners) *out++ = static_cast<Index>(corners[corner]);
    }

    /// Calls body(cells of the cube, its corners, where its cells go) for every cube.
    template <class Body>
    void for_cubes(const Body& body) {
        const std::uint64_t side = options_.side;
        for_all(side * side * side, [&](std::uint64_t number) {
            const std::uint64_t i = number % side, j = number / side % side, k = number / (side * side);
            const CubeCells& cube = shape_.layers[k % shape_.layers.size()];
            const std::uint64_t in_layer = i + side * j;
            body(cube, lattice_.corners(i, j, k),
                 Sizes{layers_[k].cells + in_layer * cube.types.size(),
                       layers_[k].corners + in_layer * cube.corners.size()});
        });
    }

    template <class Index>
    void shuffled_tets(Index* connectivity) {
        const std::uint64_t side = options_.side;
        const Permutation tet_order(layers_.back().cells, options_.seed, Stream::tet_order);
        for_all(layers_.back().cells, [&](std::uint64_t tet) {
            const std::uint64_t old = tet_order.inverse(tet), cube = old / 6;
            const auto corners = lattice_.corners(cube % side, cube / side % side, cube / (side * side));
            const auto& order = even_orders[draw(options_.seed, Stream::corner_order, tet) % even_orders.size()];
            for (std::size_t corner = 0; corner < 4; ++corner)
                connectivity[4 * tet + corner] =
                    static_cast<Index>(point_order_(corners[tables::kuhn[old % 6 * 4 + order[corner]]]));
        });
    }

    const Shape& shape_;
    const MakeOptions& options_;
    const Progress& progress_;
    Lattice lattice_;
    bool shuffled_;
    Permutation point_order_;
    std::vector<Sizes> layers_; ///< cells and corners below each layer
    std::uint64_t work_ = 0, done_ = 0;
};

template <class List>
std::vector<std::string> names_in(const List& list) {
    std::vector<std::string> names;
    for (const auto& entry : list) names.emplace_back(entry.name);
    return names;
}

/// "the shape is 'cuhn', but must be one of kuhn, ..."
Error unknown(std::string_view what, const std::string& name, std::vector<std::string> known) {
    std::string message = fmt::format("{} is '{}', but must be one of", what, name);
    std::string_view separator = " ";
    for (const std::string& candidate : nearest_first(name, std::move(known))) {
        message += separator;
        message += candidate;
        separator = ", ";
    }
    return {ErrorCode::invalid_argument, std::move(message)};
}

const OctreeShape* find_octree(std::string_view name) {
    const auto* const found = std::ranges::find(octree_shapes, name, &OctreeShape::name);
    return found == octree_shapes.end() ? nullptr : found;
}

std::optional<Error> fault_in(const MakeOptions& options) {
    const bool octree = find_octree(options.shape) != nullptr;
    if (!octree && options.shape != foam && std::ranges::find(shapes, options.shape, &Shape::name) == shapes.end())
        return unknown("the shape", options.shape, make_shapes());
    const std::uint64_t largest = octree                  ? largest_octree_side
                                  : options.shape == foam ? largest_foam_side
                                                          : largest_side;
    if (options.side < 1 || options.side > largest)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the side is {}, but must be 1 to {}", options.side, largest)};
    for (auto name = options.fields.begin(); name != options.fields.end(); ++name) {
        if (std::ranges::find(analytic_fields, *name, &AnalyticField::name) == analytic_fields.end())
            return unknown("a field", *name, make_fields());
        if (std::find(options.fields.begin(), name, *name) != name)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("the field '{}' is asked for twice, but names must differ", *name)};
    }
    return std::nullopt;
}

} // namespace

std::vector<std::string> make_shapes() {
    std::vector<std::string> names = names_in(make::shapes);
    names.emplace_back(foam);
    for (const make::OctreeShape& octree : make::octree_shapes) names.emplace_back(octree.name);
    return names;
}
std::vector<std::string> make_fields() { return names_in(make::analytic_fields); }

Result<Grid> make_grid(const MakeOptions& options, const Run& run) {
    if (const auto fault = fault_in(options)) return *fault;
    return core::carry_out("making the grid", run, [&](const Progress& progress) {
        if (options.shape == foam) return make_foam(options, progress);
        if (const OctreeShape* octree = find_octree(options.shape)) return make_octree(*octree, options, progress);
        return Maker(*std::ranges::find(shapes, options.shape, &Shape::name), options, progress).make();
    });
}

} // namespace isotet
