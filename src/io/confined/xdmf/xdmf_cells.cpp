// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_cells.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/confined/xdmf/xdmf_document.hpp"
#include "io/pieces/join/shared_faces.hpp"

namespace isotet::io::confined {
namespace {

constexpr XdmfElement xdmf_elements[] = {
    {"Polyvertex", 1, 2, 0},        {"Polyline", 2, 4, 0},
    {"Polygon", 3, 7, 0},           {"Triangle", 4, 5, 3},
    {"Quadrilateral", 5, 9, 4},     {"Tetrahedron", 6, 10, 4},
    {"Pyramid", 7, 14, 5},          {"Wedge", 8, 13, 6},
    {"Hexahedron", 9, 12, 8},       {"Polyhedron", 16, xdmf_polyhedron, 0},
    {"Edge_3", 34, 21, 3},          {"Quadrilateral_9", 35, 28, 9},
    {"Triangle_6", 36, 22, 6},      {"Quadrilateral_8", 37, 23, 8},
    {"Tetrahedron_10", 38, 24, 10}, {"Pyramid_13", 39, 27, 13},
    {"Wedge_15", 40, 26, 15},       {"Wedge_18", 41, 32, 18},
    {"Hexahedron_20", 48, 25, 20},  {"Hexahedron_24", 49, 33, 24},
    {"Hexahedron_27", 50, 29, 27},  {"Tri_6", 36, 22, 6},
    {"Quad_8", 37, 23, 8},          {"Quad_9", 35, 28, 9},
    {"Tet_10", 38, 24, 10},         {"Hex_20", 48, 25, 20},
    {"Hex_24", 49, 33, 24},         {"Hex_27", 50, 29, 27},
};

Error wrong_cells(std::string what) { return {ErrorCode::invalid_data, std::move(what)}; }

/// Takes cells of a mixed topology off its numbers, one after another.
class MixedCells {
public:
    MixedCells(std::span<const std::int64_t> numbers, std::int64_t base) : numbers_(numbers), base_(base) {}

    bool at_end() const { return at_ == numbers_.size(); }
    std::size_t count() const { return types_.size(); }
    std::size_t position() const { return at_; }

    /// Nothing where it is sound.
    std::optional<std::string> take_coded() {
        const XdmfElement* element = nullptr;
        for (const XdmfElement& known : xdmf_elements)
            if (!element && !at_end() && numbers_[at_] == known.code) element = &known;
        if (!element)
            return fmt::format("element {} of a mixed topology, at number {}, has {}", count(), at_,
                               at_end() ? "no type: the numbers end"
                                        : fmt::format("type {}, which is not known", numbers_[at_]));
        ++at_;
        return take(*element);
    }
    std::optional<std::string> take(const XdmfElement& element) {
        if (element.type == xdmf_polyhedron) return take_faces();
        std::uint64_t corners = element.corners;
        if (corners == 0) {
            if (at_end() || numbers_[at_] < 0) return ends();
            corners = static_cast<std::uint64_t>(numbers_[at_++]);
        }
        if (corners > numbers_.size() - at_) return ends();
        for (std::uint64_t c = 0; c < corners; ++c) connectivity_.push_back(numbers_[at_++] - base_);
        finish(element.type);
        return std::nullopt;
    }

    Result<Cells> to_cells(std::uint64_t points) && {
        Cells cells;
        const bool has_faces = !faces_.empty();
        cells.connectivity = Array::own(std::move(connectivity_));
        cells.offsets = Array::own(std::move(offsets_));
        cells.types = Array::own(std::move(types_));
        if (!has_faces) return cells;
        cells.faces = Array::own(std::move(faces_));
        cells.face_offsets = Array::own(std::move(face_offsets_));
        if (auto listed = list_points_of_faces(points, cells); !listed) return listed.error();
        return cells;
    }

private:
    std::string ends() const {
        return fmt::format("element {} of a mixed topology ends after its last number", count());
    }
    std::optional<std::string> take_faces() {
        if (at_end() || numbers_[at_] < 0) return ends();
        const auto faces = static_cast<std::uint64_t>(numbers_[at_]);
        if (faces > numbers_.size() - at_) return ends();
        faces_.push_back(numbers_[at_++]);
        for (std::uint64_t face = 0; face < faces; ++face) {
            if (at_end() || numbers_[at_] < 0) return ends();
            const auto points = static_cast<std::uint64_t>(numbers_[at_]);
            if (points >= numbers_.size() - at_) return ends();
            faces_.push_back(numbers_[at_++]);
            for (std::uint64_t i = 0; i < points; ++i) faces_.push_back(numbers_[at_++] - base_);
        }
        finish(xdmf_polyhedron);
        return std::nullopt;
    }
    void finish(std::uint8_t type) {
        types_.push_back(type);
        offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
        face_offsets_.push_back(static_cast<std::int64_t>(faces_.size()));
    }

