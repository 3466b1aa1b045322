// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/quadratic.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell/split.hpp"
#include "grid/orientation.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/curved/node_table.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t curved_cells_per_block = 1024;
constexpr Node row_flag = Node{1} << 31; ///< a row of the block at hand

/// What lies between two corners of a cell: an edge, a quadrilateral by its diagonal, or the cell.
struct Between {
    enum class What : std::uint8_t { nothing, edge, face, body } what = What::nothing;
    std::uint8_t index = 0;
};
using BetweenTable = std::array<std::array<Between, 8>, 8>;

constexpr BetweenTable between_of(core::CellKind kind) {
    BetweenTable table{};
    if (kind == core::CellKind::hexahedron)
        for (std::size_t a = 0; a < 8; ++a) table[a][(a + 2) % 4 + (a < 4 ? 4 : 0)] = {Between::What::body, 0};
    const auto set = [&](std::size_t a, std::size_t b, Between what) { table[a][b] = table[b][a] = what; };
    std::uint8_t index = 0;
    for (const CornerPair& edge : quadratic_edges(kind)) set(edge[0], edge[1], {Between::What::edge, index++});
    index = 0;
    for (const CornerQuad& face : quadratic_faces(kind)) {
        set(face[0], face[2], {Between::What::face, index});
        set(face[1], face[3], {Between::What::face, index++});
    }
    return table;
}

constexpr std::array<BetweenTable, core::cell_kind_count> between_tables{
    between_of(core::CellKind::tetrahedron), between_of(core::CellKind::pyramid), between_of(core::CellKind::wedge),
    between_of(core::CellKind::hexahedron)};

/// A linear cell's nodes: its corners.
NodeLayout linear_layout(core::CellKind kind) {
    return {kind, static_cast<std::uint8_t>(core::corner_count(kind)), 0, 0, false};
}

/// Which entities have nodes of their own in some cells and not in others.
struct Holes {
    bool edges = false, faces = false;
};

struct SharedNodes {
    NodeTable<2> edges;
    NodeTable<4> faces;
};

struct CurvedBlock {
    std::vector<QuadraticTet> tets;
    std::vector<std::uint8_t> odd;
    std::vector<std::uint64_t> sources;
    std::vector<std::array<std::uint8_t, 4>> locals;
    std::vector<std::uint64_t> cell_node_ends; ///< one a cell
    std::vector<Node> cell_nodes;
    std::vector<std::uint64_t> row_ends, row_points;
    std::vector<double> row_weights;
    std::uint64_t curved = 0, left_out = 0, unknown = 0;
};

/// A weighted sum in the making.
class Terms {
public:
    void clear() { terms_.clear(); }
    void add(Node node, double weight) {
        for (auto& [known, sum] : terms_)
            if (known == node) {
                sum += weight;
                return;
            }
        terms_.emplace_back(node, weight);
    }
    /// Ordered by the nodes' numbers, so that both cells of a face have the same bits.
    const std::vector<std::pair<Node, double>>& sorted() {
        std::erase_if(terms_, [](const auto& term) { return term.second == 0; });
        std::ranges::sort(terms_);
        return terms_;
    }

private:
    std::vector<std::pair<Node, double>> terms_;
};

/// One cell at a time.
class CellNodes {
public:
    CellNodes(const Grid& grid, const core::CellReader& cells, const SharedNodes& shared)
        : cells_(cells), shared_(shared), numbers_(grid.point_numbers), has_numbers_(!grid.point_numbers.empty()) {}

    void split(std::size_t cell, CellNodeLists lists, CurvedBlock& out) {
        split(cell, out);
        if (lists == CellNodeLists::left_out) return;
        if (layout_at(cell) && layout_.kind != core::CellKind::tetrahedron) add_nodes(out);
        out.cell_node_ends.push_back(out.cell_nodes.size());
    }

    void split(std::size_t cell, CurvedBlock& out) {
        const std::uint8_t type = cells_.type(cell);
        const auto layout = layout_at(cell);
        if (!layout) {
            ++out.left_out;
            out.unknown += is_curved(type);
            return;
        }
        out.curved += is_curved(type);
        read(cell, *layout);
        out_ = &out;
        core::WholeCell whole{layout_.kind, {}};
        for (std::size_t i = 0; i < core::corner_count(layout_.kind); ++i) whole.corners[i] = number(nodes_[i]);
        for (const auto& tet : core::split_locally(whole)) add_tet(tet, cell);
    }

