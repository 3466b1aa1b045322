// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_filters.hpp"

#include <array>

#include <fmt/core.h>

#include "io/confined/hdf5/hdf5_handle.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {

std::string why_not_read(hid_t data) {
    const Handle creation(H5Dget_create_plist(data), H5Pclose);
    const int count = creation.good() ? H5Pget_nfilters(creation) : 0;
    for (int i = 0; i < count; ++i) {
        std::size_t values = 0;
        unsigned flags = 0, configuration = 0;
        std::array<char, 64> name{};
        const H5Z_filter_t filter = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr,
                                                   name.size() - 1, name.data(), &configuration);
        if (filter >= 0 && H5Zfilter_avail(filter) <= 0)
            return fmt::format("is stored with the HDF5 filter {} \"{}\", which is not installed: \"h5repack -f GZIP=4 "
                               "IN OUT\", where it is, writes a file that can be read",
                               filter, escaped(name.data()));
    }
    return "cannot be read";
}

} // namespace isotet::io::confined
