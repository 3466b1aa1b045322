// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a viewer is told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "view/server/greeting.hpp"
#include "view/steps.hpp"

namespace isotet::view {

/// A file that is shown.
struct ViewerFile {
    std::string name;                                    ///< as the command line names it
    std::vector<std::string> reading;                    ///< options of the command line that say how it is read
    std::function<Result<ViewerInput>(const Run&)> read; ///< called by a thread of its own
    ReadStep read_step;  ///< of any step, as ViewerInput has it; nothing: the file is not read again
    ReadStep read_cells; ///< the same with all cells, where ViewerInput has some
    std::function<Result<Grid>(Grid grid, const std::vector<std::string>& cells,
                               const std::vector<RegionName>& regions)>
        only_cells; ///< empties others, as GridOptions::cells; nothing: all are shown
};

struct ViewerOptions {
    ViewerFile file;
    std::optional<ViewerFile> second;   ///< shown beside it
    std::uint16_t port = 0;             ///< 0: a free one
    std::vector<std::string> hosts;     ///< as ServerOptions::hosts
    std::string listen;                 ///< as ServerOptions::listen
    std::string version;                ///< shown by the page
    std::string token;                  ///< empty: 128 bits of the system's random numbers
    bool keep = false;                  ///< goes on when the last page was closed
    double linger_seconds = 60;         ///< after the last page was closed, without `keep`
    double unopened_seconds = 1800;     ///< for the first page, without `keep`
    double lost_seconds = 1800;         ///< after the last page lost its connection, from which it may come back
    double failure_seconds = 30;        ///< that an error of reading waits for a page to tell
    std::function<bool()> is_left = {}; ///< asked now and then: whether what started it has gone; then run() ends
    std::function<void(const Error&)> failed = {}; ///< told an error of reading at once, by a thread of its own
    std::size_t max_pages = 4;                     ///< at once
    int threads = 0;                               ///< at most; 0: all
    std::optional<RefineOptions> refine =
        RefineOptions{}; ///< of curved cells where a page rests; nothing: it is not done
    std::string out;     ///< a folder where pages may save files; empty: they may not
    std::string program; ///< that writes these files, and those that pages download, by command lines of isotet
};

} // namespace isotet::view
