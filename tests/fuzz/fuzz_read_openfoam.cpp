// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A case in one input: files one after another, each behind a line "=====NAME".
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "fuzz/read_input.hpp"
#include "io/foam/read_openfoam.hpp"
#include "io/pieces/join/join.hpp"

namespace {

using namespace isotet;

class MemoryCase final : public io::foam::CaseFiles {
public:
    explicit MemoryCase(std::string_view input) {
        constexpr std::string_view mark = "=====";
        while (input.starts_with(mark)) {
            const std::size_t line = input.find('\n');
            if (line == std::string_view::npos) return;
            const std::string name(input.substr(mark.size(), line - mark.size()));
            const std::size_t next = input.find("\n=====", line);
            const std::size_t end = next == std::string_view::npos ? input.size() : next;
            files_[name] = input.substr(line + 1, end > line ? end - line - 1 : 0);
            input.remove_prefix(std::min(input.size(), end + 1));
        }
    }
    io::foam::FolderContent list(const std::string& folder) const override {
        io::foam::FolderContent content;
        std::set<std::string> folders;
        const std::string prefix = folder.empty() || folder.ends_with('/') ? folder : folder + "/";
        for (const auto& [name, text] : files_) {
            if (!name.starts_with(prefix)) continue;
            const std::string rest = name.substr(prefix.size());
            const std::size_t slash = rest.find('/');
            if (slash == std::string::npos) content.files.push_back(rest);
            else folders.insert(rest.substr(0, slash));
        }
        content.folders.assign(folders.begin(), folders.end());
        return content;
    }
    bool has(const std::string& name) const override { return files_.contains(name); }
    Result<io::foam::CaseText> open(const std::string& name, std::size_t most) const override {
        const auto file = files_.find(name);
        if (file == files_.end()) return Error{ErrorCode::file, name + " is not there"};
        return io::foam::CaseText{name, name, nullptr, file->second.substr(0, most)};
    }
    std::string path_of(const std::string& name) const override { return name; }

private:
    std::map<std::string, std::string_view> files_;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const MemoryCase files(test::as_text(data, size));
    ReadOptions options;
    options.step = size % 2;
    if (files.has("constant/polyMesh/cellZones")) options.blocks = {"1"};
    auto loaded = io::load_openfoam_case(files, options, io::Depth::arrays);
    if (!loaded) {
        if (loaded.error().message.empty() || loaded.error().code == ErrorCode::internal) std::abort();
        return 0;
    }
    const auto joined = io::join(std::move(*loaded), {});
    test::expect_consistent(joined);
    return 0;
}
