// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/stored_array.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/byte_reader.hpp"
#include "io/files/first_error.hpp"
#include "io/files/number_text.hpp"
#include "io/files/pace.hpp"
#include "io/files/read_tuples.hpp"
#include "io/files/scalars.hpp"
#include "io/vtk_xml/base64.hpp"
#include "io/write/write_stream.hpp"

namespace isotet::io::vtk_xml {
namespace {

constexpr std::size_t piece_bytes = std::size_t{3} << 18; ///< of values that are not compressed: whole groups of base64
constexpr std::size_t bytes_at_once = std::size_t{1} << 18; ///< that a thread reads, where blocks are smaller
constexpr std::size_t many_bytes = std::size_t{64} << 20;   ///< asking what is free takes longer than reading fewer

/// Base64 with line breaks, which VTK does not write, without them; nothing where there are none at its beginning.
Result<std::shared_ptr<const std::string>> without_breaks(const ByteSource& source, Range place) {
    Scratch scratch;
    const auto start = source.view(place.begin, std::min<std::size_t>(place.size(), 4096), scratch);
    if (!start) return start.error();
    const auto first_break = std::ranges::find_if(*start, is_space);
    if (std::all_of(first_break, start->end(), is_space)) return std::shared_ptr<const std::string>();
    const auto whole = source.view(place.begin, place.size(), scratch);
    if (!whole) return whole.error();
    auto text = std::make_shared<std::string>();
    text->reserve(place.size());
    std::ranges::copy_if(*whole, std::back_inserter(*text), [](char c) { return !is_space(c); });
    return std::shared_ptr<const std::string>(std::move(text));
}

Result<Stream> open_stream(const Document& document, const DataArray& array) {
    Stream stream{array.source(document), array.place, array.form == DataArray::Form::base64, array.text};
    if (!stream.base64 || !array.inside) return stream;
    Scratch scratch;
    const auto start =
        stream.source.view(stream.place.begin, std::min<std::size_t>(stream.place.size(), 4096), scratch);
    if (!start) return start.error();
    stream.place.begin += static_cast<std::size_t>(std::ranges::find_if_not(*start, is_space) - start->begin());
    const std::size_t tail = std::min<std::size_t>(stream.place.size(), 4096);
    const auto end = stream.source.view(stream.place.end - tail, tail, scratch);
    if (!end) return end.error();
    stream.place.end -=
        static_cast<std::size_t>(std::find_if_not(end->rbegin(), end->rend(), is_space) - end->rbegin());
    auto text = without_breaks(stream.source, stream.place);
    if (!text) return text.error();
    if (*text) {
        stream.source = ByteSource(std::string_view(**text));
        stream.place = {0, (*text)->size()};
        stream.text = std::move(*text);
    }
    return stream;
}

template <class Work>
class ScopeEnd {
public:
    explicit ScopeEnd(Work work) : work_(work) {}
    ~ScopeEnd() { work_(); }
    ScopeEnd(const ScopeEnd&) = delete;
    ScopeEnd& operator=(const ScopeEnd&) = delete;

private:
    Work work_;
};

std::uint64_t next_word(ByteReader& reader, bool wide) {
    std::uint64_t wide_word = 0;
    std::uint32_t narrow_word = 0;
    if (wide) reader.read(wide_word);
    else reader.read(narrow_word);
    return wide ? wide_word : narrow_word;
}

} // namespace

Result<std::string_view> Stream::view(std::size_t at, std::size_t count, Scratch& scratch) const {
    const auto missing = [&] {
        return invalid_data(
            fmt::format("{} bytes from byte {} on are needed, but there are only {}", count, at, size()));
    };
    if (!base64) {
        if (at > place.size() || count > place.size() - at) return missing();
        return source.view(place.begin + at, count, scratch);
    }
    if (at > size() || count > size() - at) return missing();
    thread_local Scratch characters;
    const std::size_t first = at / 3, last = (at + count + 2) / 3;
    const auto digits = source.view(place.begin + 4 * first, 4 * (last - first), characters);
    if (!digits) return digits;
    const auto bytes = scratch.take(decoded_room(digits->size()));
    const auto decoded = decode_base64(*digits, bytes.data());
    if (!decoded) return invalid_data("its base64 data is broken");
    if (*decoded < at - 3 * first + count) return missing();
    characters.trim();
    return std::string_view(reinterpret_cast<const char*>(bytes.data()) + (at - 3 * first), count);
}

Error StoredArray::wrong(std::string_view what) const {
    return invalid_data(fmt::format("the array {}: {}", in_quotes(array_.name), what));
}

Error StoredArray::in_array(const Error& error) const {
    return error.code == ErrorCode::invalid_data ? wrong(error.message) : error;
}

Result<void> StoredArray::find_packed_blocks() {
    const std::size_t word = document_->wide_header ? 8 : 4;
    Scratch first_words;
    const auto head = stream_.view(0, 3 * word, first_words);
    if (!head) return in_array(head.error());
    ByteReader head_reader(*head, document_->order != std::endian::native);
    const auto next = [&] { return next_word(head_reader, document_->wide_header); };
    const std::uint64_t count = next(), size = next(),
                        last = next(); // blocks, bytes of each and of the last if smaller
    if (count > stream_.size() / word)
        return wrong(fmt::format("{} blocks are announced in {} bytes", count, stream_.size()));
    if (last > size) return wrong(fmt::format("its last block has {} bytes, the others {}", last, size));
    constexpr std::uint64_t most = std::uint64_t{1} << 60;
    if (size > most / (count + 1)) return wrong(fmt::format("{} blocks of {} bytes are announced", count, size));
    stored_ = count == 0 ? 0 : (count - 1) * size + (last > 0 ? last : size);
    block_bytes_ = static_cast<std::size_t>(size);
    if (block_bytes_ > many_bytes) // where not all of a block is needed, it is inflated into memory of its own
        if (auto fits = core::require_memory("a block of an array", block_bytes_); !fits) return fits;

    const std::size_t header = static_cast<std::size_t>(3 + count) * word;
    Scratch scratch;
    const auto sizes = stream_.view(3 * word, header - 3 * word, scratch);
    if (!sizes) return in_array(sizes.error());
    if (stream_.base64) stream_.place.begin += (header + 2) / 3 * 4; // the blocks are a stream of their own
    else data_ = header;
    const std::size_t end = stream_.size() - data_;
    ByteReader reader(*sizes, document_->order != std::endian::native);
    packed_.reserve(static_cast<std::size_t>(count) + 1);
    packed_.push_back(0);
    for (std::size_t block = 0; block < count; ++block) {
        const std::uint64_t bytes = next_word(reader, document_->wide_header);
        if (bytes > end - packed_.back())
            return wrong(fmt::format("block {} of {} has {} bytes, but only {} are left: the file is cut short or "
                                     "broken",
                                     block, count, bytes, end - packed_.back()));
        if (!is_plausible(document_->codec, bytes, bytes_of_block(block)))
            return wrong(fmt::format("{} bytes of {} cannot become {} bytes", bytes, name_of(document_->codec),
                                     bytes_of_block(block)));
        packed_.push_back(packed_.back() + bytes);
    }
    return {};
}

Result<void> StoredArray::find_plain_block(std::vector<std::string>& odd_lengths) {
    const std::size_t word = document_->wide_header ? 8 : 4;
    Scratch scratch;
    const auto head = stream_.view(0, word, scratch);
    if (!head) return in_array(head.error());
    ByteReader reader(*head, document_->order != std::endian::native);
    stored_ = next_word(reader, document_->wide_header);
    block_bytes_ = piece_bytes;
    data_ = word;
    if (stream_.base64) {
        // The size may be a stream of its own, which padding ends.
        const std::size_t characters = (word + 2) / 3 * 4;
        const auto text = stream_.source.view(stream_.place.begin, characters, scratch);
        if (!text) return text.error();
        if (text->ends_with('=')) {
            stream_.place.begin += characters;
            data_ = 0;
        }
    }
    // GetFEM writes the length as a float, and VTK does not look at it.
    const bool fits = stored_ >= needed_ && stored_ <= stream_.size() - std::min(data_, stream_.size());
    if (array_.inside && !fits && stream_.place.size() == (data_ + needed_ + 2) / 3 * 4) {
        stored_ = needed_;
        odd_lengths.push_back(array_.name);
    }
    if (stored_ > stream_.size() - std::min(data_, stream_.size()))
        return wrong(fmt::format("{} bytes are announced, but only {} are left: the file is cut short or broken",
                                 stored_, stream_.size() - std::min(data_, stream_.size())));
    return {};
}

Result<StoredArray> StoredArray::find(Document& document, const DataArray& array, std::uint64_t scalars,
                                      const Progress& progress) {
    StoredArray found(document, array, scalars, progress);
    if (scalars == 0) return found; // writers leave out blocks of nothing
    const std::uint64_t size = size_of(array.type);
    if (scalars > std::numeric_limits<std::uint64_t>::max() / size / 2)
        return found.wrong(fmt::format("{} values are announced", scalars));
    std::uint64_t taken = 0;
    if (array.form == DataArray::Form::ascii) {
        const auto what = fmt::format("the array {}", in_quotes(array.name));
        if (auto fits = check_room(array.place.begin, array.place.end, scalars, what); !fits) return fits.error();
    } else {
        found.needed_ = array.bits ? (scalars + 7) / 8 : scalars * size;
        auto stream = open_stream(document, array);
        if (!stream) return stream.error();
        found.stream_ = std::move(*stream);
        const bool packed = document.codec != Codec::none;
        if (auto placed = packed ? found.find_packed_blocks() : found.find_plain_block(document.odd_lengths); !placed)
            return placed.error();
        if (found.needed_ > found.stored_)
            return found.wrong(fmt::format("it has {} bytes, but {} {} take {}", found.stored_, scalars,
                                           isotet::name_of(array.type), found.needed_));
        taken = packed ? found.packed_[found.blocks()] : found.needed_;
    }
    if (array.inside) return found;
    if (!document.appended_begins.insert(array.place.begin).second) {
        document.shared_bytes += found.needed_;
        if (auto fits = core::require_memory("arrays that share their data", document.shared_bytes); !fits)
            return fits.error();
        return found;
    }
    if (taken > document.appended_left) return found.wrong("it shares a part of its appended data with other arrays");
    document.appended_left -= taken;
    return found;
}

std::size_t StoredArray::blocks() const {
    return needed_ == 0 ? 0 : static_cast<std::size_t>((needed_ - 1) / block_bytes_ + 1);
}

/// Of values, whether they are needed or not.
std::size_t StoredArray::bytes_of_block(std::size_t block) const {
    return static_cast<std::size_t>(std::min<std::uint64_t>(block_bytes_, stored_ - block * block_bytes_));
}

/// The stored bytes of compressed blocks; none of others.
Result<std::string_view> StoredArray::packed_bytes(std::size_t begin, std::size_t end, Scratch& scratch) const {
    if (packed_.empty()) return std::string_view();
    const auto bytes = stream_.view(data_ + static_cast<std::size_t>(packed_[begin]),
                                    static_cast<std::size_t>(packed_[end] - packed_[begin]), scratch);
    return bytes ? bytes : in_array(bytes.error());
}

/// The first bytes of a block.
Result<void> StoredArray::read_block(const Block& block, std::span<std::byte> to) const {
    thread_local Scratch stored, values;
    const ScopeEnd trim([] {
        stored.trim();
        values.trim();
    });
    if (packed_.empty()) {
        const std::size_t at = data_ + block.number * block_bytes_;
        if (!stream_.base64) return stream_.source.read(stream_.place.begin + at, to);
        const auto bytes = stream_.view(at, to.size(), stored);
        if (!bytes) return in_array(bytes.error());
        std::memcpy(to.data(), bytes->data(), to.size());
        return {};
    }
    const std::size_t size = bytes_of_block(block.number);
    const auto whole = to.size() == size ? to : values.take(size);
    if (!inflate(document_->codec, block.packed, whole))
        return wrong(fmt::format("block {} of {} bytes of {} cannot be inflated to {} bytes", block.number,
                                 block.packed.size(), name_of(document_->codec), size));
    if (to.size() < size) std::memcpy(to.data(), whole.data(), to.size());
    return {};
}

StoredArray StoredArray::in(const ByteSource& source) const {
    StoredArray other(*this);
    if (!other.stream_.text) other.stream_.source = source;
    return other;
}

Result<void> StoredArray::read_first(std::span<std::byte> to) const {
    Scratch stored;
    const auto packed = packed_bytes(0, 1, stored);
    return packed ? read_block({0, 0, to.size(), *packed}, to) : packed.error();
}

/// False when a call of work() needed no others.
Result<bool> StoredArray::for_blocks(const BlockWork& work,
                                     const std::function<bool(std::size_t number)>& is_needed) const {
    const auto needs = [&](std::size_t number) { return !is_needed || is_needed(number); };
    FirstError failed;
    std::atomic<bool> needed = true;
    const auto goes_on = [&] { return !failed && needed.load(std::memory_order_relaxed); };
    const std::size_t per_task = std::max<std::size_t>(1, bytes_at_once / block_bytes_);
    core::parallel_pieces(blocks(), per_task, *progress_, [&](std::size_t begin, std::size_t end) {
        thread_local Scratch stored; // work() starts no other tasks
        const ScopeEnd trim([] { stored.trim(); });
        std::string_view packed; // of blocks from `first` to before `read`
        for (std::size_t block = begin, first = begin, read = begin; block < end && goes_on(); ++block) {
            if (!needs(block)) continue;
            if (block >= read) {
                first = block;
                read = block + 1;
                while (read < end && !packed_.empty() && needs(read) &&
                       packed_[read + 1] - packed_[first] <= bytes_at_once)
                    ++read;
                const auto bytes = packed_bytes(first, read, stored);
                if (!bytes) return failed.add(block, bytes.error());
                packed = *bytes;
            }
            const std::uint64_t at = std::uint64_t{block} * block_bytes_;
            const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(block_bytes_, needed_ - at));
            std::string_view of_block;
            if (!packed_.empty())
                of_block = packed.substr(static_cast<std::size_t>(packed_[block] - packed_[first]),
                                         static_cast<std::size_t>(packed_[block + 1] - packed_[block]));
            const auto done = work({block, at, size, of_block});
            if (!done) failed.add(block, done.error());
            else if (!*done) needed = false;
        }
        const std::size_t at = packed_.empty() ? end * block_bytes_ : static_cast<std::size_t>(packed_[end]);
        (*progress_)("read", std::min(1.0, static_cast<double>(stream_.place.begin + at) /
                                               static_cast<double>(document_->source.size())));
    });
    if (progress_->cancelled()) return Pace::cancelled();
    if (const auto result = failed.result(); !result) return result.error();
    return needed.load();
}

