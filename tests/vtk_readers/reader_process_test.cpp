// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What happens to the reader process must never happen to its parent.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

class ReaderProcess : public testing::Test {
protected:
    /// Two tetrahedra, in a format that the reader program reads.
    ReaderProcess() { folder_.write("sample.xdmf", xdmf(5, "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1", "0 1 2 3 1 2 3 4")); }

    static std::string xdmf(int points, std::string_view coordinates, std::string_view corners) {
        const auto tets = std::ranges::count(corners, ' ') / 4 + 1;
        return fmt::format(R"(<Xdmf Version="3.0"><Domain><Grid Name="tets">
<Topology TopologyType="Tetrahedron" NumberOfElements="{0}"><DataItem Dimensions="{0} 4" NumberType="Int">{1}</DataItem>
</Topology><Geometry GeometryType="XYZ"><DataItem Dimensions="{2} 3">{3}</DataItem></Geometry>
</Grid></Domain></Xdmf>)",
                           tets, corners, points, coordinates);
    }
    /// Points in a row, and one tetrahedron.
    static std::string many_points(int points) {
        std::string coordinates;
        for (int i = 1; i <= points; ++i) coordinates += "0 0 " + std::to_string(i) + "\n";
        return xdmf(points, coordinates, "0 1 2 3");
    }

    /// Reads the sample through a script in place of the reader program.
    Error error_with(std::string_view commands, const Progress& progress = {}) {
        ReadOptions options;
        options.reader_program = folder_.write_script("reader", commands);
        options.time_limit = time_limit_;
        const auto result = read(folder_.file("sample.xdmf"), options, {.progress = progress});
        return result ? Error{ErrorCode::internal, "no error"} : result.error();
    }
    static void expect_words(const Error& error, std::initializer_list<std::string_view> words) {
        for (const std::string_view word : words)
            EXPECT_NE(error.message.find(word), std::string::npos) << error.message;
    }
    static void expect_two_cells(const Result<ReadResult>& result) {
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 2U);
    }
    TemporaryFolder folder_;
    std::chrono::seconds time_limit_{60};
};

TEST_F(ReaderProcess, KilledBySignalIsAnErrorThatNamesReaderAndSignal) {
    const Error error = error_with("echo 'last words' >&2; kill -SEGV $$");
    EXPECT_EQ(error.code, ErrorCode::invalid_data);
    expect_words(error, {"sample.xdmf", "reader of xdmf", "signal 11", "Segmentation fault", "last words"});
}

TEST_F(ReaderProcess, EndingByItselfIsAnErrorThatNamesTheStatus) {
    const Error error = error_with("echo 'bad zone'; exit 255");
    EXPECT_EQ(error.code, ErrorCode::invalid_data);
    expect_words(error, {"reader of xdmf", "status 255", "bad zone"});
}

TEST_F(ReaderProcess, EndingWithoutAReplyIsAnError) { EXPECT_EQ(error_with("exit 0").code, ErrorCode::internal); }

TEST_F(ReaderProcess, SayingThatItRepliedWithoutAReplyIsAnError) {
    EXPECT_EQ(error_with("printf '\\376' >&3; sleep 1000").code, ErrorCode::internal);
}

TEST_F(ReaderProcess, KilledForAnotherReasonThanTheFileSaysSo) {
    const Error memory = error_with("kill -KILL $$");
    EXPECT_EQ(memory.code, ErrorCode::out_of_memory);
    expect_words(memory, {"signal 9", "memory"});
    const Error time = error_with("kill -XCPU $$");
    EXPECT_EQ(time.code, ErrorCode::system);
    expect_words(time, {"ulimit -t"});
    EXPECT_EQ(error_with("kill -TERM $$").code, ErrorCode::system);
}

/// A reader that notes each start.
class ReaderSeries : public ReaderProcess {
protected:
    ReaderSeries() { options_.reader_program = counting("exec " + reader_path()); }
    std::string counting(const std::string& commands) const {
        return folder_.write_script("counting", "echo $$ >>" + folder_.file("starts") + "\n" + commands);
    }
    std::vector<int> starts() const {
        std::istringstream lines(content_of(folder_.file("starts")));
        return {std::istream_iterator<int>(lines), {}};
    }
    std::string sample() const { return folder_.file("sample.xdmf"); }
    ReadOptions options_;
};

