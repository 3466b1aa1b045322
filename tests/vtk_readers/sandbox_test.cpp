// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the reader process can do no more once it looks at a file. Each try runs in a child of its own.
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <functional>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "io/confined/sandbox.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

class Sandbox : public testing::Test {
protected:
    Sandbox() {
        inside_ = folder_.write("case/inside", "x");
        outside_ = folder_.write("outside", "x");
        std::filesystem::create_symlink("../outside", folder_.file("case/link"));
    }
    /// What `attempt` leaves in errno in a confined process; 0 where it gives true.
    int error_of(const std::function<bool()>& attempt) const {
        const pid_t child = ::fork();
        if (child == 0) {
            const std::string readable[] = {folder_.file("case")};
            io::confined::confine(readable);
            ::_exit(attempt() ? 0 : errno);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    static bool opens(const std::string& path, int flags) { return ::open(path.c_str(), flags, 0600) >= 0; }

    TemporaryFolder folder_;
    std::string inside_, outside_;
};

TEST_F(Sandbox, ReadsBelowTheFolderOnly) {
    ASSERT_TRUE(reader_confinement().files) << "this system has no Landlock";
    EXPECT_EQ(error_of([&] { return opens(inside_, O_RDONLY); }), 0);
    EXPECT_EQ(error_of([&] { return opens(folder_.file("case"), O_RDONLY | O_DIRECTORY); }), 0);
    EXPECT_EQ(error_of([&] { return opens(outside_, O_RDONLY); }), EACCES);
    EXPECT_EQ(error_of([&] { return opens(folder_.file("case/link"), O_RDONLY); }), EACCES) << "a link to the outside";
    EXPECT_EQ(error_of([&] { return opens("/etc/passwd", O_RDONLY); }), EACCES);
}

TEST_F(Sandbox, ChangesNoFile) {
    EXPECT_EQ(error_of([&] { return opens(inside_, O_RDWR); }), EACCES);
    EXPECT_EQ(error_of([&] { return opens(folder_.file("case/new"), O_WRONLY | O_CREAT); }), EACCES);
    EXPECT_NE(error_of([&] { return ::unlink(inside_.c_str()) == 0; }), 0);
    EXPECT_NE(error_of([&] { return ::rename(inside_.c_str(), folder_.file("case/other").c_str()) == 0; }), 0);
    EXPECT_NE(error_of([&] { return ::mkdir(folder_.file("case/made").c_str(), 0700) == 0; }), 0);
    EXPECT_NE(error_of([&] { return ::symlink("a", folder_.file("case/made").c_str()) == 0; }), 0);
    EXPECT_NE(error_of([&] { return ::chmod(inside_.c_str(), 0777) == 0; }), 0);
    EXPECT_NE(error_of([&] { return ::truncate(inside_.c_str(), 0) == 0; }), 0);
    EXPECT_EQ(content_of(inside_), "x");
}

TEST_F(Sandbox, HasNoNetworkAndNoOtherProcesses) {
    EXPECT_EQ(error_of([] { return ::socket(AF_INET, SOCK_STREAM, 0) >= 0; }), EPERM);
    EXPECT_EQ(error_of([] { return ::socket(AF_UNIX, SOCK_STREAM, 0) >= 0; }), EPERM);
    EXPECT_NE(error_of([] { return ::fork() >= 0; }), 0);
    EXPECT_EQ(error_of([] { return ::kill(::getppid(), 0) == 0; }), EPERM);
    EXPECT_EQ(error_of([] {
                  char program[] = "/bin/true";
                  char* const arguments[] = {program, nullptr};
                  return ::execv(program, arguments) == 0;
              }),
              EPERM);
    EXPECT_NE(error_of([] { return ::fcntl(0, F_SETOWN, ::getppid()) == 0; }), 0) << "would signal the parent";
}

TEST_F(Sandbox, RunsNoCodeThatItMade) {
    const auto maps = [](int rights) {
        return ::mmap(nullptr, 4096, rights, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
    };
    EXPECT_EQ(error_of([&] { return maps(PROT_READ | PROT_WRITE); }), 0);
    EXPECT_EQ(error_of([&] { return maps(PROT_READ | PROT_EXEC); }), EACCES);
}

TEST_F(Sandbox, StillHasThreadsMemoryAndItsOwnEnd) {
    EXPECT_EQ(error_of([] {
                  std::vector<double> large(1 << 20, 1.0);
                  bool ran = false;
                  std::thread([&] { ran = large.back() == 1.0; }).join();
                  return ran;
              }),
              0);
    EXPECT_EQ(error_of([]() -> bool { std::abort(); }), -1) << "abort() ends the process by a signal";
}

} // namespace
} // namespace isotet::test
