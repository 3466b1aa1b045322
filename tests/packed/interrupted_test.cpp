// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed files while writing ends early: at every write the old file is whole, or the new one is.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include <isotet/packed_file.hpp>

#include "io/packed/directory.hpp"
#include "packed/packed_samples.hpp"

namespace isotet::test {
namespace {

/// A limit of this process while it lives.
class Limit {
public:
    Limit(int resource, std::uint64_t most) : resource_(resource) {
        ::getrlimit(static_cast<__rlimit_resource_t>(resource_), &before_);
        const rlimit limit{most, before_.rlim_max};
        ::setrlimit(static_cast<__rlimit_resource_t>(resource_), &limit);
    }
    Limit(const Limit&) = delete;
    Limit& operator=(const Limit&) = delete;
    ~Limit() { ::setrlimit(static_cast<__rlimit_resource_t>(resource_), &before_); }

private:
    int resource_;
    rlimit before_{};
};

/// No file can grow beyond so many bytes: as on a full disk, a write ends short, and the next one fails.
class FullDisk {
public:
    explicit FullDisk(std::uint64_t bytes) : limit_((std::signal(SIGXFSZ, SIG_IGN), RLIMIT_FSIZE), bytes) {}

private:
    Limit limit_;
};

/// Calls work() in a process of its own, which is killed by kill -9 so long after its start, or where a file would grow beyond
/// so many bytes. Returns whether it was.
template <class Work>
bool is_killed(std::optional<std::chrono::microseconds> after, std::optional<std::uint64_t> bytes, const Work& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::alarm(60); // a lock that another thread held at fork() never opens here
        std::optional<Limit> limit;
        if (bytes) {
            limit.emplace(RLIMIT_FSIZE, *bytes);
            std::signal(SIGXFSZ, [](int) { ::kill(::getpid(), SIGKILL); });
        }
        work();
        ::_exit(0);
    }
    if (after) {
        std::this_thread::sleep_for(*after);
        ::kill(child, SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

/// How long a process takes at least that calls work().
template <class Work>
std::chrono::microseconds time_of_process(const Work& work) {
    auto least = std::chrono::microseconds::max();
    for (int i = 0; i < 5; ++i) {
        const auto start = std::chrono::steady_clock::now();
        is_killed({}, {}, work);
        const auto time = std::chrono::steady_clock::now() - start;
        least = std::min(least, std::chrono::duration_cast<std::chrono::microseconds>(time));
    }
    return least;
}

constexpr int kills = 200;          ///< of each kind
const Run one_thread{.threads = 1}; ///< a process has no others behind fork()

/// A file of one step, and the same with two.
struct TwoFiles {
    TemporaryFolder folder;
    PackedGrid packed;
    std::string path, one, two;

    TwoFiles() {
        const Grid grid = made_grid("mixed", 3, {"gyroid"});
        packed = pack(grid, point_field(grid)).value();
        path = saved(packed, folder, 500);
        one = content_of(path);
        append().value();
        two = content_of(path);
    }
    Result<std::uint64_t> append() const {
        Result<PackedWriter> writer = PackedWriter::append(packed, path, 1.0, one_thread);
        return writer ? writer->commit() : writer.error();
    }
    std::size_t sound_steps() const {
        const Result<PackedFile> file = PackedFile::open(path);
        return file && file->check(one_thread) ? file->info().steps : 0;
    }
};

TEST(InterruptedPacking, LeavesTheOldStepsAtEveryWrite) {
    const TwoFiles files;
    for (std::uint64_t bytes = files.one.size(); bytes < files.two.size(); bytes += files.one.size() / 41) {
        files.folder.write("grid.isotet", files.one);
        {
            const FullDisk disk(bytes);
            const auto failed = files.append();
            ASSERT_FALSE(failed) << bytes;
            EXPECT_EQ(failed.error().code, ErrorCode::cannot_write);
        }
        EXPECT_EQ(std::filesystem::file_size(files.path), bytes) << "what was written is there, and does not count";
        EXPECT_EQ(files.sound_steps(), 1u) << bytes;
        EXPECT_TRUE(files.append());
        EXPECT_TRUE(content_of(files.path) == files.two) << bytes;
    }
}

TEST(InterruptedPacking, AddsNothingToAFileThatTookThePlace) {
    const TwoFiles files;
    files.folder.write("grid.isotet", files.one);
    PackedWriter writer = PackedWriter::append(files.packed, files.path, 1.0, one_thread).value();
    files.folder.write("other.isotet", files.one);
    std::filesystem::rename(files.folder.file("other.isotet"), files.path);
    const auto committed = writer.commit();
    ASSERT_FALSE(committed);
    EXPECT_EQ(committed.error().code, ErrorCode::cannot_write);
    EXPECT_EQ(committed.error().message, files.path + " was replaced or removed meanwhile: nothing was added to it");
    EXPECT_TRUE(content_of(files.path) == files.one);
}

/// What is there after a kill while steps are added: `killed` ends the process that adds them. Returns how often it did.
template <class Killed>
int expect_steps_survive(const TwoFiles& files, const Killed& killed) {
    int all_killed = 0;
    for (int i = 0; i < kills; ++i) {
        files.folder.write("grid.isotet", files.one);
        all_killed += killed(i);
        const std::size_t steps = files.sound_steps();
        EXPECT_TRUE(steps == 1 || steps == 2) << "kill " << i;
        EXPECT_TRUE(steps == 1 || content_of(files.path) == files.two) << "kill " << i;
        if (i % 10 != 0 || steps == 2) continue;
        EXPECT_TRUE(files.append()) << "kill " << i;
        EXPECT_TRUE(content_of(files.path) == files.two) << "kill " << i;
    }
    return all_killed;
}

TEST(KilledPacking, LeavesTheOldStepsOrAllWheneverItIsKilled) {
    const TwoFiles files;
    const auto append = [&] { [[maybe_unused]] const auto done = files.append(); };
    const auto time = time_of_process([&] {
        files.folder.write("grid.isotet", files.one);
        append();
    });
    expect_steps_survive(files, [&](int i) { return is_killed(time * i / kills, {}, append); });
}

TEST(KilledPacking, LeavesTheOldStepsWhereverTheLastWriteEnds) {
    const TwoFiles files;
    const int killed = expect_steps_survive(files, [&](int i) {
        const std::uint64_t more = (files.two.size() - files.one.size()) * static_cast<std::uint64_t>(i) / kills;
        return is_killed({}, files.one.size() + more, [&] { [[maybe_unused]] const auto done = files.append(); });
    });
    EXPECT_GT(killed, kills / 2);
}

/// `killed` ends the process that writes a new file in place of an old one. Returns how often it did.
template <class Killed>
int expect_file_survives(const TwoFiles& files, const Killed& killed) {
    int all_killed = 0;
    for (int i = 0; i < kills; ++i) {
        files.folder.write("grid.isotet", "old");
        all_killed += killed(i);
        const std::string content = content_of(files.path);
        EXPECT_TRUE(content == "old" || content == files.one) << "kill " << i;
        for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(files.path).parent_path()))
            EXPECT_TRUE(entry.path() == files.path || entry.path().extension() == ".part") << entry.path();
    }
    return all_killed;
}

TEST(KilledPacking, LeavesTheOldFileOrTheNewOne) {
    const TwoFiles files;
    SavePackedOptions options;
    options.chunk_bytes = 500;
    const auto save = [&] {
        [[maybe_unused]] const auto done = save_packed(files.packed, files.path, options, one_thread);
    };
    const auto time = time_of_process(save);
    expect_file_survives(files, [&](int i) { return is_killed(time * i / kills, {}, save); });
    const int killed = expect_file_survives(
        files, [&](int i) { return is_killed({}, files.one.size() * static_cast<std::uint64_t>(i) / kills, save); });
    EXPECT_GT(killed, kills / 2);
}

TEST(InterruptedPacking, HasOldOrNewStepsWhateverPartOfTheSlotIsWritten) {
    const TwoFiles files;
    std::size_t steps = 0;
    for (std::size_t bytes = 0; bytes <= io::packed_slot_bytes; ++bytes) {
        std::string content = files.two;
        std::memcpy(content.data(), files.one.data(), io::packed_header_bytes);
        std::memcpy(content.data() + io::packed_slots[1], files.two.data() + io::packed_slots[1], bytes);
        files.folder.write("grid.isotet", content);
        steps = files.sound_steps();
        EXPECT_TRUE(steps == 1 || steps == 2) << bytes;
    }
    EXPECT_EQ(steps, 2u);
}

TEST(InterruptedPacking, OfANewFileLeavesTheOldOneAndNothingElse) {
    const TwoFiles files;
    for (std::uint64_t bytes = 0; bytes < files.one.size(); bytes += files.one.size() / 13) {
        files.folder.write("grid.isotet", "old");
        {
            const FullDisk disk(bytes);
            const auto failed = save_packed(files.packed, files.path);
            ASSERT_FALSE(failed) << bytes;
            EXPECT_EQ(failed.error().code, ErrorCode::cannot_write);
        }
        EXPECT_EQ(content_of(files.path), "old");
        std::size_t entries = 0;
        for ([[maybe_unused]] const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(files.path).parent_path()))
            ++entries;
        EXPECT_EQ(entries, 1u);
    }
}

TEST(InterruptedPacking, WithoutDescriptorsIsAnErrorAndGoesOnLater) {
    const TwoFiles files;
    const PackedFile open = PackedFile::open(files.path).value();
    {
        const Limit descriptors(RLIMIT_NOFILE, 0);
        const auto failed = PackedFile::open(files.path);
        ASSERT_FALSE(failed);
        EXPECT_EQ(failed.error().code, ErrorCode::system);
        EXPECT_FALSE(save_packed(files.packed, files.folder.file("other.isotet")));
        EXPECT_FALSE(files.append());
        EXPECT_TRUE(extract(open.grid().value(), 0.1)) << "what is open needs no more";
    }
    EXPECT_TRUE(PackedFile::open(files.path));
    EXPECT_TRUE(files.append());
}

} // namespace
} // namespace isotet::test
