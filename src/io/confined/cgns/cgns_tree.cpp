// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/cgns/cgns_tree.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include <cgns_io.h>
#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

std::optional<ScalarType> scalar_type_of_cgns(std::string_view type) {
    struct Named {
        std::string_view name;
        ScalarType type;
    };
    for (const Named& named :
         {Named{"R4", ScalarType::float32}, Named{"R8", ScalarType::float64}, Named{"I4", ScalarType::int32},
          Named{"I8", ScalarType::int64}, Named{"U4", ScalarType::uint32}, Named{"U8", ScalarType::uint64},
          Named{"B1", ScalarType::uint8}})
        if (named.name == type) return named.type;
    return std::nullopt;
}

std::optional<CgnsNode> found_or_nothing(const std::vector<CgnsNode>& nodes,
                                         std::vector<CgnsNode>::const_iterator found) {
    return found == nodes.end() ? std::nullopt : std::optional(*found);
}

} // namespace

std::optional<CgnsNode> child_named(const std::vector<CgnsNode>& nodes, std::string_view name) {
    return found_or_nothing(nodes, std::ranges::find(nodes, name, &CgnsNode::name));
}

std::optional<CgnsNode> child_labelled(const std::vector<CgnsNode>& nodes, std::string_view label) {
    return found_or_nothing(nodes, std::ranges::find(nodes, label, &CgnsNode::label));
}

Result<CgnsTree> CgnsTree::open(const std::string& path) {
    CgnsTree tree(path);
    if (cgio_open_file(path.c_str(), CGIO_MODE_READ, CGIO_FILE_NONE, &tree.number_) != CGIO_ERR_NONE) {
        tree.number_ = -1;
        return broken(path, "not a CGNS file, or a broken one");
    }
    if (cgio_get_root_id(tree.number_, &tree.root_) != CGIO_ERR_NONE) return broken(path, "its CGNS tree has no root");
    return tree;
}

CgnsTree::CgnsTree(CgnsTree&& other) noexcept
    : path_(std::move(other.path_)), number_(std::exchange(other.number_, -1)), root_(other.root_) {}

CgnsTree::~CgnsTree() {
    if (number_ >= 0) cgio_close_file(number_);
}

std::vector<CgnsNode> CgnsTree::children(const CgnsNode& node) const {
    std::vector<CgnsNode> nodes;
    int count = 0;
    if (cgio_number_children(number_, node.id, &count) != CGIO_ERR_NONE) return nodes;
    for (int i = 1; i <= count; ++i) {
        double id = 0;
        int found = 0;
        std::array<char, CGIO_MAX_NAME_LENGTH + 1> name{};
        std::array<char, CGIO_MAX_LABEL_LENGTH + 1> label{};
        if (cgio_children_ids(number_, node.id, i, 1, &found, &id) != CGIO_ERR_NONE || found != 1) continue;
        if (cgio_get_name(number_, id, name.data()) != CGIO_ERR_NONE ||
            cgio_get_label(number_, id, label.data()) != CGIO_ERR_NONE)
            continue;
        nodes.push_back({id, name.data(), label.data()});
    }
    return nodes;
}

Error CgnsTree::wrong(const CgnsNode& node, std::string_view what) const {
    return broken(path_, fmt::format("the CGNS node \"{}\" {}", escaped(node.name), what));
}

Result<CgnsTree::Shape> CgnsTree::shape(const CgnsNode& node) const {
    std::array<char, CGIO_MAX_DATATYPE_LENGTH + 1> type{};
    std::array<cgsize_t, CGIO_MAX_DIMENSIONS> dimensions{};
    int rank = 0;
    if (cgio_get_data_type(number_, node.id, type.data()) != CGIO_ERR_NONE ||
        cgio_get_dimensions(number_, node.id, &rank, dimensions.data()) != CGIO_ERR_NONE)
        return wrong(node, "cannot be read");
    Shape shape{type.data(), rank > 0 ? std::uint64_t{1} : 0, scalar_type_of_cgns(type.data())};
    for (int i = 0; i < rank; ++i) {
        const auto size = static_cast<std::uint64_t>(dimensions[static_cast<std::size_t>(i)]);
        constexpr std::uint64_t most = std::uint64_t{1} << 48U;
        if (size > most || (size > 0 && shape.count > most / size))
            return wrong(node, fmt::format("has a dimension of {}", size));
        shape.count *= size;
    }
    return shape;
}

template <class T>
Result<Array> CgnsTree::values(const CgnsNode& node, const Shape& shape) const {
    std::vector<T> values(shape.count);
    // Of ADF files the library gives values in the type of the file only.
    if (shape.count > 0 &&
        cgio_read_all_data_type(number_, node.id, shape.type.c_str(), values.data()) != CGIO_ERR_NONE &&
        cgio_read_all_data(number_, node.id, values.data()) != CGIO_ERR_NONE)
        return wrong(node, fmt::format("has {} values that cannot be read", shape.count));
    return Array::own(std::move(values));
}

Result<Array> CgnsTree::integers(const CgnsNode& node) const {
    const auto found = shape(node);
    if (!found) return found.error();
    if (found->type == "I4") return values<std::int32_t>(node, *found);
    if (found->type == "I8") return values<std::int64_t>(node, *found);
    return wrong(node, fmt::format("is of type \"{}\", not I4 or I8", escaped(found->type)));
}

Result<Array> CgnsTree::numbers(const CgnsNode& node) const {
    const auto found = shape(node);
    if (!found) return found.error();
    if (!found->scalar) return wrong(node, fmt::format("is of type \"{}\", which is no number", escaped(found->type)));
    return Array(*found->scalar, nullptr, 0, 1, nullptr).visit([&](auto none) {
        return values<std::remove_const_t<typename decltype(none)::value_type>>(node, *found);
    });
}

std::string CgnsTree::text(const CgnsNode& node) const {
    const auto found = shape(node);
    if (!found || found->type != "C1" || found->count > 4096) return {};
    const auto read = values<std::int8_t>(node, *found);
    if (!read) return {};
    const auto letters = read->as<std::int8_t>();
    return {letters.begin(), letters.end()};
}

std::vector<std::string> CgnsTree::texts(const CgnsNode& node, std::size_t letters) const {
    constexpr std::uint64_t most = 1 << 26;
    const auto found = shape(node);
    if (!found || found->type != "C1" || found->count > most) return {};
    const auto read = values<std::int8_t>(node, *found);
    if (!read) return {};
    std::vector<std::string> texts;
    const auto all = read->as<std::int8_t>();
    for (std::size_t at = 0; at + letters <= all.size(); at += letters) {
        std::string& text = texts.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                                               all.begin() + static_cast<std::ptrdiff_t>(at + letters));
        text.resize(std::min(text.find('\0'), text.size()));
        text.resize(text.find_last_not_of(' ') + 1);
    }
    return texts;
}

} // namespace isotet::io::confined
