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

void KeptFiles::look_at(const std::string& grid) {
    const std::lock_guard lock(mutex_);
    if (grid == grid_) return;
    grid_ = grid;
    kept_.clear();
}

void KeptFiles::keep(const std::string& path, const Identity& identity, const io::WholeFile& file) {
    const std::lock_guard lock(mutex_);
    kept_.insert_or_assign(path, Kept{identity, file});
}

std::optional<io::WholeFile> KeptFiles::get(const std::string& path) const {
    const std::lock_guard lock(mutex_);
    const auto kept = kept_.find(path);
    if (kept == kept_.end() || identity_of(path) != kept->second.identity) return std::nullopt;
    return kept->second.file;
}

std::optional<io::WholeFile> KeptFiles::take(const std::string& path) {
    auto file = get(path);
    const std::lock_guard lock(mutex_);
    kept_.erase(path);
    return file;
}

namespace io {

Result<WholeFile> look_into_file(const std::string& path, const ReadOptions& options, const Progress& progress,
                                 std::size_t most) {
    const auto identity = options.kept ? KeptFiles::identity_of(path) : std::nullopt;
    if (identity)
        if (auto kept = options.kept->get(path); kept && (kept->is_whole() || kept->text().size() >= most))
            return *std::move(kept);
    auto file = WholeFile::read(path, progress, most);
    if (file && identity) options.kept->keep(path, *identity, *file);
    return file;
}

Result<WholeFile> take_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    auto kept = options.kept ? options.kept->take(path) : std::nullopt;
    return kept ? WholeFile::read_rest(*std::move(kept), path, progress) : WholeFile::read(path, progress);
}

} // namespace io
} // namespace isotet
