// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_stored_rows.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/vtk_xml/codec.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t max_chunk_bytes = std::uint64_t{1} << 28; ///< of larger ones HDF5 reads parts

/// Nothing where a filter is another one.
std::optional<ChunkShape> with_filters(hid_t creation, ChunkShape shape) {
    const int count = H5Pget_nfilters(creation);
    if (count < 0) return std::nullopt;
    for (int i = 0; i < count; ++i) {
        unsigned flags = 0, configuration = 0;
        std::size_t values = 0;
        const H5Z_filter_t filter =
            H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &configuration);
        if (filter == H5Z_FILTER_SHUFFLE && i == 0) shape.shuffled = true;
        else if (filter == H5Z_FILTER_DEFLATE && i == count - 1) shape.deflated = true;
        else return std::nullopt;
    }
    return shape;
}

/// Nothing where HDF5 has to read the chunks.
std::optional<ChunkShape> chunk_shape_of(hid_t creation, int rank, std::size_t scalar) {
    std::array<hsize_t, 2> lengths{1, 1};
    if (H5Pget_chunk(creation, rank, lengths.data()) != rank || lengths[0] == 0 || lengths[1] == 0) return std::nullopt;
    const ChunkShape shape{lengths[0], rank == 2 ? lengths[1] : 1};
    if (shape.rows > max_chunk_bytes || shape.columns > max_chunk_bytes / shape.rows / scalar) return std::nullopt;
    return with_filters(creation, shape);
}

/// Where the chunks of some rows lie; nothing where one is filled in or has its own filters.
std::optional<std::vector<StoredChunk>> chunks_of(hid_t data, int rank, const ChunkShape& shape,
                                                  const RowRange& range) {
    std::vector<StoredChunk> out;
    for (std::uint64_t row = range.first / shape.rows * shape.rows; row < range.end(); row += shape.rows)
        for (std::uint64_t column = 0; column < range.columns; column += shape.columns) {
            const std::array<hsize_t, 2> offset{row, column};
            unsigned mask = 0;
            haddr_t address = HADDR_UNDEF;
            hsize_t bytes = 0;
            if (H5Dget_chunk_info_by_coord(data, offset.data(), &mask, &address, &bytes) < 0 || mask != 0 ||
                address == HADDR_UNDEF)
                return std::nullopt;
            out.push_back({row, rank == 2 ? column : 0, address, bytes});
        }
    return out;
}

template <std::size_t size>
void unshuffle_scalars(const std::byte* from, std::byte* to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < size; ++b) to[i * size + b] = from[b * count + i];
}

void unshuffle(std::span<const std::byte> from, std::byte* to, std::size_t scalar) {
    const std::size_t count = from.size() / scalar;
    switch (scalar) {
    case 2: return unshuffle_scalars<2>(from.data(), to, count);
    case 4: return unshuffle_scalars<4>(from.data(), to, count);
    case 8: return unshuffle_scalars<8>(from.data(), to, count);
    default: std::memcpy(to, from.data(), from.size());
    }
}

/// Memory of one thread, for one chunk after another.
struct ChunkScratch {
    Scratch packed, shuffled, whole;

    void trim() noexcept {
        for (Scratch* one : {&packed, &shuffled, &whole}) one->trim();
    }
};

thread_local ChunkScratch chunk_scratch;

} // namespace

std::optional<StoredRows> StoredRows::find(hid_t data, hid_t creation, int rank, const ByteSource& source,
                                           const RowRange& range) {
    StoredRows found(source, range);
    const H5D_layout_t layout = H5Pget_layout(creation);
    if (layout == H5D_CONTIGUOUS) {
        const haddr_t address = H5Dget_offset(data);
        if (address == HADDR_UNDEF) return std::nullopt;
        found.address_ = address;
        return found;
    }
    if (layout != H5D_CHUNKED) return std::nullopt;
    found.shape_ = chunk_shape_of(creation, rank, range.scalar);
    if (!found.shape_) return std::nullopt;
    auto chunks = chunks_of(data, rank, *found.shape_, range);
    if (!chunks) return std::nullopt;
    found.chunks_ = *std::move(chunks);
    return found;
}