    std::span<const std::int64_t> numbers_;
    std::int64_t base_;
    std::size_t at_ = 0;
    std::vector<std::int64_t> connectivity_, offsets_{0}, faces_, face_offsets_{0};
    std::vector<std::uint8_t> types_;
};

template <class Take>
Result<Cells> take_cells(const Array& values, std::optional<std::uint64_t> count, std::uint64_t points,
                         std::int64_t base, const Take& take) {
    if (count && *count > values.size())
        return wrong_cells(
            fmt::format("{} mixed elements are stated, but there are {} numbers", *count, values.size()));
    std::vector<std::int64_t> numbers(values.size());
    xdmf_indices(values, 0).visit([&](auto from) {
        for (std::size_t i = 0; i < from.size(); ++i) numbers[i] = static_cast<std::int64_t>(from[i]);
    });
    MixedCells cells(numbers, base);
    while (count ? cells.count() < *count : !cells.at_end())
        if (const auto problem = take(cells)) return wrong_cells(*problem);
    if (!cells.at_end())
        return wrong_cells(fmt::format("{} mixed elements are stated, which end at number {} of {}", cells.count(),
                                       cells.position(), values.size()));
    return std::move(cells).to_cells(points);
}

} // namespace

const XdmfElement* xdmf_element(std::string_view name) {
    for (const XdmfElement& known : xdmf_elements)
        if (same_word(known.name, name)) return &known;
    return nullptr;
}

Array xdmf_indices(const Array& values, std::int64_t base) {
    if (base == 0 && !is_floating(values.type()) && size_of(values.type()) >= 4) return values;
    std::vector<std::int64_t> indices(values.size());
    values.visit([&](auto from) {
        for (std::size_t i = 0; i < from.size(); ++i) {
            const auto value = static_cast<double>(from[i]);
            const bool whole =
                value >= 0 && value < 9e15 && value == static_cast<double>(static_cast<std::int64_t>(value));
            indices[i] = whole ? std::max<std::int64_t>(static_cast<std::int64_t>(value) - base, -1) : -1;
        }
    });
    return Array::own(std::move(indices));
}

Result<Cells> uniform_elements(const XdmfElement& element, std::uint64_t corners, const Array& values,
                               std::int64_t base, std::span<const std::uint64_t> order) {
    if (corners == 0 || values.size() % corners != 0)
        return wrong_cells(fmt::format("{} corners of cells are no multiple of {}", values.size(), corners));
    const std::uint64_t count = values.size() / corners;
    Cells cells;
    cells.connectivity = xdmf_indices(values, base);
    if (!order.empty()) {
        if (order.size() != corners ||
            std::ranges::any_of(order, [&](std::uint64_t place) { return place >= corners; }))
            return wrong_cells(fmt::format("the Order of a topology is no order of {} corners", corners));
        std::vector<std::int64_t> ordered(values.size());
        cells.connectivity.visit([&](auto from) {
            for (std::size_t i = 0; i < ordered.size(); ++i)
                ordered[i] = static_cast<std::int64_t>(from[i / corners * corners + order[i % corners]]);
        });
        cells.connectivity = Array::own(std::move(ordered));
    }
    if (element.type >= 10 && element.type <= 14) {
        cells.uniform_type = static_cast<CellType>(element.type);
        return cells;
    }
    std::vector<std::int64_t> offsets(count + 1);
    for (std::uint64_t i = 0; i <= count; ++i) offsets[i] = static_cast<std::int64_t>(i * corners);
    cells.offsets = Array::own(std::move(offsets));
    cells.types = Array::own(std::vector<std::uint8_t>(count, element.type));
    return cells;
}

Result<Cells> mixed_elements(const Array& values, std::optional<std::uint64_t> count, std::uint64_t points,
                             std::int64_t base) {
    return take_cells(values, count, points, base, [](MixedCells& cells) { return cells.take_coded(); });
}

Result<Cells> polyhedral_elements(const Array& values, std::optional<std::uint64_t> count, std::uint64_t points,
                                  std::int64_t base) {
    const XdmfElement& polyhedron = *xdmf_element("Polyhedron");
    auto plain = take_cells(values, count, points, base, [&](MixedCells& cells) { return cells.take(polyhedron); });
    if (plain) return plain;
    auto coded = mixed_elements(values, count, points, base);
    return coded ? std::move(coded) : std::move(plain);
}

} // namespace isotet::io::confined
