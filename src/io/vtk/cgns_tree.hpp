// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A CGNS file (ADF or HDF5) as a tree of nodes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

namespace isotet::io::vtk {

struct CgnsNode {
    double id = 0;
    std::string name, label;
};

/// An open file. Links are followed, as VTK's reader does.
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
    /// The same of float32 or float64.
    Result<Array> reals(const CgnsNode& node) const;
    /// That a node has at least so many values of a type, the first of which can be read.
    Result<void> check_values(const CgnsNode& node, std::uint64_t least) const;
    /// Empty where it is no text.
    std::string text(const CgnsNode& node) const;

private:
    struct Shape {
        std::string type;
        std::uint64_t count = 0;
    };
    Error wrong(const CgnsNode& node, std::string_view what) const;
    Result<Shape> shape(const CgnsNode& node) const;
    template <class T>
    Result<Array> values(const CgnsNode& node, const Shape& shape) const;

    explicit CgnsTree(std::string path) : path_(std::move(path)) {}

    std::string path_;
    int number_ = -1;
    double root_ = 0;
};

} // namespace isotet::io::vtk
