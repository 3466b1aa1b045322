// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet's side of the race, and the maker of its grids; race.py drives it through pipes.
#include "bench/isotet_contestant.hpp"

int main() {
    isotet::bench::IsotetContestant contestant;
    return isotet::bench::serve([&](const isotet::bench::Words& words) { return contestant.answer(words); });
}
