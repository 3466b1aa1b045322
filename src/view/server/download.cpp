// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/server/download.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace isotet::view {

namespace {

std::string make_download_folder() {
    std::error_code ignored;
    std::string folder = (std::filesystem::temp_directory_path(ignored) / "isotet-view-XXXXXX").string();
    return ::mkdtemp(folder.data()) ? folder : std::string();
}

} // namespace

Downloads::~Downloads() {
    saver_.reset();
    for (const auto& [page, file] : files_) ::close(file);
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

Result<void> Downloads::start(PageKey page, const SaveRequest& request, const std::string& file,
                              const std::vector<std::string>& reading, std::function<void(Result<Download>)> done) {
    if (folder_.empty()) folder_ = make_download_folder();
    if (folder_.empty())
        return Error{ErrorCode::system, fmt::format("there is no folder for a file to download: {}",
                                                    std::generic_category().message(errno))};
    if (!saver_) saver_ = std::make_unique<Saver>(program_, folder_);
    Result<std::vector<std::string>> words = save_words(request, folder_, file, reading);
    if (!words) return words.error();
    const std::string name = request.name;
    {
        const std::lock_guard lock(mutex_);
        if (!saver_->busy()) writing_for_ = page;
    }
    return saver_->start(*std::move(words), name,
                         [this, page, name, done = std::move(done)](const Result<std::string>& path) {
                             done(path ? take(page, name, *path) : Result<Download>(path.error()));
                         });
}

/// Opens the file and removes its name.
Result<Download> Downloads::take(PageKey page, const std::string& name, const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status{};
    const bool known = file >= 0 && ::fstat(file, &status) == 0;
    const int failed = known ? 0 : errno;
    ::unlink(path.c_str());
    if (!known) {
        if (file >= 0) ::close(file);
        return Error{ErrorCode::file,
                     fmt::format("{} cannot be read again: {}", name, std::generic_category().message(failed))};
    }
    const std::lock_guard lock(mutex_);
    if (writing_for_ != page) {
        ::close(file);
        return Error{ErrorCode::cancelled, "cancelled"};
    }
    if (const auto before = files_.find(page); before != files_.end()) ::close(before->second);
    files_.insert_or_assign(page, file);
    return Download{name, static_cast<std::uint64_t>(status.st_size)};
}

std::string Downloads::next_part(PageKey page) {
    const std::lock_guard lock(mutex_);
    const auto found = files_.find(page);
    if (found == files_.end()) return {};
    std::string part(part_bytes, '\0');
    std::size_t filled = 0;
    while (filled < part.size()) {
        const ssize_t count = ::read(found->second, part.data() + filled, part.size() - filled);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        filled += static_cast<std::size_t>(count);
    }
    part.resize(filled);
    if (filled == part_bytes) return part;
    ::close(found->second);
    files_.erase(found);
    return part;
}

void Downloads::forget(PageKey page) {
    const std::lock_guard lock(mutex_);
    if (saver_ && writing_for_ == page) saver_->stop();
    if (writing_for_ == page) writing_for_ = 0;
    const auto found = files_.find(page);
    if (found == files_.end()) return;
    ::close(found->second);
    files_.erase(found);
}

} // namespace isotet::view
