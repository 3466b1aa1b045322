// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "ranks.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include <vtkCommunicator.h>
#include <vtkMultiProcessController.h>

namespace isotet_vtk {

static_assert(std::is_trivially_copyable_v<isotet::Survey>);

Ranks::Ranks(vtkMultiProcessController* controller)
    : controller_(controller), count_(controller ? controller->GetNumberOfProcesses() : 1) {}

Ranks::Flags Ranks::any(const Flags& mine) const {
    if (count_ < 2) return mine;
    const std::array<int, 7> own = {mine.failed,   mine.changed, mine.renumbered, mine.no_global_ids,
                                    mine.too_many, mine.missing, mine.found};
    std::array<int, 7> all{};
    controller_->AllReduce(own.data(), all.data(), static_cast<vtkIdType>(own.size()), vtkCommunicator::MAX_OP);
    return {all[0] != 0, all[1] != 0, all[2] != 0, all[3] != 0, all[4] != 0, all[5] != 0, all[6] != 0};
}

int Ranks::sum(int mine) const {
    int all = mine;
    if (count_ > 1) controller_->AllReduce(&mine, &all, 1, vtkCommunicator::SUM_OP);
    return all;
}

std::string Ranks::first_error(const std::string& mine) const {
    if (count_ < 2 || !any({.failed = !mine.empty()}).failed) return mine;
    constexpr std::size_t width = 512;
    std::array<char, width> own{};
    std::copy_n(mine.data(), std::min(mine.size(), width - 1), own.data());
    std::vector<char> all(width * static_cast<std::size_t>(count_));
    controller_->AllGather(own.data(), all.data(), static_cast<vtkIdType>(width));
    for (int rank = 0; rank < count_; ++rank)
        if (const char* text = all.data() + width * static_cast<std::size_t>(rank); *text)
            return "rank " + std::to_string(rank) + ": " + text;
    return mine;
}

std::vector<isotet::Survey> Ranks::gather(const isotet::Survey& mine) const {
    std::vector<isotet::Survey> all(static_cast<std::size_t>(count_), mine);
    if (count_ > 1)
        controller_->AllGather(reinterpret_cast<const unsigned char*>(&mine),
                               reinterpret_cast<unsigned char*>(all.data()), static_cast<vtkIdType>(sizeof mine));
    return all;
}

} // namespace isotet_vtk
