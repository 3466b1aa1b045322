// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What addresses of `isotet view` need to be valid in the next run, too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace isotet::cli {

struct ViewRecord {
    std::string token;
    std::uint16_t port = 0;
};

/// Of the last run with a file, from view.json in $XDG_STATE_HOME/isotet or ~/.local/state/isotet. Nothing where there
/// is none, or where others than its owner may read the record.
std::optional<ViewRecord> recall_view(const std::string& file);

/// Keeps the records of 50 files, in a file that its owner alone may read. Where it cannot be written, nothing is kept.
void remember_view(const std::string& file, const ViewRecord& record);

} // namespace isotet::cli
