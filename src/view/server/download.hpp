// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that pages download: written as those of --out are, in a folder that goes with the program, and sent in parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <isotet/result.hpp>

#include "view/export/save.hpp"

namespace isotet::view {

/// A file that is written, and waits to be sent.
struct Download {
    std::string name;
    std::uint64_t bytes = 0;
};

/// One file is written at a time, for any page; each page has one file at most that waits.
///
/// Threads   one call at a time
class Downloads {
public:
    using PageKey = std::uint64_t;
    static constexpr std::size_t part_bytes = std::size_t{1} << 21;

    /// `program`   that runs command lines, as Saver's
    explicit Downloads(std::string program) : program_(std::move(program)) {}
    Downloads(const Downloads&) = delete;
    Downloads& operator=(const Downloads&) = delete;
    ~Downloads(); ///< ends what is going on, and removes the folder

    /// Begins to write a file of a page; `done` is called by a thread of its own.
    /// Errors   as save_words() and Saver::start(); system when there is no folder to be had
    Result<void> start(PageKey page, const SaveRequest& request, const std::string& file,
                       const std::vector<std::string>& reading, std::function<void(Result<Download>)> done);

    /// The next part of the page's file, `part_bytes` or what is left; empty at its end, or where the page has none.
    std::string next_part(PageKey page);

    /// The page is gone: what is written for it ends, and its file goes.
    void forget(PageKey page);

private:
    Result<Download> take(PageKey page, const std::string& name, const std::string& path);

    std::string program_;
    std::string folder_; ///< of this user alone; made when it is needed
    std::unique_ptr<Saver> saver_;
    std::mutex mutex_;             ///< of what follows
    PageKey writing_for_ = 0;      ///< or was last; 0: that page is gone
    std::map<PageKey, int> files_; ///< descriptors: the names are gone already
};

} // namespace isotet::view
