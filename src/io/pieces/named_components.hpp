// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays whose components have names: VMIS, TRESCA ...
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <isotet/export.hpp>

namespace isotet::io {

/// A field that some components of an array are.
struct NamedComponents {
    std::string name;
    std::size_t first = 0, count = 0;
};

/// The fields that an array is. Components of a vector (DX DY DZ), of a tensor (SXX SYY ...) and numbered ones (V1 to Vn) are
/// one, called as the array. Others, and those behind a vector or tensor, are one each: "SIEQ:VMIS", "DEPL:DRX".
///
/// `names`   of its components; where one is missing or there twice, all are one field
ISOTET_API std::vector<NamedComponents> fields_of_components(const std::string& array,
                                                             std::span<const std::string> names);

} // namespace isotet::io
