// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/codec.hpp"

#include <limits>
#include <memory>
#include <new>

#include <libdeflate.h>
#include <lz4.h>
#include <lzma.h>

namespace isotet::io::vtk_xml {
namespace {

struct FreeCompressor {
    void operator()(libdeflate_compressor* it) const noexcept { libdeflate_free_compressor(it); }
};

std::string deflate_zlib(std::span<const std::byte> block) {
    constexpr int level = 1;
    thread_local const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
        libdeflate_alloc_compressor(level));
    if (!compressor) throw std::bad_alloc();
    std::string packed(libdeflate_zlib_compress_bound(compressor.get(), block.size()), '\0');
    packed.resize(libdeflate_zlib_compress(compressor.get(), block.data(), block.size(), packed.data(), packed.size()));
    return packed;
}

/// Of less than 1 GB.
std::string deflate_lz4(std::span<const std::byte> block) {
    const int size = static_cast<int>(block.size());
    std::string packed(static_cast<std::size_t>(LZ4_compressBound(size)), '\0');
    packed.resize(static_cast<std::size_t>(LZ4_compress_default(reinterpret_cast<const char*>(block.data()),
                                                                packed.data(), size, static_cast<int>(packed.size()))));
    return packed;
}

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* it) const noexcept { libdeflate_free_decompressor(it); }
};

bool inflate_zlib(std::string_view packed, std::span<std::byte> to) {
    thread_local const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(
        libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    // Without a place for the size every other size is an error.
    return libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), to.data(), to.size(),
                                      nullptr) == LIBDEFLATE_SUCCESS;
}

bool inflate_lz4(std::string_view packed, std::span<std::byte> to) {
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max());
    if (packed.size() > most || to.size() > most) return false;
    const int size = static_cast<int>(to.size());
    return LZ4_decompress_safe(packed.data(), reinterpret_cast<char*>(to.data()), static_cast<int>(packed.size()),
                               size) == size;
}

bool inflate_lzma(std::string_view packed, std::span<std::byte> to) {
    std::uint64_t memory = std::uint64_t{128} << 20; // level 9 takes 65 MiB
    std::size_t read = 0, written = 0;
    const auto result =
        lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &read,
                                  packed.size(), reinterpret_cast<std::uint8_t*>(to.data()), &written, to.size());
    if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
    return result == LZMA_OK && written == to.size();
}

} // namespace

std::optional<Codec> codec_of(std::string_view compressor) {
    if (compressor.empty()) return Codec::none;
    if (compressor == "vtkZLibDataCompressor") return Codec::zlib;
    if (compressor == "vtkLZ4DataCompressor") return Codec::lz4;
    if (compressor == "vtkLZMADataCompressor") return Codec::lzma;
    return std::nullopt;
}

std::string_view name_of(Codec codec) {
    constexpr std::string_view names[] = {"none", "zlib", "LZ4", "LZMA"};
    return names[static_cast<std::size_t>(codec)];
}

bool is_plausible(Codec codec, std::uint64_t packed, std::uint64_t unpacked) {
    constexpr std::uint64_t ratios[] = {1, 1032, 255, 1 << 14}; // xz makes 1 byte of 6,900 zeros
    const std::uint64_t ratio = ratios[static_cast<std::size_t>(codec)];
    return unpacked / ratio <= packed;
}

std::string deflate(Codec codec, std::span<const std::byte> block) {
    return codec == Codec::lz4 ? deflate_lz4(block) : deflate_zlib(block);
}

std::string checksum_of(std::span<const std::byte> values) {
    const std::uint32_t sum = libdeflate_adler32(1, values.data(), values.size());
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(sum >> shift));
    return bytes;
}

bool inflate(Codec codec, std::string_view packed, std::span<std::byte> to) {
    switch (codec) {
    case Codec::zlib: return inflate_zlib(packed, to);
    case Codec::lz4: return inflate_lz4(packed, to);
    case Codec::lzma: return inflate_lzma(packed, to);
    case Codec::none: break;
    }
    return false;
}

} // namespace isotet::io::vtk_xml
