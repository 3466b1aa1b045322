// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/carried.hpp"

namespace isotet::api {

Result<ExtractOptions> with_unpacked_fields(ExtractOptions options, const Run& run) {
    for (const PackedGrid& grid : options.packed_fields) {
        Result<Field> field = unpack_field(grid, run);
        if (!field) return field.error();
        options.point_fields.push_back(*std::move(field));
    }
    options.packed_fields.clear();
    return options;
}

} // namespace isotet::api
