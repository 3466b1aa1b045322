// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_file.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "io/confined/length_check.hpp"
#include "io/confined/loaders.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t most_kept = 8;

struct KeptHdf5 {
    std::string path;
    std::shared_ptr<const Hdf5File> file;
};

/// The one that was asked for last is the last.
std::vector<KeptHdf5>& kept_hdf5() {
    static std::vector<KeptHdf5> kept;
    return kept;
}

} // namespace

std::recursive_mutex& hdf5_calls() {
    static std::recursive_mutex mutex;
    return mutex;
}

Result<std::shared_ptr<const Hdf5File>> open_hdf5(const std::string& path) {
    const std::scoped_lock lock(hdf5_calls());
    auto& kept = kept_hdf5();
    if (const auto known = std::ranges::find(kept, path, &KeptHdf5::path); known != kept.end()) {
        std::rotate(known, known + 1, kept.end());
        return kept.back().file;
    }
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // errors are returned, not printed
    auto source = ByteSource::open(path);
    if (!source) return source.error();
    if (auto complete = check_hdf5_length(*source, path); !complete) return complete.error();
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return broken(path, "not an HDF5 file, or a broken one");
    const auto close = [](const Hdf5File* opened) {
        const std::scoped_lock closing(hdf5_calls());
        delete opened;
    };
    std::shared_ptr<const Hdf5File> opened(new Hdf5File{*std::move(source), {file, H5Fclose}}, close);
    if (kept.size() == most_kept) kept.erase(kept.begin());
    kept.push_back({path, opened});
    return opened;
}

void close_hdf5_files() { kept_hdf5().clear(); }

} // namespace isotet::io::confined
