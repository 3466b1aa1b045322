// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_finite_element.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

/// How a cell's numbers are arranged: of each component first those of the corners.
struct ElementOfFunction {
    std::string_view cell;
    unsigned degree;
    std::size_t nodes; ///< values of a component in a cell
    CellType type;
    std::span<const std::uint8_t> corners; ///< for each corner its place among the nodes
    std::span<const std::uint8_t> middles; ///< for each of VTK's edges that of the node on it
};

constexpr std::array<std::uint8_t, 4> of_tetrahedron{0, 1, 2, 3};
constexpr std::array<std::uint8_t, 8> of_hexahedron{0, 1, 3, 2, 4, 5, 7, 6}; // as a tensor product
/// UFC numbers edges by the corners that they do not touch.
constexpr std::array<std::uint8_t, 6> of_tet_edges{9, 6, 8, 7, 5, 4};
constexpr ElementOfFunction elements_of_functions[] = {
    {"tetrahedron", 0, 1, CellType::tetrahedron, {}, {}},
    {"tetrahedron", 1, 4, CellType::tetrahedron, of_tetrahedron, {}},
    {"tetrahedron", 2, 10, CellType::tetrahedron, of_tetrahedron, of_tet_edges},
    {"hexahedron", 0, 1, CellType::hexahedron, {}, {}},
    {"hexahedron", 1, 8, CellType::hexahedron, of_hexahedron, {}},
};

unsigned degree_of(pugi::xml_node attribute) { return attribute.attribute("ElementDegree").as_uint(99); }

const ElementOfFunction* element_of(pugi::xml_node attribute) {
    const std::string_view family = attribute.attribute("ElementFamily").as_string();
    const bool known =
        std::ranges::any_of(std::array{"CG", "Lagrange", "P", "Q", "DG", "Discontinuous Lagrange", "DP", "DQ"},
                            [&](const char* name) { return same_word(family, name); });
    for (const ElementOfFunction& element : elements_of_functions)
        if (known && element.degree == degree_of(attribute) &&
            same_word(element.cell, attribute.attribute("ElementCell").as_string()))
            return &element;
    return nullptr;
}

Error wrong_function(std::string what) { return {ErrorCode::invalid_data, std::move(what)}; }

/// The values of cells, one row a cell.
class CellRows {
public:
    CellRows(Array numbers, Array values, std::size_t width)
        : numbers_(std::move(numbers)), values_(std::move(values)), width_(width) {}

    Result<void> check(std::size_t cells) const {
        if (numbers_.size() != cells * width_)
            return wrong_function(fmt::format("{} cells of {} values have {} numbers", cells, width_, numbers_.size()));
        for (std::size_t i = 0; i < numbers_.size(); ++i)
            if (is_floating(numbers_.type()) || number_at(numbers_, i) >= values_.size())
                return wrong_function(
                    fmt::format("cell {} has value {}, but there are {}", i / width_, numbers_.at(i), values_.size()));
        return {};
    }
    double at(std::size_t cell, std::size_t place) const {
        return values_.at(number_at(numbers_, cell * width_ + place));
    }

private:
    Array numbers_, values_;
    std::size_t width_;
};

/// Differences up to this part of the range are rounding.
constexpr double rounding = 1e-9;

/// One component at the points: the first cell's value, or where cells differ the mean.
class PointMeans {
public:
    explicit PointMeans(std::size_t points)
        : first_(points, std::numeric_limits<double>::quiet_NaN()),
          sum_(points, 0),
          count_(points, 0),
          jump_(points, 0) {}

    void add(std::size_t point, double value) {
        if (count_[point]++ == 0) first_[point] = value;
        sum_[point] += value;
        jump_[point] = std::max(jump_[point], std::abs(value - first_[point]));
        if (std::isfinite(value)) lower_ = std::min(lower_, value), upper_ = std::max(upper_, value);
    }
    /// How many points have a mean.
    std::size_t write(std::span<double> to, std::size_t component, std::size_t components) const {
        std::size_t jumps = 0;
        for (std::size_t point = 0; point < first_.size(); ++point) {
            const bool jumps_here = jump_[point] > rounding * std::max(0.0, upper_ - lower_);
            if (jumps_here) ++jumps;
            to[point * components + component] = jumps_here ? sum_[point] / count_[point] : first_[point];
        }
        return jumps;
    }

private:
    std::vector<double> first_, sum_;
    std::vector<std::uint32_t> count_;
    std::vector<double> jump_;
    double lower_ = std::numeric_limits<double>::infinity(), upper_ = -std::numeric_limits<double>::infinity();
};

