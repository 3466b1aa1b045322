// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the ranks of a controller tell each other. Each call is collective: every rank makes the same ones, whatever
// happened to it.
#pragma once

#include <string>
#include <vector>

#include <isotet/frame.hpp>

class vtkMultiProcessController;

namespace isotet_vtk {

class Ranks {
public:
    /// With a null pointer or one process nothing is sent.
    explicit Ranks(vtkMultiProcessController* controller);

    int count() const { return count_; }

    /// Whether any rank says so.
    struct Flags {
        bool failed = false;
        bool changed = false;       ///< something that the frame depends on
        bool renumbered = false;    ///< as changed, and numbers of points may be others
        bool no_global_ids = false; ///< has points without them
        bool too_many = false;      ///< has more than one block
        bool missing = false;       ///< has a block without the array
        bool found = false;         ///< has one with it
    };
    Flags any(const Flags& mine) const;

    int sum(int mine) const;

    /// The error of the lowest rank that has one, named; empty when none has.
    std::string first_error(const std::string& mine) const;

    /// The surveys of all ranks, in their order.
    std::vector<isotet::Survey> gather(const isotet::Survey& mine) const;

private:
    vtkMultiProcessController* controller_;
    int count_;
};

} // namespace isotet_vtk
