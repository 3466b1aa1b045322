// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_rows.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "io/confined/hdf5/hdf5_handle.hpp"
#include "io/confined/hdf5/hdf5_unwritten.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/escape.hpp"
#include "io/files/first_error.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/narrow_indices.hpp"
#include "io/vtk_xml/codec.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::uint64_t max_chunk_bytes = std::uint64_t{1} << 28; ///< of larger ones HDF5 reads parts
constexpr std::size_t plain_bytes = std::size_t{4} << 20;         ///< read at once of rows that are stored as they are
constexpr std::uint64_t window_rows = std::uint64_t{1} << 20;     ///< of indices, read before they become narrow
constexpr std::uint64_t many_bytes = std::uint64_t{64} << 20; ///< asking what is free takes longer than reading fewer

/// Which rows of a data set, and where they go.
struct RowRange {
    std::uint64_t first = 0, rows = 0;
    std::size_t columns = 1, scalar = 1; ///< scalar: bytes
    std::byte* to = nullptr;

    std::uint64_t row_bytes() const { return columns * scalar; }
    std::uint64_t bytes() const { return rows * row_bytes(); }
};

struct ChunkFilters {
    bool deflated = false, shuffled = false;
};

/// Nothing where a filter is another one.
std::optional<ChunkFilters> filters_of(hid_t creation) {
    ChunkFilters found;
    const int count = H5Pget_nfilters(creation);
    if (count < 0) return std::nullopt;
    for (int i = 0; i < count; ++i) {
        unsigned flags = 0, configuration = 0;
        std::size_t values = 0;
        const H5Z_filter_t filter =
            H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &configuration);
        if (filter == H5Z_FILTER_SHUFFLE && i == 0) found.shuffled = true;
        else if (filter == H5Z_FILTER_DEFLATE && i == count - 1) found.deflated = true;
        else return std::nullopt;
    }
    return found;
}

struct StoredChunk {
    std::uint64_t row = 0, column = 0; ///< its first ones
    std::uint64_t address = 0, bytes = 0;
};

/// How a data set is cut.
struct ChunkShape {
    std::uint64_t rows = 1, columns = 1;
    ChunkFilters filters;
};

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

/// Brings chunks to their places, each on its own.
class ChunkReader {
public:
    ChunkReader(const ByteSource& source, const ChunkShape& shape, const RowRange& range, ChunkScratch& scratch)
        : source_(source),
          shape_(shape),
          range_(range),
          bytes_(shape.rows * shape.columns * range.scalar),
          scratch_(scratch) {}

    Result<void> read(const StoredChunk& chunk) {
        const std::uint64_t begin = std::max(chunk.row, range_.first);
        const std::uint64_t end = std::min(chunk.row + shape_.rows, range_.first + range_.rows);
        const std::uint64_t columns = std::min<std::uint64_t>(shape_.columns, range_.columns - chunk.column);
        const bool straight = begin == chunk.row && end == chunk.row + shape_.rows && shape_.columns == range_.columns;
        std::byte* const whole = straight ? place(begin, 0) : scratch_.whole.take(bytes_).data();
        if (auto decoded = decode(chunk, {whole, bytes_}); !decoded) return decoded;
        if (straight) return {};
        for (std::uint64_t row = begin; row < end; ++row)
            std::memcpy(place(row, chunk.column), whole + (row - chunk.row) * shape_.columns * range_.scalar,
                        columns * range_.scalar);
        return {};
    }

private:
    std::byte* place(std::uint64_t row, std::uint64_t column) const {
        return range_.to + (row - range_.first) * range_.row_bytes() + column * range_.scalar;
    }

