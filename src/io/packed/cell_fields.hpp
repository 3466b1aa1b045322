// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cell fields in a packed file: the user's arrays as they are, by the user's cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/packed/piece_reader.hpp"

namespace isotet::io {

/// Of each block of an array.
std::vector<std::uint32_t> block_checksums(const Array& values);

/// The entry that holds at a step: of that step, or of the last one before it that has the field. Null: there is none.
const CellFieldEntry* find_cell_field(const PackedDirectory& directory, std::string_view name, std::size_t step);

/// The fields that hold at a step, each once.
std::vector<const CellFieldEntry*> cell_fields_at(const PackedDirectory& directory, std::size_t step);

/// Errors   file; invalid_data: a checksum differs; out_of_memory; cancelled
Result<Array> read_cell_field(const PackedSource& source, const CellFieldEntry& field, const Progress& progress);

} // namespace isotet::io