Result<void> StoredArray::decode(std::byte* to, bool* more) const {
    if (auto done = decode_stored(to, more); !done || !array_.order) return done;
    order_as_vtk(to, static_cast<std::size_t>(scalars_ / array_.components), size_of(array_.type), *array_.order);
    return {};
}

/// In the order of the file.
Result<void> StoredArray::decode_stored(std::byte* to, bool* more) const {
    if (scalars_ == 0) return {};
    if (array_.form == DataArray::Form::ascii) {
        const auto end = read_numbers(array_.source(*document_), array_.place.begin, array_.place.end, array_.type,
                                      scalars_, fmt::format("the array {}", in_quotes(array_.name)), to, *progress_);
        if (!end) return end.error();
        for (std::uint64_t i = 0; array_.bits && i < scalars_; ++i) to[i] = std::byte{to[i] != std::byte{0}};
        if (!more) return {};
        const auto blank = is_blank(array_.source(*document_), {*end, array_.place.end});
        if (!blank) return blank.error();
        *more = *more || !*blank;
        return {};
    }
    core::Buffer<std::byte> bits(array_.bits ? static_cast<std::size_t>(needed_) : 0);
    std::byte* const values = array_.bits ? bits.data() : to;
    const auto done = for_blocks([&](const Block& block) -> Result<bool> {
        if (auto read = read_block(block, {values + block.at, block.size}); !read) return read.error();
        return true;
    });
    if (!done) return done.error();
    if (array_.bits) {
        for (std::uint64_t i = 0; i < scalars_; ++i) to[i] = (bits[i / 8] >> (7 - i % 8)) & std::byte{1};
    } else if (document_->order != std::endian::native) {
        const std::size_t size = size_of(array_.type);
        core::parallel_ranges(
            static_cast<std::size_t>(scalars_), std::size_t{1} << 18,
            [&](std::size_t begin, std::size_t end) { swap_bytes(to + begin * size, end - begin, size); });
    }
    if (more) *more = *more || has_more();
    return {};
}

