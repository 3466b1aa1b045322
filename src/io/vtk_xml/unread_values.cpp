// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/unread_values.hpp"

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/common_type.hpp"

namespace isotet::io::vtk_xml {

std::string reason_of(const Error& error, std::string_view name) {
    const std::string prefix = fmt::format("the array {}: ", in_quotes(name));
    return error.message.starts_with(prefix) ? error.message.substr(prefix.size()) : error.message;
}

/// `decode`   writes so many tuples in the type of the file
template <class Decode>
Result<Array> UnreadValues::filled(std::size_t tuples, const Decode& decode) const {
    return filled_array(field_.type, tuples, field_.components, [&](std::byte* to) -> Result<void> {
        if (!stored_) {
            fill_missing(field_.type, tuples * field_.components, to);
            return {};
        }
        const auto stored = stored_->open();
        if (!stored) return stored.error();
        const auto told = [&](const Result<void>& done) -> Result<void> {
            if (done || done.error().code != ErrorCode::invalid_data) return done;
            return invalid_data(reason_of(done.error(), stored->array().name));
        };
        if (stored->array().type == field_.type) return told(decode(*stored, to));
        const auto values = filled_array(stored->array().type, tuples, field_.components,
                                         [&](std::byte* own) { return told(decode(*stored, own)); });
        if (!values) return values.error();
        convert_scalars(*values, field_.type, to);
        return {};
    });
}

Result<Array> UnreadValues::read(const std::vector<std::uint64_t>& cells) const {
    return filled(cells.size(),
                  [&](const StoredArray& stored, std::byte* to) { return stored.decode_some(cells, to); });
}

Result<Array> UnreadValues::read() const {
    return filled(static_cast<std::size_t>(tuples_),
                  [](const StoredArray& stored, std::byte* to) { return stored.decode(to); });
}

} // namespace isotet::io::vtk_xml
