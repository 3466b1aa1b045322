// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/mapped_file.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <new>

#include "base/system/plain_file.hpp"

namespace isotet::io {

Result<MappedFile> MappedFile::open(const std::string& path) {
    const auto file = core::open_plain_file(path);
    if (!file) return file.error();
    const std::size_t size = file->size;
    void* const data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file->descriptor.number(), 0);
    if (data == MAP_FAILED) return core::system_error(path, "cannot be mapped into memory", errno);
    ::madvise(data, size, MADV_SEQUENTIAL);
    try {
        return MappedFile(std::shared_ptr<const void>(data, [size](void* mapped) { ::munmap(mapped, size); }), size);
    } catch (const std::bad_alloc&) { // shared_ptr has called the deleter
        return Error{ErrorCode::out_of_memory, "no memory left to open a file"};
    }
}

} // namespace isotet::io
