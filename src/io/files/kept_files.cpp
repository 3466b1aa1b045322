// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/kept_files.hpp"

#include <sys/stat.h>

namespace isotet {

std::shared_ptr<KeptFiles> keep_files() { return std::make_shared<KeptFiles>(); }

std::optional<KeptFiles::Identity> KeptFiles::identity_of(const std::string& path) {
    struct stat status{};
    if (::stat(path.c_str(), &status) != 0) return std::nullopt;
    return Identity{static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino),
                    static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_mtim.tv_sec),
                    static_cast<std::uint64_t>(status.st_mtim.tv_nsec)};
}

void KeptFiles::keep(const std::string& path, const Identity& identity, const io::WholeFile& file) {
    const std::lock_guard lock(mutex_);
    kept_ = Kept{path, identity, file};
}

std::optional<io::WholeFile> KeptFiles::take(const std::string& path) {
    const std::lock_guard lock(mutex_);
    if (!kept_ || kept_->path != path || identity_of(path) != kept_->identity) return std::nullopt;
    return std::move(std::exchange(kept_, std::nullopt)->file);
}

namespace io {

Result<WholeFile> look_into_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    const auto identity = options.kept ? KeptFiles::identity_of(path) : std::nullopt;
    auto file = WholeFile::read(path, progress);
    if (file && identity) options.kept->keep(path, *identity, *file);
    return file;
}

Result<WholeFile> take_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    if (options.kept)
        if (auto kept = options.kept->take(path)) return *std::move(kept);
    return WholeFile::read(path, progress);
}

} // namespace io
} // namespace isotet
