// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Text is cut into chunks; a word belongs to the chunk in which it begins. Chunks are parsed side by side, each into
// memory of its own, then put one behind the other.
#include "io/files/number_text.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 18;
constexpr std::size_t chunks_at_once = 24;
constexpr std::size_t longest_word = 512;

template <class T>
struct Chunk {
    core::Buffer<T> numbers; ///< as many as a chunk can hold, used again from window to window
    std::size_t size = 0;
    std::string bad_word; ///< the first word that is no number; numbers end before it
    std::size_t begin = 0;
};

/// A chunk with the end of the word before it and the rest of its last word.
struct ChunkText {
    std::string_view text;
    std::size_t first = 0; ///< where its own words may begin
    std::size_t size = 0;  ///< and until where
};

Result<ChunkText> text_of_chunk(const ByteSource& source, std::size_t begin, std::size_t text_begin, std::size_t stop,
                                std::size_t text_end, Scratch& scratch) {
    const std::size_t from = begin > text_begin ? begin - 1 : begin;
    const std::size_t until = std::min(text_end, stop + longest_word);
    const auto view = source.view(from, until - from, scratch);
    if (!view) return view.error();
    std::size_t first = begin - from;
    if (first == 1 && !is_space(view->front()))
        while (first < view->size() && !is_space((*view)[first])) ++first;
    return ChunkText{*view, first, stop - from};
}

template <class T>
void parse_chunk(const ChunkText& chunk, bool ends_text, Chunk<T>& to) {
    TextScanner scanner(chunk.text);
    scanner.seek(chunk.first);
    while (!scanner.at_end() && scanner.position() < chunk.size) {
        const std::size_t begin = scanner.position();
        T value;
        if (!read_scalar(scanner, value) || (scanner.left() == 0 && !ends_text)) {
            scanner.seek(begin);
            to.bad_word = scanner.word();
            return;
        }
        to.numbers[to.size++] = value;
    }
}

/// Behind the first `count` words of the text from `begin` on.
Result<std::size_t> behind_words(const ByteSource& source, std::size_t begin, std::size_t text_begin,
                                 std::size_t text_end, std::size_t count) {
    Scratch scratch;
    const auto chunk =
        text_of_chunk(source, begin, text_begin, std::min(text_end, begin + chunk_bytes), text_end, scratch);
    if (!chunk) return chunk.error();
    TextScanner scanner(chunk->text);
    scanner.seek(chunk->first);
    for (std::size_t i = 0; i < count; ++i) scanner.word();
    return begin + scanner.position() - (begin > text_begin ? 1 : 0);
}

template <class T>
Result<std::size_t> read_numbers_of(const ByteSource& source, std::size_t begin, std::size_t end, std::uint64_t count,
                                    std::string_view what, std::byte* to, const Progress& progress) {
    std::uint64_t found = 0;
    std::vector<Chunk<T>> chunks;
    for (std::size_t at = begin; found < count;) {
        if (at >= end) return invalid_data(fmt::format("{} has {} numbers, not {}", what, found, count));
        if (progress.cancelled()) return Pace::cancelled();
        // No further than the numbers can reach that are still missing: what follows them may be anything.
        const std::uint64_t reach = std::max<std::uint64_t>((count - found) * 32, 4096);
        const std::size_t window = std::min<std::uint64_t>({end - at, reach, chunk_bytes * chunks_at_once});
        chunks.resize((window + chunk_bytes - 1) / chunk_bytes);
        FirstError failed;
        core::parallel_each(chunks.size(), 1, [&](std::size_t i) {
            thread_local Scratch scratch;
            Chunk<T>& chunk = chunks[i];
            chunk.begin = at + i * chunk_bytes;
            const std::size_t stop = std::min(chunk.begin + chunk_bytes, at + window);
            const auto text = text_of_chunk(source, chunk.begin, begin, stop, end, scratch);
            if (!text) return failed.add(i, text.error());
            chunk.size = 0;
            chunk.bad_word.clear();
            const std::size_t most = (stop - chunk.begin) / 2 + 1; // a number takes a character and a space
            if (chunk.numbers.size() < most) chunk.numbers = core::Buffer<T>(most);
            parse_chunk(*text, stop + longest_word >= end, chunk);
        });
        if (auto read = failed.result(); !read) return read.error();

        std::vector<std::uint64_t> places;
        for (const Chunk<T>& chunk : chunks) {
            places.push_back(found);
            found += chunk.size;
            if (found < count && !chunk.bad_word.empty())
                return invalid_data(fmt::format("{}: {}, number {} of {}, is not {}", what, in_quotes(chunk.bad_word),
                                                found, count, name_of(scalar_type_of<T>())));
            if (found >= count) break;
        }
        core::parallel_each(places.size(), 1, [&](std::size_t i) {
            const std::uint64_t used = std::min<std::uint64_t>(chunks[i].size, count - places[i]);
            if (to && used > 0) std::memcpy(to + places[i] * sizeof(T), chunks[i].numbers.data(), used * sizeof(T));
        });
        if (found >= count)
            return behind_words(source, chunks[places.size() - 1].begin, begin, end,
                                static_cast<std::size_t>(count - places.back()));
        at += window;
        progress("read", static_cast<double>(at) / static_cast<double>(source.size()));
    }
    return begin;
}

} // namespace

Result<void> check_room(std::size_t begin, std::size_t end, std::uint64_t count, std::string_view what) {
    if (count <= (end - begin) / 2 + 1) return {};
    return invalid_data(
        fmt::format("{} should have {} numbers, but there are only {} characters", what, count, end - begin));
}

Result<std::size_t> read_numbers(const ByteSource& source, std::size_t begin, std::size_t end, ScalarType type,
                                 std::uint64_t count, std::string_view what, std::byte* to, const Progress& progress) {
    if (auto fits = check_room(begin, end, count, what); !fits) return fits.error();
    return with_type(type, [&](auto zero) {
        return read_numbers_of<decltype(zero)>(source, begin, end, count, what, to, progress);
    });
}

} // namespace isotet::io
