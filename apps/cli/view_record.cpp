// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view_record.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <isotet/text.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_records = 50, max_record_bytes = 1 << 20;

fs::path record_path() {
    const char* state = std::getenv("XDG_STATE_HOME");
    if (state && state[0] == '/') return fs::path(state) / "isotet" / "view.json";
    const char* home = std::getenv("HOME");
    return home && home[0] == '/' ? fs::path(home) / ".local/state/isotet/view.json" : fs::path();
}

/// The same however a path is written.
std::string name_of_file(const std::string& file) {
    std::error_code error;
    const fs::path path = fs::canonical(file, error);
    return valid_utf8(error ? file : path.string());
}

/// Nothing where it is another user's, or others may read it.
std::string read_own_file(const fs::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    struct stat status{};
    std::string text;
    if (file < 0) return text;
    if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid() &&
        (status.st_mode & 077) == 0 && status.st_size <= static_cast<off_t>(max_record_bytes)) {
        text.resize(static_cast<std::size_t>(status.st_size));
        if (::read(file, text.data(), text.size()) != static_cast<ssize_t>(text.size())) text.clear();
    }
    ::close(file);
    return text;
}

bool is_token(const std::string& text) {
    return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Records that are whole, the newest first.
Json read_records() {
    Json whole = Json::array();
    const Json all = Json::parse(read_own_file(record_path()), nullptr, false);
    if (!all.is_array()) return whole;
    for (const Json& one : all) {
        const auto is = [&](const char* key) { return one.is_object() && one.contains(key) ? &one[key] : nullptr; };
        const Json *file = is("file"), *token = is("token"), *port = is("port");
        if (file && token && port && file->is_string() && token->is_string() && port->is_number_unsigned() &&
            is_token(token->get<std::string>()) && *port <= 65535)
            whole.push_back(one);
    }
    return whole;
}

bool is_of(const Json& record, const std::string& file) { return record["file"].get_ref<const std::string&>() == file; }

/// Takes the place of the file before, at once.
void write_own_file(const fs::path& path, std::string_view text) {
    const std::string part = path.string() + "." + std::to_string(::getpid());
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file < 0) return;
    const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    if (::close(file) != 0 || !written || ::rename(part.c_str(), path.c_str()) != 0) ::unlink(part.c_str());
}

} // namespace

std::optional<ViewRecord> recall_view(const std::string& file) {
    const std::string name = name_of_file(file);
    for (const Json& one : read_records())
        if (is_of(one, name)) return ViewRecord{one["token"].get<std::string>(), one["port"].get<std::uint16_t>()};
    return std::nullopt;
}

void remember_view(const std::string& file, const ViewRecord& record) {
    const fs::path path = record_path();
    if (path.empty()) return;
    const std::string name = name_of_file(file);
    Json records = Json::array({{{"file", name}, {"token", record.token}, {"port", record.port}}});
    for (const Json& one : read_records())
        if (!is_of(one, name) && records.size() < max_records) records.push_back(one);
    std::error_code ignored;
    fs::create_directories(path.parent_path().parent_path(), ignored);
    ::mkdir(path.parent_path().c_str(), 0700);
    write_own_file(path, records.dump(1) + "\n");
}

} // namespace isotet::cli
