// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/process/find_reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

namespace fs = std::filesystem;

constexpr const char* reader_name = "isotet-reader";

std::string running_program() {
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    return failed ? "" : program.string();
}

/// The file of the code that is running: the library, where isotet is a shared one.
std::string own_file() {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&reader_places), &info) == 0 || !info.dli_fname) return {};
    std::error_code failed;
    const fs::path file = fs::canonical(info.dli_fname, failed);
    return failed ? "" : file.string();
}

bool can_be_run(const std::string& path) {
    std::error_code failed;
    return fs::is_regular_file(path, failed) && ::access(path.c_str(), X_OK) == 0;
}

} // namespace

ReaderPlaces reader_places() {
    const char* const path = std::getenv("PATH");
    return {own_file(), ISOTET_PROGRAMS_FROM_LIBRARIES, running_program(), path ? path : "", ISOTET_READER_PROGRAM};
}

std::vector<std::string> reader_candidates(const ReaderPlaces& places) {
    std::vector<std::string> candidates;
    const auto add = [&](const fs::path& folder) {
        std::string candidate = (folder / reader_name).lexically_normal().string();
        if (std::ranges::find(candidates, candidate) == candidates.end()) candidates.push_back(std::move(candidate));
    };
    if (!places.library.empty()) {
        const fs::path folder = fs::path(places.library).parent_path();
        add(folder);
        add(folder / places.to_programs);
    }
    if (!places.program.empty()) {
        const fs::path folder = fs::path(places.program).parent_path();
        add(folder);
        add(folder / ".." / "bin");
    }
    std::string_view rest = places.search_path;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        if (const fs::path folder(rest.substr(0, end)); folder.is_absolute()) add(folder);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    if (!places.built_in.empty()) add(fs::path(places.built_in).parent_path());
    return candidates;
}

Result<std::string> find_reader(const ReaderPlaces& places) {
    for (const std::string& candidate : reader_candidates(places)) {
        if (can_be_run(candidate)) return candidate;
    }
    ReaderPlaces without_path = places;
    without_path.search_path.clear();
    std::vector<std::string> shown;
    for (const std::string& candidate : reader_candidates(without_path)) shown.push_back(escaped(candidate));
    shown.emplace_back("in PATH");
    return Error{
        ErrorCode::system,
        fmt::format("the program isotet-reader, which reads this format, was found neither as {}: install isotet with "
                    "it (it is built with -DISOTET_IO=ON), put its folder into PATH, or name it in "
                    "ReadOptions::reader_program",
                    fmt::join(shown, " nor "))};
}

} // namespace isotet::io::confined
