// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A CGNS file (ADF or HDF5) as a tree of nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

namespace isotet::io::confined {

struct CgnsNode {
    double id = 0;
    std::string name, label;
};

/// Empty where there is none of that name.
std::optional<CgnsNode> child_named(const std::vector<CgnsNode>& nodes, std::string_view name);
std::optional<CgnsNode> child_labelled(const std::vector<CgnsNode>& nodes, std::string_view label);

/// An open file. Links are followed.
class CgnsTree {
public:
    /// Errors   invalid_data: not such a file
    static Result<CgnsTree> open(const std::string& path);
    CgnsTree(CgnsTree&& other) noexcept;
    CgnsTree& operator=(CgnsTree&&) = delete;
    ~CgnsTree();

    CgnsNode root() const { return {root_, {}, {}}; }
    /// In the order of the file; none where they cannot be read.
    std::vector<CgnsNode> children(const CgnsNode& node) const;
    /// The values of a node as int32 or int64, one component, whatever its dimensions.
    ///
    /// Errors   invalid_data: no integers, more than the file can have, values that cannot be read
    Result<Array> integers(const CgnsNode& node) const;
    /// The same of numbers of any type.
    Result<Array> numbers(const CgnsNode& node) const;
    /// What numbers() would give, without the values: their type and count.
    struct Shape {
        std::string type; ///< as CGNS calls it: "R8"
        std::uint64_t count = 0;
        std::optional<ScalarType> scalar; ///< nothing: it holds no numbers
    };
    Result<Shape> shape(const CgnsNode& node) const;
    /// Empty where it is no text.
    std::string text(const CgnsNode& node) const;
    /// Texts of so many letters each, one after another, without the spaces at their ends.
    std::vector<std::string> texts(const CgnsNode& node, std::size_t letters) const;

private:
    Error wrong(const CgnsNode& node, std::string_view what) const;
    template <class T>
    Result<Array> values(const CgnsNode& node, const Shape& shape) const;

    explicit CgnsTree(std::string path) : path_(std::move(path)) {}

    std::string path_;
    int number_ = -1;
    double root_ = 0;
};

} // namespace isotet::io::confined
