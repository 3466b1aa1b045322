// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The socket between isotet and isotet-reader. A request is one packet with two memory files, the request and the one for
// the reply; back come packets of one byte.
#pragma once

#include <optional>

#include <isotet/export.hpp>

#include "base/system/descriptor.hpp"

namespace isotet::core {

/// What a reader process finds open besides 0 (/dev/null), 1 and 2 (both collected); all others are closed.
constexpr int channel_descriptor = 3;

/// Bytes from the reader: 0 to 100 are per cent done (0 also says that the request was taken).
constexpr unsigned char status_file_limit = 252; ///< the reply is larger than the limit on the size of files
constexpr unsigned char status_time_ran_out = 253;
constexpr unsigned char status_replied = 254;
constexpr unsigned char status_memory_ran_out = 255;

struct Parcel {
    Descriptor request, reply; ///< memory files
};

/// False when the other end is closed.
ISOTET_API bool send_parcel(int channel, int request, int reply);

/// Waits for a parcel; nothing when the other end is closed.
ISOTET_API std::optional<Parcel> receive_parcel(int channel);

} // namespace isotet::core
