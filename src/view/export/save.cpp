// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/save.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "view/command_line.hpp"

extern char** environ;

namespace isotet::view {

namespace {

constexpr std::array<std::string_view, 9> surface_endings{".vtp", ".vtk",  ".ply", ".stl", ".3mf",
                                                          ".glb", ".usda", ".obj", ".ts"};

Error wrong_file(std::string sentence) { return {ErrorCode::invalid_argument, std::move(sentence)}; }

bool is_surface(SaveKind kind) {
    return kind == SaveKind::surface || kind == SaveKind::above || kind == SaveKind::below || kind == SaveKind::series;
}

Result<void> check_ending(const SaveRequest& request) {
    const std::string ending = std::filesystem::path(request.name).extension().string();
    if (request.kind == SaveKind::series) { // the one format of surfaces that holds steps
        if (ending == ".glb") return {};
        return wrong_file(
            fmt::format("'{}' is no name of surfaces of all time steps, which ends in .glb", request.name));
    }
    if (is_surface(request.kind)) {
        if (std::ranges::find(surface_endings, ending) != surface_endings.end()) return {};
        return wrong_file(fmt::format("'{}' is no name of a surface, which ends in {}", request.name,
                                      fmt::join(surface_endings, ", ")));
    }
    const std::string_view needed = request.kind == SaveKind::picture ? ".png" : ".webp";
    if (ending == needed) return {};
    return wrong_file(fmt::format("'{}' is no name of {}, which ends in {}", request.name,
                                  needed == ".png" ? "a picture" : "an animation", needed));
}

Result<void> check_request(const SaveRequest& request) {
    constexpr std::uint32_t max_side = 8192;
    if (!is_file_name(request.name))
        return wrong_file(
            fmt::format("'{}' is no name of a file: it has letters, digits, blanks, . _ - + and =, at most "
                        "100, and no dot first",
                        request.name));
    if (Result<void> fits = check_ending(request); !fits) return fits;
    if (is_surface(request.kind)) return {};
    if (request.width < 1 || request.height < 1 || request.width > max_side || request.height > max_side)
        return wrong_file(fmt::format("a picture of {} x {} is asked for, but sides have 1 to {} pixels", request.width,
                                      request.height, max_side));
    if (request.pictures < 2 || request.pictures > 1000)
        return wrong_file(fmt::format("{} pictures are asked for, but an animation has 2 to 1000", request.pictures));
    return {};
}

/// Without an option and its value.
void drop_option(std::vector<std::string>& words, const std::string& name) {
    const auto found = std::ranges::find_if(
        words, [&](const std::string& word) { return word == name || word.starts_with(name + "="); });
    if (found == words.end()) return;
    words.erase(found, found + (*found == name ? 2 : 1));
}

/// A pipe whose ends a child does not inherit.
struct ErrorPipe {
    std::array<int, 2> ends{-1, -1};
    bool open() { return ::pipe2(ends.data(), O_CLOEXEC) == 0; }
    void close(std::size_t which) {
        if (ends[which] >= 0) ::close(std::exchange(ends[which], -1));
    }
    ~ErrorPipe() {
        close(0);
        close(1);
    }
};

pid_t spawn_words(const std::string& program, const std::vector<std::string>& words, int standard_error) {
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    for (std::string& word : copies) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, standard_error, 2);
    pid_t child = -1;
    if (::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ) != 0) child = -1;
    ::posix_spawn_file_actions_destroy(&actions);
    return child;
}

/// What the child says on its standard error, its last 4096 bytes.
std::string read_errors(int from, pid_t child, const std::atomic<bool>& stop) {
    std::string said;
    while (true) {
        pollfd waiting{from, POLLIN, 0};
        const int ready = ::poll(&waiting, 1, 50);
        if (stop) ::kill(child, SIGTERM);
        if (ready <= 0) continue;
        std::array<char, 1024> part{};
        const ssize_t count = ::read(from, part.data(), part.size());
        if (count <= 0) return said;
        said.append(part.data(), static_cast<std::size_t>(count));
        if (said.size() > 4096) said.erase(0, said.size() - 4096);
    }
}

Result<void> run_words(const std::string& program, const std::vector<std::string>& words,
                       const std::atomic<bool>& stop) {
    ErrorPipe pipe;
    if (!pipe.open()) return Error{ErrorCode::system, "the system gives no pipe to a program that writes a file"};
    const pid_t child = spawn_words(program, words, pipe.ends[1]);
    if (child < 0) return Error{ErrorCode::system, fmt::format("{} cannot be started to write a file", program)};
    pipe.close(1);
    std::string said = read_errors(pipe.ends[0], child, stop);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    while (!said.empty() && (said.back() == '\n' || said.back() == ' ')) said.pop_back();
    return Error{ErrorCode::cannot_write, said.empty() ? "the file was not written" : said};
}

