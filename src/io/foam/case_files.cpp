// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/case_files.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include <fmt/core.h>
#include <libdeflate.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "io/files/escape.hpp"
#include "io/files/whole_file.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::foam {

namespace {

namespace fs = std::filesystem;

bool is_gzip(std::string_view text) { return text.starts_with("\x1f\x8b"); }

/// The whole of a gzip file: one member, whose length stands in its last four bytes.
Result<CaseText> unpacked(CaseText packed) {
    constexpr std::uint64_t most_to_one = 1032; // what deflate can reach
    std::uint32_t size = 0;
    if (packed.text.size() < 18) return broken(packed.path, "a gzip file that is cut short");
    std::memcpy(&size, packed.text.data() + packed.text.size() - 4, 4);
    if (size / most_to_one > packed.text.size() || size == 0)
        return broken(packed.path,
                      fmt::format("states {} bytes unpacked, which {} packed bytes cannot hold: cut short, "
                                  "or 4 GiB and more unpacked",
                                  size, packed.text.size()));
    if (auto fits = core::require_memory("unpacking " + packed.path, size); !fits) return fits.error();
    auto bytes = std::make_shared<core::Buffer<std::byte>>(size);
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflate(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (!inflate) return Error{ErrorCode::out_of_memory, "no memory left to unpack " + packed.path};
    if (libdeflate_gzip_decompress(inflate.get(), packed.text.data(), packed.text.size(), bytes->data(), size,
                                   nullptr) != LIBDEFLATE_SUCCESS)
        return broken(packed.path, "broken or cut short: it cannot be unpacked (gzip)");
    CaseText out{
        std::move(packed.path), std::move(packed.name), bytes, {reinterpret_cast<const char*>(bytes->data()), size}};
    return out;
}

bool is_below(const fs::path& folder, const fs::path& file) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

} // namespace

std::string DiskCase::path_of(const std::string& name) const { return (fs::path(folder_) / name).string(); }

FolderContent DiskCase::list(const std::string& folder) const {
    FolderContent content;
    std::error_code error;
    for (fs::directory_iterator entry(path_of(folder), error), end; !error && entry != end; entry.increment(error)) {
        std::error_code ignored;
        std::string name = entry->path().filename().string();
        if (entry->is_directory(ignored)) content.folders.push_back(std::move(name));
        else if (entry->is_regular_file(ignored)) {
            if (name.ends_with(".gz")) name.resize(name.size() - 3);
            content.files.push_back(std::move(name));
        }
    }
    std::ranges::sort(content.folders);
    std::ranges::sort(content.files);
    const auto again = std::ranges::unique(content.files);
    content.files.erase(again.begin(), again.end());
    return content;
}

bool DiskCase::has(const std::string& name) const {
    std::error_code ignored;
    for (const char* ending : {"", ".gz"}) {
        const fs::file_status status = fs::status(path_of(name) + ending, ignored);
        if (fs::exists(status) && !fs::is_directory(status)) return true;
    }
    return false;
}

Result<CaseText> DiskCase::open(const std::string& name, std::size_t most) const {
    std::error_code error;
    std::string path = path_of(name);
    if (!fs::exists(path, error) && fs::exists(path + ".gz", error)) path += ".gz";
    const fs::path file = fs::canonical(path, error);
    if (error) return Error{ErrorCode::file, fmt::format("{} is not there, or cannot be read", escaped(path))};
    if (!allow_outside_ && !is_below(fs::canonical(folder_, error), file))
        return Error{ErrorCode::invalid_data,
                     fmt::format("{} is a link to {}: only files below the case's folder are read, unless "
                                 "`allow_outside` is given",
                                 escaped(path), escaped(file.string()))};
    auto whole = WholeFile::read(path, progress_, most);
    if (whole && most != all && is_gzip(whole->text())) whole = WholeFile::read(path, progress_);
    if (!whole) return whole.error();
    if (std::ranges::find(opened_, path) == opened_.end()) opened_.push_back(path);
    auto owner = std::make_shared<const WholeFile>(*whole);
    CaseText out{path, name, owner, owner->text()};
    return is_gzip(out.text) ? unpacked(std::move(out)) : Result<CaseText>(std::move(out));
}

} // namespace isotet::io::foam
