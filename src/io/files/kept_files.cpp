// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/kept_files.hpp"

#include <functional>
#include <memory>

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
    bytes_ = 0;
}

void KeptFiles::forget() {
    const std::lock_guard lock(mutex_);
    kept_.clear();
    bytes_ = 0;
}

bool KeptFiles::reserve(std::size_t bytes) {
    constexpr std::size_t most = std::size_t{64} << 20;
    const std::lock_guard lock(mutex_);
    if (bytes > most || bytes_ + reserved_ > most - bytes) return false;
    reserved_ += bytes;
    return true;
}

void KeptFiles::release(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    reserved_ -= bytes;
}

void KeptFiles::keep(const std::string& path, const Identity& identity, const io::WholeFile& file) {
    const std::lock_guard lock(mutex_);
    if (const auto before = kept_.find(path); before != kept_.end()) bytes_ -= before->second.file.text().size();
    kept_.insert_or_assign(path, Kept{identity, file});
    bytes_ += file.text().size();
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
    if (const auto kept = kept_.find(path); kept != kept_.end()) {
        bytes_ -= kept->second.file.text().size();
        kept_.erase(kept);
    }
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

Result<ByteSource> open_source(const std::string& path, const ReadOptions& options, const Progress& progress,
                               bool (*goes_by)(std::string_view head)) {
    constexpr std::size_t small_bytes = std::size_t{1} << 20, of_head = std::size_t{1} << 13;
    const auto identity = options.kept ? KeptFiles::identity_of(path) : std::nullopt;
    if (identity)
        if (const auto kept = options.kept->get(path); kept && kept->is_whole()) return kept->source();
    auto source = ByteSource::open(path);
    const std::size_t size = source ? source->size() : 0;
    if (!source || !identity || !options.kept->reserve(size)) return source;
    const std::unique_ptr<KeptFiles, std::function<void(KeptFiles*)>> reserved(
        options.kept.get(), [size](KeptFiles* kept) { kept->release(size); });
    if (source->size() > small_bytes) {
        Scratch scratch;
        const auto head = source->view(0, of_head, scratch);
        if (!head) return head.error();
        if (!goes_by(*head)) return source;
    }
    const auto file = WholeFile::read(path, progress);
    if (!file) return file.error();
    options.kept->keep(path, *identity, *file);
    return file->source();
}

Result<WholeFile> take_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    auto kept = options.kept ? options.kept->take(path) : std::nullopt;
    return kept ? WholeFile::read_rest(*std::move(kept), path, progress) : WholeFile::read(path, progress);
}

} // namespace io
} // namespace isotet
