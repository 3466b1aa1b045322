// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/pack_column.hpp"

#include <algorithm>
#include <bit>
#include <span>

#include "base/parallel.hpp"
#include "io/vtk_xml/codec.hpp"

namespace isotet::io {

namespace {

constexpr std::size_t most_block_bytes = std::size_t{1} << 18;

vtk_xml::Codec codec_of(Compression compression) {
    return compression == Compression::zlib ? vtk_xml::Codec::zlib : vtk_xml::Codec::lz4;
}

} // namespace

std::uint64_t PackedColumn::bytes() const {
    std::uint64_t sum = (3 + blocks.size()) * sizeof(std::uint64_t);
    for (const std::string& block : blocks) sum += block.size();
    return sum;
}

void PackedColumn::write(WriteStream& stream) const {
    for (const std::uint64_t number : {std::uint64_t{blocks.size()}, block_bytes, last_bytes})
        stream.number(number, std::endian::little);
    for (const std::string& block : blocks) stream.number(std::uint64_t{block.size()}, std::endian::little);
    for (const std::string& block : blocks) stream.text(block);
}

PackedColumn pack_column(const Column& column, Compression compression, const Progress& progress) {
    PackedColumn packed;
    const std::size_t tuple = column.tuple_bytes();
    if (column.tuples == 0 || tuple == 0) return packed;
    const std::size_t at_once = std::max<std::size_t>(1, most_block_bytes / tuple);
    packed.block_bytes = at_once * tuple;
    packed.last_bytes = column.tuples % at_once * tuple; // 0: the last block is as long as all others
    packed.blocks.resize((column.tuples + at_once - 1) / at_once);
    core::parallel_pieces(packed.blocks.size(), 1, progress, [&](std::size_t first, std::size_t last) {
        std::vector<std::byte> buffer(std::min(at_once, column.tuples) * tuple);
        for (std::size_t block = first; block < last; ++block) {
            const std::size_t begin = block * at_once, end = std::min(column.tuples, begin + at_once);
            column.fill(begin, end, buffer.data());
            if (std::endian::native != std::endian::little)
                swap_bytes(buffer.data(), (end - begin) * column.components, size_of(column.type));
            packed.blocks[block] =
                vtk_xml::deflate(codec_of(compression), std::span(buffer).first((end - begin) * tuple));
        }
    });
    return packed;
}

} // namespace isotet::io
