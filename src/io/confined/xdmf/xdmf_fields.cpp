// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_fields.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/core.h>

#include "io/confined/xdmf/xdmf_finite_element.hpp"
#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/tensor_order.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {
namespace {

std::string without_time(std::string name, std::optional<double> time) {
    const auto slash = name.rfind('/');
    if (!time || slash == std::string::npos || slash == 0) return name;
    std::string number = name.substr(slash + 1);
    std::ranges::replace(number, '_', '.');
    double value = 0;
    constexpr double digits_of_text = 1e-6;
    if (parse_number(number, value) && std::abs(value - *time) <= digits_of_text * std::max(1.0, std::abs(*time)))
        name.resize(slash);
    return name;
}

/// Of points or cells, by their numbers.
bool is_set(pugi::xml_node node) { return std::string_view(node.name()) == "Set"; }

const char* center_of(pugi::xml_node node) {
    return node.attribute(is_set(node) ? "SetType" : "Center").as_string("Node");
}

std::optional<Association> association_of(pugi::xml_node attribute) {
    if (is_finite_element_function(attribute)) return association_of_function(attribute);
    const std::string_view center = center_of(attribute);
    if (same_word(center, "Node")) return Association::point;
    if (same_word(center, "Cell")) return Association::cell;
    return std::nullopt;
}

/// 1 for those in the set, 0 for others.
Result<Array> marks_of(const Array& numbers, std::uint64_t count) {
    std::vector<std::uint8_t> marks(count);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double number = numbers.at(i);
        if (!(number >= 0) || number >= static_cast<double>(count) || number != std::floor(number))
            return Error{ErrorCode::invalid_data, fmt::format("it has the number {}, but 0 to {} is the rule", number,
                                                              static_cast<std::int64_t>(count) - 1)};
        marks[static_cast<std::size_t>(number)] = 1;
    }
    return Array::own(std::move(marks));
}

Array with_components(const Array& values, std::size_t components) {
    auto owner = std::make_shared<Array>(values);
    return Array(values.type(), values.data(), values.size() / components, components, owner);
}

} // namespace

std::vector<XdmfField> fields_of(const XdmfDocument& document, pugi::xml_node grid, std::optional<double> time) {
    std::vector<XdmfField> fields;
    for (const char* tag : {"Attribute", "Set"})
        for (const pugi::xml_node stated : document.children(grid, tag)) {
            const pugi::xml_node node = document.resolve(stated);
            std::string name = without_time((node ? node : stated).attribute("Name").as_string(), time);
            if (name.empty())
                name = fmt::format("{}_{}", tag == std::string_view("Set") ? "set" : "attribute", fields.size());
            fields.push_back({node, std::move(name), association_of(node ? node : stated)});
        }
    return fields;
}

Result<void> XdmfFieldReader::read(const XdmfField& field, XdmfMesh& mesh, Depth depth, Loaded& loaded) {
    const char* const kind = !field.association                        ? "attribute"
                             : field.association == Association::point ? "point field"
                                                                       : "cell field";
    const auto [known, is_new] = mesh.fields.try_emplace(fmt::format("{} {}", kind, field.name), field.node);
    if (!is_new && known->second == field.node) return {};
    if (!is_new) {
        leave_out(loaded.info, {kind, field.name, "another one of the same grid, before it, has its name"});
        return {};
    }
    auto done = read_values(field, mesh, depth, loaded);
    if (done || done.error().code == ErrorCode::out_of_memory) return done;
    leave_out(loaded.info, {kind, field.name, done.error().message});
    return {};
}

Result<void> XdmfFieldReader::read_values(const XdmfField& field, XdmfMesh& mesh, Depth depth, Loaded& loaded) {
    if (!field.node) return Error{ErrorCode::invalid_data, "it refers to nothing"};
    if (!field.association)
        return Error{ErrorCode::invalid_data,
                     fmt::format("its {} is \"{}\", but Node and Cell are read",
                                 is_set(field.node) ? "SetType" : "Center", escaped(center_of(field.node)))};
    const bool on_points = *field.association == Association::point;
    const bool want = depth == Depth::arrays && wanted(options_, *field.association, field.name);
    auto& fields = on_points ? mesh.grid.point_fields : mesh.grid.cell_fields;
    const Depth of_field = want ? Depth::arrays : Depth::description;
    if (is_finite_element_function(field.node)) {
        auto function = read_function_values(file_, field.node, mesh, of_field);
        if (!function) return function.error();
        announce(loaded.info, {field.name, *field.association, ScalarType::float64, function->components});
        if (want) fields.push_back({field.name, std::move(function->values)});
        if (!function->note.empty())
            loaded.notes.push_back(fmt::format("function \"{}\" {}", escaped(field.name), function->note));
        return {};
    }
    const std::uint64_t tuples = on_points ? mesh.points : mesh.cells;
    if (is_set(field.node)) {
        const auto numbers = file_.data.read_indices(file_.document.child(field.node, "DataItem"), of_field);
        if (!numbers) return numbers.error();
        auto marks = want ? marks_of(numbers->values, tuples) : Array();
        if (!marks) return marks.error();
        announce(loaded.info, {field.name, *field.association, ScalarType::uint8, 1});
        if (want) fields.push_back({field.name, *std::move(marks)});
        return {};
    }
    const auto values = file_.data.read(file_.document.child(field.node, "DataItem"), of_field);
    if (!values) return values.error();
    if (tuples == 0) return {};
    if (values->count() % tuples != 0 || values->count() == 0)
        return Error{ErrorCode::invalid_data, fmt::format("it has {} values for {} {}", values->count(), tuples,
                                                          on_points ? "points" : "cells")};
    const std::uint64_t components = values->count() / tuples;
    announce(loaded.info, {field.name, *field.association, values->values.type(), components});
    if (!want) return {};
    const std::string_view type = field.node.attribute("AttributeType").value();
    fields.push_back({field.name, components == 6 && same_word(type, "Tensor6")
                                      ? ordered_as_vtk(values->values, order_of_upper_rows)
                                      : with_components(values->values, components)});
    return {};
}

} // namespace isotet::io::confined
