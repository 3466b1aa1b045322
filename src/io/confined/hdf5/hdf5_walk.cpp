// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/hdf5_walk.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <hdf5.h>

#include "io/confined/hdf5/hdf5_file.hpp"
#include "io/confined/hdf5/hdf5_virtual.hpp"
#include "io/confined/length_check.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t max_objects = 1000000, max_files = 1000, max_broken = 1000;
constexpr int max_depth = 100;

/// Closes an HDF5 object at the end of a block.
struct Closing {
    hid_t id;
    herr_t (*close)(hid_t);
    ~Closing() {
        if (id >= 0) close(id);
    }
    Closing(hid_t object, herr_t (*function)(hid_t)) : id(object), close(function) {}
    Closing(const Closing&) = delete;
    Closing& operator=(const Closing&) = delete;
};

std::vector<std::string> parts_of(std::string_view path) {
    std::vector<std::string> parts;
    for (std::size_t at = 1; at <= path.size();) {
        const std::size_t end = std::min(path.find('/', at), path.size());
        parts.emplace_back(path.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

/// Variables of Exodus that are no part of the mesh.
bool is_extra_of_exodus(const std::string& name) {
    return std::ranges::any_of(
        std::array{"vals_", "name_", "qa_records", "info_records", "dist_fact", "node_ns", "elem_ss", "side_ss"},
        [&](const char* begin) { return name.starts_with(begin); });
}

/// What a grid lacks without an object that cannot be opened; nothing where it would be another grid: without its
/// ghost cells, or with values elsewhere.
std::optional<LeftOut> field_at(const std::string& path, bool in_solution) {
    const std::vector<std::string> parts = parts_of(path);
    const std::string reason = fmt::format("HDF5 cannot open \"{}\"", escaped(path));
    if (parts.front() == "CHA")
        return LeftOut{parts.size() > 1 ? "field" : "section", parts[parts.size() > 1 ? 1 : 0], reason};
    if (in_solution) {
        for (const char* name : {"GridLocation", "Rind", "PointList", "PointRange", "DataConversion", "DataClass"})
            if (std::ranges::find(parts, name) != parts.end()) return std::nullopt;
        const bool of_array = parts.back().starts_with(' ') && parts.size() > 1; // " data", " link"
        return LeftOut{"field", of_array ? parts[parts.size() - 2] : parts.back(), reason};
    }
    if (parts.size() == 1 && is_extra_of_exodus(parts[0])) return LeftOut{"array", parts[0], reason};
    if (parts.size() < 2 || parts.back().starts_with("vtkGhost")) return std::nullopt;
    const std::string& group = parts[parts.size() - 2];
    if (group == "PointData") return LeftOut{"point field", parts.back(), reason};
    if (group == "CellData") return LeftOut{"cell field", parts.back(), reason};
    if (group == "FieldData" || parts.back() == "FieldData") return LeftOut{"array", parts.back(), reason};
    return std::nullopt;
}

/// Without its target cells or fields would be missing in silence.
bool must_lead_somewhere(const std::string& path) {
    const std::string last = parts_of(path).back();
    return last == "PointData" || last == "CellData" || last.starts_with("vtkGhost");
}

/// The kind of a CGNS node.
std::string label_of(hid_t group) {
    constexpr std::size_t length = 33;
    if (H5Aexists(group, "label") <= 0) return {};
    const Closing attribute(H5Aopen(group, "label", H5P_DEFAULT), H5Aclose);
    const Closing type(H5Tcopy(H5T_C_S1), H5Tclose),
        stored(attribute.id < 0 ? -1 : H5Aget_type(attribute.id), H5Tclose);
    const Closing space(attribute.id < 0 ? -1 : H5Aget_space(attribute.id), H5Sclose);
    char text[length + 1] = {};
    if (stored.id < 0 || space.id < 0 || H5Tis_variable_str(stored.id) != 0 || H5Tget_class(stored.id) != H5T_STRING ||
        H5Sget_simple_extent_npoints(space.id) != 1 || H5Tset_size(type.id, length) < 0 ||
        H5Aread(attribute.id, type.id, text) < 0)
        return {};
    return text;
}

/// HDF5's signature is at the beginning, or at 512, 1024, 2048 and so on.
bool is_hdf5(const ByteSource& file) {
    constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
    Scratch scratch;
    for (std::size_t at = 0; at + signature.size() <= file.size(); at = std::max<std::size_t>(512, 2 * at))
        if (const auto bytes = file.view(at, signature.size(), scratch); bytes && *bytes == signature) return true;
    return false;
}

class Walk {
public:
    Walk(const std::string& path, bool allow_outside) : allow_outside_(allow_outside), files_{{path, true}} {}

    Result<std::vector<LeftOut>> all_files() {
        for (std::size_t i = 0; i < files_.size() && !failed_; ++i) one_file(WalkedFile(files_[i]));
        if (!failed_) follow_links();
        if (!failed_) check_virtual();
        if (failed_) return *failed_;
        return std::move(broken_);
    }

private:
    struct WalkedFile {
        std::string path;
        bool needed; ///< else only fields are in it
    };
    /// A link that may lead to nothing.
    struct LooseLink {
        std::string file, path;
        std::optional<LeftOut> without; ///< what a grid then lacks; nothing: it cannot
        std::optional<Error> missing;   ///< its file is not where it may be
    };

    struct VirtualData {
        std::string file, path;
    };

    void fail(std::string_view what) {
        if (!failed_) failed_ = broken(file_, what);
    }
    void lack(LeftOut item) {
        if (broken_.size() == max_broken)
            return fail(fmt::format("more than {} of its objects cannot be opened", max_broken));
        broken_.push_back(std::move(item));
    }
    /// Once all files are known to be sound: HDF5 opens what links lead to.
    void follow_links() {
        for (std::size_t i = 0; i < links_.size() && !failed_;) {
            file_ = links_[i].file;
            const auto file = open_hdf5(file_);
            for (; i < links_.size() && links_[i].file == file_ && !failed_; ++i) {
                LooseLink& link = links_[i];
                const Closing object(!file ? -1 : H5Oopen((*file)->file, link.path.c_str(), H5P_DEFAULT), H5Oclose);
                if (object.id >= 0 && link.missing) failed_ = std::move(link.missing); // HDF5 found another one
                else if (object.id < 0 && link.without) lack(*std::move(link.without));
                else if (object.id < 0) fail(in(link.path, "is a link that leads to nothing"));
            }
        }
    }
    /// Once it is known where links lead.
    void check_virtual() {
        for (const VirtualData& one : virtual_) {
            file_ = one.file;
            const auto file = open_hdf5(file_);
            const Closing data(!file ? -1 : H5Dopen2((*file)->file, one.path.c_str(), H5P_DEFAULT), H5Dclose);
            if (data.id < 0) return fail(in(one.path, "cannot be opened"));
            auto whole = check_virtual_data(data.id, file_, allow_outside_, one.path.ends_with("/Offsets"));
            if (!whole) return fail(in(one.path, whole.error().message));
        }
    }
    void one_file(const WalkedFile& walked) {
        file_ = walked.path;
        needed_ = walked.needed;
        const auto file = open_hdf5(file_);
        if (!file && !needed_) return;
        if (!file) return fail("HDF5 cannot open it: the file is broken");
        const Closing root(H5Gopen2((*file)->file, "/", H5P_DEFAULT), H5Gclose);
        if (root.id < 0) return fail("it has no root group: the file is broken");
        group(root.id, "");
    }

    void group(hid_t id, const std::string& name) {
        H5O_info_t info;
        if (H5Oget_info2(id, &info, H5O_INFO_BASIC) < 0) return fail(in(name, "cannot be read"));
        if (std::ranges::find(ancestors_, info.addr) != ancestors_.end()) return fail(in(name, "contains itself"));
        if (ancestors_.size() == max_depth) return fail(in(name, "is nested too deep"));
        if (std::ranges::find(seen_, info.addr) != seen_.end() && info.rc > 1) return;
        if (info.rc > 1) seen_.push_back(info.addr);
        ancestors_.push_back(info.addr);
        const bool around = in_solution_;
        in_solution_ = around || label_of(id) == "FlowSolution_t";
        Here here{this, id, name};
        hsize_t at = 0;
        const auto visit = [](hid_t, const char* link, const H5L_info_t* about, void* data) -> herr_t {
            const auto* place = static_cast<const Here*>(data);
            place->walk->link(place->group, place->name, link, *about);
            return place->walk->failed_ ? 1 : 0;
        };
        if (H5Literate(id, H5_INDEX_NAME, H5_ITER_NATIVE, &at, visit, &here) < 0) fail(in(name, "cannot be read"));
        in_solution_ = around;
        ancestors_.pop_back();
    }
    struct Here {
        Walk* walk;
        hid_t group;
        const std::string& name;
    };

    void link(hid_t group_id, const std::string& group_name, const char* name, const H5L_info_t& about) {
        const std::string path = group_name + "/" + name;
        if (++objects_ > max_objects) return fail(fmt::format("it holds more than {} objects", max_objects));
        if (about.type == H5L_TYPE_SOFT) return soft(path);
        if (about.type == H5L_TYPE_EXTERNAL) return external(group_id, path, name, about);
        if (about.type != H5L_TYPE_HARD) return fail(in(path, "is a link of a kind of its own"));
        const Closing object(H5Oopen(group_id, name, H5P_DEFAULT), H5Oclose);
        if (object.id < 0) {
            auto dispensable = field_at(path, in_solution_);
            if (dispensable) lack(*std::move(dispensable));
            else if (needed_) fail(in(path, "cannot be opened"));
            return;
        }
        const H5I_type_t kind = H5Iget_type(object.id);
        if (kind == H5I_GROUP) group(object.id, path);
        else if (kind == H5I_DATASET) data_set(object.id, path);
    }

    void soft(const std::string& path) {
        auto dispensable = field_at(path, in_solution_);
        if (dispensable) dispensable->reason = in(path, "is a link that leads to nothing");
        if (dispensable || must_lead_somewhere(path)) links_.push_back({file_, path, std::move(dispensable), {}});
    }

    void external(hid_t group_id, const std::string& path, const char* name, const H5L_info_t& about) {
        std::vector<char> value(about.u.val_size + 1, '\0');
        unsigned flags = 0;
        const char *file = nullptr, *target = nullptr;
        if (H5Lget_val(group_id, name, value.data(), value.size() - 1, H5P_DEFAULT) < 0 ||
            H5Lunpack_elink_val(value.data(), about.u.val_size, &flags, &file, &target) < 0)
            return fail(in(path, "is a link that cannot be read"));
        auto dispensable = field_at(path, in_solution_);
        if (!dispensable) {
            if (must_lead_somewhere(path)) links_.push_back({file_, path, {}, {}});
            return other_file(path, file, true);
        }
        const auto there = named_file(file_, file, allow_outside_);
        if (!there && there.error().code == ErrorCode::file) {
            dispensable->reason = there.error().message;
            return links_.push_back({file_, path, std::move(dispensable), there.error()});
        }
        dispensable->reason =
            in(path, fmt::format("links to \"{}\" in \"{}\", which HDF5 cannot open", escaped(target), escaped(file)));
        links_.push_back({file_, path, std::move(dispensable), {}});
        other_file(path, file, false);
    }

    void data_set(hid_t id, const std::string& path) {
        const Closing list(H5Dget_create_plist(id), H5Pclose);
        if (list.id < 0) return fail(in(path, "cannot be read"));
        const int stored_outside = H5Pget_external_count(list.id);
        for (int i = 0; i < stored_outside && !failed_; ++i) {
            char name[4096] = {};
            if (H5Pget_external(list.id, static_cast<unsigned>(i), sizeof name - 1, name, nullptr, nullptr) < 0)
                return fail(in(path, "stores its data in a file whose name cannot be read"));
            named(path, name, "stores its data in");
        }
        if (H5Pget_layout(list.id) != H5D_VIRTUAL) return;
        const auto files = files_of_virtual_data(id);
        if (!files) return fail(in(path, files.error().message));
        for (std::size_t i = 0; i < files->size() && !failed_; ++i)
            other_file(path, (*files)[i], true, "is put together of");
        virtual_.push_back({file_, path});
    }

    void named(const std::string& path, std::string_view name, std::string_view does) {
        if (auto file = named_file(file_, name, allow_outside_); !file && !failed_)
            failed_ = Error{file.error().code, fmt::format("{}: {} another file: {}", escaped(file_), in(path, does),
                                                           file.error().message)};
    }
    void other_file(const std::string& path, std::string_view name, bool needed, std::string_view does = "links to") {
        named(path, name, does);
        if (failed_) return;
        const auto file = named_file(file_, name, allow_outside_);
        if (const auto known = std::ranges::find(files_, *file, &WalkedFile::path); known != files_.end()) {
            if (known->needed || !needed) return;
            known->needed = true; // if it was gone over, then with less to say
        }
        if (files_.size() == max_files) return fail(fmt::format("it links to more than {} files", max_files));
        files_.push_back({*file, needed});
    }
    static std::string in(const std::string& path, std::string_view what) {
        return fmt::format("\"{}\" {}", escaped(path.empty() ? "/" : path), what);
    }

    bool allow_outside_;
    std::vector<WalkedFile> files_; ///< this one, and those that it links to
    std::vector<LooseLink> links_;  ///< of each file together
    std::vector<VirtualData> virtual_;
    std::string file_;
    bool needed_ = true;
    std::vector<haddr_t> ancestors_, seen_; ///< groups: around this one; with several names
    std::size_t objects_ = 0;
    bool in_solution_ = false; ///< of CGNS
    std::vector<LeftOut> broken_;
    std::optional<Error> failed_;
};

} // namespace

Result<std::vector<LeftOut>> check_hdf5_names(const std::string& path, bool allow_outside) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // messages are ours
    const auto file = ByteSource::open(path);
    if (!file) return file.error();
    if (auto complete = check_hdf5_length(*file, path); !complete) return complete.error();
    if (!is_hdf5(*file)) return std::vector<LeftOut>();
    return Walk(path, allow_outside).all_files();
}

} // namespace isotet::io::confined
