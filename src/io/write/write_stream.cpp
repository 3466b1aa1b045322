// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/write/write_stream.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 20; // one fill of a column; a cancel waits for no more than this
constexpr std::size_t piece_rows = 8192;
constexpr std::size_t pieces_at_once = 64;

} // namespace

namespace {

template <class Word, class Swap>
void swap_words(std::byte* data, std::size_t count, const Swap& swap) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        Word word;
        std::memcpy(&word, data + i * sizeof(Word), sizeof(Word));
        word = swap(word);
        std::memcpy(data + i * sizeof(Word), &word, sizeof(Word));
    }
}

} // namespace

void swap_bytes(std::byte* data, std::size_t count, std::size_t size) noexcept {
    if (size == 2) swap_words<std::uint16_t>(data, count, [](auto word) { return __builtin_bswap16(word); });
    else if (size == 4) swap_words<std::uint32_t>(data, count, [](auto word) { return __builtin_bswap32(word); });
    else if (size == 8) swap_words<std::uint64_t>(data, count, [](auto word) { return __builtin_bswap64(word); });
}

bool WriteStream::goes_on() {
    if (error_) return false;
    if (progress_.cancelled()) {
        error_ = Error{ErrorCode::cancelled, "writing was cancelled"};
        return false;
    }
    const auto done = static_cast<double>(file_.bytes()) / static_cast<double>(std::max<std::uint64_t>(expected_, 1));
    progress_("write", std::min(done, 1.0));
    return true;
}

void WriteStream::text(std::string_view text) {
    if (error_) return;
    if (auto written = file_.write(text); !written) error_ = written.error();
}

void WriteStream::column(const Column& column, std::endian order) {
    const std::size_t tuple = column.tuple_bytes();
    if (tuple == 0) return;
    const std::size_t piece = std::max<std::size_t>(1, piece_bytes / tuple);
    std::vector<std::byte> buffer(std::min(piece, column.tuples) * tuple);
    for (std::size_t begin = 0; begin < column.tuples && goes_on(); begin += piece) {
        const std::size_t end = std::min(column.tuples, begin + piece);
        column.fill(begin, end, buffer.data());
        if (order != std::endian::native) {
            swap_bytes(buffer.data(), (end - begin) * column.components, size_of(column.type));
        }
        if (auto written = file_.write(std::span(buffer).first((end - begin) * tuple)); !written)
            error_ = written.error();
    }
}

void WriteStream::rows(std::size_t count, const RowWriter& writer) {
    std::vector<std::string> pieces(std::min(pieces_at_once, count / piece_rows + 1));
    for (std::size_t begin = 0; begin < count && goes_on(); begin += pieces.size() * piece_rows) {
        const std::size_t rows_left = count - begin;
        const std::size_t used = std::min(pieces.size(), (rows_left - 1) / piece_rows + 1);
        core::parallel_each(used, 1, [&](std::size_t i) {
            pieces[i].clear();
            const std::size_t first = begin + i * piece_rows;
            writer(first, std::min(count, first + piece_rows), pieces[i]);
        });
        for (std::size_t i = 0; i < used; ++i) text(pieces[i]);
    }
}

Result<void> WriteStream::finish() const {
    if (error_) return *error_;
    return {};
}

Result<WriteReport> write_file(const std::string& path, const Progress& progress, std::uint64_t expected,
                               const std::function<void(WriteStream&)>& write) {
    auto file = core::OutputFile::open(path);
    if (!file) return file.error();
    WriteStream stream(*file, progress, expected);
    write(stream);
    if (auto finished = stream.finish(); !finished) return finished.error();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "writing was cancelled"};
    if (auto committed = file->commit(); !committed) return committed.error();
    progress("write", 1.0);
    WriteReport report;
    report.bytes = file->bytes();
    return report;
}

} // namespace isotet::io
