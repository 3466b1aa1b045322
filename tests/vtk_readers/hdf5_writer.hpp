// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// HDF5 files for tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include <hdf5.h>

#include <isotet/array.hpp>

namespace isotet::test {

class Hdf5Writer {
public:
    explicit Hdf5Writer(const std::string& path)
        : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
    /// Of a file that is there, from which data are removed.
    Hdf5Writer(const std::string& path, const std::vector<std::string>& removed)
        : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)) {
        for (const std::string& name : removed) H5Ldelete(file_, name.c_str(), H5P_DEFAULT);
    }
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;
    ~Hdf5Writer() { H5Fclose(file_); }

    /// Of the header of an object.
    static std::size_t place_of(const std::string& path, const char* object) {
        const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
        H5O_info_t info;
        info.addr = 0;
        H5Oget_info_by_name2(file, object, &info, H5O_INFO_BASIC, H5P_DEFAULT);
        H5Fclose(file);
        return static_cast<std::size_t>(info.addr);
    }

    void group(const std::string& name) {
        H5Gclose(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
    void external_link(const std::string& name, const std::string& file, const std::string& target) {
        H5Lcreate_external(file.c_str(), target.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
    void soft_link(const std::string& name, const std::string& target) {
        H5Lcreate_soft(target.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
    void hard_link(const std::string& object, const std::string& name) {
        H5Lcreate_hard(file_, object.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    }
    /// Doubles whose bytes are in a file of their own.
    void stored_outside(const std::string& name, const std::string& file, hsize_t count) {
        const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_external(list, file.c_str(), 0, count * sizeof(double));
        empty_data(name, count, list);
    }
    /// Doubles that are those of a data set elsewhere.
    void virtual_data(const std::string& name, const std::string& file, const std::string& source, hsize_t count) {
        const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
        const hid_t space = H5Screate_simple(1, &count, nullptr);
        H5Pset_virtual(list, space, file.c_str(), source.c_str(), space);
        H5Sclose(space);
        empty_data(name, count, list);
    }

    struct RowsElsewhere {
        std::string file, source;
        hsize_t rows, first; ///< `first`: where they go
    };
    /// Rows of data sets elsewhere, as VTK has partitions and time steps in files of their own.
    template <class T>
    void virtual_rows(const std::string& name, const std::vector<RowsElsewhere>& parts, hsize_t rows,
                      hsize_t columns = 0) {
        const int rank = columns == 0 ? 1 : 2;
        const auto space_of = [&](hsize_t count) {
            const hsize_t lengths[] = {count, columns};
            return H5Screate_simple(rank, lengths, nullptr);
        };
        const hid_t list = H5Pcreate(H5P_DATASET_CREATE), whole = space_of(rows);
        for (const RowsElsewhere& part : parts) {
            const hid_t place = space_of(rows), from = space_of(part.rows);
            const hsize_t start[] = {part.first, 0}, count[] = {part.rows, columns};
            H5Sselect_hyperslab(place, H5S_SELECT_SET, start, nullptr, count, nullptr);
            H5Pset_virtual(list, place, part.file.c_str(), part.source.c_str(), from);
            H5Sclose(place);
            H5Sclose(from);
        }
        H5Dclose(H5Dcreate2(file_, name.c_str(), type<T>(), whole, H5P_DEFAULT, list, H5P_DEFAULT));
        H5Sclose(whole);
        H5Pclose(list);
    }

    template <class T>
    void data(const std::string& name, const std::vector<T>& values, std::vector<hsize_t> dimensions) {
        const hid_t space = dimensions.empty()
                                ? H5Screate(H5S_SCALAR)
                                : H5Screate_simple(static_cast<int>(dimensions.size()), dimensions.data(), nullptr);
        const hid_t set = H5Dcreate2(file_, name.c_str(), type<T>(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Dwrite(set, type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        H5Dclose(set);
        H5Sclose(space);
    }
    /// How a data set is stored; without chunks in one run.
    struct Storage {
        std::vector<hsize_t> chunk = {};
        bool shuffled = false, deflated = false, checksums = false, big_endian = false;
        H5Z_filter_t filter = 0; ///< another one; 0: none
        hsize_t unwritten = 0;     ///< rows at the end, which are filled
        bool never_filled = false; ///< they are not: reading leaves memory as it was
    };
    template <class T>
    void stored(const std::string& name, const std::vector<T>& values, std::vector<hsize_t> dimensions,
                const Storage& storage) {
        const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
        std::vector<hsize_t> chunk = storage.chunk;
        for (std::size_t i = 0; i < chunk.size(); ++i) chunk[i] = std::min(chunk[i], dimensions[i]);
        if (!chunk.empty()) H5Pset_chunk(list, static_cast<int>(chunk.size()), chunk.data());
        if (storage.shuffled) H5Pset_shuffle(list);
        if (storage.deflated) H5Pset_deflate(list, 4);
        if (storage.checksums) H5Pset_fletcher32(list);
        if (storage.filter != 0) H5Pset_filter(list, storage.filter, H5Z_FLAG_MANDATORY, 0, nullptr);
        if (storage.never_filled) H5Pset_fill_time(list, H5D_FILL_TIME_NEVER);
        const hid_t file_type = H5Tcopy(type<T>());
        if (storage.big_endian) H5Tset_order(file_type, H5T_ORDER_BE);
        const hid_t space = H5Screate_simple(static_cast<int>(dimensions.size()), dimensions.data(), nullptr);
        const hid_t set = H5Dcreate2(file_, name.c_str(), file_type, space, H5P_DEFAULT, list, H5P_DEFAULT);
        std::vector<hsize_t> written = dimensions, start(dimensions.size(), 0);
        written[0] -= storage.unwritten;
        const hid_t memory = H5Screate_simple(static_cast<int>(written.size()), written.data(), nullptr);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, written.data(), nullptr);
        if (written[0] > 0) H5Dwrite(set, type<T>(), memory, space, H5P_DEFAULT, values.data());
        H5Sclose(memory);
        H5Sclose(space);
        H5Dclose(set);
        H5Tclose(file_type);
        H5Pclose(list);
    }
    /// Floats of two bytes, or else long doubles.
    void floats(const std::string& name, const std::vector<double>& values, bool half, hsize_t chunk) {
        const hid_t type = H5Tcopy(half ? H5T_IEEE_F32LE : H5T_NATIVE_LDOUBLE);
        if (half) { // as NumPy's float16
            H5Tset_fields(type, 15, 10, 5, 0, 10);
            H5Tset_size(type, 2);
            H5Tset_ebias(type, 15);
        }
        const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
        if (chunk > 0) H5Pset_chunk(list, 1, &chunk);
        const hsize_t count = values.size();
        const hid_t space = H5Screate_simple(1, &count, nullptr);
        const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
        H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        H5Dclose(set);
        H5Sclose(space);
        H5Pclose(list);
        H5Tclose(type);
    }
    void attribute(const std::string& group, const char* name, const std::vector<std::int64_t>& values) {
        const hsize_t count = values.size();
        attach(group, name, H5Screate_simple(1, &count, nullptr), H5T_NATIVE_INT64, values.data());
    }
    void real_attribute(const std::string& group, const char* name, const std::vector<double>& values) {
        const hsize_t count = values.size();
        attach(group, name, H5Screate_simple(1, &count, nullptr), H5T_NATIVE_DOUBLE, values.data());
    }
    void attribute(const std::string& group, const char* name, const std::string& text) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, text.size());
        attach(group, name, H5Screate(H5S_SCALAR), type, text.data());
        H5Tclose(type);
    }

    /// As h5py writes a text of Python.
    void variable_attribute(const std::string& group, const char* name, const std::string& text) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        H5Tset_cset(type, H5T_CSET_UTF8);
        const char* const letters = text.c_str();
        attach(group, name, H5Screate(H5S_SCALAR), type, &letters);
        H5Tclose(type);
    }

    /// Texts of 80 letters, as MED has the names of groups.
    void long_texts(const std::string& name, const std::vector<std::string>& texts) {
        const hsize_t letters = 80, count = texts.size();
        std::string all;
        for (std::string text : texts) {
            text.resize(letters, '\0');
            all += text;
        }
        const hid_t type = H5Tarray_create2(H5T_NATIVE_INT8, 1, &letters);
        const hid_t space = H5Screate_simple(1, &count, nullptr);
        const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
        H5Dclose(set);
        H5Sclose(space);
        H5Tclose(type);
    }

private:
    void empty_data(const std::string& name, hsize_t count, hid_t list) {
        const hid_t space = H5Screate_simple(1, &count, nullptr);
        H5Dclose(H5Dcreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT));
        H5Sclose(space);
        H5Pclose(list);
    }
    void attach(const std::string& group, const char* name, hid_t space, hid_t type, const void* values) {
        const hid_t target = H5Gopen2(file_, group.c_str(), H5P_DEFAULT);
        const hid_t attribute = H5Acreate2(target, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, type, values);
        H5Aclose(attribute);
        H5Gclose(target);
        H5Sclose(space);
    }
    template <class T>
    static hid_t type() {
        if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
        else if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
        else if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
        else if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
        else return H5T_NATIVE_INT64;
    }
    hid_t file_;
};

/// A grid of VTKHDF: two tets on five points, no field yet.
inline void write_two_tets(Hdf5Writer& file, const std::string& type = "UnstructuredGrid") {
    for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"}) file.group(name);
    file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
    file.attribute("/VTKHDF", "Type", type);
    file.data<std::int64_t>("/VTKHDF/NumberOfPoints", {5}, {1});
    file.data<std::int64_t>("/VTKHDF/NumberOfCells", {2}, {1});
    file.data<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", {8}, {1});
    file.data<double>("/VTKHDF/Points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1}, {5, 3});
    file.data<std::uint8_t>("/VTKHDF/Types", {10, 10}, {2});
    file.data<std::int64_t>("/VTKHDF/Connectivity", {0, 1, 2, 3, 0, 2, 1, 4}, {8});
    file.data<std::int64_t>("/VTKHDF/Offsets", {0, 4, 8}, {3});
}

/// A grid of VTKHDF: one cell on its points, 3 coordinates each, in their order, and the field f.
inline void write_one_cell(Hdf5Writer& file, std::uint8_t type, const std::vector<double>& points,
                           const std::vector<double>& values) {
    const auto count = static_cast<std::int64_t>(values.size());
    const hsize_t rows = values.size();
    std::vector<std::int64_t> connectivity(values.size());
    std::iota(connectivity.begin(), connectivity.end(), std::int64_t{0});
    for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"}) file.group(name);
    file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
    file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
    file.data<std::int64_t>("/VTKHDF/NumberOfPoints", {count}, {1});
    file.data<std::int64_t>("/VTKHDF/NumberOfCells", {1}, {1});
    file.data<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", {count}, {1});
    file.data<double>("/VTKHDF/Points", points, {rows, 3});
    file.data<std::uint8_t>("/VTKHDF/Types", {type}, {1});
    file.data<std::int64_t>("/VTKHDF/Connectivity", connectivity, {rows});
    file.data<std::int64_t>("/VTKHDF/Offsets", {0, count}, {2});
    file.data<double>("/VTKHDF/PointData/f", values, {rows});
}

/// All scalars of an array, tuple by tuple.
inline std::vector<double> numbers_of(const Array& array) {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < array.tuples(); ++i)
        for (std::size_t k = 0; k < array.components(); ++k) numbers.push_back(array.at(i, k));
    return numbers;
}

} // namespace isotet::test
