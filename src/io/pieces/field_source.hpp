// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cell fields that are read after the cells of their piece, so that only the values of those that are kept are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

#include "grid/surface_rows.hpp"

namespace isotet::io {

/// One value for each cell of a piece, in its file.
///
/// Threads   safe from many threads
class FieldSource {
public:
    FieldSource() = default;
    FieldSource(const FieldSource&) = delete;
    FieldSource& operator=(const FieldSource&) = delete;
    virtual ~FieldSource() = default;

    /// Of some cells, in ascending order.
    ///
    /// Errors   invalid_data: why the field cannot be read, without its name; file: it was changed meanwhile; cancelled
    virtual Result<Array> read(const std::vector<std::uint64_t>& cells) const = 0;

    /// Of all.
    virtual Result<Array> read() const = 0;
};

/// Values that are in memory after all.
class FieldInMemory final : public FieldSource {
public:
    explicit FieldInMemory(Array values) : values_(std::move(values)) {}

    Result<Array> read(const std::vector<std::uint64_t>& cells) const override { return core::rows_of(values_, cells); }
    Result<Array> read() const override { return values_; }

private:
    Array values_;
};

struct UnreadField {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
    std::shared_ptr<const FieldSource> values = {};
};

} // namespace isotet::io
