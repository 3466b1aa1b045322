// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/piece_reader.hpp"

#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/files/crc32c.hpp"
#include "io/files/first_error.hpp"
#include "io/packed/checks.hpp"
#include "io/packed/directory.hpp"

namespace isotet::io {

namespace {

/// Pieces that lie side by side are read together up to here.
constexpr std::uint64_t largest_run = std::uint64_t{1} << 20;
constexpr std::size_t most_parts = 256; ///< of a preadv()

Error piece_checksum_differs(std::size_t chunk) {
    return invalid_data(fmt::format("chunk {} is broken: its checksum differs", chunk));
}

/// preadv() until all is there.
Result<void> read_parts(const PackedSource& source, std::uint64_t at, std::vector<iovec> parts) {
    std::size_t first = 0;
    while (first < parts.size()) {
        const int count = static_cast<int>(std::min(parts.size() - first, most_parts));
        const ssize_t read =
            ::preadv(source.file.descriptor.number(), parts.data() + first, count, static_cast<off_t>(at));
        if (read < 0 && errno == EINTR) continue;
        if (read < 0) return core::system_error(source.path, "cannot be read", errno);
        if (read == 0)
            return Error{ErrorCode::file, fmt::format("{} was cut short while it was read: it had {} bytes",
                                                      source.path, source.file.size)};
        source.reads.fetch_add(1, std::memory_order_relaxed);
        source.bytes_read.fetch_add(static_cast<std::uint64_t>(read), std::memory_order_relaxed);
        at += static_cast<std::uint64_t>(read);
        auto left = static_cast<std::size_t>(read);
        while (first < parts.size() && left >= parts[first].iov_len) left -= parts[first++].iov_len;
        if (left == 0) continue;
        parts[first].iov_base = static_cast<std::byte*>(parts[first].iov_base) + left;
        parts[first].iov_len -= left;
    }
    return {};
}

/// Consecutive pieces [begin, end) of a list.
struct PieceRun {
    std::size_t begin, end;
};

std::vector<PieceRun> runs_of(const PackedSource& source, std::span<const PieceWish> wishes) {
    const auto offset = [&](std::size_t i) { return wishes[i].kind->offsets[wishes[i].chunk]; };
    const auto end_of = [&](std::size_t i) {
        return offset(i) + wishes[i].kind->bytes(source.directory, wishes[i].chunk);
    };
    std::vector<PieceRun> runs;
    for (std::size_t i = 0; i < wishes.size(); ++i) {
        const bool joins = !runs.empty() && offset(i) <= align_piece(end_of(i - 1)) &&
                           end_of(i) - offset(runs.back().begin) <= largest_run;
        if (joins) runs.back().end = i + 1;
        else runs.push_back({i, i + 1});
    }
    return runs;
}

Result<void> read_run(const PackedSource& source, const ChunkPlaces& places, std::span<const PieceWish> wishes) {
    std::array<std::byte, piece_alignment> between; // pieces
    std::vector<iovec> parts;
    const std::uint64_t begin = wishes.front().kind->offsets[wishes.front().chunk];
    std::uint64_t at = begin;
    for (const auto& [kind, chunk] : wishes) {
        const std::uint64_t offset = kind->offsets[chunk];
        if (offset > at) parts.push_back({between.data(), static_cast<std::size_t>(offset - at)});
        at = offset;
        for (std::size_t a = 0; a < kind->arrays.size(); ++a) {
            const std::span<std::byte> part = kind->part(source.directory, places, a, chunk);
            if (!part.empty()) parts.push_back({part.data(), part.size()});
            at += part.size();
        }
    }
    if (auto ok = read_parts(source, begin, std::move(parts)); !ok) return ok;
    for (const auto& [kind, chunk] : wishes) {
        std::uint32_t checksum = 0;
        for (std::size_t a = 0; a < kind->arrays.size(); ++a)
            checksum = crc32c(kind->part(source.directory, places, a, chunk), checksum);
        if (checksum != kind->checksum(chunk)) return piece_checksum_differs(chunk);
        if (auto ok = kind->check(chunk); !ok) return ok;
    }
    return {};
}

/// Reads the pieces of a table, one right behind the other, several at once, and calls use(chunk, bytes) for each.
/// `bytes_of`, `checksum_of`   of a chunk's piece
template <class BytesOf, class ChecksumOf, class Use>
Result<void> read_table(const PackedSource& source, std::uint64_t offset, const BytesOf& bytes_of,
                        const ChecksumOf& checksum_of, const Progress& progress, const Use& use) {
    const std::size_t chunks = source.directory.chunks.size();
    std::vector<std::uint64_t> starts{offset};
    for (std::size_t k = 0; k < chunks; ++k) starts.push_back(starts.back() + bytes_of(k));
    constexpr std::size_t chunks_at_once = 512;
    FirstError first_error;
    core::parallel_each((chunks + chunks_at_once - 1) / chunks_at_once, 1, [&](std::size_t task) {
        if (progress.cancelled() || first_error) return;
        const std::size_t begin = task * chunks_at_once, end = std::min(chunks, begin + chunks_at_once);
        core::Buffer<std::byte> bytes(starts[end] - starts[begin]);
        if (auto ok = source.read(starts[begin], {bytes.data(), bytes.size()}); !ok)
            return first_error.add(begin, ok.error());
        for (std::size_t k = begin; k < end; ++k) {
            const std::span<const std::byte> piece(bytes.data() + (starts[k] - starts[begin]), bytes_of(k));
            if (crc32c(piece) != checksum_of(k)) return first_error.add(k, piece_checksum_differs(k));
            if (auto ok = use(k, piece); !ok) return first_error.add(k, ok.error());
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    return first_error.result();
}

} // namespace

Error PackedSource::in_file(Error error) const {
    if (error.code == ErrorCode::invalid_data) error.message = path + ": " + error.message;
    return error;
}

Result<void> PackedSource::read(std::uint64_t at, std::span<std::byte> to) const {
    if (to.empty()) return {};
    reads.fetch_add(1, std::memory_order_relaxed);
    bytes_read.fetch_add(to.size(), std::memory_order_relaxed);
    return read_at(file, path, at, to);
}

Result<std::shared_ptr<const PackedSource>> PackedSource::open(const std::string& path) {
    auto source = std::make_shared<PackedSource>();
    source->path = path;
    Result<core::PlainFile> file = core::open_plain_file(path);
    if (!file) return file.error();
    source->file = *std::move(file);
    std::vector<std::byte> header(std::min<std::size_t>(packed_header_bytes, source->file.size));
    if (auto ok = source->read(0, header); !ok) return ok.error();
    const Result<DirectorySlot> slot = decode_packed_header(header, source->file.size, &source->slot_place);
    if (!slot) return source->in_file(slot.error());
    source->slot = *slot;
    std::memcpy(&source->minor, header.data() + packed_minor_at, sizeof source->minor);
    core::Buffer<std::byte> bytes(slot->bytes);
    const std::span<std::byte> all(bytes.data(), bytes.size());
    if (auto ok = source->read(slot->offset, all); !ok) return ok.error();
    if (crc32c(all) != slot->checksum)
        return source->in_file(invalid_data("the directory is broken: its checksum differs"));
    Result<PackedDirectory> directory = decode_directory(all, slot->file_bytes);
    if (!directory) return source->in_file(directory.error());
    source->directory = *std::move(directory);
    return std::shared_ptr<const PackedSource>(std::move(source));
}

std::uint64_t PieceKind::bytes(const PackedDirectory& directory, std::size_t chunk) const {
    std::uint64_t sum = 0;
    for (const ChunkedArray& array : arrays) sum += array.bytes_each * directory.chunks[chunk].count(array.unit);
    return sum;
}

std::span<std::byte> PieceKind::part(const PackedDirectory& directory, const ChunkPlaces& places, std::size_t array,
                                     std::size_t chunk) const {
    const ChunkedArray& a = arrays[array];
    return {a.data + a.bytes_each * places.of(a.unit, chunk),
            static_cast<std::size_t>(a.bytes_each * directory.chunks[chunk].count(a.unit))};
}

Result<void> read_pieces(const PackedSource& source, const ChunkPlaces& places, std::vector<PieceWish> wishes,
                         const Progress& progress) {
    std::ranges::sort(wishes, {}, [](const PieceWish& wish) { return wish.kind->offsets[wish.chunk]; });
    const std::vector<PieceRun> runs = runs_of(source, wishes);
    FirstError first_error;
    core::parallel_each(runs.size(), 1, [&](std::size_t i) {
        if (progress.cancelled() || first_error) return;
        const PieceRun run = runs[i];
        if (auto ok = read_run(source, places, std::span(wishes).subspan(run.begin, run.end - run.begin)); !ok)
            first_error.add(i, ok.error());
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    if (auto ok = first_error.result(); !ok) return source.in_file(ok.error());
    return {};
}

Result<core::SharedBuffer<core::ClusterHeader>> read_headers(const PackedSource& source, const ChunkPlaces& places,
                                                             const Progress& progress) {
    const PackedDirectory& d = source.directory;
    core::SharedBuffer<core::ClusterHeader> headers(d.clusters);
    const auto use = [&](std::size_t chunk, std::span<const std::byte> bytes) {
        return decode_headers(bytes, d.chunks[chunk], places, chunk, headers.data() + places.first_cluster[chunk]);
    };
    const auto read = read_table(
        source, d.clusters_offset, [&](std::size_t k) { return cluster_record_bytes * d.chunks[k].clusters; },
        [&](std::size_t k) { return d.chunks[k].clusters_checksum; }, progress, use);
    if (!read) return source.in_file(read.error());
    return headers;
}

Result<void> read_ranges(const PackedSource& source, const FieldEntry& field, core::Packed& packed,
                         const Progress& progress) {
    const PackedDirectory& d = source.directory;
    packed.has_no_data = core::SharedBuffer<std::uint8_t>(d.clusters);
    const auto read = std::visit(
        [&]<class Real>(core::Values<Real>& reals) {
            reals.ranges = core::SharedBuffer<core::Range<Real>>(d.clusters);
            std::uint64_t first = 0;
            std::vector<std::uint64_t> firsts;
            for (const ChunkEntry& chunk : d.chunks) {
                firsts.push_back(first);
                first += chunk.clusters;
            }
            const auto use = [&](std::size_t chunk, std::span<const std::byte> bytes) -> Result<void> {
                const std::size_t count = d.chunks[chunk].clusters, ranges = count * sizeof(core::Range<Real>);
                std::memcpy(reals.ranges.data() + firsts[chunk], bytes.data(), ranges);
                std::memcpy(packed.has_no_data.data() + firsts[chunk], bytes.data() + ranges, count);
                return {};
            };
            return read_table(
                source, field.ranges_offset, [&](std::size_t k) { return d.ranges_bytes(d.chunks[k]); },
                [&](std::size_t k) { return field.ranges_checksums[k]; }, progress, use);
        },
        packed.reals);
    return read ? read : Result<void>(source.in_file(read.error()));
}

} // namespace isotet::io
