// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/byte_source.hpp"

#include <cstring>

#include <fmt/core.h>

#include "base/errors.hpp"

namespace isotet::io {

Result<ByteSource> ByteSource::open(const std::string& path) {
    auto file = core::open_plain_file(path);
    if (!file) return file.error();
    const std::size_t size = file->size;
    return ByteSource(std::make_shared<const OpenFile>(OpenFile{std::move(*file), path}), size);
}

Result<void> ByteSource::check(std::size_t at, std::size_t count) const {
    if (at <= size_ && count <= size_ - at) return {};
    return invalid_data(fmt::format("{} bytes from byte {} on are needed, but there are {}", count, at, size_));
}

Result<void> ByteSource::read(std::size_t at, std::span<std::byte> to) const {
    if (auto fits = check(at, to.size()); !fits) return fits;
    if (file_) return read_at(file_->file, file_->path, at, to);
    if (!to.empty()) std::memcpy(to.data(), text_.data() + at, to.size());
    return {};
}

Result<std::string_view> ByteSource::view(std::size_t at, std::size_t count, Scratch& scratch) const {
    if (auto fits = check(at, count); !fits) return fits.error();
    if (!file_) return text_.substr(at, count);
    const auto bytes = scratch.take(count);
    if (auto done = read_at(file_->file, file_->path, at, bytes); !done) return done.error();
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), count);
}

} // namespace isotet::io