Result<void> StoredArray::decode_some(std::span<const std::uint64_t> tuples, std::byte* to) const {
    const std::size_t size = size_of(array_.type), components = array_.components;
    const bool is_raw = packed_.empty() && !stream_.base64;
    if (auto done =
            is_raw ? read_tuples(stream_.source, stream_.place.begin + data_, components * size, tuples, to, *progress_)
                   : decode_tuples(tuples, components * size, to);
        !done)
        return done;
    if (document_->order != std::endian::native) swap_bytes(to, tuples.size() * components, size);
    if (array_.order) order_as_vtk(to, tuples.size(), size, *array_.order);
    return {};
}

/// In the order of the file, of `bytes` each. A tuple may lie in two blocks.
Result<void> StoredArray::decode_tuples(std::span<const std::uint64_t> tuples, std::size_t bytes, std::byte* to) const {
    const auto first_in = [&](std::uint64_t at) { // the first tuple that ends behind it
        return std::ranges::partition_point(tuples, [&](std::uint64_t tuple) { return (tuple + 1) * bytes <= at; });
    };
    const auto is_needed = [&](std::size_t number) {
        const std::uint64_t at = std::uint64_t{number} * block_bytes_;
        const auto first = first_in(at);
        return first != tuples.end() && *first * bytes < at + block_bytes_;
    };
    const auto done = for_blocks(
        [&](const Block& block) -> Result<bool> {
            thread_local Scratch values;
            const auto read = values.take(block.size);
            if (auto ok = read_block(block, read); !ok) return ok.error();
            const std::uint64_t end = block.at + block.size;
            for (auto tuple = first_in(block.at); tuple != tuples.end() && *tuple * bytes < end; ++tuple) {
                const std::uint64_t from = std::max<std::uint64_t>(*tuple * bytes, block.at);
                const std::uint64_t behind = std::min<std::uint64_t>((*tuple + 1) * bytes, end);
                std::memcpy(to + static_cast<std::size_t>(tuple - tuples.begin()) * bytes + (from - *tuple * bytes),
                            read.data() + (from - block.at), static_cast<std::size_t>(behind - from));
            }
            values.trim();
            return true;
        },
        is_needed);
    return done ? Result<void>() : done.error();
}

