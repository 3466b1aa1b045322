// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_rows.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "io/confined/hdf5/hdf5_file.hpp"
#include "io/confined/hdf5/hdf5_filters.hpp"
#include "io/confined/hdf5/hdf5_stored_rows.hpp"
#include "io/confined/hdf5/hdf5_unwritten.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/narrow_indices.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t plain_bytes = std::size_t{4} << 20;       ///< read at once of rows that are all kept
constexpr std::size_t block_bytes = std::size_t{1} << 18;       ///< and of those that go by
constexpr std::uint64_t library_rows = std::uint64_t{1} << 20;  ///< that HDF5 reads at once of those that go by
constexpr std::uint64_t window_chunks = std::uint64_t{1} << 16; ///< of which the places are known at once
constexpr std::uint64_t most_values = std::uint64_t{1} << 50;
constexpr std::uint64_t many_bytes = std::uint64_t{64} << 20; ///< asking what is free takes longer than reading fewer

/// An open data set with its shape.
struct DataSet {
    Handle data, creation, space, stored;
    int rank = 0;
    RowsShape shape;
    std::uint64_t window_rows = 1;
    bool is_here = false; ///< not in another file, and places in the file are as HDF5 gives them

    struct Close {
        void operator()(DataSet* set) const {
            const std::scoped_lock lock(hdf5_calls());
            delete set;
        }
    };
};
using OpenDataSet = std::unique_ptr<DataSet, DataSet::Close>;

Array as_int32(const Array& values) {
    std::vector<std::int32_t> wide(values.size());
    values.visit([&](auto from) {
        std::ranges::transform(from, wide.begin(), [](auto x) { return static_cast<std::int32_t>(x); });
    });
    return Array::own(std::move(wide), values.components());
}

/// By HDF5, into the type that memory has.
HdfRead read_by_library(const DataSet& set, hid_t type, const RowRange& range, std::byte* to) {
    const std::scoped_lock lock(hdf5_calls());
    const std::array<hsize_t, 2> start{range.first, 0}, count{range.rows, range.columns};
    if (set.rank == 0) return read_written(set.data, type, set.space, set.space, {to, range.row_bytes()});
    if (H5Sselect_hyperslab(set.space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
        return HdfRead::failed;
    const Handle memory(H5Screate_simple(set.rank, count.data(), nullptr), H5Sclose);
    return read_written(set.data, type, memory, set.space, {to, range.rows * range.row_bytes()});
}

/// Links may lead to another file.
std::string name_of_file(hid_t object) {
    const ssize_t length = H5Fget_name(object, nullptr, 0);
    std::string name(length < 0 ? 0 : static_cast<std::size_t>(length) + 1, '\0');
    if (length > 0) H5Fget_name(object, name.data(), name.size());
    return name;
}

/// Of how many rows, from a multiple of them on, the places are known at once.
std::uint64_t window_rows_of(hid_t creation, int rank, std::uint64_t rows) {
    std::array<hsize_t, 2> lengths{1, 1};
    const bool chunked = H5Pget_layout(creation) == H5D_CHUNKED && H5Pget_chunk(creation, rank, lengths.data()) == rank;
    return std::max<std::uint64_t>(chunked ? lengths[0] * window_chunks : rows, 1);
}

/// Calls work() for one window after another.
template <class Work>
Result<void> each_window(const DataSet& set, std::uint64_t first, std::uint64_t rows, const Work& work) {
    RowRange range{first, 0, set.shape.columns, size_of(set.shape.type)};
    for (const std::uint64_t end = first + rows; range.first < end; range.first += range.rows) {
        range.rows = std::min((range.first / set.window_rows + 1) * set.window_rows, end) - range.first;
        if (auto done = work(range); !done) return done;
    }
    return {};
}

} // namespace

struct Hdf5Rows::File {
    std::string path;
    std::shared_ptr<const Hdf5File> opened;
    hid_t file;
    bool starts_at_zero; ///< else places are relative to what stands before

    OpenDataSet open(const std::string& name) const;
    Result<OpenDataSet> open(const std::string& name, std::uint64_t first, std::uint64_t rows) const;
    std::optional<StoredRows> find(const DataSet& set, const RowRange& range) const;
    Error wrong(const std::string& name, std::string_view what) const {
        return broken(path, fmt::format("data set \"{}\" {}", escaped(name), what));
    }
    Result<void> by_library(const std::string& name, const DataSet& set, const RowRange& range, std::byte* to) const;
};

OpenDataSet Hdf5Rows::File::open(const std::string& name) const {
    const std::scoped_lock lock(hdf5_calls());
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
    set->rank = set->space.good() ? H5Sget_simple_extent_ndims(set->space) : -1;
    if (!type || set->rank < 0 || set->rank > 2 || !set->creation.good()) return nullptr;
    if (H5Sget_simple_extent_type(set->space) == H5S_NULL) return nullptr;
    std::array<hsize_t, 2> extent{set->rank == 0 ? 1U : 0U, 1};
    H5Sget_simple_extent_dims(set->space, extent.data(), nullptr);
    if (extent[1] == 0 || extent[1] > 1'000'000) return nullptr;
    set->shape = {extent[0], static_cast<std::size_t>(extent[1]), *type, set->rank == 0};
    set->window_rows = window_rows_of(set->creation, set->rank, extent[0]);
    set->is_here = set->rank > 0 && starts_at_zero && name_of_file(data) == name_of_file(file);
    return OpenDataSet(set.release());
}

/// That has these rows.
Result<OpenDataSet> Hdf5Rows::File::open(const std::string& name, std::uint64_t first, std::uint64_t rows) const {
    auto set = open(name);
    if (!set) return wrong(name, "is not there, or does not hold rows of numbers");
    const RowsShape& shape = set->shape;
    if (first > shape.rows || rows > shape.rows - first)
        return wrong(name, fmt::format("has {} rows, but {} from row {} on are needed", shape.rows, rows, first));
    if (rows > most_values / shape.columns / size_of(shape.type)) return wrong(name, "is too large");
    return set;
}

/// Nothing where HDF5 has to read them.
std::optional<StoredRows> Hdf5Rows::File::find(const DataSet& set, const RowRange& range) const {
    const std::scoped_lock lock(hdf5_calls());
    const bool as_here = Array(set.shape.type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) {
        return H5Tequal(set.stored, native_type<T>()) > 0;
    });
    if (!set.is_here || !as_here) return std::nullopt;
    return StoredRows::find(set.data, set.creation, set.rank, opened->source, range);
}

