// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The values of a DataArray: where they are stored, checked before memory is taken, then decoded on all threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"
#include "io/vtk_xml/document.hpp"

namespace isotet::io::vtk_xml {

/// Bytes in a file, raw or as base64.
struct Stream {
    ByteSource source{std::string_view()};
    Range place;
    bool base64 = false;
    std::shared_ptr<const std::string> text; ///< of base64 with line breaks: the source is this, without them

    /// Bytes that it may have.
    std::size_t size() const noexcept { return base64 ? place.size() / 4 * 3 : place.size(); }

    /// `count` bytes from byte `at` on. `scratch` holds them until its next use.
    ///
    /// Errors   invalid_data: they are not there, or no base64
    Result<std::string_view> view(std::size_t at, std::size_t count, Scratch& scratch) const;
};

/// Values that were found and whose number is plausible. Borrows the document.
class StoredArray {
public:
    /// Looks for the first `scalars` values of an array (of arrays of bits: after unpacking).
    ///
    /// Errors   invalid_data: fewer are there, sizes in front of blocks that cannot be, arrays that share a part of their
    ///          bytes (those that begin at one place may);
    ///          out_of_memory: LZMA blocks that claim more than is free
    static Result<StoredArray> find(Document& document, const DataArray& array, std::uint64_t scalars,
                                    const Progress& progress);

    /// Writes the values, in this machine's byte order, symmetric tensors in VTK's order. Sets `more` where others stand behind them.
    ///
    /// `to`     room for them
    /// Errors   invalid_data: blocks that cannot be inflated, words that are no numbers; file, machine; cancelled
    /// Cost     parallel by blocks; a thread takes 256 KB or, where that is more, a block as it is stored and as it becomes
    Result<void> decode(std::byte* to, bool* more = nullptr) const;

    /// The same of some tuples, in ascending order. Blocks that have none of them are not read.
    Result<void> decode_some(std::span<const std::uint64_t> tuples, std::byte* to) const;

    /// True where decode_some() can be called.
    bool has_tuples() const { return array_.form != DataArray::Form::ascii && !array_.bits; }

    /// The same of all. More values than were looked for are an error.
    Result<void> decode_all(std::byte* to) const;

    /// Errors   invalid_data: more values are stored than were looked for. Of text only decode() tells
    Result<void> check_stored() const;

    /// Whether others stand behind them, of what is not text.
    bool has_more() const;

    /// True where each_block() can be called: values are stored as they are read, whole ones in each block.
    bool has_blocks() const;

    /// Calls work(position of its first value, bytes) for each block, in parallel, and keeps none of them.
    using Work = std::function<void(std::uint64_t first, std::span<const std::byte> values)>;
    Result<void> each_block(const Work& work) const;

    /// Reads the first values, as stored.
    Result<void> read_first(std::span<std::byte> to) const;

    /// Whether every block holds what `expect(position of its first value, bytes to write)` writes. A block of zlib is compared by
    /// its checksum, without inflating it, and inflated only where that differs.
    using Expect = std::function<void(std::uint64_t first, std::span<std::byte> values)>;
    Result<bool> holds(const Expect& expect) const;

    /// The same values of the same file, which was opened again.
    StoredArray in(const ByteSource& source) const;

    const DataArray& array() const noexcept { return array_; }
    std::uint64_t scalars() const noexcept { return scalars_; }

private:
    StoredArray(const Document& document, const DataArray& array, std::uint64_t scalars, const Progress& progress)
        : document_(&document), array_(array), progress_(&progress), scalars_(scalars) {}

    Result<void> decode_stored(std::byte* to, bool* more) const;
    Result<void> find_plain_block(std::vector<std::string>& odd_lengths);
    Result<void> find_packed_blocks();
    Error wrong(std::string_view what) const;
    Error in_array(const Error& error) const;

    /// A block of which the first `size` bytes of values, from `at` on, are needed.
    struct Block {
        std::size_t number;
        std::uint64_t at;
        std::size_t size;
        std::string_view packed; ///< what becomes its values, of a compressed one
    };
    /// False: no other block is needed. Blocks of which `is_needed` says so are passed over.
    using BlockWork = std::function<Result<bool>(const Block& block)>;
    Result<bool> for_blocks(const BlockWork& work, const std::function<bool(std::size_t number)>& is_needed = {}) const;
    Result<void> decode_tuples(std::span<const std::uint64_t> tuples, std::size_t bytes, std::byte* to) const;
    std::size_t blocks() const;
    std::size_t bytes_of_block(std::size_t block) const;
    Result<std::string_view> packed_bytes(std::size_t begin, std::size_t end, Scratch& scratch) const;
    Result<void> read_block(const Block& block, std::span<std::byte> to) const;
    bool is_told_by_checksum(const Block& block, const Expect& expect) const;

    const Document* document_;
    DataArray array_;
    const Progress* progress_;
    std::uint64_t scalars_;
    std::uint64_t needed_ = 0; ///< bytes of values
    std::uint64_t stored_ = 0; ///< bytes of values that there are
    Stream stream_;
    std::size_t data_ = 0;              ///< where in the stream values begin
    std::size_t block_bytes_ = 1;       ///< of values, in all blocks but the last
    std::vector<std::uint64_t> packed_; ///< behind data_: where each compressed block begins, and the last one ends
};

/// How many values are stored, as the bytes in front of them tell; 0 where these do not, or are not plausible. Nothing is
/// checked that find() checks.
std::uint64_t stored_scalars(const Document& document, const DataArray& array);

/// A whole array, in memory of its own.
Result<Array> load_array(Document& document, const DataArray& array, std::uint64_t tuples, const Progress& progress);

/// Makes an Array of `tuples` tuples that `fill(first byte)` has written.
using Fill = std::function<Result<void>(std::byte* to)>;
Result<Array> filled_array(ScalarType type, std::size_t tuples, std::size_t components, const Fill& fill);

} // namespace isotet::io::vtk_xml