Result<void> StoredArray::decode_all(std::byte* to) const {
    bool more = false;
    if (auto done = decode(to, &more); !done) return done;
    if (more) return wrong(fmt::format("it holds more than the {} values that are announced", scalars_));
    return {};
}

bool StoredArray::has_more() const {
    return array_.form != DataArray::Form::ascii && !array_.bits && stored_ >= needed_ + size_of(array_.type);
}

Result<void> StoredArray::check_stored() const {
    if (!has_more()) return {};
    return wrong(fmt::format("it holds {} values, but {} are announced", stored_ / size_of(array_.type), scalars_));
}

bool StoredArray::has_blocks() const {
    return array_.form != DataArray::Form::ascii && !array_.bits && !array_.order && scalars_ > 0 &&
           document_->order == std::endian::native && block_bytes_ % size_of(array_.type) == 0;
}

Result<void> StoredArray::each_block(const Work& work) const {
    const auto done = for_blocks([&](const Block& block) -> Result<bool> {
        thread_local Scratch values;
        const auto bytes = values.take(block.size);
        if (auto read = read_block(block, bytes); !read) return read.error();
        work(block.at / size_of(array_.type), bytes);
        values.trim();
        return true;
    });
    return done ? Result<void>() : done.error();
}

/// Whether a block, all of which is needed, ends with the checksum of what is expected.
bool StoredArray::is_told_by_checksum(const Block& block, const Expect& expect) const {
    if (block.size != bytes_of_block(block.number) || !has_checksum(document_->codec)) return false;
    if (block.packed.size() < checksum_bytes) return false;
    thread_local Scratch expected;
    const auto values = expected.take(block.size);
    expect(block.at / size_of(array_.type), values);
    const bool same = checksum_of(values) == block.packed.substr(block.packed.size() - checksum_bytes);
    expected.trim();
    return same;
}

