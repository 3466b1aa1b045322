// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/limits.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <optional>
#include <sys/resource.h>
#include <unistd.h>

#include <fmt/core.h>

#include "base/system/memory.hpp"
#include "io/confined/exodus/exodus_parts.hpp"

namespace isotet::io::confined {
namespace {

namespace fs = std::filesystem;

/// Bytes of address space in use.
std::uint64_t address_space() {
    unsigned long long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
        std::fclose(file);
    }
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t size_of_file(const fs::path& path) {
    std::error_code error;
    const auto size = fs::file_size(path, error);
    return error ? 0 : size;
}

/// Bytes of all files below a folder; nothing where there are very many.
std::optional<std::uint64_t> size_below(const fs::path& folder) {
    std::error_code error;
    std::uint64_t bytes = 0;
    int entries = 0;
    const auto options = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator at(folder, options, error), end; !error && at != end; at.increment(error)) {
        if (++entries > 20000) return std::nullopt;
        std::error_code ignored;
        if (at->is_regular_file(ignored)) bytes += size_of_file(at->path());
    }
    return bytes;
}

/// Bytes that reading may look at.
std::optional<std::uint64_t> size_to_read(const Request& request) {
    for (const std::string_view format : {"cgns", "vtkhdf"})
        if (request.format == format) return size_of_file(request.path);
    if (request.format == "exodus") {
        std::uint64_t bytes = 0;
        if (const auto parts = exodus_parts(request.path))
            for (const std::string& part : parts->files) bytes += size_of_file(part);
        return bytes;
    }
    return request.readable.empty() || request.options.allow_outside ? std::nullopt : size_below(request.readable[0]);
}

/// What a signal handler needs.
struct TimeLimit {
    char sentence[128] = {};
    std::size_t size = 0;
    void (*ran_out)() = nullptr;
};
TimeLimit time_limit;

rlim_t& inherited_file_size() {
    static rlim_t limit = [] {
        rlimit current{};
        ::getrlimit(RLIMIT_FSIZE, &current);
        return current.rlim_cur;
    }();
    return limit;
}

void set_soft(__rlimit_resource resource, rlim_t soft) {
    rlimit limit{};
    ::getrlimit(resource, &limit);
    limit.rlim_cur = std::min(soft, limit.rlim_max);
    ::setrlimit(resource, &limit);
}

} // namespace

void limit_memory(std::uint64_t limit, void (*ran_out)()) {
    static const rlim_t inherited = [] {
        rlimit current{};
        ::getrlimit(RLIMIT_AS, &current);
        return current.rlim_cur;
    }();
    static void (*tell)() = nullptr;
    set_soft(RLIMIT_AS, inherited); // free_memory() looks at the limit, too
    const std::uint64_t used = address_space(), most = limit != 0 ? limit : core::free_memory();
    limit = most < RLIM_INFINITY - used ? used + most : RLIM_INFINITY;
    set_soft(RLIMIT_AS, std::min<rlim_t>(limit, inherited));
    tell = ran_out;
    std::set_new_handler([] {
        tell();
        std::set_new_handler(nullptr); // the next failure throws
    });
}

void limit_processor_time(const Request& request, void (*ran_out)()) {
    static const rlim_t inherited = [] {
        rlimit current{};
        ::getrlimit(RLIMIT_CPU, &current);
        return current.rlim_cur;
    }();
    const auto size = size_to_read(request);
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    const auto seconds = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 1);
    const rlim_t allowed = size ? 3 + *size / 200000 : RLIM_INFINITY - seconds;
    const bool ours = seconds + allowed < inherited;
    if (ours && size) {
        const auto end = fmt::format_to_n(time_limit.sentence, sizeof time_limit.sentence,
                                          "{} s of processor time are allowed for {} bytes\n", allowed, *size);
        time_limit.size = std::min(end.size, sizeof time_limit.sentence);
        time_limit.ran_out = ran_out;
        std::signal(SIGXCPU, [](int) {
            [[maybe_unused]] const auto written = ::write(STDERR_FILENO, time_limit.sentence, time_limit.size);
            time_limit.ran_out();
            ::_exit(EXIT_FAILURE);
        });
    } else {
        std::signal(SIGXCPU, SIG_DFL);
    }
    set_soft(RLIMIT_CPU, ours ? seconds + allowed : inherited);
}

void forbid_file_growth() {
    inherited_file_size();
    set_soft(RLIMIT_FSIZE, 0);
}

void allow_file_growth() { set_soft(RLIMIT_FSIZE, inherited_file_size()); }

} // namespace isotet::io::confined
