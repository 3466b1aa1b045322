// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the text of a DataItem with Format HDF names.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <isotet/result.hpp>

#include "io/confined/hdf5/hdf5_array.hpp"

namespace isotet::io::confined {

/// The path of a file that a text names.
using FindHeavyFile = std::function<Result<std::string>(std::string_view name)>;

/// Reads "file.h5:/group/data set", or a part of it, "file.h5:/data set|start:stride:count:size" with a number for each
/// dimension in each of the four, or several of these between bars, one after another.
///
/// `index`   the XDMF file, for messages
/// `box`     a part that is taken where the text itself states none
Result<ShapedValues> read_heavy(const std::string& index, std::string_view text, const FindHeavyFile& find,
                                const Box& box, Depth depth, HdfNumbers numbers = HdfNumbers::as_stored);

} // namespace isotet::io::confined