    Result<void> decode(const StoredChunk& chunk, std::span<std::byte> to) {
        const auto wrong = [&](std::string_view what) {
            return Error{ErrorCode::invalid_data, fmt::format("the chunk at byte {} {}", chunk.address, what)};
        };
        if (!shape_.filters.deflated && chunk.bytes != to.size())
            return wrong(fmt::format("has {} bytes, but its values take {}", chunk.bytes, to.size()));
        if (shape_.filters.deflated && !vtk_xml::is_plausible(vtk_xml::Codec::zlib, chunk.bytes, to.size()))
            return wrong(fmt::format("of {} bytes cannot become {}", chunk.bytes, to.size()));
        const bool shuffled = shape_.filters.shuffled && range_.scalar > 1;
        const std::span<std::byte> inflated = shuffled ? scratch_.shuffled.take(to.size()) : to;
        if (!shape_.filters.deflated) {
            if (auto read = source_.read(chunk.address, inflated); !read) return read;
        } else {
            const auto packed = source_.view(chunk.address, chunk.bytes, scratch_.packed);
            if (!packed) return packed.error();
            if (!vtk_xml::inflate(vtk_xml::Codec::zlib, *packed, inflated)) return wrong("cannot be inflated");
        }
        if (shuffled) unshuffle(inflated, to.data(), range_.scalar);
        return {};
    }

    const ByteSource& source_;
    const ChunkShape& shape_;
    const RowRange& range_;
    const std::size_t bytes_;
    ChunkScratch& scratch_;
};

/// Where the chunks of some rows lie. Nothing where HDF5 has to read them: filled in, or with another filter.
std::optional<std::vector<StoredChunk>> chunks_of(hid_t data, int rank, const ChunkShape& shape,
                                                  const RowRange& range) {
    std::vector<StoredChunk> out;
    for (std::uint64_t row = range.first / shape.rows * shape.rows; row < range.first + range.rows; row += shape.rows)
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

/// False: not read, since HDF5 has to.
Result<bool> read_chunks(hid_t data, hid_t creation, int rank, const ByteSource& source, const RowRange& range) {
    std::array<hsize_t, 2> lengths{1, 1};
    if (H5Pget_chunk(creation, rank, lengths.data()) != rank) return false;
    const auto filters = filters_of(creation);
    if (!filters || lengths[0] == 0 || lengths[1] == 0) return false;
    const ChunkShape shape{lengths[0], rank == 2 ? lengths[1] : 1, *filters};
    if (shape.rows > max_chunk_bytes || shape.columns > max_chunk_bytes / shape.rows / range.scalar) return false;
    const auto chunks = chunks_of(data, rank, shape, range);
    if (!chunks) return false;
    FirstError error;
    const auto threads = static_cast<std::size_t>(core::threads_here());
    const std::size_t grain = std::max<std::size_t>(1, chunks->size() / (8 * threads));
    core::parallel_ranges(chunks->size(), grain, [&](std::size_t begin, std::size_t end) {
        thread_local ChunkScratch scratch;
        ChunkReader reader(source, shape, range, scratch);
        for (std::size_t i = begin; i < end && !error; ++i)
            if (auto read = reader.read((*chunks)[i]); !read) error.add(i, read.error());
        scratch.trim();
    });
    if (auto done = error.result(); !done) return done.error();
    return true;
}

/// Rows that lie one after another.
Result<void> read_plain(const ByteSource& source, std::uint64_t address, const RowRange& range) {
    const std::uint64_t begin = address + range.first * range.row_bytes(), bytes = range.bytes();
    FirstError error;
    core::parallel_ranges((bytes + plain_bytes - 1) / plain_bytes, 1, [&](std::size_t first, std::size_t last) {
        const std::uint64_t from = first * plain_bytes, to = std::min<std::uint64_t>(last * plain_bytes, bytes);
        if (auto read = source.read(begin + from, {range.to + from, to - from}); !read) error.add(first, read.error());
    });
    return error.result();
}

/// By HDF5, into the type that memory has.
HdfRead read_by_library(hid_t data, hid_t space, hid_t type, int rank, const RowRange& range) {
    const std::array<hsize_t, 2> start{range.first, 0}, count{range.rows, range.columns};
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
        return HdfRead::failed;
    const Handle memory(H5Screate_simple(rank, count.data(), nullptr), H5Sclose);
    return read_written(data, type, memory, space, {range.to, range.bytes()});
}

/// Links may lead to another file.
std::string name_of_file(hid_t object) {
    const ssize_t length = H5Fget_name(object, nullptr, 0);
    std::string name(length < 0 ? 0 : static_cast<std::size_t>(length) + 1, '\0');
    if (length > 0) H5Fget_name(object, name.data(), name.size());
    return name;
}

std::uint64_t chunk_rows_of(hid_t creation, int rank) {
    std::array<hsize_t, 2> lengths{1, 1};
    if (H5Pget_layout(creation) != H5D_CHUNKED || H5Pget_chunk(creation, rank, lengths.data()) != rank) return 1;
    return std::max<std::uint64_t>(lengths[0], 1);
}

/// An open data set with its shape.
struct DataSet {
    Handle data, creation, space, stored;
    int rank = 0;
    RowsShape shape;
};

} // namespace

