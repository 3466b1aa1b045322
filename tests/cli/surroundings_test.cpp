// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hostile surroundings: signals, closed streams, full devices, locales, names that are no text.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include <fmt/format.h>

#include <isotet/make.hpp>

#include "jobs/read_here.hpp"
#include "program.hpp"
#include "readers/foam_sample.hpp"
#include "small_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

TEST_F(Program, CtrlCEndsWithStatus130AndLeavesNoFile) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const RunResult run =
            isotet({"extract", "make:kuhn:100:gyroid", path("s.vtp"), "-i", "0", "-v", "--method", "clusters"},
                   {.interrupt_when = "isotet: packing", .signal = signal});
        EXPECT_EQ(run.status, 130) << "signal " << signal << ": " << run.err;
        EXPECT_NE(run.err.find("isotet: interrupted"), std::string::npos) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(folder.entries(), 0u);
    }
}

/// One thread, so that the whole takes long against what it takes to start and to end.
TEST_F(Program, CtrlCEndsASurveyAtAnyMoment) {
    const std::vector<std::string> arguments{"info", "make:shuffled:64:gyroid,wavelet", "--survey", "-j", "1"};
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(isotet(arguments).status, 0);
    const auto whole = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start);
    int sent = 0, ignored = 0;
    for (const std::uint32_t seed : Seeds(1, 8)) {
        std::mt19937 random(seed);
        const auto moment =
            std::chrono::milliseconds(std::uniform_int_distribution<long long>(0, whole.count() * 2 / 3)(random));
        const RunResult run = isotet(arguments, {.interrupt_after = moment});
        if (!run.interrupted) continue; // this time it was faster
        ++sent;
        ignored += run.status == 0; // or the signal came when all was done
        const bool before_main = run.status == -1 && run.signal == SIGINT;
        if (run.status == 0 || before_main) continue;
        EXPECT_EQ(run.status, 130) << "after " << moment.count() << " ms of " << whole.count() << ": " << run.err;
        EXPECT_NE(run.err.find("isotet: interrupted"), std::string::npos) << run.err;
        EXPECT_EQ(run.out, "");
    }
    EXPECT_GE(sent, std::getenv("ISOTET_SEED") ? 0 : 4);
    EXPECT_LE(ignored, 1);
}

