// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <isotet/memory.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// Whether there is room for so many bytes in scratch files; nothing where arrays do not go there.
std::optional<Result<void>> require_scratch(std::string_view what, std::uint64_t bytes);

} // namespace isotet::core
