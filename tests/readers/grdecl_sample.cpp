// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "readers/grdecl_sample.hpp"

#include <fmt/core.h>

namespace isotet::test {

std::function<double(int, int, int, int)> even_layers(double throw_) {
    return [throw_](int, int, int z, int block) { return 100 + 4 * z + block * throw_; };
}

std::string grdecl_box(const CornerPointBox& box, const std::string& rest) {
    std::string text =
        fmt::format("-- a box / with a comment\nSPECGRID\n  {} {} {} 1 F /\n\nCOORD\n", box.nx, box.ny, box.nz);
    for (int y = 0; y <= box.ny; ++y)
        for (int x = 0; x <= box.nx; ++x)
            text += fmt::format(" {} {} 100 {} {} 200\n", 10 * x, 10 * y, 10 * x + 25, 10 * y - 5);
    text += "/\nZCORN\n";
    for (int plane = 0; plane < 2 * box.nz; ++plane)
        for (int row = 0; row < 2 * box.ny; ++row) {
            for (int column = 0; column < 2 * box.nx; ++column)
                text += fmt::format(
                    " {}", box.depth((column + 1) / 2, (row + 1) / 2, (plane + 1) / 2, column / 2 < box.fault ? 0 : 1));
            text += '\n';
        }
    return text + "/\n" + rest;
}

std::string grdecl_sample() {
    return "RUNSPEC\nTITLE\nA sample\nMAPUNITS\nMETRES /\nGRIDUNIT\n 'METRES' '' /\nMAPAXES\n 0 1 0 0 1 0 "
           "/\nGRID\nACTNUM\n 3*1 0 /\n" +
           grdecl_box({2, 1, 2, 1, even_layers(1)}, "PORO -- share of the volume\n 2*.25 0.5 1* /\n"
                                                    "SATNUM\n1 2 -- lower layer\n2*3/\nEQUALS\n PORO 0.5 1 2 /\n/\n"
                                                    "BOX\n 1 1 1 1 1 1 /\nPERMX\n7 /\nENDBOX\nPROPS\nSWOF\n1 2 3 4 /\n"
                                                    "REGIONS\nFIPNUM\n4*1 /\nEND\nPORO\n4*7 /\n");
}

} // namespace isotet::test
