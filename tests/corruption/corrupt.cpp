// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The corruption driver: breaks files of every format, seeded, and gives them to a program from outside.
//
//   corrupt PROGRAM COUNT SEED FILE[,PART]...
//
// COUNT mutations and truncations of each FILE, or of a PART of its folder that it leads to, beside copies of the files that
// lie in its folder (an index is of no use without them), are read by `PROGRAM info`. What is accepted: success, or exit
// status 3 or 4 with a message. What is read must say the same, and give the same surface, when memory holds other bytes
// before it is written (MALLOC_PERTURB_): else some value was never read. A crash, any other status, another answer, or no
// end within 120 s is a failure, told with the command that makes it again.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "support/run_program.hpp"

namespace {

namespace fs = std::filesystem;
using Random = std::mt19937_64;

/// Values that break things: limits of types, and small ones where large ones are expected.
constexpr std::uint64_t nasty[] = {0,
                                   1,
                                   0x7F,
                                   0x80,
                                   0xFF,
                                   0x7FFF,
                                   0xFFFF,
                                   0x7FFFFFFF,
                                   0x80000000,
                                   0xFFFFFFFF,
                                   0x7FFFFFFFFFFFFFFF,
                                   0x8000000000000000,
                                   0xFFFFFFFFFFFFFFFF};

/// Where headers and tables are: half of the changes go to the first 4 KiB.
std::size_t place(const std::string& bytes, Random& random) {
    const std::size_t end = random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 4096) : bytes.size();
    return random() % end;
}

void put_word(std::string& bytes, Random& random) {
    const std::size_t size = std::size_t{1} << random() % 4, at = place(bytes, random);
    const bool big_endian = random() % 2 == 0;
    const std::uint64_t value = nasty[random() % std::size(nasty)];
    for (std::size_t i = 0; i < size && at + i < bytes.size(); ++i)
        bytes[at + i] = static_cast<char>(value >> (8 * (big_endian ? size - 1 - i : i)));
}

/// Another number in place of one written in digits.
void put_number(std::string& bytes, Random& random) {
    constexpr std::string_view digits = "0123456789";
    constexpr std::string_view numbers[] = {
        "-1", "0", "4294967296", "9223372036854775807", "18446744073709551616", "1e400", "nan", "x", ""};
    const std::size_t begin = bytes.find_first_of(digits, place(bytes, random));
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of(digits, begin), bytes.size());
    bytes.replace(begin, end - begin, numbers[random() % std::size(numbers)]);
}

void mutate(std::string& bytes, Random& random) {
    if (bytes.empty()) return;
    const std::size_t at = place(bytes, random);
    const std::size_t size = std::min<std::size_t>(1 + random() % 64, bytes.size() - at);
    switch (random() % 8) {
    case 0: bytes.resize(random() % bytes.size()); return;
    case 1: bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8)); return;
    case 2: bytes[at] = static_cast<char>(random()); return;
    case 3: put_word(bytes, random); return;
    case 4: put_number(bytes, random); return;
    case 5: bytes.erase(at, size); return;
    case 6: bytes.insert(at, bytes.substr(place(bytes, random), size)); return;
    default: std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), size, '\0');
    }
}

std::string content_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A folder that is gone at the end.
struct Workplace {
    fs::path path = fs::temp_directory_path() / ("isotet-corrupt-" + std::to_string(::getpid()));
    Workplace() { fs::create_directories(path); }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;
    ~Workplace() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

bool acceptable(const isotet::test::RunResult& run) {
    if (run.timed_out || run.signal != 0) return false;
    if (run.status == 0) return true;
    return (run.status == 3 || run.status == 4) && run.err.starts_with("isotet: ");
}

struct Driver {
    std::string program;
    std::uint64_t count = 0, seed = 0;
    std::uint64_t refused = 0, read = 0, failed = 0;

    void attack(const std::string& argument) {
        const std::size_t comma = argument.find(',');
        const fs::path file = argument.substr(0, comma);
        const fs::path part = comma == std::string::npos ? file.filename() : fs::path(argument.substr(comma + 1));
        const Workplace workplace;
        fs::copy(file.parent_path().empty() ? fs::path(".") : file.parent_path(), workplace.path,
                 fs::copy_options::overwrite_existing | fs::copy_options::recursive);
        const std::string content = content_of(workplace.path / part), grid = workplace.path / file.filename();
        for (std::uint64_t i = 0; i < count; ++i) {
            Random random((seed + i) * 0x9E3779B97F4A7C15u + 1);
            std::string broken = content;
            for (std::uint64_t changes = 1 + random() % 3; changes > 0; --changes) mutate(broken, random);
            std::ofstream(workplace.path / part, std::ios::binary | std::ios::trunc) << broken;
            judge(grid, argument, seed + i);
        }
    }

    static isotet::test::RunResult run(const std::vector<std::string>& words, const char* fresh_memory) {
        isotet::test::RunOptions options;
        options.environment = {{"MALLOC_PERTURB_", fresh_memory}};
        return isotet::test::run_program(words, options);
    }

    void judge(const std::string& grid, const std::string& argument, std::uint64_t trial) {
        const auto first = run({program, "info", grid}, "85");
        if (!acceptable(first)) return tell(first, "", argument, trial);
        if (first.status != 0) {
            ++refused;
            return;
        }
        const auto second = run({program, "info", grid}, "170");
        if (second.status != 0 || second.out != first.out) return tell(second, "another answer", argument, trial);
        const std::string surface = grid + ".surface.vtk";
        std::string expected;
        for (const char* fresh_memory : {"85", "170"}) {
            std::error_code ignored;
            fs::remove(surface, ignored);
            const auto made = run({program, "extract", grid, "-f", "p", "-o", surface, "-q"}, fresh_memory);
            if (made.timed_out || made.signal != 0 || made.status == 5) return tell(made, "extract", argument, trial);
            const std::string found = made.status == 0 ? content_of(surface) : made.err;
            if (*fresh_memory == '1' && found != expected) return tell(made, "another surface", argument, trial);
            expected = found;
        }
        ++read;
    }

    void tell(const isotet::test::RunResult& run, const char* what, const std::string& argument, std::uint64_t trial) {
        ++failed;
        std::printf("%s status %d, signal %d%s: corrupt %s 1 %llu %s\n%s\n", what, run.status, run.signal,
                    run.timed_out ? ", no end" : "", program.c_str(), static_cast<unsigned long long>(trial),
                    argument.c_str(), run.err.substr(0, 500).c_str());
    }
};

bool parse(std::string_view text, std::uint64_t& value) {
    return std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size() &&
           !text.empty();
}

} // namespace

int main(int argc, char** argv) {
    Driver driver;
    if (argc < 5 || !parse(argv[2], driver.count) || !parse(argv[3], driver.seed)) {
        std::printf("usage: corrupt PROGRAM COUNT SEED FILE...\n");
        return 2;
    }
    driver.program = argv[1];
    for (int i = 4; i < argc; ++i) driver.attack(argv[i]);
    std::printf("%llu refused, %llu read, %llu failed\n", static_cast<unsigned long long>(driver.refused),
                static_cast<unsigned long long>(driver.read), static_cast<unsigned long long>(driver.failed));
    return driver.failed == 0 ? 0 : 1;
}
