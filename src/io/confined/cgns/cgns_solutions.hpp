// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fields of a zone: which arrays of its solutions hold at a step, and what they are called.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/confined/cgns/cgns_zone.hpp"

namespace isotet::io::confined {

class CgnsSolutions {
public:
    /// `steps`   of the base; solutions hold at those that the zone's pointers name them for. Without pointers, where as many
    ///           solutions of one location are there as steps, each is one step; all others hold always
    CgnsSolutions(const CgnsTree& tree, const CgnsZone& zone, std::size_t steps, const CgnsCounts& counts);

    /// Adds the fields of a step, or of all; those that cannot be read as left out.
    void announce(FileInfo& info, std::optional<std::size_t> only) const;

    /// The fields that are wanted. A field of a name that another solution has, too, is called "Solution/Name". Those that
    /// cannot be read are listed in `info`.
    void read(const ReadOptions& options, std::size_t step, const CgnsCells& cells, Grid& grid, FileInfo& info) const;

    /// The name of the coordinates that hold at a step; empty: the zone does not say.
    std::string coordinates_at(std::size_t step) const;

private:
    struct Solution {
        CgnsNode node;
        std::vector<CgnsNode> parts;
        Association association = Association::point;
        std::string problem; ///< why it is left out; empty: it is not
    };
    struct Named {
        std::string name;
        const Solution* solution;
        const CgnsNode* node;
        ScalarType type = ScalarType::float64;
        std::string problem;
    };
    void add(const CgnsNode& node);
    void read_pointers();
    bool holds(const Solution& solution, std::size_t step) const;
    std::vector<Named> fields_at(std::size_t step) const;
    std::string problem_of(const Solution& solution, const CgnsNode& node, ScalarType& type) const;
    void leave_out_field(FileInfo& info, const Named& field, const std::string& reason) const;
    std::vector<std::uint64_t> size_for(const Solution& solution) const;
    Result<Array> values_of(const Named& field, const CgnsCells& cells) const;

    const CgnsTree& tree_;
    const CgnsZone& zone_;
    std::size_t steps_;
    CgnsCounts counts_;
    std::vector<Solution> solutions_;
    std::vector<std::vector<std::string>> pointers_; ///< names of solutions, one a step
    std::vector<std::string> coordinates_;
};

} // namespace isotet::io::confined
