// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// OutputFile: the old file or the whole new one, and nothing beside it.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include <isotet/write.hpp>

#include "files/sample_files.hpp"
#include "base/system/output_file.hpp"
#include "base/system/unfinished_files.hpp"

namespace isotet::test {
namespace {

using core::OutputFile;

ErrorCode code_of_opening(const std::string& path) {
    const auto file = OutputFile::open(path);
    EXPECT_FALSE(file) << path;
    return file ? ErrorCode::internal : file.error().code;
}

void write_all(const std::string& path, std::string_view text) {
    auto file = OutputFile::open(path);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_TRUE(file->write(text));
    const auto committed = file->commit();
    ASSERT_TRUE(committed) << committed.error().message;
}

TEST(OutputFile, AppearsWholeUnderItsName) {
    const Folder folder;
    write_all(folder / "out", "hello");
    EXPECT_EQ(content_of(folder / "out"), "hello");
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(OutputFile, HoldsMoreThanOneBufferInOrder) {
    const Folder folder;
    std::string expected;
    auto file = OutputFile::open(folder / "out");
    ASSERT_TRUE(file);
    for (const std::size_t size : {3UL, 1UL << 20U, (1UL << 20U) - 3, 7UL, 3UL << 20U, 1UL}) {
        const std::string piece(size, static_cast<char>('a' + size % 26));
        expected += piece;
        ASSERT_TRUE(file->write(piece));
    }
    EXPECT_EQ(file->bytes(), expected.size());
    ASSERT_TRUE(file->commit());
    EXPECT_TRUE(content_of(folder / "out") == expected);
}

TEST(OutputFile, IsRemovedByRemoveUnfinishedFiles) {
    const Folder folder;
    const int descriptor = ::open((folder / ".").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    ASSERT_GE(descriptor, 0);
    for (const char* name : {"begun", "done", "other"}) put_content(folder / name, "x");
    core::note_unfinished_file(descriptor, "begun");
    core::note_unfinished_file(descriptor, "done");
    core::forget_unfinished_file(descriptor, "done");
    remove_unfinished_files();
    EXPECT_EQ(folder.entries(), 2U);
    EXPECT_EQ(content_of(folder / "done"), "x");
    core::forget_unfinished_file(descriptor, "begun");
    auto file = OutputFile::open(folder / "out"); // with a name before it is whole, or without one
    ASSERT_TRUE(file);
    remove_unfinished_files();
    EXPECT_EQ(folder.entries(), 2U);
    ::close(descriptor);
}

TEST(OutputFile, KeepsTheOldFileUntilCommitted) {
    const Folder folder;
    put_content(folder / "out", "old");
    {
        auto file = OutputFile::open(folder / "out");
        ASSERT_TRUE(file);
        ASSERT_TRUE(file->write("new"));
        EXPECT_EQ(content_of(folder / "out"), "old");
    }
    EXPECT_EQ(content_of(folder / "out"), "old");
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(OutputFile, LeavesNothingWhenItIsDroppedOrMovedFrom) {
    const Folder folder;
    {
        auto first = OutputFile::open(folder / "first");
        auto second = OutputFile::open(folder / "second");
        ASSERT_TRUE(first && second);
        OutputFile moved(std::move(*first));
        moved = std::move(*second);
        ASSERT_TRUE(moved.write("text"));
    }
    EXPECT_EQ(folder.entries(), 0U);
}

TEST(OutputFile, LeavesNothingWhenTheProcessIsKilled) {
    const Folder folder;
    put_content(folder / "out", "old");
    const pid_t child = ::fork();
    if (child == 0) {
        auto file = OutputFile::open(folder / "out");
        if (file && file->write(std::string(3 << 20, 'x'))) ::raise(SIGKILL);
        ::_exit(1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(folder.entries(), 1U);
    EXPECT_EQ(content_of(folder / "out"), "old");
}

TEST(OutputFile, KeepsThePermissionsOfTheOldFile) {
    const Folder folder;
    put_content(folder / "out", "old");
    ASSERT_EQ(::chmod((folder / "out").c_str(), 0640), 0);
    write_all(folder / "out", "new");
    struct stat status{};
    ASSERT_EQ(::stat((folder / "out").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0640U);
    EXPECT_EQ(content_of(folder / "out"), "new");
}

TEST(OutputFile, ReplacesWhatALinkPointsTo) {
    const Folder folder;
    std::filesystem::create_directory(folder / "sub");
    put_content(folder / "sub/target", "old");
    std::filesystem::create_symlink("sub/target", folder / "inner");
    std::filesystem::create_symlink("inner", folder / "link");
    write_all(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_FALSE(std::filesystem::is_symlink(folder / "sub/target"));
    EXPECT_EQ(content_of(folder / "sub/target"), "new");
}

TEST(OutputFile, MakesTheFileThatALinkToNothingPointsTo) {
    const Folder folder;
    std::filesystem::create_symlink("missing", folder / "link");
    write_all(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(content_of(folder / "missing"), "new");
}

TEST(OutputFile, RefusesLinksInACircle) {
    const Folder folder;
    std::filesystem::create_symlink("b", folder / "a");
    std::filesystem::create_symlink("a", folder / "b");
    EXPECT_EQ(code_of_opening(folder / "a"), ErrorCode::file);
}

TEST(OutputFile, RefusesWhatIsNotAPlainFile) {
    const Folder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(code_of_opening(folder.path().string()), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of_opening(folder / "missing/"), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of_opening(folder / "pipe"), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of_opening("/dev/null"), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of_opening(""), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of_opening(std::string("a\0b", 3)), ErrorCode::invalid_argument);
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(OutputFile, NamesTheFolderThatIsMissing) {
    const Folder folder;
    const auto file = OutputFile::open(folder / "nowhere/out");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::file);
    EXPECT_NE(file.error().message.find("nowhere"), std::string::npos) << file.error().message;
}

TEST(OutputFile, CanHaveALongName) {
    const Folder folder;
    write_all(folder / std::string(255, 'n'), "text");
    EXPECT_EQ(code_of_opening(folder / std::string(256, 'n')), ErrorCode::file);
}

/// Runs `body` in a child process, as a user without rights over others' files when the tests run as root; the child's
/// exit status is what `body` returns.
template <class Body>
int in_child(const Folder& folder, const Body& body) {
    constexpr uid_t nobody = 65534;
    const pid_t child = ::fork();
    if (child == 0) {
        if (::geteuid() == 0 && (::chown(folder.path().c_str(), nobody, nobody) != 0 || ::setuid(nobody) != 0))
            ::_exit(100);
        ::_exit(body());
    }
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return 101;
    return WEXITSTATUS(status);
}

TEST(OutputFile, SaysWhenAFolderCannotBeWritten) {
    const Folder folder;
    const int result = in_child(folder, [&] {
        if (::chmod(folder.path().c_str(), 0500) != 0) return 1;
        const auto file = OutputFile::open(folder / "out");
        if (file) return 2;
        if (file.error().code != ErrorCode::cannot_write) return 3;
        return file.error().message.find("Permission denied") == std::string::npos ? 4 : 0;
    });
    EXPECT_EQ(result, 0);
}

TEST(OutputFile, DoesNotReplaceAFileThatIsReadOnly) {
    const Folder folder;
    const int result = in_child(folder, [&] {
        put_content(folder / "out", "old");
        if (::chmod((folder / "out").c_str(), 0400) != 0) return 1;
        return OutputFile::open(folder / "out") ? 2 : 0;
    });
    EXPECT_EQ(result, 0);
    EXPECT_EQ(content_of(folder / "out"), "old");
}

/// A limit on the size of files stands for a full disk: write() fails in the same way, and nobody else notices.
TEST(OutputFile, KeepsTheOldFileWhenTheDiskIsFull) {
    const Folder folder;
    put_content(folder / "out", "old");
    ASSERT_EQ(::chmod((folder / "out").c_str(), 0666), 0);
    const int result = in_child(folder, [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{100000, 100000};
        if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
        auto file = OutputFile::open(folder / "out");
        if (!file) return 2;
        const std::string block(60000, 'x');
        bool all_written = true;
        for (int i = 0; i < 100; ++i) all_written = static_cast<bool>(file->write(block)) && all_written;
        if (all_written) return 3;
        const auto committed = file->commit();
        if (committed) return 4;
        if (committed.error().code != ErrorCode::cannot_write) return 5;
        if (committed.error().message.find(folder / "out") == std::string::npos) return 6;
        return committed.error().message.find("File too large") == std::string::npos ? 7 : 0;
    });
    EXPECT_EQ(result, 0);
    EXPECT_EQ(content_of(folder / "out"), "old");
    EXPECT_EQ(folder.entries(), 1U);
}

TEST(OutputFile, FailsOnCommitWhenTheLastBytesDoNotFit) {
    const Folder folder;
    const int result = in_child(folder, [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{1000, 1000};
        if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
        auto file = OutputFile::open(folder / "out");
        if (!file || !file->write(std::string(2000, 'x'))) return 2; // still in the buffer
        return file->commit() ? 3 : 0;
    });
    EXPECT_EQ(result, 0);
    EXPECT_EQ(folder.entries(), 0U);
}

} // namespace
} // namespace isotet::test
