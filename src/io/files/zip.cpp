// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/zip.hpp"

#include <bit>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <libdeflate.h>

#include "base/system/apart.hpp"
#include "base/errors.hpp"
#include "io/files/byte_reader.hpp"

namespace isotet::io {
namespace {

constexpr std::uint32_t local_mark = 0x04034b50, central_mark = 0x02014b50, end_mark = 0x06054b50;
constexpr std::uint16_t version_needed = 20, name_is_utf8 = 1 << 11, stored = 0, deflated = 8;
constexpr std::uint16_t first_day = 1 << 5 | 1; // 1980-01-01
constexpr std::uint64_t largest = std::numeric_limits<std::uint32_t>::max();
constexpr int level = 6;

template <class Number>
void put_little(Number value, std::string& out) {
    for (std::size_t i = 0; i < sizeof value; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* it) const noexcept { libdeflate_free_decompressor(it); }
};
struct FreeCompressor {
    void operator()(libdeflate_compressor* it) const noexcept { libdeflate_free_compressor(it); }
};

Error no_memory_to_pack() { return {ErrorCode::out_of_memory, "no memory left to pack an archive"}; }

/// What the directory of an archive says of a member.
struct Entry {
    std::string_view name;
    std::uint16_t method = 0;
    std::uint32_t check = 0, packed = 0, size = 0, offset = 0;
};

ByteReader little_endian(std::string_view bytes) {
    return ByteReader(bytes, std::endian::native != std::endian::little);
}

/// The next bytes; nothing where fewer are left.
std::optional<std::string_view> take(ByteReader& reader, std::size_t count) {
    const std::string_view rest = reader.rest();
    if (!reader.skip(count)) return {};
    return rest.substr(0, count);
}

/// Reads an entry; nothing where the directory ends or is broken.
std::optional<Entry> next_entry(ByteReader& reader) {
    Entry entry;
    std::uint32_t mark = 0;
    std::uint16_t name = 0, extra = 0, comment = 0;
    if (!reader.read(mark) || mark != central_mark || !reader.skip(6) || !reader.read(entry.method) ||
        !reader.skip(4) || !reader.read(entry.check) || !reader.read(entry.packed) || !reader.read(entry.size) ||
        !reader.read(name) || !reader.read(extra) || !reader.read(comment) || !reader.skip(8) ||
        !reader.read(entry.offset))
        return {};
    const auto text = take(reader, name);
    if (!text || !reader.skip(std::size_t{extra} + comment)) return {};
    entry.name = *text;
    return entry;
}

/// Where the directory begins: by the last end mark.
std::optional<std::uint32_t> directory_of(std::string_view archive) {
    std::string mark;
    put_little(end_mark, mark);
    const std::size_t place = archive.rfind(mark);
    if (place == std::string_view::npos) return {};
    ByteReader reader = little_endian(archive.substr(place));
    std::uint32_t begin = 0;
    if (!reader.skip(16) || !reader.read(begin) || begin > archive.size()) return {};
    return begin;
}

/// The packed bytes of a member.
std::optional<std::string_view> packed_bytes(std::string_view archive, const Entry& entry) {
    if (entry.offset > archive.size()) return {};
    ByteReader reader = little_endian(archive.substr(entry.offset));
    std::uint32_t mark = 0;
    std::uint16_t name = 0, extra = 0;
    if (!reader.read(mark) || mark != local_mark || !reader.skip(22) || !reader.read(name) || !reader.read(extra) ||
        !reader.skip(std::size_t{name} + extra))
        return {};
    return take(reader, entry.packed);
}

Result<std::string> unpacked(std::string_view packed, const Entry& entry) {
    const Error broken = invalid_data(fmt::format("the member \"{}\" of the archive is broken", entry.name));
    if (entry.method == stored) {
        const bool whole = entry.packed == entry.size;
        if (!whole || libdeflate_crc32(0, packed.data(), packed.size()) != entry.check) return broken;
        return std::string(packed);
    }
    if (entry.method != deflated)
        return invalid_data(fmt::format("the member \"{}\" of the archive is packed by method {}: 0 and 8 are read",
                                        entry.name, entry.method));
    const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> inflate(libdeflate_alloc_decompressor());
    if (!inflate) return Error{ErrorCode::out_of_memory, "no memory left to unpack an archive"};
    std::string content(entry.size, '\0');
    const auto status = libdeflate_deflate_decompress(inflate.get(), packed.data(), packed.size(), content.data(),
                                                      content.size(), nullptr);
    if (status != LIBDEFLATE_SUCCESS || libdeflate_crc32(0, content.data(), content.size()) != entry.check)
        return broken;
    return content;
}

/// One call of libdeflate, which cannot be asked to stop: where it lasts, in a process of its own.
Result<std::string> packed_content(std::string_view content, const Progress& progress) {
    constexpr std::size_t soon_done = std::size_t{4} << 20;
    const std::unique_ptr<libdeflate_compressor, FreeCompressor> deflate(libdeflate_alloc_compressor(level));
    if (!deflate) return no_memory_to_pack();
    const std::size_t bound = libdeflate_deflate_compress_bound(deflate.get(), content.size());
    const auto pack = [&](char* to) {
        return libdeflate_deflate_compress(deflate.get(), content.data(), content.size(), to, bound);
    };
    if (content.size() >= soon_done) {
        const core::SharedMemory memory(sizeof(std::size_t) + bound);
        auto* const size = static_cast<std::size_t*>(memory.data());
        auto* const bytes = reinterpret_cast<char*>(size + 1);
        switch (size ? core::run_apart(progress, [&] { *size = pack(bytes); }) : core::Apart::refused) {
        case core::Apart::done: return std::string(bytes, *size);
        case core::Apart::cancelled: return Error{ErrorCode::cancelled, "packing an archive was cancelled"};
        case core::Apart::failed:
        case core::Apart::refused: break;
        }
    }
    std::string packed(bound, '\0');
    packed.resize(pack(packed.data()));
    return packed;
}

} // namespace

void ZipWriter::put_facts(std::string& out, const Member& member) {
    put_little(version_needed, out);
    put_little(name_is_utf8, out);
    put_little(deflated, out);
    put_little(std::uint16_t{0}, out); // time
    put_little(first_day, out);
    put_little(member.check, out);
    put_little(member.packed, out);
    put_little(member.size, out);
    put_little(static_cast<std::uint16_t>(member.name.size()), out);
    put_little(std::uint16_t{0}, out); // nothing extra
}

Result<void> ZipWriter::add(std::string_view name, std::string_view content, const Progress& progress) {
    Result<std::string> deflated_content = packed_content(content, progress);
    if (!deflated_content) return deflated_content.error();
    const std::string packed = *std::move(deflated_content);
    if (content.size() > largest || bytes_.size() + packed.size() > largest - (1 << 20))
        return Error{ErrorCode::invalid_argument,
                     fmt::format("an archive holds at most 4 GB, but \"{}\" has {} bytes", name, content.size())};
    Member member{std::string(name), libdeflate_crc32(0, content.data(), content.size()),
                  static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(content.size()),
                  static_cast<std::uint32_t>(bytes_.size())};
    put_little(local_mark, bytes_);
    put_facts(bytes_, member);
    bytes_ += member.name;
    bytes_ += packed;
    members_.push_back(std::move(member));
    return {};
}

std::string ZipWriter::finish() && {
    const std::size_t begin = bytes_.size();
    for (const Member& member : members_) {
        put_little(central_mark, bytes_);
        put_little(version_needed, bytes_);
        put_facts(bytes_, member);
        put_little(std::uint16_t{0}, bytes_); // no comment
        put_little(std::uint16_t{0}, bytes_); // first disk
        put_little(std::uint16_t{0}, bytes_); // internal attributes
        put_little(std::uint32_t{0}, bytes_); // external attributes
        put_little(member.offset, bytes_);
        bytes_ += member.name;
    }
    const std::size_t size = bytes_.size() - begin;
    put_little(end_mark, bytes_);
    put_little(std::uint32_t{0}, bytes_); // this disk, and that of the directory
    put_little(static_cast<std::uint16_t>(members_.size()), bytes_);
    put_little(static_cast<std::uint16_t>(members_.size()), bytes_);
    put_little(static_cast<std::uint32_t>(size), bytes_);
    put_little(static_cast<std::uint32_t>(begin), bytes_);
    put_little(std::uint16_t{0}, bytes_); // no comment
    return std::move(bytes_);
}

bool is_zip(std::string_view content) { return content.starts_with("PK\3\4"); }

Result<std::string> read_from_zip(std::string_view archive, std::string_view ending, std::uint64_t most) {
    const auto begin = directory_of(archive);
    if (!begin) return invalid_data("the archive has no directory: it was cut off, or is none");
    ByteReader reader = little_endian(archive.substr(*begin));
    while (const auto entry = next_entry(reader)) {
        if (!entry->name.ends_with(ending)) continue;
        if (entry->size > most)
            return invalid_data(fmt::format("the member \"{}\" of the archive has {} bytes, more than the {} that are "
                                            "read",
                                            entry->name, entry->size, most));
        const auto packed = packed_bytes(archive, *entry);
        if (!packed) return invalid_data(fmt::format("the member \"{}\" of the archive is cut off", entry->name));
        return unpacked(*packed, *entry);
    }
    return invalid_data(fmt::format("the archive has no member that ends with \"{}\"", ending));
}

} // namespace isotet::io
