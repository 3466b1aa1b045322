// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet's side of the race, and the maker of its grids; race.py drives it through pipes.
#include <isotet/read.hpp>

#include "bench/isotet_contestant.hpp"

int main(int argc, char** argv) {
    if (const auto status = isotet::run_as_reader(argc, argv)) return *status;
    isotet::bench::IsotetContestant contestant;
    return isotet::bench::serve([&](const isotet::bench::Words& words) { return contestant.answer(words); });
}
