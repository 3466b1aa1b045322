// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"

namespace isotet::io {
namespace {

namespace fs = std::filesystem;

Error refused(const std::string& index, std::string_view name, std::string_view why) {
    return {ErrorCode::invalid_data,
            fmt::format("{} names \"{}\", {}: only files below its own folder are read, unless "
                        "`allow_outside` is given",
                        escaped(index), escaped(name), why)};
}

} // namespace

Result<void> check_name(const std::string& index, std::string_view name, bool allow_outside) {
    if (name.empty() || name.find('\0') != std::string_view::npos)
        return Error{ErrorCode::invalid_data, escaped(index) + " names a file without a name"};
    if (name.find("://") != std::string_view::npos) return refused(index, name, "a URL");
    if (allow_outside) return {};
    const fs::path path(name);
    if (path.is_absolute()) return refused(index, name, "an absolute path");
    if (const fs::path plain = path.lexically_normal(); *plain.begin() == "..")
        return refused(index, name, "which climbs out with \"..\"");
    return {};
}

Result<std::string> named_file(const std::string& index, std::string_view name, bool allow_outside) {
    if (auto allowed = check_name(index, name, allow_outside); !allowed) return allowed.error();
    std::error_code error;
    const fs::path folder =
        fs::canonical(fs::path(index).parent_path().empty() ? fs::path(".") : fs::path(index).parent_path(), error);
    if (name.find('\\') != std::string_view::npos && !fs::exists(folder / fs::path(name), error)) { // of Windows
        std::string with_slashes(name);
        std::ranges::replace(with_slashes, '\\', '/');
        return named_file(index, with_slashes, allow_outside);
    }
    const fs::path file = error ? fs::path() : fs::canonical(folder / fs::path(name), error);
    if (error || !fs::is_regular_file(file, error))
        return Error{ErrorCode::file,
                     fmt::format("{} names \"{}\", which is not there or not a file", escaped(index), escaped(name))};
    const auto [in_folder, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    if (!allow_outside && in_folder != folder.end()) return refused(index, name, "a link to " + escaped(file.string()));
    if (fs::equivalent(file, index, error)) return Error{ErrorCode::invalid_data, escaped(index) + " names itself"};
    return file.string();
}

} // namespace isotet::io
