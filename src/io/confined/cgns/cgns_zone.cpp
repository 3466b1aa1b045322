// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/cgns/cgns_zone.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t max_zone_size = std::uint64_t{1} << 48U;

std::uint64_t product(const std::vector<std::uint64_t>& size) {
    return std::accumulate(size.begin(), size.end(), std::uint64_t{1}, std::multiplies<>());
}

/// Its values are the counts of points along each axis, then those of cells, then those of boundary points.
Result<void> read_size(const CgnsTree& tree, CgnsZone& zone) {
    const auto counts = tree.integers(zone.node);
    if (!counts) return counts.error();
    const std::size_t axes = counts->size() / 3;
    if (counts->size() % 3 != 0 || axes < 1 || axes > 3 || (!zone.is_structured && axes != 1))
        return invalid_data(fmt::format("its size has {} numbers", counts->size()));
    std::uint64_t most = max_zone_size;
    for (std::size_t i = 0; i < 2 * axes; ++i) {
        const double count = counts->at(i);
        if (!(count >= 0) || count > static_cast<double>(max_zone_size))
            return invalid_data(fmt::format("its size is {}", count));
        (i < axes ? zone.points : zone.cells).push_back(static_cast<std::uint64_t>(count));
        if (i < axes) most /= std::max<std::uint64_t>(zone.points.back(), 1);
        if (most == 0) return invalid_data("it has more points than any file can hold");
    }
    if (zone.is_structured) // what the file says of cells along an axis of one point differs
        for (std::size_t k = 0; k < axes; ++k) zone.cells[k] = zone.points[k] > 1 ? zone.points[k] - 1 : zone.points[k];
    return {};
}

std::vector<std::uint64_t> rind_of(const CgnsTree& tree, const std::vector<CgnsNode>& parts, std::size_t axes) {
    constexpr double most = 1 << 20;
    std::vector<std::uint64_t> rind(2 * axes, 0);
    const auto node = child_labelled(parts, "Rind_t");
    const auto planes = node ? tree.integers(*node) : Result<Array>(Array());
    if (!planes || planes->size() != 2 * axes) return rind;
    for (std::size_t i = 0; i < rind.size(); ++i)
        if (planes->at(i) > 0 && planes->at(i) < most) rind[i] = static_cast<std::uint64_t>(planes->at(i));
    return rind;
}

/// The core of a box of up to three axes; the first one is the fastest.
template <class T>
std::vector<T> core_of(std::span<const T> all, const std::vector<std::uint64_t>& size,
                       const std::vector<std::uint64_t>& rind) {
    std::array<std::uint64_t, 3> count{1, 1, 1}, stride{1, 1, 1}, first{0, 0, 0};
    for (std::size_t k = 0; k < size.size(); ++k) {
        count[k] = size[k];
        first[k] = rind[2 * k];
        if (k + 1 < 3) stride[k + 1] = stride[k] * (size[k] + rind[2 * k] + rind[2 * k + 1]);
    }
    std::vector<T> core;
    core.reserve(product(size));
    for (std::uint64_t z = 0; z < count[2]; ++z)
        for (std::uint64_t y = 0; y < count[1]; ++y) {
            const auto row = all.begin() + static_cast<std::ptrdiff_t>((z + first[2]) * stride[2] +
                                                                       (y + first[1]) * stride[1] + first[0]);
            core.insert(core.end(), row, row + static_cast<std::ptrdiff_t>(count[0]));
        }
    return core;
}

std::string names_of_arrays(const std::vector<CgnsNode>& parts) {
    std::string names;
    for (const CgnsNode& node : parts)
        if (node.label == "DataArray_t") names += " \"" + escaped(node.name) + "\"";
    return names.empty() ? " nothing else" : names;
}

