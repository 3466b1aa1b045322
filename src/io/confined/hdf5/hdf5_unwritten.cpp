// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_unwritten.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "io/confined/hdf5/hdf5_handle.hpp"

namespace isotet::io::confined {
namespace {

bool has_all_chunks(hid_t data, hid_t creation) {
    const Handle space(H5Dget_space(data), H5Sclose);
    const int rank = space.good() ? H5Sget_simple_extent_ndims(space) : -1;
    if (rank < 1) return false;
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank)), chunk(extent.size());
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    if (H5Pget_chunk(creation, rank, chunk.data()) != rank) return false;
    hsize_t wanted = 1, stored = 0;
    for (std::size_t axis = 0; axis < extent.size(); ++axis) {
        const hsize_t along = chunk[axis] == 0 ? 0 : (extent[axis] + chunk[axis] - 1) / chunk[axis];
        if (along != 0 && wanted > (hsize_t{1} << 60U) / along) return false;
        wanted *= along;
    }
    return H5Dget_num_chunks(data, H5S_ALL, &stored) >= 0 && stored == wanted;
}

} // namespace

bool may_be_unwritten(hid_t data) {
    const Handle creation(H5Dget_create_plist(data), H5Pclose);
    if (!creation.good()) return true;
    H5D_fill_time_t time = H5D_FILL_TIME_ALLOC;
    H5D_fill_value_t value = H5D_FILL_VALUE_DEFAULT;
    if (H5Pget_fill_time(creation, &time) < 0 || H5Pfill_value_defined(creation, &value) < 0) return true;
    if (time != H5D_FILL_TIME_NEVER && value != H5D_FILL_VALUE_UNDEFINED) return false;
    if (H5Pget_layout(creation) == H5D_CHUNKED) return !has_all_chunks(data, creation);
    H5D_space_status_t status = H5D_SPACE_STATUS_NOT_ALLOCATED;
    return H5Dget_space_status(data, &status) < 0 || status != H5D_SPACE_STATUS_ALLOCATED;
}

HdfRead read_written(hid_t data, hid_t type, hid_t memory, hid_t space, std::span<std::byte> to) {
    const auto read = [&](std::byte* place) { return H5Dread(data, type, memory, space, H5P_DEFAULT, place) >= 0; };
    if (to.empty()) return HdfRead::done;
    if (!may_be_unwritten(data)) return read(to.data()) ? HdfRead::done : HdfRead::failed;
    std::vector<std::byte> other(to.size(), std::byte{0xff});
    std::ranges::fill(to, std::byte{0});
    if (!read(to.data()) || !read(other.data())) return HdfRead::failed;
    return std::memcmp(to.data(), other.data(), to.size()) == 0 ? HdfRead::done : HdfRead::unwritten;
}

} // namespace isotet::io::confined
