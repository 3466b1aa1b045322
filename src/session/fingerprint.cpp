// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/fingerprint.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/parallel.hpp"

namespace isotet::session {

namespace {

constexpr std::size_t block = std::size_t{1} << 20;

Fingerprint of_bytes(const void* data, std::size_t bytes) noexcept {
    const XXH128_hash_t hash = XXH3_128bits(data, bytes);
    return {hash.low64, hash.high64};
}

Fingerprint of_all(const std::vector<Fingerprint>& parts) noexcept {
    return of_bytes(parts.data(), parts.size() * sizeof(Fingerprint));
}

} // namespace

Fingerprint fingerprint(const Array& array) {
    const std::size_t blocks = (array.bytes() + block - 1) / block;
    std::vector<Fingerprint> parts(blocks);
    core::parallel_each(blocks, 1, [&](std::size_t i) {
        const std::size_t begin = i * block;
        parts[i] =
            of_bytes(static_cast<const std::byte*>(array.data()) + begin, std::min(block, array.bytes() - begin));
    });
    parts.push_back({array.tuples(), array.components()});
    parts.push_back({static_cast<std::uint64_t>(array.type()), array.bytes()});
    return of_all(parts);
}

Fingerprint fingerprint(const Cells& cells) {
    std::vector<Fingerprint> parts{{static_cast<std::uint64_t>(cells.uniform_type), 0}};
    for (const Array* array : {&cells.connectivity, &cells.offsets, &cells.types, &cells.faces, &cells.face_offsets})
        parts.push_back(fingerprint(*array));
    return of_all(parts);
}

} // namespace isotet::session
