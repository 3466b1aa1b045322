// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How much memory there is, and saying no before it runs out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/memory.hpp>
#include <isotet/result.hpp>
#include <isotet/text.hpp>

namespace isotet::core {

/// Bytes this process can still take: the smallest of what the system has free, what the control group allows, and what
/// the limit on address space leaves. Huge where none of these can be told.
ISOTET_API std::uint64_t free_memory();

/// What the control group of a process (version 2, or 1) and those above it leave; huge where there is no limit. Files
/// that are only cached are counted as used there, but give way.
/// `membership`  /proc/self/cgroup   `mount`  /sys/fs/cgroup
std::uint64_t control_group_free(const std::string& membership, const std::string& mount);

/// An out_of_memory error when `bytes` are more than free_memory(): "packing needs 12.3 GB, but 4.5 GB are free".
ISOTET_API Result<void> require_memory(std::string_view what, std::uint64_t bytes);

/// Gives freed memory that the C library keeps back to the system, where it can.
/// Threads   safe from many threads
ISOTET_API void trim_heap() noexcept;

using isotet::format_bytes;
using isotet::peak_resident_memory;
using isotet::reset_peak_memory;
using isotet::resident_memory;

} // namespace isotet::core
