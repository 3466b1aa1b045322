// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/loaded.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io {

void announce(FileInfo& info, FieldInfo field) {
    for (const FieldInfo& known : info.fields)
        if (known.name == field.name && known.association == field.association) return;
    info.fields.push_back(std::move(field));
}

void leave_out(FileInfo& info, LeftOut item) {
    for (const LeftOut& known : info.left_out)
        if (known.what == item.what && known.name == item.name && known.reason == item.reason) return;
    info.left_out.push_back(std::move(item));
}

void add(LeastCounts& all, const LeastCounts& part) {
    if (part.points > 0) {
        const bool narrower = size_of(part.coordinates) < size_of(all.coordinates);
        if (all.points == 0 || narrower) all.coordinates = part.coordinates;
    }
    all.points += part.points;
    all.cells += part.cells;
    all.corners += part.corners;
    all.all_cells = all.all_cells || part.all_cells;
}

void append(Loaded& whole, Loaded part) {
    for (FieldInfo& field : part.info.fields) announce(whole.info, std::move(field));
    for (LeftOut& item : part.info.left_out) leave_out(whole.info, std::move(item));
    std::ranges::move(part.info.files, std::back_inserter(whole.info.files));
    std::ranges::move(part.pieces, std::back_inserter(whole.pieces));
    std::ranges::move(part.notes, std::back_inserter(whole.notes));
    whole.info.cells += part.info.cells;
    add(whole.info.least, part.info.least);
}

Error broken(const std::string& path, std::string_view what) {
    return {ErrorCode::invalid_data, fmt::format("{}: {}", escaped(path), what)};
}

Error in_file(const std::string& path, const Error& error) {
    return error.code == ErrorCode::invalid_data ? broken(path, error.message) : error;
}

} // namespace isotet::io