/// Standard output that nobody reads: no operation is there that could be asked to stop.
TEST_F(Program, CtrlCEndsWhatDoesNotStop) {
    const std::string pipe = path("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const int end = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_GE(end, 0);
    ASSERT_GE(::fcntl(end, F_SETPIPE_SZ, 4096), 0);
    RunResult run;
    for (const int moment : {150, 1000, 5000}) { // later where the program had not begun
        run = isotet({"render", "--help-all"},
                     {.stdout_file = pipe, .interrupt_after = std::chrono::milliseconds(moment)});
        if (run.signal == 0) break;
    }
    ::close(end);
    EXPECT_EQ(run.status, 130);
    EXPECT_EQ(run.err, "isotet: interrupted: no file was left half written\n");
}

/// Two files as pieces of one grid.
void write_pieces(const std::string& path, const std::vector<std::string>& pieces) {
    std::string index = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n";
    for (const std::string& piece : pieces) index += "<Piece Source=\"" + piece + "\"/>\n";
    put_content(path, index + "</PUnstructuredGrid></VTKFile>\n");
}

/// A case in text, of cubes, in a folder.
void write_foam(const std::filesystem::path& folder) {
    const FoamBox box = foam_box(26, [](int x, int y, int) { return x == y; });
    const auto f = [](const std::array<double, 3>& point) { return point[0] * point[1] - point[2]; };
    for (const auto& [name, content] : foam_case(box, f, {})) {
        std::filesystem::create_directories((folder / name).parent_path());
        put_content((folder / name).string(), content);
    }
}

/// Tets with a raw file beside it, which isotet-reader reads.
void write_xdmf(const std::string& path, const Grid& grid) {
    const auto raw = [&](const std::string& name, const Array& values) {
        put_content(path + name, std::string(static_cast<const char*>(values.data()), values.bytes()));
        const bool whole = !is_floating(values.type());
        return fmt::format("<DataItem Format=\"Binary\" Endian=\"Little\" NumberType=\"{}\" Precision=\"{}\" "
                           "Dimensions=\"{} {}\">{}</DataItem>",
                           whole ? "Int" : "Float", size_of(values.type()), values.tuples(), values.components(),
                           std::filesystem::path(path + name).filename().string());
    };
    const std::uint64_t cells = grid.cells.count();
    const Array corners(grid.cells.connectivity.type(), grid.cells.connectivity.data(), cells, 4, nullptr);
    put_content(path, fmt::format("<Xdmf Version=\"3.0\"><Domain><Grid><Topology TopologyType=\"Tetrahedron\" "
                                  "NumberOfElements=\"{}\">{}</Topology><Geometry GeometryType=\"XYZ\">{}</Geometry>"
                                  "<Attribute Name=\"gyroid\" Center=\"Node\">{}</Attribute></Grid></Domain></Xdmf>",
                                  cells, raw(".cells", corners), raw(".points", grid.points),
                                  raw(".gyroid", grid.point_fields[0].values)));
}

TEST_F(Program, CtrlCEndsEveryCommandAtAnyMoment) {
    std::vector<std::vector<std::string>> commands{
        {"extract", "make:kelvin:14:gyroid", path("OUT.vtp"), "-i", "0.1", "--edge-ends"},
        {"extract", "make:kuhn:40:gyroid", path("OUT_{value}.vtp"), "--levels", "9", "--normals", "gradient"},
        {"extract", "make:tet10:7:gyroid", path("OUT.vtp"), "-i", "0.1"},
        {"extract", "make:kuhn:40:gyroid", path("OUT.stl"), "-i", "0.1", "--solid", "above"},
        {"clip", "make:mixed:30:gyroid", path("OUT.vtu"), "-i", "0.1"},
        {"render", "make:hex:40:gyroid", "-o", path("OUT.png"), "-i", "0.1"},
        {"pack", "make:kuhn:40:gyroid", path("OUT.isotet")},
        {"extract", "make:kuhn:40:gyroid", path("OUT.stl"), "-i", "0.1", "--reduce", "90%"},
        {"extract", "make:kuhn:70:gyroid", path("OUT.3mf"), "-i", "0.1"},
        {"make", "kelvin", "--side", "14", "-o", path("OUT.vtu")},
        {"make", "octree-tets", "--side", "20", "-o", path("OUT.vtu")},
        {"info", path("tets.vtu"), "--survey"},
        {"info", path("polyhedra.vtu")},
        {"extract", path("tets.vtu"), path("OUT_{value}.vtp"), "--levels", "5"},
        {"extract", path("tets.vtu"), path("OUT.vtp"), "-i", "0.1", "--merge-points", "1e-6"},
        {"render", path("polyhedra.vtu"), "-o", path("OUT.png"), "-i", "0.1"},
        {"render", path("tets.vtu"), "-o", path("OUT.png"), "--volume"},
        {"slice", path("polyhedra.vtu"), path("OUT.vtp"), "--plane", "z=0.4"},
        {"check", path("s.vtp"), "--grid", path("tets.vtu"), "-f", "gyroid"},
        {"bench", path("tets.vtu"), "-f", "gyroid"},
        {"slice", path("tets.vtu"), path("OUT_{value}.vtp"), "--along", "z", "--count", "30"},
        {"render", path("tets.vtu"), "-o", path("OUT.png"), "-f", "gyroid", "-i", "0.1", "--color-by", "gyroid"},
        {"export", path("tets.vtu"), path("OUT.html"), "-f", "gyroid", "--as", "grid"},
        {"export", path("tets.vtu"), path("OUT.html"), "-f", "gyroid", "--as", "surfaces"},
        {"extract", path("pieces.pvtu"), path("OUT.vtp"), "-f", "gyroid", "-i", "0.1"},
        {"extract", path("pieces.pvtu"), path("OUT_{value}.vtp"), "-f", "gyroid", "--levels", "40"},
        {"render", path("pieces.pvtu"), "-o", path("OUT.png"), "-f", "gyroid", "-i", "0.1"},
        {"info", path("foam"), "--survey"},
        {"extract", path("foam"), path("OUT.vtp"), "-f", "T", "-i", "0.1"}};
    if (is_read_here("a.xdmf")) {
        write_xdmf(path("tets.xdmf"), make_grid({.shape = "shuffled", .side = 60, .fields = {"gyroid"}}).value());
        commands.push_back({"info", path("tets.xdmf"), "--survey"});
        commands.push_back({"extract", path("tets.xdmf"), path("OUT.vtp"), "-f", "gyroid", "-i", "0.1"});
    }
    write_foam(path("foam"));
    write_pieces(path("pieces.pvtu"), {"tets.vtu", "hexes.vtu"});
    ASSERT_EQ(isotet({"make", "hex", "--side", "40", "--fields", "gyroid", "-o", path("hexes.vtu")}).status, 0);
    ASSERT_EQ(isotet({"make", "shuffled", "--side", "50", "--fields", "gyroid", "-o", path("tets.vtu")}).status, 0);
    ASSERT_EQ(isotet({"make", "kelvin", "--side", "14", "--fields", "gyroid", "-o", path("polyhedra.vtu")}).status, 0);
    ASSERT_EQ(isotet({"extract", path("tets.vtu"), path("s.vtp"), "-i", "0.1", "--edge-ends"}).status, 0);
    constexpr std::chrono::seconds at_most(3); // of a busy machine; alone a tenth of it
    std::mt19937 random(7);
    for (std::size_t i = 0; i < commands.size(); i += seed_share) {
        std::vector<std::string> command = commands[i];
        command.insert(command.end(), {"-j", "1"});
        const auto moment = std::chrono::milliseconds(30 + random() % 400);
        const auto start = std::chrono::steady_clock::now();
        const RunResult run = isotet(command, {.interrupt_after = moment});
        const auto took = std::chrono::steady_clock::now() - start;
        const bool before_main = run.status == -1 && run.signal == SIGINT;
        if (!run.interrupted || run.status == 0 || before_main) continue; // it was faster, or had not begun
        SCOPED_TRACE(testing::Message() << command[0] << " " << command[1] << " after " << moment.count() << " ms");
        EXPECT_EQ(run.status, 130) << run.err;
        EXPECT_LT(took, moment + at_most);
        EXPECT_NE(run.err.find("isotet: interrupted"), std::string::npos) << run.err;
        for (const auto& entry : std::filesystem::directory_iterator(path(".")))
            EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
}

TEST_F(Program, CtrlCLeavesTheOldFile) {
    put_content(path("s.vtp"), "old");
    const RunResult run =
        isotet({"extract", "make:kuhn:100:gyroid", path("s.vtp"), "-i", "0", "-v", "--method", "clusters"},
               {.interrupt_when = "isotet: packing"});
    EXPECT_EQ(run.status, 130) << run.err;
    EXPECT_EQ(content_of(path("s.vtp")), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(Program, ClosedStandardStreamsDoNotLeakIntoFiles) {
    const std::vector<std::string> arguments{"extract", "make:kuhn:4:sphere", "-i",
                                             "99",      "--allow-empty",      path("s.vtp")};
    EXPECT_EQ(isotet(arguments).status, 0);
    const std::string expected = content_of(path("s.vtp"));
    for (const std::vector<int>& streams : {std::vector<int>{0}, {1}, {2}, {0, 1, 2}}) {
        const RunResult run = isotet(arguments, {.closed = streams});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(content_of(path("s.vtp")), expected);
    }
}

TEST_F(Program, JsonToAClosedStandardOutputIsStatusFour) {
    const RunResult run = isotet({"info", "make:kuhn:2", "--json", "-"}, {.closed = {1}});
    EXPECT_EQ(run.status, 4);
    EXPECT_TRUE(is_one_error(run, "standard output"));
}

TEST_F(Program, AFullStandardOutputIsStatusFour) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"info", "make:kuhn:2"},
                                                      {"--help"},
                                                      {"--version"},
                                                      {"formats", "--json", "-"},
                                                      {"docs", "man"}}) {
        const RunResult run = isotet(arguments, {.stdout_file = "/dev/full"});
        EXPECT_EQ(run.status, 4) << arguments.front();
        EXPECT_TRUE(is_one_error(run, "standard output cannot be written"));
    }
}