    /// What the cell has on its edges and faces.
    void collect(std::size_t cell, SharedNodes& to) {
        const auto layout = layout_at(cell);
        if (!layout) return;
        read(cell, *layout);
        const std::size_t corners = core::corner_count(layout_.kind);
        const auto edges = quadratic_edges(layout_.kind);
        for (std::size_t i = 0; i < layout_.edges; ++i)
            to.edges.add({nodes_[edges[i][0]], nodes_[edges[i][1]]}, nodes_[corners + i]);
        const auto faces = quadratic_faces(layout_.kind);
        for (std::size_t i = 0; i < layout_.faces; ++i)
            to.faces.add(corners_of(faces[i]), nodes_[corners + layout_.edges + i]);
    }

    std::optional<NodeLayout> layout_at(std::size_t cell) const {
        const std::uint8_t type = cells_.type(cell);
        if (const auto kind = core::kind_of(type)) return linear_layout(*kind);
        return layout_of(type, cells_.corners(cell));
    }

private:
    std::uint64_t number(Node node) const { return has_numbers_ ? numbers_[node] : node; }

    void read(std::size_t cell, const NodeLayout& layout) {
        layout_ = layout;
        between_ = &between_tables[static_cast<std::size_t>(layout.kind)];
        edge_nodes_.fill(not_yet);
        face_nodes_.fill(not_yet);
        body_node_ = not_yet;
        if (core::is_contoured(cells_.type(cell))) {
            const core::WholeCell whole = cells_.whole(cell);
            for (std::size_t i = 0; i < layout.nodes; ++i) nodes_[i] = static_cast<Node>(whole.corners[i]);
        } else {
            const std::uint64_t first = cells_.first(cell);
            for (std::size_t i = 0; i < layout.nodes; ++i) nodes_[i] = static_cast<Node>(cells_.corner(first + i));
        }
    }

    std::array<Node, 4> corners_of(const CornerQuad& face) const {
        return {nodes_[face[0]], nodes_[face[1]], nodes_[face[2]], nodes_[face[3]]};
    }

    Node edge_node(std::size_t edge) {
        Node& known = edge_nodes_[edge];
        if (known != not_yet) return known;
        if (edge < layout_.edges) return known = nodes_[core::corner_count(layout_.kind) + edge];
        const CornerPair& ends = quadratic_edges(layout_.kind)[edge];
        return known = shared_.edges.find({nodes_[ends[0]], nodes_[ends[1]]}).value_or(mean_node);
    }

    void add_edge(std::size_t edge, double weight, Terms& to) {
        const Node node = edge_node(edge);
        if (node != mean_node) return to.add(node, weight);
        for (const std::uint8_t end : quadratic_edges(layout_.kind)[edge]) to.add(nodes_[end], weight / 2);
    }

    /// The face's own node, or what stands for it.
    void add_face(std::size_t face, double weight, Terms& to) {
        const CornerQuad& corners = quadratic_faces(layout_.kind)[face];
        if (const auto node = own_face_node(face)) return to.add(*node, weight);
        for (std::size_t k = 0; k < 4; ++k) {
            to.add(nodes_[corners[k]], -weight / 4);
            add_edge((*between_)[corners[k]][corners[(k + 1) % 4]].index, weight / 2, to);
        }
    }

    std::optional<Node> own_face_node(std::size_t face) const {
        if (face < layout_.faces) return nodes_[core::corner_count(layout_.kind) + layout_.edges + face];
        return shared_.faces.find(corners_of(quadratic_faces(layout_.kind)[face]));
    }

    Node add_row() {
        for (const auto& [node, weight] : terms_.sorted()) {
            out_->row_points.push_back(node);
            out_->row_weights.push_back(weight);
        }
        out_->row_ends.push_back(out_->row_points.size());
        return row_flag | static_cast<Node>(out_->row_ends.size() - 1);
    }

    Node face_node(std::size_t face) {
        Node& known = face_nodes_[face];
        if (known != not_yet) return known;
        if (const auto own = own_face_node(face)) return known = *own;
        terms_.clear();
        add_face(face, 1, terms_);
        return known = add_row();
    }

    /// Transfinite: half of the faces less a quarter of the edges and an eighth of the corners.
    Node body_node() {
        if (body_node_ != not_yet) return body_node_;
        if (layout_.centre)
            return body_node_ = nodes_[core::corner_count(layout_.kind) + layout_.edges + layout_.faces];
        terms_.clear();
        for (std::size_t face = 0; face < 6; ++face) add_face(face, 0.5, terms_);
        for (std::size_t edge = 0; edge < 12; ++edge) add_edge(edge, -0.25, terms_);
        for (std::size_t corner = 0; corner < 8; ++corner) terms_.add(nodes_[corner], 0.125);
        return body_node_ = add_row();
    }

    Node node_between(std::uint8_t a, std::uint8_t b) {
        const Between between = (*between_)[a][b];
        switch (between.what) {
        case Between::What::edge: return edge_node(between.index);
        case Between::What::face: return face_node(between.index);
        case Between::What::body: return body_node();
        case Between::What::nothing: break;
        }
        return mean_node;
    }

