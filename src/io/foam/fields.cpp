// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/foam/field_file.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/tensor_order.hpp"

namespace isotet::io::foam {

namespace {

/// Means at points; NaN is left out.
class PointMeans {
public:
    PointMeans(std::size_t points, std::size_t components)
        : components_(components), sums_(points * components, 0), counts_(points, 0) {}

    void add(std::int32_t point, const double* tuple) {
        const auto at = static_cast<std::size_t>(point);
        ++counts_[at];
        for (std::size_t k = 0; k < components_; ++k) sums_[at * components_ + k] += tuple[k];
    }
    bool has(std::size_t point) const { return counts_[point] > 0; }
    double mean(std::size_t point, std::size_t component) const {
        return sums_[point * components_ + component] / counts_[point];
    }

private:
    std::size_t components_;
    std::vector<double> sums_;
    std::vector<std::uint32_t> counts_;
};

bool has_nan(const double* tuple, std::size_t components) {
    return std::any_of(tuple, tuple + components, [](double value) { return std::isnan(value); });
}

/// A face of a patch and the values there.
struct FaceValue {
    std::array<std::int32_t, 2> key; ///< lowest and highest point: an order that the numbers of faces do not decide
    std::size_t face;
    const double* tuple;
};

/// Collects what the parts have, then gives arrays.
class FieldReader {
public:
    FieldReader(const CaseFiles& files, const WholeMesh& whole, const Cells& cells, const FieldRequest& request)
        : files_(files), whole_(whole), cells_(cells), request_(request) {}

    Result<CaseField> read() {
        for (const Part& part : whole_.parts)
            if (auto added = add(part); !added) return added.error();
        CaseField out;
        out.lacking = std::move(lacking_);
        out.unread = std::move(unread_);
        out.misfits = std::move(misfits_);
        if (of_points_) {
            out.points = array_of(std::move(values_));
            return out;
        }
        if (request_.points) out.points = array_of(at_points());
        if (request_.cells) out.cells = array_of(std::move(values_));
        return out;
    }

private:
    Result<void> add(const Part& part) {
        const std::string name = part.prefix + request_.folder + request_.name;
        const auto first = std::ranges::find_if(whole_.parts, [&](const Part& one) {
            return files_.has(one.prefix + request_.folder + request_.name);
        });
        if (first != whole_.parts.end() && !files_.has(name)) { // as where a run was stopped while it wrote
            lacking_.push_back(part.prefix.substr(0, part.prefix.find('/')));
            return {};
        }
        auto file = read_field_file(files_, name, std::max(part.cells, part.points), request_.allow_outside);
        if (!file) return file.error();
        if (type_.empty()) {
            components_ = file->components;
            of_points_ = file->header.type.starts_with("point");
            type_ = file->header.type;
            const std::size_t tuples = of_points_ ? whole_.mesh.point_count() : whole_.mesh.cells;
            values_.assign(tuples * components_, std::numeric_limits<double>::quiet_NaN());
        } else if (file->header.type != type_)
            return broken(file->path, fmt::format("is of class {}, but {} in the first part",
                                                  in_quotes(file->header.type), in_quotes(type_)));
        single_ = single_ && file->header.single;
        unread_.merge(file->unread);
        misfits_.merge(file->faults);
        if (auto placed = place(part, *file); !placed) return placed;
        if (!of_points_ && request_.points) keep_patches(part, *file);
        return {};
    }

    /// What is wrong with a number of values; empty: nothing.
    std::string misfit(const Values& values, std::size_t wanted, const std::string& what) const {
        const std::size_t tuples = values.values.size() / components_;
        if (values.uniform || tuples == wanted) return {};
        return fmt::format("{} has {} values, but {} are wanted", what, tuples, wanted);
    }

    Result<void> place(const Part& part, FieldFile& file) {
        Values& inside = *file.inside;
        const std::size_t count = of_points_ ? part.points : part.cells;
        if (const std::string wrong = misfit(inside, count, "internalField"); !wrong.empty())
            return broken(file.path, wrong);
        if (components_ == 6) order_as_vtk(inside.values, order_of_upper_rows);
        const bool is_whole = whole_.parts.size() == 1;
        if (is_whole && !inside.uniform) {
            values_ = std::move(inside.values);
            return {};
        }
        const auto& numbers = of_points_ ? part.point_numbers : part.cell_numbers;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t to = is_whole ? i : static_cast<std::size_t>(numbers[i]);
            std::copy_n(inside.values.data() + (inside.uniform ? 0 : i * components_), components_,
                        values_.data() + to * components_);
        }
        return {};
    }