TEST_F(Program, AReaderThatGoesAwayIsStatusFourAndNoSignal) {
    const std::string command = fmt::format("'{}' formats | true; exit ${{PIPESTATUS[0]}}", program_path());
    for (int i = 0; i < 20; ++i) { // the reader may also be late
        const RunResult run = run_program({"/bin/bash", "-c", command});
        EXPECT_TRUE(run.status == 4 || run.status == 0) << run.status << " " << run.err;
    }
}

TEST_F(Program, OutputThatCannotBeWrittenIsToldBeforeTheWork) {
    const RunResult device = isotet({"extract", "make:kuhn:2:sphere", "-i", "1", "--json", "/dev/full"});
    EXPECT_EQ(device.status, 2);
    EXPECT_TRUE(is_one_error(device, "/dev/full"));
    const RunResult nowhere = isotet({"extract", "make:kuhn:2:sphere", "-i", "1", path("no/such/folder/s.vtp")});
    EXPECT_EQ(nowhere.status, 3);
    EXPECT_TRUE(is_one_error(nowhere, "no/such/folder"));
}

TEST_F(Program, AFileTooLargeForTheLimitLeavesNothing) {
    // ulimit -f counts 1,024 bytes in bash.
    const std::string command =
        fmt::format("ulimit -f 8; exec '{}' make kuhn --side 20 -o '{}'", program_path(), path("g.vtu"));
    const RunResult run = run_program({"/bin/bash", "-c", command});
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_TRUE(is_one_error(run, "g.vtu"));
    EXPECT_EQ(folder.entries(), 0u);
}