    /// All nodes of degree 2, of the cell that was read last.
    void add_nodes(CurvedBlock& out) {
        for (std::size_t i = 0; i < core::corner_count(layout_.kind); ++i) out.cell_nodes.push_back(nodes_[i]);
        for (std::size_t i = 0; i < quadratic_edges(layout_.kind).size(); ++i) out.cell_nodes.push_back(edge_node(i));
        for (std::size_t i = 0; i < quadratic_faces(layout_.kind).size(); ++i) out.cell_nodes.push_back(face_node(i));
        if (layout_.kind == core::CellKind::hexahedron) out.cell_nodes.push_back(body_node());
    }

    void add_tet(std::array<std::uint8_t, 4> corners, std::size_t cell) {
        std::uint8_t odd = 0;
        for (std::size_t end = 4; end > 1; --end)
            for (std::size_t i = 1; i < end; ++i)
                if (number(nodes_[corners[i]]) < number(nodes_[corners[i - 1]])) {
                    std::swap(corners[i], corners[i - 1]);
                    odd ^= 1;
                }
        QuadraticTet tet{};
        for (std::size_t i = 0; i < 4; ++i) tet[i] = nodes_[corners[i]];
        for (std::size_t e = 0; e < 6; ++e)
            tet[4 + e] = node_between(corners[tet_edges[e][0]], corners[tet_edges[e][1]]);
        out_->tets.push_back(tet);
        out_->odd.push_back(odd);
        out_->sources.push_back(cell);
        out_->locals.push_back(corners);
    }

    static constexpr Node not_yet = 0xfffffffe;

    const core::CellReader& cells_;
    const SharedNodes& shared_;
    core::IndexColumn numbers_;
    bool has_numbers_;
    NodeLayout layout_{};
    const BetweenTable* between_ = nullptr;
    std::array<Node, 27> nodes_{};
    std::array<Node, 12> edge_nodes_{};
    std::array<Node, 6> face_nodes_{};
    Node body_node_ = not_yet;
    Terms terms_;
    CurvedBlock* out_ = nullptr;
};

/// What is wrong with the nodes of a curved cell; empty: nothing.
std::string fault_of_nodes(const Grid& grid, const core::CellReader& cells, std::size_t cell) {
    const std::uint8_t type = cells.type(cell);
    const std::uint64_t count = cells.corners(cell), first = cells.first(cell), points = grid.points.tuples();
    if (const std::uint64_t expected = expected_nodes(type); expected && count != expected)
        return fmt::format("cell {} ({}) has {} nodes, but must have {}", cell, name_of_cell_type(type), count,
                           expected);
    if (!layout_of(type, count)) return {};
    const core::PointReader reader(grid.points);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t point = cells.corner(first + i);
        if (point >= points)
            return fmt::format("cell {} ({}) has point {}, but the grid has {} points", cell, name_of_cell_type(type),
                               static_cast<std::int64_t>(point), points);
        for (const double x : reader[point])
            if (!std::isfinite(x))
                return fmt::format("point {} of cell {} ({}) has a coordinate that is not finite", point, cell,
                                   name_of_cell_type(type));
    }
    return {};
}

Result<void> check_nodes(const Grid& grid, const core::CellReader& cells, const Progress& progress) {
    std::atomic<std::size_t> lowest{cells.count()};
    core::parallel_pieces(cells.count(), 1 << 13, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end && cell < lowest.load(std::memory_order_relaxed); ++cell) {
            if (!is_curved(cells.type(cell)) || fault_of_nodes(grid, cells, cell).empty()) continue;
            std::size_t seen = lowest.load(std::memory_order_relaxed);
            while (cell < seen && !lowest.compare_exchange_weak(seen, cell, std::memory_order_relaxed)) {}
        }
    });
    if (lowest.load() < cells.count()) return invalid_data(fault_of_nodes(grid, cells, lowest.load()));
    return {};
}

/// A pass over the types.
Holes find_holes(const CellNodes& nodes, const core::CellReader& cells) {
    bool with_edges = false, without_edges = false, with_faces = false, without_faces = false;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        const auto layout = nodes.layout_at(cell);
        if (!layout) continue;
        with_edges |= layout->edges > 0;
        without_edges |= layout->edges < quadratic_edges(layout->kind).size();
        with_faces |= layout->faces > 0;
        without_faces |= layout->faces < quadratic_faces(layout->kind).size();
    }
    return {with_edges && without_edges, with_faces && without_faces};
}

