// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is told of a packed file from its directory.
#pragma once

#include <string>

#include <isotet/packed_file.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

std::string packed_table(const PackedFileInfo& info, const std::string& path);

Json packed_json(const PackedFileInfo& info, const std::string& path, const std::string& command);

} // namespace isotet::cli
