// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The files of an OpenFOAM case by their names in the case: from a folder, or from memory.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::io::foam {

/// The content of a file, or its beginning. Copies share it.
struct CaseText {
    std::string path; ///< for messages
    std::string name; ///< in the case
    std::shared_ptr<const void> owner;
    std::string_view text;
};

/// What a folder holds. Pipes and devices are in neither list.
struct FolderContent {
    std::vector<std::string> folders, files; ///< sorted; files without ".gz"
};

class CaseFiles {
public:
    static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

    CaseFiles() = default;
    CaseFiles(const CaseFiles&) = delete;
    CaseFiles& operator=(const CaseFiles&) = delete;
    virtual ~CaseFiles() = default;

    /// Empty where there is no such folder. "" is the case's own.
    virtual FolderContent list(const std::string& folder) const = 0;
    /// How many folders processor0, processor1 and so on there are that list("") does not name.
    virtual std::size_t unlisted_processors() const { return 0; }
    /// True for anything but a folder of that name, or with ".gz".
    virtual bool has(const std::string& name) const = 0;
    /// Opens NAME, else NAME.gz.
    ///
    /// `most`   bytes from the beginning (of a packed file, all)
    /// Errors   file: not there, a folder, a pipe, empty; invalid_data: outside of the case, broken gzip; out_of_memory
    virtual Result<CaseText> open(const std::string& name, std::size_t most = all) const = 0;
    /// How messages call a file of the case.
    virtual std::string path_of(const std::string& name) const = 0;
};

/// A folder on disk. Links are followed before it is judged whether a file lies below the folder.
class ISOTET_API DiskCase final : public CaseFiles {
public:
    DiskCase(std::string folder, bool allow_outside, const Progress& progress)
        : folder_(std::move(folder)), allow_outside_(allow_outside), progress_(progress) {}

    FolderContent list(const std::string& folder) const override;
    bool has(const std::string& name) const override;
    Result<CaseText> open(const std::string& name, std::size_t most) const override;
    std::string path_of(const std::string& name) const override;

    /// Everything that was opened, once each.
    std::vector<std::string> opened() const { return opened_; }

private:
    std::string folder_;
    bool allow_outside_;
    const Progress& progress_;
    mutable std::vector<std::string> opened_;
};

} // namespace isotet::io::foam
