// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The reader process: limits first, then the file.
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <malloc.h>
#include <new>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/core.h>

#include "core/memory.hpp"
#include "io/vtk/child_process.hpp"
#include "io/own/escape.hpp"
#include "io/own/join.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/messages.hpp"
#include "io/vtk/reader_process.hpp"
#include "io/vtk/vtk_log.hpp"

namespace isotet::io::vtk {
namespace {

void tell(unsigned char status) { [[maybe_unused]] const ssize_t written = ::write(status_descriptor, &status, 1); }

/// Bytes of address space in use.
std::uint64_t address_space() {
    unsigned long long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
        std::fclose(file);
    }
    return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Dies with the parent; leaves no core file; large blocks are given back to the system when freed.
bool tie_to_parent(const char* parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    long number = 0;
    std::from_chars(parent, parent + std::strlen(parent), number);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
    return ::getppid() == number; // else the parent died before the first line of this function
}

/// The limit counts from what the program and its libraries have mapped already, before the file is looked at.
void limit_memory(std::uint64_t limit) {
    const std::uint64_t used = address_space(), most = limit != 0 ? limit : core::free_memory();
    limit = most < RLIM_INFINITY - used ? used + most : RLIM_INFINITY;
    rlimit current{};
    ::getrlimit(RLIMIT_AS, &current);
    const rlim_t least = std::min<rlim_t>(limit, current.rlim_cur);
    const rlimit wanted{least, least};
    ::setrlimit(RLIMIT_AS, &wanted);
    std::set_new_handler([] {
        tell(status_memory_ran_out);
        std::set_new_handler(nullptr); // the next failure throws
    });
}

/// Bytes of the grid's file; nothing where it is spread over several, whose sizes are not known yet.
std::optional<std::uint64_t> size_of_grid(const Request& request) {
    for (const std::string_view format : {"cgns", "vtkhdf", "ucd"}) {
        struct stat status{};
        if (request.format == format && ::stat(request.path.c_str(), &status) == 0)
            return static_cast<std::uint64_t>(status.st_size);
    }
    return std::nullopt;
}

/// Processor time by the size of the file, some fifty times what the slowest encoding takes: on some broken files the
/// CGNS library never comes to an end.
void limit_processor_time(const Request& request) {
    const auto size = size_of_grid(request);
    if (!size) return;
    rlimit current{};
    ::getrlimit(RLIMIT_CPU, &current);
    const rlim_t seconds = std::min<rlim_t>(10 + *size / 200000, current.rlim_cur);
    const rlimit wanted{seconds, current.rlim_max};
    ::setrlimit(RLIMIT_CPU, &wanted);
}

Result<Request> receive() {
    struct stat status{};
    if (::fstat(request_descriptor, &status) != 0 || status.st_size > (1 << 26))
        return Error{ErrorCode::internal, "the reader process found no request"};
    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    if (::pread(request_descriptor, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        return Error{ErrorCode::internal, "the reader process could not read its request"};
    return decode_request(bytes);
}

Reply do_task(const Request& request) {
    const Load load = loader_of(request.format);
    if (!load)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("VTK's readers do not read format \"{}\"", escaped(request.format))};
    const bool inspecting = request.task == Task::inspect;
    auto loaded = load(request.path, request.options, inspecting ? Depth::description : Depth::arrays);
    if (!loaded) return loaded.error();
    loaded->info.format = request.format;
    if (inspecting) return std::move(loaded->info);
    auto joined = join(std::move(*loaded), request.options.merge_pieces_by_coordinates);
    return joined ? Reply(std::move(*joined)) : Reply(joined.error());
}

Reply answer(const Request& request) {
    const auto named = [&](ErrorCode code, std::string_view what) {
        return Error{code, fmt::format("{}: {}", escaped(request.path), what)};
    };
    try {
        return do_task(request);
    } catch (const std::bad_alloc&) {
        return named(
            ErrorCode::out_of_memory,
            request.options.memory_limit != 0
                ? fmt::format("reading needs more than the memory limit of {} bytes, or a size in the file is wrong",
                              request.options.memory_limit)
                : std::string("reading needs more memory than is free, or a size in the file is wrong"));
    } catch (const std::exception& exception) {
        return named(ErrorCode::invalid_data, "the reader failed: " + escaped(exception.what()));
    }
}

int serve(const char* parent) {
    if (!tie_to_parent(parent)) return EXIT_FAILURE;
    auto request = receive();
    if (!request) return write_reply(reply_descriptor, request.error()) ? EXIT_SUCCESS : EXIT_FAILURE;
    collect_vtk_messages();
    on_progress([last = -1](double fraction) mutable {
        const int percent = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * 100);
        if (percent > last) tell(static_cast<unsigned char>(last = percent));
    });
    limit_memory(request->options.memory_limit);
    limit_processor_time(*request);
    const auto written = write_reply(reply_descriptor, answer(*request));
    if (written) return EXIT_SUCCESS;
    tell(status_memory_ran_out);
    return EXIT_FAILURE;
}

} // namespace
} // namespace isotet::io::vtk

std::optional<int> isotet::run_as_reader(int argc, char** argv) {
    if (argc == 3 && argv[1] == std::string_view(io::vtk::reader_process_argument)) return io::vtk::serve(argv[2]);
    io::vtk::this_program_can_be_reader();
    return std::nullopt;
}