/// A new folder inside another, which goes with all it holds.
class OwnFolder {
public:
    explicit OwnFolder(const std::string& parent) : path_(parent + "/.isotet-save-XXXXXX") {
        if (!::mkdtemp(path_.data())) path_.clear();
    }
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;
    ~OwnFolder() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }
    const std::string& path() const noexcept { return path_; } ///< empty: it could not be made

private:
    std::string path_;
};

/// Gives a file another name that nothing has; 0 or the system's error.
int move_to_free_name(const std::string& from, const std::string& to) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
    return ::link(from.c_str(), to.c_str()) == 0 ? 0 : errno; // file systems without the flag
}

Error taken_name(const std::string& name) {
    return wrong_file(fmt::format("'{}' is there already: another name is needed", name));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

/// Numbers of parts are of what is shown: not of another solid.
void show_solid(SolidSide side, ViewState& state) {
    const bool by_number =
        state.keep && (state.keep->kind == PartChoice::Kind::numbers || state.keep->kind == PartChoice::Kind::others);
    if (by_number && state.solid != side) state.keep.reset();
    state.solid = side;
}

} // namespace

std::optional<SaveKind> parse_save_kind(std::string_view name) {
    constexpr std::array<std::string_view, 8> names{"picture", "surface", "sweep", "turn",
                                                    "steps",   "above",   "below", "series"};
    const auto* const found = std::ranges::find(names, name);
    if (found == names.end()) return std::nullopt;
    return static_cast<SaveKind>(found - names.begin());
}

bool is_file_name(std::string_view name) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view(" ._-+=").find(c) != std::string_view::npos;
    };
    return !name.empty() && name.size() <= 100 && name.front() != '.' && std::ranges::all_of(name, fits);
}

Result<std::vector<std::string>> save_words(const SaveRequest& request, const std::string& folder,
                                            const std::string& file, const std::vector<std::string>& reading) {
    if (Result<void> fits = check_request(request); !fits) return fits.error();
    const bool surface = is_surface(request.kind);
    ViewState state = request.state;
    if (request.kind == SaveKind::sweep && state.volume) state.volume->opacity = "peaks"; // one, from value to value
    if (request.kind == SaveKind::above) show_solid(SolidSide::above, state);
    if (request.kind == SaveKind::below) show_solid(SolidSide::below, state);
    std::vector<std::string> words = request.kind == SaveKind::series ? extract_all_words(state, file, reading)
                                     : surface                        ? extract_words(state, file, reading)
                                                                      : render_words(state, file, reading);
    words.resize(words.size() - 2); // -o, and what it names
    if (!surface) {
        words.push_back("--size");
        words.push_back(fmt::format("{}x{}", request.width, request.height));
    }
    if (request.kind == SaveKind::sweep) {
        drop_option(words, "--isovalue");
        words.push_back(fmt::format("--sweep={},{},{}", request.from, request.to, request.pictures));
    }
    if (request.kind == SaveKind::turn) words.push_back(fmt::format("--orbit={}", request.pictures));
    if (request.kind == SaveKind::steps) {
        drop_option(words, "--step");
        words.emplace_back("--all-steps");
    }
    words.emplace_back("-q");
    words.emplace_back("-o");
    words.push_back((std::filesystem::path(folder) / request.name).string());
    return words;
}

Saver::~Saver() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

Result<void> Saver::start(std::vector<std::string> words, const std::string& name,
                          std::function<void(Result<std::string>)> done) {
    std::error_code ignored;
    const std::filesystem::path path = std::filesystem::path(folder_) / name;
    if (std::filesystem::exists(std::filesystem::symlink_status(path, ignored))) return taken_name(name);
    if (busy_) return wrong_file("another file is being written: one at a time");
    if (thread_.joinable()) thread_.join();
    busy_ = true;
    stop_ = false;
    thread_ = std::thread([this, words = std::move(words), name, done = std::move(done)] {
        Result<std::string> written = write(words, name);
        busy_ = false;
        done(std::move(written));
    });
    return {};
}

Result<std::string> Saver::write(std::vector<std::string> words, const std::string& name) const {
    const OwnFolder own(folder_);
    if (own.path().empty())
        return Error{ErrorCode::cannot_write,
                     fmt::format("{} cannot be written into: {}", folder_, std::generic_category().message(errno))};
    words.back() = own.path() + "/" + name;
    if (const Result<void> run = run_words(program_, words, stop_); !run)
        return Error{run.error().code, replaced(run.error().message, own.path(), folder_)};
    const std::string path = (std::filesystem::path(folder_) / name).string();
    const int failed = move_to_free_name(words.back(), path);
    if (failed == EEXIST) return taken_name(name);
    if (failed != 0)
        return Error{ErrorCode::cannot_write,
                     fmt::format("{} cannot be written: {}", path, std::generic_category().message(failed))};
    return path;
}

} // namespace isotet::view