TEST_F(Program, KilledAtAnyMomentItLeavesTheOldFileOrTheNewOne) {
    const auto make = [&](const char* side, const std::string& out) {
        return std::vector<std::string>{program_path(), "make", "kuhn", "--side", side, "-o", out};
    };
    ASSERT_EQ(run_program(make("3", path("old.vtu"))).status, 0);
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run_program(make("30", path("new.vtu"))).status, 0);
    const std::chrono::duration<double> whole_run = std::chrono::steady_clock::now() - start;
    const std::string old_content = content_of(path("old.vtu")), new_content = content_of(path("new.vtu"));
    constexpr int trials = 24;
    int killed = 0;
    for (int trial = 0; trial < trials; ++trial) {
        put_content(path("out.vtu"), old_content);
        std::vector<std::string> command = make("30", path("out.vtu"));
        const std::string moment = fmt::format("{:.6f}", whole_run.count() * (trial + 0.5) / trials);
        command.insert(command.begin(), {"/usr/bin/timeout", "-s", "KILL", moment});
        killed += run_program(command).status != 0;
        const std::string content = content_of(path("out.vtu"));
        EXPECT_TRUE(content == old_content || content == new_content) << "killed after " << moment << " s";
    }
    EXPECT_GT(killed, 0);
}

TEST_F(Program, TwoProcessesWithOneOutputLeaveOneWholeFile) {
    const auto make = [&](const char* side, const std::string& out) {
        return std::vector<std::string>{program_path(), "make", "kuhn", "--side", side, "-o", out};
    };
    ASSERT_EQ(run_program(make("20", path("a.vtu"))).status, 0);
    ASSERT_EQ(run_program(make("24", path("b.vtu"))).status, 0);
    for (int trial = 0; trial < 5; ++trial) {
        RunResult first;
        std::thread other([&] { first = run_program(make("20", path("out.vtu"))); });
        const RunResult second = run_program(make("24", path("out.vtu")));
        other.join();
        EXPECT_EQ(first.status, 0) << first.err;
        EXPECT_EQ(second.status, 0) << second.err;
        const std::string content = content_of(path("out.vtu"));
        EXPECT_TRUE(content == content_of(path("a.vtu")) || content == content_of(path("b.vtu")));
        EXPECT_EQ(folder.entries(), 3u);
    }
}

TEST_F(Program, TooLittleAddressSpaceIsToldWithTheAmounts) {
    // Room to start and to make the grid, not to pack it.
    const std::string command =
        fmt::format("exec '{}' extract make:kuhn:200:sphere -i 0.5 -q --method clusters", program_path());
    const RunResult run = run_program({"/bin/bash", "-c", "ulimit -v 2200000; " + command});
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_TRUE(is_one_error(run, " needs "));
    EXPECT_TRUE(is_one_error(run, " free"));
}