Result<void> StoredRows::each_stretch(std::size_t bytes, const Work& work) const {
    const std::uint64_t unit = shape_ ? shape_->rows : 1; // chunks are not cut
    const std::uint64_t rows = std::max<std::uint64_t>(1, bytes / range_.row_bytes() / unit) * unit;
    const std::uint64_t origin = range_.first / unit * unit;
    FirstError error;
    core::parallel_each((range_.end() - origin + rows - 1) / rows, 1, [&](std::size_t i) {
        if (error) return;
        const std::uint64_t begin = std::max(origin + i * rows, range_.first);
        if (auto done = work(begin, std::min(origin + (i + 1) * rows, range_.end())); !done) error.add(i, done.error());
    });
    return error.result();
}

Result<void> StoredRows::read(std::uint64_t begin, std::uint64_t end, std::byte* to) const {
    if (!shape_) return source_.read(address_ + begin * range_.row_bytes(), {to, (end - begin) * range_.row_bytes()});
    const std::uint64_t beside = (range_.columns + shape_->columns - 1) / shape_->columns;
    const std::uint64_t first = range_.first / shape_->rows;
    for (std::uint64_t i = begin / shape_->rows; i * shape_->rows < end; ++i)
        for (std::uint64_t k = 0; k < beside; ++k) {
            const StoredChunk& chunk = chunks_[(i - first) * beside + k];
            if (auto read = read_chunk(chunk, begin, end, to); !read) return read;
        }
    chunk_scratch.trim();
    return {};
}

/// What a chunk has of rows [begin, end).
Result<void> StoredRows::read_chunk(const StoredChunk& chunk, std::uint64_t begin, std::uint64_t end,
                                    std::byte* to) const {
    const std::uint64_t first = std::max(chunk.row, begin), last = std::min(chunk.row + shape_->rows, end);
    const std::size_t row_bytes = shape_->columns * range_.scalar, bytes = shape_->rows * row_bytes;
    const auto place = [&](std::uint64_t row) {
        return to + (row - begin) * range_.row_bytes() + chunk.column * range_.scalar;
    };
    if (last - first == shape_->rows && shape_->columns == range_.columns) return decode(chunk, {place(first), bytes});
    const std::span<std::byte> whole = chunk_scratch.whole.take(bytes);
    if (auto decoded = decode(chunk, whole); !decoded) return decoded;
    const std::uint64_t columns = std::min<std::uint64_t>(shape_->columns, range_.columns - chunk.column);
    for (std::uint64_t row = first; row < last; ++row)
        std::memcpy(place(row), whole.data() + (row - chunk.row) * row_bytes, columns * range_.scalar);
    return {};
}

Result<void> StoredRows::decode(const StoredChunk& chunk, std::span<std::byte> to) const {
    const auto wrong = [&](std::string_view what) {
        return Error{ErrorCode::invalid_data, fmt::format("the chunk at byte {} {}", chunk.address, what)};
    };
    if (!shape_->deflated && chunk.bytes != to.size())
        return wrong(fmt::format("has {} bytes, but its values take {}", chunk.bytes, to.size()));
    if (shape_->deflated && !vtk_xml::is_plausible(vtk_xml::Codec::zlib, chunk.bytes, to.size()))
        return wrong(fmt::format("of {} bytes cannot become {}", chunk.bytes, to.size()));
    const bool shuffled = shape_->shuffled && range_.scalar > 1;
    const std::span<std::byte> inflated = shuffled ? chunk_scratch.shuffled.take(to.size()) : to;
    if (!shape_->deflated) {
        if (auto read = source_.read(chunk.address, inflated); !read) return read;
    } else {
        const auto packed = source_.view(chunk.address, chunk.bytes, chunk_scratch.packed);
        if (!packed) return packed.error();
        if (!vtk_xml::inflate(vtk_xml::Codec::zlib, *packed, inflated)) return wrong("cannot be inflated");
    }
    if (shuffled) unshuffle(inflated, to.data(), range_.scalar);
    return {};
}

} // namespace isotet::io::confined
