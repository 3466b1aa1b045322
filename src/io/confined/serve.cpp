// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The reader process: one request after another, limits and confinement first, then the file.
#include "io/confined/serve.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>
#include <fcntl.h>
#include <malloc.h>
#include <new>
#include <poll.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/core.h>

#include "base/system/fresh_memory.hpp"
#include "io/confined/limits.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/opened_files.hpp"
#include "io/confined/sandbox.hpp"
#include "io/confined/progress.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/join/join.hpp"
#include "io/pieces/survey_unread.hpp"
#include "base/system/channel.hpp"
#include "io/process/messages.hpp"

namespace isotet::io::confined {
namespace {

constexpr int idle_milliseconds = 10000;

void tell(unsigned char status) {
    [[maybe_unused]] const ssize_t written = ::write(core::channel_descriptor, &status, 1);
}

/// A thread that ends the process when the program that started it is gone, even in the middle of a file.
void end_with_parent() {
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
    ::pthread_attr_setstacksize(&attributes, 1 << 16);
    pthread_t thread;
    ::pthread_create(
        &thread, &attributes,
        [](void*) -> void* {
            pollfd channel{core::channel_descriptor, 0, 0}; // POLLHUP is always told
            while (::poll(&channel, 1, -1) < 0 && errno == EINTR) {}
            ::_exit(EXIT_SUCCESS);
        },
        nullptr);
    ::pthread_attr_destroy(&attributes);
}

Result<Request> receive(int file) {
    struct stat status{};
    if (::fstat(file, &status) != 0 || status.st_size > (1 << 26))
        return Error{ErrorCode::internal, "the reader process found no request"};
    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    if (::pread(file, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        return Error{ErrorCode::internal, "the reader process could not read its request"};
    return decode_request(bytes);
}

Reply do_task(Request request) {
    const Load load = loader_of(request.format);
    if (!load)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("isotet-reader does not read format \"{}\"", escaped(request.format))};
    if (request.task == Task::survey) request.options = to_be_counted(std::move(request.options));
    const bool inspecting = request.task == Task::inspect;
    const auto load_all = [&] {
        auto loaded = load(request.path, request.options, inspecting ? Depth::description : Depth::arrays);
        if (!loaded) return loaded;
        loaded->info.format = request.format;
        loaded->info.files = take_opened_files();
        return loaded;
    };
    if (inspecting) {
        auto loaded = load_all();
        return loaded ? Reply(std::move(loaded->info)) : Reply(loaded.error());
    }
    if (request.task == Task::survey) {
        auto loaded = load_all();
        if (!loaded) return loaded.error();
        auto surveyed = join_counted(*std::move(loaded), request.options);
        return surveyed ? Reply(std::move(*surveyed)) : Reply(surveyed.error());
    }
    const std::shared_ptr<StreamedBoundary> boundary =
        request.options.active_cells ? request.options.active_cells->boundary : nullptr;
    const StreamedBoundary before = boundary ? *boundary : StreamedBoundary{};
    auto joined = load_and_join(load_all, request.options);
    if (!joined) return joined.error();
    GridReply reply{*std::move(joined)};
    if (!boundary) return reply;
    reply.is_same = before.is_there && boundary->is_there && before.of_steps && boundary->print == before.print &&
                    before.print != decltype(before.print){};
    reply.boundary = std::move(*boundary);
    return reply;
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
                : core::ran_out_of_memory("reading").message + ", or a size in the file is wrong");
    } catch (const std::exception& exception) {
        return named(ErrorCode::invalid_data, "the reader failed: " + escaped(exception.what()));
    }
}

/// Once: all requests that one process gets are for the same places.
void confine_to(const Request& request) {
    static bool confined = false;
    if (std::exchange(confined, true)) return;
    confine(request.readable);
    end_with_parent();
    watch_opened_files();
}

void serve_one(const core::Parcel& parcel) {
    tell(0);
    Reply reply = Error{};
    if (auto request = receive(parcel.request.number()); !request) {
        reply = request.error();
    } else {
        confine_to(*request);
        core::fresh_memory().forget();
        take_opened_files();
        on_progress([last = 0](double fraction) mutable {
            const int percent = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * 100);
            if (percent > last) tell(static_cast<unsigned char>(last = percent));
        });
        limit_memory(request->options.memory_limit, [] { tell(core::status_memory_ran_out); });
        limit_processor_time(*request, [] { tell(core::status_time_ran_out); });
        forbid_file_growth();
        reply = answer(*request);
    }
    close_hdf5_files(); // they may change until the next request
    allow_file_growth();
    const bool good = !std::holds_alternative<Error>(reply);
    const auto written = write_reply(parcel.reply.number(), std::move(reply));
    if (written) tell(core::status_replied);
    else tell(written.error().code == ErrorCode::out_of_memory ? core::status_memory_ran_out : core::status_file_limit);
    if (!good || !written)
        ::_exit(written ? EXIT_SUCCESS : EXIT_FAILURE); // what a broken file left behind is not used again
}

/// Where the system ends a process for lack of memory, it shall be this one: isotet then says so.
void be_the_first_to_end() {
    if (std::FILE* file = std::fopen("/proc/self/oom_score_adj", "w")) {
        std::fputs("1000", file);
        std::fclose(file);
    }
}

} // namespace

int serve() {
    int kind = 0;
    socklen_t size = sizeof kind;
    if (::getsockopt(core::channel_descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 || kind != SOCK_SEQPACKET) {
        std::fputs("isotet-reader reads grids for isotet, which starts it: there is nothing to call it for\n", stderr);
        return EXIT_FAILURE;
    }
    be_the_first_to_end();
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    ::mallopt(M_MMAP_THRESHOLD, 1 << 20); // large blocks are given back to the system when freed
    std::signal(SIGXFSZ, SIG_IGN);        // a write that fails says why
    pollfd channel{core::channel_descriptor, POLLIN, 0};
    while (::poll(&channel, 1, idle_milliseconds) > 0) {
        const auto parcel = core::receive_parcel(core::channel_descriptor);
        if (!parcel) break;
        serve_one(*parcel);
    }
    return EXIT_SUCCESS;
}

} // namespace isotet::io::confined