TEST_F(ReaderSeries, IsAnsweredByOneProcess) {
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(inspect(sample(), options_));
        expect_two_cells(read(sample(), options_));
    }
    EXPECT_EQ(starts().size(), 1U);
}

TEST_F(ReaderSeries, OfAnotherFolderTakesAnotherProcess) {
    folder_.write("other/sample.xdmf", content_of(sample()));
    expect_two_cells(read(sample(), options_));
    expect_two_cells(read(folder_.file("other/sample.xdmf"), options_));
    expect_two_cells(read(sample(), options_));
    EXPECT_EQ(starts().size(), 2U);
}

TEST_F(ReaderSeries, GoesOnWithANewProcessAfterABrokenFile) {
    expect_two_cells(read(sample(), options_));
    EXPECT_FALSE(read(folder_.write("broken.xdmf", content_of(sample()).substr(0, 40)), options_));
    expect_two_cells(read(sample(), options_));
    EXPECT_EQ(starts().size(), 2U);
}

TEST_F(ReaderSeries, GoesOnWithANewProcessWhereTheOldOneIsGone) {
    expect_two_cells(read(sample(), options_));
    ASSERT_EQ(starts().size(), 1U);
    ::kill(starts()[0], SIGKILL);
    expect_two_cells(read(sample(), options_));
    EXPECT_EQ(starts().size(), 2U);
}

TEST_F(ReaderSeries, GoesOnInAProcessThatIsForkedOff) {
    expect_two_cells(read(sample(), options_));
    const pid_t child = ::fork();
    if (child == 0) {
        const auto result = read(sample(), options_);
        ::_exit(result && result->grid.cells.count() == 2 ? 0 : 1);
    }
    int status = 1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    expect_two_cells(read(sample(), options_));
    EXPECT_EQ(starts().size(), 2U);
}

