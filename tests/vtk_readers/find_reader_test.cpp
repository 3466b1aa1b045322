// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The program that runs VTK's readers is found wherever isotet is moved to.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "io/process/find_reader.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using io::confined::find_reader;
using io::confined::reader_candidates;
using io::confined::ReaderPlaces;

using Paths = std::vector<std::string>;

TEST(ReaderCandidates, BeginBesideTheLibraryAndEndWithTheBuiltInPath) {
    EXPECT_EQ(reader_candidates({.library = "/moved/lib/x86/libisotet_io.so.0",
                                 .to_programs = "../../bin",
                                 .program = "/opt/cfd/bin/solver",
                                 .search_path = "/usr/bin:/bin",
                                 .built_in = "/usr/local/bin/isotet-reader"}),
              (Paths{"/moved/lib/x86/isotet-reader", "/moved/bin/isotet-reader", "/opt/cfd/bin/isotet-reader", "/usr/bin/isotet-reader",
                     "/bin/isotet-reader", "/usr/local/bin/isotet-reader"}));
}

TEST(ReaderCandidates, LeaveOutWhatIsNotKnown) {
    EXPECT_EQ(reader_candidates({}), Paths{});
    EXPECT_EQ(reader_candidates({.program = "/a/tools/solver"}), (Paths{"/a/tools/isotet-reader", "/a/bin/isotet-reader"}));
}

TEST(ReaderCandidates, OfTheSearchPathAreAbsolute) {
    EXPECT_EQ(reader_candidates({.search_path = ":.:bin:/one::../up:/two/:"}), (Paths{"/one/isotet-reader", "/two/isotet-reader"}));
}

class FoundReader : public testing::Test {
protected:
    std::string program(const std::string& name) const {
        folder_.write(name, ""); // makes its folder
        return folder_.write_script(name, "exit 0");
    }
    TemporaryFolder folder_;
};

TEST_F(FoundReader, IsTheOneOfTheLibrarysPrefix) {
    const std::string reader = program("moved/bin/isotet-reader");
    const ReaderPlaces places{.library = folder_.write("moved/lib/libisotet_io.so", ""),
                              .to_programs = "../bin",
                              .search_path = std::filesystem::path(program("elsewhere/isotet-reader")).parent_path()};
    EXPECT_EQ(find_reader(places).value(), reader);
}

TEST_F(FoundReader, IsTheOneInPathOtherwise) {
    const std::string reader = program("elsewhere/isotet-reader");
    const ReaderPlaces places{.library = folder_.file("solver"),
                              .to_programs = "../bin",
                              .program = folder_.file("solver"),
                              .search_path = "/not/there:" + folder_.file("elsewhere"),
                              .built_in = "/not/there/either/isotet-reader"};
    EXPECT_EQ(find_reader(places).value(), reader);
}

TEST_F(FoundReader, CanBeRun) {
    folder_.write("a/isotet-reader", "not a program");
    std::filesystem::create_directories(folder_.file("b/isotet-reader"));
    const std::string reader = program("c/isotet-reader");
    const auto path = [&](const char* name) { return folder_.file(name); };
    const ReaderPlaces places{.program = path("solver"), .search_path = path("a") + ":" + path("b") + ":" + path("c")};
    EXPECT_EQ(find_reader(places).value(), reader);
}

TEST_F(FoundReader, ThatIsNowhereIsAnErrorThatSaysWhatToDo) {
    const auto missing = find_reader({.program = folder_.file("solver"), .search_path = "/not/there"});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::system);
    for (const std::string& part : {folder_.file("isotet-reader"), std::string("nor in PATH"),
                                    std::string("ReadOptions::reader_program"), std::string("-DISOTET_IO=ON")})
        EXPECT_NE(missing.error().message.find(part), std::string::npos) << part << ": " << missing.error().message;
    EXPECT_EQ(missing.error().message.find("/not/there"), std::string::npos) << "PATH may have many folders";
}

TEST(ReaderPlacesOfThisProcess, AreThoseOfTheProgram) {
    const ReaderPlaces places = io::confined::reader_places();
    EXPECT_EQ(places.program, std::filesystem::canonical("/proc/self/exe"));
    EXPECT_TRUE(std::filesystem::exists(places.library)) << places.library;
    EXPECT_FALSE(places.to_programs.empty());
    EXPECT_TRUE(std::filesystem::path(places.built_in).is_absolute());
}

} // namespace
} // namespace isotet::test
