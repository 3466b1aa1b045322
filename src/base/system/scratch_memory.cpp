// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/scratch_memory.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "base/system/block_place.hpp"
#include "base/system/memory.hpp"

namespace isotet::core {

namespace {

std::string reason(int number) { return std::generic_category().message(number); }

/// A file without a name; -1 with errno where there can be none.
int open_unnamed(const std::string& folder) {
    const int file = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
    if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return file;
    std::string name = folder + "/.isotet-scratch-XXXXXX"; // not all file systems know O_TMPFILE
    const int named = ::mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) ::unlink(name.c_str());
    return named;
}

std::uint64_t room_in(const std::string& folder) {
    struct statvfs there{};
    return statvfs(folder.c_str(), &there) == 0 ? std::uint64_t{there.f_bavail} * there.f_frsize : 0;
}

Error no_room(std::string_view what, std::uint64_t bytes, const std::string& folder) {
    return Error{ErrorCode::cannot_write, fmt::format("{} needs {} in the scratch folder '{}', but {} are free", what,
                                                      format_bytes(bytes), folder, format_bytes(room_in(folder)))};
}

/// Bytes of this process that are in memory: all, and those of files.
struct Resident {
    std::uint64_t all = 0, of_files = 0;

    /// Zeros where the system does not tell.
    static Resident now(int statm) {
        char text[128];
        const ssize_t read = ::pread(statm, text, sizeof text, 0);
        if (read <= 0) return {};
        std::uint64_t numbers[3] = {}; // size, resident, of files
        const char *at = text, *const end = text + read;
        for (std::uint64_t& number : numbers) {
            at = std::from_chars(at, end, number).ptr;
            if (at != end) ++at;
        }
        static const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
        return {page * numbers[1], page * std::min(numbers[1], numbers[2])};
    }
};

/// The files of all blocks that do not lie in memory. They stay mapped until they are given back; what of them is in
/// memory goes, slice by slice in turns, when the process has too much.
class ScratchFiles final : public BlockPlace {
public:
    Result<void> begin(const ScratchOptions& options) {
        const std::lock_guard lock(mutex_);
        if (limit_) return Error{ErrorCode::invalid_argument, "arrays lie in scratch files already"};
        if (options.memory == 0) return Error{ErrorCode::invalid_argument, "`memory` is 0, but must be more"};
        const int file = open_unnamed(options.folder);
        if (file < 0)
            return Error{ErrorCode::cannot_write, fmt::format("no file can be made in the scratch folder '{}': {}",
                                                              options.folder, reason(errno))};
        ::close(file);
        folder_ = options.folder;
        failure_.reset();
        peak_ = bytes_;
        limit_ = options.memory;
        use_block_place(*this);
        return {};
    }
    void end() {
        const std::lock_guard lock(mutex_);
        limit_ = 0;
    }

    Block take(std::size_t bytes, std::size_t in_memory) override {
        const std::uint64_t limit = limit_;
        if (!limit || belongs_in_memory(bytes, in_memory, limit)) return {};
        static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
        std::map<void*, std::size_t> place{{nullptr, 0}}; // before there is anything that could be lost
        const Block block = map_file((bytes + page - 1) / page * page);
        if (!block.data) throw std::bad_alloc();
        auto node = place.extract(place.begin());
        node.key() = block.data;
        node.mapped() = block.bytes;
        const std::lock_guard lock(mutex_);
        blocks_.insert(std::move(node));
        bytes_ += block.bytes;
        peak_ = std::max<std::uint64_t>(peak_, bytes_);
        return block;
    }

    bool give_back(Block block) noexcept override {
        if (bytes_ == 0) return false;
        {
            const std::lock_guard lock(mutex_);
            if (blocks_.erase(block.data) == 0) return false;
            bytes_ -= block.bytes;
        }
        munmap(block.data, block.bytes); // and the file is gone
        return true;
    }

    bool lets_keep() const noexcept override { return limit_ == 0; }

    /// Lets go of pages when the process nears the limit.
    void hold_limit(int statm) {
        const std::uint64_t most = limit_ - limit_ / 4; // the rest is for what is touched until the next look
        const auto excess = [&](std::uint64_t share) {
            const Resident now = Resident::now(statm);
            const std::uint64_t others = now.all - now.of_files;
            return now.of_files > (most > others ? (most - others) / share : 0);
        };
        if (looks_to_skip_ > 0) {
            --looks_to_skip_;
            return;
        }
        if (!excess(1)) return;
        std::size_t slices = 0;
        {
            const std::lock_guard lock(mutex_);
            slices = bytes_ / slice + blocks_.size();
        }
        for (; slices > 0 && excess(2); --slices) drop_slice();
        // What is still there may not be of these files, but the program, or replies of isotet-reader: then each next
        // look comes later, up to a second.
        const bool helped = slices > 0 || !excess(1);
        rest_ = helped ? 0 : std::min(2 * rest_ + 1, 511U);
        looks_to_skip_ = rest_;
    }

    ScratchReport report() {
        const std::lock_guard lock(mutex_);
        return {bytes_, peak_};
    }
    std::optional<Error> failure() {
        const std::lock_guard lock(mutex_);
        return failure_;
    }
    std::optional<Result<void>> require(std::string_view what, std::uint64_t bytes) {
        const std::lock_guard lock(mutex_);
        if (!limit_) return {};
        if (bytes > room_in(folder_)) return no_room(what, bytes, folder_);
        return Result<void>();
    }

private:
    static constexpr std::size_t slice = std::size_t{8} << 20;

