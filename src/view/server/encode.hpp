// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pictures as a browser takes them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <isotet/picture.hpp>
#include <isotet/result.hpp>

namespace isotet::view {

struct EncodedPicture {
    std::uint32_t width = 0, height = 0;
    std::string_view type; ///< MIME
    std::string bytes;
};

/// Every pixel as it is; opacity is dropped. Errors   out_of_memory
Result<EncodedPicture> encode_png(const Picture& picture);

/// For a picture that moves: about a tenth of the bytes. Errors   out_of_memory
Result<EncodedPicture> encode_jpeg(const Picture& picture);

} // namespace isotet::view