Result<bool> StoredArray::holds(const Expect& expect) const {
    return for_blocks([&](const Block& block) -> Result<bool> {
        if (is_told_by_checksum(block, expect)) return true;
        thread_local Scratch stored;
        const auto bytes = stored.take(block.size);
        if (auto read = read_block(block, bytes); !read) return read.error();
        bool same = true;
        alignas(8) std::array<std::byte, 1 << 14> expected; // few enough to stay in the cache
        for (std::size_t begin = 0; begin < block.size && same; begin += expected.size()) {
            const auto piece = std::span(expected).first(std::min(expected.size(), block.size - begin));
            expect((block.at + begin) / size_of(array_.type), piece);
            same = std::memcmp(piece.data(), bytes.data() + begin, piece.size()) == 0;
        }
        stored.trim();
        return same;
    });
}

std::uint64_t stored_scalars(const Document& document, const DataArray& array) {
    if (array.form == DataArray::Form::ascii || array.bits || array.text) return 0;
    Stream stream{array.source(document), array.place, array.form == DataArray::Form::base64, {}};
    Scratch scratch;
    if (array.inside) {
        const auto start =
            stream.source.view(stream.place.begin, std::min<std::size_t>(stream.place.size(), 256), scratch);
        if (!start) return 0;
        stream.place.begin += static_cast<std::size_t>(std::ranges::find_if_not(*start, is_space) - start->begin());
    }
    const bool packed = document.codec != Codec::none;
    const auto head = stream.view(0, (packed ? 3 : 1) * (document.wide_header ? 8 : 4), scratch);
    if (!head) return 0;
    ByteReader reader(*head, document.order != std::endian::native);
    const auto next = [&] { return next_word(reader, document.wide_header); };
    const std::uint64_t first = next(), scalar = size_of(array.type);
    if (!packed) return first <= stream.size() ? first / scalar : 0;
    const std::uint64_t size = next(), last = next(), most = std::uint64_t{1} << 60;
    if (first == 0 || first > stream.size() || last > size || size > most / first) return 0;
    const std::uint64_t bytes = (first - 1) * size + (last > 0 ? last : size);
    return is_plausible(document.codec, stream.size(), bytes) ? bytes / scalar : 0;
}

Result<Array> filled_array(ScalarType type, std::size_t tuples, std::size_t components, const Fill& fill) {
    return with_type(type, [&](auto zero) -> Result<Array> {
        using Scalar = decltype(zero);
        const std::size_t bytes = tuples * components * sizeof(Scalar);
        if (bytes > many_bytes)
            if (auto fits = core::require_memory("an array", bytes); !fits) return fits.error();
        core::Buffer<Scalar> values(tuples * components);
        if (auto filled = fill(reinterpret_cast<std::byte*>(values.data())); !filled) return filled.error();
        return std::move(values).to_array(components);
    });
}

Result<Array> load_array(Document& document, const DataArray& array, std::uint64_t tuples, const Progress& progress) {
    if (tuples > std::numeric_limits<std::uint64_t>::max() / array.components)
        return invalid_data(fmt::format("the array {} should have {} tuples", in_quotes(array.name), tuples));
    const auto stored = StoredArray::find(document, array, tuples * array.components, progress);
    if (!stored) return stored.error();
    return filled_array(array.type, static_cast<std::size_t>(tuples), array.components,
                        [&](std::byte* to) { return stored->decode(to); });
}

} // namespace isotet::io::vtk_xml