/// A control group with a limit on memory, where one can be made; else there is none.
class MemoryGroup {
public:
    MemoryGroup() {
        const std::filesystem::path mount = "/sys/fs/cgroup";
        is_first_ = std::filesystem::exists(mount / "memory");
        folder_ = (is_first_ ? mount / "memory" : mount) / fmt::format("isotet-test-{}", ::getpid());
        std::error_code error;
        std::filesystem::create_directory(folder_, error);
        has_limit_ = !error && std::filesystem::exists(limit());
    }
    ~MemoryGroup() {
        std::error_code error;
        std::filesystem::remove(folder_, error); // a folder of a control group has nothing that can be removed
    }
    MemoryGroup(const MemoryGroup&) = delete;
    MemoryGroup& operator=(const MemoryGroup&) = delete;

    /// What a shell does to have no more than so many bytes; nothing where there is no group.
    std::string enter(std::size_t bytes) const {
        if (!has_limit_) return {};
        const std::string swap = is_first_ ? "memory.swappiness" : "memory.swap.max";
        return fmt::format("echo {} > {}; echo 0 > {} 2> /dev/null; echo $$ > {}/cgroup.procs; ", bytes,
                           limit().string(), (folder_ / swap).string(), folder_.string());
    }

private:
    std::filesystem::path limit() const { return folder_ / (is_first_ ? "memory.limit_in_bytes" : "memory.max"); }

    std::filesystem::path folder_;
    bool is_first_ = false, has_limit_ = false;
};

TEST_F(Program, IsNotKilledWhereItsControlGroupHasTooLittleMemory) {
    ASSERT_EQ(isotet({"make", "kuhn", "--side", "48", "-o", path("g.vtu"), "-q"}).status, 0);
    const MemoryGroup group;
    const std::string run_it = fmt::format("exec '{}' extract '{}' '{}' -f gyroid -q "
                                           "--isovalue=-0.9,-0.7,-0.5,-0.3,-0.1,0.1,0.3,0.5,0.7,0.9",
                                           program_path(), path("g.vtu"), path("o.vtp"));
    for (const std::size_t megabytes : {200, 90, 80, 60, 40, 25}) {
        const RunResult run = run_program({"/bin/bash", "-c", group.enter(megabytes * 1'000'000) + run_it});
        if (run.status == 0) continue;
        EXPECT_EQ(run.status, 4) << megabytes << " MB: " << run.err;
        EXPECT_TRUE(is_one_error(run, " are free; ")) << megabytes << " MB";
        EXPECT_TRUE(is_one_error(run, " needs less")) << megabytes << " MB";
    }
}

TEST_F(Program, LocaleChangesNothing) {
    // Where the system has no such locale the run is that of C, and equal all the more.
    const std::vector<std::string> arguments{"extract", "make:kuhn:4:sphere", "-i", "0.5,1.25", path("s-{value}.ts")};
    EXPECT_EQ(isotet(arguments).status, 0);
    const std::string expected = content_of(path("s-0.5.ts"));
    for (const char* locale : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "C"}) {
        const RunResult run = isotet(arguments, {.environment = {{"LC_ALL", locale}, {"LANG", locale}}});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(content_of(path("s-0.5.ts")), expected);
    }
    EXPECT_EQ(folder.entries(), 2u);
}

TEST_F(Program, NamesThatAreNoTextAreEscapedAndTheJsonIsValid) {
    const std::string name = "p\xff\x1b[31m";
    put_content(path("g.msh"), small_grid({{name, {0, 1, 1, 1, 2}}}));
    const RunResult run = isotet({"info", path("g.msh"), "--json", path("r.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("p\\xff\\x1b[31m"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find('\x1b'), std::string::npos);
    const json report = json::parse(content_of(path("r.json")), nullptr, false);
    ASSERT_FALSE(report.is_discarded());
    const std::string first = report["fields"][0]["name"];
    EXPECT_EQ(first, "p\\xff\x1b[31m");
    EXPECT_EQ(isotet({"extract", path("g.msh"), "-f", name, "-i", "0.5"}).status, 0);
    const RunResult wrong = isotet({"extract", path("g.msh"), "-f", "p\xfe", "-i", "0.5"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_TRUE(is_one_error(wrong, "'p\\xfe'"));
    EXPECT_EQ(wrong.err.find('\x1b'), std::string::npos);
}

TEST_F(Program, AFileNameThatIsNoTextIsEscaped) {
    const RunResult run = isotet({"info", path("g\x1b\xff.msh")});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "g\\x1b\\xff.msh"));
}

} // namespace
} // namespace isotet::test