Result<FunctionValues> values_of_cells(const CellRows& rows, std::size_t cells, std::size_t components) {
    std::vector<double> values(cells * components);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = rows.at(i / components, i % components);
    return FunctionValues{components, Array::own(std::move(values), components), {}};
}

Result<FunctionValues> values_of_points(const CellRows& rows, const ElementOfFunction& element, XdmfMesh& mesh,
                                        std::size_t components) {
    const Cells& cells = mesh.grid.cells;
    const std::size_t corners = element.corners.size();
    if (!cells.offsets.empty() || cells.uniform_type != element.type)
        return wrong_function(fmt::format("it is of {} cells, but those of the mesh are others", element.cell));
    auto edges = mesh.edges;
    if (!edges && !element.middles.empty()) edges = std::make_shared<const TetEdges>(cells.connectivity);
    const std::size_t places = mesh.points + (element.middles.empty() ? 0 : edges->count());
    std::vector<double> values(places * components);
    std::size_t jumps = 0;
    for (std::size_t component = 0; component < components; ++component) {
        PointMeans means(places);
        for (std::size_t i = 0; i < cells.connectivity.size(); ++i) {
            const std::uint64_t point = number_at(cells.connectivity, i);
            if (point >= mesh.points)
                return wrong_function(
                    fmt::format("cell {} of its mesh has point {} of {}", i / corners, point, mesh.points));
            means.add(point, rows.at(i / corners, component * element.nodes + element.corners[i % corners]));
        }
        for (std::size_t cell = 0; cell < mesh.cells && !element.middles.empty(); ++cell)
            for (std::size_t k = 0; k < element.middles.size(); ++k)
                means.add(mesh.points + edges->number(cell, k),
                          rows.at(cell, component * element.nodes + element.middles[k]));
        jumps += means.write(values, component, components);
    }
    FunctionValues found{components, Array::own(std::move(values), components), {}};
    if (jumps > 0) found.note = fmt::format("differs between cells at {} points: the mean was taken", jumps);
    mesh.edges = std::move(edges);
    return found;
}

} // namespace

bool is_finite_element_function(pugi::xml_node attribute) {
    return same_word(attribute.attribute("ItemType").as_string(), "FiniteElementFunction");
}

Association association_of_function(pugi::xml_node attribute) {
    return degree_of(attribute) == 0 ? Association::cell : Association::point;
}

Result<FunctionValues> read_function_values(const XdmfFile& file, pugi::xml_node attribute, XdmfMesh& mesh,
                                            Depth depth) {
    const ElementOfFunction* const element = element_of(attribute);
    if (!element)
        return wrong_function(fmt::format("a finite element function of family \"{}\" and degree {} on cell \"{}\" is "
                                          "not read: CG and DG are, of degree "
                                          "0 to 2 on tetrahedra, 0 and 1 on hexahedra",
                                          escaped(attribute.attribute("ElementFamily").as_string()),
                                          escaped(attribute.attribute("ElementDegree").as_string()),
                                          escaped(attribute.attribute("ElementCell").as_string())));
    const auto items = file.document.children(attribute, "DataItem");
    if (items.size() < 2) return wrong_function("a finite element function needs two DataItems and more");
    const auto numbers = file.data.read(items[0], depth), values = file.data.read(items[1], depth);
    if (!numbers) return numbers.error();
    if (!values) return values.error();
    const std::uint64_t width = mesh.cells == 0 ? 0 : numbers->count() / mesh.cells;
    if (width == 0 || numbers->count() % mesh.cells != 0 || width % element->nodes != 0)
        return wrong_function(fmt::format("it has {} numbers of values for {} cells, which are no multiple of {} each",
                                          numbers->count(), mesh.cells, element->nodes));
    FunctionValues found{width / element->nodes, Array(ScalarType::float64, nullptr, 0, 1, nullptr), {}};
    if (depth == Depth::description) return found;
    if (items.size() > 2) {
        const auto begins = file.data.read(items[2], Depth::arrays);
        if (!begins) return begins.error();
        for (std::size_t i = 0; i < begins->values.size(); ++i)
            if (number_at(begins->values, i) != i * width)
                return wrong_function(
                    fmt::format("its cells have different numbers of values: those of cell {} begin at "
                                "{}, not at {}",
                                i, begins->values.at(i), i * width));
    }
    const CellRows rows(numbers->values, values->values, width);
    if (auto sound = rows.check(mesh.cells); !sound) return sound.error();
    return element->corners.empty() ? values_of_cells(rows, mesh.cells, found.components)
                                    : values_of_points(rows, *element, mesh, found.components);
}

} // namespace isotet::io::confined