    /// The smaller a block, the more often it is asked for, and what is in it used: three eighths of the limit are for
    /// what lies in memory, two of them for blocks that would soon fill it.
    static bool belongs_in_memory(std::size_t bytes, std::size_t in_memory, std::uint64_t limit) {
        if (bytes <= limit / 64) return in_memory + bytes <= 3 * (limit / 8);
        return bytes <= limit / 16 && in_memory + bytes <= limit / 4;
    }

    /// No data when there is no room, which is remembered.
    Block map_file(std::size_t bytes) {
        std::string folder;
        {
            const std::lock_guard lock(mutex_);
            folder = folder_;
        }
        const int file = open_unnamed(folder);
        int number = file < 0 ? errno : 0;
        // All of its room at once: when the disk were found full later, at a page, that would end the process.
        while (!number && (number = posix_fallocate(file, 0, static_cast<off_t>(bytes))) == EINTR) number = 0;
        void* data = MAP_FAILED;
        if (!number) {
            data = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
            if (data == MAP_FAILED) number = errno;
        }
        if (file >= 0) ::close(file);
        if (data != MAP_FAILED) return {data, bytes};
        if (number == ENOMEM) return {}; // that is no fault of the folder
        const std::lock_guard lock(mutex_);
        failure_ = number == ENOSPC || number == EDQUOT || number == EFBIG
                       ? no_room("an array", bytes, folder)
                       : Error{ErrorCode::cannot_write,
                               fmt::format("a file of {} cannot be made in the scratch folder '{}': {}",
                                           format_bytes(bytes), folder, reason(number))};
        return {};
    }

    /// The next slice in turn leaves this process; its bytes stay in the file.
    void drop_slice() {
        const std::lock_guard lock(mutex_);
        if (blocks_.empty()) return;
        auto block = blocks_.upper_bound(next_);
        if (block != blocks_.begin() && next_ < end_of(*std::prev(block))) --block;
        if (block == blocks_.end()) {
            block = blocks_.begin();
            next_ = nullptr;
        }
        std::byte* const begin = std::max(static_cast<std::byte*>(block->first), next_);
        next_ = begin + std::min(slice, static_cast<std::size_t>(end_of(*block) - begin));
        madvise(begin, static_cast<std::size_t>(next_ - begin), MADV_DONTNEED);
    }
    static std::byte* end_of(const std::pair<void* const, std::size_t>& block) {
        return static_cast<std::byte*>(block.first) + block.second;
    }

    std::mutex mutex_;
    std::atomic<std::uint64_t> limit_{0}; ///< 0: arrays lie in memory
    std::string folder_;
    std::map<void*, std::size_t> blocks_; ///< and their bytes
    std::atomic<std::uint64_t> bytes_{0}; ///< of them
    std::uint64_t peak_ = 0;
    std::byte* next_ = nullptr;             ///< where the next slice begins
    unsigned rest_ = 0, looks_to_skip_ = 0; ///< of who watches the limit
    std::optional<Error> failure_;
};

/// Never destroyed, as the blocks.
ScratchFiles& scratch_files() {
    static auto* const files = new ScratchFiles;
    return *files;
}

} // namespace

std::optional<Result<void>> require_scratch(std::string_view what, std::uint64_t bytes) {
    return scratch_files().require(what, bytes);
}

} // namespace isotet::core

namespace isotet {

/// Watches over the limit.
struct ScratchMemory::Data {
    Data() : statm(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC)), watch([this] { hold_limit(); }) {}
    ~Data() {
        done = true;
        watch.join();
        if (statm >= 0) ::close(statm);
        core::scratch_files().end();
    }
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;

    void hold_limit() {
        while (!done) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2)); // in which some megabytes are touched
            core::scratch_files().hold_limit(statm);
        }
    }

    int statm;
    std::atomic<bool> done{false};
    std::thread watch; ///< last: it uses the others
};

ScratchMemory::ScratchMemory(std::unique_ptr<Data> data) : data_(std::move(data)) {}
ScratchMemory::ScratchMemory(ScratchMemory&&) noexcept = default;
ScratchMemory& ScratchMemory::operator=(ScratchMemory&&) noexcept = default;
ScratchMemory::~ScratchMemory() = default;

Result<ScratchMemory> ScratchMemory::begin(const ScratchOptions& options) {
    if (auto begun = core::scratch_files().begin(options); !begun) return begun.error();
    core::drop_kept_blocks();
    try {
        return ScratchMemory(std::make_unique<Data>());
    } catch (const std::exception& e) {
        core::scratch_files().end();
        return Error{ErrorCode::system, fmt::format("the limit of memory cannot be watched: {}", e.what())};
    }
}

ScratchReport ScratchMemory::report() const { return core::scratch_files().report(); }
std::optional<Error> ScratchMemory::failure() const { return core::scratch_files().failure(); }

Result<void> ScratchMemory::require(std::string_view what, std::uint64_t bytes) const {
    return core::require_scratch(what, bytes).value_or(Result<void>());
}

} // namespace isotet