Result<CgnsZone> zone_of(const CgnsTree& tree, const CgnsNode& base, const CgnsNode& node) {
    CgnsZone zone;
    zone.node = node;
    zone.name = base.name + "/" + node.name;
    zone.parts = tree.children(node);
    const auto type = child_labelled(zone.parts, "ZoneType_t");
    zone.is_structured = type && tree.text(*type).starts_with("Structured");
    const auto dimensions = tree.integers(base);
    if (dimensions && dimensions->size() > 0 && dimensions->at(0) >= 1 && dimensions->at(0) <= 3)
        zone.cell_dimension = static_cast<int>(dimensions->at(0));
    if (dimensions && dimensions->size() > 1 && dimensions->at(1) >= 1 && dimensions->at(1) <= 3)
        zone.dimension = static_cast<std::size_t>(dimensions->at(1));
    if (auto read = read_size(tree, zone); !read)
        return invalid_data(fmt::format("zone \"{}\": {}", escaped(zone.name), read.error().message));
    return zone;
}

} // namespace

std::uint64_t CgnsZone::point_count() const { return product(points); }

Result<std::vector<CgnsZone>> cgns_zones(const CgnsTree& tree, const std::string& path) {
    std::vector<CgnsZone> zones;
    std::size_t bases = 0;
    for (const CgnsNode& base : tree.children(tree.root())) {
        if (base.label != "CGNSBase_t") continue;
        for (const CgnsNode& node : tree.children(base)) {
            if (node.label != "Zone_t") continue;
            auto zone = zone_of(tree, base, node);
            if (!zone) return broken(path, zone.error().message);
            zone->base = bases;
            zones.push_back(*std::move(zone));
        }
        ++bases;
    }
    return zones;
}

std::uint64_t count_with_rind(const CgnsTree& tree, const std::vector<CgnsNode>& parts,
                              const std::vector<std::uint64_t>& size) {
    const auto rind = rind_of(tree, parts, size.size());
    std::uint64_t count = 1;
    for (std::size_t k = 0; k < size.size(); ++k) count *= size[k] + rind[2 * k] + rind[2 * k + 1];
    return count;
}

Result<Array> without_rind(const CgnsTree& tree, const std::vector<CgnsNode>& parts, const Array& values,
                           const std::vector<std::uint64_t>& size) {
    const auto rind = rind_of(tree, parts, size.size());
    const std::uint64_t needed = count_with_rind(tree, parts, size);
    if (values.size() != needed)
        return invalid_data(fmt::format("has {} values, but {} are needed", values.size(), needed));
    if (std::ranges::all_of(rind, [](std::uint64_t planes) { return planes == 0; })) return values;
    return values.visit([&](auto all) {
        using T = std::remove_const_t<typename decltype(all)::value_type>;
        return Array::own(core_of<T>(all, size, rind));
    });
}

Result<Array> cgns_points(const CgnsTree& tree, const CgnsZone& zone, const std::string& name) {
    auto node = child_named(zone.parts, name);
    if (!node || node->label != "GridCoordinates_t") node = child_labelled(zone.parts, "GridCoordinates_t");
    if (!node) return invalid_data("has no coordinates");
    const std::vector<CgnsNode> parts = tree.children(*node);
    std::vector<double> places(3 * zone.point_count(), 0);
    for (std::size_t axis = 0; axis < zone.dimension; ++axis) {
        const std::string wanted = std::string("Coordinate") + "XYZ"[axis];
        const auto coordinate = child_named(parts, wanted);
        if (!coordinate) return invalid_data(fmt::format("has no {}, but{}", wanted, names_of_arrays(parts)));
        const auto values = tree.numbers(*coordinate);
        if (!values) return values.error();
        const auto inside = without_rind(tree, parts, *values, zone.points);
        if (!inside) return invalid_data(fmt::format("{} {}", coordinate->name, inside.error().message));
        inside->visit([&](auto from) {
            for (std::size_t i = 0; i < from.size(); ++i) places[3 * i + axis] = static_cast<double>(from[i]);
        });
    }
    return Array::own(std::move(places), 3);
}

} // namespace isotet::io::confined