Result<void> Hdf5Rows::File::by_library(const std::string& name, const DataSet& set, const RowRange& range,
                                        std::byte* to) const {
    const HdfRead read = Array(set.shape.type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) {
        return read_by_library(set, native_type<T>(), range, to);
    });
    if (read == HdfRead::failed) {
        const std::scoped_lock lock(hdf5_calls());
        return wrong(name, why_not_read(set.data));
    }
    if (read == HdfRead::unwritten) return wrong(name, "has values that were never written");
    return {};
}

Hdf5Rows::Hdf5Rows(std::shared_ptr<const File> file) : file_(std::move(file)) {}

Result<Hdf5Rows> Hdf5Rows::open(const std::string& path) {
    const auto opened = open_hdf5(path);
    if (!opened) return opened.error();
    const std::scoped_lock lock(hdf5_calls());
    const hid_t file = (*opened)->file;
    const Handle creation(H5Fget_create_plist(file), H5Pclose);
    hsize_t before = 1;
    const bool starts_at_zero = creation.good() && H5Pget_userblock(creation, &before) >= 0 && before == 0;
    return Hdf5Rows(std::make_shared<const File>(File{path, *opened, file, starts_at_zero}));
}

std::optional<RowsShape> Hdf5Rows::shape(const std::string& name) const {
    const auto set = file_->open(name);
    return set ? std::optional(set->shape) : std::nullopt;
}

Result<void> Hdf5Rows::check(const std::string& name, std::uint64_t first, std::uint64_t rows) const {
    const auto set = file_->open(name, first, rows);
    return set ? Result<void>() : set.error();
}

Result<Array> Hdf5Rows::read(const std::string& name, std::uint64_t first, std::uint64_t rows) const {
    const auto set = file_->open(name, first, rows);
    if (!set) return set.error();
    const RowsShape& shape = (*set)->shape;
    const std::uint64_t bytes = rows * shape.columns * size_of(shape.type);
    if (bytes > many_bytes)
        if (auto fits = core::require_memory("an array", bytes); !fits) return fits.error();
    return Array(shape.type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> Result<Array> {
        core::Buffer<T> values(rows * shape.columns);
        const auto place = [&](std::uint64_t row) {
            return reinterpret_cast<std::byte*>(values.data() + (row - first) * shape.columns);
        };
        const auto done = each_window(**set, first, rows, [&](const RowRange& window) -> Result<void> {
            const auto stored = file_->find(**set, window);
            if (!stored) return file_->by_library(name, **set, window, place(window.first));
            auto read = stored->each_stretch(plain_bytes, [&](std::uint64_t begin, std::uint64_t end) {
                return stored->read(begin, end, place(begin));
            });
            return read ? read : file_->wrong(name, read.error().message);
        });
        if (!done) return done.error();
        return std::move(values).to_array(shape.columns);
    });
}

