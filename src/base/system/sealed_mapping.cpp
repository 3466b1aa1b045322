// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/sealed_mapping.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <fmt/format.h>

namespace isotet::core {

Result<SealedMapping> map_sealed(int descriptor) {
    if (::fcntl(descriptor, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL) != 0)
        return Error{ErrorCode::system,
                     fmt::format("the reply of the reader process cannot be sealed: {}", std::strerror(errno))};
    struct stat status{};
    if (::fstat(descriptor, &status) != 0)
        return Error{ErrorCode::system,
                     fmt::format("the size of the reader process's reply cannot be read: {}", std::strerror(errno))};
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size == 0) return SealedMapping{};
    void* const begin = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (begin == MAP_FAILED)
        return Error{ErrorCode::system, fmt::format("the reply of the reader process, {} bytes, cannot be mapped: {}",
                                                    size, std::strerror(errno))};
    std::shared_ptr<const void> owner(begin, [size](void* mapped) { ::munmap(mapped, size); });
    return SealedMapping{{static_cast<const std::byte*>(begin), size}, std::move(owner)};
}

} // namespace isotet::core
