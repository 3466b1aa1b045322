// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cell fields that were left in their file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/pieces/field_source.hpp"
#include "io/vtk_xml/array_in_file.hpp"

namespace isotet::io::vtk_xml {

/// Why an array is not read, without its name, which the sentence around has.
std::string reason_of(const Error& error, std::string_view name);

class UnreadValues final : public FieldSource {
public:
    /// `field`    without values; of a type that the others become
    /// `tuples`   one a cell
    /// `stored`   of which decode_some() can be called; nothing where the piece does not have the field
    UnreadValues(UnreadField field, std::uint64_t tuples, std::optional<ArrayInFile> stored)
        : field_(std::move(field)), tuples_(tuples), stored_(std::move(stored)) {}

    Result<Array> read(const std::vector<std::uint64_t>& cells) const override;
    Result<Array> read() const override;

private:
    template <class Decode>
    Result<Array> filled(std::size_t tuples, const Decode& decode) const;

    UnreadField field_;
    std::uint64_t tuples_;
    std::optional<ArrayInFile> stored_;
};

} // namespace isotet::io::vtk_xml
