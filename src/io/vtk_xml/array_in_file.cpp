// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/array_in_file.hpp"

#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io::vtk_xml {

ArrayInFile::ArrayInFile(std::string path, std::shared_ptr<const Document> document, const StoredArray& stored)
    : path_(std::move(path)),
      document_(std::move(document)),
      held_(document_->source.is_in_memory() ? document_->source : ByteSource(std::string_view())),
      size_(document_->source.size()),
      stored_(stored.in(ByteSource(std::string_view()))) {}

Result<StoredArray> ArrayInFile::open() const {
    if (held_.size() == size_) return stored_.in(held_);
    const auto source = ByteSource::open(path_);
    if (!source) return source.error();
    if (source->size() != size_)
        return Error{ErrorCode::file, fmt::format("{}: it had {} bytes and has {} now, so it was changed meanwhile",
                                                  escaped(path_), size_, source->size())};
    return stored_.in(*source);
}

} // namespace isotet::io::vtk_xml
