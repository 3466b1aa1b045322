// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/lone_faces.hpp"

#include <algorithm>
#include <atomic>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/system/fresh_memory.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"

namespace isotet::linear {

namespace {

/// Errors   as lone_faces()
Result<std::vector<FoundFace>> found_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                           const LookAtCells& look, const Progress& progress) {
    constexpr std::string_view what = "looking for hanging points";
    constexpr std::size_t cells_a_part = 1 << 13;
    std::vector<std::vector<FoundFace>> parts((cells.count() + cells_a_part - 1) / cells_a_part);
    core::FreshMemory room(core::unclaimed_memory);
    std::atomic<std::uint64_t> count = 0;
    std::atomic<bool> fits = true;
    core::parallel_pieces(parts.size(), 1, progress, [&](std::size_t first, std::size_t last) {
        FaceWalk walk(cells, faces);
        for (std::size_t part = first; part < last && fits; ++part) {
            look(walk, part * cells_a_part, std::min((part + 1) * cells_a_part, cells.count()), parts[part]);
            parts[part].shrink_to_fit();
            count += parts[part].size();
            if (!room.take(parts[part].size() * sizeof(FoundFace))) fits = false;
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, fmt::format("{} was cancelled", what)};
    constexpr std::uint64_t bytes_each = sizeof(FoundFace) + 2 * sizeof(core::Keyed) + 1; // alone_of() too
    if (!fits) return core::too_little_memory(what, bytes_each * count + core::FreshMemory::of_heap);
    if (auto enough = core::require_memory(what, bytes_each * count); !enough) return enough.error();
    std::vector<FoundFace> all;
    all.reserve(count);
    for (std::vector<FoundFace>& part : parts) {
        all.insert(all.end(), part.begin(), part.end());
        part = {};
    }
    return all;
}

std::vector<FoundFace> alone_of(std::vector<FoundFace> found) {
    core::Buffer<core::Keyed> items(found.size()), scratch(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) items[i] = {found[i].hash, i};
    core::radix_sort({items.data(), items.size()}, {scratch.data(), scratch.size()});
    std::vector<std::uint8_t> is_alone(found.size());
    for (std::size_t begin = 0, end = 0; begin < items.size(); begin = end) {
        end = begin + 1;
        while (end < items.size() && items[end].key == items[begin].key) ++end;
        is_alone[items[begin].number] = end == begin + 1;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (is_alone[i] != 0) found[kept++] = found[i];
    found.resize(kept);
    return found;
}

} // namespace

Result<std::vector<FoundFace>> lone_faces(const core::CellReader& cells, const core::FaceReader& faces,
                                          const LookAtCells& look, const Progress& progress) {
    auto found = found_faces(cells, faces, look, progress);
    if (!found) return found;
    return alone_of(*std::move(found));
}

OpenFaces with_loops(const std::vector<FoundFace>& found, const core::CellReader& cells,
                     const core::FaceReader& faces) {
    OpenFaces out;
    FaceWalk walk(cells, faces);
    for (const FoundFace& face : found) out.add(face.place, walk.loop(face.place));
    return out;
}

} // namespace isotet::linear