    void keep_patches(const Part& part, const FieldFile& file) {
        for (const Patch& patch : part.patches) {
            auto values = known_values(file, patch);
            if (!values || patch.count == 0) continue;
            const std::string what = fmt::format("the value of patch {} in {}", in_quotes(patch.name), request_.name);
            if (std::string wrong = misfit(*values, patch.count, what); !wrong.empty()) {
                misfits_.insert(std::move(wrong));
                continue;
            }
            if (components_ == 6) order_as_vtk(values->values, order_of_upper_rows);
            patches_.emplace_back(&patch, std::move(*values));
        }
    }

    PointMeans means_of_patches() const {
        std::vector<FaceValue> faces;
        const Faces& all = whole_.mesh.faces;
        for (const auto& [patch, values] : patches_)
            for (std::size_t i = 0; i < patch->count; ++i) {
                const std::size_t face = patch->first + i;
                const double* tuple = values.values.data() + (values.uniform ? 0 : i * components_);
                const auto points = all.of(face);
                if (points.empty() || has_nan(tuple, components_)) continue;
                const auto [low, high] = std::ranges::minmax(points);
                faces.push_back({{low, high}, face, tuple});
            }
        // Faces of a decomposed case come in another order, and sums depend on it.
        std::ranges::stable_sort(faces, {}, &FaceValue::key);
        PointMeans means(whole_.mesh.point_count(), components_);
        for (const FaceValue& value : faces)
            for (const std::int32_t point : all.of(value.face)) means.add(point, value.tuple);
        return means;
    }

    PointMeans means_of_cells() const {
        PointMeans means(whole_.mesh.point_count(), components_);
        const auto corners = cells_.connectivity.as<std::int32_t>();
        const std::size_t uniform =
            cells_.offsets.empty() && whole_.mesh.cells > 0 ? corners.size() / whole_.mesh.cells : 0;
        const auto begin = [&](std::size_t cell) {
            return uniform ? cell * uniform : static_cast<std::size_t>(cells_.offsets.as<std::int64_t>()[cell]);
        };
        for (std::size_t cell = 0; cell < whole_.mesh.cells; ++cell) {
            const double* tuple = values_.data() + cell * components_;
            if (has_nan(tuple, components_)) continue;
            for (std::size_t k = begin(cell); k < begin(cell + 1); ++k) means.add(corners[k], tuple);
        }
        return means;
    }

    std::vector<double> at_points() const {
        const std::size_t points = whole_.mesh.point_count();
        std::vector<double> out(points * components_, std::numeric_limits<double>::quiet_NaN());
        const auto take = [&](const PointMeans& means) {
            for (std::size_t point = 0; point < points; ++point)
                for (std::size_t k = 0; k < components_ && means.has(point); ++k)
                    out[point * components_ + k] = means.mean(point, k);
        };
        take(means_of_cells());
        if (!patches_.empty()) take(means_of_patches());
        return out;
    }

    Array array_of(std::vector<double> values) const {
        if (!single_) return Array::own(std::move(values), components_);
        std::vector<float> narrow(values.size());
        std::ranges::transform(values, narrow.begin(), [](double value) { return static_cast<float>(value); });
        return Array::own(std::move(narrow), components_);
    }

    const CaseFiles& files_;
    const WholeMesh& whole_;
    const Cells& cells_;
    const FieldRequest& request_;
    std::string type_;
    std::size_t components_ = 1;
    bool of_points_ = false, single_ = true;
    std::vector<std::string> lacking_;
    std::set<std::string> unread_, misfits_;
    std::vector<double> values_;
    std::vector<std::pair<const Patch*, Values>> patches_;
};

} // namespace

Result<CaseField> read_case_field(const CaseFiles& files, const WholeMesh& whole, const Cells& cells,
                                  const FieldRequest& request) {
    return FieldReader(files, whole, cells, request).read();
}

} // namespace isotet::io::foam