QuadraticTets joined_curved(std::vector<CurvedBlock>& blocks, std::uint64_t points) {
    struct Place {
        std::uint64_t tet = 0, row = 0, term = 0, cell = 0, node = 0;
    };
    std::vector<Place> places(blocks.size() + 1);
    QuadraticTets out;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const CurvedBlock& block = blocks[b];
        places[b + 1] = {places[b].tet + block.tets.size(), places[b].row + block.row_ends.size(),
                         places[b].term + block.row_points.size(), places[b].cell + block.cell_node_ends.size(),
                         places[b].node + block.cell_nodes.size()};
        out.curved += block.curved;
        out.left_out += block.left_out;
        out.unknown += block.unknown;
    }
    const Place total = places.back();
    out.tets = core::Buffer<QuadraticTet>(total.tet);
    out.odd = core::Buffer<std::uint8_t>(total.tet);
    out.sources = core::Buffer<std::uint64_t>(total.tet);
    out.locals = core::Buffer<std::array<std::uint8_t, 4>>(total.tet);
    if (total.cell > 0) out.first_node.resize(total.cell + 1);
    out.cell_nodes.resize(total.node);
    core::Buffer<std::uint64_t> first(total.row + 1), terms(total.term);
    core::Buffer<double> weights(total.term);
    first[0] = 0;
    core::parallel_each(blocks.size(), 1, [&](std::size_t b) {
        CurvedBlock& block = blocks[b];
        const Place& at = places[b];
        const auto joined_node = [&](Node node) {
            return node == mean_node || !(node & row_flag) ? node
                                                           : static_cast<Node>(points + at.row + (node & ~row_flag));
        };
        for (std::size_t i = 0; i < block.tets.size(); ++i) {
            QuadraticTet tet = block.tets[i];
            for (std::size_t k = 4; k < 10; ++k) tet[k] = joined_node(tet[k]);
            out.tets[at.tet + i] = tet;
        }
        for (std::size_t i = 0; i < block.cell_nodes.size(); ++i)
            out.cell_nodes[at.node + i] = joined_node(block.cell_nodes[i]);
        for (std::size_t i = 0; i < block.cell_node_ends.size(); ++i)
            out.first_node[at.cell + i + 1] = at.node + block.cell_node_ends[i];
        std::ranges::copy(block.odd, out.odd.begin() + at.tet);
        std::ranges::copy(block.sources, out.sources.begin() + at.tet);
        std::ranges::copy(block.locals, out.locals.begin() + at.tet);
        for (std::size_t i = 0; i < block.row_ends.size(); ++i) first[at.row + i + 1] = at.term + block.row_ends[i];
        std::ranges::copy(block.row_points, terms.begin() + at.term);
        std::ranges::copy(block.row_weights, weights.begin() + at.term);
        block = {};
    });
    out.hidden = {std::move(first).to_array(), std::move(terms).to_array(), std::move(weights).to_array()};
    return out;
}

} // namespace

Result<QuadraticTets> quadratic_tets(const Grid& grid, CellNodeLists lists, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    if (auto sound = check_nodes(grid, *cells, progress); !sound) return sound.error();
    const std::uint64_t points = grid.points.tuples();
    const auto too_many = [&](std::uint64_t nodes) {
        return invalid_data(
            fmt::format("the grid has {} points, with those between them, but may have at most {} where "
                        "cells are quadratic",
                        nodes, max_nodes));
    };
    if (points >= max_nodes) return too_many(points);
    SharedNodes shared;
    if (const Holes holes = find_holes(CellNodes(grid, *cells, shared), *cells); holes.edges || holes.faces) {
        CellNodes nodes(grid, *cells, shared);
        SharedNodes found;
        for (std::size_t cell = 0; cell < cells->count() && !progress.cancelled(); ++cell) nodes.collect(cell, found);
        shared = std::move(found);
        shared.edges.sort();
        shared.faces.sort();
    }
    std::vector<CurvedBlock> blocks((cells->count() + curved_cells_per_block - 1) / curved_cells_per_block);
    core::parallel_pieces(blocks.size(), 4, progress, [&](std::size_t begin, std::size_t end) {
        CellNodes nodes(grid, *cells, shared);
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t last = std::min(cells->count(), (b + 1) * curved_cells_per_block);
            for (std::size_t cell = b * curved_cells_per_block; cell < last; ++cell) nodes.split(cell, lists, blocks[b]);
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "splitting curved cells was cancelled"};
    QuadraticTets out = joined_curved(blocks, points);
    if (points + out.hidden.count() >= max_nodes) return too_many(points + out.hidden.count());
    if (out.tets.empty())
        return invalid_data(
            fmt::format("the grid with {} points and {} cells has no cell that can be contoured: {} are "
                        "curved cells of a type or degree that is not handled",
                        points, cells->count(), out.unknown));
    return out;
}

} // namespace isotet::linear