Result<Array> Hdf5Rows::read_indices(const std::string& name, std::uint64_t first, std::uint64_t rows) const {
    const auto found = shape(name);
    if (found && !is_floating(found->type) && size_of(found->type) < sizeof(std::int32_t)) {
        const auto values = read(name, first, rows);
        return values ? as_int32(*values) : values;
    }
    if (!found || !NarrowIndices::narrows(found->type) || first > found->rows || rows > found->rows - first ||
        rows > most_values / found->columns)
        return read(name, first, rows);
    NarrowIndices narrow(rows * found->columns);
    const auto done = each_block(name, first, rows, [&](std::uint64_t place, const Array& block) {
        block.visit([&]<class T>(std::span<const T> values) {
            if constexpr (std::is_integral_v<T>) narrow.add(place, values);
        });
    });
    if (!done) return done.error();
    auto array = std::move(narrow).to_array(found->columns);
    return array ? *std::move(array) : read(name, first, rows);
}

Result<void> Hdf5Rows::each_block(const std::string& name, std::uint64_t first, std::uint64_t rows,
                                  const Visit& visit) const {
    const auto set = file_->open(name, first, rows);
    if (!set) return set.error();
    const RowsShape& shape = (*set)->shape;
    const auto block = [&](std::uint64_t begin, std::uint64_t end, const auto& fill) -> Result<void> {
        thread_local Scratch scratch;
        const auto bytes = scratch.take((end - begin) * shape.columns * size_of(shape.type));
        if (auto filled = fill(bytes.data()); !filled) return filled;
        visit((begin - first) * shape.columns,
              Array(shape.type, bytes.data(), (end - begin) * shape.columns, 1, nullptr));
        scratch.trim();
        return {};
    };
    return each_window(**set, first, rows, [&](const RowRange& window) -> Result<void> {
        if (const auto stored = file_->find(**set, window)) {
            auto done = stored->each_stretch(block_bytes, [&](std::uint64_t begin, std::uint64_t end) {
                return block(begin, end, [&](std::byte* to) { return stored->read(begin, end, to); });
            });
            return done ? done : file_->wrong(name, done.error().message);
        }
        RowRange part = window;
        for (; part.first < window.end(); part.first += part.rows) {
            part.rows = std::min(library_rows, window.end() - part.first);
            auto done =
                block(part.first, part.end(), [&](std::byte* to) { return file_->by_library(name, **set, part, to); });
            if (!done) return done;
        }
        return {};
    });
}

Result<Array> Hdf5Rows::read_some(const std::string& name, std::uint64_t first, std::uint64_t rows,
                                  const std::vector<std::uint64_t>& numbers) const {
    const auto set = file_->open(name, first, rows);
    if (!set) return set.error();
    const RowsShape& shape = (*set)->shape;
    const std::size_t row_bytes = shape.columns * size_of(shape.type);
    return Array(shape.type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> Result<Array> {
        core::Buffer<T> values(numbers.size() * shape.columns);
        auto* const to = reinterpret_cast<std::byte*>(values.data());
        // Of rows [begin, end) of the data set; `fill` reads some of these.
        const auto take = [&](std::uint64_t begin, std::uint64_t end, const auto& fill) -> Result<void> {
            const auto number = std::ranges::lower_bound(numbers, begin - first);
            const auto behind = std::lower_bound(number, numbers.end(), end - first);
            if (number == behind) return {};
            thread_local Scratch scratch;
            const std::uint64_t least = first + *number, most = first + *std::prev(behind);
            const auto bytes = scratch.take((most + 1 - least) * row_bytes);
            if (auto filled = fill(least, most + 1, bytes.data()); !filled) return filled;
            for (auto at = number; at != behind; ++at)
                std::memcpy(to + static_cast<std::size_t>(at - numbers.begin()) * row_bytes,
                            bytes.data() + (first + *at - least) * row_bytes, row_bytes);
            scratch.trim();
            return {};
        };
        const auto done = each_window(**set, first, rows, [&](const RowRange& window) -> Result<void> {
            const auto has_some = std::ranges::lower_bound(numbers, window.first - first);
            if (has_some == numbers.end() || *has_some >= window.end() - first) return {};
            if (const auto stored = file_->find(**set, window)) {
                auto read = stored->each_stretch(block_bytes, [&](std::uint64_t begin, std::uint64_t end) {
                    return take(begin, end, [&](std::uint64_t least, std::uint64_t most, std::byte* some) {
                        return stored->read(least, most, some);
                    });
                });
                return read ? read : file_->wrong(name, read.error().message);
            }
            for (std::uint64_t begin = window.first; begin < window.end(); begin += library_rows) {
                auto read = take(begin, std::min(begin + library_rows, window.end()),
                                 [&](std::uint64_t least, std::uint64_t most, std::byte* some) {
                                     RowRange part = window;
                                     part.first = least;
                                     part.rows = most - least;
                                     return file_->by_library(name, **set, part, some);
                                 });
                if (!read) return read;
            }
            return {};
        });
        if (!done) return done.error();
        return std::move(values).to_array(shape.columns);
    });
}

Result<Array> Hdf5Rows::read(const std::string& name) const {
    const auto whole = shape(name);
    return read(name, 0, whole ? whole->rows : 0);
}

} // namespace isotet::io::confined
