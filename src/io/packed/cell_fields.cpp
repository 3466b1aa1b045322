// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/cell_fields.hpp"

#include <algorithm>
#include <span>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/crc32c.hpp"
#include "io/files/first_error.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io {

std::vector<std::uint32_t> block_checksums(const Array& values) {
    const std::span<const std::byte> all(static_cast<const std::byte*>(values.data()), values.bytes());
    std::vector<std::uint32_t> checksums(CellFieldEntry::blocks(all.size()));
    core::parallel_each(checksums.size(), 1, [&](std::size_t i) {
        const auto rest = all.subspan(i * cell_block_bytes);
        checksums[i] = crc32c(rest.first(std::min(rest.size(), cell_block_bytes)));
    });
    return checksums;
}

const CellFieldEntry* find_cell_field(const PackedDirectory& directory, std::string_view name, std::size_t step) {
    const CellFieldEntry* found = nullptr;
    for (const CellFieldEntry& field : directory.cell_fields) // steps ascend
        if (field.name == name && field.step <= step) found = &field;
    return found;
}

std::vector<const CellFieldEntry*> cell_fields_at(const PackedDirectory& directory, std::size_t step) {
    std::vector<const CellFieldEntry*> fields;
    for (const CellFieldEntry& field : directory.cell_fields)
        if (find_cell_field(directory, field.name, step) == &field) fields.push_back(&field);
    return fields;
}

Result<Array> read_cell_field(const PackedSource& source, const CellFieldEntry& field, const Progress& progress) {
    const std::uint64_t bytes = field.bytes(source.directory.user_cells);
    if (auto ok = core::require_memory(fmt::format("cell field {} of {}", in_quotes(field.name), source.path), bytes);
        !ok)
        return ok.error();
    core::Buffer<std::uint8_t> all(bytes);
    FirstError first_error;
    core::parallel_each(field.checksums.size(), 1, [&](std::size_t i) {
        if (progress.cancelled() || first_error) return;
        const std::uint64_t at = i * cell_block_bytes;
        const auto block =
            std::as_writable_bytes(std::span(all.data() + at, std::min<std::uint64_t>(cell_block_bytes, bytes - at)));
        if (auto ok = source.read(field.offset + at, block); !ok) return first_error.add(i, ok.error());
        if (crc32c(block) != field.checksums[i])
            first_error.add(i, invalid_data(fmt::format("cell field {} is broken: the checksum of block {} differs",
                                                        in_quotes(field.name), i)));
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    if (auto ok = first_error.result(); !ok) return source.in_file(ok.error());
    const Array kept = std::move(all).to_array();
    return Array(field.type, kept.data(), source.directory.user_cells, field.components, kept.owner().lock());
}

} // namespace isotet::io
