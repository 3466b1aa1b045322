// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/saved_mesh.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include <libdeflate.h>

namespace isotet::view {

namespace {

/// 0, -1, 1, -2 as 0, 1, 2, 3.
template <class Word>
Word folded(Word difference) {
    const Word sign = static_cast<Word>(difference >> (std::numeric_limits<Word>::digits - 1));
    return static_cast<Word>(static_cast<Word>(difference << 1) ^ static_cast<Word>(0 - sign));
}

/// The column of `count` numbers that `code(i)` gives.
template <class Word, class Code>
void add_column(std::string& bytes, std::size_t count, const Code& code) {
    static_assert(std::is_unsigned_v<Word>);
    const std::size_t begin = bytes.size();
    bytes.resize(begin + count * sizeof(Word));
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t word = code(i);
        for (std::size_t plane = 0; plane < sizeof(Word); ++plane)
            bytes[begin + plane * count + i] = static_cast<char>(word >> (8 * plane));
    }
}

/// Of differences between the numbers that `at(vertex)` gives.
template <class Word, class At>
void add_differences(std::string& bytes, const std::vector<std::uint32_t>& order, const At& at) {
    Word last = 0;
    add_column<Word>(bytes, order.size(), [&](std::size_t i) {
        const Word value = static_cast<Word>(at(order[i]));
        const Word code = folded(static_cast<Word>(value - last));
        last = value;
        return static_cast<std::uint64_t>(code);
    });
}

/// Vertices in the order in which triangles use them first, then those that none uses.
std::vector<std::uint32_t> order_of_use(const Mesh& mesh) {
    std::vector<std::uint32_t> order;
    order.reserve(mesh.vertices.size());
    std::vector<bool> used(mesh.vertices.size(), false);
    const auto use = [&](std::uint32_t vertex) {
        if (used[vertex]) return;
        used[vertex] = true;
        order.push_back(vertex);
    };
    for (const std::uint32_t corner : mesh.corners) use(corner);
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) use(static_cast<std::uint32_t>(vertex));
    return order;
}

template <class Word>
void add_corners(std::string& bytes, const Mesh& mesh, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<std::uint32_t>(i);
    std::uint32_t next = 0; ///< that no triangle has used
    add_column<Word>(bytes, mesh.corners.size(), [&](std::size_t i) {
        const std::uint32_t back = next - place[mesh.corners[i]];
        next += back == 0 ? 1 : 0;
        return std::uint64_t{back};
    });
}

bool is_wide(const Mesh& mesh) { return mesh.vertices.size() > 65'535; }

} // namespace

std::string columns_of(const Mesh& mesh) {
    std::string bytes;
    const std::vector<std::uint32_t> order = order_of_use(mesh);
    for (std::size_t axis = 0; axis < 3; ++axis)
        add_differences<std::uint16_t>(bytes, order, [&](std::size_t i) { return mesh.vertices[i].place[axis]; });
    for (std::size_t side = 0; side < 2; ++side)
        add_differences<std::uint8_t>(bytes, order, [&](std::size_t i) { return mesh.vertices[i].normal[side]; });
    if (!mesh.colors.empty())
        add_differences<std::uint16_t>(bytes, order, [&](std::size_t i) { return mesh.colors[i]; });
    if (mesh.flat) return bytes;
    if (is_wide(mesh)) add_corners<std::uint32_t>(bytes, mesh, order);
    else add_corners<std::uint16_t>(bytes, mesh, order);
    return bytes;
}

Json told_of(const Mesh& mesh) {
    Json told = {{"vertices", mesh.vertices.size()},
                 {"triangles", mesh.triangle_count()},
                 {"wide", is_wide(mesh)},
                 {"flat", mesh.flat},
                 {"colored", !mesh.colors.empty()}};
    if (mesh.box.empty()) return told;
    told["lower"] = mesh.box.lower;
    told["upper"] = mesh.box.upper;
    return told;
}

Result<std::string> deflated(std::string_view bytes) {
    constexpr int level = 8;
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(level), libdeflate_free_compressor);
    if (!compressor) return Error{ErrorCode::out_of_memory, "there is too little memory to compress a surface"};
    std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
    out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
    return out;
}

std::string base64_of(std::string_view bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

} // namespace isotet::view
