// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any bytes, read as a PNG file: an error with a sentence, or a picture with all its pixels.
#include <string>

#include "fuzz/read_input.hpp"
#include "io/pictures/read_picture.hpp"

namespace {

std::uint32_t checksum(std::string_view bytes) {
    std::uint32_t sum = 0xffffffffu;
    for (const char byte : bytes) {
        sum ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ (sum & 1 ? 0xedb88320u : 0u);
    }
    return ~sum;
}

/// The same chunks with the checksums that they should have: with wrong ones nothing of them would be looked at.
std::string with_checksums(std::string_view input) {
    std::string bytes(input);
    constexpr std::size_t signature = 8, length_and_type = 8, type = 4, sum_bytes = 4;
    for (std::size_t at = signature; at + length_and_type + sum_bytes <= bytes.size();) {
        std::size_t length = 0;
        for (std::size_t k = 0; k < 4; ++k) length = length << 8 | static_cast<unsigned char>(bytes[at + k]);
        if (length > bytes.size() - at - length_and_type - sum_bytes) break;
        const std::size_t end = at + length_and_type + length;
        const std::uint32_t sum = checksum(std::string_view(bytes).substr(at + type, type + length));
        for (std::size_t k = 0; k < sum_bytes; ++k) bytes[end + k] = static_cast<char>(sum >> (24 - 8 * k));
        at = end + sum_bytes;
    }
    return bytes;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto picture = isotet::io::parse_picture(with_checksums(isotet::test::as_text(data, size)), "input");
    if (picture) {
        if (picture->pixels.size() != std::size_t{picture->width} * picture->height) std::abort();
    } else if (picture.error().message.empty() || picture.error().code == isotet::ErrorCode::internal) {
        std::abort();
    }
    return 0;
}
