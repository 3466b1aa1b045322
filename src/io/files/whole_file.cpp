// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/whole_file.hpp"

#include <algorithm>
#include <new>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"

namespace isotet::io {

namespace {

constexpr std::size_t piece_bytes = std::size_t{4} << 20;
constexpr std::size_t many_bytes = std::size_t{64} << 20; ///< asking what is free takes longer than reading fewer

} // namespace

Result<void> read_bytes(const core::PlainFile& file, const std::string& path, std::span<std::byte> to,
                        const Progress& progress, std::size_t at) {
    FirstError failed;
    core::parallel_pieces(to.size(), piece_bytes, progress, [&](std::size_t begin, std::size_t end) {
        if (auto read = read_at(file, path, at + begin, to.subspan(begin, end - begin)); !read)
            failed.add(begin, read.error());
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    return failed.result();
}

Result<WholeFile> WholeFile::read(const std::string& path, const Progress& progress, std::size_t most) {
    return read_behind({}, path, progress, most);
}

Result<WholeFile> WholeFile::read_rest(WholeFile begin, const std::string& path, const Progress& progress) {
    if (begin.is_whole()) return begin;
    return read_behind(std::as_bytes(std::span(begin.text())), path, progress, all);
}

Result<WholeFile> WholeFile::read_behind(std::span<const std::byte> begin, const std::string& path,
                                         const Progress& progress, std::size_t most) {
    const auto file = core::open_plain_file(path);
    if (!file) return file.error();
    const std::size_t size = std::min(file->size, most);
    if (begin.size() > size) begin = {}; // it was cut short since
    if (size > many_bytes)
        if (auto fits = core::require_memory("reading " + path, size); !fits) return fits.error();
    try {
        core::Buffer<std::byte> bytes(size);
        std::ranges::copy(begin, bytes.data());
        const std::span<std::byte> rest(bytes.data() + begin.size(), size - begin.size());
        if (auto done = read_bytes(*file, path, rest, progress, begin.size()); !done) return done.error();
        return WholeFile(std::make_shared<const core::Buffer<std::byte>>(std::move(bytes)), size == file->size);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "no memory left to read " + path};
    }
}

} // namespace isotet::io