struct Hdf5Rows::File {
    std::string path;
    ByteSource source;
    Handle file;
    bool starts_at_zero; ///< else places are relative to what stands before

    std::unique_ptr<DataSet> data_set(const std::string& name) const;
};

std::unique_ptr<DataSet> Hdf5Rows::File::data_set(const std::string& name) const {
    for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1))
        if (H5Lexists(file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return nullptr;
    if (H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0) return nullptr;
    const hid_t data = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    if (data < 0) return nullptr;
    std::unique_ptr<DataSet> set(new DataSet{{data, H5Dclose},
                                             {H5Dget_create_plist(data), H5Pclose},
                                             {H5Dget_space(data), H5Sclose},
                                             {H5Dget_type(data), H5Tclose},
                                             0,
                                             {}});
    const auto type = set->stored.good() ? scalar_type_of(set->stored) : std::nullopt;
    set->rank = set->space.good() ? H5Sget_simple_extent_ndims(set->space) : 0;
    if (!type || (set->rank != 1 && set->rank != 2) || !set->creation.good()) return nullptr;
    std::array<hsize_t, 2> extent{0, 1};
    H5Sget_simple_extent_dims(set->space, extent.data(), nullptr);
    if (extent[1] == 0 || extent[1] > 1'000'000) return nullptr;
    set->shape = {extent[0], static_cast<std::size_t>(extent[1]), *type, chunk_rows_of(set->creation, set->rank)};
    return set;
}

Hdf5Rows::Hdf5Rows(std::unique_ptr<File> file) : file_(std::move(file)) {}
Hdf5Rows::Hdf5Rows(Hdf5Rows&&) noexcept = default;
Hdf5Rows& Hdf5Rows::operator=(Hdf5Rows&&) noexcept = default;
Hdf5Rows::~Hdf5Rows() = default;

Result<Hdf5Rows> Hdf5Rows::open(const std::string& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // errors are returned, not printed
    auto source = ByteSource::open(path);
    if (!source) return source.error();
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return broken(path, "not an HDF5 file, or a broken one");
    std::unique_ptr<File> opened(new File{path, *std::move(source), {file, H5Fclose}, false});
    const Handle creation(H5Fget_create_plist(file), H5Pclose);
    hsize_t before = 1;
    opened->starts_at_zero = creation.good() && H5Pget_userblock(creation, &before) >= 0 && before == 0;
    return Hdf5Rows(std::move(opened));
}

std::optional<RowsShape> Hdf5Rows::shape(const std::string& name) const {
    const auto set = file_->data_set(name);
    return set ? std::optional(set->shape) : std::nullopt;
}

Result<Array> Hdf5Rows::read(const std::string& name, std::uint64_t first, std::uint64_t rows) const {
    const auto failed = [&](std::string_view what) {
        return broken(file_->path, fmt::format("data set \"{}\" {}", escaped(name), what));
    };
    const auto set = file_->data_set(name);
    if (!set) return failed("is not there, or does not hold rows of numbers");
    const RowsShape& shape = set->shape;
    if (first > shape.rows || rows > shape.rows - first)
        return failed(fmt::format("has {} rows, but {} from row {} on are needed", shape.rows, rows, first));
    const std::size_t scalar = size_of(shape.type);
    if (rows > (std::uint64_t{1} << 50) / shape.columns / scalar) return failed("is too large");
    const std::uint64_t bytes = rows * shape.columns * scalar;
    if (bytes > many_bytes)
        if (auto fits = core::require_memory("an array", bytes); !fits) return fits.error();
    return Array(shape.type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> Result<Array> {
        core::Buffer<T> values(rows * shape.columns);
        if (rows == 0) return std::move(values).to_array(shape.columns);
        const RowRange range{first, rows, shape.columns, scalar, reinterpret_cast<std::byte*>(values.data())};
        bool done = false;
        if (file_->starts_at_zero && name_of_file(set->data) == name_of_file(file_->file) &&
            H5Tequal(set->stored, native_type<T>()) > 0) {
            const H5D_layout_t layout = H5Pget_layout(set->creation);
            const haddr_t address = layout == H5D_CONTIGUOUS ? H5Dget_offset(set->data) : HADDR_UNDEF;
            if (address != HADDR_UNDEF) {
                if (auto read = read_plain(file_->source, address, range); !read) return failed(read.error().message);
                done = true;
            } else if (layout == H5D_CHUNKED) {
                const auto read = read_chunks(set->data, set->creation, set->rank, file_->source, range);
                if (!read) return failed(read.error().message);
                done = *read;
            }
        }
        if (!done) {
            const HdfRead by_library = read_by_library(set->data, set->space, native_type<T>(), set->rank, range);
            if (by_library == HdfRead::failed) return failed("cannot be read");
            if (by_library == HdfRead::unwritten) return failed("has values that were never written");
        }
        return std::move(values).to_array(shape.columns);
    });
}

Result<Array> Hdf5Rows::read_indices(const std::string& name, std::uint64_t first, std::uint64_t rows) const {
    const auto found = shape(name);
    if (!found || found->columns != 1 || !NarrowIndices::narrows(found->type) || first > found->rows ||
        rows > found->rows - first)
        return read(name, first, rows);
    NarrowIndices narrow(rows);
    const auto done = each_piece(name, first, rows, [&](std::uint64_t place, const Array& window) {
        window.visit([&]<class T>(std::span<const T> values) {
            if constexpr (std::is_integral_v<T>)
                core::parallel_ranges(values.size(), window_rows / 64, [&](std::size_t from, std::size_t to) {
                    narrow.add(place + from, values.subspan(from, to - from));
                });
        });
    });
    if (!done) return done.error();
    auto array = std::move(narrow).to_array();
    return array ? *std::move(array) : read(name, first, rows);
}

Result<void> Hdf5Rows::each_piece(const std::string& name, std::uint64_t first, std::uint64_t rows,
                                  const std::function<void(std::uint64_t first, const Array& values)>& take) const {
    const auto found = shape(name);
    const std::uint64_t chunk = found ? found->chunk_rows : 1, chunks = std::max<std::uint64_t>(1, window_rows / chunk);
    for (std::uint64_t row = first; row < first + rows;) { // a piece ends where chunks end
        const std::uint64_t end = std::min((row / chunk + chunks) * chunk, first + rows);
        const auto piece = read(name, row, end - row);
        if (!piece) return piece.error();
        take(row - first, *piece);
        row = end;
    }
    return {};
}

Result<Array> Hdf5Rows::read(const std::string& name) const {
    const auto whole = shape(name);
    return read(name, 0, whole ? whole->rows : 0);
}

} // namespace isotet::io::confined
