// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MED files for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "vtk_readers/hdf5_writer.hpp"

namespace isotet::test {

using MedNumbers = std::vector<std::int64_t>;

class MedWriter {
public:
    explicit MedWriter(const std::string& path, std::int64_t version = 4) : file_(path) {
        for (const char* name : {"/INFOS_GENERALES", "/ENS_MAA", "/CHA", "/FAS", "/PROFILS"}) file_.group(name);
        file_.attribute("/INFOS_GENERALES", "MAJ", MedNumbers{version});
        file_.attribute("/INFOS_GENERALES", "MIN", MedNumbers{1});
    }
    Hdf5Writer& hdf5() { return file_; }

    /// `points`   so many coordinates each, one after another
    void mesh(const std::string& name, const std::vector<double>& points, std::size_t axes = 3) {
        axes_ = axes;
        group_ = "/ENS_MAA/" + name;
        file_.group(group_);
        const auto dimension = static_cast<std::int64_t>(axes);
        for (const auto& [key, value] : {std::pair("DIM", dimension), {"ESP", dimension}, {"TYP", 0}, {"REP", 0}})
            file_.attribute(group_, key, MedNumbers{value});
        group_ = add_step(group_, -1, -1, 0);
        file_.group(group_ + "/MAI");
        coordinates(points);
    }
    /// At another step of the mesh that was begun last.
    void coordinates_at(std::int64_t number, const std::vector<double>& points) {
        group_ = add_step(group_.substr(0, group_.rfind('/')), number, number, static_cast<double>(number));
        coordinates(points);
    }
    /// `nodes`   from 1, of each cell in MED's order; `families`: one a cell, or none
    void cells(const std::string& type, std::size_t width, const MedNumbers& nodes, const MedNumbers& families = {}) {
        const std::string group = group_ + "/MAI/" + type;
        file_.group(group);
        file_.data(group + "/NOD", by_component(nodes, width), {nodes.size()});
        if (!families.empty()) file_.data(group + "/FAM", families, {families.size()});
    }
    /// Polyhedra; all numbers from 1.
    void polyhedra(const MedNumbers& nodes, const MedNumbers& face_offsets, const MedNumbers& cell_offsets) {
        const std::string group = group_ + "/MAI/POE";
        file_.group(group);
        file_.data(group + "/NOD", nodes, {nodes.size()});
        file_.data(group + "/INN", face_offsets, {face_offsets.size()});
        file_.data(group + "/IFN", cell_offsets, {cell_offsets.size()});
    }
    /// All numbers from 1.
    void polygons(const std::string& type, const MedNumbers& nodes, const MedNumbers& offsets) {
        const std::string group = group_ + "/MAI/" + type;
        file_.group(group);
        file_.data(group + "/NOD", nodes, {nodes.size()});
        file_.data(group + "/INN", offsets, {offsets.size()});
    }
    void family(const std::string& mesh, const std::string& name, std::int64_t number,
                const std::vector<std::string>& groups) {
        const std::string all = "/FAS/" + mesh;
        if (families_of_ != mesh) {
            file_.group(all);
            file_.group(all + "/ELEME");
        }
        families_of_ = mesh;
        const std::string group = all + "/ELEME/" + name;
        file_.group(group);
        file_.attribute(group, "NUM", MedNumbers{number});
        file_.group(group + "/GRO");
        file_.long_texts(group + "/GRO/NOM", groups);
    }
    void profile(const std::string& name, const MedNumbers& numbers) {
        file_.group("/PROFILS/" + name);
        file_.data("/PROFILS/" + name + "/PFL", numbers, {numbers.size()});
    }
    /// `type`   6: float64, 24: int32
    void field(const std::string& name, const std::string& mesh, std::int64_t components, std::int64_t type = 6,
               const std::string& names = "") {
        field_ = "/CHA/" + name;
        file_.group(field_);
        file_.attribute(field_, "MAI", mesh);
        file_.attribute(field_, "NCO", MedNumbers{components});
        file_.attribute(field_, "TYP", MedNumbers{type});
        if (!names.empty()) file_.attribute(field_, "NOM", names);
    }
    /// Of the field that was begun last; -1: at all times.
    void step(std::int64_t number, double time) {
        step_ = add_step(field_, number, number, time);
        file_.attribute(step_, "RDT", MedNumbers{number});
        file_.attribute(step_, "ROR", MedNumbers{number});
    }
    /// `place`    "NOE", "MAI.TE4", "NOE.TE4"
    /// `values`   for each component, for each entity, for each of its points
    template <class T>
    void values(const std::string& place, const std::vector<T>& values, std::int64_t per_entity = 1,
                const std::string& profile = "MED_NO_PROFILE_INTERNAL") {
        if (place_ != step_ + "/" + place) file_.group(step_ + "/" + place);
        place_ = step_ + "/" + place;
        const std::string group = place_ + "/" + profile;
        file_.group(group);
        file_.attribute(group, "NGA", MedNumbers{per_entity});
        file_.data(group + "/CO", values, {values.size()});
    }

private:
    std::string add_step(const std::string& group, std::int64_t number, std::int64_t iteration, double time) {
        const std::string step = fmt::format("{}/{:020}{:020}", group, number, iteration);
        file_.group(step);
        file_.attribute(step, "NDT", MedNumbers{number});
        file_.attribute(step, "NOR", MedNumbers{iteration});
        file_.real_attribute(step, "PDT", {time});
        return step;
    }
    void coordinates(const std::vector<double>& points) {
        file_.group(group_ + "/NOE");
        file_.data(group_ + "/NOE/COO", by_component(points, axes_), {points.size()});
    }
    template <class T>
    static std::vector<T> by_component(const std::vector<T>& rows, std::size_t width) {
        std::vector<T> columns;
        for (std::size_t c = 0; c < width; ++c)
            for (std::size_t at = c; at < rows.size(); at += width) columns.push_back(rows[at]);
        return columns;
    }

    Hdf5Writer file_;
    std::size_t axes_ = 3;
    std::string group_, field_, step_, place_, families_of_;
};

} // namespace isotet::test
