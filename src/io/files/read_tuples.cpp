// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/read_tuples.hpp"

#include <cstring>

#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/files/pace.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t tuples_per_task = std::size_t{1} << 12;
constexpr std::size_t bytes_per_read = std::size_t{1} << 18;
constexpr std::size_t bytes_between = std::size_t{1} << 14; ///< that are rather read than stepped over

} // namespace

Result<void> read_tuples(const ByteSource& source, std::size_t begin, std::size_t bytes,
                         std::span<const std::uint64_t> tuples, std::byte* to, const Progress& progress) {
    FirstError failed;
    core::parallel_pieces(tuples.size(), tuples_per_task, progress, [&](std::size_t first, std::size_t end) {
        thread_local Scratch scratch;
        for (std::size_t i = first, next = first; i < end && !failed; i = next) {
            const std::size_t from = static_cast<std::size_t>(tuples[i]) * bytes;
            std::size_t behind = from + bytes; // of the last one that is read with it
            for (next = i + 1; next < end; ++next) {
                const std::size_t at = static_cast<std::size_t>(tuples[next]) * bytes;
                if (at > behind + bytes_between || at + bytes > from + bytes_per_read) break;
                behind = at + bytes;
            }
            const auto together = scratch.take(behind - from);
            if (auto done = source.read(begin + from, together); !done) return failed.add(i, done.error());
            for (std::size_t k = i; k < next; ++k)
                std::memcpy(to + k * bytes, together.data() + static_cast<std::size_t>(tuples[k]) * bytes - from,
                            bytes);
        }
        scratch.trim();
    });
    if (progress.cancelled()) return Pace::cancelled();
    return failed.result();
}

} // namespace isotet::io
