// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The collated format of OpenFOAM: the files of all processors as blocks of one file.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

#include "io/foam/case_files.hpp"

namespace isotet::io::foam {

/// A case with folders processor0, processor1 and so on in place of "processors4", or of "processors4_0-1" and
/// "processors4_2-3". The file of a processor is its block, with the header of the first one.
///
/// Guarantees   the last files that were opened stay in memory, so a file is read once, not for each processor
class CollatedCase final : public CaseFiles {
public:
    /// Null where the case has no such folders, or plain ones beside them.
    ///
    /// Errors   invalid_data: folders that lack a processor, or have one twice
    static Result<std::unique_ptr<const CollatedCase>> over(const CaseFiles& files);

    FolderContent list(const std::string& folder) const override;
    std::size_t unlisted_processors() const override { return groups_.back().first + groups_.back().count; }
    bool has(const std::string& name) const override { return files_.has(collated(name).name); }
    /// Errors   invalid_data: not as many blocks as there are processors, a block that is cut short
    Result<CaseText> open(const std::string& name, std::size_t most) const override;
    std::string path_of(const std::string& name) const override { return files_.path_of(collated(name).name); }

private:
    /// The processors of a folder.
    struct Group {
        std::string folder;
        std::size_t first = 0, count = 0;
    };
    /// A file of the case below, and which of its blocks; none of a file outside of the folders.
    struct Place {
        std::string name;
        const Group* group = nullptr;
        std::size_t block = 0;
    };
    struct Blocks {
        CaseText file;
        std::string_view header;
        std::vector<std::string_view> blocks; ///< empty: the file is not collated
    };

    explicit CollatedCase(const CaseFiles& files) : files_(files) {}
    Place collated(const std::string& name) const;
    static Result<Blocks> blocks_of(CaseText file, std::size_t count);
    Result<const Blocks*> blocks_at(const Place& place) const;

    const CaseFiles& files_;
    std::vector<Group> groups_;
    mutable std::list<std::pair<std::string, Blocks>> recent_; ///< newest first
};

} // namespace isotet::io::foam