TEST_F(ReaderSeries, EndsWithItsParent) {
    const pid_t parent = ::fork();
    if (parent == 0) ::_exit(read(sample(), options_) ? 0 : 1);
    int status = 1;
    ::waitpid(parent, &status, 0);
    ASSERT_EQ(status, 0);
    ASSERT_EQ(starts().size(), 1U);
    const auto runs = [&] { // a process that has ended may wait for its new parent as a zombie
        std::ifstream file("/proc/" + std::to_string(starts()[0]) + "/stat");
        std::string number, name, state;
        return file >> number >> name >> state && state != "Z" && state != "X";
    };
    for (int i = 0; i < 1000 && runs(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(runs());
}

TEST_F(ReaderProcess, AGridLargerThanTheLimitOnFilesIsNotTheFilesFault) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    folder_.write("large.xdmf", many_points(20000));
    ASSERT_EXIT(
        {
            rlimit limit{};
            limit.rlim_cur = limit.rlim_max = 100000;
            ::setrlimit(RLIMIT_FSIZE, &limit);
            const auto result = read(folder_.file("large.xdmf"));
            const bool said = !result && result.error().code == ErrorCode::system &&
                              result.error().message.find("ulimit -f") != std::string::npos;
            ::_exit(said ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(ReaderProcess, OutputWithControlCharactersIsEscaped) {
    const Error error = error_with("printf 'red \\033[31m\\007\\377'; exit 3");
    expect_words(error, {"red \\x1b[31m\\x07\\xff"});
}

TEST_F(ReaderProcess, OutputWithoutEndIsCutToItsLastLines) {
    const Error error = error_with("yes 0123456789 | head -c 3000000; echo the end; exit 3");
    EXPECT_LT(error.message.size(), 6000u);
    expect_words(error, {"the end"});
}

TEST_F(ReaderProcess, IsStoppedAtItsTimeLimit) {
    time_limit_ = std::chrono::seconds(1);
    const Error error = error_with("sleep 1000");
    EXPECT_EQ(error.code, ErrorCode::system);
    expect_words(error, {"1 s", "time limit"});
}

TEST_F(ReaderProcess, IsStoppedOnCancel) {
    std::atomic<bool> cancel = false;
    Progress progress;
    progress.cancel = &cancel;
    std::thread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        cancel = true;
    });
    EXPECT_EQ(error_with("sleep 1000", progress).code, ErrorCode::cancelled);
    user.join();
}

TEST_F(ReaderProcess, FindsNoOtherOpenFiles) {
    const int inherited = ::open(folder_.write("private", "x").c_str(), O_RDONLY); // without O_CLOEXEC
    ASSERT_GE(inherited, 0);
    const Error error = error_with("ls -l /proc/$$/fd; exit 3");
    ::close(inherited);
    expect_words(error, {"/dev/null", "socket"});
    EXPECT_EQ(error.message.find("private"), std::string::npos) << error.message;
}

TEST_F(ReaderProcess, HittingItsMemoryLimitIsAnErrorThatNamesTheLimit) {
    const std::string content = many_points(200000);
    ReadOptions options;
    options.memory_limit = content.size() + 1000000; // to look at the file, not for its arrays
    const auto result = read(folder_.write("large.xdmf", content), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::out_of_memory);
    expect_words(result.error(), {std::to_string(options.memory_limit) + " bytes"});
}

TEST_F(ReaderProcess, ThatCannotBeStartedIsAnErrorThatNamesTheProgram) {
    ReadOptions options;
    options.reader_program = folder_.file("not-there");
    const auto result = read(folder_.file("sample.xdmf"), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::system);
    expect_words(result.error(), {"not-there", "No such file"});
}

TEST_F(ReaderProcess, WorksForAParentThatIgnoresItsChildren) {
    std::signal(SIGCHLD, SIG_IGN);
    expect_two_cells(read(folder_.file("sample.xdmf")));
    std::signal(SIGCHLD, SIG_DFL);
}

extern "C" void wait_for_all_children(int) {
    while (::waitpid(-1, nullptr, WNOHANG) > 0) {}
}

/// As some host programs do.
class WaitingForAllChildren {
public:
    WaitingForAllChildren() { std::signal(SIGCHLD, wait_for_all_children); }
    ~WaitingForAllChildren() { std::signal(SIGCHLD, SIG_DFL); }
    WaitingForAllChildren(const WaitingForAllChildren&) = delete;
    WaitingForAllChildren& operator=(const WaitingForAllChildren&) = delete;
};

TEST_F(ReaderProcess, WorksForAParentThatWaitsForAllItsChildren) {
    const WaitingForAllChildren host;
    for (int i = 0; i < 5; ++i) expect_two_cells(read(folder_.file("sample.xdmf")));
}

// Either of the two may be first at the status.
TEST_F(ReaderProcess, ThatCrashesIsAnErrorForAParentThatWaitsForAllItsChildren) {
    const WaitingForAllChildren host;
    const Error error = error_with("echo 'last words' >&2; kill -SEGV $$");
    EXPECT_EQ(error.code, ErrorCode::invalid_data);
    expect_words(error, {"sample.xdmf", "last words"});
}

TEST_F(ReaderProcess, ThatCrashesIsAnErrorForAParentThatIgnoresItsChildren) {
    std::signal(SIGCHLD, SIG_IGN); // the system keeps no status
    const Error error = error_with("echo 'last words' >&2; kill -SEGV $$");
    std::signal(SIGCHLD, SIG_DFL);
    EXPECT_EQ(error.code, ErrorCode::invalid_data);
    expect_words(error, {"sample.xdmf", "without a complete reply", "SIGCHLD", "last words"});
}

TEST_F(ReaderProcess, IsStoppedOnCancelForAParentThatWaitsForAllItsChildren) {
    const WaitingForAllChildren host;
    std::atomic<bool> cancel = false;
    Progress progress;
    progress.cancel = &cancel;
    std::thread user([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        cancel = true;
    });
    EXPECT_EQ(error_with("sleep 1000", progress).code, ErrorCode::cancelled);
    user.join();
}

TEST_F(ReaderProcess, WorksForAParentWithItsStandardStreamsClosed) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    ASSERT_EXIT(
        {
            for (int descriptor = 0; descriptor < 3; ++descriptor) ::close(descriptor);
            const auto result = read(folder_.file("sample.xdmf"));
            ::_exit(result && result->grid.cells.count() == 2 ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(ReaderProcess, ArraysOutliveEverythingElse) {
    Array points;
    {
        auto result = read(folder_.file("sample.xdmf"));
        ASSERT_TRUE(result) << result.error().message;
        points = result->grid.points;
    }
    EXPECT_EQ(points.at(4, 0), 1);
}

TEST_F(ReaderProcess, ServesManyThreadsAtOnce) {
    std::atomic<int> read_well = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            if (const auto result = read(folder_.file("sample.xdmf")); result && result->grid.cells.count() == 2)
                ++read_well;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(read_well, 4);
}

} // namespace
} // namespace isotet::test
